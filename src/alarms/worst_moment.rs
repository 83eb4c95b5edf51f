//! The worst moment of an alarm: its condition and its time, kept for as long as the alarm stands or is not yet
//! acknowledged. The present motion may be another one, whose figures would contradict the alarm.

use super::finding::Finding;
use super::sentence::capitalized;
use flexdrill_alarms::{Priority, Standing, Time};
use flexdrill_text::time_of_day;

/// Age of a worst moment from which on the text gives its time (ns): to a person, a younger one is the present.
const RECENT: Time = 1_000_000_000;

/// The worst moment of an alarm since its priority was reached.
#[derive(Debug, Clone, Default)]
pub(super) struct WorstMoment {
    /// The condition at its worst; the default while the alarm is normal, and while an alarm that an earlier run left
    /// standing has not been observed.
    pub finding: Finding,
    /// The time of the worst moment (ns).
    pub at: Time,
    /// When the condition for the published priority ended; none while it is met.
    pub ended: Option<Time>,
    /// The present priority of the condition.
    pub present: Option<Priority>,
    /// When the condition for the published priority was last met.
    met: Time,
    /// When the condition was last observed.
    observed: Time,
}

impl WorstMoment {
    /// Adds an observation at an instant, after the alarm has observed it.
    pub fn observe(&mut self, finding: Finding, time: Time, standing: &Standing) {
        self.observed = time;
        self.present = finding.priority.filter(|_| finding.ended.is_none());
        // The book clears the moment of a normal alarm after the event of its return.
        if standing
            .priority()
            .is_some_and(|published| finding.priority >= Some(published))
        {
            self.at = finding.seen.unwrap_or(time);
            self.ended = finding.ended;
            self.met = finding.ended.unwrap_or(time);
            self.finding = finding;
        } else if self.is_known() && self.ended.is_none() {
            self.ended = Some(self.met);
        }
    }

    /// Whether the condition has been observed, which after a restart takes a first observation.
    pub fn is_known(&self) -> bool {
        self.finding.priority.is_some()
    }

    /// The evidence, with the time of the worst moment and of the end where they are past.
    pub fn evidence(&self, standing: &Standing) -> String {
        let mut times = Vec::new();
        if self.is_known() && self.observed.saturating_sub(self.at) > RECENT {
            times.push(format!("worst at {}", time_of_day(self.at)));
        }
        if let Some(ended) = self.ended {
            let at = time_of_day(ended);
            times.push(match (self.present, standing.active()) {
                (Some(_), _) => format!("less severe since {at}"),
                (None, Some(_)) => format!("ended at {at}, being watched"),
                (None, None) => format!("ended at {at}"),
            });
        }
        match times.is_empty() {
            true => self.finding.evidence.clone(),
            false => format!("{} {}.", self.finding.evidence, capitalized(&times.join("; "))),
        }
    }
}
