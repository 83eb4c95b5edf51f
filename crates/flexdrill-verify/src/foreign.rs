//! Figures of programs of others, as their pinned versions give them. `tests/foreign.rs` runs the programs again where they
//! are installed, and holds these figures to what they print.

use super::case::CaseTwin;
use super::sliding::{Heavy, weight_at_kickoff};
use super::{Row, VerifyError};

/// The version of welleng that the figures are from.
pub const WELLENG: &str = "0.30.0";

/// A guide that is pushed round the arc, by welleng.
#[derive(Debug, Clone, Copy)]
pub struct SoftString {
    /// The case whose configuration describes it.
    pub case: &'static str,
    /// Friction coefficient.
    pub friction: f64,
    /// Force at the kick-off (N) with the change of inclination counted from the bit upwards, as in SPE 11380.
    pub upwards: f64,
    /// Force at the kick-off (N) as the package has it: counted downwards, which changes the side of the hole that the
    /// weight presses on.
    pub as_released: f64,
}

/// Pushes without weight and with it.
pub const SOFT_STRINGS: [SoftString; 4] = [
    SoftString {
        case: "capstan",
        friction: 0.3,
        upwards: 1601.89,
        as_released: 1601.89,
    },
    SoftString {
        case: "capstan_weight",
        friction: 0.2,
        upwards: 2410.39,
        as_released: 2227.74,
    },
    SoftString {
        case: "capstan_weight",
        friction: 0.3,
        upwards: 2910.40,
        as_released: 2606.58,
    },
    SoftString {
        case: "capstan_weight",
        friction: 0.4,
        upwards: 3499.64,
        as_released: 3049.82,
    },
];

/// What a soft string is computed from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftStringInputs {
    /// Friction coefficient.
    pub friction: f64,
    /// Radius of the arc (m).
    pub radius: f64,
    /// Weight on bit (N).
    pub weight_on_bit: f64,
    /// Weight of the guide in mud (N/m).
    pub weight: f64,
    /// Outer diameter of the guide (m).
    pub outer_diameter: f64,
}

impl SoftString {
    /// What the foreign program needs, as the configuration of the case has it.
    ///
    /// # Errors
    /// When the configuration of the case is refused.
    pub fn inputs(&self) -> Result<SoftStringInputs, VerifyError> {
        let twin = self.twin()?;
        let of = Heavy::of(&twin);
        Ok(SoftStringInputs {
            friction: of.friction,
            radius: of.radius,
            weight_on_bit: of.weight_on_bit,
            weight: of.guide,
            outer_diameter: twin.config.tool().guide_section.outer_diameter,
        })
    }

    fn twin(&self) -> Result<CaseTwin, VerifyError> {
        CaseTwin::with(self.case, |config| {
            config
                .with_value("contact.outer.friction_axial", self.friction)?
                .with_value("contact.outer.friction_tangential", self.friction)
        })
    }
}

pub(super) fn soft_strings() -> Result<Vec<Row>, VerifyError> {
    SOFT_STRINGS
        .iter()
        .map(|string| {
            let got = weight_at_kickoff(string.case, &mut string.twin()?)?;
            let weight = if string.case == "capstan" { "without" } else { "with" };
            let quantity = format!(
                "{weight} weight, mu {} (N); {:.0} N as released",
                string.friction, string.as_released
            );
            Ok(Row::relative(string.case, quantity, string.upwards, got, 1e-3))
        })
        .collect()
}
