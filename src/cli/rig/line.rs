//! A line of WITS level 0 that a demonstration rig writes.

use anyhow::Context as _;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tokio::sync::{broadcast, mpsc};
use tokio::task::JoinSet;

use super::Batch;
use crate::cli::output::say;
use flexdrill_bridge::lines::{self, LineState, Place, Seats, Times};
use flexdrill_bridge::wits::{Mapping, RigFrames};
use flexdrill_bridge::{Quantity, SurveyKind};
use flexdrill_core::inputs::InputKind;
use flexdrill_messages::RigSurvey;
use flexdrill_outputs::MeasuredValues as _;
use flexdrill_text::printable;

/// Frames that wait for a slow reader.
const WAITING: usize = 16;
/// Events that wait to be logged.
const EVENTS: usize = 64;

/// A line that is open for as long as this lives.
pub(super) struct WitsLine {
    address: SocketAddr,
    frames: RigFrames,
    outgoing: broadcast::Sender<Arc<[u8]>>,
    connections: Arc<AtomicU64>,
    _tasks: JoinSet<()>,
}

impl WitsLine {
    /// Listens at an address and reports connections. `map` is the file of items, without which they are the usual ones;
    /// `well` is the name in the headers.
    ///
    /// # Errors
    /// When the file cannot be read, or the address cannot be listened at.
    pub(super) async fn open(address: SocketAddr, map: Option<&Path>, well: &str) -> anyhow::Result<Self> {
        let mapping = map.map_or_else(|| Ok(Mapping::default()), Mapping::load)?;
        let listening = tokio::net::TcpListener::bind(address).await;
        let listener = listening.with_context(|| format!("--wits {address}"))?;
        let address = listener.local_addr()?;
        let (outgoing, _) = broadcast::channel(WAITING);
        let (sender, events) = mpsc::channel(EVENTS);
        let times = Times {
            // A reader sends nothing.
            silence: None,
            ..Times::default()
        };
        let connections = Arc::new(AtomicU64::new(0));
        let mut tasks = JoinSet::new();
        let place = Place::Listen(listener);
        tasks.spawn(lines::run(
            place,
            times,
            None,
            sender,
            outgoing.clone(),
            Seats::default(),
        ));
        tasks.spawn(tell(events, Arc::clone(&connections)));
        Ok(Self {
            address,
            frames: RigFrames::new(&mapping, well),
            outgoing,
            connections,
            _tasks: tasks,
        })
    }

    /// Where it listens.
    pub(super) fn address(&self) -> SocketAddr {
        self.address
    }

    /// Connections that are open.
    pub(super) fn connections(&self) -> u64 {
        self.connections.load(Ordering::Relaxed)
    }

    /// Writes the values that are due as one frame at an instant (ns since 1970). Returns how many samples that were, none
    /// without a connection.
    pub(super) fn send(&mut self, batch: &Batch<'_>, now: i64) -> u64 {
        let input = |kind: InputKind| batch.inputs[kind.index()].map(|value| kind.to_si(value));
        let measured = |kind| batch.measured.values().find_map(|message| message.value(kind));
        let values = |quantity: Quantity| match quantity {
            Quantity::Survey(kind) => batch.surveys.last().and_then(|survey| surveyed(survey, kind)),
            Quantity::Measured(kind) => measured(kind).or_else(|| input(quantity.input()?)),
            _ => input(quantity.input()?),
        };
        // A frame has one record of surveys: the newest.
        let surveys = batch.surveys.len().min(1);
        let samples = batch.inputs.iter().flatten().count() + batch.measured.len() + surveys;
        let Some(frame) = self.frames.frame(now, values) else {
            return 0;
        };
        let written = self.outgoing.send(Arc::from(frame)).is_ok();
        if written { samples as u64 } else { 0 }
    }
}

/// Tells who comes and leaves.
async fn tell(mut events: mpsc::Receiver<LineState>, connections: Arc<AtomicU64>) {
    while let Some(event) = events.recv().await {
        match event {
            LineState::Opened { connection, peer, .. } => {
                connections.fetch_add(1, Ordering::Relaxed);
                say!("connection {connection} with {}", printable(&peer));
            }
            LineState::Closed { connection, why, .. } => {
                connections.fetch_sub(1, Ordering::Relaxed);
                say!("connection {connection} ended: {}", printable(&why));
            }
            LineState::Refused { peer } => say!(
                "a connection from {} was refused; at most {} are kept",
                printable(&peer),
                lines::MOST_CONNECTIONS
            ),
            LineState::NotWritten { connection, frames } => {
                say!("connection {connection} reads too slowly; {frames} frames were left out");
            }
            LineState::Waiting { why, wait } => {
                say!("{}; the next attempt is in {} s", printable(&why), wait.as_secs_f64());
            }
            // What a reader sends has no meaning here.
            LineState::Asked { .. } | LineState::Bytes { .. } => {}
        }
    }
}

/// A value of a survey (SI), if it has it.
fn surveyed(survey: &RigSurvey, kind: SurveyKind) -> Option<f64> {
    let value = match kind {
        SurveyKind::Depth => survey.measured_depth,
        SurveyKind::Inclination => survey.inclination,
        SurveyKind::Azimuth => survey.azimuth,
    };
    (!value.is_nan()).then_some(value)
}
