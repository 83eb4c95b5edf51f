//! One alarm: when a condition becomes a change.

use serde::{Deserialize, Serialize};

use crate::{Change, Priority, Standing, Time, Unshelving, span};

/// How long a condition must stand or be gone before it counts (s).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Delays {
    /// Before the alarm is active, or its priority rises.
    pub on: f64,
    /// Before it has returned, or its priority falls.
    pub off: f64,
}

/// A condition as it is at an instant.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Observation<'a> {
    /// Its priority; none while it is not there.
    pub priority: Option<Priority>,
    /// The plant is in a state in which it means nothing.
    pub suppressed: bool,
    /// What it is judged by, in a sentence.
    pub evidence: &'a str,
}

/// State of an alarm with the timers of its delays.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Timed {
    pub(crate) standing: Standing,
    /// When its present state began.
    pub(crate) since: Time,
    /// Per priority: since when the condition has had at least it without a break.
    present_since: [Option<Time>; 3],
    /// Per priority: since when it has had less without a break.
    absent_since: [Option<Time>; 3],
}

impl Timed {
    /// The next change that an observation brings, if any. To be applied and asked again until there is none.
    pub(crate) fn next(&mut self, time: Time, observed: &Observation<'_>, delays: Delays) -> Option<Change> {
        let standing = self.standing;
        if standing.is_out_of_service() {
            return None;
        }
        if observed.suppressed != standing.is_suppressed() {
            return Some(if observed.suppressed {
                Change::Suppressed
            } else {
                Change::Released
            });
        }
        if observed.suppressed {
            self.forget();
            return self.end_of_shelf(time, standing.active());
        }
        self.keep_time(time, observed.priority);
        let active = standing.active();
        let level = self.level(time, active, delays);
        let change = match (active, level) {
            (None, Some(priority)) => Change::Activated(priority),
            (Some(before), Some(now)) if now > before => Change::Raised(now),
            (Some(before), Some(now)) if now < before => Change::Lowered(now),
            (Some(_), None) => Change::Returned,
            _ => return self.end_of_shelf(time, active),
        };
        Some(change)
    }

    /// Forgets the timers: a condition that comes now has all its delay before it.
    pub(crate) fn forget(&mut self) {
        self.present_since = [None; 3];
        self.absent_since = [None; 3];
    }

    /// Whether a shelving is over by its time or by what it does not cover.
    pub(crate) fn end_of_shelf(&self, time: Time, active: Option<Priority>) -> Option<Change> {
        let shelf = self.standing.shelf()?;
        if active > Some(shelf.covers) {
            Some(Change::Unshelved(Unshelving::Raised))
        } else if time >= shelf.until {
            Some(Change::Unshelved(Unshelving::Expired))
        } else {
            None
        }
    }

    fn keep_time(&mut self, time: Time, priority: Option<Priority>) {
        for level in Priority::ALL {
            let index = level as usize;
            let (begins, ends) = if priority >= Some(level) {
                (&mut self.present_since[index], &mut self.absent_since[index])
            } else {
                (&mut self.absent_since[index], &mut self.present_since[index])
            };
            *ends = None;
            // A clock that goes back begins the delay anew.
            *begins = Some(begins.map_or(time, |since| since.min(time)));
        }
    }

    /// The priority that has stood long enough, or has not been gone for long enough.
    fn level(&self, time: Time, active: Option<Priority>, delays: Delays) -> Option<Priority> {
        let lasted = |since: Option<Time>, delay: f64| since.is_some_and(|since| time - since >= span(delay));
        Priority::ALL.into_iter().rev().find(|level| {
            let index = *level as usize;
            lasted(self.present_since[index], delays.on)
                || (active >= Some(*level) && !lasted(self.absent_since[index], delays.off))
        })
    }
}
