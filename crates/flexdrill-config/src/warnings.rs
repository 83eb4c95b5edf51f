//! Warnings about values that are allowed but probably unintended.

use super::{Config, HardBounds};
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

/// Smallest duration of a collision of pipe and guide, in steps. The default tool's lasts 1.5 steps and is accurate; at
/// 0.99 its motion is not, nor that of a stiffer contact at 0.85 (`docs/measurements.md`, model quality). The guide
/// rests on the wall and does not strike it: contacts of 0.3 steps there did no harm.
const FEWEST_STEPS: f64 = 1.1;

impl Config {
    /// Warnings as sentences, most important first.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        self.warn_of_joint_limit(&mut warnings);
        self.warn_of_sagitta(&mut warnings);
        self.warn_of_short_contacts(&mut warnings);
        let off_mesh = self.tool.pipe.pieces_off_mesh(self.tool.elements_per_link);
        if !off_mesh.is_empty() {
            warnings.push(format!(
                "tool.pipe.pieces end at {off_mesh:?} of the link, inside an element; each of the {} elements takes the piece at its middle",
                self.tool.elements_per_link
            ));
        }
        let (bit, hole) = (self.tool.bit.diameter, self.well.hole_diameter);
        if (bit - hole).abs() > 0.02 * hole {
            warnings.push(format!(
                "tool.bit.diameter {bit} m and well.hole_diameter {hole} m differ by more than 2 %: a bit cuts its own diameter"
            ));
        }
        for (name, rate) in self.rates() {
            if rate * self.solver.time_step > 1.0 {
                warnings.push(format!(
                    "outputs.rates.{name} {rate} Hz is faster than the model's step of {} s",
                    self.solver.time_step
                ));
            }
        }
        if self.whirl.sample_rate * self.solver.time_step > 1.0 {
            warnings.push(format!(
                "whirl.sample_rate {} Hz is faster than the model's step of {} s",
                self.whirl.sample_rate, self.solver.time_step
            ));
        }
        warnings.extend(HardBounds::overridden(self));
        warnings
    }

    fn rates(&self) -> [(&'static str, f64); 3] {
        let rates = &self.outputs.rates;
        [
            ("joint_deflections", rates.joint_deflections),
            ("contact_forces", rates.contact_forces),
            ("bit_state", rates.bit_state),
        ]
    }

    fn warn_of_joint_limit(&self, warnings: &mut Vec<String>) {
        let (limit, needed) = (self.tool.joint.limit_deg, self.build_angle_per_link_deg());
        if self.tool.links < 2 {
            return;
        }
        if limit <= needed {
            warnings.push(format!(
                "tool.joint.limit_deg {limit} deg is not above the {needed:.2} deg that each joint must take in the arc: all stops carry load from the start; take more links or a larger limit"
            ));
        }
        // A link that lies diagonally in the gap bends both its joints.
        let lean = rad_to_deg((2.0 * self.inner_clearance() / self.link_length()).atan());
        if limit > needed + 2.0 * lean && limit < 45.0 {
            warnings.push(format!(
                "tool.joint.limit_deg {limit} deg can hardly be reached: the gap lets a joint bend to about {:.1} deg",
                needed + 2.0 * lean
            ));
        }
    }

    fn warn_of_short_contacts(&self, warnings: &mut Vec<String>) {
        let (step, duration) = (self.solver.time_step, self.contact_duration());
        if duration < FEWEST_STEPS * step {
            warnings.push(format!(
                "contact.inner.stiffness {:.3e} N/m throws a node of the pipe back after {:.2} ms, {:.2} steps of solver.time_step {step} s; below {FEWEST_STEPS} steps collisions may feed the motion (model_quality in twin/status): take a step below {:.2e} s, or a softer contact",
                self.contact.inner.stiffness,
                1e3 * duration,
                duration / step,
                duration / FEWEST_STEPS
            ));
        }
    }

    fn warn_of_sagitta(&self, warnings: &mut Vec<String>) {
        let (sagitta, clearance) = (self.chord_sagitta(), self.inner_clearance());
        if sagitta > clearance {
            warnings.push(format!(
                "a straight link of {:.3} m does not fit into the curved guide: its chord lies {:.1} mm off the centre line, the clearance is {:.1} mm; take more links",
                self.link_length(),
                sagitta * 1e3,
                clearance * 1e3
            ));
        }
        let tilt = deg_to_rad(self.build_angle_per_link_deg());
        if tilt > 0.2 {
            warnings.push(format!(
                "a link turns by {:.1} deg in the arc: tilts are not small any more",
                rad_to_deg(tilt)
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn default_tool() -> Config {
        Config::load("../../config/default.yaml").unwrap()
    }

    fn short_contacts(config: &Config) -> Vec<String> {
        let mut warnings = Vec::new();
        config.warn_of_short_contacts(&mut warnings);
        warnings
    }

    #[test]
    fn contacts_too_short_for_the_step_are_warned_of() {
        let stiff = default_tool().with_value("contact.inner.stiffness", 3e7).unwrap();
        let warnings = short_contacts(&stiff);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        // 63 x 32 mm of steel, 152 mm in five elements: 0.553 kg; pi sqrt(m / k) = 0.427 ms.
        for part in [
            "contact.inner.stiffness 3.000e7 N/m",
            "0.43 ms",
            "0.85 steps",
            "below 3.88e-4 s",
        ] {
            assert!(warnings[0].contains(part), "'{part}' is not in {}", warnings[0]);
        }
        let finer = stiff.with_value("solver.time_step", 3.8e-4).unwrap();
        assert!(short_contacts(&finer).is_empty());
    }

    #[test]
    fn the_default_tool_is_not_warned_of_until_its_step_grows() {
        let config = default_tool();
        assert!(short_contacts(&config).is_empty());
        let doubled = config.with_value("solver.time_step", 1e-3).unwrap();
        assert_eq!(short_contacts(&doubled).len(), 1);
    }
}
