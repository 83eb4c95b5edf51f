//! Loads of trips over the depth of the bit, as `flexdrill trip` computes them: the tool as configured and plausible ones on
//! threads, table, picture and words. [`flexdrill_trip`] has the mechanics.

pub mod picture;
pub mod reached;
pub mod stuck;
pub mod table;
pub mod words;

use flexdrill_config::Config;
use flexdrill_drilling::Band;
use flexdrill_trip::unknowns::{UnknownsError, priors};
use flexdrill_trip::{Assembly, Refusal, Trip};
use flexdrill_uncertainty::Priors;

use crate::runs::{KeepError, KeptAs, Work, run_all};

/// What is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Depths of the bit below the kick-off (m), from the bottom up.
    pub depths: Vec<f64>,
    /// Speed along the hole (m/s).
    pub along: f64,
    /// Angular speed with rotation (rad/s).
    pub spin: f64,
    /// Plausible tools.
    pub members: usize,
    /// Seed of their draws.
    pub seed: u64,
    /// Threads.
    pub jobs: usize,
}

/// Figures of a depth, by [`FIGURES`].
pub type Figures = [f64; FIGURES.len()];

/// A figure of a depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Hook load while pulling out (N).
    Out,
    /// The same with rotation (N).
    OutTurning,
    /// Hook load while running in (N).
    In,
    /// The same with rotation (N).
    InTurning,
    /// Torque at the rig while pulling out with rotation (N m).
    OutTorque,
    /// The same while running in (N m).
    InTorque,
    /// Tension of the guide at its top while pulling out (N).
    Guide,
    /// Largest push along string and guide while running in (N).
    Push,
}

/// All figures, in the order of their numbers.
pub const FIGURES: [Figure; 8] = [
    Figure::Out,
    Figure::OutTurning,
    Figure::In,
    Figure::InTurning,
    Figure::OutTorque,
    Figure::InTorque,
    Figure::Guide,
    Figure::Push,
];

impl Figure {
    fn of(self, trip: &Trip) -> f64 {
        match self {
            Self::Out => trip.out[0].hook_load(),
            Self::OutTurning => trip.out[1].hook_load(),
            Self::In => trip.into[0].hook_load(),
            Self::InTurning => trip.into[1].hook_load(),
            Self::OutTorque => trip.out[1].torque(),
            Self::InTorque => trip.into[1].torque(),
            Self::Guide => trip.out[0].guide_tension(),
            Self::Push => trip.into[0].largest_push(),
        }
    }

    /// Whether it is a torque; all others are forces.
    pub const fn is_torque(self) -> bool {
        matches!(self, Self::OutTorque | Self::InTorque)
    }
}

/// A depth with its results.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Depth of the bit below the kick-off (m).
    pub depth: f64,
    /// Hook load without friction (N); not a number where the figures are not known.
    pub weight: f64,
    /// Figures of the tool as configured, or why there are none.
    pub nominal: Result<Figures, String>,
    /// Ends of 90 % of the plausible tools, by [`FIGURES`]; none of too few.
    pub bands: [Option<Band>; FIGURES.len()],
    /// Plausible tools without a result.
    pub unknown: usize,
}

impl Row {
    /// A figure of the tool as configured.
    pub fn figure(&self, figure: Figure) -> Option<f64> {
        Some(self.nominal.as_ref().ok()?[figure as usize])
    }

    /// Its band.
    pub fn band(&self, figure: Figure) -> Option<Band> {
        self.bands[figure as usize]
    }
}

/// Why a study cannot be made. A depth without a result is part of it.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Nothing can be computed for the configuration.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// There are no plausible tools.
    #[error(transparent)]
    Unknowns(#[from] UnknownsError),
    /// A run cannot be kept, which none is.
    #[error(transparent)]
    Keep(#[from] KeepError),
}

/// A tool that makes the trip.
struct Run<'a> {
    assembly: Result<Assembly, String>,
    plan: &'a Plan,
}

impl Work for Run<'_> {
    /// Weight without friction and figures of each depth; not a number where there are none.
    type Found = Vec<f64>;

    fn cost(&self) -> f64 {
        1.0
    }

    /// A run takes less time than a file.
    fn kept_as(&self) -> Option<KeptAs> {
        None
    }

    fn run(&self, report: &mut impl FnMut(f64)) -> Result<Vec<f64>, String> {
        let assembly = self.assembly.as_ref().map_err(Clone::clone)?;
        let depths = &self.plan.depths;
        let mut figures = Vec::with_capacity(depths.len() * (FIGURES.len() + 1));
        for (index, &depth) in depths.iter().enumerate() {
            match assembly.trip(depth, self.plan.along, self.plan.spin) {
                Ok(trip) => {
                    figures.push(trip.weight);
                    figures.extend(FIGURES.map(|figure| figure.of(&trip)));
                }
                Err(_) => figures.extend([f64::NAN; FIGURES.len() + 1]),
            }
            report((index + 1) as f64 / depths.len() as f64);
        }
        Ok(figures)
    }

    fn figures(found: &Vec<f64>) -> Vec<f64> {
        found.clone()
    }

    fn found(figures: Vec<f64>) -> Option<Vec<f64>> {
        Some(figures)
    }
}

/// The plausible tools of a plan, or why one is none.
fn members(priors: &Priors, plan: &Plan) -> impl Iterator<Item = Result<Assembly, String>> {
    (0..plan.members).map(|number| {
        let drawn = priors
            .member(plan.seed, number as u64)
            .map_err(|error| error.to_string())?;
        Assembly::of(&drawn.config).map_err(|error| error.to_string())
    })
}

/// Computes all depths of a configuration and of plausible tools.
///
/// # Errors
/// When nothing can be computed for the configuration, or its priors cannot be drawn.
pub fn study(config: &Config, plan: &Plan, progress: impl FnMut(f64)) -> Result<Vec<Row>, StudyError> {
    let assembly = Assembly::of(config)?;
    let priors = priors(config)?;
    let runs: Vec<Run<'_>> = members(&priors, plan).map(|assembly| Run { assembly, plan }).collect();
    let members = run_all(&runs, plan.jobs, None, progress)?;
    let row = |(index, &depth): (usize, &f64)| {
        // The reason is that of the tool as configured; members without a result are counted.
        let nominal = assembly.trip(depth, plan.along, plan.spin);
        let of_member = |figure: usize| -> Vec<f64> {
            let at = index * (FIGURES.len() + 1) + 1 + figure;
            let known = members.iter().flatten().filter_map(|figures| figures.get(at).copied());
            known.filter(|value| value.is_finite()).collect()
        };
        Row {
            depth,
            weight: nominal.as_ref().map_or(f64::NAN, |trip| trip.weight),
            nominal: nominal
                .map(|trip| FIGURES.map(|figure| figure.of(&trip)))
                .map_err(|error| error.to_string()),
            bands: FIGURES.map(|figure| Band::of(of_member(figure as usize))),
            unknown: plan.members - of_member(0).len(),
        }
    };
    Ok(plan.depths.iter().enumerate().map(row).collect())
}
