//! `flexdrill bridge wits`: a line of WITS level 0 and the twin's topics.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use flexdrill_bridge::TwinFigures;
use flexdrill_bridge::lines::{self, LineState, Place, Times};
use flexdrill_bridge::wits::capture::{CaptureError, CaptureWriter};
use flexdrill_bridge::wits::{FrameUse, Line, LineEvent, Mapping, NotUsed, TwinFrames, shown};
use flexdrill_realtime::monotonic;
use flexdrill_text::{Throttles, printable};
use tokio::sync::{broadcast, mpsc};
use tokio::time::{MissedTickBehavior, interval};

use super::diagnosis::LineHealth;
use super::{BridgeNode, Outgoing};

/// Pieces of a line that wait to be read; beyond them the connection waits.
const QUEUE: usize = 64;
/// Frames of the twin that wait for a slow connection.
const OUTGOING: usize = 16;
/// Time between two messages on `/diagnostics`.
const DIAGNOSTICS: Duration = Duration::from_secs(1);
/// Least time between two log lines of one cause (s).
const LOG_INTERVAL: f64 = 10.0;

/// A line of WITS and the node that it is joined to.
pub struct WitsBridge {
    node: BridgeNode,
    node_name: String,
    place: String,
    mapping: Mapping,
    capture: Option<CaptureWriter>,
    connections: BTreeMap<u64, Line>,
    health: LineHealth,
    faults: Throttles<&'static str>,
}

impl WitsBridge {
    /// A bridge; `place` names the line. With `capture` the bytes of the line are kept.
    ///
    /// # Errors
    /// When the capture cannot be created.
    pub fn new(
        node: BridgeNode,
        node_name: String,
        place: String,
        mapping: Mapping,
        capture: Option<&Path>,
    ) -> Result<Self, CaptureError> {
        Ok(Self {
            node,
            node_name,
            place,
            mapping,
            capture: capture.map(CaptureWriter::create).transpose()?,
            connections: BTreeMap::new(),
            health: LineHealth::default(),
            faults: Throttles::new(LOG_INTERVAL),
        })
    }

    /// Runs until it is dropped.
    pub async fn run(&mut self, place: Place, times: Times) {
        let (sender, mut events) = mpsc::channel(QUEUE);
        let (outgoing, _) = broadcast::channel(OUTGOING);
        let mut writing = self
            .mapping
            .write
            .as_ref()
            .map(|write| TwinFrames::new(write, self.mapping.utc_offset()));
        let period = writing
            .as_ref()
            .map_or(DIAGNOSTICS, |frames| Duration::from_secs_f64(frames.interval()));
        let (mut diagnostics, mut write) = (interval(DIAGNOSTICS), interval(period));
        diagnostics.set_missed_tick_behavior(MissedTickBehavior::Delay);
        write.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut twin = TwinFigures::default();
        let mut line = std::pin::pin!(lines::run(place, times, sender, outgoing.clone()));
        loop {
            tokio::select! {
                () = &mut line => return,
                Some(event) = events.recv() => self.on(event),
                _ = diagnostics.tick() => {
                    let message = self.health.diagnostics(&self.node_name, &self.place, lines::now());
                    self.node.diagnose(&message);
                }
                _ = write.tick(), if writing.is_some() => {
                    let unreadable = self.node.take(|topic, body| twin.take(topic.name, body).is_ok());
                    if unreadable > 0 {
                        self.log("figures", || format!("{unreadable} messages of the twin could not be read"));
                    }
                    let frame = writing.as_mut().and_then(|frames| frames.frame(&twin, lines::now()));
                    // Without a connection the frame is dropped.
                    if let Some(frame) = frame
                        && outgoing.send(Arc::from(frame)).is_ok()
                    {
                        self.health.written[0] += 1;
                    }
                }
            }
        }
    }

    fn on(&mut self, event: LineState) {
        match event {
            LineState::Opened { connection, peer } => {
                self.health.open += 1;
                self.health.made += 1;
                tracing::info!("wits: connection {connection} with {}", printable(&peer));
                self.connections.insert(connection, Line::new(&self.mapping, &peer));
            }
            LineState::Bytes {
                connection,
                time,
                bytes,
            } => {
                self.keep(time, connection, &bytes);
                let Some(mut line) = self.connections.remove(&connection) else {
                    return;
                };
                let (mut read, mut counts) = (Vec::new(), self.health.counts);
                line.push(&bytes, time, &mut counts, |event| read.push(event));
                self.health.counts = counts;
                self.connections.insert(connection, line);
                for event in read {
                    self.take(event, time);
                }
            }
            LineState::Closed { connection, time, why } => {
                self.keep(time, connection, &[]);
                self.health.open = self.health.open.saturating_sub(1);
                self.health.last_loss.clone_from(&why);
                let mut cut = 0;
                if let Some(line) = self.connections.remove(&connection) {
                    let mut counts = self.health.counts;
                    line.finish(time, &mut counts, |event| {
                        if let LineEvent::Discarded(discarded) = event {
                            cut += discarded.bytes;
                        }
                    });
                    self.health.counts = counts;
                }
                let lost = match cut {
                    0 => "no frame was in flight".to_owned(),
                    bytes => format!("{bytes} bytes of an unfinished frame are lost"),
                };
                tracing::warn!("wits: connection {connection} ended: {}; {lost}", printable(&why));
            }
            LineState::Waiting { why, wait } => {
                self.health.last_loss.clone_from(&why);
                self.log("waiting", || {
                    format!(
                        "no connection ({}); the next attempt is in {} s",
                        printable(&why),
                        wait.as_secs_f64()
                    )
                });
            }
            LineState::Refused { peer } => self.log("refused", || {
                format!(
                    "a connection from {} was refused; at most {} are kept",
                    printable(&peer),
                    lines::MOST_CONNECTIONS
                )
            }),
            LineState::NotWritten { connection, frames } => {
                self.health.written[1] += frames;
                self.log("not written", || {
                    format!("connection {connection} takes the twin's frames too slowly; {frames} were left out")
                });
            }
        }
    }

    fn take(&mut self, event: LineEvent, arrived: i64) {
        let reading = match event {
            LineEvent::Discarded(discarded) => {
                return self.log(discarded.reason.name(), || {
                    format!(
                        "{}: {} bytes, beginning with \"{}\"",
                        discarded.reason.name(),
                        discarded.bytes,
                        shown(&discarded.sample)
                    )
                });
            }
            LineEvent::Frame(_, reading) => reading,
        };
        if let Some(inputs) = &reading.inputs {
            self.node.publish(Outgoing::Inputs, inputs);
        }
        if let Some(measured) = &reading.measured {
            self.node.publish(Outgoing::Measured, measured);
        }
        match reading.outcome {
            FrameUse::Used { .. } => self.health.used_at = Some(arrived),
            // Empty frames show life or ask for data; they are counted only.
            FrameUse::NotUsed(NotUsed::Empty) => {}
            FrameUse::NotUsed(reason) => self.log(reason.name(), || format!("a frame was not used: {}", reason.name())),
        }
        for fault in &reading.faults {
            self.log(fault.kind.name(), || fault.to_string());
        }
    }

    /// Keeps bytes in the capture. A disk that refuses them ends the capture and not the bridge.
    fn keep(&mut self, time: i64, connection: u64, bytes: &[u8]) {
        if let Some(capture) = &mut self.capture
            && let Err(error) = capture.write(time, connection, bytes)
        {
            tracing::error!("the capture ends: {error}");
            self.health.capture_failed = Some(error.to_string());
            self.capture = None;
        }
    }

    fn log(&mut self, cause: &'static str, text: impl FnOnce() -> String) {
        if let Some(more) = self.faults.ending(cause, monotonic::now() as f64 * 1e-9) {
            tracing::warn!("wits: {}{more}", text());
        }
    }
}
