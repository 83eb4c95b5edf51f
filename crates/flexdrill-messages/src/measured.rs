//! `rig/measured`: its fields by quantity.

use super::RigMeasured;
use super::std_msgs::Header;
use flexdrill_core::inputs::MeasuredKind;

impl RigMeasured {
    /// A message in which no value is given.
    pub fn not_given(header: Header, quality: u8, source: String) -> Self {
        let mut message = Self {
            header,
            quality,
            source,
            ..Self::default()
        };
        for kind in MeasuredKind::ALL {
            *message.field(kind) = f64::NAN;
        }
        message
    }

    /// The value of a quantity (SI), if it is given.
    pub fn value(&self, kind: MeasuredKind) -> Option<f64> {
        let value = match kind {
            MeasuredKind::SurfaceTorque => self.surface_torque,
            MeasuredKind::StandpipePressure => self.standpipe_pressure,
            MeasuredKind::HookLoad => self.hook_load,
            MeasuredKind::RateOfPenetration => self.rate_of_penetration,
            MeasuredKind::BitDepth => self.bit_depth,
            MeasuredKind::HoleDepth => self.hole_depth,
            MeasuredKind::DownholeRotarySpeed => self.downhole_rotary_speed,
            MeasuredKind::DownholeTorque => self.downhole_torque,
            MeasuredKind::DownholeWeightOnBit => self.downhole_weight_on_bit,
            MeasuredKind::AxialVibration => self.axial_vibration,
            MeasuredKind::LateralVibration => self.lateral_vibration,
            MeasuredKind::AxialShock => self.axial_shock,
            MeasuredKind::LateralShock => self.lateral_shock,
        };
        (!value.is_nan()).then_some(value)
    }

    /// Sets the value of a quantity (SI).
    pub fn set(&mut self, kind: MeasuredKind, value: f64) {
        *self.field(kind) = value;
    }

    /// Whether no value is given.
    pub fn is_empty(&self) -> bool {
        MeasuredKind::ALL.into_iter().all(|kind| self.value(kind).is_none())
    }

    fn field(&mut self, kind: MeasuredKind) -> &mut f64 {
        match kind {
            MeasuredKind::SurfaceTorque => &mut self.surface_torque,
            MeasuredKind::StandpipePressure => &mut self.standpipe_pressure,
            MeasuredKind::HookLoad => &mut self.hook_load,
            MeasuredKind::RateOfPenetration => &mut self.rate_of_penetration,
            MeasuredKind::BitDepth => &mut self.bit_depth,
            MeasuredKind::HoleDepth => &mut self.hole_depth,
            MeasuredKind::DownholeRotarySpeed => &mut self.downhole_rotary_speed,
            MeasuredKind::DownholeTorque => &mut self.downhole_torque,
            MeasuredKind::DownholeWeightOnBit => &mut self.downhole_weight_on_bit,
            MeasuredKind::AxialVibration => &mut self.axial_vibration,
            MeasuredKind::LateralVibration => &mut self.lateral_vibration,
            MeasuredKind::AxialShock => &mut self.axial_shock,
            MeasuredKind::LateralShock => &mut self.lateral_shock,
        }
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
}
