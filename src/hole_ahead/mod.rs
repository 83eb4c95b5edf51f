//! The hole ahead: where the tool of a configuration drills in the next metres, and how far that is known.
//!
//! # Layout
//! - [`tool`]: guide, bit and hole of a configuration.
//! - [`unknowns`]: what is not known, and plausible tools drawn from it.
//! - [`plan`]: a planned hole and the distance to it.
//! - [`advice`]: what the plan needs, and under which weight the bit comes nearest to it.
//! - [`table`], [`words`], [`picture`]: the results.

pub mod advice;
pub mod picture;
pub mod plan;
pub mod table;
pub mod tool;
pub mod unknowns;
pub mod words;

use flexdrill_config::Config;
use flexdrill_hole::{Bounds, HoleError, Propagation, RIPPLE_THRESHOLD, bounds, steady};

use crate::runs::{KeepError, KeptAs, Work, run_all};
pub use advice::Advice;
pub use plan::Plan;
pub use tool::{Drilling, Refusal, SPACING};

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

/// The bit at a depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Inclination of the hole (rad).
    pub inclination: f64,
    /// Azimuth of the hole (rad).
    pub azimuth: f64,
    /// Position from the kick-off (m): along azimuth 0, to the right of it, down.
    pub position: [f64; 3],
}

/// The stations of a tool, from the bit on.
pub type Track = Vec<Station>;

/// Ends of 90 % of the members and their median.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// 5 % of the members are below.
    pub low: f64,
    /// Half of the members are below.
    pub median: f64,
    /// 5 % of the members are above.
    pub high: f64,
}

impl Band {
    /// Fewest values of a band. Quantile q of n values is their number q (n + 1), so that the next value is below it with
    /// the chance q: 5 % of fewer would be below the first of them.
    pub const LEAST: usize = 19;

    /// Of known values; none of fewer than [`Band::LEAST`].
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        if values.len() < Self::LEAST {
            return None;
        }
        values.sort_by(f64::total_cmp);
        let last = values.len() - 1;
        let quantile = |share: f64| {
            let at = (share * (values.len() + 1) as f64 - 1.0).clamp(0.0, last as f64);
            let below = (at.floor() as usize).min(last);
            let above = (below + 1).min(last);
            values[below] + (at - below as f64) * (values[above] - values[below])
        };
        Some(Self {
            low: quantile(0.05),
            median: quantile(0.5),
            high: quantile(0.95),
        })
    }

    /// Half of its width.
    pub fn half(&self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

/// Where the members are at a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Inclination (rad).
    pub inclination: Band,
    /// Azimuth (rad), continuous at that of the nominal tool.
    pub azimuth: Band,
    /// Distance from the nominal position towards the high side (m).
    pub high: Band,
    /// The same to the right (m).
    pub right: Band,
}

/// What a guide drills to in a long arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Long {
    /// Curvature (1/m).
    pub curvature: f64,
    /// Length between bit and wall (m).
    pub free_length: f64,
    /// P: lateral resistance of the bit against that of the guide.
    pub steering_number: f64,
}

impl Long {
    /// Whether the hole ripples.
    pub fn ripples(&self) -> bool {
        self.steering_number < RIPPLE_THRESHOLD
    }
}

/// The answer.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Measured depth of the bit, from the kick-off (m).
    pub depth: f64,
    /// The tool as configured.
    pub drilling: Drilling,
    /// Its stations.
    pub nominal: Track,
    /// Those of the members, or why one is not known.
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

/// Drills to some stations ahead; the first is the bit.
///
/// # Errors
/// When the statics of the guide have no solution.
pub fn drill(drilling: &Drilling, stations: usize) -> Result<Track, HoleError> {
    let (guide, law, hole) = (drilling.guide, drilling.law, drilling.hole.clone());
    let (mut propagation, start) = Propagation::begin(guide, law, hole, drilling.chord())?;
    let station = |at: flexdrill_hole::Advance| Station {
        inclination: at.inclination,
        azimuth: at.azimuth,
        position: [at.position.x, at.position.y, at.position.z],
    };
    let mut track = vec![station(start)];
    for _ in 0..stations {
        let mut last = None;
        for _ in 0..drilling.chords {
            last = Some(propagation.advance()?);
        }
        track.extend(last.map(station));
    }
    Ok(track)
}

/// The angle nearest to 0 that is the same direction (rad).
pub fn turned(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}

/// Unit vectors across the hole at a station: to the high side and to the right.
pub fn across(at: &Station) -> [[f64; 3]; 2] {
    let (sine, cosine) = libm::sincos(at.inclination);
    let (east, north) = libm::sincos(at.azimuth);
    [[cosine * north, cosine * east, -sine], [-east, north, 0.0]]
}

/// Component of the way from one position to another along a unit vector (m).
pub fn along(from: [f64; 3], to: [f64; 3], unit: [f64; 3]) -> f64 {
    (0..3).map(|axis| (to[axis] - from[axis]) * unit[axis]).sum()
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

/// Answers for a configuration.
///
/// # Errors
/// When nothing can be predicted for the configuration as it is. A member that fails is part of the answer.
pub fn answer(config: &Config, question: &Question, progress: impl FnMut(f64)) -> Result<Answer, AnswerError> {
    let drilling = Drilling::of(config, question.weight, question.azimuth)?;
    let nominal = drill(&drilling, question.stations)?;
    let Question {
        weight,
        azimuth,
        members,
        seed,
        ..
    } = *question;
    let tools = unknowns::members(config, weight, azimuth, members, seed)?;
    let stations = question.stations;
    let runs: Vec<Run<'_>> = tools.iter().map(|drilling| Run { drilling, stations }).collect();
    let members = run_all(&runs, question.jobs, None, progress)?;
    let sine = libm::sin(middle_inclination(&nominal));
    let long = steady(&drilling.guide, &drilling.law, sine).ok();
    // The weight across the hole is largest in a level one: the widest range.
    let widest = tool::guide(config, question.largest_weight);
    Ok(Answer {
        depth: config.well.length(),
        spread: spread(&nominal, &members),
        bounds: bounds(&widest, question.largest_weight, 1.0).ok(),
        long: long.map(|long| Long {
            curvature: long.curvature,
            free_length: long.free_length,
            steering_number: long.steering_number,
        }),
        drilling,
        nominal,
        members,
    })
}

/// Inclination half of the way ahead (rad).
fn middle_inclination(track: &[Station]) -> f64 {
    track.get(track.len() / 2).map_or(0.0, |at| at.inclination)
}

/// Where the members are at each station of the nominal tool.
fn spread(nominal: &[Station], members: &[Result<Track, String>]) -> Vec<Spread> {
    let known: Vec<&Track> = members.iter().flatten().collect();
    let at_station = |(index, nominal): (usize, &Station)| {
        let band = |of: &dyn Fn(&Station) -> f64| Band::of(known.iter().map(|track| of(&track[index])).collect());
        let [high, right] = across(nominal);
        Some(Spread {
            inclination: band(&|at: &Station| at.inclination)?,
            azimuth: band(&|at: &Station| nominal.azimuth + turned(at.azimuth - nominal.azimuth))?,
            high: band(&|at: &Station| along(nominal.position, at.position, high))?,
            right: band(&|at: &Station| along(nominal.position, at.position, right))?,
        })
    };
    nominal.iter().enumerate().filter_map(at_station).collect()
}

/// Turn of the hole per metre over some stations from the bit on (rad/m): the change of its inclination.
pub fn build(track: &[Station], stations: usize) -> f64 {
    let last = stations.min(track.len().saturating_sub(1)).max(1);
    match (track.first(), track.get(last)) {
        (Some(first), Some(last_station)) => (last_station.inclination - first.inclination) / (last as f64 * SPACING),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_has_ninety_per_cent_between_its_ends() {
        // The next of 19 equally likely values is below the first, or above the last, once in twenty times.
        let of = |count: u32| Band::of((1..=count).rev().map(f64::from).collect());
        let band = of(19).unwrap();
        let near = |value: f64, expected: f64| (value - expected).abs() < 1e-9;
        assert!(
            near(band.low, 1.0) && near(band.median, 10.0) && near(band.high, 19.0),
            "{band:?}"
        );
        let band = of(99).unwrap();
        assert!(
            near(band.low, 5.0) && near(band.median, 50.0) && near(band.high, 95.0),
            "{band:?}"
        );
        assert!(near(band.half(), 45.0));
        assert_eq!(of(18), None);
    }

    #[test]
    fn azimuths_near_north_are_near_each_other() {
        assert!((turned(-6.2) - (std::f64::consts::TAU - 6.2)).abs() < 1e-12);
        assert_eq!(turned(0.5), 0.5);
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
