//! The twin as a server.

use std::time::Duration;

use flexdrill_bridge::lines::{BackOff, now};
use flexdrill_bridge::messages::rig_inputs;
use flexdrill_bridge::opcua::client::WAIT;
use flexdrill_bridge::opcua::event::ServerEvent;
use flexdrill_bridge::opcua::server::{self, Setup};
use flexdrill_bridge::opcua::state::TwinState;
use flexdrill_messages::RigInputs;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;
use flexdrill_text::printable;
use tokio::net::TcpListener;
use tokio::sync::mpsc;
use tokio::time::{Instant, MissedTickBehavior, interval};

use super::diagnosis::ServerHealth;
use super::{DIAGNOSTICS, QUEUE, info, warn};
use crate::bridge::{BridgeNode, Outgoing};

/// Time between two looks at the twin's messages: clients may sample every 0.1 s.
const UPDATE: Duration = Duration::from_millis(100);
/// A server that ran for so long begins with the shortest wait again.
const SETTLED: Duration = Duration::from_secs(60);

/// Our server and the node that it is joined to.
pub struct ServerBridge {
    node: BridgeNode,
    node_name: String,
    place: String,
    setup: Setup,
    twin: TwinState,
    health: ServerHealth,
}

impl ServerBridge {
    /// A server; `place` is its address for people.
    pub fn new(node: BridgeNode, node_name: String, place: String, setup: Setup) -> Self {
        Self {
            node,
            node_name,
            place,
            setup,
            twin: TwinState::default(),
            health: ServerHealth::default(),
        }
    }

    /// Runs until it is dropped. A server that ends is restarted.
    pub async fn run(&mut self, listener: &TcpListener) {
        let mut back_off = BackOff::new(WAIT);
        loop {
            let began = Instant::now();
            let why = self.serve(listener).await;
            if began.elapsed() > SETTLED {
                back_off.reset();
            }
            let wait = back_off.next_wait();
            self.health.restarts += 1;
            self.health.open = 0;
            self.health.last_fault.clone_from(&why);
            warn("the server restarts", || {
                format!(
                    "the server restarts in {} s and its clients have to connect again: {}",
                    wait.as_secs_f64(),
                    printable(&why)
                )
            });
            self.diagnose();
            tokio::time::sleep(wait).await;
        }
    }

    /// One life of the server; returns why it ended.
    async fn serve(&mut self, listener: &TcpListener) -> String {
        let (sender, mut events) = mpsc::channel(QUEUE);
        // A fault of the preparation ends this life; the caller waits and tries again with the same listener.
        let (mut server, prepared) = match server::prepare(&self.setup, sender).await {
            Ok(prepared) => prepared,
            Err(error) => return error.to_string(),
        };
        self.health.last_fault.clear();
        let (mut update, mut diagnostics) = (interval(UPDATE), interval(DIAGNOSTICS));
        // One update after a pause replaces all that were missed.
        update.set_missed_tick_behavior(MissedTickBehavior::Delay);
        diagnostics.set_missed_tick_behavior(MissedTickBehavior::Delay);
        // The server runs inside this future, so that returning from it closes all sessions.
        let mut running = std::pin::pin!(prepared.run(listener));
        loop {
            tokio::select! {
                why = &mut running => return why,
                Some(event) = events.recv() => self.on(event),
                _ = update.tick() => {
                    // One instant for all values of an update: clients compare source times.
                    let at = now();
                    let (twin, health) = (&mut self.twin, &mut self.health);
                    health.unreadable += self.node.take(|topic, body| {
                        health.twin_at = Some(at);
                        twin.take(topic, body, at).is_ok()
                    });
                    // A refused value means that the address space and the figures
                    // differ, which only a new life can repair.
                    if let Err(status) = server.update(twin, at) {
                        return format!("a value of the twin was refused: {status}");
                    }
                }
                _ = diagnostics.tick() => {
                    let rejected = self.setup.keys.rejected() as u64;
                    // The count comes from the folder of rejected certificates.
                    // Only a rise is logged, because the files stay.
                    if rejected > self.health.certificates_rejected {
                        let folder = self.setup.keys.folder().display();
                        warn("certificate", || {
                            format!(
                                "a client's certificate is not trusted; if it should be, move it from {folder}/rejected to \
                                 {folder}/trusted"
                            )
                        });
                    }
                    self.health.certificates_rejected = rejected;
                    self.diagnose();
                }
            }
        }
    }

    fn diagnose(&self) {
        let message = self.health.diagnostics(&self.node_name, &self.place, now());
        self.node.diagnose(&message);
    }

    fn on(&mut self, event: ServerEvent) {
        match event {
            ServerEvent::Opened { peer } => {
                self.health.open += 1;
                self.health.opened += 1;
                info("opened", || format!("connection from {peer}"));
            }
            // Saturating: `Opened` is dropped when the queue is full, and its `Closed` then comes alone.
            ServerEvent::Closed => self.health.open = self.health.open.saturating_sub(1),
            ServerEvent::Refused { peer } => {
                self.health.refused += 1;
                warn("refused", || {
                    format!("a connection from {peer} was refused, because it or all clients have too many")
                });
            }
            ServerEvent::NotOpcUa { peer } => {
                // Counted apart from refusals: port scanners cause these, and no client has to be helped.
                self.health.not_opcua += 1;
                warn("not opcua", || {
                    format!("a connection from {peer} did not begin as OPC UA and was closed")
                });
            }
            ServerEvent::NotAccepted => warn("not accepted", || {
                "the system refuses connections; are all handles in use?".to_owned()
            }),
            ServerEvent::LoginRefused { user } => {
                self.health.logins_refused += 1;
                warn("login", || {
                    format!("user \"{}\" or the password is wrong", printable(&user))
                });
            }
            ServerEvent::Written { quantity, value, user } => {
                self.health.targets_written += 1;
                // The stamp is the bridge's: a client's clock is not known to agree with the rig's.
                let header = Header {
                    stamp: Time::from_nanoseconds(now()),
                    ..Header::default()
                };
                let source = format!("opcua user {user}");
                // One target per message. The others stay out of it, so that an old value of theirs cannot return.
                let only = |of| (of == quantity).then_some(value);
                if let Some(inputs) = rig_inputs(only, header, RigInputs::GOOD, &source) {
                    self.node.publish(Outgoing::Inputs, &inputs);
                }
                info("written", || {
                    let unit = quantity.dimension().si();
                    format!("user \"{}\" wrote {quantity} {value} {unit}", printable(&user))
                });
            }
        }
    }
}
