//! What is shown of an alarm: the condition as it was at its worst, with its time, for as long as the alarm stands or
//! waits to be acknowledged. The present may already be another motion, whose figures would say the opposite of the
//! alarm.

use super::finding::Finding;
use super::sentence::capitalized;
use flexdrill_alarms::{Priority, Standing, Time};
use flexdrill_text::time_of_day;

/// Between a worst moment and the newest observation, from which on the text names the moment (ns): what is newer is
/// "now" to a person.
const RECENT: Time = 1_000_000_000;

/// An alarm's condition as it is shown.
#[derive(Debug, Clone, Default)]
pub(super) struct Shown {
    /// The condition at its worst; a default one while the alarm is normal, and where an earlier run left it standing.
    pub finding: Finding,
    /// When that was seen (ns).
    pub worst_at: Time,
    /// When the condition for the priority shown ended; none while it is met.
    pub ended: Option<Time>,
    /// The priority that the condition has at present.
    pub present: Option<Priority>,
    /// When the condition for the priority shown was met last.
    met: Time,
    /// When the condition was observed last.
    observed: Time,
}

impl Shown {
    /// Takes an observation at an instant, after the alarm has taken it.
    pub fn observe(&mut self, finding: Finding, time: Time, standing: &Standing) {
        self.observed = time;
        self.present = finding.priority.filter(|_| finding.ended.is_none());
        // An alarm that is normal is forgotten by the book, after the event of its return.
        if standing.priority().is_some_and(|shown| finding.priority >= Some(shown)) {
            self.worst_at = finding.seen.unwrap_or(time);
            self.ended = finding.ended;
            self.met = finding.ended.unwrap_or(time);
            self.finding = finding;
        } else if self.is_known() && self.ended.is_none() {
            self.ended = Some(self.met);
        }
    }

    /// Whether anything is known of the condition. After a restart nothing is until it is observed again.
    pub fn is_known(&self) -> bool {
        self.finding.priority.is_some()
    }

    /// The evidence with the time of the worst moment and of the end, where they are not now.
    pub fn evidence(&self, standing: &Standing) -> String {
        let mut times = Vec::new();
        if self.is_known() && self.observed.saturating_sub(self.worst_at) > RECENT {
            times.push(format!("worst at {}", time_of_day(self.worst_at)));
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
