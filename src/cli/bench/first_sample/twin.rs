//! The ends between which the time counts: a bridge as `flexdrill bridge wits` runs it, and the input of a twin, joined by
//! DDS on this machine.

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};
use tokio::sync::mpsc;

use crate::bridge::confirmations::Confirmations;
use crate::bridge::first_frames::FirstFrames;
use crate::bridge::wits::WitsBridge;
use crate::bridge::{BridgeNode, Outgoing};
use crate::node::clocks::Clocks;
use crate::node::inputs::RigInputs;
use crate::rig_inputs::DriverId;
use flexdrill_bridge::lines::{Place, Times};
use flexdrill_bridge::wits::Mapping;
use flexdrill_config::Config;
use flexdrill_messages::topics::RIG_INPUTS;
use flexdrill_messages::{RigInputs as RigInputsMessage, message_from_cdr_body};
use flexdrill_realtime::link::Targets;
use flexdrill_ros2::args::{NodeIdentity, Remapping};
use flexdrill_ros2::dds::network::{Network, Reach};
use flexdrill_ros2::dds::port::{Inbox, Port, PortBuilder, Sample};

/// Longest wait for an accepted sample: a recorder that answers only is asked after 10 s.
const PATIENCE: Duration = Duration::from_secs(60);
/// Time in which a sample that is under way arrives, so that it counts for no other line.
const UNDER_WAY: Duration = Duration::from_millis(300);

/// Both nodes.
pub(super) struct Ends {
    bridge: Option<BridgeNode>,
    samples: Arc<Inbox<Sample>>,
    /// DDS of the twin's end.
    _port: Port,
}

/// The input of a twin that has received nothing.
pub(super) fn input(config: &Config) -> RigInputs {
    let targets = Targets::new(config.simulation().initial_inputs);
    RigInputs::new(config, targets, Clocks::new(false))
}

impl Ends {
    /// Joins both on this machine, in a namespace of this process: made samples must drive no twin.
    ///
    /// # Errors
    /// When a variable of ROS 2 is wrong, or DDS does not start.
    pub(super) fn join() -> anyhow::Result<Self> {
        let (network, _) = Network::read(None, |name| std::env::var(name).ok())?;
        let network = network.configured(Some(Reach::Localhost), &[], &[])?;
        let namespace = format!("/flexdrill_bench_{}", std::process::id());
        let twin = NodeIdentity::new(&namespace, "twin")?;
        let mut port = PortBuilder::new(&network, &twin.namespace, &twin.name);
        let samples = port.subscription(&twin.expand(RIG_INPUTS.name)?, RIG_INPUTS.kind.dds_type, false);
        let port = port.start()?;
        let bridge = NodeIdentity::new(&namespace, "bridge")?;
        let name = bridge.name.clone();
        let remapping = Remapping::default();
        let bridge = BridgeNode::new(&network, &bridge, &remapping, &name, &Outgoing::OF_A_RIG, &[], None)?;
        Ok(Self {
            bridge: Some(bridge),
            samples,
            _port: port,
        })
    }

    /// Runs a bridge at a line from the moment at which `plug` plugs a recorder in, until the twin's input accepts a sample.
    /// Returns what `plug` made and the instant of that sample.
    ///
    /// # Errors
    /// When no sample is accepted in [`PATIENCE`].
    pub(super) async fn first_accepted<P>(
        &mut self,
        config: &Config,
        mapping: Mapping,
        place: Place,
        plug: impl FnOnce() -> P,
    ) -> anyhow::Result<(P, Instant)> {
        tokio::time::sleep(UNDER_WAY).await;
        while self.samples.pop().is_some() {}
        let node = self.bridge.take().context("the bridge's node is in use")?;
        let confirmations = Confirmations::new(None, b"", "made".to_owned());
        let first = FirstFrames::new(confirmations, false);
        let mut bridge = WitsBridge::new(
            node,
            "bridge".to_owned(),
            "made".to_owned(),
            mapping,
            None,
            first,
            |_| {},
        )?;
        let (_keys, confirm) = mpsc::channel(1);
        let input = input(config);
        let plugged = plug();
        let found = tokio::select! {
            () = bridge.run(place, Times::default(), confirm) => None,
            found = tokio::time::timeout(PATIENCE, accepted(&self.samples, &input)) => found.ok(),
        };
        self.bridge = Some(bridge.into_node());
        let Some(instant) = found else {
            bail!("no sample was accepted in {} s", PATIENCE.as_secs());
        };
        Ok((plugged, instant))
    }
}

/// The instant at which the input has accepted a sample.
async fn accepted(samples: &Inbox<Sample>, input: &RigInputs) -> Instant {
    loop {
        let Sample::Body { writer, body } = samples.next().await else {
            continue;
        };
        let Ok(message) = message_from_cdr_body::<RigInputsMessage>(&body) else {
            continue;
        };
        if message.given != 0 && input.accept_stamped(&message, DriverId(writer)).is_empty() {
            return Instant::now();
        }
    }
}
