//! From windows and surrogates to estimates.

use nalgebra::{DMatrix, DVector};

use crate::explain::{self, Explained, QuantityCheck};
use crate::identify::{CombinedPair, Estimate, identify};
use crate::noise::{ErrorSource, covariance};
use crate::random::Random;
use crate::sensor::Sensor;
use crate::smoother::{SmootherSettings, smooth, standard_normal};
use crate::surrogate::Surrogate;
use crate::unknown::Unknown;
use crate::windows::{Activity, Channel, Windows};
use crate::{BAND, CalibrationError};

/// Standardised value up to which the twin is run on both sides of the prior's median: 98.8 % of the prior.
pub const DESIGN: f64 = 2.5;

/// Members of the prior over which the covariance of the surrogates' errors is a mean. Where a variance differs by half
/// of itself from member to member, the mean of so many is known to an eighth.
const PRIOR_MEMBERS: usize = 16;

/// A measured quantity that the twin predicts.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// What is measured.
    pub channel: Channel,
    /// In which state of motion.
    pub motion: Activity,
    /// The modelled unknowns that the twin's runs in this state of motion depend on.
    pub acting: Vec<usize>,
    /// The twin's figure: inputs are the standardised unknowns of `acting`, then speed (rad/s) and, while drilling, weight (N).
    pub surrogate: Surrogate,
    /// What the sensor shows of that figure.
    pub sensor: Sensor,
}

/// A window's mean of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Number of the quantity.
    pub quantity: usize,
    /// Number of the window.
    pub window: usize,
    /// Middle of the window (s from the beginning of the log).
    pub time: f64,
    /// Speed (rad/s).
    pub rotary_speed: f64,
    /// Weight that the indicator shows (N).
    pub shown_weight: f64,
    /// Mean.
    pub value: f64,
    /// Standard deviation of the mean.
    pub scatter: f64,
}

/// Everything that is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The unknowns; those that the twin's runs depend on come first.
    pub unknowns: Vec<Unknown>,
    /// Number of unknowns that the twin's runs depend on.
    pub modelled: usize,
    /// Quantities.
    pub quantities: Vec<Predicted>,
    /// The weight indicator, which the weight of every load comes from.
    pub indicator: Sensor,
    /// Standard deviation of each channel's drift after an hour, in the order of [`Channel::ALL`].
    pub drift: [f64; Channel::COUNT],
    /// Error of the twin's figure of each channel that is another one in each window, as a share of what was measured (standard
    /// deviation). What all windows share is an unknown.
    pub discrepancy: [f64; Channel::COUNT],
    /// What was observed.
    pub observations: Vec<Observation>,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Per unknown.
    pub estimates: Vec<Estimate>,
    /// Pairs of which one combination is known only.
    pub pairs: Vec<CombinedPair>,
    /// Per observation.
    pub explained: Vec<Explained>,
    /// Per quantity that was observed.
    pub checks: Vec<QuantityCheck>,
    /// Mean square of the standardised residuals: about 1 or less where the twin explains the log.
    pub misfit: f64,
    /// The posterior ensemble of standardised unknowns, one column per member.
    pub posterior: DMatrix<f64>,
}

impl Outcome {
    /// Whether the twin explains the log within the stated errors.
    pub fn explains(&self) -> bool {
        self.misfit <= explain::EXPLAINS && self.checks.iter().all(QuantityCheck::is_explained)
    }
}

/// Why a channel is not used although it was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// No steady time off bottom: the offset of the torque sensor is not separable from friction and rock.
    NoOffBottomTorque,
}

impl Refusal {
    /// The reason in words.
    pub fn text(self) -> &'static str {
        match self {
            Self::NoOffBottomTorque => {
                "the log has no steady time off bottom with rotation, so the tare of the surface torque is not known: an \
                 offset of the sensor looks like friction or rock. Rotate off bottom for a minute, at the speed of drilling"
            }
        }
    }
}

/// Channels that are refused although drilling windows have them.
pub fn refusals(windows: &Windows) -> Vec<(Channel, Refusal)> {
    let channel = Channel::SurfaceTorque;
    let drilled = windows.having(Activity::Drilling, channel).next().is_some();
    let tared = windows.having(Activity::OffBottom, channel).next().is_some();
    if drilled && !tared {
        vec![(channel, Refusal::NoOffBottomTorque)]
    } else {
        Vec::new()
    }
}

/// The observations of all windows, without channels that are refused.
pub fn observations(windows: &Windows, quantities: &[Predicted]) -> Vec<Observation> {
    let refused = refusals(windows);
    let mut all = Vec::new();
    for (index, window) in windows.steady.iter().enumerate() {
        for (number, quantity) in quantities.iter().enumerate() {
            if quantity.motion != window.motion || refused.iter().any(|(channel, _)| *channel == quantity.channel) {
                continue;
            }
            if let Some(mean) = window.measured[quantity.channel as usize] {
                all.push(Observation {
                    quantity: number,
                    window: index,
                    time: 0.5 * (window.span[0] + window.span[1]),
                    rotary_speed: window.rotary_speed,
                    shown_weight: window.weight,
                    value: mean.value,
                    scatter: mean.scatter,
                });
            }
        }
    }
    all
}

/// The loads that a surrogate of a state of motion has as inputs.
pub fn load(motion: Activity, rotary_speed: f64, weight: f64) -> Vec<f64> {
    match motion {
        Activity::OffBottom => vec![rotary_speed.abs()],
        Activity::Drilling => vec![rotary_speed.abs(), weight],
    }
}

impl Predicted {
    /// Correlation of the surrogates' errors of two quantities, from the runs that were left out.
    fn errors_alike(&self, other: &Self) -> f64 {
        let [a, b] = [self, other].map(|quantity| &quantity.surrogate.left_out);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let size = (product(a, a) * product(b, b)).sqrt();
        match (a.len() == b.len(), size > 0.0) {
            (true, true) => product(a, b) / size,
            _ => 0.0,
        }
    }
}

/// The correlations of a covariance; without a variance, nothing depends on anything.
fn correlations(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |i, j| {
        let size = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        match (size > 0.0, i == j) {
            (true, _) => covariance[(i, j)] / size,
            (false, same) => f64::from(u8::from(same)),
        }
    })
}

impl Problem {
    /// The predictions of all observations from standardised unknowns.
    pub fn predict(&self, z: &[f64]) -> Vec<f64> {
        let of = |unknown: usize| self.unknowns[unknown].value(z[unknown]);
        self.observations
            .iter()
            .map(|observation| {
                let quantity = &self.quantities[observation.quantity];
                let figure = quantity.surrogate.predict(&self.inputs(z, observation));
                quantity.sensor.shows(figure, of)
            })
            .collect()
    }

    /// The weight (N) that acts where the indicator shows one, with standardised unknowns.
    pub fn acting_weight(&self, z: &[f64], shown: f64) -> f64 {
        self.indicator
            .acting(shown, |unknown| self.unknowns[unknown].value(z[unknown]))
    }

    /// What the sensor of a quantity shows of a figure of the twin, with standardised unknowns.
    pub fn shown(&self, z: &[f64], quantity: usize, figure: f64) -> f64 {
        let of = |unknown: usize| self.unknowns[unknown].value(z[unknown]);
        self.quantities[quantity].sensor.shows(figure, of)
    }

    /// Inputs of the surrogate of an observation.
    fn inputs(&self, z: &[f64], observation: &Observation) -> Vec<f64> {
        let quantity = &self.quantities[observation.quantity];
        let weight = self.acting_weight(z, observation.shown_weight);
        let mut inputs: Vec<f64> = quantity.acting.iter().map(|unknown| z[*unknown]).collect();
        inputs.extend(load(quantity.motion, observation.rotary_speed, weight));
        inputs
    }

    /// The standard deviation of the surrogate's error of an observation, at standardised unknowns.
    pub fn surrogate_deviation(&self, z: &[f64], observation: usize) -> f64 {
        let observation = &self.observations[observation];
        let surrogate = &self.quantities[observation.quantity].surrogate;
        surrogate.deviation(&self.inputs(z, observation))
    }

    /// The covariance of the errors of all observations: of what is measured, and of the surrogates.
    ///
    /// # Errors
    /// When a number of an observation cannot be.
    pub fn covariance(&self, seed: u64) -> Result<DMatrix<f64>, CalibrationError> {
        let sources: Vec<ErrorSource> = self
            .observations
            .iter()
            .map(|observation| {
                let channel = self.quantities[observation.quantity].channel as usize;
                ErrorSource {
                    sensor: channel,
                    time: observation.time.max(0.0),
                    scatter: observation.scatter,
                    drift_in_an_hour: self.drift[channel],
                }
            })
            .collect();
        let prior = standard_normal(self.unknowns.len(), PRIOR_MEMBERS, &mut Random::new(seed));
        Ok(covariance(&sources)? + self.surrogate_errors(&prior) + self.discrepancies())
    }

    /// The covariance of the twin's own errors, as shares of what was measured.
    fn discrepancies(&self) -> DMatrix<f64> {
        let of = |observation: &Observation| {
            let channel = self.quantities[observation.quantity].channel;
            (self.discrepancy[channel as usize] * observation.value).powi(2)
        };
        DMatrix::from_diagonal(&DVector::from_iterator(
            self.observations.len(),
            self.observations.iter().map(of),
        ))
    }

    /// The covariance of the surrogates' errors, as a mean over members of standardised unknowns, one column each. The
    /// unknowns are the same at all loads of a log, so that the errors of its windows depend on each other as the
    /// processes say. Quantities of one state of motion come from the same runs: their errors depend on each other as
    /// those of the runs that were left out. The mean of the correlations over the quantities, times the correlations
    /// of these, is again a correlation (a product of two by elements).
    fn surrogate_errors(&self, members: &DMatrix<f64>) -> DMatrix<f64> {
        let count = self.observations.len();
        let mut all = DMatrix::zeros(count, count);
        for motion in [Activity::OffBottom, Activity::Drilling] {
            let of_motion: Vec<usize> = (0..count)
                .filter(|k| self.quantities[self.observations[*k].quantity].motion == motion)
                .collect();
            let mut quantities: Vec<usize> = of_motion.iter().map(|k| self.observations[*k].quantity).collect();
            quantities.sort_unstable();
            quantities.dedup();
            let mut between_loads = DMatrix::zeros(of_motion.len(), of_motion.len());
            let mut deviations = vec![0.0; of_motion.len()];
            for &number in &quantities {
                let surrogate = &self.quantities[number].surrogate;
                let mut mean = DMatrix::zeros(of_motion.len(), of_motion.len());
                for member in members.column_iter() {
                    let z: Vec<f64> = member.iter().copied().collect();
                    let at: Vec<Vec<f64>> = of_motion
                        .iter()
                        .map(|k| self.inputs(&z, &self.observations[*k]))
                        .collect();
                    mean += surrogate.error_covariance(&at) / members.ncols() as f64;
                }
                for (row, k) in of_motion.iter().enumerate() {
                    if self.observations[*k].quantity == number {
                        deviations[row] = mean[(row, row)].sqrt();
                    }
                }
                between_loads += correlations(&mean) / quantities.len() as f64;
            }
            for (row, i) in of_motion.iter().enumerate() {
                for (column, j) in of_motion.iter().enumerate() {
                    let [a, b] = [i, j].map(|k| self.observations[*k].quantity);
                    let alike = self.quantities[a].errors_alike(&self.quantities[b]);
                    all[(*i, *j)] = alike * between_loads[(row, column)] * deviations[row] * deviations[column];
                }
            }
        }
        all
    }

    /// Fits the unknowns to the observations.
    ///
    /// # Errors
    /// When nothing was observed, or a number cannot be.
    pub fn fit(&self, settings: &SmootherSettings) -> Result<Outcome, CalibrationError> {
        if self.observations.is_empty() {
            return Err(CalibrationError::NothingObserved);
        }
        let observed: Vec<f64> = self.observations.iter().map(|observation| observation.value).collect();
        let errors = self.covariance(settings.seed)?;
        let posterior = smooth(self.unknowns.len(), &observed, &errors, settings, |z| self.predict(z))?;
        let (estimates, pairs) = identify(&self.unknowns, &posterior);
        let prior = self.predict(&vec![0.0; self.unknowns.len()]);
        // Each member is predicted by itself: the surrogate is not linear, so that the mean of the figures is not that of the
        // values.
        let members: Vec<Vec<f64>> = posterior
            .column_iter()
            .map(|member| self.predict(&member.iter().copied().collect::<Vec<_>>()))
            .collect();
        let count = members.len() as f64;
        let explained: Vec<Explained> = (0..observed.len())
            .map(|k| {
                let predicted = members.iter().map(|member| member[k]).sum::<f64>() / count;
                let spread = members
                    .iter()
                    .map(|member| (member[k] - predicted).powi(2))
                    .sum::<f64>()
                    / count;
                // A measurement scatters about the members by its error too.
                let deviation = (spread + errors[(k, k)]).sqrt();
                Explained {
                    prior: prior[k],
                    predicted,
                    band: BAND * deviation,
                    standardised: (observed[k] - predicted) / deviation,
                }
            })
            .collect();
        // A quantity is judged by what is left of it after the fit.
        let residuals: Vec<f64> = observed
            .iter()
            .zip(&explained)
            .map(|(observed, explained)| observed - explained.predicted)
            .collect();
        let quantity_of: Vec<usize> = self
            .observations
            .iter()
            .map(|observation| observation.quantity)
            .collect();
        let checks = explain::check(&quantity_of, &residuals, &errors, &explained);
        let squares: f64 = explained.iter().map(|explained| explained.standardised.powi(2)).sum();
        Ok(Outcome {
            estimates,
            pairs,
            misfit: squares / observed.len() as f64,
            checks,
            explained,
            posterior,
        })
    }
}
