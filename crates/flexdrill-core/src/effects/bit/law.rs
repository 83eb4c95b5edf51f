//! What the rock resists with: the depth of cut over the paths of the blades, the wear flats, and a friction that falls with
//! the speed. The laws are printed in [`super`].

use super::Groove;
use crate::tool::description::{DepthOfCut, Weakening};

impl Weakening {
    /// P and dP/domega (s/rad) at a speed (rad/s).
    pub fn at(&self, speed: f64) -> (f64, f64) {
        let more = (self.ratio - 1.0) * libm::exp(-speed.abs() / self.rate);
        (1.0 + more, -more / self.rate * speed.signum())
    }
}

/// What the rock does to the bit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Answer {
    /// Torque of cutting and of Eq. 1 (N m), before the sign of the speed.
    pub torque: f64,
    /// Its derivative by the depth (N) and by the angle (N m/rad).
    pub torque_by: [f64; 2],
    /// Torque of friction (N m), before P and the sign of the speed, and its derivative by the depth (N).
    pub friction: f64,
    /// Derivative of the friction torque by the depth (N).
    pub friction_by_depth: f64,
    /// Weight on the bit (N, compressing).
    pub weight: f64,
    /// Its derivative by the depth (N/m) and by the angle (N/rad).
    pub weight_by: [f64; 2],
    /// Depth of cut (m per turn).
    pub depth_of_cut: f64,
    /// Depth down to which the wear flats press the rock (m).
    pub pressed: f64,
}

impl DepthOfCut {
    /// The answer to a bit of `radius` (m) at a depth (m, down) and an angle (rad) over the paths in `groove`, with a `share` (0
    /// to 1) of the cutters' faces in the rock.
    pub fn answer(&self, radius: f64, depth: f64, angle: f64, groove: &Groove, share: f64) -> Answer {
        let (path, slope) = groove.path(angle);
        // The faces cut by the depth below the groove; energy per volume times radius is the force of that depth.
        let (blades, cutting) = (f64::from(self.blades), self.specific_energy * radius);
        let cuts = depth > path;
        let depth_of_cut = if cuts { share * blades * (depth - path) } else { 0.0 };
        // The wear flats press elastically over their travel. While the bit cuts they follow it down at their full force; the
        // rock below them is broken by the cutters. Turning back they carry whatever weight there is: the less of the
        // cutters' faces is in the rock, the more the flats bear before they follow, so that a bit that stands does not sink.
        let stiffness = self.wear_flat_force / self.wear_flat_travel;
        let deepest = if share > 0.0 {
            depth - self.wear_flat_travel / share
        } else {
            f64::NEG_INFINITY
        };
        let yields = deepest > groove.pressed();
        let pressed = if yields { deepest } else { groove.pressed() };
        let compressed = depth - pressed;
        let bears = compressed > 0.0;
        let flat = if bears { stiffness * compressed } else { 0.0 };
        let flat_slope = if bears && !yields { stiffness } else { 0.0 };
        // Slopes by depth and angle, the groove's own slope included: the path ahead rises and falls.
        let by_depth = if cuts { share * blades * cutting } else { 0.0 };
        let by_angle = -by_depth * slope;
        // A bit without wear flats stands on its cutters in either sense.
        let (standing, standing_by_depth) = if self.wear_flat_force > 0.0 || !cuts {
            (depth_of_cut, by_depth)
        } else {
            (blades * (depth - path), blades * cutting)
        };
        // The torque acts at half the radius on average over the face.
        Answer {
            torque: 0.5 * cutting * radius * depth_of_cut,
            torque_by: [0.5 * radius * by_depth, 0.5 * radius * by_angle],
            friction: 0.5 * self.wear_flat_friction * radius * flat,
            friction_by_depth: 0.5 * self.wear_flat_friction * radius * flat_slope,
            weight: self.cutter_inclination * cutting * standing + flat,
            weight_by: [
                self.cutter_inclination * standing_by_depth + flat_slope,
                -self.cutter_inclination * standing_by_depth * slope,
            ],
            depth_of_cut,
            pressed,
        }
    }
}
