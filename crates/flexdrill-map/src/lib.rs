//! The map of two quantities: what every alarm and every figure does over them.
//!
//! [`Map`] is the content of `map.json`. [`Map::load`] reads it, bounds it and names what is wrong.

mod check;
mod error;
mod words;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use flexdrill_alarms::Priority;
use serde::{Deserialize, Serialize};

pub use error::MapError;

/// The format that this build writes and reads. Format 1 drew cells clear that no run had said anything of.
pub const FORMAT: u32 = 2;
/// Probability from which on what was not run is inferred: the level of all intervals here. Below, it is not known.
pub const SURE: f64 = 0.95;
/// Largest file that is read (bytes): a map of [`MOST_CELLS`] cells with every figure has a third of it.
pub const MOST_BYTES: u64 = 64 << 20;
/// Most values of an axis.
pub const MOST_VALUES: usize = 200;
/// Most cells of a map.
pub const MOST_CELLS: usize = 10_000;
/// Dotted key of the configuration that a rotary speed is set by (r/min).
pub const ROTARY_SPEED: &str = "inputs.rotary_speed.initial_rpm";
/// Dotted key of the configuration that a weight on bit is set by (kN).
pub const WEIGHT_ON_BIT: &str = "inputs.weight_on_bit.initial_kn";

/// A map over two quantities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// [`FORMAT`].
    pub format: u32,
    /// The program that computed it, with its version.
    pub program: String,
    /// Title of the configuration's run.
    pub title: String,
    /// Hash of the whole configuration (SHA-256, hex).
    pub configuration: String,
    /// Hash of what determines the tool's motion and its alarms (`Config::motion_hash`): a map belongs to every
    /// configuration with this hash.
    pub motion: String,
    /// First axis.
    pub x: Axis,
    /// Second axis.
    pub y: Axis,
    /// Model time that each member was judged over (s).
    pub horizon: f64,
    /// Members per cell and start, at most; [`OfStart::members`] has how many ran.
    pub members: u32,
    /// Whether all of these ran, also where the first ones decided every alarm.
    pub run_all: bool,
    /// Whether a member ended with its first alarm of [`Map::priority`] or above: only members without any have figures.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub first_alarm: bool,
    /// Whether members are plausible tools, drawn from `uncertainty` of the configuration; otherwise they are the tool of the
    /// configuration.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub plausible: bool,
    /// The sample of a calibration that these tools are drawn from; none where they are drawn from `uncertainty` alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub posterior: Option<Sample>,
    /// Seed of the members' disturbances.
    pub seed: u64,
    /// Priority from which on an alarm counts for [`OfStart::chance`] and [`Cell::verdict`].
    pub priority: Priority,
    /// Chance of such an alarm above which it must be expected.
    pub limit: f64,
    /// Ways to the cell's values, in the order of [`Cell::starts`].
    pub starts: Vec<Start>,
    /// Runs that were made, of the cells times the starts.
    pub runs: u32,
    /// Runs among these that have their first member alone, since no neighbour is of another class ([`OfStart::members`] is 1).
    #[serde(default)]
    pub first_looks: u32,
    /// Model time of all members that count and of the states that they began from (s); 0 where unknown.
    #[serde(default)]
    pub model_time: f64,
    /// Row by row of y, x within a row.
    pub cells: Vec<Cell>,
}

/// The sample of a calibration that plausible tools are drawn from, with its provenance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// SHA-256 of its file (hex).
    pub sha256: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// File name of the log that it was fitted to.
    pub log: String,
    /// SHA-256 of the log (hex).
    pub log_sha256: String,
    /// First and last row of the log.
    pub rows: [u64; 2],
    /// Its members.
    pub members: u32,
    /// Number of members alike that their weights amount to.
    pub effective: f64,
    /// Keys of the configuration that it has; the others are drawn from `uncertainty`, given these.
    pub keys: Vec<String>,
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Dotted key of the configuration.
    pub key: String,
    /// What it is, for people.
    pub name: String,
    /// Unit of the values; empty if dimensionless.
    pub unit: String,
    /// Rising, at least two.
    pub values: Vec<f64>,
}

flexdrill_base::listed! {
    /// How a run comes to its values.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Start: 1 {
        /// The tool stands, then speed and weight rise to the values.
        Rest: "rest";
        /// The tool runs fast under the weight, then the speed falls to the value.
        Running: "running";
    }
}

impl Start {
    /// Name in files.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }
}

/// One pair of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Value on the first axis.
    pub x: f64,
    /// Value on the second axis.
    pub y: f64,
    /// What all starts together say.
    pub verdict: Verdict,
    /// By [`Map::starts`].
    pub starts: Vec<OfStart>,
}

flexdrill_base::listed! {
    /// What a cell is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Verdict: 1 {
        /// From no start must an alarm be expected.
        Clear: "clear";
        /// From every start an alarm must be expected.
        Alarm: "alarm";
        /// From one start an alarm must be expected, from another not.
        DependsOnStart: "depends_on_start";
        /// A run of it failed, so that it is not known to be clear: it is not safe.
        Unknown: "unknown";
        /// It was not run from some start, and the runs around it do not say with [`SURE`] what it is: it is not safe.
        NotKnown: "not_known";
    }
}

impl Verdict {
    /// Name in files.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }

    /// What the starts of a cell say together. It is clear only where all starts are, with [`SURE`] together.
    pub fn of(starts: &[OfStart]) -> Self {
        let expected = starts.iter().filter(|start| start.expected).count();
        let unknown = starts.iter().any(|start| !start.expected && start.is_unknown());
        let not_known = starts.iter().any(|start| start.state == Origin::NotKnown);
        // Rounding must not turn what each start alone is sure of.
        let sure = starts.iter().map(|start| start.confidence).product::<f64>() >= SURE - 1e-12;
        match expected {
            _ if unknown => Self::Unknown,
            _ if not_known => Self::NotKnown,
            0 if sure => Self::Clear,
            0 => Self::NotKnown,
            all if all == starts.len() => Self::Alarm,
            _ => Self::DependsOnStart,
        }
    }
}

flexdrill_base::listed! {
    /// Where a cell's figures come from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Origin: 1 {
        /// It was run.
        Known: "known";
        /// It was not run; whether an alarm must be expected is inferred from the cells that were, with [`SURE`].
        Inferred: "inferred";
        /// It was run, and no member ended: what is there is unknown.
        Unknown: "unknown";
        /// It was not run, and nothing is inferred with [`SURE`].
        NotKnown: "not_known";
    }
}

impl Origin {
    /// Name in files.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }

    /// Whether a run was made.
    pub const fn was_run(self) -> bool {
        matches!(self, Self::Known | Self::Unknown)
    }
}

/// A cell from one start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OfStart {
    /// Whether it was run.
    pub state: Origin,
    /// Whether an alarm must be expected: the chance of any is above [`Map::limit`], or is inferred to be. It says nothing
    /// where the state is unknown or not known.
    pub expected: bool,
    /// Probability that a run would say the same: 1 where a member ended, 0 where none did, at least [`SURE`] where inferred;
    /// where not known, that of the class that is most likely.
    pub confidence: f64,
    /// Chance of any alarm that counts ([`Map::priority`]): members that saw one, of those that ended; nothing where not run.
    pub chance: Option<f64>,
    /// The 95 % interval of the chance (Wilson), by the members that ended; 0 to 1 where not known.
    pub interval: [f64; 2],
    /// Identifier of the alarm that most of these members saw; empty where none was seen.
    pub alarm: String,
    /// Members that were run: at most [`Map::members`], fewer where they decided every alarm.
    pub members: u32,
    /// Members of these that failed: they are in no chance.
    pub failed: u32,
    /// Why the first of them failed; empty where none did.
    pub failure: String,
    /// Alarms that a member saw, by identifier, from the lowest priority.
    pub alarms: Vec<AlarmCount>,
    /// Figures over the members; empty where not run.
    pub figures: Vec<Figure>,
}

impl OfStart {
    /// Whether a member failed, so that what would have come is unknown.
    pub fn is_unknown(&self) -> bool {
        self.state == Origin::Unknown || self.failed > 0
    }

    /// What was not run, and is not known: `confidence` is that of the most likely class.
    pub fn not_known(confidence: f64) -> Self {
        Self {
            state: Origin::NotKnown,
            ..Self::inferred(false, confidence)
        }
    }

    /// What was not run, and is inferred.
    pub fn inferred(expected: bool, confidence: f64) -> Self {
        Self {
            state: Origin::Inferred,
            expected,
            confidence,
            chance: None,
            interval: [0.0, 1.0],
            alarm: String::new(),
            members: 0,
            failed: 0,
            failure: String::new(),
            alarms: Vec::new(),
            figures: Vec::new(),
        }
    }
}

/// How often one alarm was seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlarmCount {
    /// Identifier of the alarm.
    pub alarm: String,
    /// Of this priority or a higher one.
    pub priority: Priority,
    /// Members that saw it.
    pub seen: u32,
    /// Members that ended.
    pub of: u32,
    /// 95 % interval of the chance (Wilson).
    pub interval: [f64; 2],
    /// Median time to the first of it over the members that saw it (s).
    pub first: Option<f64>,
}

/// A figure over the members.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Name, as in messages.
    pub name: String,
    /// Unit; empty if dimensionless.
    pub unit: String,
    /// Quantiles at 5, 50 and 95 %; nothing where no member has it.
    pub quantiles: Option<[f64; 3]>,
}

impl Map {
    /// Reads a map.
    ///
    /// # Errors
    /// When the file cannot be read, is too large, is of another format, is no map, or contradicts itself.
    pub fn load(path: &Path) -> Result<Self, MapError> {
        let name = path.display().to_string();
        let unread = |reason| MapError::Read {
            file: name.clone(),
            reason,
        };
        let mut bytes = Vec::new();
        let file = File::open(path).map_err(unread)?;
        // One byte more than allowed shows that there are more.
        file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(unread)?;
        Self::from_bytes(&name, &bytes)
    }

    /// Reads a map from its bytes; `name` stands for the file in errors.
    ///
    /// # Errors
    /// As [`Map::load`].
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, MapError> {
        if bytes.len() as u64 > MOST_BYTES {
            return Err(MapError::Large { file: name.to_owned() });
        }
        /// The one field that says how to read the others.
        #[derive(Deserialize)]
        struct Versioned {
            format: u32,
        }
        let no_map = |error: serde_json::Error| MapError::NoMap {
            file: name.to_owned(),
            reason: error.to_string(),
        };
        let Versioned { format } = serde_json::from_slice(bytes).map_err(no_map)?;
        if format != FORMAT {
            return Err(MapError::Format {
                file: name.to_owned(),
                found: format,
            });
        }
        let map: Self = serde_json::from_slice(bytes).map_err(no_map)?;
        map.check(name)?;
        Ok(map)
    }

    /// The map as the content of its file.
    ///
    /// # Errors
    /// When a number is not finite, which a checked map does not have.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string(self)? + "\n")
    }

    /// The cell of a column and a row.
    pub fn cell(&self, column: usize, row: usize) -> Option<&Cell> {
        let columns = self.x.values.len();
        (column < columns)
            .then(|| self.cells.get(row * columns + column))
            .flatten()
    }

    /// The cell whose values are nearest to `x` and `y`; nothing outside the axes by more than half a cell.
    pub fn nearest(&self, x: f64, y: f64) -> Option<&Cell> {
        self.cell(self.x.nearest(x)?, self.y.nearest(y)?)
    }
}

impl Axis {
    /// Number of the value that is nearest to `value`; nothing outside the axis by more than half a cell.
    pub fn nearest(&self, value: f64) -> Option<usize> {
        let [from, to] = self.range()?;
        if !(from..=to).contains(&value) {
            return None;
        }
        let distance = |at: &f64| (at - value).abs();
        let numbered = self.values.iter().enumerate();
        numbered
            .min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)))
            .map(|(number, _)| number)
    }

    /// The ends of the axis, half a cell beyond its values.
    pub fn range(&self) -> Option<[f64; 2]> {
        let [first, second, ..] = self.values[..] else {
            return None;
        };
        let [.., before, last] = self.values[..] else {
            return None;
        };
        Some([first - 0.5 * (second - first), last + 0.5 * (last - before)])
    }
}
