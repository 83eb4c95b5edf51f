//! The closed form that the field uses for what arrives at the bit: the guide as a soft string on the wall, and the pipe in the
//! guide ([`flexdrill_trip::soft_string`]).
//!
//! With the compression N of the guide, the curvature kappa and the inclination i of the hole, the weights per length
//! w_g and w_p of guide and pipe in mud and the axial friction coefficient mu_x of the wall in the interval of the hole,
//! down the hole:
//!
//! ```text
//! dN/ds = w_g cos i - mu_x |N kappa + (w_g + w_p) sin i|.
//! ```
//!
//! The guide is not driven: it slides along the hole only, whether the pipe rotates or not. Without weight this is
//! e^(-mu_x theta) in an arc and - mu_x w L in a level hole. Once N is zero, no weight is passed on.
//!
//! The pipe hangs from its top and turns in the guide, where its sliding along the axis is negligible. With its tension T =
//! integral of w_p cos i from the bit up, its friction takes the torque
//!
//! ```text
//! M = mu_t r integral |w_p sin i - T kappa| ds.
//! ```

use flexdrill_config::Config;
use flexdrill_trip::Sense;
use flexdrill_trip::soft_string::{Load as At, Motion};
use flexdrill_trip::tool::{pieces, pipe_radius, pipe_torque};

use super::Load;
use crate::drilling::loads::{bit_torque, weights};

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
    pub fn of(config: &Config, load: &Load, rotates: bool) -> Self {
        let tool = config.tool();
        let [guide, pipe] = weights(&tool);
        let radius = pipe_radius(&tool);
        let (sections, start) = (&config.well.sections, tool.well.start_inclination);
        let of_wall = |interval| tool.outer.friction_axial * tool.wall_friction_factors.of(interval);
        let pushed = At {
            tension: -load.weight,
            torque: 0.0,
        };
        let motion = Motion::sliding(Sense::In);
        let weight = -pieces(sections, start, [guide, guide + pipe], of_wall, radius)
            .iter()
            .fold(pushed, |above, piece| piece.below(above, &motion, 0.0))
            .tension;
        if !rotates {
            return Self {
                weight_at_bit: weight,
                torque_at_bit: 0.0,
                torque_at_top: 0.0,
            };
        }
        let torque = bit_torque(&tool, weight, load.speed);
        let in_guide = pieces(sections, start, [pipe; 2], |_| tool.inner.friction_tangential, radius);
        Self {
            weight_at_bit: weight,
            torque_at_bit: torque,
            torque_at_top: torque + pipe_torque(&in_guide),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn the_wall_rubs_in_each_interval_with_its_factor() {
        let text = "well: {sections: [{arc: {radius: 3.2, build_angle_deg: 90}}, {straight: {length: 10}}], hole_diameter: 0.118}
tool:
  links: 100
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118}
contact: {wall_friction_factors: {arc: 0.5, after_arc: 2}}
";
        let config = Config::from_text("test.yaml", text).unwrap();
        let load = Load {
            speed: 4.0,
            weight: 20e3,
            advance: 1e-3,
            longest: 60.0,
        };
        let with =
            |key: &str, value: f64| SoftString::of(&config.with_value(key, value).unwrap(), &load, true).weight_at_bit;
        let tool = config.tool();
        let mu = tool.outer.friction_axial;
        // Without weight the level part takes nothing.
        let expected = 20e3 * (-0.5 * mu * FRAC_PI_2).exp();
        // Steps of 2 cm in an arc of 3.2 m: (mu h / R)^4 / 120 per step.
        assert!((with("environment.buoyancy_factor", 0.0) / expected - 1.0).abs() < 1e-10);
        // The level part takes its factor times mu w L: without friction there, that much more arrives.
        let taken = 2.0 * mu * weights(&tool).iter().sum::<f64>() * 10.0;
        let factor = "contact.wall_friction_factors.after_arc";
        // A level hole takes the same from all of its length: rounding of 90 deg alone.
        assert!(((with(factor, 0.0) - with(factor, 2.0)) / taken - 1.0).abs() < 1e-9);
    }
}
