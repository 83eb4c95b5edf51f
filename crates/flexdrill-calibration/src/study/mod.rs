//! The whole calibration of a log.

pub mod check;
pub mod overlay;
pub mod point;
pub mod points;
pub mod posterior;
pub mod unknowns;

use crate::CalibrationError;
use crate::fit::{Outcome, Predicted, Problem, Refusal, observations, refusals};
use crate::sensor::LEAST_WEIGHT;
use crate::smoother::SmootherSettings;
use crate::surrogate::{Surrogate, usual_points};
use crate::windows::{Activity, Channel, Window, Windows};
use check::{Checked, Objection, check, objections};
use flexdrill_config::Config;
use flexdrill_core::units::kn_to_n;
use points::{Cover, Point};
use unknowns::Unknowns;
use unknowns::sensors::Of;

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

/// Ranges of speed and weight that the points of a state of motion cover: those of the windows, and of the weights that may
/// act where the indicator shows these.
///
/// `None` without a window in that state.
pub fn cover(config: &Config, unknowns: &Unknowns, windows: &Windows, motion: Activity) -> Option<Cover> {
    let range = |of: fn(&Window) -> f64| {
        let all = windows.steady.iter().filter(|window| window.motion == motion).map(of);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        })
    };
    let with_a_slope = |[low, high]: [f64; 2]| {
        let middle = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max(SPREAD * middle);
        [middle - half, middle + half]
    };
    let rotary_speed = with_a_slope(range(|window| window.rotary_speed.abs()));
    let most = kn_to_n(config.inputs.weight_on_bit.max_kn);
    let weight = match motion {
        Activity::OffBottom => [0.0; 2],
        Activity::Drilling => unknowns
            .acting_range(with_a_slope(range(|window| window.weight)))
            .map(|weight| weight.min(most).max(LEAST_WEIGHT)),
    };
    rotary_speed[0].is_finite().then(|| {
        let loads = crate::fit::load(motion, 1.0, 1.0).len();
        Cover {
            motion,
            rotary_speed,
            weight,
            points: usual_points(unknowns.acting(motion).len() + loads),
        }
    })
}

/// The figures of the points of a state of motion in a channel, with the inputs of the surrogate.
fn results(points: &[Point], acting: &[usize], motion: Activity, channel: Channel) -> (Vec<Vec<f64>>, Vec<f64>) {
    let (mut inputs, mut results) = (Vec::new(), Vec::new());
    // Each state of motion has its own surrogates: the bit changes the torque's dependence on everything.
    for point in points.iter().filter(|point| point.load.motion == motion) {
        // A point whose run failed is left out; the design has points to spare.
        if let Some(Ok(figures)) = &point.found
            && figures[channel as usize].is_finite()
        {
            inputs.push(point.inputs(acting));
            results.push(figures[channel as usize]);
        }
    }
    (inputs, results)
}

/// The hook load of a tool that hangs (N): off bottom it depends on the unknowns by some newtons. Without such runs it is
/// that of drilling with the weight that is slacked off.
fn hanging(points: &[Point]) -> f64 {
    let of = |motion: Activity| {
        let all = points.iter().filter(move |point| point.load.motion == motion);
        let loads = all.filter_map(|point| match &point.found {
            Some(Ok(figures)) => Some(figures[Channel::HookLoad as usize] + point.load.weight),
            _ => None,
        });
        let known: Vec<f64> = loads.filter(|load| load.is_finite()).collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    };
    of(Activity::OffBottom)
        .or_else(|| of(Activity::Drilling))
        .unwrap_or(0.0)
}

/// What is fitted with: the surrogates of every state of motion and channel that the windows have.
fn quantities(windows: &Windows, points: &[Point], unknowns: &Unknowns) -> Result<Vec<Predicted>, CalibrationError> {
    let hanging = hanging(points);
    let mut all = Vec::new();
    for motion in [Activity::OffBottom, Activity::Drilling] {
        let acting = unknowns.acting(motion);
        for channel in Channel::ALL {
            // Off bottom the bit carries nothing, whatever the coefficients are.
            let nothing_to_see = motion == Activity::OffBottom && channel.is_of_the_bit();
            if nothing_to_see || windows.having(motion, channel).next().is_none() {
                continue;
            }
            let (inputs, results) = results(points, &acting, motion, channel);
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
                acting: acting.clone(),
                // The surrogate is fitted to the figures as they are; what the sensor makes of them is added afterwards.
                surrogate: Surrogate::new(&name, &inputs, &results)?,
                sensor: unknowns.sensor(Of::Channel(channel), hanging),
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
    let settings = &config.calibration;
    let stated = config
        .uncertainty
        .as_ref()
        .map(|stated| stated.sensors)
        .unwrap_or_default();
    let mut drift = [0.0; Channel::COUNT];
    drift[Channel::SurfaceTorque as usize] = settings.torque_drift_nm;
    drift[Channel::HookLoad as usize] = kn_to_n(settings.hook_load_drift_kn);
    drift[Channel::BitTorque as usize] = stated.downhole_torque.drift_nm;
    drift[Channel::BitWeight as usize] = kn_to_n(stated.downhole_weight.drift_kn);
    let mut discrepancy = [0.0; Channel::COUNT];
    // A half of the variance; the other half is an unknown that all windows share.
    discrepancy[Channel::RateOfPenetration as usize] = settings.rate_of_penetration_error / 2.0_f64.sqrt();
    Ok(Problem {
        unknowns: unknowns.all(),
        modelled: unknowns.modelled.len(),
        observations: observations(windows, &quantities),
        quantities,
        indicator: unknowns.sensor(Of::Indicator, 0.0),
        drift,
        discrepancy,
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
