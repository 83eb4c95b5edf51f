//! An alarm at one moment, from an event of the journal or from a list.

use crate::{Alarm, AlarmEvent};

/// What a recording says of an alarm at its worst moment. Evidence, value and location are of one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct AlarmMoment {
    /// Name of the alarm.
    pub name: String,
    /// What happened, in a sentence.
    pub evidence: String,
    /// What the driller can do.
    pub what_to_do: String,
    /// What the engineer can do.
    pub what_the_engineer_can_do: String,
    /// Measured depth (m), NaN for an alarm without a location.
    pub measured_depth: f64,
    /// Inclination of the bore there (rad), NaN for an alarm without a location.
    pub inclination: f64,
    /// The body there, a constant of [`Alarm`].
    pub body: u8,
    /// The value that is judged; NaN where there is no such number.
    pub value: f64,
    /// The threshold of the value; NaN where there is none, or an event says it, which does not carry it.
    threshold: f64,
    /// When that was (ns since 1970); zero where the recording does not say it.
    pub worst_at: i64,
    /// The constant of [`Alarm`] for a matter of drilling or of the computer.
    pub category: u8,
}

impl From<&AlarmEvent> for AlarmMoment {
    fn from(event: &AlarmEvent) -> Self {
        Self {
            name: event.name.clone(),
            evidence: event.evidence.clone(),
            what_to_do: event.what_to_do.clone(),
            what_the_engineer_can_do: event.what_the_engineer_can_do.clone(),
            measured_depth: event.measured_depth,
            inclination: event.inclination,
            body: event.body,
            value: event.value,
            threshold: f64::NAN,
            worst_at: event.worst_at.to_nanoseconds(),
            category: event.category,
        }
    }
}

impl From<&Alarm> for AlarmMoment {
    fn from(alarm: &Alarm) -> Self {
        Self {
            name: alarm.name.clone(),
            evidence: alarm.evidence.clone(),
            what_to_do: alarm.what_to_do.clone(),
            what_the_engineer_can_do: alarm.what_the_engineer_can_do.clone(),
            measured_depth: alarm.measured_depth,
            inclination: alarm.inclination,
            body: alarm.body,
            value: alarm.value,
            threshold: alarm.threshold,
            worst_at: alarm.worst_at.to_nanoseconds(),
            category: alarm.category,
        }
    }
}

impl AlarmMoment {
    /// Whether the value of this moment is worse than that of an earlier one of the same alarm and priority: further from the
    /// threshold, on the side of it on which the earlier one lies. Without numbers the earlier moment stays.
    pub fn is_worse_than(&self, earlier: &Self) -> bool {
        let scale = if self.threshold.is_finite() && self.threshold != 0.0 {
            self.threshold
        } else {
            1.0
        };
        let [new, kept] = [self.value, earlier.value].map(|value| value / scale);
        match kept.is_finite() {
            false => new.is_finite(),
            // A twin that is slower than real time has a value below its threshold, and less of it is worse.
            true if kept < 1.0 => new < kept,
            true => new > kept,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worse_is_further_from_the_threshold_on_either_side() {
        let moment = |value: f64, threshold: f64| {
            AlarmMoment::from(&Alarm {
                value,
                threshold,
                ..Alarm::default()
            })
        };
        for (new, kept, threshold, worse) in [
            (8.96, 1.38, 1.0, true),
            (1.2, 1.38, 1.0, false),
            // Seconds per second of real time.
            (0.5, 0.9, 0.98, true),
            (0.95, 0.9, 0.98, false),
            // A torque below the band of what is expected.
            (-60.0, -40.0, -30.0, true),
            (-35.0, -40.0, -30.0, false),
            (2.0, 1.0, 0.0, true),
            (2.0, f64::NAN, 1.0, true),
            (f64::NAN, 2.0, 1.0, false),
        ] {
            let is_worse = moment(new, threshold).is_worse_than(&moment(kept, threshold));
            assert_eq!(is_worse, worse, "{new} after {kept}, threshold {threshold}");
        }
    }
}
