//! The quantities that a rig sends: those that drive the twin, and those that it only measures.

use std::fmt;

use flexdrill_config::checker::Checker;
use flexdrill_core::inputs::{Dimension, InputKind, MeasuredKind, Unit};
use serde::{Deserialize, Serialize};

flexdrill_base::listed! {
    /// A value of a survey.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum SurveyKind: 1 {
        /// Measured depth.
        Depth: "survey_depth";
        /// Inclination.
        Inclination: "survey_inclination";
        /// Azimuth, corrected to the north of the plan.
        Azimuth: "survey_azimuth";
    }
}

impl SurveyKind {
    /// Largest angle of either sign (rad): the twin's own bounds are narrower.
    const TURN: f64 = std::f64::consts::TAU;

    const fn name(self) -> &'static str {
        self.row()[0]
    }

    const fn dimension(self) -> Dimension {
        match self {
            Self::Depth => Dimension::Length,
            Self::Inclination | Self::Azimuth => Dimension::Angle,
        }
    }

    const fn plausible(self) -> [f64; 2] {
        match self {
            Self::Depth => MeasuredKind::BitDepth.plausible(),
            Self::Inclination => [0.0, std::f64::consts::PI],
            Self::Azimuth => [-Self::TURN, Self::TURN],
        }
    }
}

/// A quantity of the rig by its name. Rate of penetration and standpipe pressure are both measured and an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Quantity {
    /// Speed of the top drive.
    RotarySpeed,
    /// Weight on bit at the surface.
    WeightOnBit,
    /// A measured quantity.
    Measured(MeasuredKind),
    /// A value of a survey of the hole.
    Survey(SurveyKind),
}

/// A name that belongs to no quantity.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{name:?} is no quantity; it is one of {}", names())]
pub struct NoQuantity {
    /// The name.
    pub name: String,
}

/// All names, for messages.
fn names() -> String {
    Quantity::all().map(Quantity::name).collect::<Vec<_>>().join(", ")
}

impl Quantity {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::RotarySpeed, Self::WeightOnBit]
            .into_iter()
            .chain(MeasuredKind::ALL.into_iter().map(Self::Measured))
            .chain(SurveyKind::ALL.into_iter().map(Self::Survey))
    }

    /// The name in mappings.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RotarySpeed => InputKind::RotarySpeed.name(),
            Self::WeightOnBit => InputKind::WeightOnBit.name(),
            Self::Measured(kind) => kind.name(),
            Self::Survey(kind) => kind.name(),
        }
    }

    /// What it measures.
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::RotarySpeed => Dimension::RotarySpeed,
            Self::WeightOnBit => Dimension::Force,
            Self::Measured(kind) => kind.dimension(),
            Self::Survey(kind) => kind.dimension(),
        }
    }

    /// The input that it drives, if any.
    pub const fn input(self) -> Option<InputKind> {
        match self {
            Self::RotarySpeed => Some(InputKind::RotarySpeed),
            Self::WeightOnBit => Some(InputKind::WeightOnBit),
            Self::Measured(MeasuredKind::RateOfPenetration) => Some(InputKind::RateOfPenetration),
            Self::Measured(MeasuredKind::StandpipePressure) => Some(InputKind::StandpipePressure),
            Self::Measured(_) | Self::Survey(_) => None,
        }
    }

    /// Smallest and largest plausible value (SI). The node's own limits of its inputs are narrower.
    pub const fn plausible(self) -> [f64; 2] {
        match self {
            Self::RotarySpeed => MeasuredKind::DownholeRotarySpeed.plausible(),
            // The largest rigs put 500 kN on a bit.
            Self::WeightOnBit => [-1e6, 1e6],
            Self::Measured(kind) => kind.plausible(),
            Self::Survey(kind) => kind.plausible(),
        }
    }
}

impl TryFrom<String> for Quantity {
    type Error = NoQuantity;

    fn try_from(name: String) -> Result<Self, NoQuantity> {
        let found = Self::all().find(|quantity| quantity.name() == name);
        found.ok_or(NoQuantity { name })
    }
}

impl From<Quantity> for String {
    fn from(quantity: Quantity) -> Self {
        quantity.name().to_owned()
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Checks the keys `unit` and `valid` of an entry of a mapping file.
pub(crate) fn check_unit_and_range(c: &mut Checker, quantity: Quantity, unit: Unit, valid: Option<[f64; 2]>) {
    let dimension = quantity.dimension();
    c.require(
        unit.dimension() == dimension,
        "unit",
        unit,
        "",
        format!("one of {}", dimension.units()),
        "the unit belongs to another quantity",
    );
    if let Some([least, most]) = valid {
        c.require(
            least.is_finite() && most.is_finite() && least < most,
            "valid",
            format!("[{least}, {most}]"),
            "",
            "[smallest, largest]",
            "values outside are left out",
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_and_inputs_keep_their_dimension() {
        for quantity in Quantity::all() {
            assert_eq!(Quantity::try_from(quantity.name().to_owned()), Ok(quantity));
            if let Some(input) = quantity.input() {
                assert_eq!(input.name(), quantity.name());
                assert_eq!(input.si_unit(), quantity.dimension().si().name());
            }
        }
        let wrong = Quantity::try_from("torque".to_owned()).unwrap_err();
        assert!(wrong.to_string().contains("surface_torque"), "{wrong}");
    }

    #[test]
    fn a_weight_on_bit_ends_at_a_thousand_kilonewtons() {
        assert_eq!(Quantity::WeightOnBit.plausible(), [-1e6, 1e6]);
        // A hook carries more than a bit.
        let [_, hook] = Quantity::Measured(MeasuredKind::HookLoad).plausible();
        assert!(hook > 1e7);
    }
}
