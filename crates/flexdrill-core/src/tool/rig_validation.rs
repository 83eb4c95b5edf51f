//! What the string above the tool, its drive and hoist must satisfy.

use super::description::{Direction, Location, ToolDescription, WeightPlace};
use super::{Hoist, Piece, SpeedController, StringDescription, TopDrive, WallFriction};
use crate::validation::{Bound, ValidationError, count, require};

/// Most pieces: one for each 50 m of the longest wells, over thirty times.
const MOST_PIECES: usize = 10_000;
/// Most rows that the waves of all pieces need while they travel, of 72 bytes each: 150 MB. 15 km of pipe need 75,000 in
/// steps of 0.5 ms.
const MOST_ROWS: f64 = 2e6;
/// Rows of waves per step: finer parts of a step do not get a row of their own.
pub(crate) const ROWS_PER_STEP: f64 = 8.0;

type Checked = Result<(), ValidationError>;

impl ToolDescription {
    pub(super) fn validate_rig(&self) -> Checked {
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
    pub(crate) fn validate_step(&self, time_step: f64) -> Checked {
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
