//! The guide: what bends in the hole and holds the bit's axis.

use flexdrill_base::Bends;
use flexdrill_base::validation::{Bound, ValidationError};
use nalgebra::Vector2;

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

/// The line of a slotted guide that carries the thrust, off the guide's axis. Bending is about it, so that the thrust bends the
/// guide away from it, as if it had been made with another curvature:
///
/// ```text
/// kf + min(e C / EI, k_c)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spine {
    /// e: distance from the guide's axis (m).
    pub offset: f64,
    /// Toolface of the bend that the thrust adds, from that of the free curvature (rad): the spine lies on the other side of
    /// the axis.
    pub turn: f64,
    /// k_c: largest curvature that the thrust adds (1/m), at which the slots are shut; none where they stay open.
    pub most: Option<f64>,
}

impl Spine {
    /// Curvature (1/m) that a thrust C (N) adds to a guide of a bending stiffness EI (N m2); below 0 under tension, which opens
    /// the slots.
    pub fn bend(&self, thrust: f64, bending_stiffness: f64) -> f64 {
        (self.offset * thrust / bending_stiffness).min(self.most.unwrap_or(f64::INFINITY))
    }
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
    /// Where the spine lies off the axis.
    pub spine: Option<Spine>,
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
    /// Direction (right, low) into which the thrust bends it, and how far off the axis that acts (m); none for a guide whose
    /// spine is on its axis.
    pub(crate) fn thrust_bends(&self) -> Option<(Vector2<f64>, f64)> {
        let spine = self.spine?;
        let (sine, cosine) = (self.roll + spine.turn).sin_cos();
        Some((Vector2::new(sine, -cosine), spine.offset))
    }

    /// The thrust (N) above which the slots are shut, so that more of it does not bend the guide further.
    pub(crate) fn shutting_thrust(&self) -> f64 {
        match self.spine {
            Some(Spine {
                offset,
                most: Some(most),
                ..
            }) if offset > 0.0 => self.bending_stiffness * most / offset,
            _ => f64::INFINITY,
        }
    }

    /// The guide without thrust that has the shape of this one under a thrust (N) without anything that bends it: what the
    /// closed forms take, in the plane of the build.
    pub(crate) fn under(&self, thrust: f64) -> Self {
        let Some(spine) = self.spine else {
            return *self;
        };
        let more = spine.bend(thrust, self.bending_stiffness) * spine.turn.cos();
        Self {
            free_curvature: self.free_curvature + more,
            bends: self.bends.plus(more),
            spine: None,
            ..*self
        }
    }

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
        if let Some(spine) = self.spine {
            // A hole of 5 1/m leaves no guide with a spine further out.
            Bound::Within(0.0, 0.19).check("guide.spine.offset", spine.offset, "m")?;
            Bound::Finite.check("guide.spine.turn", spine.turn, "rad")?;
            spine
                .most
                .map_or(Ok(()), |most| Bound::Positive.check("guide.spine.most", most, "1/m"))?;
        }
        Bound::NotNegative.check("guide.weight_per_metre", self.weight_per_metre, "N/m")?;
        Bound::Within(0.0, 2.0).check("guide.wall_friction", self.wall_friction, "")?;
        Bound::Positive.check("guide.wall_stiffness", self.wall_stiffness, "N/m2")?;
        Bound::Finite.check("guide.torque", self.torque, "N m")
    }
}
