//! The hole ahead of a configuration, as `flexdrill ahead` answers it: plausible tools on threads, a plan, words and pictures.
//! [`drilling`](crate::drilling) lets each tool drill.
//!
//! # Layout
//! - [`advice`]: what the plan needs, and under which weight the bit comes nearest to it.
//! - [`surveys`]: a table of surveys; [`learnt`]: what they correct.
//! - [`present`]: the tool at the end of a recorded run, or as a state has it.
//! - [`table`], [`words`], [`picture`]: the results.

pub mod advice;
pub mod learnt;
pub mod picture;
pub mod present;
pub mod surveys;
pub mod table;
pub mod words;

use flexdrill_config::Config;
use flexdrill_hole::{Bounds, HoleError, bounds, steady};

pub use crate::drilling::{
    Band, Drilling, Long, Plan, Refusal, SPACING, Spread, Station, Track, USUAL_LENGTH, USUAL_WEIGHT, across, along,
    build, drill, plan, tool, turned,
};
use crate::drilling::{middle_inclination, spread, unknowns};
use crate::runs::{KeepError, KeptAs, Work, run_all};
pub use advice::Advice;
pub use learnt::Learnt;
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
    drilling: &'a Result<Drilling, String>,
    stations: usize,
}

/// Numbers of a station.
const NUMBERS: usize = 5;

impl Work for Run<'_> {
    type Found = Track;

    fn cost(&self) -> f64 {
        1.0
    }

    /// A run takes less time than a file.
    fn kept_as(&self) -> Option<KeptAs> {
        None
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
    /// A run cannot be kept, which none is.
    #[error(transparent)]
    Keep(#[from] KeepError),
}

/// Answers for a configuration, with what surveys say.
///
/// # Errors
/// When nothing can be predicted for the configuration as it is. A member that fails is part of the answer.
pub fn answer(
    config: &Config,
    question: &Question,
    learnt: Option<Learnt>,
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
    let runs: Vec<Run<'_>> = tools.iter().map(|drilling| Run { drilling, stations }).collect();
    let mut members = run_all(&runs, question.jobs, None, progress)?;
    let mut nominal = nominal;
    if let Some(learnt) = &learnt {
        members = learnt.plausible(&nominal, &members, seed)?;
        nominal = learnt.corrected(&nominal);
    }
    let sine = libm::sin(middle_inclination(&nominal));
    let long = steady(&drilling.guide, &drilling.law, sine).ok();
    // The weight across the hole is largest in a level one: the widest range.
    let widest = tool::guide(config, question.largest_weight);
    Ok(Answer {
        depth: config.well.length(),
        spread: spread(&nominal, &members),
        bounds: bounds(&widest, question.largest_weight, 1.0).ok(),
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
