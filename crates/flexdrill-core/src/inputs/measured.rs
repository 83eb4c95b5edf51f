//! What a rig measures besides the inputs that drive the twin: names, units and plausible ranges.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::Dimension;

/// The measured quantities, each optional. None of them drives the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeasuredKind {
    /// Torque of the drive, N m.
    SurfaceTorque,
    /// Pressure inside minus outside at the tool's top, Pa.
    StandpipePressure,
    /// Load on the hook, N.
    HookLoad,
    /// Advance of the tool along the hole, m/s; negative when it is pulled back.
    RateOfPenetration,
    /// Measured depth of the bit from the rig's zero, m.
    BitDepth,
    /// Measured depth of the hole from the rig's zero, m.
    HoleDepth,
    /// Rotary speed above the bit, rad/s.
    DownholeRotarySpeed,
    /// Torque above the bit, N m.
    DownholeTorque,
    /// Weight on bit, measured in the hole, N.
    DownholeWeightOnBit,
    /// Axial acceleration, root mean square over the sensor's window, m/s2.
    AxialVibration,
    /// Lateral acceleration, root mean square over the sensor's window, m/s2.
    LateralVibration,
    /// Largest axial acceleration in the sensor's window, m/s2.
    AxialShock,
    /// Largest lateral acceleration in the sensor's window, m/s2.
    LateralShock,
}

impl MeasuredKind {
    /// Number of quantities.
    pub const COUNT: usize = 13;
    /// All, in the order of every array with an entry per quantity.
    pub const ALL: [Self; Self::COUNT] = [
        Self::SurfaceTorque,
        Self::StandpipePressure,
        Self::HookLoad,
        Self::RateOfPenetration,
        Self::BitDepth,
        Self::HoleDepth,
        Self::DownholeRotarySpeed,
        Self::DownholeTorque,
        Self::DownholeWeightOnBit,
        Self::AxialVibration,
        Self::LateralVibration,
        Self::AxialShock,
        Self::LateralShock,
    ];

    /// Index into arrays with an entry per quantity.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The name in configuration, mappings and messages: `surface_torque`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SurfaceTorque => "surface_torque",
            Self::StandpipePressure => "standpipe_pressure",
            Self::HookLoad => "hook_load",
            Self::RateOfPenetration => "rate_of_penetration",
            Self::BitDepth => "bit_depth",
            Self::HoleDepth => "hole_depth",
            Self::DownholeRotarySpeed => "downhole_rotary_speed",
            Self::DownholeTorque => "downhole_torque",
            Self::DownholeWeightOnBit => "downhole_weight_on_bit",
            Self::AxialVibration => "axial_vibration",
            Self::LateralVibration => "lateral_vibration",
            Self::AxialShock => "axial_shock",
            Self::LateralShock => "lateral_shock",
        }
    }

    /// What it measures; the values are in the SI unit of that.
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::SurfaceTorque | Self::DownholeTorque => Dimension::Torque,
            Self::StandpipePressure => Dimension::Pressure,
            Self::HookLoad | Self::DownholeWeightOnBit => Dimension::Force,
            Self::RateOfPenetration => Dimension::Speed,
            Self::BitDepth | Self::HoleDepth => Dimension::Length,
            Self::DownholeRotarySpeed => Dimension::RotarySpeed,
            Self::AxialVibration | Self::LateralVibration | Self::AxialShock | Self::LateralShock => {
                Dimension::Acceleration
            }
        }
    }

    /// SI unit of the values.
    pub const fn unit(self) -> &'static str {
        self.dimension().si().name()
    }

    /// Smallest and largest plausible value (SI): several times what the largest rigs and sensors reach, so that only
    /// values in a wrong unit and defects lie outside.
    pub const fn plausible(self) -> [f64; 2] {
        match self {
            // The strongest top drives hold 150 kN m.
            Self::SurfaceTorque | Self::DownholeTorque => [-1e6, 1e6],
            // The strongest pumps reach 70 MPa; a gauge may show less than the air.
            Self::StandpipePressure => [-1e6, 2e8],
            // The largest hooks carry 12 MN; a tare may be some tonnes off.
            Self::HookLoad => [-1e6, 3e7],
            // Strings are tripped with 2 m/s.
            Self::RateOfPenetration => [-10.0, 10.0],
            // The longest wells have 15 km; the rig's zero may lie above the ground.
            Self::BitDepth | Self::HoleDepth => [-1e3, 3e4],
            // Stick-slip reaches three times a drive's 30 rad/s.
            Self::DownholeRotarySpeed => [-300.0, 300.0],
            Self::DownholeWeightOnBit => [-1e7, 1e7],
            // Shock sensors end at 1,000 times gravity.
            Self::AxialVibration | Self::LateralVibration | Self::AxialShock | Self::LateralShock => [0.0, 1e5],
        }
    }

    /// The quantity of that name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

impl fmt::Display for MeasuredKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_follow_the_list_and_names_are_unique() {
        for (index, kind) in MeasuredKind::ALL.into_iter().enumerate() {
            assert_eq!(kind.index(), index);
            assert_eq!(MeasuredKind::of_name(kind.name()), Some(kind));
            let [least, most] = kind.plausible();
            assert!(least < most, "{kind}");
        }
    }
}
