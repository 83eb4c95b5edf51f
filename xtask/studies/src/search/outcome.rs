//! What a trial came to, as a line of the table.

use super::space::{DIMENSIONS, case, written};
use flexdrill_config::{Config, ConfigError};
use flexdrill_paper::{Finding, PaperError, Record, findings, score};

/// One tried point.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Number, from 0.
    pub index: usize,
    /// Part of the plan.
    pub stage: &'static str,
    /// Coordinates in the unit cube.
    pub point: Vec<f64>,
    /// What came of it.
    pub outcome: Outcome,
}

/// Findings, or why there are none.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// It ran and its energy audit held.
    Ran {
        /// All findings.
        findings: Vec<Finding>,
        /// Error of the energy audit over the drive's work.
        energy_error: f64,
        /// Part of the steps that were halved.
        halved: f64,
    },
    /// It did not.
    Failed(String),
    /// Done by an earlier run of the same plan: its line of the table.
    Earlier {
        /// The line.
        line: Vec<String>,
        /// Its score, as written.
        score: f64,
        /// Findings that agree.
        agree: usize,
    },
}

impl Outcome {
    /// Of a run.
    pub fn of(result: Result<Record, PaperError>) -> Self {
        match result {
            Ok(record) => Self::Ran {
                energy_error: record.energy_error(),
                halved: record.solver.halved_steps as f64 / record.steps.max(1) as f64,
                findings: findings(&record),
            },
            Err(error) => Self::Failed(error.to_string()),
        }
    }

    /// From a line of the table; nothing if it is none, or of other parameters than these.
    pub fn earlier(line: Vec<String>, index: usize, stage: &str, parameters: &[String]) -> Option<Self> {
        let fits = line.len() == csv_header().len()
            && line[0] == index.to_string()
            && line[1] == stage
            && line[PARAMETERS..].starts_with(parameters);
        let (score, agree) = (line.get(2)?.parse().ok()?, line.get(3)?.parse().ok()?);
        fits.then_some(Self::Earlier { line, score, agree })
    }

    /// Whether it ran and its energy audit held.
    pub fn ran(&self) -> bool {
        match self {
            Self::Ran { .. } => true,
            Self::Failed(_) => false,
            Self::Earlier { line, .. } => line.last().is_some_and(String::is_empty),
        }
    }

    /// Mean closeness, as written in the table so that a search taken up goes on as it would have, and number of
    /// agreements; nothing for a failed run.
    pub fn score(&self) -> (f64, usize) {
        match self {
            Self::Ran { findings, .. } => {
                let (score, agree) = score(findings);
                ((score * ROUND).round() / ROUND, agree)
            }
            Self::Failed(_) => (0.0, 0),
            Self::Earlier { score, agree, .. } => (*score, *agree),
        }
    }
}

/// Scores have four digits.
const ROUND: f64 = 1e4;
/// Columns of a line before the parameters.
const PARAMETERS: usize = 6;

/// Keys of the findings, in order.
const KEYS: [&str; 20] = [
    "pipe_shape",
    "pipe_whirl",
    "pipe_bottom",
    "guide_shape",
    "guide_whirl",
    "ripple",
    "guide_speed",
    "guide_period",
    "inner_force",
    "inner_place",
    "inner_peak",
    "inner_period",
    "inner_contact",
    "outer_force",
    "outer_place",
    "outer_peak",
    "outer_period",
    "outer_contact",
    "lateral",
    "pipe_over_guide",
];

/// Titles of [`Trial::csv`].
pub fn csv_header() -> Vec<String> {
    let mut titles: Vec<String> = ["trial", "stage", "score", "agree", "energy_error", "halved"]
        .map(str::to_owned)
        .to_vec();
    titles.extend(DIMENSIONS.iter().map(|dimension| dimension.name.to_owned()));
    titles.extend(KEYS.iter().map(|key| (*key).to_owned()));
    titles.extend(KEYS.iter().map(|key| format!("{key}_verdict")));
    titles.push("failure".to_owned());
    titles
}

impl Trial {
    /// Its configuration on a mesh, with its inputs as initial ones.
    ///
    /// # Errors
    /// When a value is refused.
    pub fn config(&self, base: &Config) -> Result<Config, ConfigError> {
        let case = case(base, &self.point)?;
        case.config.with_values(
            "parameter",
            [
                ("inputs.weight_on_bit.initial_kn", case.weight_on_bit_kn),
                ("inputs.rotary_speed.initial_rpm", case.rotary_speed_rpm),
            ],
        )
    }

    /// A line of the table.
    pub fn csv(&self) -> Vec<String> {
        if let Outcome::Earlier { line, .. } = &self.outcome {
            return line.clone();
        }
        let (score, agree) = self.outcome.score();
        let mut line = vec![
            self.index.to_string(),
            self.stage.to_owned(),
            format!("{score:.4}"),
            agree.to_string(),
        ];
        let parameters = DIMENSIONS.iter().zip(&self.point).map(|(d, &at)| written(d, at));
        match &self.outcome {
            Outcome::Ran {
                findings,
                energy_error,
                halved,
            } => {
                line.extend([format!("{energy_error:.3e}"), format!("{halved:.4}")]);
                line.extend(parameters);
                line.extend(findings.iter().map(|finding| format!("{:.5e}", finding.value)));
                line.extend(findings.iter().map(|finding| finding.verdict.word().to_owned()));
                line.push(String::new());
            }
            Outcome::Failed(why) => {
                line.extend([String::new(), String::new()]);
                line.extend(parameters);
                line.extend((0..2 * KEYS.len()).map(|_| String::new()));
                line.push(why.clone());
            }
            Outcome::Earlier { .. } => {}
        }
        line
    }
}
