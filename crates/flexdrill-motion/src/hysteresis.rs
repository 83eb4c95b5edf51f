//! Hysteresis of a level: it rises at once and falls late.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::hazards::Hold;

/// A level between the conditions that raise it and the weaker ones that hold it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Hysteresis {
    pub(super) level: Severity,
    /// Model time at which the level was reached (s).
    pub(super) since: f64,
    /// Time for which the conditions that hold the level have not been met (s).
    unmet_for: f64,
    /// Model time at which the conditions that hold WATCH, WARNING and CRITICAL were met last (s).
    pub(super) met: [f64; 3],
}

/// Result of an update.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Transition {
    /// The level rose.
    Rose,
    /// The conditions that hold the level are met.
    Stands,
    /// They are not met: the level falls at the end of the hold-off.
    Fades,
}

impl Hysteresis {
    /// Updates the level at model time `time` (s), `elapsed` (s) after the last update: the conditions met now raise it
    /// to `raised` and hold it at `held`. After `hold_off` (s) without the conditions it falls to `held`.
    pub(super) fn update(
        &mut self,
        time: f64,
        elapsed: f64,
        raised: Severity,
        held: Severity,
        hold_off: f64,
    ) -> Transition {
        for (level, met) in Severity::RAISED.into_iter().zip(&mut self.met) {
            if level <= raised.max(held) {
                *met = time;
            }
        }
        if raised > self.level {
            self.reach(raised, time);
            return Transition::Rose;
        }
        if held >= self.level {
            self.unmet_for = 0.0;
            return Transition::Stands;
        }
        self.unmet_for += elapsed;
        if self.unmet_for >= hold_off {
            self.reach(held, time);
        }
        Transition::Fades
    }

    fn reach(&mut self, level: Severity, time: f64) {
        (self.level, self.since, self.unmet_for) = (level, time, 0.0);
    }
}

impl AlarmThresholds {
    /// Threshold of a level; that of WATCH for OK.
    pub fn of(&self, level: Severity) -> f64 {
        self.levels[(level as usize).saturating_sub(1)]
    }
}

/// Values from which the levels WATCH, WARNING and CRITICAL are reached, and how they are left.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AlarmThresholds {
    /// WATCH, WARNING, CRITICAL; in the unit of the judged value.
    pub levels: [f64; 3],
    /// Part of a threshold by which the value must fall below it, 0 to 1.
    pub hysteresis: f64,
    /// Time for which it must stay there before the level falls (s).
    pub hold_off: f64,
}

/// An alarm on one value.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    hysteresis: Hysteresis,
    /// Largest value since the level was reached, and the model time of it (s); the newest while the level is OK.
    worst: f64,
    worst_at: f64,
}

impl Alarm {
    /// Takes a value that stood for `elapsed` (s) until model time `time` (s); says whether the level rose or stands
    /// above OK for this value.
    pub fn update(&mut self, time: f64, elapsed: f64, value: f64, thresholds: &AlarmThresholds) -> bool {
        let reached = |factor: f64| {
            Severity::RAISED
                .into_iter()
                .zip(thresholds.levels)
                .filter(|(_, threshold)| value >= threshold * factor)
                .map(|(level, _)| level)
                .next_back()
                .unwrap_or_default()
        };
        let (raised, held) = (reached(1.0), reached(1.0 - thresholds.hysteresis));
        let before = self.severity();
        let change = self.hysteresis.update(time, elapsed, raised, held, thresholds.hold_off);
        let now = self.severity();
        if now == Severity::Ok || now != before || value > self.worst {
            (self.worst, self.worst_at) = (value, time);
        }
        match change {
            Transition::Rose => true,
            Transition::Stands => now > Severity::Ok,
            Transition::Fades => false,
        }
    }

    /// Largest value since the level was reached; the newest while the level is OK.
    pub fn worst(&self) -> f64 {
        self.worst
    }

    /// Model time of that value (s).
    pub fn worst_at(&self) -> f64 {
        self.worst_at
    }

    /// Model time at which the level was reached (s).
    pub fn since(&self) -> f64 {
        self.hysteresis.since
    }

    /// What holds the level at model time `now` (s).
    pub fn hold(&self, now: f64) -> Hold {
        Hold::of(self.severity(), self.hysteresis.met, now)
    }

    /// The present level.
    pub fn severity(&self) -> Severity {
        self.hysteresis.level
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRESHOLDS: AlarmThresholds = AlarmThresholds {
        levels: [1.0, 2.0, 4.0],
        hysteresis: 0.1,
        hold_off: 1.0,
    };

    #[test]
    fn rises_at_once_and_falls_after_the_hold_off() {
        let mut level = Alarm::default();
        assert!(!level.update(0.0, 0.1, 0.99, &THRESHOLDS));
        assert!(level.update(0.0, 0.1, 5.0, &THRESHOLDS));
        assert_eq!(level.severity(), Severity::Critical);
        for _ in 0..9 {
            assert!(!level.update(0.0, 0.1, 2.5, &THRESHOLDS));
            assert_eq!(level.severity(), Severity::Critical);
        }
        level.update(0.0, 0.11, 2.5, &THRESHOLDS);
        assert_eq!(level.severity(), Severity::Warning);
    }

    #[test]
    fn does_not_flap_around_a_threshold() {
        let mut level = Alarm::default();
        level.update(0.0, 0.1, 2.0, &THRESHOLDS);
        for step in 0..1000 {
            let value = 2.0 + 0.15 * f64::from(step).sin();
            level.update(0.0, 0.1, value, &THRESHOLDS);
            assert_eq!(level.severity(), Severity::Warning);
        }
    }
}
