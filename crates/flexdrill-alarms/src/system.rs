//! A fixed set of alarms.

use crate::alarm::Timed;
use crate::request::named;
use crate::saved::SavedAlarm;
use crate::{
    Change, Delays, Event, FORMAT, Observation, Operator, Priority, Refusal, Saved, SavedError, Shelf, Shelving,
    Standing, Statistics, Time, Unshelving, span,
};

/// An alarm of the set.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    /// Its name for programs, by which it is found again after a restart.
    pub id: &'static str,
    /// Its delays.
    pub delays: Delays,
    /// False takes it out of service.
    pub in_service: bool,
}

/// One alarm as it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Alarm {
    /// Its state.
    pub standing: Standing,
    /// When its present state began.
    pub since: Time,
}

/// Alarms with their journal's numbers, requests and figures. Every method appends the events that it causes.
#[derive(Debug, Clone, PartialEq)]
pub struct AlarmSystem {
    definitions: Vec<Definition>,
    alarms: Vec<Timed>,
    statistics: Statistics,
    sequence: u64,
    longest_shelving: f64,
}

impl AlarmSystem {
    /// All alarms normal. `longest_shelving` is in s.
    pub fn new(definitions: Vec<Definition>, longest_shelving: f64) -> Self {
        let count = definitions.len();
        Self {
            definitions,
            alarms: vec![Timed::default(); count],
            statistics: Statistics::new(count),
            sequence: 0,
            longest_shelving,
        }
    }

    /// Takes a saved state up where the ids are the same; alarms that it does not have begin anew. To be called before
    /// anything else.
    ///
    /// # Errors
    /// When another version saved it.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), SavedError> {
        if saved.format != FORMAT {
            return Err(SavedError::Format { found: saved.format });
        }
        let same = saved.alarms.iter().map(|alarm| alarm.id.as_str());
        let same = same.eq(self.definitions.iter().map(|definition| definition.id));
        if same && saved.statistics.is_of(self.definitions.len()) {
            self.statistics = saved.statistics.clone();
        }
        self.sequence = saved.sequence;
        for (definition, alarm) in self.definitions.iter().zip(&mut self.alarms) {
            if let Some(saved) = saved.alarms.iter().find(|saved| saved.id == definition.id) {
                *alarm = saved.state.clone();
            }
        }
        Ok(())
    }

    /// The state to be kept.
    pub fn save(&self) -> Saved {
        let alarms = self.definitions.iter().zip(&self.alarms);
        Saved {
            format: FORMAT,
            sequence: self.sequence,
            alarms: alarms
                .map(|(definition, state)| SavedAlarm {
                    id: definition.id.to_owned(),
                    state: state.clone(),
                })
                .collect(),
            statistics: self.statistics.clone(),
        }
    }

    /// The definitions, in the order that alarms are counted in.
    pub fn definitions(&self) -> &[Definition] {
        &self.definitions
    }

    /// An alarm as it stands; normal for a number that is none.
    pub fn alarm(&self, index: usize) -> Alarm {
        self.alarms
            .get(index)
            .map_or_else(|| Alarm::of(&Timed::default()), Alarm::of)
    }

    /// The number of an alarm.
    ///
    /// # Errors
    /// When there is none of that id.
    pub fn find(&self, id: &str) -> Result<usize, Refusal> {
        let found = self.definitions.iter().position(|definition| definition.id == id);
        found.ok_or_else(|| self.unknown(id))
    }

    fn unknown(&self, alarm: &str) -> Refusal {
        Refusal::Unknown {
            alarm: alarm.to_owned(),
            known: self.definitions.iter().map(|definition| definition.id).collect(),
        }
    }

    /// Events so far.
    pub fn sequence(&self) -> u64 {
        self.sequence
    }

    /// How many alarms there have been.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Puts alarms out of service and back as their definitions say, after a start or a change of configuration.
    pub fn follow_definitions(&mut self, time: Time, events: &mut Vec<Event>) {
        for index in 0..self.alarms.len() {
            let out = !self.definitions[index].in_service;
            if out != self.alarms[index].standing.is_out_of_service() {
                let change = if out { Change::TakenOut } else { Change::PutBack };
                self.alarms[index].forget();
                self.change(index, time, change, &Operator { name: "", reason: "" }, "", events);
            }
        }
    }

    /// Takes the condition of an alarm.
    pub fn observe(&mut self, index: usize, time: Time, observed: &Observation<'_>, events: &mut Vec<Event>) {
        let Some(delays) = self.definitions.get(index).map(|definition| definition.delays) else {
            return;
        };
        // Each change brings the alarm nearer to what is observed; the longest way, suppressed under a shelf that has
        // ended, is shorter than this.
        for _ in 0..8 {
            let Some(change) = self.alarms[index].next(time, observed, delays) else {
                break;
            };
            let nobody = Operator { name: "", reason: "" };
            let before = self.alarms[index].standing;
            self.change(index, time, change, &nobody, observed.evidence, events);
            let after = self.alarms[index].standing;
            let gone = before.active().is_some() && after.active().is_none();
            if gone && after.shelf().is_some_and(|shelf| shelf.one_shot) {
                let change = Change::Unshelved(Unshelving::Returned);
                self.change(index, time, change, &nobody, observed.evidence, events);
            }
        }
    }

    /// Lets time pass on the clock of requests, for shelves and figures. To be called before what happens then is
    /// observed, which may carry the time of another clock. When the clock goes back, shelves end: nobody could say how
    /// long they would last.
    pub fn advance(&mut self, time: Time, events: &mut Vec<Event>) {
        let went_back = self.statistics.last().is_some_and(|last| time < last);
        self.statistics.advance(time);
        for index in 0..self.alarms.len() {
            let alarm = &self.alarms[index];
            let end = if went_back && alarm.standing.shelf().is_some() {
                Some(Change::Unshelved(Unshelving::Expired))
            } else {
                alarm.end_of_shelf(time, alarm.standing.active())
            };
            if let Some(change) = end {
                self.change(index, time, change, &Operator { name: "", reason: "" }, "", events);
            }
        }
    }

    /// An operator says that he knows.
    ///
    /// # Errors
    /// When nobody says so, or there is nothing to acknowledge.
    pub fn acknowledge(
        &mut self,
        index: usize,
        time: Time,
        by: &Operator<'_>,
        events: &mut Vec<Event>,
    ) -> Result<(), Refusal> {
        let (alarm, standing) = self.asked(index, by)?;
        if standing.unacknowledged().is_none() {
            let state = standing.state();
            return Err(Refusal::NothingToAcknowledge { alarm, state });
        }
        self.change(index, time, Change::Acknowledged, by, "", events);
        Ok(())
    }

    /// An operator says that he knows all that is to be known; how many alarms that were.
    ///
    /// # Errors
    /// When nobody says so.
    pub fn acknowledge_all(
        &mut self,
        time: Time,
        by: &Operator<'_>,
        events: &mut Vec<Event>,
    ) -> Result<usize, Refusal> {
        named(by)?;
        let mut count = 0;
        for index in 0..self.alarms.len() {
            if self.acknowledge(index, time, by, events).is_ok() {
                count += 1;
            }
        }
        Ok(count)
    }

    /// An operator puts an alarm aside. One that is shelved already is shelved anew. Until when.
    ///
    /// # Errors
    /// When nobody asks or gives no reason, the alarm is out of service, or the time is too long or none.
    pub fn shelve(
        &mut self,
        index: usize,
        time: Time,
        how: Shelving,
        by: &Operator<'_>,
        events: &mut Vec<Event>,
    ) -> Result<Time, Refusal> {
        let (alarm, standing) = self.asked(index, by)?;
        if by.reason.trim().is_empty() {
            return Err(Refusal::NoReason { alarm });
        }
        if standing.is_out_of_service() {
            return Err(Refusal::OutOfService { alarm });
        }
        let most = self.longest_shelving;
        let (asked, one_shot) = match how {
            Shelving::OneShot => (most, true),
            Shelving::Timed(asked) => (asked, false),
        };
        if !(asked > 0.0 && asked <= most) {
            return Err(Refusal::Duration { alarm, asked, most });
        }
        let until = time.saturating_add(span(asked));
        let shelf = Shelf {
            until,
            one_shot,
            covers: standing.active().unwrap_or(Priority::Medium).max(Priority::Medium),
        };
        if standing.shelf() != Some(shelf) {
            self.change(index, time, Change::Shelved(shelf), by, "", events);
        }
        Ok(until)
    }

    /// An operator wants an alarm back.
    ///
    /// # Errors
    /// When nobody asks, or it is not shelved.
    pub fn unshelve(
        &mut self,
        index: usize,
        time: Time,
        by: &Operator<'_>,
        events: &mut Vec<Event>,
    ) -> Result<(), Refusal> {
        let (alarm, standing) = self.asked(index, by)?;
        if standing.shelf().is_none() {
            let state = standing.state();
            return Err(Refusal::NotShelved { alarm, state });
        }
        self.change(index, time, Change::Unshelved(Unshelving::Asked), by, "", events);
        Ok(())
    }

    fn asked(&self, index: usize, by: &Operator<'_>) -> Result<(&'static str, Standing), Refusal> {
        named(by)?;
        match (self.definitions.get(index), self.alarms.get(index)) {
            (Some(definition), Some(alarm)) => Ok((definition.id, alarm.standing)),
            _ => Err(self.unknown(&index.to_string())),
        }
    }

    fn change(
        &mut self,
        index: usize,
        time: Time,
        change: Change,
        by: &Operator<'_>,
        evidence: &str,
        events: &mut Vec<Event>,
    ) {
        let alarm = &mut self.alarms[index];
        let before = alarm.standing;
        alarm.standing.apply(&change);
        let (from, to) = (before.state(), alarm.standing.state());
        if from != to {
            alarm.since = time;
        }
        self.sequence += 1;
        let event = Event {
            sequence: self.sequence,
            time,
            alarm: index,
            change,
            from,
            to,
            priority: alarm
                .standing
                .active()
                .or(before.priority().max(alarm.standing.priority())),
            operator: by.name.to_owned(),
            reason: by.reason.to_owned(),
            evidence: evidence.to_owned(),
        };
        if event.annunciates() {
            self.statistics.count(index, event.priority);
        } else if event.rises() {
            self.statistics.raise(index, event.priority);
        }
        events.push(event);
    }
}

impl Alarm {
    fn of(alarm: &Timed) -> Self {
        Self {
            standing: alarm.standing,
            since: alarm.since,
        }
    }
}
