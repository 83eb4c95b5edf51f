//! Proposes the mapping of a log: which column is which quantity, in which unit, and the time's format, with the evidence.
//!
//! A wrong column that is believed is worse than none. A column is proposed only where the log has a word for it, its name
//! or its unit, and its numbers do not contradict; numbers alone, without a unit, are never enough, as pump strokes have
//! the size of rotary speeds. A column that fits two quantities equally is left out and named.

mod choose;
mod names;
mod numbers;
mod sheet;
mod show;
mod time;
mod vocabulary;

use std::path::Path;

use crate::read::{LARGEST, content_of};
use crate::{Decimal, FieldLogError};
pub use show::is_proposed;

use choose::Candidate;
use flexdrill_core::inputs::{Dimension, Unit};
use flexdrill_text::Course;
use sheet::Sheet;
use time::TimeProposal;

flexdrill_base::listed! {
    /// What a column may be, besides the time.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Quantity: 1 {
        /// Rotary speed of the drive.
        RotarySpeed: "rotary_speed";
        /// Weight on bit, measured or computed at the surface.
        WeightOnBit: "weight_on_bit";
        /// Load on the hook.
        HookLoad: "hook_load";
        /// Torque of the drive.
        Torque: "torque";
        /// Rate of penetration.
        RateOfPenetration: "rate_of_penetration";
        /// Standpipe pressure.
        StandpipePressure: "standpipe_pressure";
        /// Measured depth of the bit.
        BitDepth: "bit_depth";
        /// Measured depth of the hole.
        HoleDepth: "hole_depth";
    }
}

impl Quantity {
    /// The name in a mapping.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }

    /// What it measures.
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::RotarySpeed => Dimension::RotarySpeed,
            Self::WeightOnBit | Self::HookLoad => Dimension::Force,
            Self::Torque => Dimension::Torque,
            Self::RateOfPenetration => Dimension::Speed,
            Self::StandpipePressure => Dimension::Pressure,
            Self::BitDepth | Self::HoleDepth => Dimension::Length,
        }
    }

    /// Smallest and largest usual size of values that are not at rest (SI), for rigs from the smallest to the largest.
    pub(crate) fn usual(self) -> [f64; 2] {
        let (unit, range) = match self {
            // A drive turns a string with 250 r/min at most; a small rig's tool with a few.
            Self::RotarySpeed => (Unit::TurnPerMinute, [1.0, 400.0]),
            // Small bits need some hundred newtons; the largest bits take 600 kN.
            Self::WeightOnBit => (Unit::Kilonewton, [0.2, 800.0]),
            // The largest hooks carry 12 MN, an empty one of a small rig some kilonewtons.
            Self::HookLoad => (Unit::Kilonewton, [3.0, 12_000.0]),
            // The strongest top drives hold 150 kN m.
            Self::Torque => (Unit::KilonewtonMetre, [0.02, 150.0]),
            // Surface holes in soft rock are drilled with 300 m/h.
            Self::RateOfPenetration => (Unit::MetrePerHour, [0.1, 400.0]),
            // The strongest pumps reach 70 MPa.
            Self::StandpipePressure => (Unit::Megapascal, [0.1, 80.0]),
            // The longest wells have 15 km.
            Self::BitDepth | Self::HoleDepth => (Unit::Metre, [1.0, 15_000.0]),
        };
        range.map(|value| unit.to_si(value))
    }
}

/// How sure a proposal is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sure {
    /// Name, unit and numbers agree.
    Sure,
    /// Name and unit agree; the numbers do not contradict.
    Likely,
    /// The unit and the numbers alone: the name says nothing.
    Weak,
}

impl Sure {
    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Sure => "sure",
            Self::Likely => "likely",
            Self::Weak => "weak: its name says nothing",
        }
    }
}

/// A proposed column.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// Its name in the header.
    pub column: String,
    /// What it is.
    pub quantity: Quantity,
    /// Its unit.
    pub unit: Unit,
    /// Its first value, as read.
    pub first_text: String,
    /// Its first number, in the unit of the log.
    pub first: f64,
    /// Why.
    pub evidence: Vec<String>,
    /// How sure.
    pub sure: Sure,
}

/// A column that is not proposed.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// Its name in the header.
    pub column: String,
    /// Its first text.
    pub first_text: String,
    /// What it may be; empty where nothing suggests anything.
    pub may_be: Vec<Quantity>,
    /// Why it is left out.
    pub why: String,
}

/// The proposed mapping of a log. It is complete when it has the time, the rotary speed and the weight on bit.
pub struct Guess {
    file: String,
    separator: char,
    decimal: Decimal,
    header_row: Option<u64>,
    missing: Vec<f64>,
    rows: usize,
    notes: Vec<String>,
    time: Option<TimeProposal>,
    proposals: Vec<Proposal>,
    left_out: Vec<LeftOut>,
    codes: Option<Codes>,
}

/// A column of activities, whose codes a person may know.
struct Codes {
    column: String,
    /// A line per code: its rows and the usual values in them.
    lines: Vec<String>,
}

/// Proposes the mapping of a log.
///
/// # Errors
/// When the file cannot be read, is no text, or has no names of columns.
pub fn guess(path: impl AsRef<Path>) -> Result<Guess, FieldLogError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let content = content_of(path, &name)?;
    guess_bytes(name, &content)
}

/// As [`guess`], of the bytes of a log; errors name it `name`.
///
/// # Errors
/// As [`guess`].
pub fn guess_bytes(name: String, content: &[u8]) -> Result<Guess, FieldLogError> {
    let sheet = Sheet::of(&name, content, LARGEST)?;
    // The time comes first: whether a depth grows or a rate fits it is a question of the rows' order and steps.
    let times = time::find(&sheet);
    let choice = choose::choose(&sheet, &times);
    let column = |index: usize| sheet.columns.get(index);
    // A person compares the proposal with the rig's display by its first value and its course.
    let proposal = |candidate: Candidate| {
        let column = column(candidate.index)?;
        let course = Course::of(column.numbers())?;
        let mut evidence = candidate.evidence;
        evidence.push(format!("in {}: {}", candidate.unit, course.words()));
        Some(Proposal {
            column: column.name.clone(),
            quantity: candidate.quantity,
            unit: candidate.unit,
            first_text: column.first.clone(),
            first: course.first,
            evidence,
            sure: candidate.sure,
        })
    };
    let codes = choose::codes(&sheet, &choice.proposals);
    // Every column that is not proposed is named once, in the order of the log: what is not said is believed to be read.
    let mut left_out: Vec<(usize, Vec<Quantity>, String)> = choice.left_out;
    left_out.extend(times.left_out.into_iter().map(|(index, why)| (index, Vec::new(), why)));
    left_out.sort_by_key(|(index, ..)| *index);
    left_out.dedup_by_key(|(index, ..)| *index);
    let left_out = left_out.into_iter().filter_map(|(index, may_be, why)| {
        let column = column(index)?;
        Some(LeftOut {
            column: column.name.clone(),
            first_text: column.first.clone(),
            may_be,
            why,
        })
    });
    Ok(Guess {
        left_out: left_out.collect(),
        proposals: choice.proposals.into_iter().filter_map(proposal).collect(),
        file: name,
        separator: sheet.separator,
        decimal: sheet.decimal,
        header_row: sheet.header_row,
        missing: sheet.missing.clone(),
        rows: sheet.rows.len(),
        notes: sheet.notes.clone(),
        time: times.proposal,
        codes,
    })
}

impl Guess {
    /// The proposed columns besides the time.
    pub fn proposals(&self) -> &[Proposal] {
        &self.proposals
    }

    /// The columns that are left out.
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// The column of time, or date and clock with a blank between, and the name of its format; `None` where it is not clear.
    pub fn time(&self) -> Option<(String, String)> {
        let time = self.time.as_ref()?;
        Some((time.column.name(), time.column.format().name().to_owned()))
    }

    /// What a mapping needs and the guess does not have, by the keys of the mapping; empty where the guess can be run.
    pub fn lacks(&self) -> Vec<&'static str> {
        let has = |quantity| self.proposals.iter().any(|proposal| proposal.quantity == quantity);
        let needed = [
            ("time", self.time.is_some()),
            (Quantity::RotarySpeed.name(), has(Quantity::RotarySpeed)),
            (Quantity::WeightOnBit.name(), has(Quantity::WeightOnBit)),
        ];
        needed
            .into_iter()
            .filter(|(_, is_there)| !is_there)
            .map(|(name, _)| name)
            .collect()
    }
}
