//! One alarm with its delays, which decide when a condition becomes a change.

use serde::{Deserialize, Serialize};

use crate::{Change, Priority, Standing, Time, Unshelving, span};

/// How long a condition must stand or be absent before the alarm changes (s).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Delays {
    /// Before the alarm becomes active or its priority rises.
    pub on: f64,
    /// Before the alarm returns or its priority falls.
    pub off: f64,
}

/// The state of a condition at an instant.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Observation<'a> {
    /// The priority of the condition; none while it is not met.
    pub priority: Option<Priority>,
    /// Whether the condition has no meaning in the present state of the plant.
    pub suppressed: bool,
    /// The evidence in a sentence.
    pub evidence: &'a str,
}

/// The state of an alarm with the timers of its delays.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Timed {
    pub(crate) standing: Standing,
    /// The begin of the present state.
    pub(crate) since: Time,
    /// Per priority: the begin of the uninterrupted time in which the condition has had at least this priority.
    present_since: [Option<Time>; 3],
    /// Per priority: the begin of the uninterrupted time in which the condition has had less.
    absent_since: [Option<Time>; 3],
}

impl Timed {
    /// The next change due to an observation, if any. The caller applies it and asks again until there is none.
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

    /// Clears the timers, so that a new condition has its whole delay ahead.
    pub(crate) fn forget(&mut self) {
        self.present_since = [None; 3];
        self.absent_since = [None; 3];
    }

    /// The end of a shelving by its time or by a priority that it does not cover.
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
            // A clock that steps back restarts the delay.
            *begins = Some(begins.map_or(time, |since| since.min(time)));
        }
    }

    /// The priority that has stood for the on-delay, or that has not been absent for the off-delay.
    fn level(&self, time: Time, active: Option<Priority>, delays: Delays) -> Option<Priority> {
        let lasted = |since: Option<Time>, delay: f64| since.is_some_and(|since| time - since >= span(delay));
        Priority::ALL.into_iter().rev().find(|level| {
            let index = *level as usize;
            lasted(self.present_since[index], delays.on)
                || (active >= Some(*level) && !lasted(self.absent_since[index], delays.off))
        })
    }
}
