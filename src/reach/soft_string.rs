//! The closed form that the field uses: a string without bending stiffness that follows the hole (Johancsik, Friesen and
//! Dawson, J. Pet. Tech. 36 (6), 1984), here for the guide on the wall and the pipe in the guide.
//!
//! With the compression N of the guide, the curvature kappa and the inclination i of the hole, the weights per length
//! w_g and w_p of guide and pipe in mud and the axial friction coefficient mu_x of the wall in the interval of the hole,
//! down the hole:
//!
//! ```text
//! dN/ds = w_g cos i - mu_x f |N kappa + (w_g + w_p) sin i|,      f = v / sqrt(v^2 + u^2).
//! ```
//!
//! The guide is not driven: it slides along the hole only, u = 0 and f = 1, whether the pipe rotates or not. Without
//! weight this is e^(-mu_x theta) in an arc and - mu_x w L in a level hole. Once N is zero, no weight is passed on.
//!
//! The pipe hangs from its top and turns in the guide, where its sliding along the axis is negligible (f = 0). With its
//! tension T = integral of w_p cos i from the bit up, its friction takes the torque
//!
//! ```text
//! M = mu_t r integral |w_p sin i - T kappa| ds.
//! ```

use flexdrill_core::tool::{ToolDescription, WellPath};

use super::Load;
use crate::drilling::loads::{bit_torque, weights};

/// Pieces into which the hole is divided: 1.5 cm of 60 m.
const PIECES: usize = 4000;

/// Weight and torque by the closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftString {
    /// Weight at the bit (N).
    pub weight_at_bit: f64,
    /// Torque at the bit under this weight (N m); zero without rotation.
    pub torque_at_bit: f64,
    /// Torque at the tool's top (N m); zero without rotation.
    pub torque_at_top: f64,
}

impl SoftString {
    /// For a tool that is pushed at its top by the weight of `load`.
    pub fn of(tool: &ToolDescription, load: &Load, rotates: bool) -> Self {
        let [guide, pipe] = weights(tool);
        let path = WellPath::new(&tool.well);
        let length = path.length() / PIECES as f64;
        let middle = |piece: usize| (piece as f64 + 0.5) * length;
        // Weight of the pipe above a piece, from the top down; the rest hangs on it.
        let along = |piece: usize| pipe * libm::cos(path.inclination(middle(piece))) * length;
        let mut tension: f64 = (0..PIECES).map(along).sum();
        let (mut weight, mut friction_torque) = (load.weight, 0.0);
        for piece in 0..PIECES {
            let (inclination, curvature) = (path.inclination(middle(piece)), path.curvature(middle(piece)));
            let (sin, cos) = libm::sincos(inclination);
            let friction = tool.outer.friction_axial * tool.wall_friction_factors.of(path.interval(middle(piece)));
            let contact = (weight * curvature + (guide + pipe) * sin).abs();
            weight = (weight + (guide * cos - friction * contact) * length).max(0.0);
            let inner = (pipe * sin - tension * curvature).abs();
            friction_torque += tool.inner.friction_tangential * radius(tool) * inner * length;
            tension -= along(piece);
        }
        let torque = if rotates {
            bit_torque(tool, weight, load.speed)
        } else {
            0.0
        };
        Self {
            weight_at_bit: weight,
            torque_at_bit: torque,
            torque_at_top: if rotates { torque + friction_torque } else { 0.0 },
        }
    }
}

/// Radius at which the pipe touches the guide (m).
fn radius(tool: &ToolDescription) -> f64 {
    tool.pipe_contact_diameters
        .iter()
        .chain(tool.pipe_sections.iter().map(|tube| &tube.outer_diameter))
        .fold(0.0_f64, |widest, &diameter| widest.max(diameter))
        / 2.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use flexdrill_core::tool::{WallFrictionFactors, WellDescription, WellSection};

    use super::*;

    #[test]
    fn the_wall_rubs_in_each_interval_with_its_factor() {
        let paper = ToolDescription::paper();
        let well = WellDescription {
            start_inclination: 0.0,
            sections: vec![
                WellSection::Arc {
                    radius: 3.2,
                    angle: FRAC_PI_2,
                },
                WellSection::Straight { length: 10.0 },
            ],
        };
        let pipe = paper.pipe_sections[0];
        let tool = ToolDescription::new(well, paper.hole_diameter, 100, pipe, paper.guide_section).with(|tool| {
            tool.wall_friction_factors = WallFrictionFactors {
                arc: 0.5,
                after_arc: 2.0,
                ..WallFrictionFactors::ONE
            };
        });
        let load = Load {
            speed: 4.0,
            weight: 20e3,
            advance: 1e-3,
            longest: 60.0,
        };
        let of = |tool: &ToolDescription| SoftString::of(tool, &load, true).weight_at_bit;
        let mu = tool.outer.friction_axial;
        // Without weight the level part takes nothing. The 1340 pieces of the arc leave out (mu pi / 2)^2 / 2 / 1340.
        let weightless = tool.clone().with(|tool| tool.gravity = 0.0);
        let expected = 20e3 * (-0.5 * mu * FRAC_PI_2).exp();
        assert!((of(&weightless) / expected - 1.0).abs() < 3e-5);
        // The level part takes its factor times mu w L: without friction there, that much more arrives.
        let free = tool.clone().with(|tool| tool.wall_friction_factors.after_arc = 0.0);
        let taken = 2.0 * mu * weights(&tool).iter().sum::<f64>() * 10.0;
        // The pieces at the boundary are 4 mm long.
        assert!(((of(&free) - of(&tool)) / taken - 1.0).abs() < 1e-3);
    }
}
