//! Alarms: what the motion and the node's own state mean for an operator, from condition to message. The life of an
//! alarm is the crate [`flexdrill_alarms`]; here are the conditions and the words.
//!
//! # Layout
//! - [`AlarmBook`] joins them: conditions and requests in, [`AlarmList`] and [`AlarmEvent`]s out.
//! - `catalogue`: which alarms there are. `finding`: a condition with its words.
//! - `tool`: conditions from a snapshot, in model time, so that a replay has the same alarms. `node`: conditions of
//!   inputs, pace, solver and recording. `shown`: an alarm shows its worst moment while it stands. `advice`: what the
//!   driller can do, for all alarms together, from the rules of the configuration. `sentence`: parts of sentences.
//! - `fill`: messages. `state_file`: what is kept over a restart.
//!
//! `docs/alarms.md` is for those who use them.

mod advice;
mod catalogue;
mod fill;
mod finding;
mod node;
mod request;
mod sentence;
mod shown;
pub mod state_file;
mod tool;

pub use catalogue::AlarmId;
pub use finding::Finding;
pub use node::{NodeState, RecordingState};
pub use request::Request;

use std::sync::Arc;

use crate::messages::outputs::Encoded;
use crate::messages::std_msgs::Header;
use crate::messages::topics;
use crate::messages::{AlarmEvent, AlarmList, CdrError, to_cdr_into};
use flexdrill_alarms::{AlarmSystem, Event, Figures, Observation, Saved, SavedError, Statistics, Time};
use flexdrill_config::Config;
use flexdrill_core::motion::HazardKind;
use flexdrill_core::twin::Snapshot;

use advice::{Demand, Operating};
use shown::Shown;

/// Step back of the clock beyond which the journal's stamps follow it (ns).
const SET_BACK: Time = 60_000_000_000;
/// Longest time between two lists (ns).
const LIST_INTERVAL: Time = 1_000_000_000;

/// All alarms with what is known of their conditions.
pub struct AlarmBook {
    system: AlarmSystem,
    config: Arc<Config>,
    /// Per alarm, while it stands or is to be acknowledged: its worst moment.
    shown: Vec<Shown>,
    /// Where the tool is driven, by the newest snapshot.
    operating: Operating,
    memory: node::Memory,
    /// Per alarm: its present state is that of an earlier run.
    restored: Vec<bool>,
    /// Not yet published.
    journal: Vec<AlarmEvent>,
    /// Stamp of the newest event: the tool's are at the model's instants and the node's at the present, and a journal
    /// read by time keeps its sequence.
    newest: Time,
    /// When the list was published last, and the newest event in it.
    listed: Option<(Time, u64)>,
    bytes: Vec<u8>,
}

impl AlarmBook {
    /// Alarms as a run before has left them in `saved`, where there is one.
    ///
    /// # Errors
    /// When another version saved it.
    pub fn new(config: Arc<Config>, saved: Option<&Saved>, time: Time) -> Result<Self, SavedError> {
        let mut system = system(&config);
        if let Some(saved) = saved {
            system.restore(saved)?;
        }
        Ok(Self::with(system, config, time))
    }

    /// All alarms normal, defined by a configuration.
    pub fn fresh(config: Arc<Config>, time: Time) -> Self {
        Self::with(system(&config), config, time)
    }

    fn with(system: AlarmSystem, config: Arc<Config>, time: Time) -> Self {
        let mut book = Self {
            shown: vec![Shown::default(); AlarmId::ALL.len()],
            operating: Operating::default(),
            memory: node::Memory::default(),
            restored: (0..AlarmId::ALL.len())
                .map(|index| system.alarm(index).since != 0)
                .collect(),
            journal: Vec::new(),
            newest: Time::MIN,
            listed: None,
            bytes: Vec::new(),
            system,
            config,
        };
        let mut events = Vec::new();
        book.system.follow_definitions(time, &mut events);
        book.keep(events);
        book
    }

    /// Takes over limits and rules that may change while running.
    pub fn reconfigure(&mut self, config: &Arc<Config>) {
        self.config = Arc::clone(config);
    }

    /// Lets time pass on the clock of requests. To be called before what happens then is taken.
    pub fn advance(&mut self, time: Time) {
        let mut events = Vec::new();
        self.system.advance(time, &mut events);
        self.keep(events);
    }

    /// Takes the hazards of a snapshot, at its stamp.
    pub fn observe_tool(&mut self, snapshot: &Snapshot, stamp: Time) {
        let stands = |id: AlarmId| self.system.alarm(id as usize).standing.active().is_some();
        let findings = tool::findings(snapshot, stamp, &self.config, stands);
        self.operating = Operating::of(&snapshot.applied);
        self.observe(findings, stamp);
    }

    /// Takes the node's own state.
    pub fn observe_node(&mut self, state: &NodeState<'_>, time: Time) {
        let findings = node::findings(state, &self.config.alarms, &mut self.memory);
        self.observe(findings, time);
    }

    fn observe(&mut self, findings: impl IntoIterator<Item = (AlarmId, Finding)>, time: Time) {
        let mut events = Vec::new();
        for (id, finding) in findings {
            let observed = Observation {
                priority: finding.priority,
                suppressed: finding.suppressed,
                evidence: &finding.evidence,
            };
            self.system.observe(id as usize, time, &observed, &mut events);
            let standing = self.system.alarm(id as usize).standing;
            self.shown[id as usize].observe(finding, time, &standing);
        }
        self.keep(events);
    }

    /// Advises the driller on all alarms of the tool's motion together.
    fn advise(&mut self) {
        let mut demands = Vec::new();
        for kind in HazardKind::ALL {
            let id = AlarmId::of_hazard(kind);
            let (shown, standing) = (&self.shown[id as usize], self.system.alarm(id as usize).standing);
            if shown.is_known() {
                demands.push(Demand {
                    id,
                    priority: shown.present,
                    rule: tool::rule(kind, &self.config.alarms.advice),
                    shelved: standing.shelf().is_some(),
                });
            }
        }
        let texts = advice::what_to_do(&demands, &self.operating, &self.config.inputs);
        for (demand, text) in demands.iter().zip(texts) {
            let index = demand.id as usize;
            self.shown[index].finding.what_to_do = match self.system.alarm(index).standing.active() {
                Some(_) => text,
                None => "No further action: acknowledge it.".to_owned(),
            };
        }
    }

    /// Carries out what somebody asks for, at the present time of the clock of requests. What was done.
    ///
    /// # Errors
    /// When it is refused.
    pub fn request(&mut self, request: &Request, time: Time) -> Result<String, flexdrill_alarms::Refusal> {
        self.advance(time);
        let mut events = Vec::new();
        let answer = request.carry_out(&mut self.system, time, &mut events);
        self.keep(events);
        answer
    }

    fn keep(&mut self, events: Vec<Event>) {
        self.advise();
        let frame_id = &self.config.outputs.frame_id;
        let calm = Shown::default();
        for event in &events {
            let shown = self.shown.get(event.alarm).unwrap_or(&calm);
            // The tool's events follow their instants within moments: further back, the clock was set.
            self.newest = if self.newest.saturating_sub(event.time) > SET_BACK {
                event.time
            } else {
                self.newest.max(event.time)
            };
            if event.from != event.to
                && let Some(restored) = self.restored.get_mut(event.alarm)
            {
                *restored = false;
            }
            self.journal.push(fill::event(event, self.newest, shown, frame_id));
        }
        for (index, shown) in self.shown.iter_mut().enumerate() {
            if self.system.alarm(index).standing.priority().is_none() {
                *shown = Shown::default();
            }
        }
    }

    /// Whether there is something to publish at an instant of any steady clock (ns): events, or the list, which goes
    /// out with every event and every second.
    pub fn is_due(&self, clock: Time) -> bool {
        !self.journal.is_empty() || self.list_is_due(clock)
    }

    fn list_is_due(&self, clock: Time) -> bool {
        self.listed.is_none_or(|(at, sequence)| {
            sequence != self.system.sequence() || !(0..LIST_INTERVAL).contains(&(clock - at))
        })
    }

    /// Sends the events that have not been sent, and the list when it is due. The events.
    ///
    /// # Errors
    /// When a message cannot be encoded, or what `send` says.
    pub fn publish<E: From<CdrError>>(
        &mut self,
        header: Header,
        clock: Time,
        mut send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<Vec<AlarmEvent>, E> {
        let events = std::mem::take(&mut self.journal);
        for event in &events {
            to_cdr_into(event, &mut self.bytes)?;
            send(Encoded {
                topic: &topics::ALARM_EVENTS,
                stamp: event.header.stamp.to_nanoseconds(),
                cdr: &self.bytes,
            })?;
        }
        if self.list_is_due(clock) {
            self.listed = Some((clock, self.system.sequence()));
            let stamp = header.stamp.to_nanoseconds();
            to_cdr_into(&self.list(header), &mut self.bytes)?;
            send(Encoded {
                topic: &topics::ALARMS,
                stamp,
                cdr: &self.bytes,
            })?;
        }
        Ok(events)
    }

    /// All alarms as they stand, the worst first.
    pub fn list(&self, header: Header) -> AlarmList {
        fill::list(&self.system, &self.shown, &self.restored, header)
    }

    /// Events so far.
    pub fn sequence(&self) -> u64 {
        self.system.sequence()
    }

    /// What is to be kept over a restart.
    pub fn save(&self) -> Saved {
        self.system.save()
    }

    /// How many alarms there have been.
    pub fn figures(&self) -> Figures {
        self.system.statistics().figures()
    }

    /// How many of each alarm there have been.
    pub fn statistics(&self) -> &Statistics {
        self.system.statistics()
    }
}

fn system(config: &Config) -> AlarmSystem {
    let definitions = AlarmId::ALL.map(|id| id.define(&config.alarms)).to_vec();
    AlarmSystem::new(definitions, config.alarms.longest_shelving)
}
