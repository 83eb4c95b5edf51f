//! An orderly end where DDS uses loopback alone.

use crate::common::{Network, Program};

#[test]
fn an_orderly_end_on_loopback_logs_no_error() {
    let Some(network) = Network::new() else { return };
    // As on a machine whose default route leaves by another interface, or that has none.
    assert!(network.done(&["ip", "route", "del", "224.0.0.0/4", "dev", "lo"]));
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["bridge", "wits", "--listen", "127.0.0.1:0"]);
    command.env("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
    let mut program = Program::start(command);
    program.wait_for("Ctrl-C ends it");
    // DDS, in its own process, joins the multicast groups within this time.
    std::thread::sleep(std::time::Duration::from_secs(2));
    program.signal("TERM");
    assert_eq!(program.end(), Some(0), "{}", program.said());
    let said = program.said();
    assert!(said.contains("stopped") && !said.contains("ERROR"), "{said}");
}
