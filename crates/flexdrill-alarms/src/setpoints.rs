//! Setpoints that turn a value into a priority.

use crate::Priority;

/// Setpoints of a value for which larger is worse, with a deadband against flicker. For a value for which smaller is
/// worse, negate the value and the setpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoints {
    /// The setpoints of low, medium and high, reached at or above them; `None` for a priority that does not exist.
    pub at: [Option<f64>; 3],
    /// A standing priority ends only below its setpoint minus this deadband (in the value's unit).
    pub deadband: f64,
}

impl Setpoints {
    /// The priority of a value after the priority `before`. A NaN changes nothing.
    pub fn judge(&self, value: f64, before: Option<Priority>) -> Option<Priority> {
        if value.is_nan() {
            return before;
        }
        let reached = |(priority, setpoint): (Priority, Option<f64>)| {
            let margin = if before >= Some(priority) { self.deadband } else { 0.0 };
            (value >= setpoint? - margin).then_some(priority)
        };
        Priority::ALL.into_iter().zip(self.at).filter_map(reached).max()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_within_the_deadband_changes_nothing() {
        let setpoints = Setpoints {
            at: [Some(2.0), None, Some(5.0)],
            deadband: 0.5,
        };
        let mut priority = None;
        let mut judge = |value| {
            priority = setpoints.judge(value, priority);
            priority
        };
        assert_eq!(judge(1.9), None);
        assert_eq!(judge(2.0), Some(Priority::Low));
        assert_eq!(judge(1.6), Some(Priority::Low));
        assert_eq!(judge(5.0), Some(Priority::High));
        assert_eq!(judge(4.5), Some(Priority::High));
        assert_eq!(judge(f64::NAN), Some(Priority::High));
        assert_eq!(judge(4.4), Some(Priority::Low));
        assert_eq!(judge(1.4), None);
        assert_eq!(judge(1.6), None);
    }
}
