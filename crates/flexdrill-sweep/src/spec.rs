//! The specification of a sweep (YAML), as a person writes it.

use std::path::{Path, PathBuf};

use flexdrill_config::checker::{Bound, Checker};
use flexdrill_config::{Config, ConfigError, reading};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::error::SweepError;
use crate::map::{ROTARY_SPEED, Start};
use crate::plan::{FORMAT, HORIZONS, MOST_KEYS, MOST_MEMBERS, MOST_POINTS, Plan, Running, Runs};
use crate::values::{along, ends, is_scalar};

/// A sweep as a person writes it. Exactly one of `grid`, `list` and `latin_hypercube` gives the values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// The configuration that the points change; a relative path begins at the specification's folder. Required.
    pub configuration: PathBuf,
    /// Model time that each member is judged over (s). Default 60.
    #[serde(default = "horizon")]
    pub horizon: f64,
    /// Members per point, at most. Default 3.
    #[serde(default = "members")]
    pub members: u32,
    /// Whether all members run, also where the first ones decide every alarm. Default false.
    #[serde(default)]
    pub run_all: bool,
    /// Ways to the values, `rest` and `running`. Default both.
    #[serde(default = "starts")]
    pub starts: Vec<Start>,
    /// Seeds of the members' disturbances, a point per seed. Default 1.
    #[serde(default = "seeds")]
    pub seeds: Vec<u64>,
    /// The state that the start `running` comes from.
    #[serde(default)]
    pub running: RunningSpec,
    /// Values per key; every combination is a point. The first key changes slowest. A list of values, or `{from, to,
    /// count}`.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub grid: Map<String, Value>,
    /// Points by their values. All have the same keys.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub list: Vec<Map<String, Value>>,
    /// Points that fill the space between bounds evenly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub latin_hypercube: Option<LatinHypercube>,
}

/// `running`: the state that the start `running` comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RunningSpec {
    /// Rotary speed (r/min). Default the highest of the points, or the highest that the inputs accept if no point sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rpm: Option<f64>,
    /// Model time at this speed (s). Default 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
}

/// `latin_hypercube`: every bound is cut into as many equal parts as there are points, and each part has one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LatinHypercube {
    /// Number of points. Required.
    pub points: usize,
    /// Seed of the arrangement. Default 1.
    #[serde(default = "seed")]
    pub seed: u64,
    /// Lower and upper bound per key. Required.
    pub ranges: Map<String, Value>,
}

/// Model time of the start `running` at its speed (s), unless the specification has one: as the look-ahead's shortest
/// horizon, the windows of the analysis.
pub const RUNNING_TIME: f64 = 10.0;

fn horizon() -> f64 {
    60.0
}
fn members() -> u32 {
    3
}
fn starts() -> Vec<Start> {
    Start::ALL.to_vec()
}
fn seeds() -> Vec<u64> {
    vec![1]
}
fn seed() -> u64 {
    1
}

/// What the program says of itself in a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Name and version.
    pub name: String,
    /// See [`Runs::arithmetic`].
    pub arithmetic: String,
    /// Alarms that it counts.
    pub alarms: Vec<String>,
    /// Figures that it computes, with units.
    pub figures: Vec<(String, String)>,
}

impl Spec {
    /// Reads a specification, with the folder that relative paths begin at.
    ///
    /// # Errors
    /// When the file cannot be read, is not YAML of a specification, or a value is out of bounds.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let (name, text) = reading::read(path)?;
        Ok(Self::from_text(&name, &text)?)
    }

    /// Reads a text; `name` stands for the file in errors.
    ///
    /// # Errors
    /// As [`Spec::load`].
    pub fn from_text(name: &str, text: &str) -> Result<Self, ConfigError> {
        let required = ["configuration", "latin_hypercube.points", "latin_hypercube.ranges"];
        reading::checked(name, text, &required, Self::check)
    }

    fn check(&self, c: &mut Checker) {
        let [least, most] = HORIZONS;
        let delays = "the delays of the alarms have to pass; chaotic motion says nothing beyond minutes";
        c.number("horizon", self.horizon, Bound::within(least, most), "s", delays);
        let bound = Bound::within(1.0, f64::from(MOST_MEMBERS));
        c.count("members", self.members as usize, bound, "more says little more");
        if let Some(time) = self.running.time {
            c.number(
                "running.time",
                time,
                Bound::within(0.0, most),
                "s",
                "it only brings the tool to its motion",
            );
        }
        if let Some(rpm) = self.running.rpm {
            c.number(
                "running.rpm",
                rpm,
                Bound::within(0.1, 5000.0),
                "r/min",
                "the tool must run",
            );
        }
        // Exactly one form gives the values: with two it would be open which of them counts.
        let given = [
            !self.grid.is_empty(),
            !self.list.is_empty(),
            self.latin_hypercube.is_some(),
        ];
        if given.iter().filter(|given| **given).count() != 1 {
            c.wrong(
                "grid",
                "",
                "",
                "given, or `list`, or `latin_hypercube`",
                "exactly one of them gives the values",
            );
        }
        // Each error has the path of its key, so that it points at the line.
        for (key, values) in &self.grid {
            if let Err(why) = along(values) {
                c.wrong(
                    &format!("grid.{key}"),
                    values,
                    "",
                    why,
                    "a list, or `{from: 20, to: 120, count: 11}`",
                );
            }
        }
        // The first point sets the keys of the list.
        let keys = self
            .list
            .first()
            .map(|point| point.keys().collect::<Vec<_>>())
            .unwrap_or_default();
        for (number, point) in self.list.iter().enumerate() {
            if !keys.iter().all(|key| point.contains_key(*key)) || point.len() != keys.len() {
                let key = format!("list.{number}");
                c.wrong(
                    &key,
                    point.len(),
                    "",
                    "of the same keys as the first point",
                    "a table has no holes",
                );
            }
            for (key, value) in point {
                if !is_scalar(value) {
                    c.wrong(
                        &format!("list.{number}.{key}"),
                        value,
                        "",
                        "one value",
                        "a number, a word, true or false",
                    );
                }
            }
        }
        if let Some(cube) = &self.latin_hypercube {
            // The bound of a directory holds for the cube before its points are formed.
            let bound = Bound::within(1.0, MOST_POINTS as f64);
            c.count(
                "latin_hypercube.points",
                cube.points,
                bound,
                "more does not fit into a directory",
            );
            for (key, range) in &cube.ranges {
                if ends(range).is_none() {
                    let key = format!("latin_hypercube.ranges.{key}");
                    c.wrong(&key, range, "", "two numbers, the smaller first", "`[0.1, 0.4]`");
                }
            }
        }
        // Sizes come last: they multiply all of the above, which may be wrong one by one.
        let (keys, points) = self.size();
        if !(1..=MOST_KEYS).contains(&keys) {
            c.wrong(
                "grid",
                keys,
                "keys",
                format!("1 to {MOST_KEYS}"),
                "a point changes something",
            );
        }
        if points > MOST_POINTS as f64 {
            c.wrong(
                "grid",
                points,
                "points",
                format!("at most {MOST_POINTS}"),
                "with all starts and seeds",
            );
        }
    }

    /// Keys, and points without starts and seeds; nothing is built.
    fn size(&self) -> (usize, f64) {
        if let Some(cube) = &self.latin_hypercube {
            return (cube.ranges.len(), cube.points as f64);
        }
        if let Some(first) = self.list.first() {
            return (first.len(), self.list.len() as f64);
        }
        let counts = self.grid.values().map(|values| match values {
            Value::Array(values) => values.len() as f64,
            values => values.get("count").and_then(Value::as_f64).unwrap_or(1.0),
        });
        (self.grid.len(), counts.product())
    }

    /// The plan of the specification that was read from `path`. Every row of values is checked by the configuration.
    ///
    /// # Errors
    /// When the configuration, one of its rows or a number of the plan is refused.
    pub fn plan(&self, path: &Path, program: &Program) -> Result<Plan, SweepError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let config = Config::load(folder.join(&self.configuration))?;
        self.plan_for(&path.display().to_string(), &config, program)
    }

    /// The same for a configuration that was read; `name` stands for the specification in errors.
    ///
    /// # Errors
    /// As [`Spec::plan`].
    pub fn plan_for(&self, name: &str, config: &Config, program: &Program) -> Result<Plan, SweepError> {
        // Rows are formed here once. From now on the plan has values only, and
        // no ranges that another version may expand otherwise.
        let (keys, rows) = self.rows(config);
        let speed = keys.iter().position(|key| key == ROTARY_SPEED);
        let highest = speed.and_then(|at| {
            let speeds = rows.iter().filter_map(|row| row.get(at)?.as_f64());
            speeds.reduce(f64::max).filter(|rpm| *rpm > 0.0)
            // A start from running needs a speed. The highest of the sweep has the
            // most motion; without any the configuration's bound.
        });
        // Sorted and each once, so that equal specifications give the same plan, and points have the same numbers.
        let mut seeds = self.seeds.clone();
        seeds.sort_unstable();
        seeds.dedup();
        let mut starts = self.starts.clone();
        starts.sort_unstable();
        starts.dedup();
        let plan = Plan {
            format: FORMAT,
            runs: Runs {
                program: program.name.clone(),
                arithmetic: program.arithmetic.clone(),
                configuration: config.to_yaml().map_err(|error| SweepError::Damaged {
                    path: self.configuration.clone(),
                    reason: error.to_string(),
                })?,
                hash: config.hash(),
                horizon: self.horizon,
                members: self.members,
                run_all: self.run_all,
                fast: None,
                plausible: false,
                running: Running {
                    rpm: self
                        .running
                        .rpm
                        .or(highest)
                        .unwrap_or(config.inputs.rotary_speed.max_rpm),
                    time: self.running.time.unwrap_or(RUNNING_TIME),
                },
                alarms: program.alarms.clone(),
                figures: program.figures.clone(),
            },
            keys,
            rows,
            starts,
            seeds,
            map: None,
        };
        // Every row is tried with the configuration now, or a wrong one would be found after hours.
        plan.check_rows(name, config)?;
        Ok(plan)
    }
}
