//! A recording shown live: played at its own times to Foxglove and Lichtblick, which play, pause and jump.

use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;

use crate::bag;
use crate::cli::output::say;
use crate::cli::signals;
use crate::live::{self, Gateway, Hub, LatchedStates, Player};
use crate::ros::args::RosArgs;
use crate::ros::logging;
use flexdrill_text::printable;

/// Plays a bag at `address` until the process is asked to end.
pub(super) fn show(path: &Path, address: SocketAddr, origins: &[String]) -> anyhow::Result<()> {
    logging::start(&RosArgs::default());
    let listener = live::listen("--foxglove", address)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let shutdown = signals::shutdown(false)?;
        let bag = bag::open(path)?;
        let (start, end) = live::range(&bag, path)?;
        let hub = Hub::new(bag.topics().iter().map(AsRef::as_ref));
        let states = Arc::new(LatchedStates::default());
        read_states(path, Arc::clone(&states))?;
        let playing = Player::start(bag, (start, end), &hub, &states)?;
        say!(
            "playing {} ({:.1} s) at ws://{} for Foxglove and Lichtblick; Ctrl-C ends it",
            printable(&path.display().to_string()),
            (end - start) as f64 * 1e-9,
            listener.local_addr()?
        );
        let gateway = Gateway::new(&hub, None, origins);
        live::serve(listener, live::only_gateway(gateway), shutdown).await?;
        drop(playing);
        anyhow::Ok(())
    })
}

/// Reads the latched topics through, on a thread that is left behind at the end: it only reads.
fn read_states(path: &Path, states: Arc<LatchedStates>) -> anyhow::Result<()> {
    let mut bag = bag::open(path)?;
    bag.select(|topic| topic.qos.iter().any(|qos| qos.transient_local));
    std::thread::Builder::new().name("reader".into()).spawn(move || {
        // What cannot be read is told by the player, when it comes there.
        for message in bag.flatten() {
            states.observe(&message);
        }
    })?;
    Ok(())
}
