//! From a value to a priority.

use crate::Priority;

/// Setpoints of a value of which more is worse, with a deadband against flicker. For a value of which less is worse,
/// give both with their sign turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoints {
    /// Reached at or above these: low, medium, high; `None` where there is no such priority.
    pub at: [Option<f64>; 3],
    /// A priority that stands is left only below its setpoint less this (in the value's unit).
    pub deadband: f64,
}

impl Setpoints {
    /// The priority of a value, where `before` stood. A value that is no number changes nothing.
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
