//! The server's own knowledge of the twin: session, history, journal and newest status, from DDS or from a bag.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::history::History;
use crate::mappings::Mappings;
use crate::orbits::Orbits;
use crate::session::Session;
use flexdrill_alarms::Incidents;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::diagnostic_msgs::DiagnosticArray;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::visualization_msgs::MarkerArray;
use flexdrill_messages::{
    AlarmEvent, AlarmList, AppliedInputs, BitState, ContactForces, JointDeflections, SessionInfo, TwinStatus,
    WhirlState, WhirlWarning, from_cdr_body,
};
use flexdrill_text::{log_ending, printable};

/// Largest number of events kept, for a page that is opened later.
const MOST_EVENTS: usize = 2000;
/// Longest event kept (bytes): some sentences.
const LONGEST_EVENT: usize = 16 << 10;
/// Longest text of an incident (characters).
const LONGEST_TEXT: usize = 1000;
/// A twin whose status is older counts as gone: ten heartbeats at the default rate.
const GONE: Duration = Duration::from_secs(2);
/// The parameter that changes how the tool's shape is drawn.
const EXAGGERATION: &str = "outputs.exaggeration";
/// Outputs of which the server keeps the age alone.
const AGE_ONLY: [&str; 9] = [
    topics::JOINT_STATES.name,
    topics::AGEING.name,
    topics::REACTIONS.name,
    topics::TRANSFER.name,
    topics::FORECAST.name,
    topics::BANDS.name,
    topics::HOLE_AHEAD.name,
    topics::SAFE_WINDOW.name,
    topics::RESIDUALS.name,
];

struct Known {
    session: Option<Session>,
    history: History,
    /// Orbits of a live twin; of a bag the player provides the motion.
    orbits: Option<Orbits>,
    events: VecDeque<(i64, AlarmEvent)>,
    /// Of all events, also those that are no longer kept.
    event_count: u64,
    /// In ns since 1970, with the evidence of the worst moment.
    incidents: Incidents<String>,
    status: Option<(TwinStatus, Instant)>,
    mappings: Mappings,
    /// The newest message of each topic: its stamp (ns since 1970), and the time of its arrival.
    newest: BTreeMap<&'static str, (i64, Instant)>,
}

/// Shared by the receivers of messages and the handlers of requests.
pub(crate) struct Board(Mutex<Known>);

impl Board {
    /// An empty board for a live twin.
    pub fn live() -> Self {
        Self::new(1, Some(Orbits::default()))
    }

    /// An empty board for a bag, whose history has one frame per `seconds`.
    pub fn of_bag(seconds: u32) -> Self {
        Self::new(seconds, None)
    }

    fn new(seconds: u32, orbits: Option<Orbits>) -> Self {
        Self(Mutex::new(Known {
            session: None,
            history: History::new(seconds),
            orbits,
            events: VecDeque::new(),
            event_count: 0,
            incidents: Incidents::new(MOST_EVENTS),
            status: None,
            mappings: Mappings::default(),
            newest: BTreeMap::new(),
        }))
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a message (a little-endian CDR body) that arrived at `arrived` (ns since 1970). Returns its stamp, or
    /// `arrived` if it cannot be read.
    pub fn observe(&self, topic: &TopicInfo, body: &[u8], arrived: i64) -> i64 {
        let is_session = topic.name == topics::SESSION.name;
        let of_session = if is_session { self.observe_session(body) } else { None };
        let mut known = self.known();
        let time = if is_session {
            of_session
        } else {
            known.observe(topic, body, arrived)
        };
        let time = time.unwrap_or(arrived);
        known.newest.insert(topic.name, (time, Instant::now()));
        time
    }

    /// The newest message of each topic, for the page: its stamp and its age since arrival (s), by the monotonic clock.
    pub fn newest(&self) -> Value {
        let known = self.known();
        let newest = known.newest.iter().map(|(name, (time, arrived))| {
            let message = json!({"time_ns": time.to_string(), "age_s": arrived.elapsed().as_secs_f64()});
            ((*name).to_owned(), message)
        });
        Value::Object(newest.collect())
    }

    /// Parses a configuration without holding the lock, so that no request waits for it.
    fn observe_session(&self, body: &[u8]) -> Option<i64> {
        let (info, _): (SessionInfo, _) = from_cdr_body(body).ok()?;
        let start = info.start.to_nanoseconds();
        let is_same = |session: &Session| session.config_hash == info.config_hash && session.start == start;
        if !self.known().session.as_ref().is_some_and(is_same) {
            match Session::new(&info) {
                Ok(session) => {
                    let mut known = self.known();
                    known.history.begin(&session);
                    known.session = Some(session);
                }
                Err(why) => {
                    if let Some(more) = log_ending("session not read") {
                        tracing::warn!("{}{more}", printable(&why));
                    }
                }
            }
        }
        Some(info.header.stamp.to_nanoseconds())
    }

    /// Changes the history.
    pub fn with_history(&self, change: impl FnOnce(&mut History)) {
        change(&mut self.known().history);
    }

    /// The history, for the page.
    pub fn history(&self) -> Option<Vec<u8>> {
        self.known().history.to_bytes()
    }

    /// A joint's motion at a time (ns since 1970), for the page; `None` if it is not kept.
    pub fn orbit(&self, joint: usize, time: i64) -> Option<Value> {
        self.known().orbits.as_ref()?.at(joint, time)
    }

    /// The journal, for the page.
    pub fn journal(&self) -> Value {
        let known = self.known();
        let events: Vec<Value> = known
            .events
            .iter()
            .map(|(stamp, event)| event_json(*stamp, event))
            .collect();
        json!({ "events": events })
    }

    /// Version of the journal, which changes with each event.
    pub fn journal_version(&self) -> u64 {
        self.known().event_count
    }

    /// The run, once it is known.
    pub fn session(&self) -> Option<Session> {
        self.known().session.clone()
    }

    /// The newest status, unless the twin has gone.
    pub fn status(&self) -> Option<(TwinStatus, Instant)> {
        let known = self.known();
        known.status.clone().filter(|(_, arrived)| arrived.elapsed() < GONE)
    }

    /// What bridges in a namespace make of their rigs' items, for the page. `service` is the one that this server can call.
    pub fn mappings(&self, namespace: &str, service: Option<&str>) -> Value {
        self.known().mappings.json(namespace, service, Instant::now())
    }

    /// The incidents in the order of their begin, as the page gets them.
    pub fn incidents(&self) -> Value {
        let known = self.known();
        let incidents = known.incidents.list().iter().map(|incident| {
            json!({
                "time_ns": incident.begin.to_string(),
                "duration_s": incident.end.map(|end| (end - incident.begin) as f64 * 1e-9),
                "severity": incident.priority,
                "alarm": incident.alarm,
                "text": incident.worst,
            })
        });
        incidents.collect()
    }
}

impl Known {
    fn observe(&mut self, topic: &TopicInfo, body: &[u8], arrived: i64) -> Option<i64> {
        // A message that does not decode is left out, not an error: the twin may be of another version.
        fn read<M: DeserializeOwned>(body: &[u8]) -> Option<M> {
            from_cdr_body(body).ok().map(|(message, _)| message)
        }
        let stamp = |time: &Time| time.to_nanoseconds();
        let history = &mut self.history;
        let time = match topic.name {
            name if name == topics::STATUS.name => {
                let message: TwinStatus = read(body)?;
                let time = stamp(&message.header.stamp);
                history.status(time, &message);
                // The time of arrival counts for the status: its silence is judged by this machine's clock.
                self.status = Some((message, Instant::now()));
                time
            }
            name if name == topics::BIT_STATE.name => {
                let message: BitState = read(body)?;
                let time = stamp(&message.header.stamp);
                history.bit(time, &message);
                time
            }
            name if name == topics::JOINT_DEFLECTIONS.name => {
                let message: JointDeflections = read(body)?;
                let time = stamp(&message.header.stamp);
                history.joints(time, &message);
                // Orbits exist only where a page needs them: they hold every sample of a station.
                if let Some(orbits) = &mut self.orbits {
                    orbits.observe(time, &message);
                }
                time
            }
            name if name == topics::CONTACT_FORCES.name => {
                let message: ContactForces = read(body)?;
                let time = stamp(&message.header.stamp);
                history.contacts(time, &message);
                time
            }
            name if name == topics::WHIRL.name => {
                let message: WhirlState = read(body)?;
                let time = stamp(&message.header.stamp);
                // The session names the stations; without it the figures have no location on the tool.
                if let Some(session) = &self.session {
                    history.whirl(time, &message, session);
                }
                time
            }
            name if name == topics::WHIRL_WARNINGS.name => {
                let message: WhirlWarning = read(body)?;
                let time = stamp(&message.header.stamp);
                history.warning(time, &message);
                time
            }
            name if name == topics::ALARMS.name => {
                let message: AlarmList = read(body)?;
                let time = stamp(&message.header.stamp);
                history.alarms(time, &message);
                time
            }
            name if name == topics::ALARM_EVENTS.name => {
                let message: AlarmEvent = read(body)?;
                let time = stamp(&message.header.stamp);
                // An event that long is no alarm of ours, and 2000 are kept.
                if body.len() <= LONGEST_EVENT {
                    self.event(time, message);
                }
                time
            }
            name if name == topics::TOOL_SHAPE.name => {
                let message: MarkerArray = read(body)?;
                // A shape without markers has no stamp, so the time of arrival stands for it.
                let time = message
                    .markers
                    .first()
                    .map_or(arrived, |marker| stamp(&marker.header.stamp));
                if let Some(session) = &self.session {
                    history.shape(time, &message, session);
                }
                time
            }
            name if name == topics::APPLIED_INPUTS.name => {
                let message: AppliedInputs = read(body)?;
                let changes = message.parameter_name.iter().zip(&message.parameter_value);
                // Later shapes are drawn with this factor, so the history must know it.
                for (_, factor) in changes.filter(|(name, _)| *name == EXAGGERATION) {
                    history.set_exaggeration(*factor);
                }
                stamp(&message.header.stamp)
            }
            name if name == topics::DIAGNOSTICS.name => {
                let message: DiagnosticArray = read(body)?;
                let time = stamp(&message.header.stamp);
                self.mappings.observe(message, Instant::now());
                time
            }
            // For these the page shows the age alone, so the header is enough.
            name if AGE_ONLY.contains(&name) => {
                let header: Header = read(body)?;
                stamp(&header.stamp)
            }
            // The rig's inputs and the transform have no stamp of the model.
            _ => return None,
        };
        Some(time)
    }

    fn event(&mut self, time: i64, event: AlarmEvent) {
        // A restart of DDS may deliver an event again.
        if self
            .events
            .iter()
            .rev()
            .take(100)
            .any(|(_, known)| known.sequence == event.sequence && known.id == event.id)
        {
            return;
        }
        self.incidents
            .add(time, &event.occurrence(), || shortened(&event.evidence));
        if self.events.len() == MOST_EVENTS {
            self.events.pop_front();
        }
        self.events.push_back((time, event));
        self.event_count += 1;
    }
}

/// The evidence, at most as long as any text of the node.
fn shortened(text: &str) -> String {
    text.chars().take(LONGEST_TEXT).collect()
}

fn event_json(stamp: i64, event: &AlarmEvent) -> Value {
    // JSON has null for a number that is not finite.
    let mut value = serde_json::to_value(event).unwrap_or_default();
    if let Some(fields) = value.as_object_mut() {
        fields.remove("header");
        fields.insert("stamp_ns".to_owned(), stamp.to_string().into());
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::{Alarm, to_cdr_body};

    fn send(board: &Board, second: i64, sequence: u64, change: u8, priority: u8) {
        let event = AlarmEvent {
            header: Header {
                stamp: Time::from_nanoseconds(second * 1_000_000_000),
                ..Header::default()
            },
            sequence,
            id: "shock".into(),
            change,
            priority,
            evidence: format!("seen at {second} s"),
            value: f64::NAN,
            ..AlarmEvent::default()
        };
        board.observe(&topics::ALARM_EVENTS, &to_cdr_body(&event).unwrap(), 0);
    }

    #[test]
    fn the_newest_of_a_topic_has_its_own_time_and_the_age_since_it_arrived() {
        let board = Board::live();
        assert_eq!(board.newest(), json!({}));
        for second in [5, 7] {
            send(&board, second, 1, AlarmEvent::ACTIVATED, Alarm::LOW);
        }
        let newest = &board.newest()[topics::ALARM_EVENTS.name];
        assert_eq!(newest["time_ns"], "7000000000");
        let age = newest["age_s"].as_f64().unwrap();
        std::thread::sleep(Duration::from_millis(20));
        let later = board.newest()[topics::ALARM_EVENTS.name]["age_s"].as_f64().unwrap();
        // It ages by this clock, whatever its stamp says.
        assert!(
            (0.0..60.0).contains(&age) && later >= age + 0.02,
            "{age} s, then {later} s"
        );
    }

    #[test]
    fn an_incident_lasts_from_the_call_to_the_end_with_its_worst_level() {
        let board = Board::live();
        send(&board, 10, 1, AlarmEvent::ACTIVATED, Alarm::LOW);
        send(&board, 10, 1, AlarmEvent::ACTIVATED, Alarm::LOW);
        send(&board, 12, 2, AlarmEvent::RAISED, Alarm::HIGH);
        send(&board, 14, 3, AlarmEvent::ACKNOWLEDGED, Alarm::HIGH);
        send(&board, 15, 4, AlarmEvent::RETURNED, Alarm::HIGH);
        send(&board, 20, 5, AlarmEvent::ACTIVATED, Alarm::LOW);
        let incidents = board.incidents();
        assert_eq!(incidents.as_array().unwrap().len(), 2);
        assert_eq!(incidents[0]["duration_s"], 5.0);
        assert_eq!(
            (&incidents[0]["severity"], &incidents[0]["text"]),
            (&json!(3), &json!("seen at 12 s"))
        );
        assert_eq!(
            (&incidents[1]["time_ns"], &incidents[1]["duration_s"]),
            (&json!("20000000000"), &Value::Null)
        );
        let journal = board.journal();
        assert_eq!(journal["events"].as_array().unwrap().len(), 5);
        assert_eq!(
            (&journal["events"][0]["stamp_ns"], &journal["events"][0]["value"]),
            (&json!("10000000000"), &Value::Null)
        );
    }
}
