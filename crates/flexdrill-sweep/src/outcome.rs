//! The result of a point and its file: a line of JSON, and a line with the checksum of the first.
//!
//! The file depends on the point only, not on who computed it, when, or where.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};

use flexdrill_alarms::Priority;

use crate::map::{AlarmCount, Figure, Start};
use crate::plan::{FORMAT, Plan, Point};
use flexdrill_text::hex;

/// Largest file of a point that is read (bytes): all alarms with all priorities and all figures have a twentieth of it.
pub const MOST_BYTES: u64 = 1 << 18;

/// What a point brought.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Members that were run.
    pub members: u32,
    /// Members of these that failed: they are in no count.
    pub failed: u32,
    /// Why the first of them, or the way to the values, failed; empty where none did.
    pub failure: String,
    /// Model time of the way to the values (s); nothing where it failed.
    pub run_up: Option<f64>,
    /// Model time of the members that ended, with their ways to the values (s); 0 in results of earlier builds.
    #[serde(default)]
    pub model_time: f64,
    /// The states that members began from, which other points may share.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub begun: Vec<Begun>,
    /// Members that saw any alarm of this priority or a higher one, by [`Priority::ALL`].
    pub any_alarm: [u32; 3],
    /// Alarms that a member saw, by identifier, from the lowest priority.
    pub alarms: Vec<AlarmCount>,
    /// Figures over the members.
    pub figures: Vec<Figure>,
    /// Members by the worst quality of their motion: good, degraded, poor.
    pub quality: [u32; 3],
}

impl Outcome {
    /// Members that ended.
    pub fn ended(&self) -> u32 {
        self.members.saturating_sub(self.failed)
    }
}

/// A state that members began from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Begun {
    /// Number of its plausible tool; none where it is the tool of the configuration.
    pub tool: Option<u32>,
    /// Model time that making it took (s).
    pub time: f64,
}

/// The first line of a point's file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Body {
    format: u32,
    point: String,
    program: String,
    arithmetic: String,
    configuration: String,
    values: Map<String, Value>,
    start: Start,
    seed: u64,
    outcome: Outcome,
}

/// Why a point's file is none.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// Cut off, or not written by this program.
    #[error("it does not end with the checksum of its first line")]
    Checksum,
    /// The first line is not a result.
    #[error("it is not a result of this version: {0}")]
    NoResult(String),
    /// The result of another point.
    #[error("it holds the result of another point: {what} is {found}, not {expected}")]
    Another {
        /// What differs.
        what: &'static str,
        /// In the file.
        found: String,
        /// In the plan.
        expected: String,
    },
    /// A link, a pipe, a device or a folder, which is not read: a pipe would wait for ever.
    #[error("it is no regular file")]
    NotAFile,
    /// Too large.
    #[error("it has more than {MOST_BYTES} bytes")]
    Large,
    /// It contradicts itself.
    #[error("{what} = {value}: must be {bound}")]
    Wrong {
        /// Which value.
        what: &'static str,
        /// As it stands.
        value: String,
        /// What it must be.
        bound: String,
    },
}

/// The content of a point's file.
///
/// # Errors
/// When a number of the outcome is not finite.
pub fn to_bytes(plan: &Plan, point: &Point, outcome: &Outcome) -> Result<Vec<u8>, serde_json::Error> {
    let body = Body {
        format: FORMAT,
        point: point.id.clone(),
        program: plan.runs.program.clone(),
        arithmetic: plan.runs.arithmetic.clone(),
        configuration: plan.runs.hash.clone(),
        values: plan
            .values(point.row)
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect(),
        start: point.start,
        seed: point.seed,
        outcome: outcome.clone(),
    };
    let line = serde_json::to_string(&body)?;
    let sum = hex(&Sha256::digest(line.as_bytes()));
    Ok(format!("{line}\n\"{sum}\"\n").into_bytes())
}

/// The outcome in a point's file.
///
/// # Errors
/// When the file is damaged or another point's.
pub fn from_bytes(plan: &Plan, point: &Point, bytes: &[u8]) -> Result<Outcome, Damage> {
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Damage::Large);
    }
    let end = bytes.iter().position(|byte| *byte == b'\n').ok_or(Damage::Checksum)?;
    let (line, rest) = bytes.split_at(end);
    if rest != format!("\n\"{}\"\n", hex(&Sha256::digest(line))).as_bytes() {
        return Err(Damage::Checksum);
    }
    let body: Body = serde_json::from_slice(line).map_err(|error| Damage::NoResult(error.to_string()))?;
    let runs = &plan.runs;
    for (what, found, expected) in [
        ("the point", &body.point, &point.id),
        ("the program", &body.program, &runs.program),
        ("the arithmetic", &body.arithmetic, &runs.arithmetic),
        ("the configuration", &body.configuration, &runs.hash),
    ] {
        if found != expected {
            return Err(Damage::Another {
                what,
                found: found.escape_debug().to_string(),
                expected: expected.clone(),
            });
        }
    }
    body.outcome.check(plan)?;
    Ok(body.outcome)
}

impl Outcome {
    fn check(&self, plan: &Plan) -> Result<(), Damage> {
        // A result may come from another machine, or may have been changed by
        // hand with its checksum. Its content is therefore checked.
        let wrong = |what: &'static str, value: String, bound: String| Err(Damage::Wrong { what, value, bound });
        if self.members > plan.runs.members {
            return wrong(
                "members",
                self.members.to_string(),
                format!("at most {}", plan.runs.members),
            );
        }
        if self.failed > self.members {
            return wrong("failed", self.failed.to_string(), format!("at most {}", self.members));
        }
        let mut times = self.begun.iter().map(|begun| begun.time).chain([self.model_time]);
        if let Some(time) = times.find(|time| !(*time >= 0.0 && time.is_finite())) {
            return wrong("model_time", time.to_string(), "0 s or more".to_owned());
        }
        // One state for all members, or one for each.
        if self.begun.len() > plan.runs.members as usize {
            let most = format!("at most {}, a state per member", plan.runs.members);
            return wrong("begun", self.begun.len().to_string(), most);
        }
        // All counts below refer to the members that ended.
        let ended = self.ended();
        for count in &self.alarms {
            if !plan.runs.alarms.contains(&count.alarm) {
                let name = count.alarm.escape_debug().to_string();
                return wrong("alarm", name, "one of the plan's".to_owned());
            }
            // An alarm that no member saw is not listed, so `seen` is at least one.
            if count.of != ended || count.seen > ended || count.seen == 0 {
                let value = format!("{} of {}", count.seen, count.of);
                return wrong("seen", value, format!("1 to {ended} of {ended}"));
            }
            let [low, high] = count.interval;
            if !(0.0 <= low && low <= high && high <= 1.0) {
                return wrong("interval", format!("{low} to {high}"), "within 0 and 1".to_owned());
            }
            if !count.first.is_none_or(|first| first >= 0.0) {
                return wrong("first", format!("{:?}", count.first), "0 s or more".to_owned());
            }
        }
        for (priority, any) in Priority::ALL.into_iter().zip(self.any_alarm) {
            // As many as saw one of them, at most as many as saw them together.
            let of = self.alarms.iter().filter(|count| count.priority >= priority);
            let least = of.clone().map(|count| count.seen).max().unwrap_or(0);
            let most = of.map(|count| u64::from(count.seen)).sum::<u64>().min(u64::from(ended));
            if !(u64::from(least)..=most).contains(&u64::from(any)) {
                let bound = format!(
                    "{least} to {most} with {} priority or a higher one, as its alarms say",
                    priority.name()
                );
                return wrong("any_alarm", any.to_string(), bound);
            }
        }
        // Same names, units and order, because tables are formed by position.
        let named = self.figures.iter().map(|figure| (&figure.name, &figure.unit));
        if !named.eq(plan.runs.figures.iter().map(|(name, unit)| (name, unit))) {
            return wrong(
                "figures",
                self.figures.len().to_string(),
                "those of the plan".to_owned(),
            );
        }
        let unsorted = self
            .figures
            .iter()
            .filter_map(|figure| figure.quantiles)
            .find(|of| !of.is_sorted());
        if let Some(quantiles) = unsorted {
            return wrong("quantiles", format!("{quantiles:?}"), "rising".to_owned());
        }
        // Each member that ended has exactly one quality.
        if self.quality.iter().map(|count| u64::from(*count)).sum::<u64>() != u64::from(ended) {
            return wrong(
                "quality",
                format!("{:?}", self.quality),
                format!("{ended} members together"),
            );
        }
        Ok(())
    }
}
