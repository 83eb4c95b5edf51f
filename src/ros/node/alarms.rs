//! Alarms in the node: conditions from the publisher's side, requests by service, and the state over a restart.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, PoisonError};

use tokio::sync::oneshot;

use super::publish::{self, Beside, PublisherParts};
use crate::alarms::state_file::{self, StateError, StateWriter};
use crate::alarms::{AlarmBook, NodeState, RecordingState, Request};
use crate::dds::port::PortBuilder;
use crate::messages::outputs::Encoded;
use crate::messages::std_msgs::Header;
use crate::messages::{
    AcknowledgeAlarmRequest, AcknowledgeAlarmResponse, Alarm, AlarmEvent, AlarmList, CdrError, ShelveAlarmRequest,
    ShelveAlarmResponse, UnshelveAlarmRequest, UnshelveAlarmResponse, words,
};
use crate::ros::NodeError;
use crate::ros::parameters::Task;
use crate::ros::service::{ServiceMapping, ServiceServer};
use flexdrill_alarms::{Refusal, Saved, Time};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::inputs::InputKind;
use flexdrill_core::twin::Snapshot;

/// A request on its way to the publisher, which keeps the alarms.
pub struct Asked {
    request: Request,
    answer: oneshot::Sender<Result<String, Refusal>>,
}

/// The alarms of a node, on the publisher's thread.
pub struct AlarmDesk {
    book: AlarmBook,
    asked: Receiver<Asked>,
    /// Writes what is kept over a restart, and the newest event that it has.
    writer: Option<(StateWriter, u64)>,
}

impl AlarmDesk {
    /// Alarms as a run before has left them in `state_file`, or all normal. What is wrong with the file is logged.
    pub fn new(config: Arc<Config>, state_file: Option<&Path>, asked: Receiver<Asked>, time: Time) -> Self {
        let (saved, writer) = match state_file.map(open) {
            Some((saved, writer)) => (saved, writer),
            None => (None, None),
        };
        let book = AlarmBook::new(Arc::clone(&config), saved.as_ref(), time).unwrap_or_else(|error| {
            tracing::warn!("{error}; all alarms begin as normal");
            AlarmBook::fresh(config, time)
        });
        Self {
            book,
            asked,
            writer: writer.map(|writer| (writer, 0)),
        }
    }

    /// Takes over limits and rules that have changed.
    pub fn reconfigure(&mut self, config: &Arc<Config>) {
        self.book.reconfigure(config);
    }

    /// Takes the hazards of a snapshot, at its stamp.
    pub fn observe_tool(&mut self, snapshot: &Snapshot, stamp: Time) {
        self.book.observe_tool(snapshot, stamp);
    }

    /// Takes the node's own state, at the present time on the rig's clock.
    pub fn observe_node(&mut self, state: &NodeState<'_>, time: Time) {
        self.book.advance(time);
        self.book.observe_node(state, time);
    }

    /// Answers what has been asked, at the present time on the rig's clock.
    pub fn answer(&mut self, time: impl Fn() -> Time) {
        while let Ok(asked) = self.asked.try_recv() {
            let answer = self.book.request(&asked.request, time());
            // The client may have gone meanwhile.
            let _ = asked.answer.send(answer);
        }
    }

    /// Whether there is something to publish, at an instant of a steady clock (ns).
    pub fn is_due(&self, clock: u64) -> bool {
        self.book.is_due(clock as Time)
    }

    /// Publishes events and list, logs what calls for somebody, and keeps what has changed.
    ///
    /// # Errors
    /// When a message cannot be encoded.
    pub fn publish(
        &mut self,
        header: Header,
        clock: u64,
        send: impl FnMut(Encoded<'_>) -> Result<(), CdrError>,
    ) -> Result<(), CdrError> {
        let events = self.book.publish(header, clock as Time, send)?;
        for event in &events {
            log(event);
        }
        if let (Some(newest), Some((writer, written))) = (events.last(), &mut self.writer)
            && newest.sequence > *written
        {
            writer.save(self.book.save());
            *written = newest.sequence;
        }
        Ok(())
    }

    /// All alarms as they stand.
    pub fn list(&self, header: Header) -> AlarmList {
        self.book.list(header)
    }
}

/// Judges the alarms of the node itself. They follow the wall clock, so that they go on when the model does not.
pub(super) fn judge_node(parts: &mut PublisherParts, failure: Option<StepFailure>, real_time_factor: Option<f64>) {
    let conditioner = parts.conditioner.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let now = (parts.now)();
    let drivers = {
        let intake = parts.intake.lock().unwrap_or_else(PoisonError::into_inner);
        InputKind::ALL.map(|kind| intake.drivers.summary(kind, now))
    };
    let state = NodeState {
        conditioner: &conditioner,
        dds: parts.dds.health(),
        now,
        drivers,
        run_state: parts.gauges.run_state(),
        failure,
        real_time_factor,
        recording: parts.recording.as_ref().map(|recording| RecordingState {
            error: recording.health().error(),
            notice: recording.health().notice(),
            drops: recording.health().drops(),
        }),
    };
    let time = (parts.rig_time)();
    parts.alarms.observe_node(&state, time);
}

/// Publishes what is due of the alarms, and keeps it.
pub(super) fn publish(parts: &mut PublisherParts, header: Header, clock: u64) {
    let (publishers, beside) = (
        &parts.publishers,
        Beside::new(parts.recording.as_ref(), parts.live.as_ref()),
    );
    let sent = parts.alarms.publish(header, clock, |encoded| {
        publish::send(publishers, &beside, encoded);
        Ok(())
    });
    if let Err(error) = sent {
        tracing::error!("an alarm could not be encoded: {error}");
    }
}

fn open(path: &Path) -> (Option<Saved>, Option<StateWriter>) {
    let told = |error: StateError| tracing::warn!("{error}");
    let saved = state_file::read(path).unwrap_or_else(|error| {
        told(error);
        None
    });
    (saved, StateWriter::start(path.to_owned()).map_err(told).ok())
}

fn log(event: &AlarmEvent) {
    let priority = words::alarm_priority(event.priority);
    let state = words::alarm_state(event.to_state);
    let calls =
        event.to_state == Alarm::ACTIVE_UNACKNOWLEDGED && (event.annunciates || event.change == AlarmEvent::RAISED);
    if calls && event.priority >= Alarm::MEDIUM {
        tracing::warn!(
            "alarm {} ({priority}): {} {}",
            event.id,
            event.evidence,
            event.what_to_do
        );
    } else if !event.operator_name.is_empty() {
        tracing::info!(
            "alarm {} is {state}: asked for by {} ({})",
            event.id,
            event.operator_name,
            event.reason
        );
    } else {
        tracing::debug!("alarm {} is {state}", event.id);
    }
}

/// Creates `~/acknowledge_alarm`, `~/shelve_alarm` and `~/unshelve_alarm`; `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is wrong.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    desk: &Sender<Asked>,
    name: impl Fn(&str) -> Result<String, crate::ros::args::ArgsError>,
) -> Result<Vec<Task>, NodeError> {
    let mut server = |private: &str, kind: &str| -> Result<ServiceServer, NodeError> {
        let kind = format!("flexdrill/srv/{kind}");
        Ok(ServiceServer::new(port, &name(private)?, &kind, mapping))
    };
    let ask = |desk: &Sender<Asked>, request| ask(desk.clone(), request);
    let (acknowledge, shelve, unshelve) = (desk.clone(), desk.clone(), desk.clone());
    Ok(vec![
        Box::pin(
            server("~/acknowledge_alarm", "AcknowledgeAlarm")?.serve(move |request: AcknowledgeAlarmRequest| {
                let asked = ask(&acknowledge, Request::Acknowledge(request));
                async move {
                    let (success, message) = asked.await;
                    AcknowledgeAlarmResponse { success, message }
                }
            }),
        ),
        Box::pin(
            server("~/shelve_alarm", "ShelveAlarm")?.serve(move |request: ShelveAlarmRequest| {
                let asked = ask(&shelve, Request::Shelve(request));
                async move {
                    let (success, message) = asked.await;
                    ShelveAlarmResponse { success, message }
                }
            }),
        ),
        Box::pin(
            server("~/unshelve_alarm", "UnshelveAlarm")?.serve(move |request: UnshelveAlarmRequest| {
                let asked = ask(&unshelve, Request::Unshelve(request));
                async move {
                    let (success, message) = asked.await;
                    UnshelveAlarmResponse { success, message }
                }
            }),
        ),
    ])
}

/// Has the publisher carry a request out; whether it did, and what it says.
async fn ask(desk: Sender<Asked>, request: Request) -> (bool, String) {
    let (answer, answered) = oneshot::channel();
    // Where the publisher has ended, the answer fails too.
    let _ = desk.send(Asked { request, answer });
    match answered.await {
        Ok(Ok(done)) => (true, done),
        Ok(Err(refusal)) => (false, refusal.to_string()),
        Err(_) => (false, "the node is ending".to_owned()),
    }
}
