//! The worst moment of an alarm: its condition and its time, kept for as long as the alarm stands or is not yet
//! acknowledged. The present motion may be another one, whose figures would contradict the alarm.

use super::finding::Finding;
use super::sentence::capitalized;
use flexdrill_alarms::{Priority, Standing, Time};
use flexdrill_text::time_of_day;

/// Age of a worst moment from which on the text gives its time (ns): to a person, a younger one is the present.
const RECENT: Time = 1_000_000_000;

/// Time for which an alarm keeps its priority while its motion comes and goes with a lower one (ns): without it an
/// operator who has acknowledged the alarm is called again with every stronger episode. Assumption.
const PRIORITY_HELD: Time = 120_000_000_000;

/// The worst moment of an alarm since its priority was reached.
#[derive(Debug, Clone, Default)]
pub(super) struct WorstMoment {
    /// The condition at its worst; the default while the alarm is normal, and while an alarm that an earlier run left
    /// standing has not been observed.
    pub finding: Finding,
    /// The time of the worst moment (ns).
    pub at: Time,
    /// Times that the condition has come since the alarm was normal.
    pub episodes: u32,
    /// The priority with which the condition counts. A condition that has come back counts until its alarm returns: one
    /// that pauses for some seconds has not ended.
    pub counts: Option<Priority>,
    /// The present priority of the condition.
    present: Option<Priority>,
    /// The published priority of the alarm.
    published: Option<Priority>,
    /// When the first episode began.
    first: Time,
    /// When the condition for the published priority was last met.
    reached: Time,
    /// When the condition was last met at all.
    met: Time,
    /// When the condition was last observed.
    observed: Time,
}

impl WorstMoment {
    /// Adds an observation at an instant, after the alarm has observed it.
    pub fn observe(&mut self, finding: Finding, time: Time, standing: &Standing) {
        let present = finding.present();
        if present.is_some() && self.present.is_none() {
            self.first = if self.episodes == 0 { time } else { self.first };
            self.episodes = self.episodes.saturating_add(1);
        }
        (self.observed, self.published) = (time, standing.priority());
        if present.is_some() {
            self.met = time;
        } else if let Some(ended) = finding.ended {
            self.met = ended;
        }
        let pauses = self.episodes > 1 && standing.active().is_some();
        self.counts = present.or(self.counts.filter(|_| pauses));
        self.present = present;
        // The book clears the moment of a normal alarm after the event of its return.
        if self.published.is_some() && finding.priority >= self.published {
            self.at = finding.seen.unwrap_or(time);
            self.reached = finding.ended.unwrap_or(time);
            self.finding = finding;
        }
    }

    /// The priority of a condition that is observed at an instant, for an alarm of the priority `active`: that of motion
    /// that comes and goes does not fall at once.
    pub fn held(&self, priority: Option<Priority>, active: Option<Priority>, time: Time) -> Option<Priority> {
        let holds = self.episodes > 1 && (0..PRIORITY_HELD).contains(&time.saturating_sub(self.reached));
        priority.map(|priority| active.filter(|_| holds).map_or(priority, |active| priority.max(active)))
    }

    /// Whether the condition stands and had come by an instant (ns).
    pub fn stood_at(&self, time: Time) -> bool {
        self.counts.is_some() && self.first <= time
    }

    /// Whether the condition has been observed, which after a restart takes a first observation.
    pub fn is_known(&self) -> bool {
        self.finding.priority.is_some()
    }

    /// When the condition ended; none while it counts.
    pub fn ended(&self) -> Option<Time> {
        (self.is_known() && self.counts.is_none()).then_some(self.met)
    }

    /// When the condition last reached the published priority, while it counts with a lower one.
    pub fn less_severe(&self) -> Option<Time> {
        (self.counts.is_some() && self.counts < self.published).then_some(self.reached)
    }

    /// The evidence, with the time of the worst moment, of the end where they are past, and the count of a condition that
    /// comes and goes.
    pub fn evidence(&self, standing: &Standing) -> String {
        let mut times = Vec::new();
        if self.is_known() && self.observed.saturating_sub(self.at) > RECENT {
            times.push(format!("worst at {}", time_of_day(self.at)));
        }
        if self.episodes > 1 {
            let first = time_of_day(self.first);
            times.push(format!("it came {} times since {first}", self.episodes));
        }
        if let Some(ended) = self.ended() {
            let watched = standing.active().map_or("", |_| ", being watched");
            times.push(format!("ended at {}{watched}", time_of_day(ended)));
        } else if self.present.is_none() && self.is_known() {
            times.push(format!("last at {}", time_of_day(self.met)));
        } else if let Some(reached) = self.less_severe() {
            times.push(format!("less severe since {}", time_of_day(reached)));
        }
        match times.is_empty() {
            true => self.finding.evidence.clone(),
            false => format!("{} {}.", self.finding.evidence, capitalized(&times.join("; "))),
        }
    }
}
