//! Both layers of contacts as described, their friction along the hole, and their checks.

use serde::{Deserialize, Serialize};

use super::{HoleInterval, LiveParameters, ToolDescription};
use crate::validation::{Bound, ValidationError, require};

type Checked = Result<(), ValidationError>;

/// One layer of gap elements, Eq. 20 to 34.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct GapDescription {
    /// Normal stiffness per station (N/m).
    pub stiffness: f64,
    /// Hunt-Crossley damping c of F = k d (1 + c d') (s/m).
    pub damping: f64,
    /// Coulomb coefficient around the circumference, mu_1.
    pub friction_tangential: f64,
    /// Coulomb coefficient along the axis, mu_2.
    pub friction_axial: f64,
    /// How friction follows from sliding.
    pub friction_law: FrictionLaw,
    /// Speed at which the regularised friction of this layer reaches 71 % of Coulomb's (m/s); `None` takes
    /// [`ToolDescription::slip_speed`]. A bristle has none.
    pub slip_speed: Option<f64>,
}

/// How the friction of a gap layer follows from sliding.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionLaw {
    /// Around and along by themselves, Eq. 25.
    #[default]
    Separate,
    /// Against the whole sliding velocity.
    Vector,
    /// Against the whole sliding velocity, with an elastic slip before it: the contact can stick.
    Bristle,
}

impl GapDescription {
    /// A layer of penalty stiffness `stiffness` (N/m) with the same Coulomb coefficient `friction` in both directions
    /// and the damping of the paper's case. A stiffness of 0 switches the layer off.
    #[must_use]
    pub const fn new(stiffness: f64, friction: f64) -> Self {
        Self {
            stiffness,
            damping: 0.5,
            friction_tangential: friction,
            friction_axial: friction,
            friction_law: FrictionLaw::Separate,
            slip_speed: None,
        }
    }
}

impl GapDescription {
    fn validate(&self, under: &str) -> Checked {
        Bound::NotNegative.check(&format!("{under}.stiffness"), self.stiffness, "N/m")?;
        Bound::NotNegative.check(&format!("{under}.damping"), self.damping, "s/m")?;
        let frictions = [
            ("friction_tangential", self.friction_tangential),
            ("friction_axial", self.friction_axial),
        ];
        Bound::NotNegative.check_all(under, &frictions, "")?;
        self.slip_speed.map_or(Ok(()), |speed| {
            Bound::Positive.check(&format!("{under}.slip_speed"), speed, "m/s")
        })
    }
}

/// Factors on both friction coefficients of the layer between guide and wall, by the interval of the hole in which a
/// station lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WallFrictionFactors {
    /// In [`HoleInterval::BeforeArc`].
    pub before_arc: f64,
    /// In [`HoleInterval::Arc`].
    pub arc: f64,
    /// In [`HoleInterval::AfterArc`].
    pub after_arc: f64,
}

impl WallFrictionFactors {
    /// The same friction all along the hole.
    pub const ONE: Self = Self {
        before_arc: 1.0,
        arc: 1.0,
        after_arc: 1.0,
    };

    /// That of an interval.
    #[must_use]
    pub const fn of(&self, interval: HoleInterval) -> f64 {
        match interval {
            HoleInterval::BeforeArc => self.before_arc,
            HoleInterval::Arc => self.arc,
            HoleInterval::AfterArc => self.after_arc,
        }
    }
}

impl Default for WallFrictionFactors {
    fn default() -> Self {
        Self::ONE
    }
}

impl WallFrictionFactors {
    fn validate(&self) -> Checked {
        let factors = [
            ("before_arc", self.before_arc),
            ("arc", self.arc),
            ("after_arc", self.after_arc),
        ];
        Bound::NotNegative.check_all("wall_friction_factors", &factors, "")
    }
}

impl ToolDescription {
    /// Whether friction of a layer holds by an elastic slip, whose force is part of the state.
    pub(crate) fn holds_friction(&self) -> bool {
        [&self.inner, &self.outer]
            .iter()
            .any(|layer| layer.friction_law == FrictionLaw::Bristle)
    }

    /// Turns of the hole times the friction of the wall along it in force (-): a rope that slides round them passes on e to the
    /// power of minus this.
    pub(crate) fn round_the_arc(&self, live: &LiveParameters) -> f64 {
        let [_, friction] = live.outer_friction;
        friction * self.wall_friction_factors.arc * self.well.turn()
    }

    /// Checks both layers and the friction of the wall.
    pub(in crate::tool) fn check_contact(&self) -> Checked {
        self.inner.validate("inner")?;
        self.outer.validate("outer")?;
        self.wall_friction_factors.validate()?;
        Bound::Positive.check("slip_speed", self.slip_speed, "m/s")
    }

    /// Checks what holds a guide at rest that has been slid in.
    pub(in crate::tool) fn check_friction_at_rest(&self) -> Checked {
        require(
            !self.slid_in || self.static_start,
            "slid_in",
            "a guide that has been slid in is at rest; set static_start to true or slid_in to false",
        )?;
        require(
            !self.slid_in || (self.outer.friction_law == FrictionLaw::Bristle && !self.guide_fixed),
            "slid_in",
            "only a guide that may slide, with outer.friction_law Bristle, holds friction at rest; set slid_in to false",
        )
    }
}
