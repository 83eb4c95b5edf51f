//! `flexdrill bridge wits`: a line of WITS level 0 and the twin's topics.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use flexdrill_bridge::TwinFigures;
use flexdrill_bridge::lines::{self, LineState, Place, Seats, Times};
use flexdrill_bridge::wits::capture::{CaptureError, CaptureWriter};
use flexdrill_bridge::wits::{
    FrameUse, Line, LineEvent, Mapping, NotUsed, RawFrame, Reading, Refused, Sources, TwinFrames, shown,
};
use flexdrill_messages::{ConfirmMappingRequest, ConfirmMappingResponse, RigInputs, RigMeasured, RigSurvey};
use flexdrill_ros2::service::ServiceServer;
use flexdrill_text::{counted, log_ending, printable};
use tokio::sync::{broadcast, mpsc, oneshot};
use tokio::time::{MissedTickBehavior, interval};

use super::diagnosis::LineHealth;
use super::first_frames::FirstFrames;
use super::{BridgeNode, Outgoing};

/// Pieces of a line that wait to be read; beyond them the connection waits.
const QUEUE: usize = 64;
/// Frames of the twin that wait for a slow connection.
const OUTGOING: usize = 16;
/// Time between two messages on `/diagnostics`.
const DIAGNOSTICS: Duration = Duration::from_secs(1);

/// A line of WITS and the node that it is joined to.
pub struct WitsBridge {
    node: BridgeNode,
    node_name: String,
    place: String,
    mapping: Mapping,
    capture: Option<CaptureWriter>,
    connections: BTreeMap<u64, Connection>,
    /// Which connection serves each quantity.
    sources: Sources,
    health: LineHealth,
    /// What the mapping makes of the first frames, and for which sources a person has confirmed it.
    first: FirstFrames,
    /// Shows the first frame of a connection to people.
    show: fn(&str),
}

struct Connection {
    line: Line,
    /// Its other end with the port.
    address: String,
    /// It was silent and was asked, and has not answered yet.
    asked: bool,
}

/// A request for a confirmation, and where its answer goes.
type Asked = (ConfirmMappingRequest, oneshot::Sender<ConfirmMappingResponse>);

impl WitsBridge {
    /// A bridge; `place` names the line. With `capture` the bytes of the line are kept. `show` prints for people what the
    /// mapping makes of the first frame of a connection. Values of a source for which no person has confirmed the mapping
    /// are marked as suspect.
    ///
    /// # Errors
    /// When the capture cannot be created.
    pub fn new(
        node: BridgeNode,
        node_name: String,
        place: String,
        mapping: Mapping,
        capture: Option<&Path>,
        first: FirstFrames,
        show: fn(&str),
    ) -> Result<Self, CaptureError> {
        Ok(Self {
            node,
            node_name,
            place,
            mapping,
            capture: capture.map(CaptureWriter::create).transpose()?,
            connections: BTreeMap::new(),
            sources: Sources::default(),
            health: LineHealth::default(),
            first,
            show,
        })
    }

    /// The node, after the bridge has run.
    pub fn into_node(self) -> BridgeNode {
        self.node
    }

    /// Runs until it is dropped. Each message on `confirm` is a person's confirmation of what was shown.
    pub async fn run(&mut self, place: Place, times: Times, mut confirm: mpsc::Receiver<()>) {
        let (sender, mut events) = mpsc::channel(QUEUE);
        let (outgoing, _) = broadcast::channel(OUTGOING);
        let mut writing = self
            .mapping
            .write
            .as_ref()
            .map(|write| TwinFrames::new(write, self.mapping.utc_offset()));
        // Without frames to write the timer exists for the `select` alone, whose branch is then off.
        let period = writing
            .as_ref()
            .map_or(DIAGNOSTICS, |frames| Duration::from_secs_f64(frames.interval()));
        let (mut diagnostics, mut write) = (interval(DIAGNOSTICS), interval(period));
        // After a pause of the machine one tick follows, not a burst of those
        // that were missed: each would write the same values.
        diagnostics.set_missed_tick_behavior(MissedTickBehavior::Delay);
        write.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut twin = TwinFigures::default();
        let seats = Seats::default();
        let (ask, mut asked) = mpsc::channel::<Asked>(1);
        let (service, server) = self.node.take_server().unzip();
        let service = service.unwrap_or_default();
        let mut serving = std::pin::pin!(serve(server, ask));
        // The line lives in this task, not in another: when `run` is dropped its connections close with it.
        let mut line = std::pin::pin!(lines::run(
            place,
            times,
            self.mapping.ask(),
            sender,
            outgoing.clone(),
            seats.clone()
        ));
        loop {
            tokio::select! {
                () = &mut line => return,
                Some(event) = events.recv() => self.on(event, &seats),
                () = &mut serving => return,
                Some(()) = confirm.recv() => {
                    if self.first.confirm_shown("a person at the bridge's terminal", lines::now()) == 0 {
                        tracing::info!("wits: no source waits for a confirmation");
                    }
                }
                Some((request, answer)) = asked.recv() => {
                    // A client that has gone misses the answer alone.
                    let _ = answer.send(self.first.answer(&request, lines::now()));
                }
                _ = diagnostics.tick() => {
                    // The dispute ends by time, not by an event, so it is looked up at each tick.
                    self.health.disputed = self.sources.is_disputed(lines::now());
                    self.health.unconfirmed = self.first.unconfirmed();
                    let mut message = self.health.diagnostics(&self.node_name, &self.place, lines::now());
                    message.status.extend(self.first.diagnostics(&self.node_name, &service));
                    self.node.diagnose(&message);
                }
                _ = write.tick(), if writing.is_some() => {
                    let unreadable = self.node.take(|topic, body| twin.take(topic.name, body).is_ok());
                    if unreadable > 0 {
                        log("figures", || format!("{} of the twin could not be read", counted(unreadable, "message")));
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

    fn on(&mut self, event: LineState, seats: &Seats) {
        match event {
            LineState::Opened {
                connection,
                peer,
                address,
            } => {
                self.health.open += 1;
                self.health.made += 1;
                // The peer is foreign text; `printable` keeps control characters out of the log.
                if let Some(more) = log_ending("wits connection made") {
                    tracing::info!("wits: connection {connection} with {}{more}", printable(&address));
                }
                let line = Line::new(&self.mapping, &peer);
                self.first.opened(connection, peer, address.clone());
                let opened = Connection {
                    line,
                    address,
                    asked: false,
                };
                self.connections.insert(connection, opened);
            }
            LineState::Asked { connection } => {
                if let Some(asked) = self.connections.get_mut(&connection) {
                    asked.asked = true;
                }
                log("asked", || {
                    format!(
                        "connection {connection} has sent no frame yet. Some recorders send only in answer to a packet, so \
                         the bridge sends one. If no frame follows, check that the recorder's WITS output is on"
                    )
                });
            }
            LineState::Bytes {
                connection,
                time,
                bytes,
            } => {
                // The raw bytes are kept before they are read, so that a capture has what the reader could not use.
                self.keep(time, connection, &bytes);
                let Some(from) = self.connections.get_mut(&connection) else {
                    return;
                };
                // Events are gathered first, because the line borrows the connection that `take` needs.
                let mut read = Vec::new();
                from.line
                    .push(&bytes, time, &mut self.health.counts, |event| read.push(event));
                for event in read {
                    // Only whole frames hold a seat. A scanner that connects and sends noise must yield to the rig.
                    if matches!(event, LineEvent::Frame(..)) {
                        seats.whole_frame(connection);
                    }
                    self.take(connection, event, time);
                }
            }
            LineState::Closed { connection, time, why } => self.closed(connection, time, &why),
            LineState::Waiting { why, wait } => {
                // The reason stays in the diagnostics; the log is limited in
                // its rate, because a rig may be away for days.
                self.health.last_loss.clone_from(&why);
                log("waiting", || {
                    format!(
                        "no connection ({}); the next attempt is in {} s",
                        printable(&why),
                        wait.as_secs_f64()
                    )
                });
            }
            LineState::Refused { peer } => log("refused", || {
                format!(
                    "a connection from {} was refused; at most {} are kept",
                    printable(&peer),
                    lines::MOST_CONNECTIONS
                )
            }),
            LineState::NotWritten { connection, frames } => {
                // Frames are dropped for a slow peer and never queued: the rig's next frame replaces them anyway.
                self.health.written[1] += frames;
                log("not written", || {
                    format!("connection {connection} takes the twin's frames too slowly; {frames} were left out")
                });
            }
        }
    }

    fn closed(&mut self, connection: u64, time: i64, why: &str) {
        self.keep(time, connection, &[]);
        self.sources.closed(connection);
        self.first.closed(connection);
        self.health.open = self.health.open.saturating_sub(1);
        why.clone_into(&mut self.health.last_loss);
        let mut cut = 0;
        if let Some(Connection { line, .. }) = self.connections.remove(&connection) {
            line.finish(time, &mut self.health.counts, |event| {
                if let LineEvent::Discarded(discarded) = event {
                    cut += discarded.bytes;
                }
            });
        }
        let lost = match cut {
            0 => "no frame was in flight".to_owned(),
            bytes => format!("lost: {} of an unfinished frame", counted(bytes, "byte")),
        };
        log("connection ended", || {
            format!("connection {connection} ended: {}; {lost}", printable(why))
        });
    }

    fn take(&mut self, connection: u64, event: LineEvent, arrived: i64) {
        let mut reading = match event {
            LineEvent::Discarded(discarded) => {
                return log(discarded.reason.name(), || {
                    format!(
                        "{}: {} bytes, beginning with \"{}\"",
                        discarded.reason.name(),
                        discarded.bytes,
                        shown(&discarded.sample)
                    )
                });
            }
            LineEvent::Frame(frame, reading) => {
                self.show_first(connection, &frame, reading.outcome);
                reading
            }
        };
        for seen in &reading.records {
            if let Some(defect) = seen.defect {
                log("sequence defect", || {
                    format!("connection {connection}: item {:02}04 {}", seen.record, defect.words())
                });
            }
        }
        if let Some(clock) = reading.clock {
            log("clock", || {
                format!(
                    "connection {connection}: the rig's clock shows another time zone than the mapping says; set \
                     `utc_offset_h: {}`",
                    clock.utc_offset_h
                )
            });
        }
        if let Some(refused) = self.sources.sort(connection, arrived, &mut reading) {
            self.refused(connection, &refused);
        }
        if !self.first.is_confirmed(connection) {
            mark_as_suspect(&mut reading);
        }
        if let Some(inputs) = &reading.inputs {
            self.node.publish(Outgoing::Inputs, inputs);
        }
        if let Some(measured) = &reading.measured {
            self.node.publish(Outgoing::Measured, measured);
        }
        if let Some(survey) = &reading.survey {
            self.node.publish(Outgoing::Survey, survey);
        }
        match reading.outcome {
            FrameUse::Used { .. } => {
                self.health.used_at = Some(arrived);
                self.answered(connection);
            }
            // Empty frames show life or ask for data; they are counted only.
            FrameUse::NotUsed(NotUsed::Empty) => {}
            FrameUse::NotUsed(reason) => log(reason.name(), || format!("a frame was not used: {}", reason.name())),
        }
        for fault in &reading.faults {
            log(fault.kind.name(), || fault.to_string());
        }
    }

    /// Shows what the mapping makes of the first frame of a connection.
    fn show_first(&mut self, connection: u64, frame: &RawFrame, outcome: FrameUse) {
        // A frame without an item has nothing to compare.
        if outcome == FrameUse::NotUsed(NotUsed::Empty) {
            return;
        }
        if let Some(text) = self.first.frame(connection, frame, &self.mapping, lines::now()) {
            (self.show)(&text);
        }
    }

    /// Says that a recorder sends in answer only, after its first frame.
    fn answered(&mut self, connection: u64) {
        let found = self.connections.get_mut(&connection).filter(|found| found.asked);
        let Some(found) = found else { return };
        found.asked = false;
        log("answers", || {
            format!(
                "connection {connection} ({}) answers: its recorder sends on request, so the bridge continues to ask every \
                 30 s. With `ask: {{every_s: 30}}` in the mapping it asks at once; a recorder that answers each request with \
                 one frame needs `every_s: 1`",
                printable(&found.address)
            )
        });
    }

    /// Reports values of a second source.
    fn refused(&mut self, connection: u64, refused: &Refused) {
        self.health.second_source += refused.quantities.len() as u64;
        let peer = |connection| {
            let known = self.connections.get(&connection);
            known.map_or("?", |known| known.address.as_str())
        };
        let names: Vec<&str> = refused.quantities.iter().map(|quantity| quantity.name()).collect();
        let text = format!(
            "connection {connection} ({}) also sends {}, which connection {} ({}) serves; its values are refused until that \
             one has been silent for 10 s. Stop one of the two, or leave its items out in the mapping",
            printable(peer(connection)),
            names.join(", "),
            refused.serving,
            printable(peer(refused.serving))
        );
        self.health.second_text.clone_from(&text);
        log("second source", || text);
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
}

/// Serves requests for confirmations, for as long as it is polled: passes them on and waits for the answers. Without a server it
/// waits.
async fn serve(server: Option<ServiceServer>, ask: mpsc::Sender<Asked>) {
    let Some(server) = server else {
        return std::future::pending().await;
    };
    let handler = move |request: ConfirmMappingRequest| {
        let ask = ask.clone();
        async move {
            let (answer, answered) = oneshot::channel();
            // Sending fails only where the bridge has ended; then the answer fails, too.
            let _ = ask.send((request, answer)).await;
            answered.await.unwrap_or_else(|_| ConfirmMappingResponse {
                success: false,
                message: "the bridge is ending".to_owned(),
            })
        }
    };
    server.serve(handler).await;
}

/// Marks the values of a frame whose mapping no person has confirmed: they drive the twin, and are shown as doubtful. The twin
/// uses no survey of it.
fn mark_as_suspect(reading: &mut Reading) {
    if let Some(inputs) = reading
        .inputs
        .as_mut()
        .filter(|inputs| inputs.quality == RigInputs::GOOD)
    {
        inputs.quality = RigInputs::SUSPECT;
    }
    if let Some(measured) = reading
        .measured
        .as_mut()
        .filter(|measured| measured.quality == RigMeasured::GOOD)
    {
        measured.quality = RigMeasured::SUSPECT;
    }
    if let Some(survey) = reading
        .survey
        .as_mut()
        .filter(|survey| survey.quality == RigSurvey::GOOD)
    {
        survey.quality = RigSurvey::SUSPECT;
    }
}

/// One warning per cause in ten seconds.
fn log(cause: &'static str, text: impl FnOnce() -> String) {
    if let Some(more) = log_ending(cause) {
        tracing::warn!("wits: {}{more}", text());
    }
}
