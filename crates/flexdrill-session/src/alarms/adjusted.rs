//! What `calibration.follow` or a client changes of what the twin expects, as entries of the journal.

use flexdrill_alarms::Time;

use super::sentence::number;
use crate::messages::Residuals;

/// Time for which a change waits for those that follow it (ns), so that values which move every second make an entry per
/// minute.
const GATHERED: Time = 60_000_000_000;
/// Time without a change that ends the wait (ns).
const AT_REST: Time = 10_000_000_000;

/// A parameter as the journal names it: name, unit, digits.
const PARAMETERS: [(&str, &str, usize); 2] = [("friction factor", "", 3), ("torque tare", " N m", 1)];

/// The values in force by the journal, and since when they differ from those in force by the comparison.
#[derive(Debug, Clone, Default)]
pub(super) struct Adjusted {
    /// Friction factor and torque tare (N m) as last entered; `None` before the first comparison.
    entered: Option<[f64; 2]>,
    newest: [f64; 2],
    /// Times of the first and of the newest change that is not entered.
    changed: Option<(Time, Time)>,
}

impl Adjusted {
    /// Takes the values of a comparison at its stamp. Returns the entry that is due.
    pub(super) fn observe(&mut self, residuals: &Residuals, stamp: Time) -> Option<String> {
        let values = [residuals.applied_friction_factor, residuals.applied_torque_tare];
        let Some(entered) = self.entered else {
            (self.entered, self.newest) = (Some(values), values);
            return None;
        };
        if values != self.newest {
            let first = self.changed.map_or(stamp, |(first, _)| first);
            self.changed = Some((first, stamp));
            self.newest = values;
        }
        let (first, last) = self.changed?;
        let waits = (0..GATHERED).contains(&(stamp - first)) && (0..AT_REST).contains(&(stamp - last));
        if waits {
            return None;
        }
        self.changed = None;
        self.entered = Some(values);
        let configured = [residuals.configured_friction_factor, residuals.configured_torque_tare];
        let moved: Vec<String> = (0..2)
            .filter(|k| values[*k] != entered[*k])
            .map(|k| in_words(k, entered[k], values[k], configured[k]))
            .collect();
        (!moved.is_empty()).then(|| moved.join("; "))
    }
}

fn in_words(parameter: usize, from: f64, to: f64, configured: f64) -> String {
    let (name, unit, digits) = PARAMETERS[parameter];
    let write = |value| number(value, digits).unwrap_or_else(|| "a value out of range".to_owned());
    format!(
        "{name} from {} to {}{unit}, configured {}{unit}",
        write(from),
        write(to),
        write(configured)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Time = 1_000_000_000;

    fn at(factor: f64, tare: f64) -> Residuals {
        Residuals {
            applied_friction_factor: factor,
            configured_friction_factor: 1.0,
            applied_torque_tare: tare,
            ..Residuals::default()
        }
    }

    /// Entries with their seconds, of a factor and a tare by second.
    fn entries(values: impl Fn(i64) -> [f64; 2], seconds: i64) -> Vec<(i64, String)> {
        let mut adjusted = Adjusted::default();
        (0..seconds)
            .filter_map(|second| {
                let [factor, tare] = values(second);
                let entry = adjusted.observe(&at(factor, tare), second * SECOND)?;
                Some((second, entry))
            })
            .collect()
    }

    #[test]
    fn a_motion_makes_an_entry_per_minute_and_one_at_its_end() {
        let moves = |second: i64| [1.0 + 0.001 * second.clamp(100, 190) as f64 - 0.1, 0.0];
        let found = entries(moves, 300);
        let expected = [
            (161, "friction factor from 1.000 to 1.061, configured 1.000"),
            (200, "friction factor from 1.061 to 1.090, configured 1.000"),
        ];
        assert_eq!(found, expected.map(|(second, text)| (second, text.to_owned())));
    }

    #[test]
    fn both_values_share_an_entry_and_one_that_returns_makes_none() {
        let jump = |second: i64| if second < 5 { [1.0, 0.0] } else { [1.2, -7.0] };
        let both = "friction factor from 1.000 to 1.200, configured 1.000; torque tare from 0.0 to -7.0 N m, configured 0.0 N m";
        assert_eq!(entries(jump, 60), [(15, both.to_owned())]);
        assert!(entries(|second| [if second == 5 { 1.2 } else { 1.0 }, 0.0], 60).is_empty());
        assert!(entries(|_| [1.3, 0.0], 60).is_empty());
    }

    #[test]
    fn a_clock_that_is_set_back_delays_nothing() {
        let mut adjusted = Adjusted::default();
        assert_eq!(adjusted.observe(&at(1.0, 0.0), 100 * SECOND), None);
        assert_eq!(adjusted.observe(&at(1.1, 0.0), 101 * SECOND), None);
        assert!(adjusted.observe(&at(1.2, 0.0), 50 * SECOND).is_some());
    }
}
