//! A sweep's plan (`sweep.json`): everything that determines its points.

use flexdrill_alarms::Priority;
use flexdrill_config::{Config, ConfigError};
use flexdrill_text::hex;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::error::SweepError;
use crate::map::Start;

/// The format of plans and points that this build writes and reads. Points of format 1 do not count the members that saw
/// any alarm.
pub const FORMAT: u32 = 3;
/// Most points of a plan: 256 folders of them hold fewer than 800 files each.
pub const MOST_POINTS: usize = 200_000;
/// Most keys that a plan changes.
pub const MOST_KEYS: usize = 32;
/// Most members per point.
pub const MOST_MEMBERS: u32 = 200;
/// Longest horizon (s), and the shortest: the delays of the alarms and the windows of the analysis have to pass.
pub const HORIZONS: [f64; 2] = [10.0, 600.0];
/// Most model time of a whole plan (s): ten years of one core at ten times real time.
pub const MOST_MODEL_TIME: f64 = 3e9;

/// What is computed, and with what.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// [`FORMAT`].
    pub format: u32,
    /// How the runs are made.
    pub runs: Runs,
    /// Dotted keys of the configuration that change.
    pub keys: Vec<String>,
    /// Values of these keys, a row each.
    pub rows: Vec<Vec<Value>>,
    /// Ways to the values.
    pub starts: Vec<Start>,
    /// Seeds of the disturbances: a point per seed.
    pub seeds: Vec<u64>,
    /// The map that the rows are the cells of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<Grid>,
}

/// What all points of a plan share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Runs {
    /// The program that computes, with its version.
    pub program: String,
    /// Its arithmetic, on which the last bits depend: `fused` (AVX2 or AVX-512) or `portable`.
    pub arithmetic: String,
    /// The configuration that the rows change (YAML, complete).
    pub configuration: String,
    /// Its hash.
    pub hash: String,
    /// Model time that each member is judged over (s).
    pub horizon: f64,
    /// Members per point, at most.
    pub members: u32,
    /// Whether all of these run, also where the first ones decide every alarm.
    pub run_all: bool,
    /// How members of a fast map end; none where they run over the horizon.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fast: Option<Fast>,
    /// Whether members are plausible tools, drawn from `uncertainty` of the configuration.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub plausible: bool,
    /// The state that [`Start::Running`] comes from.
    pub running: Running,
    /// Alarms that a point counts, by identifier.
    pub alarms: Vec<String>,
    /// Figures of a point: name and unit.
    pub figures: Vec<(String, String)>,
}

/// How the members of a fast map end, and which of them are the first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fast {
    /// Least priority of the alarm with which a member ends, and which decides a point.
    pub first_alarm: Priority,
    /// Time of its horizon (s) after which a member ends whose motion has stayed away from all levels.
    pub calm_after: f64,
    /// Share of members with such an alarm, 0 to 1, above which a point has it: the point ends once more than this share of all
    /// its members saw one, since the others cannot change that.
    pub limit: f64,
    /// Plausible tools whose first ones take turns over the points, so that neighbours have others; 1: tool 0 everywhere.
    pub turns: u32,
}

impl Fast {
    /// Whether so many alarms decide a point of so many members in all, whatever the others bring.
    pub fn decides(&self, seen: u32, members: u32) -> bool {
        f64::from(seen) > self.limit * f64::from(members)
    }
}

/// The state that a start from running comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Running {
    /// Rotary speed (r/min).
    pub rpm: f64,
    /// Model time at this speed (s).
    pub time: f64,
}

/// A grid of rows: x within y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Values of the first key.
    pub columns: usize,
    /// Values of the second key.
    pub rows: usize,
}

/// One point of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Number in the plan.
    pub number: usize,
    /// Number of the row of values.
    pub row: usize,
    /// Way to the values.
    pub start: Start,
    /// Seed of the disturbances.
    pub seed: u64,
    /// Name that follows from the content: 32 hexadecimal digits.
    pub id: String,
}

impl Plan {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.rows.len() * self.starts.len() * self.seeds.len()
    }

    /// Whether there are none; a checked plan has some.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of the point of a row, a start and a seed, each by its number.
    pub fn number(&self, row: usize, start: usize, seed: usize) -> usize {
        (row * self.starts.len() + start) * self.seeds.len() + seed
    }

    /// The points, in the order of their numbers.
    pub fn points(&self) -> Vec<Point> {
        // What all points share is hashed once.
        let mut shared = Sha256::new();
        let runs = &self.runs;
        for text in [&runs.program, &runs.arithmetic, &runs.hash] {
            hash_text(&mut shared, text);
        }
        let amount = format!("{FORMAT} {} {} {}", runs.horizon, runs.members, runs.run_all);
        hash_text(&mut shared, &amount);
        // Points of plans without these keep their names.
        if let Some(fast) = &runs.fast {
            let Fast {
                first_alarm,
                calm_after,
                limit,
                turns,
            } = fast;
            hash_text(
                &mut shared,
                &format!("{} {calm_after} {limit} {turns}", first_alarm.name()),
            );
        }
        if runs.plausible {
            hash_text(&mut shared, "plausible");
        }
        let keys: Vec<&String> = self.keys.iter().collect();
        hash_text(&mut shared, &serde_json::to_string(&keys).unwrap_or_default());
        let mut points = Vec::with_capacity(self.len());
        for (row, values) in self.rows.iter().enumerate() {
            let mut of_row = shared.clone();
            // Plain numbers, words and truth values can be serialised.
            hash_text(&mut of_row, &serde_json::to_string(values).unwrap_or_default());
            for &start in &self.starts {
                for &seed in &self.seeds {
                    let mut of_point = of_row.clone();
                    let way = match start {
                        Start::Rest => String::new(),
                        Start::Running => format!("{} {}", runs.running.rpm, runs.running.time),
                    };
                    hash_text(&mut of_point, start.name());
                    hash_text(&mut of_point, &way);
                    hash_text(&mut of_point, &seed.to_string());
                    points.push(Point {
                        number: points.len(),
                        row,
                        start,
                        seed,
                        id: hex(&of_point.finalize()[..16]),
                    });
                }
            }
        }
        points
    }

    /// The number of the plausible tool that a member of a row is: members take turns from a first one on, which differs
    /// between neighbours, so that the first members of a region stand for all tools.
    pub fn tool(&self, row: usize, member: u32) -> u32 {
        let Some(fast) = &self.runs.fast else { return member };
        // The R2 sequence: multiples of the inverse powers of the plastic number fill a square evenly.
        const OF_AXES: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];
        let columns = self.map.map_or(1, |grid| grid.columns.max(1));
        let along = [row % columns, row / columns];
        let place = |axis: usize| (along[axis] as u64).wrapping_mul(OF_AXES[axis]);
        let share = place(0).wrapping_add(place(1)) >> 32;
        let first = (share * u64::from(fast.turns)) >> 32;
        ((first + u64::from(member)) % u64::from(fast.turns)) as u32
    }

    /// The values of a row by their keys.
    pub fn values(&self, row: usize) -> impl Iterator<Item = (&String, &Value)> {
        self.keys.iter().zip(self.rows.get(row).into_iter().flatten())
    }

    /// The first problem of the plan's own numbers, if any. The values of its rows are the configuration's to check.
    pub fn problem(&self) -> Option<Problem> {
        let runs = &self.runs;
        // The checks are in the order of the file, and the first problem is reported.
        let [least, most] = HORIZONS;
        let problem = |what: &str, value: &dyn ToString, bound: String| {
            Some(Problem {
                what: what.to_owned(),
                value: value.to_string(),
                bound,
            })
        };
        if !(least..=most).contains(&runs.horizon) {
            return problem("horizon", &runs.horizon, format!("{least} to {most} s"));
        }
        if !(1..=MOST_MEMBERS).contains(&runs.members) {
            return problem("members", &runs.members, format!("1 to {MOST_MEMBERS}"));
        }
        if let Some(fast) = &runs.fast {
            if !(least..=runs.horizon).contains(&fast.calm_after) {
                let bound = format!("{least} to {} s, the horizon", runs.horizon);
                return problem("fast.calm_after", &fast.calm_after, bound);
            }
            if !(0.0..1.0).contains(&fast.limit) {
                return problem("fast.limit", &fast.limit, "0 to below 1".to_owned());
            }
            if !(1..=MOST_MEMBERS).contains(&fast.turns) {
                return problem("fast.turns", &fast.turns, format!("1 to {MOST_MEMBERS}"));
            }
        }
        if !(0.0..=most).contains(&runs.running.time) {
            return problem("running.time", &runs.running.time, format!("0 to {most} s"));
        }
        if !(runs.running.rpm > 0.0 && runs.running.rpm.is_finite()) {
            return problem("running.rpm", &runs.running.rpm, "above 0 r/min".to_owned());
        }
        if !(1..=MOST_KEYS).contains(&self.keys.len()) {
            return problem("keys", &self.keys.len(), format!("1 to {MOST_KEYS}"));
        }
        // A key that is given twice would be set twice, and the second value would win silently.
        for (number, key) in self.keys.iter().enumerate() {
            if self.keys[..number].contains(key) {
                return problem("keys", key, "given once".to_owned());
            }
        }
        let ragged = self.rows.iter().find(|row| row.len() != self.keys.len());
        if let Some(row) = ragged {
            return problem(
                "rows",
                &row.len(),
                format!("{} values each, one per key", self.keys.len()),
            );
        }
        // Strictly rising means sorted and without repetition: the number of a point follows from these orders.
        if self.starts.is_empty() || !self.starts.is_sorted_by(|a, b| a < b) {
            return problem(
                "starts",
                &format!("{:?}", self.starts),
                "rest, running or both".to_owned(),
            );
        }
        if self.seeds.is_empty() || !self.seeds.is_sorted_by(|a, b| a < b) {
            return problem("seeds", &format!("{:?}", self.seeds), "rising, at least one".to_owned());
        }
        // In 128 bits, since a file may hold any numbers and their product must not wrap.
        let points = (self.rows.len() as u128) * (self.starts.len() as u128) * (self.seeds.len() as u128);
        if !(1..=MOST_POINTS as u128).contains(&points) {
            return problem(
                "points",
                &points,
                format!("1 to {MOST_POINTS}, rows times starts times seeds"),
            );
        }
        // The bound on all model time together protects against a plan that no machine finishes.
        let time = points as f64 * f64::from(runs.members) * runs.horizon;
        if time > MOST_MODEL_TIME {
            let bound = format!("at most {MOST_MODEL_TIME} s; fewer points or members, or a shorter horizon");
            return problem("model time of all members", &time, bound);
        }
        // Columns times rows may overflow as well; then it is no grid of these rows.
        if let Some(grid) = self.map
            && (self.keys.len() != 2 || grid.columns.checked_mul(grid.rows) != Some(self.rows.len()))
        {
            return problem(
                "map",
                &format!("{grid:?}"),
                format!("a grid of {} rows, two keys", self.rows.len()),
            );
        }
        None
    }

    /// Checks every row by the configuration, and the plan's own numbers.
    ///
    /// # Errors
    /// With the first that is refused.
    pub fn check_rows(&self, name: &str, config: &Config) -> Result<(), SweepError> {
        if let Some(problem) = self.problem() {
            let name = name.to_owned();
            return Err(SweepError::Plan { name, problem });
        }
        let rpm = self.runs.running.rpm;
        let mut beyond = None;
        for row in 0..self.rows.len() {
            let changed = config.with_values(name, self.values(row).map(|(key, value)| (key, value.clone())));
            let changed = changed.map_err(|reason| SweepError::Row {
                name: name.to_owned(),
                row: row + 1,
                reason,
            })?;
            let limits = &changed.inputs.rotary_speed;
            if self.starts.contains(&Start::Running) && !(limits.min_rpm..=limits.max_rpm).contains(&rpm) {
                beyond.get_or_insert([limits.min_rpm, limits.max_rpm]);
            }
        }
        // After all rows: where a row is beyond a limit itself, that is what is wrong.
        let Some([least, most]) = beyond else { return Ok(()) };
        Err(SweepError::Plan {
            name: name.to_owned(),
            problem: Problem {
                what: "running.rpm".to_owned(),
                value: rpm.to_string(),
                bound: format!("within inputs.rotary_speed, {least} to {most} r/min"),
            },
        })
    }

    /// The configuration of a row.
    ///
    /// # Errors
    /// When the plan's configuration or the row is refused, which those of a checked plan are not.
    pub fn config(&self, base: &Config, row: usize) -> Result<Config, ConfigError> {
        base.with_values("sweep", self.values(row).map(|(key, value)| (key, value.clone())))
    }

    /// The first thing in which another plan differs.
    pub(crate) fn difference(&self, other: &Self) -> Option<&'static str> {
        let (a, b) = (&self.runs, &other.runs);
        let parts = [
            (
                "the program or its arithmetic",
                a.program == b.program && a.arithmetic == b.arithmetic,
            ),
            ("the configuration", a.hash == b.hash),
            ("horizon, members, run_all, alarms or figures", a == b),
            ("the keys", self.keys == other.keys),
            // As text: a number may have been rounded to its last bit when it was read.
            ("the values", same_text(&self.rows, &other.rows)),
            ("the starts", self.starts == other.starts),
            ("the seeds", self.seeds == other.seeds),
            ("the grid of the map", self.map == other.map),
        ];
        parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
    }
}

/// Whether two tables are equal once the second is written and read as the first was.
fn same_text(read: &[Vec<Value>], given: &[Vec<Value>]) -> bool {
    let written = serde_json::to_string(given).and_then(|text| serde_json::from_str::<Vec<Vec<Value>>>(&text));
    written.is_ok_and(|again| again == read)
}

/// A number of a plan that is out of its bounds.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} = {value}: must be {bound}")]
pub struct Problem {
    /// Which.
    pub what: String,
    /// As given.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

/// Adds a text with its length, so that no two sequences of texts are the same bytes.
fn hash_text(hasher: &mut Sha256, text: &str) {
    hasher.update((text.len() as u64).to_le_bytes());
    hasher.update(text.as_bytes());
}
