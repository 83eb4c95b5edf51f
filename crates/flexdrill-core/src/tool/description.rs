//! Plain numbers in SI that describe the tool, its well, its supports and its loads.
//!
//! The model is built from a [`ToolDescription`], which is checked then. While the model runs only the
//! [`LiveParameters`] can change.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

/// Everything the mechanics needs to know, in SI units and radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ToolDescription {
    /// The bore's centre line, from the kick-off (measured depth 0) on.
    pub well: WellDescription,
    /// Number of rigidly straight links of the flexible pipe.
    pub links: usize,
    /// Beam elements per link (the paper's five).
    pub elements_per_link: usize,
    /// Steel of both pipes.
    pub material: Material,
    /// Section of each element of a link, top to bottom; length `elements_per_link`. All links are alike.
    pub pipe_sections: Vec<Tube>,
    /// Outer diameter of the pipe where it meets the guide, per station of a link (m); length
    /// `elements_per_link + 1`. Decides the inner clearance, Eq. 27.
    pub pipe_contact_diameters: Vec<f64>,
    /// Section of the guide pipe.
    pub guide_section: Tube,
    /// Factor on the guide's bending stiffness (slotted guides are softer), dimensionless.
    pub guide_bending_factor: f64,
    /// Every guide node held in all six directions (the verification cases' fixed outer beam).
    pub guide_fixed: bool,
    /// Diameter of the bore (m), Eq. 31.
    pub hole_diameter: f64,
    /// The joints between links.
    pub joint: JointDescription,
    /// Mass- and stiffness-proportional damping of both pipes, Eq. 7.
    pub rayleigh: Rayleigh,
    /// Gap layer between pipe and guide.
    pub inner: GapDescription,
    /// Gap layer between guide and wall.
    pub outer: GapDescription,
    /// Speed at which the regularised friction reaches 71 % of Coulomb's (m/s).
    pub slip_speed: f64,
    /// The bit and its rock, Eq. 1.
    pub bit: BitDescription,
    /// Acceleration of gravity along world +Z (m/s2), already reduced by the buoyancy factor.
    pub gravity: f64,
    /// Held directions, Table 1 and its variants.
    pub supports: Vec<Support>,
    /// Whether the spin of the first pipe node follows the drive's angle (else it is as `supports` say).
    pub drive_top: bool,
    /// How the weight on bit reaches the tool.
    pub wob_path: WobPath,
    /// Loads over time, in addition to gravity, drive and bit.
    pub loads: Vec<PointLoad>,
    /// Point masses added to nodes.
    pub masses: Vec<PointMass>,
    /// Velocity of every pipe node at the start, in the station frame (m/s), for cases that start moving.
    pub initial_pipe_velocity: [f64; 3],
    /// Displacement of every pipe node at the start, in the station frame (m).
    pub initial_pipe_displacement: [f64; 3],
    /// Spin rate of the pipe at the start (rad/s).
    pub initial_spin_rate: f64,
    /// Whether the run starts from rest under gravity and the initial weight on bit.
    pub static_start: bool,
}

/// The bore's centre line: sections one after another in the vertical X-Z plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WellDescription {
    /// Inclination at measured depth 0 (rad), 0 is straight down.
    pub start_inclination: f64,
    /// Sections from the top down. Their lengths add up to the tool's length.
    pub sections: Vec<WellSection>,
}

/// One section of the well path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum WellSection {
    /// Straight over `length` (m).
    Straight {
        /// Length along the path (m).
        length: f64,
    },
    /// A circular arc that builds `angle` (rad, > 0) at `radius` (m).
    Arc {
        /// Radius of curvature (m).
        radius: f64,
        /// Change of inclination (rad).
        angle: f64,
    },
}

/// An isotropic linear elastic material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus (Pa).
    pub youngs_modulus: f64,
    /// Poisson's ratio (-), 0 to 0.5.
    pub poisson_ratio: f64,
    /// Density (kg/m3).
    pub density: f64,
}

/// A round tube.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Tube {
    /// Outer diameter (m).
    pub outer_diameter: f64,
    /// Inner diameter (m).
    pub inner_diameter: f64,
}

/// Kinds of joint between two links, Eq. 12 and 13.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Cross (Hooke) joint: second row of Eq. 13, with a bend limit.
    Universal,
    /// Constant velocity: both ends spin at the same rate at any bend, with a bend limit.
    BallCage,
    /// Both rows of Eq. 13 as equalities: a hinge with one free axis, for comparison only.
    Revolute,
}

/// The angle theta in the third row of Eq. 13, for [`JointKind::Revolute`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HingeAngle {
    /// 90 degrees: links that are in line at rest.
    #[default]
    Straight,
    /// The angle of the undeflected tool in the well at spin zero: links keep the well's bend, which turns with them.
    AsBuilt,
}

/// All joints of the pipe.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointDescription {
    /// Which rows hold.
    pub kind: JointKind,
    /// Bend angle chi at which the stop begins (rad).
    pub limit: f64,
    /// Rotational stiffness of the stop (N m/rad).
    pub stop_stiffness: f64,
    /// Hunt-Crossley damping of the stop (s/rad).
    pub stop_damping: f64,
    /// Phase of the first joint's cross about the shaft (rad).
    pub cross_phase: f64,
    /// Turn of the cross from one joint to the next (rad).
    pub cross_phase_step: f64,
    /// Theta of Eq. 13 for [`JointKind::Revolute`].
    pub hinge_angle: HingeAngle,
}

impl JointDescription {
    /// Joints of one kind that bend up to `limit` (rad), with the stop of the paper's case and crosses that turn by 90
    /// degrees from joint to joint.
    #[must_use]
    pub const fn new(kind: JointKind, limit: f64) -> Self {
        Self {
            kind,
            limit,
            stop_stiffness: 2e5,
            stop_damping: 0.5,
            cross_phase: 0.0,
            cross_phase_step: FRAC_PI_2,
            hinge_angle: HingeAngle::Straight,
        }
    }
}

/// Rayleigh damping C = alpha M + beta K, Eq. 7.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rayleigh {
    /// Mass-proportional damping (1/s).
    pub alpha: f64,
    /// Stiffness-proportional damping (s).
    pub beta: f64,
}

/// One layer of gap elements, Eq. 20 to 34.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct GapDescription {
    /// Normal stiffness per station (N/m).
    pub stiffness: f64,
    /// Hunt-Crossley damping c of F = k d (1 + c d') (s/m).
    pub damping: f64,
    /// Coulomb coefficient around the circumference, mu_1.
    pub friction_tangential: f64,
    /// Coulomb coefficient along the axis, mu_2.
    pub friction_axial: f64,
}

impl GapDescription {
    /// A layer of penalty stiffness `stiffness` (N/m) with the same Coulomb coefficient `friction` in both directions
    /// and the damping of the paper's case. A stiffness of 0 switches the layer off.
    #[must_use]
    pub const fn new(stiffness: f64, friction: f64) -> Self {
        Self {
            stiffness,
            damping: 0.5,
            friction_tangential: friction,
            friction_axial: friction,
        }
    }
}

/// The bit, Eq. 1: torque = eta D WOB / 3 against its rotation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BitDescription {
    /// Bit diameter (m).
    pub diameter: f64,
    /// Friction factor between bit and rock, eta.
    pub friction_factor: f64,
    /// Bit speed at which the regularised torque reaches 71 % of Eq. 1 (rad/s).
    pub slip_rate: f64,
    /// Rotary inertia about the axis (kg m2), a thin disc's.
    pub inertia: f64,
}

impl BitDescription {
    /// A bit of `diameter` (m) with the friction factor eta of Eq. 1, without inertia.
    #[must_use]
    pub const fn new(diameter: f64, friction_factor: f64) -> Self {
        Self {
            diameter,
            friction_factor,
            slip_rate: 0.1,
            inertia: 0.0,
        }
    }
}

/// Which of the two pipes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// The flexible, rotating, jointed pipe.
    #[default]
    Pipe,
    /// The continuous guide pipe around it.
    Guide,
}

impl Body {
    /// The name in sentences: `pipe`, `guide pipe`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pipe => "pipe",
            Self::Guide => "guide pipe",
        }
    }
}

impl std::fmt::Display for Body {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// A location along the tool.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Location {
    /// The first station, at the kick-off.
    Top,
    /// The last station, at the bit.
    Bottom,
    /// Station index from the top, 0-based.
    Station(usize),
    /// Joint number from the top, 0-based (both of its pipe nodes).
    Joint(usize),
    /// Every station of the tool.
    All,
}

/// One of a node's six degrees of freedom, in storage order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Along the axis.
    U,
    /// Horizontal transverse (the paper's y).
    V,
    /// Transverse in the well plane, towards the low side (z).
    W,
    /// Spin about the axis.
    Psi,
    /// Tilt about y.
    PhiY,
    /// Tilt about z.
    PhiZ,
}

/// Directions held at zero, Table 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// Where.
    pub location: Location,
    /// On which pipe.
    pub body: Body,
    /// Which directions, in the node's own frame.
    pub directions: Vec<Direction>,
}

/// How the weight on bit reaches the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WobPath {
    /// Upward on the guide's last node.
    Guide,
    /// The ends of both pipes are tied axially. A jointed pipe deflects across the hole and carries hardly any of the
    /// load.
    Shared,
}

/// A load over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum LoadHistory {
    /// Constant (N or N m).
    Constant(f64),
    /// `rate` (N/s or N m/s) times the time since `start`, held after `end` (s).
    Ramp {
        /// Slope (N/s or N m/s).
        rate: f64,
        /// When it begins (s).
        start: f64,
        /// When it stays (s).
        end: f64,
    },
    /// amplitude sin(2 pi frequency t + phase).
    Sine {
        /// N or N m.
        amplitude: f64,
        /// Frequency (Hz).
        frequency: f64,
        /// Phase angle at time zero (rad).
        phase: f64,
    },
    /// Linear between (s, N or N m) points, held outside.
    Table(Vec<(f64, f64)>),
}

/// A load on one node, in the node's own frame (link frame for the pipe, station frame for the guide).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointLoad {
    /// Where; `Joint` loads the end of the link above.
    pub location: Location,
    /// On which pipe.
    pub body: Body,
    /// Along which direction (moment for rotations).
    pub direction: Direction,
    /// How much, when.
    pub history: LoadHistory,
}

/// A rigid body added to a node, round but for its unbalance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointMass {
    /// Where.
    pub location: Location,
    /// On which pipe.
    pub body: Body,
    /// Mass (kg).
    pub mass: f64,
    /// Rotary inertia about the axis (kg m2).
    pub axial_inertia: f64,
    /// Rotary inertia about a diameter (kg m2); at least half of that about the axis, which is a thin disc's.
    pub transverse_inertia: f64,
    /// Distance of its centre of mass from the axis (m).
    pub eccentricity: f64,
    /// Angle of its centre of mass at spin zero, from the node's y axis towards its z axis (rad).
    pub eccentricity_phase: f64,
}

/// Parameters that may change while the model runs; all others are fixed when it is built.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LiveParameters {
    /// Inner layer, mu_1 and mu_2.
    pub inner_friction: [f64; 2],
    /// Outer layer, mu_1 and mu_2.
    pub outer_friction: [f64; 2],
    /// eta of Eq. 1.
    pub bit_friction_factor: f64,
}
