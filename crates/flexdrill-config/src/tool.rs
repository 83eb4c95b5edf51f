//! `tool`: the flexible pipe, its joints, the guide pipe and the bit.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::json_schema;
use super::pipe::{Guide, Pipe};
use super::section::section;
use flexdrill_core::tool::{BitDescription, HingeAngle, JointDescription, JointKind, Material as Steel, Rayleigh};
use flexdrill_core::units::deg_to_rad;

const LINKS: Bound = Bound::within(1.0, 500.0);
const ELEMENTS: Bound = Bound::within(1.0, MOST_ELEMENTS as f64);
const MOST_ELEMENTS: usize = 50;

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
    #[derive(Copy)]
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
    }
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
    }
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
        c.below("joint", |c| self.joint.check_numbers(c));
        c.below("damping", |c| self.damping.check_numbers(c));
        c.below("bit", |c| self.bit.check_numbers(c));
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
    pub(super) fn describe(&self) -> JointDescription {
        let mut joint = JointDescription::new(self.kind, deg_to_rad(self.limit_deg));
        joint.stop_stiffness = self.stop_stiffness;
        joint.stop_damping = self.stop_damping;
        joint.cross_phase = deg_to_rad(self.cross_phase_deg);
        joint.cross_phase_step = deg_to_rad(self.cross_phase_step_deg);
        joint.hinge_angle = self.hinge_angle;
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
