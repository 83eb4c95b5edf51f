//! The hole ahead of a configuration, as `flexdrill ahead` answers it: plausible tools on threads, a plan, words and pictures.
//! [`drilling`](crate::drilling) lets each tool drill.
//!
//! # Layout
//! - [`advice`]: what the plan needs, and under which weight the bit comes nearest to it.
//! - [`present`]: the tool at the end of a recorded run, or as a state has it.
//! - [`table`], [`words`], [`picture`]: the results.

pub mod advice;
pub mod picture;
pub mod present;
pub mod table;
pub mod words;

use flexdrill_config::{Config, sha256};
use flexdrill_hole::{Bounds, HoleError, steady};

pub use crate::drilling::{
    Band, Drilling, Learnt, Long, Plan, Refusal, SPACING, Spread, Station, Track, USUAL_LENGTH, USUAL_WEIGHT, across,
    along, build, drill, learnt, plan, surveys, tool, turned,
};
use crate::drilling::{middle_inclination, range::whatever_the_bit, spread, unknowns};
use crate::runs::{KeepError, Kept, KeptAs, Work, run_all};
pub use advice::Advice;
pub use present::Present;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// Weight at the bit (N).
    pub weight: f64,
    /// Largest weight that the inputs allow (N).
    pub largest_weight: f64,
    /// Stations ahead, each [`SPACING`] behind the one before.
    pub stations: usize,
    /// Azimuth of the hole's plane (rad).
    pub azimuth: f64,
    /// Plausible tools.
    pub members: usize,
    /// Seed of their draws.
    pub seed: u64,
    /// Threads.
    pub jobs: usize,
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Measured depth of the bit, from the kick-off (m).
    pub depth: f64,
    /// The tool as configured.
    pub drilling: Drilling,
    /// Its stations, with what surveys correct.
    pub nominal: Track,
    /// What surveys say; none without any.
    pub learnt: Option<Learnt>,
    /// Those of the plausible tools, or of the plausible holes where surveys correct the curvature; or why one is not known.
    pub members: Vec<Result<Track, String>>,
    /// Where the known members are, by station; empty without any.
    pub spread: Vec<Spread>,
    /// What the tool drills to in a long arc; none where the thrust bends it without limit.
    pub long: Option<Long>,
    /// Curvatures that no bit leaves, at the largest weight; none where the thrust bends the guide without limit.
    pub bounds: Option<Bounds>,
}

/// A tool to be run.
struct Run<'a> {
    /// Its number among the plausible tools.
    number: usize,
    drilling: &'a Result<Drilling, String>,
    stations: usize,
}

/// Holes that are drawn from what surveys say: the ends of a band scatter by 4 % of its half.
const HOLES: usize = 1000;

/// Numbers of a station.
const NUMBERS: usize = 5;

impl Work for Run<'_> {
    type Found = Track;

    fn cost(&self) -> f64 {
        1.0
    }

    fn kept_as(&self) -> Option<KeptAs> {
        let drilling = self.drilling.as_ref().ok()?;
        Some(KeptAs {
            name: format!("{:05}", self.number),
            // All numbers of guide, bit and hole, each as a text that reads back to the bit: whatever changes one of them
            // makes another tool.
            config: sha256(format!("{drilling:?}").as_bytes()),
            load: format!("{} stations", self.stations),
        })
    }

    fn run(&self, _: &mut impl FnMut(f64)) -> Result<Track, String> {
        let drilling = self.drilling.as_ref().map_err(Clone::clone)?;
        drill(drilling, self.stations).map_err(|error| error.to_string())
    }

    fn figures(found: &Track) -> Vec<f64> {
        let of = |at: &Station| {
            let [x, y, z] = at.position;
            [at.inclination, at.azimuth, x, y, z]
        };
        found.iter().flat_map(of).collect()
    }

    fn found(figures: Vec<f64>) -> Option<Track> {
        let (stations, rest) = figures.as_chunks::<NUMBERS>();
        let of = |&[inclination, azimuth, x, y, z]: &[f64; NUMBERS]| Station {
            inclination,
            azimuth,
            position: [x, y, z],
        };
        rest.is_empty().then(|| stations.iter().map(of).collect())
    }
}

/// Why there is no answer. A plausible tool that fails is part of an answer.
#[derive(Debug, thiserror::Error)]
pub enum AnswerError {
    /// Nothing can be predicted for the configuration.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The tool as configured has no equilibrium.
    #[error("the tool as configured: {0}")]
    Hole(#[from] HoleError),
    /// The priors cannot be drawn.
    #[error(transparent)]
    Priors(#[from] flexdrill_uncertainty::UncertaintyError),
    /// A tool that has drilled cannot be kept.
    #[error(transparent)]
    Keep(#[from] KeepError),
}

/// Answers for a configuration, with what surveys say. Plausible tools that are `kept` do not drill again, and each that has
/// drilled is kept.
///
/// # Errors
/// When nothing can be predicted for the configuration as it is, or a tool cannot be kept. A member that fails is part of the
/// answer.
pub fn answer(
    config: &Config,
    question: &Question,
    learnt: Option<Learnt>,
    kept: Option<&Kept>,
    progress: impl FnMut(f64),
) -> Result<Answer, AnswerError> {
    let drilling = Drilling::of(config, question.weight, question.azimuth)?;
    let nominal = drill(&drilling, question.stations)?;
    let Question {
        weight,
        azimuth,
        members,
        seed,
        ..
    } = *question;
    // Where the curvature was measured, plausible tools say nothing more of it.
    let measured = learnt.as_ref().is_some_and(Learnt::corrects_curvature);
    let members = if measured { 0 } else { members };
    let tools = unknowns::members(config, weight, azimuth, members, seed)?;
    let stations = question.stations;
    let run = |(number, drilling)| Run {
        number,
        drilling,
        stations,
    };
    let runs: Vec<Run<'_>> = tools.iter().enumerate().map(run).collect();
    let mut members = run_all(&runs, question.jobs, kept, progress)?;
    let mut nominal = nominal;
    if let Some(learnt) = &learnt {
        members = learnt.plausible(&nominal, &members, HOLES, seed)?;
        nominal = learnt.corrected(&nominal);
    }
    let sine = libm::sin(middle_inclination(&nominal));
    let long = steady(&drilling.guide, &drilling.law, sine).ok();
    Ok(Answer {
        depth: config.well.length(),
        spread: spread(&nominal, &members),
        bounds: whatever_the_bit(config, question.largest_weight),
        long: long.map(Long::from),
        drilling,
        nominal,
        learnt,
        members,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of a tool that differs in one bit, or drills further, is none of this one.
    #[test]
    fn a_tool_is_kept_by_all_that_it_is() {
        let yaml = include_str!("../../tests/data/ahead.yaml");
        let config = Config::from_text("ahead.yaml", yaml).unwrap();
        let tool = Drilling::of(&config, 10e3, 0.0).unwrap();
        let kept = |drilling: Drilling, stations| {
            let drilling = Ok(drilling);
            let number = 7;
            let run = Run {
                number,
                drilling: &drilling,
                stations,
            };
            run.kept_as().unwrap()
        };
        let this = kept(tool.clone(), 20);
        assert_eq!(this, kept(tool.clone(), 20));
        assert_ne!(this, kept(tool.clone(), 21));
        let mut other = tool;
        other.guide.gap = other.guide.gap.next_up();
        let other = kept(other, 20);
        assert!(this.name == other.name && this.config != other.config);
    }

    #[test]
    fn numbers_of_a_track_read_back() {
        let track = vec![
            Station {
                inclination: 0.1,
                azimuth: 0.2,
                position: [1.0, 2.0, 3.0],
            };
            3
        ];
        let figures = Run::figures(&track);
        assert_eq!(Run::found(figures[1..].to_vec()), None);
        assert_eq!(Run::found(figures), Some(track));
    }
}
