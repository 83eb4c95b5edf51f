//! Alarms in the node: their conditions, requests by service, and their state over a restart.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};
use std::time::Duration;

use tokio::sync::oneshot;

use super::NodeError;
use super::confirmed::Confirmation;
use super::publish::PublisherParts;
use crate::ahead::{Acting, Advisor, InForce};
use crate::alarms::{AlarmBook, Request};
use crate::health::conditions::{NodeConditions, NodeState, RecordingState};
use crate::state_file::{self, Kept, StateError, StateWriter, Words};
use flexdrill_alarms::{Refusal, Saved, Time};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::inputs::{InputKind, Inputs};
use flexdrill_messages::{
    AcknowledgeAlarmRequest, AcknowledgeAlarmResponse, Alarm, AlarmEvent, ShelveAlarmRequest, ShelveAlarmResponse,
    UnshelveAlarmRequest, UnshelveAlarmResponse,
};
use flexdrill_outputs::words;
use flexdrill_realtime::PaceReading;
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::PortBuilder;
use flexdrill_ros2::service::{ServiceMapping, ServiceServer, Task};
use flexdrill_text::log_ending;

/// Longest wait of a request until its effect is on the disk: shorter than a client waits for a reply.
const DISK_PATIENCE: Duration = Duration::from_secs(2);

/// A request on its way to the publisher's thread, which owns the alarms.
pub struct AlarmRequest {
    request: Request,
    answer: oneshot::Sender<Result<Accepted, Refusal>>,
}

/// A request that was carried out.
struct Accepted {
    /// The effect, as a sentence.
    text: String,
    saved: Saving,
}

/// Whether the effect of a request survives a restart.
enum Saving {
    /// This node keeps no state, for a reason that was logged at its start.
    Off,
    /// The writer reports when the state is on the disk.
    Pending(oneshot::Receiver<Result<(), String>>),
}

/// What the node does about the alarms of its session, on the publisher's thread: it answers requests, takes advice from
/// look-aheads, logs, and keeps their state over a restart.
pub struct AlarmDesk {
    requests: Receiver<AlarmRequest>,
    /// Who looks ahead for advice; none where that is off.
    advisor: Option<Arc<Advisor>>,
    /// The parameters in force that advice depends on.
    parameters: InForce,
    /// The conditions of the node itself.
    conditions: NodeConditions,
    /// Writes the state to its file, with the number of the newest event that it was given.
    writer: Option<(StateWriter<Saved>, u64)>,
}

/// Acknowledgements, shelvings and the figures of the alarms, as JSON.
impl Kept for Saved {
    const WORDS: Words = Words {
        state: "the alarms' state",
        of_node: "the alarms",
        without: "all alarms begin as normal",
        lost: "acknowledgements and shelvings",
    };

    fn encode(&self) -> std::io::Result<Vec<u8>> {
        // A state of numbers, words and lists fails to encode only without memory.
        Ok(serde_json::to_vec(self)?)
    }

    fn decode(bytes: &[u8]) -> Result<Self, String> {
        serde_json::from_slice(bytes).map_err(|error| error.to_string())
    }
}

impl AlarmDesk {
    /// Alarms with the state that an earlier run has left in `state_file`, or all normal, and their desk. A problem of the file
    /// is logged.
    pub fn open(
        config: &Arc<Config>,
        state_file: Option<&Path>,
        requests: Receiver<AlarmRequest>,
        time: Time,
    ) -> (AlarmBook, Self) {
        let (saved, writer) = state_file.map(open).unwrap_or_default();
        let book = AlarmBook::new(Arc::clone(config), saved.as_ref(), time).unwrap_or_else(|error| {
            tracing::warn!("{error}; all alarms begin as normal");
            AlarmBook::fresh(Arc::clone(config), time)
        });
        let desk = Self {
            requests,
            advisor: None,
            parameters: InForce::of(config),
            conditions: NodeConditions::default(),
            writer: writer.map(|writer| (writer, 0)),
        };
        (book, desk)
    }

    /// Takes advice from look-aheads.
    pub fn advised_by(&mut self, advisor: Arc<Advisor>) {
        self.advisor = Some(advisor);
    }

    /// Adopts the parameters of a changed configuration.
    pub fn reconfigure(&mut self, config: &Config) {
        self.parameters = InForce::of(config);
    }

    /// Gives the alarms that stand what look-aheads have found for them under what the driller has set, at `now` (s) of the
    /// steady clock.
    pub fn advise(&self, book: &mut AlarmBook, set: Inputs, now: f64) {
        if let Some(advisor) = &self.advisor {
            advisor.advise(book, &Acting::new(set, &self.parameters), now);
        }
    }

    /// Answers all waiting requests, at the present time on the rig's clock.
    pub fn answer(&mut self, book: &mut AlarmBook, time: impl Fn() -> Time) {
        while let Ok(AlarmRequest { request, answer }) = self.requests.try_recv() {
            let result = book.request(&request, time());
            let result = result.map(|text| Accepted {
                text,
                saved: self.save(book),
            });
            // The service may not wait any more.
            let _ = answer.send(result);
        }
    }

    /// Passes the state to the writer, which reports when it is on the disk. The publisher's thread does not wait for the
    /// disk.
    fn save(&mut self, book: &AlarmBook) -> Saving {
        let Some((writer, written)) = &mut self.writer else {
            return Saving::Off;
        };
        let (sender, saved) = oneshot::channel();
        // The service may not wait any more.
        let report = move |result| drop(sender.send(result));
        writer.save_then(book.save(), Box::new(report));
        *written = book.sequence();
        Saving::Pending(saved)
    }

    /// Logs those of these events that call for an operator, and saves a changed state.
    pub fn published(&mut self, book: &AlarmBook, events: &[AlarmEvent]) {
        for event in events {
            log(event);
        }
        if let (Some(newest), Some((writer, written))) = (events.last(), &mut self.writer)
            && newest.sequence > *written
        {
            writer.save(book.save());
            *written = newest.sequence;
        }
    }
}

/// Judges the alarms of the node itself, at the present time on the rig's clock. They follow the wall clock, so that they work
/// while the model stands.
pub(super) fn judge_node(
    parts: &mut PublisherParts,
    book: &mut AlarmBook,
    failure: Option<StepFailure>,
    pace: PaceReading,
) {
    let inputs = parts.inputs.snapshot();
    let now = parts.clocks.age_time();
    let state = NodeState {
        conditioner: inputs.conditioner(),
        dds: parts.dds.health(),
        namesakes: parts.dds.namesakes().iter().map(ToString::to_string).collect(),
        now,
        drivers: InputKind::ALL.map(|kind| inputs.drivers(kind, now)),
        run_state: parts.gauges.run_state(),
        failure,
        pace,
        recording: parts.recording.as_ref().map(|recording| RecordingState {
            error: recording.health().problem(),
            notice: recording.health().past_problem(),
            losses: recording.health().losses(),
        }),
    };
    let time = parts.clocks.rig_time();
    book.advance(time);
    parts.alarms.conditions.observe(book, &state, time);
    for Confirmation { by, reason } in parts.confirmed.take() {
        book.enter_confirmed(&by, &reason, time);
    }
}

/// The state of an earlier run and the writer for this one; neither where another node uses the file.
fn open(path: &Path) -> (Option<Saved>, Option<StateWriter<Saved>>) {
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
        if let Some(more) = log_ending(format!("alarm {} ({priority})", event.id)) {
            tracing::warn!(
                "alarm {} ({priority}): {} {}{more}",
                event.id,
                event.evidence,
                event.what_to_do
            );
        }
    } else if !event.operator_name.is_empty() {
        if let Some(more) = log_ending(format!("alarm {} is {state}", event.id)) {
            tracing::info!("alarm {} is {state}: {}{more}", event.id, requested_by(event));
        }
    } else {
        tracing::debug!("alarm {} is {state}", event.id);
    }
}

/// The operator who requested a change, with the reason if there is one.
fn requested_by(event: &AlarmEvent) -> String {
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
/// When a remapped name is not allowed.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    desk: &Sender<AlarmRequest>,
    name: impl Fn(&str) -> Result<String, ArgsError>,
) -> Result<Vec<Task>, NodeError> {
    let mut server = |private: &str, kind: &str| -> Result<ServiceServer, NodeError> {
        let kind = format!("flexdrill/srv/{kind}");
        Ok(ServiceServer::new(port, &name(private)?, &kind, mapping))
    };
    let (acknowledge, shelve, unshelve) = (desk.clone(), desk.clone(), desk.clone());
    Ok(vec![
        Box::pin(
            server("~/acknowledge_alarm", "AcknowledgeAlarm")?.serve(move |request: AcknowledgeAlarmRequest| {
                let answered = ask(acknowledge.clone(), Request::Acknowledge(request));
                async move {
                    let (success, message) = answered.await;
                    AcknowledgeAlarmResponse { success, message }
                }
            }),
        ),
        Box::pin(
            server("~/shelve_alarm", "ShelveAlarm")?.serve(move |request: ShelveAlarmRequest| {
                let answered = ask(shelve.clone(), Request::Shelve(request));
                async move {
                    let (success, message) = answered.await;
                    ShelveAlarmResponse { success, message }
                }
            }),
        ),
        Box::pin(
            server("~/unshelve_alarm", "UnshelveAlarm")?.serve(move |request: UnshelveAlarmRequest| {
                let answered = ask(unshelve.clone(), Request::Unshelve(request));
                async move {
                    let (success, message) = answered.await;
                    UnshelveAlarmResponse { success, message }
                }
            }),
        ),
    ])
}

/// Passes a request to the publisher's thread and waits until its effect is on the disk. Returns whether both succeeded, and
/// the text of the reply.
async fn ask(desk: Sender<AlarmRequest>, request: Request) -> (bool, String) {
    let (answer, answered) = oneshot::channel();
    // Sending fails only where the publisher has ended; then the answer fails, too.
    let _ = desk.send(AlarmRequest { request, answer });
    match answered.await {
        Ok(Ok(accepted)) => accepted.reply().await,
        Ok(Err(refusal)) => (false, refusal.to_string()),
        Err(_) => (false, "the node is ending".to_owned()),
    }
}

impl Accepted {
    async fn reply(self) -> (bool, String) {
        let Self { text, saved } = self;
        let Saving::Pending(saved) = saved else {
            return (
                true,
                format!("{text}; for this run only, since the node keeps no state"),
            );
        };
        let why = match tokio::time::timeout(DISK_PATIENCE, saved).await {
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
    use crate::alarms::{AlarmSet, Change, Knob, Tested};
    use flexdrill_core::twin::Snapshot;
    use flexdrill_messages::std_msgs::Header;
    use flexdrill_motion::{DriveState, HazardKind, Severity};

    #[test]
    fn a_request_without_a_reason_has_no_empty_brackets() {
        let by = |reason: &str| {
            requested_by(&AlarmEvent {
                operator_name: "ann".to_owned(),
                reason: reason.to_owned(),
                ..AlarmEvent::default()
            })
        };
        assert_eq!(by(" "), "requested by ann");
        assert_eq!(by("sensor replaced"), "requested by ann (sensor replaced)");
    }

    /// Shelves an alarm at a desk without a node, and returns the reply.
    async fn shelved((book, desk): &mut (AlarmBook, AlarmDesk), sender: &Sender<AlarmRequest>) -> (bool, String) {
        let request = Request::Shelve(ShelveAlarmRequest {
            id: "shock".to_owned(),
            one_shot: true,
            duration: 0.0,
            operator_name: "ann".to_owned(),
            reason: "reaming".to_owned(),
        });
        let answered = tokio::spawn(ask(sender.clone(), request));
        while !answered.is_finished() {
            desk.answer(book, || 5_000_000_000);
            tokio::time::sleep(Duration::from_millis(1)).await;
        }
        answered.await.unwrap()
    }

    #[tokio::test]
    async fn a_reply_says_success_only_when_the_state_is_on_the_disk() {
        let config = Arc::new(Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap());
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("alarms.json");
        let (sender, requests) = std::sync::mpsc::channel();
        let mut desk = AlarmDesk::open(&config, Some(&file), requests, 0);
        let (success, message) = shelved(&mut desk, &sender).await;
        assert!(success && message.contains("shock shelved"), "{message}");
        let state = std::fs::read_to_string(&file).unwrap();
        assert!(state.contains("\"one_shot\":true"), "{state}");
        // A folder in the place of the file makes writing fail.
        std::fs::remove_file(&file).unwrap();
        std::fs::create_dir_all(file.join("in the path")).unwrap();
        let (success, message) = shelved(&mut desk, &sender).await;
        assert!(!success && message.contains("not kept over a restart"), "{message}");
        // This desk has no file.
        let (sender, requests) = std::sync::mpsc::channel();
        let mut desk = AlarmDesk::open(&config, None, requests, 0);
        let (success, message) = shelved(&mut desk, &sender).await;
        assert!(success && message.contains("for this run only"), "{message}");
    }

    /// Advice that was tested with a friction of 0.2 is not given with another.
    #[test]
    fn advice_that_was_tested_on_another_tool_is_withdrawn() {
        let config = Arc::new(Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap());
        let config = Arc::new(config.with_value("look_ahead.advice", true).unwrap());
        let (_, requests) = std::sync::mpsc::channel();
        let (mut book, mut desk) = AlarmDesk::open(&config, None, requests, 0);
        let advisor = Arc::new(Advisor::default());
        desk.advised_by(Arc::clone(&advisor));
        let mut snapshot = Snapshot::default();
        snapshot.hazards.drive = DriveState::Turning;
        snapshot.hazards.list[HazardKind::BackwardWhirl as usize].severity = Severity::Critical;
        (snapshot.applied.rotary_speed, snapshot.applied.weight_on_bit) = (4.0 * std::f64::consts::PI, 10e3);
        let mut second = 0;
        let mut advice = |desk: &AlarmDesk| {
            second += 1;
            book.observe_tool(&snapshot, 1_000_000_000 * second);
            desk.advise(&mut book, snapshot.applied.inputs(), second as f64);
            // The texts are written after what was found was taken.
            book.observe_tool(&snapshot, 1_000_000_000 * second + 1);
            let list = book.list(Header::default());
            let alarm = list.alarms.into_iter().find(|alarm| alarm.id == "backward_whirl");
            alarm.unwrap().what_to_do
        };
        assert!(advice(&desk).contains("a rule of thumb: the twin has not tried it out."));
        // The question is of the first second, and due once it has settled.
        assert!(advisor.due(1.5).is_none());
        let (asked, _) = advisor.due(4.0).unwrap();
        assert!(advice(&desk).contains("the twin is searching for a change that ends the alarm."));
        let tested = Tested {
            ends: asked.leading.standing,
            stays: AlarmSet::EMPTY,
            from: [120.0, 10.0],
            change: Change {
                quantity: Knob::Speed,
                to: 84.0,
            },
            ended: 10,
            of: 10,
            tools: 0,
        };
        advisor.answer(asked, Some(tested));
        assert!(advice(&desk).contains("84 r/min"));
        // The same configuration, and a parameter that has nothing to do with the motion.
        desk.reconfigure(&config);
        desk.reconfigure(&config.with_value("outputs.rates.whirl", 5.0).unwrap());
        assert!(advice(&desk).contains("84 r/min"));
        desk.reconfigure(&config.with_value("contact.inner.friction_tangential", 1.0).unwrap());
        let words = advice(&desk);
        assert!(
            words.contains("a rule of thumb") && !words.contains("84 r/min"),
            "{words}"
        );
        assert!(advisor.due(9.0).is_some(), "it is asked for again");
    }
}
