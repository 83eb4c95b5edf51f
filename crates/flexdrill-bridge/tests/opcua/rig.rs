//! Our client, with asyncua as the rig's server.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use flexdrill_bridge::lines::now;
use flexdrill_bridge::opcua::client::RigEvent;
use flexdrill_messages::RigInputs;

use crate::follower::Follower;
use crate::peer::{python, script};

/// A rig's server by asyncua.
struct Rig {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    port: u16,
}

impl Drop for Rig {
    fn drop(&mut self) {
        // One that has ended is no fault.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Rig {
    fn start(python: &Path, port: u16) -> Self {
        let mut child = Command::new(python)
            .arg(script("opcua_rig.py"))
            .arg(port.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let input = child.stdin.take().unwrap();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        output.read_line(&mut line).unwrap();
        Self {
            port: line.trim().parse().unwrap(),
            child,
            input,
            output,
        }
    }

    fn set(&mut self, line: &str) {
        writeln!(self.input, "{line}").unwrap();
        let mut answer = String::new();
        self.output.read_line(&mut answer).unwrap();
        assert_eq!(answer.trim(), "done", "{line}");
    }
}

const MAPPING: &str = "interval_s: 0.05\nnodes:\n  \"nsu=urn:rig;s=Rig.Speed\": {quantity: rotary_speed, unit: r/min, valid: \
                       [0, 200]}\n  \"ns=2;s=Rig.HookLoad\": {quantity: hook_load, unit: kN}\n  \"ns=2;s=Rig.Nothing\": \
                       {quantity: surface_torque, unit: kN.m}\n";

#[tokio::test(flavor = "multi_thread", worker_threads = 3)]
async fn interop_our_client_follows_a_rig_of_asyncua_through_bad_values_and_a_restart() {
    let Some(python) = python() else { return };
    let mut rig = Rig::start(&python, 0);
    let mut follower = Follower::new(&format!("opc.tcp://127.0.0.1:{}", rig.port), MAPPING);
    let mut refused = Vec::new();
    let nodes = follower
        .until(60, |_, event| match event {
            RigEvent::NotFollowed { node, .. } => {
                refused.push(node.clone());
                None
            }
            RigEvent::Opened { nodes, .. } => Some(*nodes),
            _ => None,
        })
        .await;
    assert_eq!(
        (nodes, refused.as_slice()),
        (2, ["ns=2;s=Rig.Nothing".to_owned()].as_slice())
    );
    for speed in [60.0, 90.0] {
        rig.set(&format!("Speed {speed}"));
        let inputs = follower
            .inputs(30, |inputs| (inputs.rotary_speed_rpm - speed).abs() < 1e-9)
            .await;
        assert_eq!(inputs.quality, RigInputs::GOOD);
        assert!(inputs.weight_on_bit_kn.is_nan());
        // The source timestamp, of this machine.
        let age = now() - inputs.header.stamp.to_nanoseconds();
        assert!((0..20_000_000_000).contains(&age), "{age}");
    }
    rig.set("Speed 91 UncertainSensorNotAccurate");
    let inputs = follower.inputs(30, |inputs| inputs.quality == RigInputs::SUSPECT).await;
    assert!((inputs.rotary_speed_rpm - 91.0).abs() < 1e-9);
    // A bad value is sent as bad, with the last number.
    rig.set("Speed none BadSensorFailure");
    let inputs = follower.inputs(30, |inputs| inputs.quality == RigInputs::BAD).await;
    assert!((inputs.rotary_speed_rpm - 91.0).abs() < 1e-9);
    // A value outside its range is left out.
    rig.set("Speed 900");
    let end = Instant::now() + Duration::from_secs(30);
    while follower.collector.counts.out_of_range == 0 {
        assert!(Instant::now() < end, "{:?}", follower.collector.counts);
        follower
            .until(30, |_, event| matches!(event, RigEvent::Value(_)).then_some(()))
            .await;
    }

    // The server dies and comes back at its port, and so do the values.
    let port = rig.port;
    drop(rig);
    let mut waits: Vec<Duration> = Vec::new();
    follower
        .until(60, |collector, event| {
            if let RigEvent::Waiting { wait, .. } = event {
                collector.forget();
                waits.push(*wait);
            }
            (waits.len() == 3).then_some(())
        })
        .await;
    assert_eq!(waits, [500, 1000, 2000].map(Duration::from_millis));
    let mut rig = Rig::start(&python, port);
    rig.set("Speed 33");
    let inputs = follower
        .inputs(60, |inputs| (inputs.rotary_speed_rpm - 33.0).abs() < 1e-9)
        .await;
    assert_eq!(inputs.quality, RigInputs::GOOD);
}
