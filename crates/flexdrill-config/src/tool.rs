//! `tool`: the flexible pipe, its joints, the guide pipe and the bit.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker, EachItem};
use super::guide::Guide;
use super::joint_life::{JointLife, check_serial_numbers};
use super::json_schema;
use super::pipe::Pipe;
use super::section::section;
use flexdrill_core::tool::{
    BitDescription, HingeAngle, JointDescription, JointKind, JointPlay, Material as Steel, PinFriction, Rayleigh,
    Shortening,
};
use flexdrill_core::units::deg_to_rad;

const LINKS: Bound = Bound::within(1.0, 500.0);
const ELEMENTS: Bound = Bound::within(1.0, MOST_ELEMENTS as f64);
const MOST_ELEMENTS: usize = 50;
const LATERAL_RESISTANCE: Bound = Bound::within(2.0, 1000.0);
/// A resistance of 1 cuts as easily across as along: the tilt of the bit then no longer steers.
const RESISTANCE_RANGE: Bound = Bound::within(1.1, 1e4);
const WALK_ANGLE: Bound = Bound::within(-60.0, 60.0);
/// The lateral resistance of a gauge of 40 mm in mid-hard rock.
const USUAL_RESISTANCE: f64 = 20.0;

/// The tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Number of links; they share the well's length equally. Required.
    #[schemars(transform = LINKS.in_schema())]
    pub links: usize,
    /// Beam elements per link. Default 5, the paper's.
    #[serde(default = "five")]
    #[schemars(transform = ELEMENTS.in_schema())]
    pub elements_per_link: usize,
    /// Material of both pipes. Default steel.
    #[serde(default)]
    pub material: Material,
    /// The flexible pipe. Required.
    pub pipe: Pipe,
    /// The guide pipe. Required.
    pub guide: Guide,
    /// The joints. Required.
    pub joint: Joint,
    /// How a link that tilts across its chord shortens along it: `none`, as in the paper, or `second_order`, by the square
    /// of the tilt. Default none.
    #[serde(default)]
    #[schemars(with = "json_schema::Shortening")]
    pub shortening: Shortening,
    /// Rayleigh damping.
    #[serde(default)]
    pub damping: Damping,
    /// The bit. Required.
    pub bit: Bit,
}

fn five() -> usize {
    5
}

section! {
    /// Isotropic, linear elastic; the defaults are those of steel.
    #[derive(Copy)]
    pub struct Material(this) {
        /// Young's modulus (Pa).
        youngs_modulus: f64 = 206e9, within(1e6, 1e14), "Pa", "in Pa; steel is 206e9";
        /// Poisson's ratio.
        poisson_ratio: f64 = 0.3, within(-0.99, 0.5), "",
            "outside, an isotropic material would gain energy when loaded";
        /// Density (kg/m3).
        density: f64 = 7850.0, within(1.0, 1e6), "kg/m3", "the mass matrix must be positive; steel is 7850";
    }
}

section! {
    /// The joints between links.
    pub struct Joint(this) {
        /// Kind of joint: `universal` (a cross), `ball_cage` (constant velocity) or `revolute` (a hinge, for comparison
        /// with the paper). Default universal.
        #[serde(default = "universal")]
        #[schemars(with = "json_schema::JointKind")]
        kind: JointKind;
        /// Bend angle at which the stop begins. It affects the motion more than any other key. Required.
        limit_deg: f64, above(0.0, 45.0), "deg",
            "tilts are small in the model; a joint that never stops may be set to 45";
        /// Stiffness of the stop (N m/rad). Default 2e5, of the order of 4EI/l of a link.
        #[serde(default = "default_stop_stiffness")]
        stop_stiffness: f64, within(0.0, 1e12), "N m/rad", "0 switches the stop off";
        /// Hunt-Crossley damping of the stop (s/rad). Default 0.5.
        #[serde(default = "half")]
        stop_damping: f64, within(0.0, 1e3), "s/rad", "0 is elastic; far above 1 the stop hardly opens within a step";
        /// Angle of the first cross about the shaft. Default 0.
        #[serde(default)]
        cross_phase_deg: f64, within(-360.0, 360.0), "deg", "one turn";
        /// Angle from one cross to the next. Default 90.
        #[serde(default = "ninety")]
        cross_phase_step_deg: f64, within(-360.0, 360.0), "deg", "one turn";
        /// Angle that a `revolute` joint keeps across its hinge: `straight` links, or `as_built` in the well. Default
        /// straight.
        #[serde(default)]
        #[schemars(with = "json_schema::HingeAngle")]
        hinge_angle: HingeAngle;
        /// Coefficient of friction in the pins of a `universal` joint's cross. Default 0, as in the paper.
        #[serde(default)]
        friction: f64, within(0.0, 1.0), "", "0 is none; steel in mud rubs with 0.1 to 0.4";
        /// Radius of a pin of the cross (m). Default 6 mm. Used with `friction` only.
        #[serde(default = "default_pin_radius")]
        pin_radius: f64, above(0.0, 0.1), "m", "in metres; the pins fit into the joint";
        /// Diameter of the circle on which the pins carry the torque (m). Default 40 mm. Used with `friction` only.
        #[serde(default = "default_pin_circle")]
        pin_circle_diameter: f64, above(0.0, 0.5), "m", "in metres; the pins lie within the joint";
        /// Rate of swing at which the regularised friction of the pins reaches 71 % of Coulomb's (rad/s). Default 0.02:
        /// a joint of the paper's arc swings by up to 0.2 rad/s at 40 r/min.
        #[serde(default = "default_pin_slip_rate")]
        pin_slip_rate: f64, within(1e-4, 1.0), "rad/s",
            "0 would make the moment jump where a joint's swing turns; far above the swing there is no friction";
        /// Play of a joint about its shaft: the angle by which its links turn freely against each other, from stop to
        /// stop. Not with `revolute`. Default 0: the spins are a constraint.
        #[serde(default)]
        play_deg: f64, within(0.0, 20.0), "deg", "0 is none; a worn joint has some tenths of a degree";
        /// Stiffness of the contact at either end of the play (N m/rad). Default 1e6. Used with `play_deg` only.
        #[serde(default = "default_play_stiffness")]
        play_stiffness: f64, above(0.0, 1e9), "N m/rad", "the contact carries the torque";
        /// Hunt-Crossley damping of that contact (s/rad). Default 0.5. Used with `play_deg` only.
        #[serde(default = "half")]
        play_damping: f64, within(0.0, 1e3), "s/rad", "0 is elastic; far above 1 the contact hardly opens within a step";
        /// Serial numbers of the joints, from the bit up: `tool.links` - 1 of them. `flexdrill life` keeps the life of each.
        /// Default none.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        serial_numbers: Vec<String>;
        /// The class of the joints' details, for their life. It changes nothing of the motion. Default none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        life: Option<JointLife>;
    }
}

fn default_pin_radius() -> f64 {
    PinFriction::NONE.pin_radius
}

fn default_pin_circle() -> f64 {
    PinFriction::NONE.circle_diameter
}

fn default_pin_slip_rate() -> f64 {
    PinFriction::NONE.slip_rate
}

fn default_play_stiffness() -> f64 {
    JointPlay::NONE.stiffness
}

fn universal() -> JointKind {
    JointKind::Universal
}

fn default_stop_stiffness() -> f64 {
    2e5
}

fn half() -> f64 {
    0.5
}

fn ninety() -> f64 {
    90.0
}

section! {
    /// Rayleigh damping, C = alpha M + beta K.
    #[derive(Copy)]
    pub struct Damping(this) {
        /// Factor on the mass matrix (1/s).
        alpha: f64 = 2.0, within(0.0, 1e5), "1/s", "damping only takes energy";
        /// Factor on the stiffness matrix (s).
        beta: f64 = 1e-4, within(0.0, 1.0), "s", "damping only takes energy";
    }
}

section! {
    /// The bit, Eq. 1.
    #[derive(Copy)]
    pub struct Bit(this) {
        /// Diameter of the hole that the bit cuts (m). Required.
        diameter: f64, above(0.0, 2.0), "m", "given in metres";
        /// Friction factor eta of Eq. 1: the bit torque is eta x diameter x weight on bit / 3. Default 0.235, the
        /// paper's.
        #[serde(default = "paper_eta")]
        friction_factor: f64, within(0.0, 5.0), "", "0 is a bit without torque; rock and bit rarely exceed 1";
        /// Bit speed at which the regularised torque reaches 71 % of Eq. 1 (rad/s). Default 0.1.
        #[serde(default = "tenth")]
        slip_rate: f64, within(1e-4, 10.0), "rad/s", "0 would make the torque jump at standstill";
        /// Moment of inertia of the bit about its axis (kg m2), as of a thin disc. Default 0: only the pipe's inertia
        /// acts there.
        #[serde(default)]
        inertia: f64, within(0.0, 1e3), "kg m2", "an inertia is not negative; a bit of 8 kg in a 118 mm hole has 0.01";
        /// Lateral resistance of the bit: depth of cut along the axis over that across it, under equal forces. Large: the
        /// bit hardly cuts sideways and drills where it points. A gauge of 40 mm gives about 20. Only `flexdrill ahead`
        /// reads it. Default 20.
        ///
        /// Allowed: within 2 to 1000
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(transform = LATERAL_RESISTANCE.in_schema())]
        lateral_resistance: Option<f64>;
        /// Range of the lateral resistance, 90 % of what is plausible with rock and wear: `[5, 100]`. Only `flexdrill
        /// ahead` reads it, unless `uncertainty.keys` has a distribution of `lateral_resistance`. Default a quarter to five
        /// times `lateral_resistance`.
        ///
        /// Allowed: within 1.1 to 10000
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(transform = EachItem(RESISTANCE_RANGE))]
        lateral_resistance_range: Option<[f64; 2]>;
        /// Angle by which the bit cuts to the side of its side force, clockwise seen down the hole. Only `flexdrill ahead`
        /// reads it. Default 0.
        ///
        /// Allowed: within -60 to 60 deg
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(transform = WALK_ANGLE.in_schema())]
        walk_angle_deg: Option<f64>;
        /// What holds the bit's axis: the `guide`, in a bearing of some length, or the last `link` of the pipe, with the bit
        /// only centred by the guide. Only `flexdrill ahead` reads it, and predicts nothing with `link`. Default guide.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(with = "BitAxis")]
        axis: Option<BitAxis>;
    }
}

/// What holds the bit's axis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BitAxis {
    /// The guide, in a bearing of some length.
    #[default]
    Guide,
    /// The last link of the pipe.
    Link,
}

fn paper_eta() -> f64 {
    0.235
}

fn tenth() -> f64 {
    0.1
}

impl Bit {
    /// Torque of Eq. 1 per weight on bit (m): N m per N.
    pub fn torque_arm(&self) -> f64 {
        self.friction_factor * self.diameter / 3.0
    }

    /// The lateral resistance, as given or the default.
    pub fn lateral_resistance(&self) -> f64 {
        self.lateral_resistance.unwrap_or(USUAL_RESISTANCE)
    }

    /// Ends of 90 % of the plausible lateral resistances.
    pub fn lateral_resistance_range(&self) -> [f64; 2] {
        let middle = self.lateral_resistance();
        self.lateral_resistance_range
            .unwrap_or([(0.25 * middle).max(1.1), 5.0 * middle])
    }

    /// Angle of the sideways cutting against the side force (deg).
    pub fn walk_angle_deg(&self) -> f64 {
        self.walk_angle_deg.unwrap_or_default()
    }

    /// What holds the bit's axis.
    pub fn axis(&self) -> BitAxis {
        self.axis.unwrap_or_default()
    }

    fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        if let Some(resistance) = self.lateral_resistance {
            let reason = "below 2 the tilt of the bit no longer steers; beyond 1000 it drills where it points";
            c.number("lateral_resistance", resistance, LATERAL_RESISTANCE, "", reason);
        }
        if let Some(angle) = self.walk_angle_deg {
            let reason = "bits walk by some 20 deg at most";
            c.number("walk_angle_deg", angle, WALK_ANGLE, "deg", reason);
        }
        if let Some([low, high]) = self.lateral_resistance_range {
            let middle = self.lateral_resistance();
            c.require(
                low < high && [low, high].into_iter().all(|end| RESISTANCE_RANGE.holds(end)),
                "lateral_resistance_range",
                format!("[{low}, {high}]"),
                "",
                format!(
                    "two numbers within {}, the first the smaller one",
                    RESISTANCE_RANGE.words("")
                ),
                "they are the ends of 90 % of the plausible values",
            );
            c.require(
                low >= high || (low..=high).contains(&middle),
                "lateral_resistance_range",
                format!("[{low}, {high}]"),
                "",
                format!("a range around tool.bit.lateral_resistance, {middle}"),
                "the value itself is plausible",
            );
        }
    }
}

impl Tool {
    pub(super) fn check(&self, c: &mut Checker) {
        c.count(
            "links",
            self.links,
            LINKS,
            "more than 500 links cannot be stepped in useful time",
        );
        c.count(
            "elements_per_link",
            self.elements_per_link,
            ELEMENTS,
            "a link is short and stiff; the paper takes 5",
        );
        c.below("material", |c| self.material.check_numbers(c));
        c.below("pipe", |c| self.pipe.check(c));
        c.below("guide", |c| self.guide.check(c));
        if (1..=MOST_ELEMENTS).contains(&self.elements_per_link) {
            let widest = self
                .pipe
                .contact_diameters(self.elements_per_link)
                .into_iter()
                .fold(0.0, f64::max);
            c.require(
                widest < self.guide.inner_diameter,
                "guide.inner_diameter",
                self.guide.inner_diameter,
                "m",
                format!("above the pipe's contact diameter, {widest} m"),
                "the pipe turns inside the guide",
            );
        }
        c.below("joint", |c| self.joint.check(c, self.links.saturating_sub(1)));
        c.below("damping", |c| self.damping.check_numbers(c));
        c.below("bit", |c| self.bit.check(c));
    }
}

impl Material {
    pub(super) fn describe(&self) -> Steel {
        Steel {
            youngs_modulus: self.youngs_modulus,
            poisson_ratio: self.poisson_ratio,
            density: self.density,
        }
    }
}

impl Joint {
    /// Checks the description of `joints` joints.
    fn check(&self, c: &mut Checker, joints: usize) {
        self.check_numbers(c);
        check_serial_numbers(c, &self.serial_numbers, joints);
        if let Some(life) = &self.life {
            c.below("life", |c| life.check(c));
        }
        c.require(
            self.friction == 0.0 || self.kind == JointKind::Universal,
            "friction",
            self.friction,
            "",
            "0 unless tool.joint.kind is universal".to_owned(),
            "the friction is that of the pins of a cross",
        );
        c.require(
            self.friction == 0.0 || self.pin_circle_diameter > self.pin_radius,
            "friction",
            self.friction,
            "",
            format!(
                "0 unless tool.joint.pin_circle_diameter, {} m, is above tool.joint.pin_radius, {} m",
                self.pin_circle_diameter, self.pin_radius
            ),
            "the pins stand around the shaft",
        );
        c.require(
            self.play_deg == 0.0 || self.kind != JointKind::Revolute,
            "play_deg",
            self.play_deg,
            "deg",
            "0 with tool.joint.kind revolute".to_owned(),
            "play needs a joint with one row about the shaft; a hinge has two",
        );
    }

    pub(super) fn describe(&self) -> JointDescription {
        let mut joint = JointDescription::new(self.kind, deg_to_rad(self.limit_deg));
        joint.stop_stiffness = self.stop_stiffness;
        joint.stop_damping = self.stop_damping;
        joint.cross_phase = deg_to_rad(self.cross_phase_deg);
        joint.cross_phase_step = deg_to_rad(self.cross_phase_step_deg);
        joint.hinge_angle = self.hinge_angle;
        joint.friction = PinFriction {
            coefficient: self.friction,
            pin_radius: self.pin_radius,
            circle_diameter: self.pin_circle_diameter,
            slip_rate: self.pin_slip_rate,
        };
        joint.play = JointPlay {
            half_angle: 0.5 * deg_to_rad(self.play_deg),
            stiffness: self.play_stiffness,
            damping: self.play_damping,
        };
        joint
    }
}

impl Damping {
    pub(super) fn describe(&self) -> Rayleigh {
        Rayleigh {
            alpha: self.alpha,
            beta: self.beta,
        }
    }
}

impl Bit {
    pub(super) fn describe(&self) -> BitDescription {
        let mut bit = BitDescription::new(self.diameter, self.friction_factor);
        bit.slip_rate = self.slip_rate;
        bit.inertia = self.inertia;
        bit
    }
}
