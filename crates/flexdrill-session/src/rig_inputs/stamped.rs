//! Messages on `rig/inputs`: the inputs with stamp, quality and source.

use flexdrill_core::inputs::{InputKind, Stamp};
use flexdrill_messages::RigInputs;
use flexdrill_outputs::InputValues as _;

/// The values of a message at `rig_time` (ns since 1970, on the clock of its stamp); `None` for an input that the message
/// does not give.
pub fn values(message: &RigInputs, rig_time: i64, max_skew: f64) -> [Option<(f64, Stamp)>; InputKind::COUNT] {
    let age = rig_time.saturating_sub(message.header.stamp.to_nanoseconds());
    let stamp = Stamp {
        age: age as f64 * 1e-9,
        // An unknown code counts as bad.
        bad: !matches!(message.quality, RigInputs::GOOD | RigInputs::SUSPECT),
        max_skew,
    };
    InputKind::ALL.map(|kind| message.value(kind).map(|value| (value, stamp)))
}

/// Whether the source doubts the values.
pub fn is_suspect(message: &RigInputs) -> bool {
    message.quality == RigInputs::SUSPECT
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::builtin_interfaces::Time;

    fn message(stamp: i64, quality: u8) -> RigInputs {
        let mut message = RigInputs {
            rotary_speed_rpm: 40.0,
            weight_on_bit_kn: f64::NAN,
            quality,
            rate_of_penetration_m_per_h: -3.0,
            standpipe_pressure_mpa: f64::NAN,
            ..RigInputs::default()
        };
        message.header.stamp = Time::from_nanoseconds(stamp);
        message
    }

    #[test]
    fn the_age_is_that_of_the_stamp_and_nan_is_not_given() {
        let now = 1_700_000_000_000_000_000;
        let [speed, weight, rate, pressure] = values(&message(now - 250_000_000, RigInputs::GOOD), now, 0.5);
        let (value, stamp) = speed.unwrap();
        assert_eq!((value, stamp.age, stamp.bad, weight), (40.0, 0.25, false, None));
        assert_eq!((rate.unwrap().0, pressure), (-3.0, None));
        let [ahead, ..] = values(&message(now + 1_000_000_000, RigInputs::SUSPECT), now, 0.5);
        assert_eq!(ahead.unwrap().1.age, -1.0);
        for quality in [RigInputs::BAD, 7] {
            assert!(values(&message(now, quality), now, 0.5)[0].unwrap().1.bad, "{quality}");
        }
    }
}
