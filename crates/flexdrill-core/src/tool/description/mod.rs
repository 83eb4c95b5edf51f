//! Plain numbers in SI that describe the tool, its well, its supports and its loads.
//!
//! The model is built from a [`ToolDescription`], which is checked then. While the model runs only the
//! [`LiveParameters`] can change.

mod bit;
mod contact;
mod joint;
mod string;
mod whole;

pub use flexdrill_base::{Body, Location};
use serde::{Deserialize, Serialize};

pub use bit::*;
pub use contact::*;
pub use joint::*;
pub use string::*;
pub use whole::*;

/// The bore's centre line: sections one after another in the vertical X-Z plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WellDescription {
    /// Inclination at measured depth 0 (rad), 0 is straight down.
    pub start_inclination: f64,
    /// Sections from the top down. Their lengths add up to the tool's length.
    pub sections: Vec<WellSection>,
}

/// A part of the hole with friction of its own: the formation, the casing and the cuttings differ from one to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum HoleInterval {
    /// Straight sections before the first arc; all of a hole without arcs. Hole as drilled where it says so.
    BeforeArc,
    /// Arcs, and hole as drilled where it says so.
    Arc,
    /// Straight sections after the first arc, those between two arcs too. Hole as drilled where it says so.
    AfterArc,
}

impl HoleInterval {
    /// From the top down.
    pub const ALL: [Self; 3] = [Self::BeforeArc, Self::Arc, Self::AfterArc];
}

/// One section of the well path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Hole as drilled: arcs of equal length that follow each other, each with its curvature.
    Drilled {
        /// Length of each arc (m).
        spacing: f64,
        /// Change of inclination per metre of each arc (1/m), below 0 where the hole drops.
        build: Vec<f64>,
        /// The interval of the hole that it belongs to: as drilled it is neither straight nor an arc.
        interval: HoleInterval,
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

/// Rayleigh damping C = alpha M + beta K, Eq. 7.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rayleigh {
    /// Mass-proportional damping (1/s).
    pub alpha: f64,
    /// Stiffness-proportional damping (s).
    pub beta: f64,
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

/// Where the weight on bit of the inputs is measured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WeightPlace {
    /// At the bit: it acts as it is.
    #[default]
    Bit,
    /// At the kick-off, as the axial force on the guide there. The weight at the bit follows so that the guide's
    /// reaction becomes the input: friction and weight of the guide lie between the two.
    Kickoff,
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
