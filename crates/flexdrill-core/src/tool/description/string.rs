//! The drill string above the tool with its drive and hoist, as described. Its laws are in `elements/string`.

use serde::{Deserialize, Serialize};

use super::ToolDescription;

/// The string as built.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StringDescription {
    /// From the top drive down; at least one.
    pub pieces: Vec<Piece>,
    /// What turns it.
    pub drive: TopDrive,
    /// What carries it: then axial waves travel, and the guide's first node is free along the hole.
    pub hoist: Option<Hoist>,
    /// Weight of the string in mud along the hole (N), for the hook load.
    pub weight: f64,
}

impl ToolDescription {
    /// Whether a hoist carries the tool, so that its top moves along the hole.
    pub(crate) fn hangs_on_a_hoist(&self) -> bool {
        self.string.as_ref().is_some_and(|string| string.hoist.is_some())
    }
}

/// A uniform piece of the string.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// Length (m).
    pub length: f64,
    /// Torsional waves.
    pub torsion: Wave,
    /// Axial waves.
    pub axial: Wave,
    /// Friction on the wall at the piece's lower end; not at the last piece, where the tool begins.
    pub friction: Option<WallFriction>,
}

/// Waves of one kind in a piece.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Wave {
    /// Impedance: torque over angular speed (N m s) or force over speed (N s/m).
    pub impedance: f64,
    /// Time of travel (s).
    pub delay: f64,
    /// Loss at the piece's lower end: torque over the difference of angular speeds (N m s), or force over that of speeds (N
    /// s/m), against a body that follows within two seconds. None at the last piece, where the tool begins.
    pub drag: f64,
}

/// One point of the string that rubs on the wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WallFriction {
    /// Sliding friction mu N (N).
    pub sliding: f64,
    /// Friction that sticking can reach over that of sliding, at least 1.
    pub static_ratio: f64,
    /// Sliding speed (m/s) up to which friction stays at the static level.
    pub static_speed: f64,
    /// Radius at which the string rubs (m).
    pub radius: f64,
}

/// The drive, as built and tuned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum TopDrive {
    /// Keeps the speed asked for under any torque.
    Rigid,
    /// An inertia with a speed controller.
    Controlled(SpeedController),
}

/// A speed controller and what it turns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedController {
    /// Inertia of motor and gear, seen at the string (kg m2).
    pub inertia: f64,
    /// Torque per difference of speed, P (N m s).
    pub proportional: f64,
    /// Torque per difference of angle, I (N m).
    pub integral: f64,
    /// Largest torque, M_max (N m).
    pub torque_limit: f64,
}

/// Block, lines and auto-driller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hoist {
    /// Stiffness of block, lines and derrick (N/m).
    pub stiffness: f64,
    /// Response time t of the auto-driller (s).
    pub response_time: f64,
    /// Fastest lowering and raising of the block (m/s).
    pub fastest: f64,
    /// Speed V_touch at which a bit without weight is lowered (m/s); at most `fastest`.
    pub touch_down: f64,
    /// Distance c by which the bit is lifted off bottom where no weight is asked for, at least (m).
    pub clearance: f64,
    /// What the block is lowered by.
    pub feed: Feed,
}

/// What the block is lowered by.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Feed {
    /// The auto-driller, towards the weight on bit asked for.
    #[default]
    Weight,
    /// The rate of penetration asked for.
    Rate,
}

/// A torsional mode of drive, string and tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorsionalMode {
    /// Rate of decay (1/s): the amplitude falls to e^-1 within 1 / decay.
    pub decay: f64,
    /// Angular frequency of the decaying vibration (rad/s).
    pub frequency: f64,
}

/// What hangs below the string, in torsion.
#[derive(Debug, Clone, PartialEq)]
pub struct HangingTool {
    /// Pieces of the tool's pipe from the top down.
    pub pieces: Vec<Wave>,
    /// Inertia at the lower end (kg m2): the bit's.
    pub inertia: f64,
}
