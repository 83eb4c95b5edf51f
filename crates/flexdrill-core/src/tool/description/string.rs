//! The drill string above the tool with its drive and hoist, as described, with their checks. Their laws are in `effects/string`.

use serde::{Deserialize, Serialize};

use super::{Direction, Location, ToolDescription, WeightPlace};
use crate::validation::{Bound, ValidationError, count, require};

/// Most pieces: one for each 50 m of the longest wells, over thirty times.
const MOST_PIECES: usize = 10_000;
/// Most rows that the waves of all pieces need while they travel, of 72 bytes each: 150 MB. 15 km of pipe need 75,000 in
/// steps of 0.5 ms.
const MOST_ROWS: f64 = 2e6;
/// Rows of waves per step: finer parts of a step do not get a row of their own.
pub(crate) const ROWS_PER_STEP: f64 = 8.0;

type Checked = Result<(), ValidationError>;

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

impl ToolDescription {
    /// Whether a hoist carries the tool, so that its top moves along the hole.
    pub(crate) fn moves_at_top(&self) -> bool {
        self.string.as_ref().is_some_and(|string| string.hoist.is_some())
    }

    /// Whether the drive prescribes the spin of the pipe's first node. Below a string that node turns as the string lets it.
    pub(crate) fn prescribes_spin(&self) -> bool {
        self.drive_top && self.string.is_none()
    }

    /// Checks the step (s) against the waves above the tool.
    ///
    /// # Errors
    /// As [`StringDescription::validate_step`].
    pub(crate) fn check_step(&self, time_step: f64) -> Checked {
        self.string
            .as_ref()
            .map_or(Ok(()), |string| string.validate_step(time_step))
    }

    /// Checks what is above the tool.
    pub(in crate::tool) fn check_upper_end(&self) -> Checked {
        let hoist = self.string.as_ref().and_then(|string| string.hoist);
        // Without a string nothing above is left to check.
        let Some(string) = &self.string else {
            return Ok(());
        };
        string.validate()?;
        require(
            self.drive_top,
            "string",
            "the string turns the first link; set drive_top to true or leave the string out",
        )?;
        // Only the top matters: the hoist carries it, and a support would carry it as well.
        let holds_top = self.supports.iter().any(|support| {
            let at_top = matches!(support.location, Location::Top | Location::All | Location::Station(0));
            at_top && support.directions.contains(&Direction::U)
        });
        require(
            hoist.is_none() || (!holds_top && !self.guide_fixed),
            "string.hoist",
            "the hoist carries the tops of both pipes along the hole; let no support hold u there, and set guide_fixed to false",
        )?;
        require(
            hoist.is_none() || self.weight_place == WeightPlace::Bit,
            "weight_place",
            "the hoist holds the weight at the surface, and the rock gives that at the bit; set weight_place to bit",
        )
    }
}

impl StringDescription {
    fn validate(&self) -> Checked {
        count("string.pieces", self.pieces.len(), 1, MOST_PIECES)?;
        for (index, piece) in self.pieces.iter().enumerate() {
            piece.validate(&format!("string.pieces[{index}]"))?;
        }
        if let TopDrive::Controlled(controller) = &self.drive {
            controller.validate()?;
        }
        if let Some(hoist) = &self.hoist {
            hoist.validate()?;
        }
        Bound::Finite.check("string.weight", self.weight, "N")
    }

    /// Checks the times of travel against the step (s): waves are read from the past only, and are kept while they travel.
    ///
    /// # Errors
    /// When a wave travels through a piece in less than a step, or so many steps that they need too much memory.
    fn validate_step(&self, time_step: f64) -> Checked {
        let mut longest = 0.0;
        for (index, piece) in self.pieces.iter().enumerate() {
            let axial = self.hoist.map(|_| ("axial", piece.axial.delay));
            for (kind, delay) in [("torsion", piece.torsion.delay)].into_iter().chain(axial) {
                let field = format!("string.pieces[{index}].{kind}.delay");
                Bound::Within(time_step, f64::MAX).check(&field, delay, "s")?;
            }
            longest += piece.torsion.delay.max(piece.axial.delay);
        }
        let shortest = longest * ROWS_PER_STEP / MOST_ROWS;
        if time_step >= shortest {
            return Ok(());
        }
        Err(ValidationError::Value {
            field: "time_step".to_owned(),
            value: time_step,
            unit: "s",
            bound: format!("at least {shortest:.2e} s: the waves in string.pieces are kept while they travel"),
        })
    }
}

impl Piece {
    fn validate(&self, under: &str) -> Checked {
        Bound::Positive.check(&format!("{under}.length"), self.length, "m")?;
        for (kind, wave, unit) in [("torsion", self.torsion, "N m s"), ("axial", self.axial, "N s/m")] {
            let field = |name: &str| format!("{under}.{kind}.{name}");
            Bound::Positive.check(&field("impedance"), wave.impedance, unit)?;
            Bound::Positive.check(&field("delay"), wave.delay, "s")?;
            Bound::NotNegative.check(&field("drag"), wave.drag, unit)?;
        }
        self.friction
            .map_or(Ok(()), |friction| friction.validate(&format!("{under}.friction")))
    }
}

impl WallFriction {
    fn validate(&self, under: &str) -> Checked {
        let field = |name: &str| format!("{under}.{name}");
        Bound::NotNegative.check(&field("sliding"), self.sliding, "N")?;
        Bound::Within(1.0, f64::MAX).check(&field("static_ratio"), self.static_ratio, "")?;
        Bound::NotNegative.check(&field("static_speed"), self.static_speed, "m/s")?;
        Bound::Positive.check(&field("radius"), self.radius, "m")
    }
}

impl SpeedController {
    fn validate(&self) -> Checked {
        Bound::Positive.check("string.drive.inertia", self.inertia, "kg m2")?;
        Bound::NotNegative.check("string.drive.proportional", self.proportional, "N m s")?;
        Bound::NotNegative.check("string.drive.integral", self.integral, "N m")?;
        Bound::Positive.check("string.drive.torque_limit", self.torque_limit, "N m")
    }
}

impl Hoist {
    fn validate(&self) -> Checked {
        Bound::Positive.check("string.hoist.stiffness", self.stiffness, "N/m")?;
        Bound::Positive.check("string.hoist.response_time", self.response_time, "s")?;
        Bound::Positive.check("string.hoist.fastest", self.fastest, "m/s")?;
        Bound::Above(0.0, self.fastest).check("string.hoist.touch_down", self.touch_down, "m/s")?;
        Bound::NotNegative.check("string.hoist.clearance", self.clearance, "m")
    }
}
