//! The whole calibration of a log.

pub mod check;
pub mod overlay;
pub mod point;
pub mod points;
pub mod posterior;
pub mod unknowns;

use crate::CalibrationError;
use crate::fit::{Outcome, Predicted, Problem, Refusal, observations, refusals};
use crate::smoother::SmootherSettings;
use crate::surrogate::{Surrogate, usual_points};
use crate::unknown::Unknown;
use crate::windows::{Activity, Channel, Window, Windows};
use check::{Checked, Objection, check, objections};
use flexdrill_config::Config;
use flexdrill_core::units::kn_to_n;
use points::{Cover, Point};
use unknowns::Unknowns;

/// Least half width of the speeds of a design, as a share of their mean, and of the weights: without a range there is no
/// slope.
const SPREAD: f64 = 0.1;

/// How a log is calibrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StudySettings {
    /// Threads.
    pub jobs: usize,
    /// Seed of design, ensemble and perturbations.
    pub seed: u64,
    /// Members of the ensemble.
    pub members: usize,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Study {
    /// What was fitted.
    pub unknowns: Unknowns,
    /// The windows of the log.
    pub windows: Windows,
    /// Channels that are not used, and why.
    pub refused: Vec<(Channel, Refusal)>,
    /// Points whose run gave no figure, and why.
    pub failed: Vec<String>,
    /// The problem that was solved.
    pub problem: Problem,
    /// Its solution.
    pub outcome: Outcome,
    /// Full runs at the posterior's centre and at some of its members.
    pub checked: Vec<Checked>,
}

impl Study {
    /// Why the values are not to be used; none where they may be.
    pub fn objections(&self) -> Vec<Objection> {
        objections(self)
    }

    /// Value per modelled unknown: what was found, the configured value where the data do not determine it.
    pub fn values(&self) -> Vec<f64> {
        let estimates = self.outcome.estimates.iter().take(self.unknowns.modelled.len());
        estimates.map(|estimate| estimate.value).collect()
    }
}

/// Ranges of speed and weight that the points of a state of motion cover, from the windows.
///
/// `None` without a window in that state.
pub fn cover(windows: &Windows, motion: Activity, unknowns: usize) -> Option<Cover> {
    let of = |of: fn(&Window) -> f64| {
        let all = windows.steady.iter().filter(|window| window.motion == motion).map(of);
        let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
        let middle = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max(SPREAD * middle);
        [middle - half, middle + half]
    };
    let rotary_speed = of(|window| window.rotary_speed.abs());
    rotary_speed[0].is_finite().then(|| {
        let loads = crate::fit::load(motion, 1.0, 1.0).len();
        Cover {
            motion,
            rotary_speed,
            weight: of(|window| window.weight),
            points: usual_points(unknowns + loads),
        }
    })
}

/// What is fitted with: the surrogates of every state of motion and channel that the windows have.
fn quantities(windows: &Windows, points: &[Point], unknowns: &Unknowns) -> Result<Vec<Predicted>, CalibrationError> {
    let modelled = unknowns.modelled.len();
    let mut all = Vec::new();
    for motion in [Activity::OffBottom, Activity::Drilling] {
        for channel in Channel::ALL {
            let off_bottom_of_the_bit =
                motion == Activity::OffBottom && matches!(channel, Channel::BitTorque | Channel::BitWeight);
            // Off bottom the bit carries nothing, whatever the coefficients are.
            if off_bottom_of_the_bit || windows.having(motion, channel).next().is_none() {
                continue;
            }
            let (mut inputs, mut results) = (Vec::new(), Vec::new());
            // Each state of motion has its own surrogates: the bit changes the torque's dependence on everything.
            for point in points.iter().filter(|point| point.load.motion == motion) {
                // A point whose run failed is left out; the design has points to spare.
                if let Some(Ok(figures)) = &point.found
                    && figures[channel as usize].is_finite()
                {
                    inputs.push(point.inputs());
                    results.push(figures[channel as usize]);
                }
            }
            // A tool without this figure, such as a hook load without a string.
            if results.is_empty() {
                continue;
            }
            let state = match motion {
                Activity::OffBottom => "off bottom",
                Activity::Drilling => "while drilling",
            };
            let name = format!("{} {state}", channel.name_and_unit().0);
            all.push(Predicted {
                channel,
                motion,
                // The surrogate is fitted to the figures without tare, which is added afterwards as its own unknown.
                surrogate: Surrogate::new(&name, &inputs, &results)?,
                tare: match channel {
                    Channel::SurfaceTorque => Some(modelled),
                    Channel::HookLoad => Some(modelled + 1),
                    Channel::BitTorque | Channel::BitWeight => None,
                },
            });
        }
    }
    Ok(all)
}

/// The problem of windows and points.
///
/// # Errors
/// When the points do not determine a surrogate.
pub fn problem(
    config: &Config,
    unknowns: &Unknowns,
    windows: &Windows,
    points: &[Point],
) -> Result<Problem, CalibrationError> {
    let quantities = quantities(windows, points, unknowns)?;
    let mut all: Vec<Unknown> = unknowns
        .modelled
        .iter()
        .map(|modelled| modelled.unknown.clone())
        .collect();
    all.extend([unknowns.torque_tare.clone(), unknowns.hook_load_tare.clone()]);
    let settings = &config.calibration;
    Ok(Problem {
        unknowns: all,
        modelled: unknowns.modelled.len(),
        observations: observations(windows, &quantities),
        quantities,
        drift: [settings.torque_drift_nm, kn_to_n(settings.hook_load_drift_kn), 0.0, 0.0],
    })
}

/// Fits a configuration to windows with points that have been run, and checks the result by full runs.
///
/// # Errors
/// When nothing can be fitted.
pub fn study(
    config: &Config,
    unknowns: Unknowns,
    windows: Windows,
    points: &[Point],
    settings: &StudySettings,
) -> Result<Study, CalibrationError> {
    let problem = problem(config, &unknowns, &windows, points)?;
    let smoother = SmootherSettings {
        members: settings.members,
        seed: settings.seed,
        ..SmootherSettings::default()
    };
    let outcome = problem.fit(&smoother)?;
    let failed = points
        .iter()
        .filter_map(|point| point.found.as_ref()?.as_ref().err().cloned());
    let mut study = Study {
        refused: refusals(&windows),
        failed: failed.collect(),
        checked: Vec::new(),
        unknowns,
        windows,
        problem,
        outcome,
    };
    study.checked = check(config, &study, settings.jobs);
    Ok(study)
}
