//! `rig/measured` and `rig/inputs`: their values by quantity, where they are given.

use flexdrill_core::inputs::{InputKind, MeasuredKind};
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{RigInputs, RigMeasured};

/// A value that its sender gives: not NaN, and with its bit set in `given`. A sender that sets no bit does not know the
/// field; it has left at 0 what it does not know either, where `may_be_unknown`.
fn given_value(value: f64, given: u32, bit: u32, may_be_unknown: bool) -> Option<f64> {
    let is_given = match given {
        0 => !may_be_unknown || value != 0.0,
        given => given & bit != 0,
    };
    (is_given && !value.is_nan()).then_some(value)
}

/// The values of `rig/inputs`.
pub trait InputValues: Sized {
    /// A message with those of the values, in the order of [`InputKind::ALL`] and in their units, that are given.
    fn of(header: Header, values: [Option<f64>; InputKind::COUNT], quality: u8, source: String) -> Self;

    /// The value of an input in its unit, if it is given.
    fn value(&self, kind: InputKind) -> Option<f64>;

    /// Whether a value of 0 was taken as not given, because the sender does not say which are.
    fn has_doubtful_zero(&self) -> bool;
}

impl InputValues for RigInputs {
    fn of(header: Header, values: [Option<f64>; InputKind::COUNT], quality: u8, source: String) -> Self {
        let given = (0..).zip(values).filter(|(_, value)| value.is_some());
        let [speed, weight, rate, pressure] = values.map(|value| value.unwrap_or(f64::NAN));
        Self {
            header,
            rotary_speed_rpm: speed,
            weight_on_bit_kn: weight,
            quality,
            source,
            rate_of_penetration_m_per_h: rate,
            standpipe_pressure_mpa: pressure,
            given: given.map(|(bit, _)| 1 << bit).sum(),
        }
    }

    fn value(&self, kind: InputKind) -> Option<f64> {
        // Programs that were written before the rate and the pressure were inputs leave those at 0 once they are built again.
        let (value, bit, may_be_unknown) = match kind {
            InputKind::RotarySpeed => (self.rotary_speed_rpm, Self::GIVEN_ROTARY_SPEED, false),
            InputKind::WeightOnBit => (self.weight_on_bit_kn, Self::GIVEN_WEIGHT_ON_BIT, false),
            InputKind::RateOfPenetration => (self.rate_of_penetration_m_per_h, Self::GIVEN_RATE_OF_PENETRATION, true),
            InputKind::StandpipePressure => (self.standpipe_pressure_mpa, Self::GIVEN_STANDPIPE_PRESSURE, true),
        };
        given_value(value, self.given, bit, may_be_unknown)
    }

    fn has_doubtful_zero(&self) -> bool {
        self.given == 0 && (self.rate_of_penetration_m_per_h == 0.0 || self.standpipe_pressure_mpa == 0.0)
    }
}

/// The values of `rig/measured`.
pub trait MeasuredValues: Sized {
    /// A message in which no value is given.
    fn not_given(header: Header, quality: u8, source: String) -> Self;

    /// The value of a quantity (SI), if it is given.
    fn value(&self, kind: MeasuredKind) -> Option<f64>;

    /// Whether a value of 0 was taken as not given, because the sender does not say which are.
    fn has_doubtful_zero(&self) -> bool;

    /// Sets the value of a quantity (SI).
    fn set(&mut self, kind: MeasuredKind, value: f64);

    /// Whether no value is given.
    fn is_empty(&self) -> bool;
}

impl MeasuredValues for RigMeasured {
    fn not_given(header: Header, quality: u8, source: String) -> Self {
        let mut message = Self {
            header,
            quality,
            source,
            ..Self::default()
        };
        for kind in MeasuredKind::ALL {
            *field(&mut message, kind) = f64::NAN;
        }
        message
    }

    fn value(&self, kind: MeasuredKind) -> Option<f64> {
        given_value(written(self, kind), self.given, 1 << kind.index(), true)
    }

    fn has_doubtful_zero(&self) -> bool {
        self.given == 0 && MeasuredKind::ALL.into_iter().any(|kind| written(self, kind) == 0.0)
    }

    fn set(&mut self, kind: MeasuredKind, value: f64) {
        *field(self, kind) = value;
        self.given |= 1 << kind.index();
    }

    fn is_empty(&self) -> bool {
        MeasuredKind::ALL.into_iter().all(|kind| self.value(kind).is_none())
    }
}

/// The number in the field of a quantity.
fn written(message: &RigMeasured, kind: MeasuredKind) -> f64 {
    match kind {
        MeasuredKind::SurfaceTorque => message.surface_torque,
        MeasuredKind::StandpipePressure => message.standpipe_pressure,
        MeasuredKind::HookLoad => message.hook_load,
        MeasuredKind::RateOfPenetration => message.rate_of_penetration,
        MeasuredKind::BitDepth => message.bit_depth,
        MeasuredKind::HoleDepth => message.hole_depth,
        MeasuredKind::DownholeRotarySpeed => message.downhole_rotary_speed,
        MeasuredKind::DownholeTorque => message.downhole_torque,
        MeasuredKind::DownholeWeightOnBit => message.downhole_weight_on_bit,
        MeasuredKind::AxialVibration => message.axial_vibration,
        MeasuredKind::LateralVibration => message.lateral_vibration,
        MeasuredKind::AxialShock => message.axial_shock,
        MeasuredKind::LateralShock => message.lateral_shock,
    }
}

/// The field of a quantity.
fn field(message: &mut RigMeasured, kind: MeasuredKind) -> &mut f64 {
    match kind {
        MeasuredKind::SurfaceTorque => &mut message.surface_torque,
        MeasuredKind::StandpipePressure => &mut message.standpipe_pressure,
        MeasuredKind::HookLoad => &mut message.hook_load,
        MeasuredKind::RateOfPenetration => &mut message.rate_of_penetration,
        MeasuredKind::BitDepth => &mut message.bit_depth,
        MeasuredKind::HoleDepth => &mut message.hole_depth,
        MeasuredKind::DownholeRotarySpeed => &mut message.downhole_rotary_speed,
        MeasuredKind::DownholeTorque => &mut message.downhole_torque,
        MeasuredKind::DownholeWeightOnBit => &mut message.downhole_weight_on_bit,
        MeasuredKind::AxialVibration => &mut message.axial_vibration,
        MeasuredKind::LateralVibration => &mut message.lateral_vibration,
        MeasuredKind::AxialShock => &mut message.axial_shock,
        MeasuredKind::LateralShock => &mut message.lateral_shock,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_its_own_field_of_the_same_name() {
        let mut message = RigMeasured::not_given(Header::default(), RigMeasured::GOOD, String::new());
        assert!(message.is_empty());
        for kind in MeasuredKind::ALL {
            assert_eq!(message.value(kind), None);
            message.set(kind, kind.index() as f64);
        }
        let fields = serde_json::to_value(&message).unwrap();
        for kind in MeasuredKind::ALL {
            assert_eq!(message.value(kind), Some(kind.index() as f64));
            assert_eq!(fields[kind.name()], kind.index() as f64, "{kind}");
        }
    }

    #[test]
    fn what_a_sender_leaves_at_zero_is_no_measurement() {
        let default = RigMeasured::default();
        assert!(default.is_empty() && default.has_doubtful_zero());
        let one = RigMeasured {
            hook_load: 5e4,
            ..RigMeasured::default()
        };
        assert_eq!(one.value(MeasuredKind::HookLoad), Some(5e4));
        assert_eq!(one.value(MeasuredKind::BitDepth), None);
        // Who says which are given can measure a 0.
        let mut said = RigMeasured::not_given(Header::default(), RigMeasured::GOOD, String::new());
        said.set(MeasuredKind::RateOfPenetration, 0.0);
        assert_eq!(said.value(MeasuredKind::RateOfPenetration), Some(0.0));
        assert!(!said.has_doubtful_zero());
        let mut inputs = RigInputs {
            rotary_speed_rpm: 40.0,
            ..RigInputs::default()
        };
        // The weight of a message without `given` was always a value.
        let values = |inputs: &RigInputs| InputKind::ALL.map(|kind| inputs.value(kind));
        assert_eq!(values(&inputs), [Some(40.0), Some(0.0), None, None]);
        assert!(inputs.has_doubtful_zero());
        inputs.given = RigInputs::GIVEN_ROTARY_SPEED | RigInputs::GIVEN_STANDPIPE_PRESSURE;
        assert_eq!(values(&inputs), [Some(40.0), None, None, Some(0.0)]);
        let given = [None, Some(0.0), Some(-3.0), None];
        let made = RigInputs::of(Header::default(), given, RigInputs::GOOD, String::new());
        assert_eq!(values(&made), given);
        assert_eq!(made.given, 6);
    }
}
