//! What was found, checked by full runs of the twin: whether the surrogates that the fit used are as good as they say
//! where it ended, and whether the twin itself then explains the log.

use std::fmt;

use super::Study;
use super::overlay::shown;
use super::point;
use super::point::Load;
use super::points::{self, Point};
use crate::BAND;
use crate::explain::EXPLAINS;
use crate::windows::{Activity, Channel};
use flexdrill_config::Config;

/// Largest number of loads that are checked, in each state of motion.
const LOADS: usize = 3;
/// Members of the posterior that are checked besides its centre.
const MEMBERS: usize = 2;
/// Mean square of the standardised differences of one quantity above which full runs speak against the values: three
/// times the stated error. Of three independent differences it is above in one of 20,000 calibrations; with
/// [`EXPLAINS`] it would be in one of 140, and there are six quantities.
const OF_ONE: f64 = 9.0;

/// Standard deviations of its prior from which on the mean of an unknown's posterior speaks against the values: a prior has
/// one value of a thousand there, and the posterior is nearer to its middle than the truth is.
const FARTHEST: f64 = 3.3;

/// Unknowns with which a full run was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// The medians of the posterior.
    Centre,
    /// A member of the posterior.
    Member(usize),
}

/// A full run of the twin with what was found, against the log.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Window of the log.
    pub window: usize,
    /// Quantity.
    pub channel: Channel,
    /// With which unknowns.
    pub at: At,
    /// Mean of the log (SI).
    pub measured: f64,
    /// What the sensor shows of the twin's figure in a full run, or why there is none.
    pub run: Result<f64, String>,
    /// The surrogate's, with the same unknowns.
    pub surrogate: f64,
    /// Half of the 90 % band of the measurement.
    pub band: f64,
    /// Half of the 90 % band of the run less the surrogate: the surrogate's error, and the scatter of the window.
    pub surrogate_band: f64,
}

impl Checked {
    /// The log less the full run, over its standard deviation.
    fn unexplained(&self) -> Option<f64> {
        let run = self.run.as_ref().ok()?;
        Some(BAND * (self.measured - run) / self.band)
    }

    /// The full run less the surrogate, over its standard deviation.
    fn misled(&self) -> Option<f64> {
        let run = self.run.as_ref().ok()?;
        Some(BAND * (run - self.surrogate) / self.surrogate_band)
    }
}

/// Why the values of a calibration are not to be used.
#[derive(Debug, Clone, PartialEq)]
pub enum Objection {
    /// The residuals of the fit are so many times their stated errors (root mean square).
    Unexplained {
        /// How many times.
        times: f64,
    },
    /// The residuals of one quantity are so many times their stated errors (root mean square, with the correlation of these).
    QuantityUnexplained {
        /// Quantity.
        channel: Channel,
        /// State of motion.
        motion: Activity,
        /// Windows in which it was measured.
        windows: usize,
        /// How many times.
        times: f64,
        /// Bound of that.
        most: f64,
        /// Rows of the window with the largest residual over its error.
        rows: [u64; 2],
        /// What was measured in it less what the twin computes (SI).
        residual: f64,
    },
    /// An unknown was found so far from what was expected that the prior hardly has such values.
    BeyondPrior {
        /// The unknown.
        name: String,
        /// Its value (SI).
        value: f64,
        /// Ends of the 90 % that were expected (SI).
        expected: [f64; 2],
        /// Standard deviations of the prior from its middle.
        deviations: f64,
    },
    /// Full runs differ from the surrogates by so many times the stated errors.
    Misled {
        /// Quantity, where one alone differs.
        channel: Option<Channel>,
        /// How many times.
        times: f64,
    },
    /// Full runs with what was found differ from the log by so many times the stated errors.
    RunsDiffer {
        /// Quantity, where one alone differs.
        channel: Option<Channel>,
        /// How many times.
        times: f64,
    },
    /// A full run with what was found has no figure.
    NoRun {
        /// Why.
        problem: String,
    },
}

impl Objection {
    /// As in the results for other programs.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Unexplained { .. } | Self::QuantityUnexplained { .. } => "unexplained",
            Self::BeyondPrior { .. } => "beyond_prior",
            Self::Misled { .. } => "surrogate_misled",
            Self::RunsDiffer { .. } => "full_runs_differ",
            Self::NoRun { .. } => "no_full_run",
        }
    }
}

impl fmt::Display for Objection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = |channel: &Option<Channel>| match channel {
            Some(channel) => format!(" in {}", channel.name_and_unit().0),
            None => String::new(),
        };
        match self {
            // What a reader can do comes last in each sentence.
            Self::Unexplained { times } => write!(
                f,
                "the twin does not explain the log: the residuals are {times:.1} times their stated errors (root mean \
                 square). The values fit this configuration to another tool or another well, or a sensor is wrong"
            ),
            Self::QuantityUnexplained {
                channel,
                motion,
                windows,
                times,
                most,
                rows: [first, last],
                residual,
            } => {
                // In the unit of the rig's display, since the log is to be looked at.
                let (unit, factor) = shown(*channel);
                write!(
                    f,
                    "the twin does not explain the {} {}: the residuals of {windows} windows are {times:.1} times their stated \
                     errors (root mean square; at most {most:.1}). The largest is {:+.3} {unit}, measured less computed, in \
                     rows {first} to {last}. No values of what is fitted describe this tool in this well, or that sensor is \
                     wrong",
                    channel.name_and_unit().0,
                    match motion {
                        Activity::OffBottom => "off bottom",
                        Activity::Drilling => "while drilling",
                    },
                    factor * residual
                )
            }
            Self::BeyondPrior {
                name,
                value,
                expected: [low, high],
                deviations,
            } => write!(
                f,
                "{name} was found at {value:.4}, {deviations:.1} standard deviations from the middle of what is expected \
                 ({low:.4} to {high:.4}, SI, 90 %). It stands for something else that the fit does not have, such as another \
                 rock; or state a wider range, if such a value is possible"
            ),
            // The surrogate is wrong here, and below it the tool itself.
            Self::Misled { channel, times } => write!(
                f,
                "full runs of the twin with what was found differ from the surrogate that was fitted{} by {times:.1} times \
                 the stated errors (root mean square), so that the bands are too narrow. Calibrate with parts of the log \
                 whose weights are nearer to each other",
                of(channel)
            ),
            Self::RunsDiffer { channel, times } => write!(
                f,
                "full runs of the twin with what was found differ from the log{} by {times:.1} times the stated errors \
                 (root mean square). The values do not describe this tool in this well",
                of(channel)
            ),
            Self::NoRun { problem } => write!(
                f,
                "a full run of the twin with what was found gave no figure, so that nothing confirms the values: {problem}"
            ),
        }
    }
}

/// What speaks against the values, the fit itself first.
pub(super) fn objections(study: &Study) -> Vec<Objection> {
    let mut all = Vec::new();
    if study.outcome.misfit > EXPLAINS {
        all.push(Objection::Unexplained {
            times: study.outcome.misfit.sqrt(),
        });
    }
    for check in study.outcome.checks.iter().filter(|check| !check.is_explained()) {
        let (quantity, worst) = (&study.problem.quantities[check.quantity], check.worst);
        let observation = &study.problem.observations[worst];
        all.push(Objection::QuantityUnexplained {
            channel: quantity.channel,
            motion: quantity.motion,
            windows: check.windows,
            times: check.times,
            most: check.most,
            rows: study.windows.steady[observation.window].rows,
            residual: observation.value - study.outcome.explained[worst].predicted,
        });
    }
    all.extend(beyond_prior(study));
    if let Some((channel, times)) = beyond(&study.checked, Checked::misled) {
        all.push(Objection::Misled { channel, times });
    }
    let at_centre: Vec<Checked> = study
        .checked
        .iter()
        .filter(|checked| checked.at == At::Centre)
        .cloned()
        .collect();
    if let Some((channel, times)) = beyond(&at_centre, Checked::unexplained) {
        all.push(Objection::RunsDiffer { channel, times });
    }
    if let Some(problem) = at_centre.iter().find_map(|checked| checked.run.as_ref().err()) {
        all.push(Objection::NoRun {
            problem: problem.clone(),
        });
    }
    all
}

/// Unknowns that ran away from what was expected of them.
fn beyond_prior(study: &Study) -> impl Iterator<Item = Objection> {
    let middles: Vec<f64> = study.outcome.posterior.row_iter().map(|row| row.mean()).collect();
    let known = study.problem.unknowns.iter().zip(&study.outcome.estimates);
    let beyond = known.zip(middles).filter(|(_, middle)| middle.abs() > FARTHEST);
    beyond.map(|((unknown, estimate), middle)| Objection::BeyondPrior {
        name: unknown.name.clone(),
        value: estimate.value,
        expected: unknown.prior(),
        deviations: middle.abs(),
    })
}

/// The root mean square of standardised differences, of all or of the worst quantity, where it is beyond its bound.
fn beyond(checked: &[Checked], of: impl Fn(&Checked) -> Option<f64>) -> Option<(Option<Channel>, f64)> {
    let mean_square = |channel: Option<Channel>| {
        let some = checked
            .iter()
            .filter(|checked| channel.is_none_or(|channel| checked.channel == channel));
        let squares: Vec<f64> = some.filter_map(&of).map(|difference| difference * difference).collect();
        squares.iter().sum::<f64>() / squares.len().max(1) as f64
    };
    let all = mean_square(None);
    if all > EXPLAINS {
        return Some((None, all.sqrt()));
    }
    let each = Channel::ALL
        .into_iter()
        .map(|channel| (channel, mean_square(Some(channel))));
    let (channel, most) = each.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    (most > OF_ONE).then(|| (Some(channel), most.sqrt()))
}

/// Windows that are checked: in each state of motion those of the least, the middle and the largest load.
fn chosen(study: &Study) -> Vec<usize> {
    let mut chosen = Vec::new();
    for motion in [Activity::OffBottom, Activity::Drilling] {
        let mut of_motion: Vec<usize> = study
            .problem
            .observations
            .iter()
            .map(|observation| observation.window)
            .filter(|window| study.windows.steady[*window].motion == motion)
            .collect();
        of_motion.dedup();
        let load = |window: &usize| {
            let window = &study.windows.steady[*window];
            (window.weight, window.rotary_speed)
        };
        of_motion.sort_by(|a, b| load(a).partial_cmp(&load(b)).unwrap_or(std::cmp::Ordering::Equal));
        let last = of_motion.len().saturating_sub(1);
        let mut some: Vec<usize> = (0..LOADS)
            .filter_map(|k| of_motion.get(k * last / (LOADS - 1)).copied())
            .collect();
        some.dedup();
        chosen.extend(some);
    }
    chosen
}

/// Full runs at what was found and at some members, for some windows of each state of motion.
pub(super) fn check(config: &Config, study: &Study, jobs: usize) -> Vec<Checked> {
    // A few windows suffice, because a full run takes minutes; they spread over the loads.
    let chosen = chosen(study);
    let modelled = study.unknowns.modelled.len();
    // Standardised values are what the points and the surrogates take.
    let centre: Vec<f64> = study
        .problem
        .unknowns
        .iter()
        .zip(&study.outcome.estimates)
        .map(|(unknown, estimate)| unknown.standard(estimate.value))
        .collect();
    let mut places = vec![(At::Centre, centre)];
    // The members are independent of each other: the first ones are as good as any.
    for (number, member) in study.outcome.posterior.column_iter().take(MEMBERS).enumerate() {
        places.push((At::Member(number), member.iter().copied().collect()));
    }
    let mut wanted = Vec::new();
    for (at, z) in &places {
        for &window in &chosen {
            let of_log = &study.windows.steady[window];
            // Unknowns of the model alone: those of sensors act on the measurement and on the weight.
            let point = Point {
                z: z[..modelled].to_vec(),
                load: Load {
                    motion: of_log.motion,
                    // The sign is the direction of rotation, which the model does not distinguish.
                    rotary_speed: of_log.rotary_speed.abs(),
                    // Off bottom the log's weight is that of its sensor's error.
                    weight: match of_log.motion {
                        Activity::OffBottom => 0.0,
                        // The indicator's errors are among what was found.
                        Activity::Drilling => study.problem.acting_weight(z, of_log.weight),
                    },
                },
                found: None,
            };
            wanted.push((*at, z, window, point));
        }
    }
    // All runs together, so that the threads are used to the end.
    let open = wanted.iter().map(|(.., point)| point.clone()).collect();
    let run = points::run(config, &study.unknowns, open, jobs, |_, _| {});
    let mut checked = Vec::new();
    for ((at, z, window, _), point) in wanted.iter().zip(&run) {
        // Once per place: the prediction is for all observations at the same time.
        let predicted = study.problem.predict(z);
        for (index, observation) in study.problem.observations.iter().enumerate() {
            if observation.window != *window {
                continue;
            }
            let quantity = &study.problem.quantities[observation.quantity];
            let found: Result<point::Figures, String> = point
                .found
                .clone()
                .unwrap_or_else(|| Err("the run did not take place".to_owned()));
            let deviation = study.problem.surrogate_deviation(z, index);
            checked.push(Checked {
                window: *window,
                channel: quantity.channel,
                at: *at,
                measured: observation.value,
                // The run has no sensor, and the measurement has one.
                run: found.map(|figures| {
                    let figure = figures[quantity.channel as usize];
                    study.problem.shown(z, observation.quantity, figure)
                }),
                surrogate: predicted[index],
                band: study.outcome.explained[index].band,
                // The band of a difference: both errors are independent.
                surrogate_band: BAND * deviation.hypot(observation.scatter),
            });
        }
    }
    checked
}
