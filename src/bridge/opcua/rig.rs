//! A rig's server as a source of the twin's inputs.

use std::sync::atomic::Ordering;
use std::time::Duration;

use flexdrill_bridge::lines::now;
use flexdrill_bridge::opcua::client::{Place, RigClient, RigEvent};
use flexdrill_bridge::opcua::mapping::NodeMapping;
use flexdrill_bridge::opcua::values::Collector;
use flexdrill_text::printable;
use tokio::sync::mpsc;
use tokio::time::{MissedTickBehavior, interval};

use super::diagnosis::RigHealth;
use super::{DIAGNOSTICS, QUEUE, info, warn};
use crate::bridge::{BridgeNode, Outgoing};

/// Time in which values that belong together come.
const GATHER: Duration = Duration::from_millis(20);
/// A server without a sign of life for so long (ns) says nothing about the present: it is asked every two seconds.
const ALIVE: i64 = 5_000_000_000;

/// A rig's server and the node that it is joined to.
pub struct RigBridge {
    node: BridgeNode,
    node_name: String,
    url: String,
    collector: Collector,
    health: RigHealth,
}

impl RigBridge {
    /// A bridge from the server at `url`.
    pub fn new(node: BridgeNode, node_name: String, url: &str, mapping: &NodeMapping) -> Self {
        Self {
            node,
            node_name,
            url: url.to_owned(),
            collector: Collector::new(mapping, url.trim_start_matches("opc.tcp://")),
            health: RigHealth::default(),
        }
    }

    /// Runs until it is dropped.
    pub async fn run(&mut self, place: Place, mapping: &NodeMapping) {
        let (sender, mut events) = mpsc::channel(QUEUE);
        let client = RigClient::new(place, mapping, sender);
        let lost = client.lost();
        let (mut gather, mut diagnostics) = (interval(GATHER), interval(DIAGNOSTICS));
        gather.set_missed_tick_behavior(MissedTickBehavior::Delay);
        diagnostics.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut running = std::pin::pin!(client.run());
        loop {
            tokio::select! {
                () = &mut running => return,
                Some(event) = events.recv() => self.on(event),
                _ = gather.tick() => self.send(),
                _ = diagnostics.tick() => {
                    self.health.lost = lost.load(Ordering::Relaxed);
                    self.health.counts = self.collector.counts;
                    let message = self.health.diagnostics(&self.node_name, &self.url, now());
                    self.node.diagnose(&message);
                }
            }
        }
    }

    fn send(&mut self) {
        let now = now();
        let heard = self.health.heard_at.is_some_and(|at| now.saturating_sub(at) <= ALIVE);
        for (inputs, measured) in self.collector.due(now, heard && self.health.connected) {
            if let Some(inputs) = inputs {
                self.node.publish(Outgoing::Inputs, &inputs);
                self.health.published[0] += 1;
            }
            if let Some(measured) = measured {
                self.node.publish(Outgoing::Measured, &measured);
                self.health.published[1] += 1;
            }
        }
        if let Some(survey) = self.collector.survey_due(now) {
            self.node.publish(Outgoing::Survey, &survey);
        }
    }

    fn on(&mut self, event: RigEvent) {
        match event {
            RigEvent::Opened {
                connection,
                nodes,
                policy,
            } => {
                // `connected` and the nodes are of this connection; the other counts run since the start.
                self.health.connected = true;
                self.health.connections_made += 1;
                self.health.nodes[0] = nodes as u64;
                // Opening counts as hearing: a server whose values do not
                // change sends nothing until its first keep-alive.
                self.health.heard_at = Some(now());
                info("connected", || {
                    format!("connection {connection} follows {nodes} nodes; security policy {policy}")
                });
            }
            // One missing node does not end the session, since the other quantities are of use without it.
            RigEvent::NotFollowed { node, status } => {
                self.health.nodes[1] += 1;
                warn("not followed", || {
                    format!("node {} is not followed: {status}", printable(&node))
                });
            }
            RigEvent::Value(raw) => {
                // A value that is refused also proves that the server lives.
                self.health.heard_at = Some(raw.arrived);
                if let Err(fault) = self.collector.take(&raw) {
                    warn(fault.name(), || printable(&fault.to_string()).into_owned());
                }
            }
            RigEvent::Alive(at) => self.health.heard_at = Some(at),
            RigEvent::Closed { connection, why } => {
                // Held values would be repeated as present ones, though nothing says that they are.
                self.collector.forget();
                self.health.connected = false;
                self.health.nodes = [0; 2];
                self.health.last_loss.clone_from(&why);
                warn("connection ended", || {
                    format!("connection {connection} ended: {}", printable(&why))
                });
            }
            RigEvent::Waiting { why, wait } => {
                self.health.attempts_failed += u64::from(why != self.health.last_loss || !self.health.connected);
                self.health.nodes = [0; 2];
                self.health.last_loss.clone_from(&why);
                warn("waiting", || {
                    format!(
                        "no connection ({}); the next attempt is in {} s",
                        printable(&why),
                        wait.as_secs_f64()
                    )
                });
            }
        }
    }
}
