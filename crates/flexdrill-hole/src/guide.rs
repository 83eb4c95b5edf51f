//! The guide: what bends in the hole and holds the bit's axis.

use flexdrill_base::Bends;
use flexdrill_base::validation::{Bound, ValidationError};

/// How the weight of guide and pipe acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gravity {
    /// Vertically down.
    #[default]
    Down,
    /// Towards z of the hole's frame with its full size at every depth: as in a level hole, whatever its inclination. A
    /// hole then reaches a steady curvature, which the closed form has.
    LowSide,
}

/// A guide of one section, with the pipe that lies in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guide {
    /// Length above the bit (m).
    pub length: f64,
    /// EI: bending stiffness (N m2); for slotted guides that of the tube times its bending factor.
    pub bending_stiffness: f64,
    /// kf: curvature of the guide as made (1/m), towards the high side. Of a guide in pieces that of the piece at the bit.
    pub free_curvature: f64,
    /// Curvatures of the pieces above it, by their distance from the bit.
    pub bends: Bends,
    /// Roll of the guide, by which its free curvature is turned clockwise seen down the hole (rad): above 0 to the right.
    pub roll: f64,
    /// q: weight of guide and pipe in mud (N/m).
    pub weight_per_metre: f64,
    /// How that weight acts.
    pub gravity: Gravity,
    /// c: radial gap between guide and wall (m).
    pub gap: f64,
    /// Friction of the guide that slides down the wall.
    pub wall_friction: f64,
    /// Stiffness of the wall per metre of hole (N/m2).
    pub wall_stiffness: f64,
    /// Torque that the pipe carries to the bit (N m).
    pub torque: f64,
}

impl Guide {
    /// Checks the guide's numbers.
    ///
    /// # Errors
    /// [`ValidationError`] with the first number out of bounds.
    pub fn check(&self) -> Result<(), ValidationError> {
        Bound::Positive.check_all("guide", &[("length", self.length), ("gap", self.gap)], "m")?;
        Bound::Positive.check("guide.bending_stiffness", self.bending_stiffness, "N m2")?;
        Bound::Within(-5.0, 5.0).check("guide.free_curvature", self.free_curvature, "1/m")?;
        self.bends.check()?;
        Bound::Within(0.0, 5.0).check("guide.bends", self.bends.most(0.0), "1/m")?;
        Bound::Finite.check("guide.roll", self.roll, "rad")?;
        Bound::NotNegative.check("guide.weight_per_metre", self.weight_per_metre, "N/m")?;
        Bound::Within(0.0, 2.0).check("guide.wall_friction", self.wall_friction, "")?;
        Bound::Positive.check("guide.wall_stiffness", self.wall_stiffness, "N/m2")?;
        Bound::Finite.check("guide.torque", self.torque, "N m")
    }
}
