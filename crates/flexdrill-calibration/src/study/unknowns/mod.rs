//! What is fitted of a configuration.

mod made;
mod rock;
pub mod sensors;

use crate::CalibrationError;
use crate::sensor::Sensor;
use crate::unknown::{Shape, Unknown};
use crate::windows::Activity;
use flexdrill_config::{Config, ConfigError, Model};
use flexdrill_core::tool::HoleInterval;
use sensors::{Of, OfSensor};

/// An unknown that the twin's runs depend on.
#[derive(Debug, Clone, PartialEq)]
pub struct Modelled {
    /// Name and prior.
    pub unknown: Unknown,
    /// Keys of the configuration that get its value.
    pub keys: Vec<&'static str>,
    /// What a key gets per value of the unknown: 1 where the keys are the unknown itself.
    pub per_value: f64,
    /// Whether it acts on a bit that drills alone: runs off bottom do not depend on it.
    pub drilling_alone: bool,
}

impl Modelled {
    /// A coefficient that its keys are, with 90 % of its prior in `range`.
    fn of(name: &str, keys: &[&'static str], range: [f64; 2]) -> Result<Self, CalibrationError> {
        Ok(Self {
            unknown: Unknown::new(name, "", Shape::LogNormal, range)?,
            keys: keys.to_vec(),
            per_value: 1.0,
            drilling_alone: false,
        })
    }

    /// What its keys get for a value of the unknown.
    pub fn key_value(&self, value: f64) -> f64 {
        self.per_value * value
    }
}

/// All unknowns of a configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknowns {
    /// Those that the twin's runs depend on.
    pub modelled: Vec<Modelled>,
    /// Those of the rig's sensors, which follow the modelled ones in the order of all unknowns.
    pub sensors: Vec<OfSensor>,
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
        let mut modelled = Vec::new();
        let mut left_out = Vec::new();
        // Only what the log can show is fitted. Everything else is listed with
        // its reason, so that a reader does not search for it.
        let leans = config
            .string
            .sections
            .iter()
            .any(|section| section.inclination_deg != 0.0);
        // Above a vertical string there is no side force, and its coefficient has no effect that a log could show.
        if config.string.model == Model::Line && leans {
            modelled.push(Modelled::of(
                "friction of the string above",
                &["string.friction.coefficient"],
                ranges.friction.ends(),
            )?);
        } else {
            left_out.push(("friction of the string above", "no part of the string lies on the wall"));
        }
        // Both directions of a contact have one coefficient: torque sees them
        // around and hook load along, and a log rarely separates them.
        modelled.push(Modelled::of(
            "friction of pipe in guide",
            &["contact.inner.friction_tangential", "contact.inner.friction_axial"],
            ranges.friction.ends(),
        )?);
        // The wall has one unknown per interval of the hole, whose lengths of contact differ.
        modelled.extend(of_the_wall(config, &mut left_out)?);
        modelled.extend(rock::of(config, &mut left_out)?);
        if config.tool.joint.friction > 0.0 {
            modelled.push(Modelled::of(
                "friction in the joints",
                &["tool.joint.friction"],
                ranges.joint_friction.ends(),
            )?);
        } else {
            left_out.push(("friction in the joints", "tool.joint.friction is 0: the model has none"));
        }
        modelled.extend(made::of(config, &mut left_out)?);
        Ok(Self {
            modelled,
            sensors: sensors::of(config)?,
            left_out,
        })
    }

    /// All unknowns: those that the twin's runs depend on, then those of the sensors.
    pub fn all(&self) -> Vec<Unknown> {
        let modelled = self.modelled.iter().map(|modelled| &modelled.unknown);
        let of_sensors = self.sensors.iter().map(|known| &known.unknown);
        modelled.chain(of_sensors).cloned().collect()
    }

    /// Numbers of the modelled unknowns that runs in a state of motion depend on.
    pub fn acting(&self, motion: Activity) -> Vec<usize> {
        let acts = |modelled: &Modelled| motion == Activity::Drilling || !modelled.drilling_alone;
        (0..self.modelled.len()).filter(|k| acts(&self.modelled[*k])).collect()
    }

    /// The sensor of what is measured; `hanging` is the hook load (N) of a tool that hangs.
    pub fn sensor(&self, of: Of, hanging: f64) -> Sensor {
        sensors::sensor(&self.sensors, self.modelled.len(), of, hanging)
    }

    /// Range of the weights (N) that may act where the indicator shows these, over the part of the prior that a design covers.
    pub fn acting_range(&self, shown: [f64; 2]) -> [f64; 2] {
        sensors::acting_range(&self.sensors, shown, crate::fit::DESIGN)
    }

    /// The configuration with values of the modelled unknowns.
    ///
    /// # Errors
    /// When the configuration does not allow one of them.
    pub fn apply(&self, config: &Config, values: &[f64]) -> Result<Config, ConfigError> {
        let pairs = self.modelled.iter().zip(values);
        let keys = pairs.flat_map(|(modelled, value)| {
            let value = modelled.key_value(*value);
            modelled.keys.iter().map(move |key| (*key, value))
        });
        config.with_values("calibration", keys)
    }
}

/// The friction of the guide on the wall, one coefficient per interval of the hole. In a hole of one interval it is the
/// coefficient of the layer. In others each interval has its factor on that, so that no interval's value depends on
/// whether the log determines another's.
fn of_the_wall(
    config: &Config,
    left_out: &mut Vec<(&'static str, &'static str)>,
) -> Result<Vec<Modelled>, CalibrationError> {
    let tool = config.tool();
    let range = config.calibration.friction.ends();
    let intervals: Vec<HoleInterval> = HoleInterval::ALL
        .into_iter()
        .filter(|interval| tool.well.has(*interval))
        .collect();
    // With one interval the coefficient itself is fitted, so that its value can be compared between wells.
    if let [only] = intervals.as_slice() {
        let name = "friction of guide on wall";
        let factor = tool.wall_friction_factors.of(*only);
        // A factor of zero has switched the friction of this wall off; no coefficient would change that.
        if factor == 0.0 {
            left_out.push((
                name,
                "contact.wall_friction_factors has 0 for the hole: the wall has no friction",
            ));
            return Ok(Vec::new());
        }
        let keys = ["contact.outer.friction_tangential", "contact.outer.friction_axial"];
        let mut whole = Modelled::of(name, &keys, range)?;
        // The fit has the friction as it acts; the key has it before the factor.
        whole.per_value = 1.0 / factor;
        return Ok(vec![whole]);
    }
    let mut all = Vec::new();
    for interval in intervals {
        let (name, key) = match interval {
            HoleInterval::BeforeArc => (
                "friction of guide on wall before the arc",
                "contact.wall_friction_factors.before_arc",
            ),
            HoleInterval::Arc => (
                "friction of guide on wall in the arc",
                "contact.wall_friction_factors.arc",
            ),
            HoleInterval::AfterArc => (
                "friction of guide on wall after the arc",
                "contact.wall_friction_factors.after_arc",
            ),
        };
        // A factor on zero remains zero, whatever the log shows.
        let whole = config.contact.outer.friction_axial;
        if whole == 0.0 {
            left_out.push((name, "contact.outer.friction_axial is 0, and so is every factor of it"));
            continue;
        }
        let mut of_interval = Modelled::of(name, &[key], range)?;
        of_interval.per_value = 1.0 / whole;
        all.push(of_interval);
    }
    Ok(all)
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
                "inclination of the cutters",
                "force that the wear flats carry",
                "specific energy of the rock",
                "friction in the joints",
                "limit of the joints",
                "bending stiffness of the guide",
                "free curvature of the guide"
            ]
        );
        // Off bottom the bit does nothing.
        assert_eq!(unknowns.acting(Activity::OffBottom), [0, 1, 6, 7, 8, 9]);
        assert_eq!(unknowns.acting(Activity::Drilling).len(), 10);
        let [low, high] = unknowns.modelled[7].unknown.prior();
        assert_eq!([low, high], [5.5, 6.5]);
        assert_eq!(unknowns.left_out[0].0, "friction of the string above");
        let changed = unknowns
            .apply(&config, &[0.31, 0.33, 0.12, 1.2, 3300.0, 31e6, 0.2, 6.1, 0.009, 0.28])
            .unwrap();
        assert_eq!(changed.contact.inner.friction_axial, 0.31);
        assert_eq!(changed.contact.outer.friction_tangential, 0.33);
        assert_eq!(changed.rock.depth_of_cut.wear_flat_friction, 0.12);
        assert_eq!(changed.rock.depth_of_cut.wear_flat_force, 3300.0);
        assert_eq!(changed.tool.joint.friction, 0.2);
        assert_eq!(changed.tool.joint.limit_deg, 6.1);
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
    #[test]
    fn a_hole_with_a_straight_part_has_a_coefficient_per_interval() {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let longer = config.with_links(45).unwrap();
        let unknowns = Unknowns::of(&longer).unwrap();
        let names: Vec<&str> = unknowns
            .modelled
            .iter()
            .take(4)
            .map(|modelled| modelled.unknown.name.as_str())
            .collect();
        assert_eq!(
            names,
            [
                "friction of pipe in guide",
                "friction of guide on wall in the arc",
                "friction of guide on wall after the arc",
                "friction of the bit on the rock"
            ]
        );
        for wall in &unknowns.modelled[1..3] {
            let [low, high] = wall.unknown.prior();
            assert!(
                (low - 0.25).abs() < 1e-12 && (high - 0.40).abs() < 1e-12,
                "{low} {high}"
            );
        }
        let changed = unknowns.apply(&longer, &[0.31, 0.24, 0.39, 0.12, 0.2]).unwrap();
        let tool = changed.tool();
        assert_eq!(changed.contact.outer, longer.contact.outer);
        let of = |interval| tool.outer.friction_axial * tool.wall_friction_factors.of(interval);
        // A quotient and a product round to 1e-16 each.
        assert!((of(HoleInterval::Arc) - 0.24).abs() < 1e-15 && (of(HoleInterval::AfterArc) - 0.39).abs() < 1e-15);
        let frictionless = longer.with_value("contact.outer.friction_axial", 0.0).unwrap();
        let none = Unknowns::of(&frictionless).unwrap();
        assert_eq!(none.modelled.len(), unknowns.modelled.len() - 2);
        assert!(none.left_out.iter().any(|(name, _)| name.ends_with("after the arc")));
    }

    #[test]
    fn the_coefficient_of_a_hole_of_one_interval_has_its_factor() {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let harder = config.with_value("contact.wall_friction_factors.arc", 1.6).unwrap();
        let unknowns = Unknowns::of(&harder).unwrap();
        let tool = unknowns.apply(&harder, &[0.31, 0.32, 0.12, 0.2]).unwrap().tool();
        assert!((tool.outer.friction_axial * tool.wall_friction_factors.arc - 0.32).abs() < 1e-15);
    }
}
