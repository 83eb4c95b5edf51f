//! Reach: torque and weight at the bit against the length of the hole.
//!
//! The configuration's tool and hole are lengthened by links in a straight part. Every point, a length with a friction
//! coefficient, with or without rotation, is a run of the twin until its means are steady ([`point`]). Beside it are the
//! closed form of a soft string ([`soft_string`]) and the depth from which the tool is compressed beyond buckling. A run
//! that fails or does not become steady is unknown, with its cause. [`plausible`] has the range of plausible tools.

pub mod picture;
pub mod plausible;
pub mod point;
pub mod soft_string;
pub mod table;

use flexdrill_config::{Config, ConfigError};

use crate::runs::{KeepError, Kept, KeptAs, Work, run_all};
pub use point::{Found, Load, Point};
use soft_string::SoftString;

/// What is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Numbers of links, rising.
    pub links: Vec<usize>,
    /// Friction coefficients of both layers, rising.
    pub frictions: Vec<f64>,
    /// Speed, weight and duration of every run.
    pub load: Load,
    /// Threads.
    pub jobs: usize,
}

/// A point with its result.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Length of the hole from the kick-off (m).
    pub length: f64,
    /// Links.
    pub links: usize,
    /// Friction coefficient.
    pub friction: f64,
    /// Whether the tool rotates.
    pub rotates: bool,
    /// Closed form of a soft string.
    pub soft: SoftString,
    /// The twin's figures, or why there are none.
    pub found: Result<Found, String>,
}

/// Why a study cannot be made. A run that fails is part of its results.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The configuration cannot be lengthened or loaded as the plan says.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A point cannot be kept.
    #[error(transparent)]
    Keep(#[from] KeepError),
}

/// Runs all points, on as many threads as the plan has. The rows are in the order of lengths, with rotation first, then
/// of friction ([`run_all`]).
///
/// # Errors
/// When the configuration cannot be lengthened or loaded as the plan says, or a point cannot be kept.
pub fn study(
    config: &Config,
    plan: &Plan,
    kept: Option<&Kept>,
    progress: impl FnMut(f64),
) -> Result<Vec<Row>, StudyError> {
    let mut points = Vec::new();
    for &links in &plan.links {
        for rotates in [true, false] {
            for &friction in &plan.frictions {
                points.push(Point::new(config, links, friction, rotates, &plan.load)?);
            }
        }
    }
    let load = plan.load;
    let runs: Vec<Loaded<'_>> = points
        .iter()
        .map(|point| Loaded {
            point,
            load: &load,
            member: None,
        })
        .collect();
    let found = run_all(&runs, plan.jobs, kept, progress)?;
    Ok(points
        .iter()
        .zip(found)
        // The closed form costs nothing and is computed again, so a kept point does not depend on its version.
        .map(|(point, found)| Row {
            length: point.config.well.length(),
            links: point.links,
            friction: point.friction,
            rotates: point.rotates,
            soft: SoftString::of(&point.config, &plan.load, point.rotates),
            found,
        })
        .collect())
}

/// A point under its load.
struct Loaded<'a> {
    point: &'a Point,
    load: &'a Load,
    /// Number of a plausible tool.
    member: Option<usize>,
}

impl Work for Loaded<'_> {
    type Found = Found;

    /// The cost of a step grows with the links.
    fn cost(&self) -> f64 {
        self.point.links as f64
    }

    fn kept_as(&self) -> Option<KeptAs> {
        let Point {
            config,
            links,
            friction,
            rotates,
        } = self.point;
        let rotation = if *rotates { "with" } else { "without" };
        let of = match self.member {
            Some(member) => format!("tool{member}"),
            None => friction.to_string(),
        };
        Some(KeptAs {
            name: format!("{links}_{of}_{rotation}"),
            config: config.hash(),
            load: format!("{:?}", self.load),
        })
    }

    fn run(&self, report: &mut impl FnMut(f64)) -> Result<Found, String> {
        self.point.run(self.load, report)
    }

    fn figures(found: &Found) -> Vec<f64> {
        let [buckles, folds] = [found.guide_buckles_at, found.chain_folds_at].map(|at| at.unwrap_or(f64::NAN));
        let figures = [
            found.weight,
            found.torque,
            found.range,
            [buckles, folds],
            [found.advance, found.time],
        ];
        figures.concat()
    }

    fn found(figures: Vec<f64>) -> Option<Found> {
        let [a, b, c, d, e, f, buckles, folds, advance, time] = figures.try_into().ok()?;
        let known = |at: f64| (!at.is_nan()).then_some(at);
        Some(Found {
            weight: [a, b],
            torque: [c, d],
            range: [e, f],
            guide_buckles_at: known(buckles),
            chain_folds_at: known(folds),
            advance,
            time,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_follows_from_its_numbers() {
        let found = Found {
            weight: [0.1 + 0.2, 1e-300],
            torque: [f64::MIN_POSITIVE, -1.0 / 3.0],
            range: [0.0, 1e300],
            guide_buckles_at: None,
            chain_folds_at: Some(0.15),
            advance: 1e-3,
            time: 33.0,
        };
        let figures = Loaded::figures(&found);
        assert_eq!(Loaded::found(figures[1..].to_vec()), None);
        assert_eq!(Loaded::found(figures), Some(found));
    }
}
