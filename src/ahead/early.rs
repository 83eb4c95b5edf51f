//! When a member ends before its horizon: once its alarms have ended, or can no longer end in time.

use super::measured::hazard;
use crate::alarms::{AlarmBook, AlarmId, AlarmSet};
use flexdrill_alarms::Priority;
use flexdrill_core::twin::Snapshot;
use flexdrill_motion::{Hold, Severity};

/// When a member ends before its horizon.
pub(super) struct Early {
    /// The alarms that are to end.
    pub alarms: AlarmSet,
    /// Time for which they must stay away (s).
    pub lasting: f64,
    /// Least looks of the member.
    pub least: u64,
    /// The alarm without whose end the rest says nothing.
    pub leading: AlarmId,
    /// Looks from which on a condition that is met keeps its alarm for the rest of the time that alarms have to end.
    pub hopeless: u64,
    /// Model time from which on the condition of none of the alarms was met (s); none while one is.
    pub over: Option<f64>,
}

impl Early {
    /// Takes a look. An alarm outlasts its condition by the hold-off of the analysis and by its off-delay, in which the motion
    /// has ended already.
    pub fn follow(&mut self, snapshot: &Snapshot, book: &AlarmBook) {
        let ended = self.alarms.iter().map(|id| match (book.active(id), hazard(id)) {
            (None, _) => Some(f64::NEG_INFINITY),
            (Some(_), Some(kind)) => {
                let of = snapshot.hazards.of(kind);
                match of.hold {
                    Hold::Ended { at } => Some(at),
                    // The hold-off is over too, and the off-delay runs.
                    _ if of.severity == Severity::Ok => Some(snapshot.time),
                    Hold::Met | Hold::Less { .. } => None,
                }
            }
            (Some(_), None) => None,
        });
        let ended = ended.collect::<Option<Vec<f64>>>();
        self.over = ended.map(|ended| {
            let last = ended.into_iter().fold(f64::NEG_INFINITY, f64::max);
            // Where all alarms have ended, they did between two looks.
            let last = if last.is_finite() { last } else { snapshot.time };
            self.over.unwrap_or(last)
        });
    }

    /// The priority of the leading alarm, where it stands and its condition is met at a level that calls at any speed and
    /// weight.
    pub fn is_met(&self, snapshot: &Snapshot, book: &AlarmBook) -> Option<Priority> {
        let of = snapshot.hazards.of(hazard(self.leading)?);
        book.active(self.leading)
            .filter(|_| of.hold == Hold::Met && of.severity >= Severity::Warning)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use flexdrill_alarms::span;
    use flexdrill_config::Config;
    use flexdrill_motion::{DriveState, ENDED_AFTER, HazardKind};

    /// Stick-slip whose condition is met until 10 s, with the hold-off of 5 s, look by look, in tenths of a second: what is
    /// known of it at each, and whether its alarm stands.
    fn followed(until: u32) -> (Early, bool, Option<Priority>) {
        let config = Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap();
        let mut book = AlarmBook::prompt(Arc::new(config), 0);
        let mut early = Early {
            alarms: [AlarmId::StickSlip, AlarmId::Shock].into_iter().collect(),
            lasting: 15.0,
            least: 250,
            leading: AlarmId::StickSlip,
            hopeless: 0,
            over: None,
        };
        let mut snapshot = Snapshot::default();
        snapshot.hazards.drive = DriveState::Turning;
        let mut met = None;
        for look in 1..=until {
            let time = 0.1 * f64::from(look);
            snapshot.time = time;
            let of = &mut snapshot.hazards.list[HazardKind::StickSlip as usize];
            of.severity = if time < 15.0 { Severity::Critical } else { Severity::Ok };
            of.hold = match time {
                time if (10.0 + ENDED_AFTER..15.0).contains(&time) => Hold::Ended { at: 10.0 },
                _ => Hold::Met,
            };
            book.observe_tool(&snapshot, span(time));
            early.follow(&snapshot, &book);
            met = early.is_met(&snapshot, &book);
        }
        (early, book.active(AlarmId::StickSlip).is_some(), met)
    }

    #[test]
    fn a_motion_is_over_from_the_end_of_its_condition_on() {
        let at = |look| {
            let (early, stands, met) = followed(look);
            (early.over, stands, met)
        };
        let high = Some(Priority::High);
        assert_eq!(at(99), (None, true, high));
        // A condition counts as met for a moment after its end.
        assert_eq!(at(112), (None, true, high));
        assert_eq!(at(118), (Some(10.0), true, None));
        // The off-delay of a member's alarms, then none stands: what was over has been since 10 s.
        assert_eq!(at(155), (Some(10.0), true, None));
        assert_eq!(at(165), (Some(10.0), false, None));
    }
}
