//! Bit and rock, as described, with their checks. Their laws are in `effects/bit`.

use serde::{Deserialize, Serialize};

use super::ToolDescription;
use crate::validation::{Bound, ValidationError, count, require};

/// Most blades, each with 2048 points of the hole's bottom.
const MOST_BLADES: usize = 1000;

type Checked = Result<(), ValidationError>;

/// The bit, Eq. 1: torque = eta D WOB / 3 against its rotation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BitDescription {
    /// Bit diameter (m).
    pub diameter: f64,
    /// Friction factor between bit and rock, eta.
    pub friction_factor: f64,
    /// Bit speed at which the regularised torque reaches 71 % of Eq. 1 (rad/s).
    pub slip_rate: f64,
    /// Rotary inertia about the axis (kg m2), a thin disc's.
    pub inertia: f64,
}

impl BitDescription {
    /// A bit of `diameter` (m) with the friction factor eta of Eq. 1, without inertia.
    #[must_use]
    pub const fn new(diameter: f64, friction_factor: f64) -> Self {
        Self {
            diameter,
            friction_factor,
            slip_rate: 0.1,
            inertia: 0.0,
        }
    }
}

/// How the rock answers the bit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RockLaw {
    /// Eq. 1: the torque is proportional to the weight.
    #[default]
    Paper,
    /// Eq. 1 with a torque that falls with the speed.
    Weakening(Weakening),
    /// Cutting and wear flats: weight and torque follow from the depth of cut.
    DepthOfCut(DepthOfCut),
}

/// P(omega) = 1 + (ratio - 1) exp(-|omega| / rate).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Weakening {
    /// Torque at standstill over that at high speed, mu_s / mu_k, at least 1; 1 is no weakening.
    pub ratio: f64,
    /// Speed over which the difference falls to 37 %, omega_c (rad/s).
    pub rate: f64,
}

impl Weakening {
    /// No weakening.
    pub const NONE: Self = Self { ratio: 1.0, rate: 1.0 };
}

/// Bit and rock of the law with depth of cut.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DepthOfCut {
    /// Number of blades n.
    pub blades: u32,
    /// Energy to cut a volume of rock, e (Pa).
    pub specific_energy: f64,
    /// Weight over torque-like force of a sharp cutter, zeta (-).
    pub cutter_inclination: f64,
    /// Largest force of the wear flats, sigma l a (N).
    pub wear_flat_force: f64,
    /// Friction of the wear flats with the bit's geometry, mu_g (-).
    pub wear_flat_friction: f64,
    /// Distance over which the wear flats come to bear (m).
    pub wear_flat_travel: f64,
    /// How the friction of the wear flats falls with the speed.
    pub weakening: Weakening,
    /// Part of the torque of cutting that falls with the speed in the same way, c (0 to 1).
    pub cutting_weakening: f64,
}

impl ToolDescription {
    /// Checks what acts on the tool's lower end.
    pub(in crate::tool) fn check_lower_end(&self) -> Checked {
        self.bit.validate()?;
        // Each law has its own numbers; the combination with a hoist follows.
        match &self.rock {
            RockLaw::Paper => {}
            RockLaw::Weakening(weakening) => weakening.validate("rock")?,
            RockLaw::DepthOfCut(cut) => cut.validate()?,
        }
        // A hoist and a rock that holds the bit need each other: only together do they fix the weight.
        let (cuts, hangs) = (matches!(self.rock, RockLaw::DepthOfCut(_)), self.moves_at_top());
        require(
            cuts || !hangs,
            "string.hoist",
            "a hoist needs a rock that holds the bit; leave the hoist out or set rock to DepthOfCut",
        )?;
        require(
            !cuts || hangs,
            "rock",
            "DepthOfCut gives the weight on bit as a result, so that the top of the tool must be able to move along the hole; \
             give string.hoist or another law",
        )
    }
}

impl BitDescription {
    fn validate(&self) -> Checked {
        Bound::Positive.check("bit.diameter", self.diameter, "m")?;
        Bound::NotNegative.check("bit.friction_factor", self.friction_factor, "")?;
        Bound::Positive.check("bit.slip_rate", self.slip_rate, "rad/s")?;
        Bound::NotNegative.check("bit.inertia", self.inertia, "kg m2")
    }
}

impl Weakening {
    fn validate(&self, under: &str) -> Checked {
        Bound::Within(1.0, f64::MAX).check(&format!("{under}.ratio"), self.ratio, "")?;
        Bound::Positive.check(&format!("{under}.rate"), self.rate, "rad/s")
    }
}

impl DepthOfCut {
    fn validate(&self) -> Checked {
        count("rock.blades", self.blades as usize, 1, MOST_BLADES)?;
        Bound::Positive.check("rock.specific_energy", self.specific_energy, "Pa")?;
        Bound::Positive.check("rock.cutter_inclination", self.cutter_inclination, "")?;
        Bound::NotNegative.check("rock.wear_flat_force", self.wear_flat_force, "N")?;
        Bound::NotNegative.check("rock.wear_flat_friction", self.wear_flat_friction, "")?;
        Bound::Positive.check("rock.wear_flat_travel", self.wear_flat_travel, "m")?;
        Bound::Within(0.0, 1.0).check("rock.cutting_weakening", self.cutting_weakening, "")?;
        self.weakening.validate("rock.weakening")
    }
}
