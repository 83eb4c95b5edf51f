//! The law of the bit: in which direction it cuts.

use flexdrill_base::validation::{Bound, ValidationError, require};
use nalgebra::{Matrix2, Rotation2, Vector2};

/// The bit and its load, quasi-static and per turn.
///
/// The direction of the hole at the bit is the bit's axis plus the sideways cutting of the side force (F in N, tilt t in
/// rad, both against the hole's tangent, components right and low):
///
/// ```text
/// turn = t + Rot(walk) (F - W t) / (eta W_a)
/// ```
///
/// F - W t is the side force in the bit's frame. The moment at the bit is 0. With walk = 0 the law is that of Perneder and
/// Detournay (2013) without the bit's angular resistance, and that of Menand, Sellami and Simon (SPE 87837) with
/// 1/eta = W_a BS / W for their bit steerability BS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BitLaw {
    /// W: axial force of the bit on the rock (N).
    pub weight: f64,
    /// W_a: the part of the weight that cuts, without the force on wear flats (N).
    pub active_weight: f64,
    /// eta: depth of cut along the axis over that across it, under equal forces. Large: the bit hardly cuts sideways.
    pub lateral_resistance: f64,
    /// Angle by which the sideways cutting is turned from the side force, clockwise seen down the hole (rad).
    pub walk_angle: f64,
}

impl BitLaw {
    /// A sharp bit without walk: all of the weight cuts.
    pub const fn sharp(weight: f64, lateral_resistance: f64) -> Self {
        Self {
            weight,
            active_weight: weight,
            lateral_resistance,
            walk_angle: 0.0,
        }
    }

    /// eta W_a (N): side force per radian by which it turns the hole.
    pub fn steering_resistance(&self) -> f64 {
        self.lateral_resistance * self.active_weight
    }

    /// Checks the law's numbers.
    ///
    /// # Errors
    /// [`ValidationError`] if a force is not above 0, the walk angle is a right angle or more, more weight cuts than there
    /// is, or the bit cuts sideways so easily that its tilt no longer steers (eta W_a at most W).
    pub fn check(&self) -> Result<(), ValidationError> {
        Bound::Positive.check_all(
            "bit",
            &[("weight", self.weight), ("active_weight", self.active_weight)],
            "N",
        )?;
        Bound::Positive.check("bit.lateral_resistance", self.lateral_resistance, "")?;
        Bound::Within(-1.5, 1.5).check("bit.walk_angle", self.walk_angle, "rad")?;
        require(
            self.active_weight <= self.weight,
            "bit.active_weight",
            "more than the weight: the wear flats cannot pull",
        )?;
        Bound::Over(self.weight).check(
            "bit.lateral_resistance * active_weight",
            self.steering_resistance(),
            "N",
        )
    }

    /// Rot(walk) on vectors (right, low): turns right towards low.
    pub(crate) fn walk(&self) -> Matrix2<f64> {
        *Rotation2::new(self.walk_angle).matrix()
    }

    /// Direction of the hole at the bit against its tangent (rad), from tilt (rad) and side force (N).
    pub fn turn(&self, tilt: Vector2<f64>, side_force: Vector2<f64>) -> Vector2<f64> {
        tilt + self.walk() * (side_force - self.weight * tilt) / self.steering_resistance()
    }

    /// The side force (N) under which a bit with a tilt (rad) turns the hole by `turn` (rad): [`BitLaw::turn`] inverted.
    pub fn side_force(&self, tilt: Vector2<f64>, turn: Vector2<f64>) -> Vector2<f64> {
        self.weight * tilt + self.steering_resistance() * self.walk().transpose() * (turn - tilt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_force_turns_the_hole_as_the_formula_says() {
        let law = BitLaw::sharp(10e3, 20.0);
        // -6.64 mrad + (4084 N + 66.4 N) / 2e5 N: the stiff guide drops, although its bit points up.
        let turn = law.turn(Vector2::new(0.0, -6.64e-3), Vector2::new(0.0, 4084.0));
        assert!(
            (turn.y - (-6.64e-3 + 4150.4 / 2e5)).abs() < 1e-15 && turn.x == 0.0,
            "{turn}"
        );
    }

    #[test]
    fn the_walk_angle_turns_clockwise_seen_down_the_hole() {
        let law = BitLaw {
            walk_angle: 0.1,
            ..BitLaw::sharp(10e3, 20.0)
        };
        // Right turns towards low, and low towards left.
        let right = law.turn(Vector2::zeros(), Vector2::new(1000.0, 0.0));
        let low = law.turn(Vector2::zeros(), Vector2::new(0.0, 1000.0));
        assert!(right.y > 0.0 && low.x < 0.0, "{right} {low}");
    }

    #[test]
    fn turn_and_side_force_invert_each_other() {
        let law = BitLaw {
            walk_angle: -0.3,
            active_weight: 4e3,
            ..BitLaw::sharp(9e3, 30.0)
        };
        let (tilt, force) = (Vector2::new(0.01, -0.02), Vector2::new(-300.0, 1200.0));
        let back = law.side_force(tilt, law.turn(tilt, force));
        assert!((back - force).norm() < 1e-9, "{back}");
    }

    #[test]
    fn a_bit_that_steers_only_by_force_is_refused() {
        assert!(BitLaw::sharp(10e3, 0.9).check().is_err());
        assert!(BitLaw::sharp(f64::NAN, 20.0).check().is_err());
        assert!(BitLaw::sharp(10e3, 20.0).check().is_ok());
    }
}
