//! What is fitted of a configuration.

use flexdrill_calibration::CalibrationError;
use flexdrill_calibration::unknown::{Shape, Unknown};
use flexdrill_config::{Config, ConfigError, Law, Model};
use flexdrill_core::units::kn_to_n;

/// An unknown that the twin's runs depend on.
#[derive(Debug, Clone, PartialEq)]
pub struct Modelled {
    /// Name and prior.
    pub unknown: Unknown,
    /// Keys of the configuration that get its value.
    pub keys: Vec<&'static str>,
}

/// All unknowns of a configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    /// Those that the twin's runs depend on.
    pub modelled: Vec<Modelled>,
    /// Offset of the surface torque's sensor (N m).
    pub torque_tare: Unknown,
    /// Offset of the hook load's sensor (N).
    pub hook_load_tare: Unknown,
    /// Unknowns of the issue that this configuration does not have, with the reason.
    pub left_out: Vec<(&'static str, &'static str)>,
}

impl Unknowns {
    /// The unknowns of a configuration with the priors of its section `calibration`.
    ///
    /// # Errors
    /// When a prior cannot be.
    pub fn of(config: &Config) -> Result<Self, CalibrationError> {
        let ranges = &config.calibration;
        let coefficient = |name, range| Unknown::new(name, "", Shape::LogNormal, range);
        let mut modelled = Vec::new();
        let mut left_out = Vec::new();
        let mut add = |name, keys: &[&'static str], range| -> Result<(), CalibrationError> {
            modelled.push(Modelled {
                unknown: coefficient(name, range)?,
                keys: keys.to_vec(),
            });
            Ok(())
        };
        let leans = config
            .string
            .sections
            .iter()
            .any(|section| section.inclination_deg != 0.0);
        if config.string.model == Model::Line && leans {
            add(
                "friction of the string above",
                &["string.friction.coefficient"],
                ranges.friction.ends(),
            )?;
        } else {
            left_out.push(("friction of the string above", "no part of the string lies on the wall"));
        }
        add(
            "friction of pipe in guide",
            &["contact.inner.friction_tangential", "contact.inner.friction_axial"],
            ranges.friction.ends(),
        )?;
        add(
            "friction of guide on wall",
            &["contact.outer.friction_tangential", "contact.outer.friction_axial"],
            ranges.friction.ends(),
        )?;
        let (key, configured) = match config.rock.law {
            Law::DepthOfCut => (
                "rock.depth_of_cut.wear_flat_friction",
                config.rock.depth_of_cut.wear_flat_friction,
            ),
            _ => ("tool.bit.friction_factor", config.tool.bit.friction_factor),
        };
        if configured > 0.0 {
            add(
                "friction of the bit on the rock",
                &[key],
                ranges.bit.ends().map(|factor| factor * configured),
            )?;
        } else {
            left_out.push(("friction of the bit on the rock", "the configured coefficient is 0"));
        }
        if config.tool.joint.friction > 0.0 {
            add(
                "friction in the joints",
                &["tool.joint.friction"],
                ranges.joint_friction.ends(),
            )?;
        } else {
            left_out.push(("friction in the joints", "tool.joint.friction is 0: the model has none"));
        }
        let around = |middle: f64, distance: f64| [middle - distance, middle + distance];
        Ok(Self {
            modelled,
            torque_tare: Unknown::new(
                "tare of the surface torque",
                "N m",
                Shape::Normal,
                around(ranges.torque_tare_nm, ranges.torque_tare_range_nm),
            )?,
            hook_load_tare: Unknown::new(
                "tare of the hook load",
                "N",
                Shape::Normal,
                around(
                    kn_to_n(ranges.hook_load_tare_kn),
                    kn_to_n(ranges.hook_load_tare_range_kn),
                ),
            )?,
            left_out,
        })
    }

    /// The configuration with values of the modelled unknowns.
    ///
    /// # Errors
    /// When the configuration does not allow one of them.
    pub fn apply(&self, config: &Config, values: &[f64]) -> Result<Config, ConfigError> {
        let pairs = self.modelled.iter().zip(values);
        let keys = pairs.flat_map(|(modelled, value)| modelled.keys.iter().map(move |key| (*key, *value)));
        config.with_values("calibration", keys)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rig_has_what_acts_in_it() {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let unknowns = Unknowns::of(&config).unwrap();
        let names: Vec<&str> = unknowns
            .modelled
            .iter()
            .map(|modelled| modelled.unknown.name.as_str())
            .collect();
        assert_eq!(
            names,
            [
                "friction of pipe in guide",
                "friction of guide on wall",
                "friction of the bit on the rock",
                "friction in the joints"
            ]
        );
        assert_eq!(unknowns.left_out[0].0, "friction of the string above");
        let changed = unknowns.apply(&config, &[0.31, 0.33, 0.12, 0.2]).unwrap();
        assert_eq!(changed.contact.inner.friction_axial, 0.31);
        assert_eq!(changed.contact.outer.friction_tangential, 0.33);
        assert_eq!(changed.rock.depth_of_cut.wear_flat_friction, 0.12);
        assert_eq!(changed.tool.joint.friction, 0.2);
        // An inclined string leans on the wall.
        let text = config
            .to_yaml()
            .unwrap()
            .replace("inclination_deg: 0.0", "inclination_deg: 30.0");
        let inclined = Config::from_text("inclined", &text).unwrap();
        assert_eq!(
            Unknowns::of(&inclined).unwrap().modelled[0].keys,
            ["string.friction.coefficient"]
        );
    }
}
