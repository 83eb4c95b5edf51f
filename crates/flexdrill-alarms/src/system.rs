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
    /// The identifier for programs, which a restart uses to restore the alarm.
    pub id: &'static str,
    /// Its delays.
    pub delays: Delays,
    /// False for an alarm out of service.
    pub in_service: bool,
}

/// The present state of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Alarm {
    /// Its state.
    pub standing: Standing,
    /// The begin of the present state.
    pub since: Time,
}

/// A fixed set of alarms. Every method appends the events that it causes to the journal.
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

    /// Restores a saved state for the ids that it contains; all other alarms begin as normal. Call it before anything
    /// else.
    ///
    /// # Errors
    /// When another version saved the state.
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

    /// The state to save.
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

    /// The definitions in the order of the alarms' indices.
    pub fn definitions(&self) -> &[Definition] {
        &self.definitions
    }

    /// The present state of an alarm; normal for an index that does not exist.
    pub fn alarm(&self, index: usize) -> Alarm {
        self.alarms
            .get(index)
            .map_or_else(|| Alarm::of(&Timed::default()), Alarm::of)
    }

    /// The index of an alarm.
    ///
    /// # Errors
    /// When no alarm has the id.
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

    /// The number of events so far.
    pub fn sequence(&self) -> u64 {
        self.sequence
    }

    /// The counts and figures so far.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Takes alarms out of service or puts them back, as their definitions say after a start or a change.
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

    /// Observes the condition of an alarm.
    pub fn observe(&mut self, index: usize, time: Time, observed: &Observation<'_>, events: &mut Vec<Event>) {
        let Some(delays) = self.definitions.get(index).map(|definition| definition.delays) else {
            return;
        };
        // Each change brings the state closer to the observation. The longest chain, for a suppressed alarm whose shelving
        // has ended, is shorter than this bound.
        for _ in 0..8 {
            let Some(change) = self.alarms[index].next(time, observed, delays) else {
                break;
            };
            let no_operator = Operator { name: "", reason: "" };
            let before = self.alarms[index].standing;
            self.change(index, time, change, &no_operator, observed.evidence, events);
            let after = self.alarms[index].standing;
            let gone = before.active().is_some() && after.active().is_none();
            if gone && after.shelf().is_some_and(|shelf| shelf.one_shot) {
                let change = Change::Unshelved(Unshelving::Returned);
                self.change(index, time, change, &no_operator, observed.evidence, events);
            }
        }
    }

    /// Enters into the journal that what an alarm is judged against was adjusted, by whom and how. An index that does not
    /// exist enters nothing.
    pub fn adjusted(&mut self, index: usize, time: Time, by: &Operator<'_>, events: &mut Vec<Event>) {
        if index < self.alarms.len() {
            self.change(index, time, Change::Adjusted, by, "", events);
        }
    }

    /// Advances the clock of requests, for shelvings and figures. Call it before the observations of that time, which may
    /// carry the time of another clock. When the clock steps back, shelvings end, because their remaining time would be
    /// unknown.
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

    /// Acknowledges an alarm.
    ///
    /// # Errors
    /// When the request has no operator, or there is nothing to acknowledge.
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

    /// Acknowledges all alarms. Returns how many there were.
    ///
    /// # Errors
    /// When the request has no operator.
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

    /// Shelves an alarm, also one that is shelved already. Returns the end of the shelving.
    ///
    /// # Errors
    /// When operator or reason is missing, the alarm is out of service, or the duration is outside its bounds.
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

    /// Ends a shelving.
    ///
    /// # Errors
    /// When the request has no operator, or the alarm is not shelved.
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
