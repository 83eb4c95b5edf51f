//! Alarms in the node: conditions from the publisher's side, requests by service, and the state over a restart.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, PoisonError};
use std::time::Duration;

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
use flexdrill_realtime::PaceReading;

/// Longest wait of a request for the disk that is to keep what was done: shorter than a client waits for a reply.
const DISK_PATIENCE: Duration = Duration::from_secs(2);

/// A request on its way to the publisher, which keeps the alarms.
pub struct Asked {
    request: Request,
    answer: oneshot::Sender<Result<Done, Refusal>>,
}

/// A request that was carried out.
struct Done {
    /// What was done.
    text: String,
    /// Whether it is on the disk, once that is known.
    kept: Kept,
}

/// What becomes of a change over a restart.
enum Kept {
    /// No state is kept by this node, for a reason that was logged at its start.
    Nowhere,
    /// The writer answers.
    Asked(oneshot::Receiver<Result<(), String>>),
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
        let (saved, writer) = state_file.map(open).unwrap_or_default();
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
            let answer = answer.map(|text| Done {
                text,
                kept: self.keep(),
            });
            // The client may have gone meanwhile.
            let _ = asked.answer.send(answer);
        }
    }

    /// Hands the state to the writer, who says when it is on the disk: the publisher's thread does not wait for that.
    fn keep(&mut self) -> Kept {
        let Some((writer, written)) = &mut self.writer else {
            return Kept::Nowhere;
        };
        let (sender, kept) = oneshot::channel();
        // Whoever asked may wait no longer.
        let told = move |result| drop(sender.send(result));
        writer.save_then(self.book.save(), Box::new(told));
        *written = self.book.sequence();
        Kept::Asked(kept)
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
pub(super) fn judge_node(parts: &mut PublisherParts, failure: Option<StepFailure>, pace: PaceReading) {
    let conditioner = parts.conditioner.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let now = (parts.now)();
    let drivers = {
        let intake = parts.intake.lock().unwrap_or_else(PoisonError::into_inner);
        InputKind::ALL.map(|kind| intake.drivers.summary(kind, now))
    };
    let state = NodeState {
        conditioner: &conditioner,
        dds: parts.dds.health(),
        namesakes: parts.dds.namesakes().iter().map(ToString::to_string).collect(),
        now,
        drivers,
        run_state: parts.gauges.run_state(),
        failure,
        pace,
        recording: parts.recording.as_ref().map(|recording| RecordingState {
            error: recording.health().problem(),
            notice: recording.health().past_problem(),
            losses: recording.health().losses(),
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

/// The state of an earlier run and the writer of this one's. Where another node has the file, its state is none of this
/// node's.
fn open(path: &Path) -> (Option<Saved>, Option<StateWriter>) {
    let logged = |error: StateError| tracing::warn!("{error}");
    match StateWriter::start(path.to_owned()) {
        Err(error @ StateError::Owned { .. }) => {
            logged(error);
            (None, None)
        }
        writer => {
            let saved = state_file::read(path).unwrap_or_else(|error| {
                logged(error);
                None
            });
            (saved, writer.map_err(logged).ok())
        }
    }
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
        tracing::info!("alarm {} is {state}: {}", event.id, asked_for_by(event));
    } else {
        tracing::debug!("alarm {} is {state}", event.id);
    }
}

/// Who asked for a change, and why where a reason was given.
fn asked_for_by(event: &AlarmEvent) -> String {
    let reason = event.reason.trim();
    if reason.is_empty() {
        format!("requested by {}", event.operator_name)
    } else {
        format!("requested by {} ({reason})", event.operator_name)
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

/// Has the publisher carry a request out, and waits until that is on the disk; whether both succeeded, and what is said of
/// it.
async fn ask(desk: Sender<Asked>, request: Request) -> (bool, String) {
    let (answer, answered) = oneshot::channel();
    // Where the publisher has ended, the answer fails too.
    let _ = desk.send(Asked { request, answer });
    match answered.await {
        Ok(Ok(done)) => done.said().await,
        Ok(Err(refusal)) => (false, refusal.to_string()),
        Err(_) => (false, "the node is ending".to_owned()),
    }
}

impl Done {
    async fn said(self) -> (bool, String) {
        let Self { text, kept } = self;
        let Kept::Asked(kept) = kept else {
            return (
                true,
                format!("{text}; for this run only, since the node keeps no state"),
            );
        };
        let why = match tokio::time::timeout(DISK_PATIENCE, kept).await {
            Ok(Ok(Ok(()))) => return (true, text),
            Ok(Ok(Err(why))) => why,
            Ok(Err(_)) => "the node is ending".to_owned(),
            Err(_) => format!("the disk has not answered within {} s", DISK_PATIENCE.as_secs()),
        };
        (false, format!("{text} in this run, but not kept over a restart: {why}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_without_a_reason_leaves_no_empty_brackets() {
        let by = |reason: &str| {
            asked_for_by(&AlarmEvent {
                operator_name: "ann".to_owned(),
                reason: reason.to_owned(),
                ..AlarmEvent::default()
            })
        };
        assert_eq!(by(" "), "requested by ann");
        assert_eq!(by("sensor replaced"), "requested by ann (sensor replaced)");
    }

    /// A desk without a node around it: the answer to a request, and the state in the file when it came.
    async fn acknowledged(desk: &mut AlarmDesk, asking: &Sender<Asked>) -> (bool, String) {
        let request = Request::Shelve(ShelveAlarmRequest {
            id: "shock".to_owned(),
            one_shot: true,
            duration: 0.0,
            operator_name: "ann".to_owned(),
            reason: "reaming".to_owned(),
        });
        let asked = tokio::spawn(ask(asking.clone(), request));
        while !asked.is_finished() {
            desk.answer(|| 5_000_000_000);
            tokio::time::sleep(Duration::from_millis(1)).await;
        }
        asked.await.unwrap()
    }

    #[tokio::test]
    async fn a_reply_says_success_only_when_the_state_is_on_the_disk() {
        let config = Arc::new(Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap());
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("alarms.json");
        let (asking, asked) = std::sync::mpsc::channel();
        let mut desk = AlarmDesk::new(Arc::clone(&config), Some(&file), asked, 0);
        let (success, message) = acknowledged(&mut desk, &asking).await;
        assert!(success && message.contains("shock shelved"), "{message}");
        let kept = std::fs::read_to_string(&file).unwrap();
        assert!(kept.contains("\"one_shot\":true"), "{kept}");
        // A folder where the file is to be.
        std::fs::remove_file(&file).unwrap();
        std::fs::create_dir_all(file.join("in the path")).unwrap();
        let (success, message) = acknowledged(&mut desk, &asking).await;
        assert!(!success && message.contains("not kept over a restart"), "{message}");
        // Nothing is to be kept.
        let (asking, asked) = std::sync::mpsc::channel();
        let mut desk = AlarmDesk::new(config, None, asked, 0);
        let (success, message) = acknowledged(&mut desk, &asking).await;
        assert!(success && message.contains("for this run only"), "{message}");
    }
}
