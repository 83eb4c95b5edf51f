//! The YAML configuration: one schema for the tool, the well, the solver, the run, the inputs, the whirl thresholds and
//! the outputs.
//!
//! SI units; a key with another unit carries it in its name. Unknown keys are refused. Only `well` and `tool` must be
//! given; every other key has the default that its field documents. What is out of bounds is reported with file, line,
//! key, value, bound and unit, all problems at once.
//!
//! The plain structs here are the schema. A [`Config`] is a checked [`Schema`]; only [`Config::with_value`] changes it,
//! and checks it again.

mod alarms;
mod boundary;
mod calibration;
mod changed;
pub mod checker;
mod contact;
mod derived;
mod drilled;
mod ensemble;
mod environment;
mod error;
mod guide;
mod hard_limits;
mod inputs;
mod joint_life;
mod json_schema;
mod keys;
pub mod lines;
mod loads;
mod look_ahead;
mod map;
mod motion;
mod mud;
mod network;
mod outputs;
mod pipe;
mod place;
mod pressure;
pub mod reading;
mod rebase;
mod rock;
mod run;
mod schema;
mod section;
mod sized;
mod solver;
mod start;
mod string;
mod texts;
mod tool;
mod transfer;
mod uncertainty;
pub mod units;
mod vibration;
mod warnings;
mod well;
mod well_plan;
mod whirl;
mod whole;
mod yaml_place;
mod yaml_words;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

use std::collections::BTreeMap;
use std::ops::Deref;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;
use sha2::{Digest, Sha256};

pub use alarms::{Advice, AdviceTable, Alarms, NodeAlarm, ToolAlarm};
pub use boundary::{BottomAxial, Boundary, Drive, Held, Preset};
pub use calibration::{Calibration, Range};
pub use changed::{ChangedNumber, FOLLOWED};
pub use checker::NumberKey;
pub use contact::{Contact, Layer, WallFrictionFactors};
pub use derived::Unknowns;
pub use drilled::{Drilled, Interval};
pub use ensemble::{BandFactor, DrawnFrom, Ensemble, Members};
pub use environment::Environment;
pub use error::{ConfigError, Problem};
pub use guide::{AsBuilt, BentPiece, FreeBend, Guide, Never, SlotsClose};
pub use hard_limits::{HardBounds, HardLimits};
pub use inputs::{DriverPolicy, DriverRule, InputsConfig, Measured, RotarySpeed, StampRule, WeightOnBit};
pub use joint_life::{DetailClass, JointLife, LifeEnvironment};
pub use json_schema::json_schema;
pub use loads::{History, Load, Mass};
pub use look_ahead::LookAhead;
pub use map::SafeMap;
pub use motion::PROMPT_OFF_DELAY;
pub use mud::Mud;
pub use network::{Network, Reach};
pub use outputs::{Outputs, Rates};
pub use pipe::{Piece, Pipe};
pub use place::At;
pub use pressure::{AtTop, End, Pressure, Standpipe};
pub use rock::{DepthOfCut, Law, Rock, Weakening};
pub use run::Run;
pub use schema::Schema;
pub use solver::{Solver, TimeScheme};
pub use start::{Initial, Start};
pub use string::{DrillString, Feed, Friction, Hoist, Model, Section as StringSection, TopDrive, Tuning};
pub use texts::key_texts;
pub use tool::{Bit, BitAxis, Damping, Joint, Material, Tool};
pub use transfer::{GuidePreload, PressureFolding, Transfer};
pub use uncertainty::{
    Correlated, Distribution, DownholeTorque, DownholeWeight, Factor, Form, Sensors, SpeedSensor, UncertainKey,
    Uncertainty, WeightIndicator,
};
pub use vibration::{ChaoticWhirl, JointLoad, Repeats, Shock, Steps, StickSlip};
pub use well::{Section, Well};
pub use well_plan::{PlannedStation, WellPlan};
pub use whirl::{ForwardPower, InputTrust, Watched, Whirl};

use checker::Checker;
use flexdrill_core::inputs::{InputKind, Inputs};
use flexdrill_core::tool::{FrictionLaw, GapDescription, LiveParameters, ToolDescription};
use flexdrill_core::twin::SimulationSettings;
use flexdrill_core::units::{kn_to_n, m_per_h_to_m_per_s, mpa_to_pa, rpm_to_rad_per_s};
use flexdrill_motion::WhirlSettings;
use flexdrill_text::hex;
use keys::{kind, left_out, meant, slot};
use lines::Lines;
use place::Mesh;

/// Keys without a default.
const REQUIRED: &[&str] = &[
    "well",
    "well.sections",
    "well.hole_diameter",
    "tool",
    "tool.links",
    "tool.pipe",
    "tool.guide",
    "tool.guide.outer_diameter",
    "tool.guide.inner_diameter",
    "tool.joint",
    "tool.joint.limit_deg",
    "tool.bit",
    "tool.bit.diameter",
];

/// A checked configuration. Fields are read through [`Schema`].
#[derive(Debug, Clone, PartialEq)]
pub struct Config {
    schema: Schema,
    /// Friction factor at the start of the run.
    begun_factor: f64,
}

impl Deref for Config {
    type Target = Schema;

    fn deref(&self) -> &Schema {
        &self.schema
    }
}

impl Config {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// When the file cannot be read, is not YAML of this schema, or does not make sense.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        let (name, text) = reading::read(path.as_ref())?;
        Self::from_text(&name, &text)
    }

    /// Reads and checks a text; `name` stands for the file in errors.
    ///
    /// # Errors
    /// When the text is not YAML of this schema, or does not make sense.
    pub fn from_text(name: &str, text: &str) -> Result<Self, ConfigError> {
        let schema = reading::checked(name, text, REQUIRED, Schema::check)?;
        Ok(Self::of(schema))
    }

    /// Checks a schema built in code; `name` stands for the file in errors.
    ///
    /// # Errors
    /// When it does not make sense.
    pub fn from_schema(name: &str, schema: Schema) -> Result<Self, ConfigError> {
        let lines = Lines::default();
        let mut checker = Checker::new(name, &lines);
        schema.check(&mut checker);
        checker.finish().map(|()| Self::of(schema))
    }

    /// A configuration as a run begins with it.
    fn of(schema: Schema) -> Self {
        Self {
            begun_factor: schema.calibration.friction_factor,
            schema,
        }
    }

    /// A copy with one value changed, checked as a whole. `key` is a dotted path (`contact.inner.friction_axial`) of a
    /// key that [`Config::to_yaml`] shows. A distribution in `uncertainty` that the change takes its meaning from, such as
    /// a factor on a value that is now 0, is removed with it.
    ///
    /// # Errors
    /// When the key does not exist, or the value is of the wrong type or out of bounds.
    pub fn with_value(&self, key: &str, value: impl Into<Value>) -> Result<Self, ConfigError> {
        self.with_values("parameter", [(key, value)])
    }

    /// The same with several values, for keys that only make sense together; `origin` stands for the file in errors.
    ///
    /// # Errors
    /// As [`Config::with_value`].
    pub fn with_values<K: AsRef<str>, V: Into<Value>>(
        &self,
        origin: &str,
        values: impl IntoIterator<Item = (K, V)>,
    ) -> Result<Self, ConfigError> {
        let mut tree = self.to_tree();
        let mut schema = self.schema.clone();
        let mut states_priors = false;
        for (key, value) in values {
            let (key, value) = (key.as_ref(), value.into());
            states_priors |= key.starts_with("uncertainty");
            let Some(node) = slot(&mut tree, key) else {
                return Err(ConfigError::UnknownKey {
                    key: key.to_string(),
                    meant: meant(key, &self.to_tree()),
                });
            };
            let wanted = kind(node);
            let mistyped = !node.is_null() && wanted != kind(&value);
            *node = value.clone();
            // One value at a time, so that the error names the key; an error of the types has no key.
            schema = Schema::deserialize(&tree).map_err(|error| ConfigError::WrongType {
                key: key.to_string(),
                value: value.to_string(),
                message: if mistyped {
                    format!("must be {wanted}")
                } else {
                    error.to_string()
                },
            })?;
        }
        // A sweep of a tool or a client that sets a parameter says nothing of its priors, and must not fail by them.
        if !states_priors && let Some(stated) = schema.uncertainty.take() {
            schema.uncertainty = Some(stated.that_holds(&schema.numbers()));
        }
        Self::from_schema(origin, schema)
    }

    /// The same for values that change while a run continues, which keeps what it began with: see
    /// [`Config::motion_factor`].
    ///
    /// # Errors
    /// As [`Config::with_value`].
    pub fn with_live_values<K: AsRef<str>, V: Into<Value>>(
        &self,
        origin: &str,
        values: impl IntoIterator<Item = (K, V)>,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            begun_factor: self.begun_factor,
            ..self.with_values(origin, values)?
        })
    }

    /// A copy without the sections `uncertainty` and `ensemble`: the values that stand in the file are what is known.
    #[must_use]
    pub fn without_uncertainty(&self) -> Self {
        let mut copy = self.clone();
        // No other section depends on it, so that the rest remains checked.
        (copy.schema.uncertainty, copy.schema.ensemble) = (None, None);
        copy
    }

    /// Whether there is a key of this dotted path, with a value or an optional one without.
    pub fn has(&self, key: &str) -> bool {
        slot(&mut self.to_tree(), key).is_some()
    }

    /// Optional keys without a value, with their texts: those of the schema that a section of this configuration leaves
    /// out, without the keys of sections that it leaves out as a whole.
    pub fn keys_left_out(&self) -> BTreeMap<String, String> {
        left_out(&self.to_tree())
    }

    /// All values by their keys.
    pub fn to_tree(&self) -> Value {
        // Serializing plain numbers, text and lists cannot fail; with an empty tree no key would be known.
        serde_json::to_value(&self.schema).unwrap_or(Value::Null)
    }

    /// Every numeric key with value, limits, unit and the reason of the limits.
    pub fn numbers(&self) -> Vec<NumberKey> {
        self.schema.numbers()
    }

    /// The tool, for the mechanics.
    pub fn tool(&self) -> ToolDescription {
        let mesh = self.mesh();
        let (elements, pipe, guide) = (self.tool.elements_per_link, &self.tool.pipe, &self.tool.guide);
        let hole = self.well.hole_diameter;
        let (links, uniform) = (self.tool.links, pipe.uniform_section().unwrap_or_default());
        ToolDescription::new(self.well.describe(), hole, links, uniform, guide.section()).with(|tool| {
            // From the inside to the outside, in the order of the schema.
            tool.elements_per_link = elements;
            tool.material = self.tool.material.describe();
            tool.pipe_sections = pipe.element_sections(elements);
            tool.pipe_contact_diameters = pipe.contact_diameters(elements);
            tool.guide_bending_factor = guide.bending_factor;
            tool.guide_free_curvature = guide.free_curvature();
            tool.guide_bends = guide.bends();
            tool.guide_slots_close_at = guide.slots_close_at();
            tool.guide_spine = guide.spine();
            tool.guide_fixed = guide.fixed;
            tool.joint = self.tool.joint.describe();
            tool.shortening = self.tool.shortening;
            tool.rayleigh = self.tool.damping.describe();
            [tool.inner, tool.outer] = self.layers();
            tool.wall_friction_factors = self.contact.wall_friction_factors.describe();
            tool.slip_speed = self.contact.slip_speed;
            tool.bit = self.tool.bit.describe();
            tool.gravity = self.environment.effective_gravity();
            // Pressure acts on the sections that were set above.
            let sections = &tool.pipe_sections;
            tool.pressure = self.environment.pressure.map(|pressure| pressure.describe(sections));
            tool.mud = self.environment.mud.map(|mud| mud.describe());
            tool.rock = self.rock.describe();
            tool.string = self.string.describe(tool.gravity, self.has_hoist());
            tool.supports = self.boundary.describe(&mesh, self.has_hoist());
            tool.drive_top = self.boundary.drive == Drive::Top;
            tool.wob_path = self.boundary.wob_path;
            tool.weight_place = self.boundary.weight_on_bit_at;
            tool.loads = self.loads.iter().map(|load| load.describe(&mesh)).collect();
            tool.masses = self.masses.iter().map(|mass| mass.describe(&mesh)).collect();
            tool.initial_pipe_velocity = self.initial.velocity;
            tool.initial_pipe_displacement = self.initial.displacement;
            tool.initial_spin_rate = rpm_to_rad_per_s(self.initial.spin_rpm);
            // A tool that slid in is in balance too.
            tool.static_start = self.start != Start::AsGiven;
            tool.slid_in = self.start == Start::SlidIn;
        })
    }

    /// Which inputs the tool's mechanics ask for, by [`InputKind::index`].
    pub fn used_inputs(&self) -> [bool; InputKind::COUNT] {
        let contact = &self.contact;
        InputKind::ALL.map(|kind| match kind {
            InputKind::RotarySpeed | InputKind::WeightOnBit => true,
            // Separate friction is regularised at a multiple of a usual advance, so that a rig need not send it.
            InputKind::RateOfPenetration => contact.outer.friction != FrictionLaw::Separate,
            InputKind::StandpipePressure => {
                (self.environment.pressure.as_ref()).is_some_and(|pressure| matches!(pressure.at_top, AtTop::Input(_)))
            }
        })
    }

    /// How the simulation runs.
    pub fn simulation(&self) -> SimulationSettings {
        let (speed, weight) = (&self.inputs.rotary_speed, &self.inputs.weight_on_bit);
        SimulationSettings::default().with(|settings| {
            settings.time_step = self.solver.time_step;
            settings.step = self.solver.rule();
            settings.scheme = self.solver.describe();
            settings.max_iterations = self.solver.max_iterations;
            settings.max_halvings = self.solver.max_halvings;
            settings.initial_inputs = Inputs {
                rotary_speed: rpm_to_rad_per_s(speed.initial_rpm),
                weight_on_bit: kn_to_n(weight.initial_kn),
                rate_of_penetration: m_per_h_to_m_per_s(self.inputs.rate_of_penetration.assumed_m_per_h),
                standpipe_pressure: mpa_to_pa(self.inputs.standpipe_pressure.assumed_mpa),
            };
            settings.rotary_speed_slew = rpm_to_rad_per_s(speed.fastest_change_rpm_per_s());
            settings.weight_on_bit_slew = kn_to_n(weight.slew_kn_per_s);
            settings.rate_of_penetration_slew = m_per_h_to_m_per_s(self.inputs.rate_of_penetration.slew_m_per_h_per_s);
            settings.standpipe_pressure_slew = mpa_to_pa(self.inputs.standpipe_pressure.slew_mpa_per_s);
            settings.whirl = self.whirl_settings();
            settings.stick_slip = self.stick_slip.describe();
            settings.shock = self.shock.describe();
            settings.joint_load = self.joint_load.describe();
            settings.chaotic_whirl = self.chaotic_whirl.describe();
            settings.transfer = self.transfer.describe();
            settings.guide_preload = self.guide_preload.describe();
            settings.pressure_folding = self.pressure_folding.describe();
            settings.ageing = self.ageing();
            settings.watched = self.whirl.watched_stations(self.mesh().last_station());
            settings.whirl_sample_interval = 1.0 / self.whirl.sample_rate;
        })
    }

    /// Friction factor of the motion around the hole, which decides on whirl and stick-slip. A torque sensor that drifts
    /// must not end a whirl that continues: with `calibration.follow` this factor follows the rig to more friction than the
    /// run began with, and not to less.
    pub fn motion_factor(&self) -> f64 {
        let factor = self.calibration.friction_factor;
        if self.calibration.follow {
            factor.max(self.begun_factor)
        } else {
            factor
        }
    }

    /// Both layers of contact, with the factors on their friction.
    fn layers(&self) -> [GapDescription; 2] {
        [&self.contact.inner, &self.contact.outer].map(|layer| {
            let mut layer = layer.describe();
            layer.friction_tangential *= self.motion_factor();
            layer.friction_axial *= self.calibration.friction_factor;
            layer
        })
    }

    /// Parameters that may change while running, as configured.
    pub fn live(&self) -> LiveParameters {
        let friction = |layer: &GapDescription| [layer.friction_tangential, layer.friction_axial];
        let [inner, outer] = self.layers();
        LiveParameters {
            inner_friction: friction(&inner),
            outer_friction: friction(&outer),
            bit_friction_factor: self.tool.bit.friction_factor,
        }
    }

    /// Settings of the whirl analysis.
    pub fn whirl_settings(&self) -> WhirlSettings {
        self.whirl.describe()
    }

    /// The complete configuration, defaults included; reads back to an equal one.
    ///
    /// # Errors
    /// When the serializer fails, which it does not for a checked configuration.
    pub fn to_yaml(&self) -> Result<String, serde_saphyr::SerializeError> {
        serde_saphyr::to_string(&self.schema)
    }

    /// SHA-256, in hex, over all values in the schema's order: equal for files that differ only in layout, comments or
    /// written-out defaults.
    pub fn hash(&self) -> String {
        // Serializing plain numbers, strings and lists cannot fail; if it did, hashes would coincide.
        sha256(&serde_json::to_vec(&self.schema).unwrap_or_default())
    }

    fn mesh(&self) -> Mesh {
        self.schema.mesh()
    }
}

/// SHA-256 in hex.
pub fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}
