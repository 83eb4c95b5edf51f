//! A level that rises at once and falls late.

use serde::{Deserialize, Serialize};

use super::Severity;

/// Values from which the levels WATCH, WARNING and CRITICAL are reached, and how they are left.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HeldThresholds {
    /// WATCH, WARNING, CRITICAL; in the unit of what is judged.
    pub levels: [f64; 3],
    /// Part of a threshold by which the value must fall below it, 0 to 1.
    pub hysteresis: f64,
    /// Time for which it must stay there before the level falls (s).
    pub hold_off: f64,
}

/// A level judged by one value.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldLevel {
    /// Where it stands.
    pub severity: Severity,
    /// How long the value has been below the level's threshold (s).
    below_for: f64,
}

const LEVELS: [Severity; 3] = [Severity::Watch, Severity::Warning, Severity::Critical];

impl HeldLevel {
    /// Takes a value that stood for `elapsed` (s); says whether the level rose or repeats its cause.
    pub fn update(&mut self, elapsed: f64, value: f64, thresholds: &HeldThresholds) -> bool {
        let reached = |factor: f64| {
            LEVELS
                .into_iter()
                .zip(thresholds.levels)
                .filter(|(_, threshold)| value >= threshold * factor)
                .map(|(level, _)| level)
                .next_back()
                .unwrap_or_default()
        };
        let raised = reached(1.0);
        if raised > self.severity {
            *self = Self {
                severity: raised,
                below_for: 0.0,
            };
            return true;
        }
        let held = reached(1.0 - thresholds.hysteresis);
        if held >= self.severity {
            self.below_for = 0.0;
            return self.severity > Severity::Ok;
        }
        self.below_for += elapsed;
        if self.below_for >= thresholds.hold_off {
            *self = Self {
                severity: held,
                below_for: 0.0,
            };
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRESHOLDS: HeldThresholds = HeldThresholds {
        levels: [1.0, 2.0, 4.0],
        hysteresis: 0.1,
        hold_off: 1.0,
    };

    #[test]
    fn rises_at_once_and_falls_after_the_hold_off() {
        let mut level = HeldLevel::default();
        assert!(!level.update(0.1, 0.99, &THRESHOLDS));
        assert!(level.update(0.1, 5.0, &THRESHOLDS));
        assert_eq!(level.severity, Severity::Critical);
        for _ in 0..9 {
            assert!(!level.update(0.1, 2.5, &THRESHOLDS));
            assert_eq!(level.severity, Severity::Critical);
        }
        level.update(0.11, 2.5, &THRESHOLDS);
        assert_eq!(level.severity, Severity::Warning);
    }

    #[test]
    fn does_not_flap_around_a_threshold() {
        let mut level = HeldLevel::default();
        level.update(0.1, 2.0, &THRESHOLDS);
        for step in 0..1000 {
            let value = 2.0 + 0.15 * f64::from(step).sin();
            level.update(0.1, value, &THRESHOLDS);
            assert_eq!(level.severity, Severity::Warning);
        }
    }
}
