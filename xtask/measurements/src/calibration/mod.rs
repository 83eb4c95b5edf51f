//! `--cases calibration`: how often the bands of a calibration hold the truth. The truth comes from full runs of the
//! twin with unknowns and loads that the design has not seen; to their figures come the noise, the drift, the factors and
//! the tares of a rig's sensors, its weight indicator with them. The weights of every log lie on both sides of the one at
//! which the bit begins to cut.

use std::f64::consts::TAU;
use std::path::PathBuf;

use anyhow::Context as _;
use flexdrill_bench::table::Table;
use flexdrill_calibration::fit::{Outcome, Problem};
use flexdrill_calibration::identify::Verdict;
use flexdrill_calibration::sensor::LEAST_WEIGHT;
use flexdrill_calibration::smoother::SmootherSettings;
use flexdrill_calibration::study::check::{Checked, Objection};
use flexdrill_calibration::study::point::{Figures, Load};
use flexdrill_calibration::study::points::{self, Cover, Point, design};
use flexdrill_calibration::study::unknowns::sensors::Of;
use flexdrill_calibration::study::unknowns::{Modelled, Unknowns};
use flexdrill_calibration::study::{StudySettings, study};
use flexdrill_calibration::surrogate::usual_points;
use flexdrill_calibration::windows::{Activity, Channel, Sample, WindowSettings, Windows, find};
use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, m_per_s_to_m_per_h, n_to_kn, rad_per_s_to_rpm, rpm_to_rad_per_s};

/// Speeds (r/min) of design and logs.
const SPEEDS: [f64; 2] = [35.0, 65.0];
/// Weights at the surface of the logs, over the configured force of the wear flats. At 1 no usual tool cuts; at 2.2 each does
/// that passes on half. The design covers what an indicator may show of them.
const WEIGHTS: [f64; 2] = [1.0, 2.2];
/// Parts of a log in which the bit drills, each with a weight of its own fifth of the range, and their duration (s).
const DRILLING: usize = 5;
const DRILLING_TIME: u32 = 200;
/// Duration of rotation off bottom (s) at the begin and at the end of a log.
const OFF_BOTTOM_TIME: u32 = 90;
/// Noise from second to second of a sub above the bit (N m, N); it is tared in the hole and does not drift.
const IN_THE_HOLE: [f64; 2] = [10.0, 400.0];
/// Noise of the rate of penetration from second to second (m/s): 1.8 m/h, a block that is read to 5 mm over ten seconds.
const RATE_NOISE: f64 = 5e-4;
/// Standardised unknowns of the truth: beyond this lie 5 % of the prior.
const TRUTH: f64 = 2.0;
/// Seed of the design. The logs have their own numbers.
const SEED: u64 = 1;
const MEMBERS: usize = 1000;
/// Name of the file with the runs of the twin.
const POINTS: &str = "points.csv";

/// What is run.
pub(crate) struct Plan<'a> {
    pub(crate) config: &'a Config,
    /// Number of logs.
    pub(crate) logs: usize,
    /// Of so many logs the result is checked by full runs.
    pub(crate) checked: usize,
    /// Threads.
    pub(crate) jobs: usize,
    /// Folder that keeps the runs of design and truth.
    pub(crate) parts: Option<PathBuf>,
}

/// A log with what it was made of.
#[derive(Clone)]
struct Log {
    /// Standardised unknowns: of the twin, then the tares.
    truth: Vec<f64>,
    /// The runs that it is made of: off bottom, then drilling.
    points: Vec<Point>,
    random: fastrand::Rng,
}

/// What the calibration of a log gave.
struct Trial {
    truth: Vec<f64>,
    /// Whether the bit carries less than its wear flats do at one load, and more at another.
    straddles: bool,
    problem: Problem,
    outcome: Outcome,
    /// Full runs, where the result was checked.
    checked: Option<(Vec<Checked>, Vec<Objection>)>,
}

fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (TAU * random.f64()).cos()
}

/// Weights of the logs (N).
fn weights(config: &Config) -> [f64; 2] {
    WEIGHTS.map(|share| share * config.rock.depth_of_cut.wear_flat_force)
}

fn covers(config: &Config, unknowns: &Unknowns) -> [Cover; 2] {
    let rotary_speed = SPEEDS.map(rpm_to_rad_per_s);
    let usual = |motion: Activity, loads: usize| usual_points(unknowns.acting(motion).len() + loads);
    let most = kn_to_n(config.inputs.weight_on_bit.max_kn);
    [
        Cover {
            motion: Activity::OffBottom,
            rotary_speed,
            weight: [0.0; 2],
            points: usual(Activity::OffBottom, 1),
        },
        Cover {
            motion: Activity::Drilling,
            rotary_speed,
            weight: unknowns
                .acting_range(weights(config))
                .map(|weight| weight.clamp(LEAST_WEIGHT, most)),
            points: usual(Activity::Drilling, 2),
        },
    ]
}

impl Log {
    /// The log of a number, before its runs.
    fn new(config: &Config, unknowns: &Unknowns, number: usize) -> Self {
        let mut random = fastrand::Rng::with_seed(1_000 + number as u64);
        let modelled = unknowns.modelled.len();
        let truth: Vec<f64> = (0..modelled + unknowns.sensors.len())
            .map(|_| normal(&mut random).clamp(-TRUTH, TRUTH))
            .collect();
        Self::of(config, unknowns, truth, random)
    }

    /// The log of a truth, before its runs.
    fn of(config: &Config, unknowns: &Unknowns, truth: Vec<f64>, mut random: fastrand::Rng) -> Self {
        let modelled = unknowns.modelled.len();
        let [_, drilling] = covers(config, unknowns);
        let mut points = Vec::new();
        for part in 0..=DRILLING {
            let [slow, fast] = drilling.rotary_speed;
            let rotary_speed = slow + random.f64() * (fast - slow);
            let [low, high] = weights(config);
            let load = match part.checked_sub(1) {
                None => Load {
                    motion: Activity::OffBottom,
                    rotary_speed,
                    weight: 0.0,
                },
                Some(fifth) => Load {
                    motion: Activity::Drilling,
                    rotary_speed,
                    weight: low + (fifth as f64 + random.f64()) / DRILLING as f64 * (high - low),
                },
            };
            points.push(Point {
                z: truth[..modelled].to_vec(),
                load,
                found: None,
            });
        }
        Self { truth, points, random }
    }

    /// The samples at 1 Hz: off bottom, the drilling parts in a random order, off bottom again.
    fn samples(&mut self, config: &Config, unknowns: &Unknowns) -> anyhow::Result<Vec<Sample>> {
        let given = &config.calibration;
        // The noise is that of the configuration, so that the fit assumes the truth about the sensors.
        let [torque, weight] = IN_THE_HOLE;
        let noise = [
            given.torque_noise_nm,
            kn_to_n(given.hook_load_noise_kn),
            torque,
            weight,
            RATE_NOISE,
        ];
        // A random walk by the second: the deviation after an hour, over the root of 3600.
        let drift = [given.torque_drift_nm, kn_to_n(given.hook_load_drift_kn), 0.0, 0.0, 0.0].map(|hour| hour / 60.0);
        let all = unknowns.all();
        let of = |unknown: usize| all[unknown].value(self.truth[unknown]);
        let hanging = self.hanging();
        let sensors = Channel::ALL.map(|channel| unknowns.sensor(Of::Channel(channel), hanging));
        let indicator = unknowns.sensor(Of::Indicator, 0.0);
        // From part to part the rock differs; that it differs in the whole log is among the unknowns.
        let rock = config.calibration.rate_of_penetration_error / 2.0_f64.sqrt();
        // Off bottom comes first and last, as on a rig. The loads between come
        // in random order, or the drift would follow the weight.
        let (off_bottom, drilling) = self.points.split_at_mut(1);
        self.random.shuffle(drilling);
        let (mut walk, mut samples) = ([0.0; Channel::COUNT], Vec::new());
        for point in off_bottom.iter().chain(drilling.iter()).chain(off_bottom.iter()) {
            let figures: &Figures = match &point.found {
                Some(Ok(figures)) => figures,
                Some(Err(problem)) => anyhow::bail!("a run of a log gave no figure: {problem}"),
                None => anyhow::bail!("a run of a log did not take place"),
            };
            let seconds = match point.load.motion {
                Activity::OffBottom => OFF_BOTTOM_TIME,
                Activity::Drilling => DRILLING_TIME,
            };
            let of_part = 1.0 + rock * normal(&mut self.random);
            let mut exact = *figures;
            exact[Channel::RateOfPenetration as usize] *= of_part;
            for _ in 0..seconds {
                // Channels start as NaN, so that one that is forgotten counts as not measured.
                let mut measured = [f64::NAN; Channel::COUNT];
                for k in 0..measured.len() {
                    walk[k] += drift[k] * normal(&mut self.random);
                    measured[k] = sensors[k].shows(exact[k], of) + walk[k] + noise[k] * normal(&mut self.random);
                }
                let row = samples.len() as u64;
                // The header is row 1 and rows are counted from 1, so the first sample is row 2.
                samples.push(Sample {
                    time: row as f64,
                    row: row + 2,
                    rotary_speed: point.load.rotary_speed,
                    weight: match point.load.motion {
                        Activity::OffBottom => 0.0,
                        Activity::Drilling => indicator.shows(point.load.weight, of),
                    },
                    measured,
                });
            }
        }
        Ok(samples)
    }

    /// Hook load of the tool that hangs (N).
    fn hanging(&self) -> f64 {
        match self.points.first().map(|point| &point.found) {
            Some(Some(Ok(figures))) => figures[Channel::HookLoad as usize],
            _ => 0.0,
        }
    }

    /// Weights at the bit (N) while drilling.
    fn bit_weights(&self) -> impl Iterator<Item = f64> {
        self.points.iter().skip(1).filter_map(|point| match &point.found {
            Some(Ok(figures)) => Some(figures[Channel::BitWeight as usize]),
            _ => None,
        })
    }
}

/// The runs of design and logs.
fn runs(plan: &Plan, unknowns: &Unknowns, mut logs: Vec<Log>) -> anyhow::Result<(Vec<Point>, Vec<Log>)> {
    let mut all: Vec<Point> = covers(plan.config, unknowns)
        .iter()
        .flat_map(|cover| design(unknowns, cover, SEED))
        .collect();
    let of_design = all.len();
    all.extend(logs.iter().flat_map(|log| log.points.iter().cloned()));
    let file = plan.parts.as_ref().map(|folder| folder.join(POINTS));
    if let Some(file) = &file {
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).with_context(|| format!("{} cannot be created", folder.display()))?;
        }
        if let Ok(text) = std::fs::read_to_string(file) {
            points::fill(file, &text, plan.config, unknowns, SEED, &mut all)?;
        }
    }
    let mut problem = None;
    let mut all = points::run(plan.config, unknowns, all, plan.jobs, |points, left| {
        if let Some(file) = &file {
            let text = points::to_csv(plan.config, unknowns, SEED, points);
            problem = problem.take().or(std::fs::write(file, text).err());
        }
        if left % 50 == 0 {
            eprintln!("{left} runs of the twin left");
        }
    });
    if let Some(problem) = problem {
        return Err(problem).context("the runs of the twin cannot be kept");
    }
    let mut of_logs = all.split_off(of_design).into_iter();
    for log in &mut logs {
        log.points = of_logs.by_ref().take(1 + DRILLING).collect();
    }
    Ok((all, logs))
}

/// Force that the wear flats carry (N), with standardised unknowns.
fn flats(config: &Config, unknowns: &Unknowns, z: &[f64]) -> f64 {
    let of = |modelled: &Modelled| modelled.keys.contains(&"rock.depth_of_cut.wear_flat_force");
    match unknowns.modelled.iter().position(of) {
        Some(at) => unknowns.modelled[at].unknown.value(z[at]),
        None => config.rock.depth_of_cut.wear_flat_force,
    }
}

fn windows(log: &mut Log, config: &Config, unknowns: &Unknowns) -> anyhow::Result<Windows> {
    Ok(find(&log.samples(config, unknowns)?, &WindowSettings::default()))
}

/// The calibration of every log.
fn trials(plan: &Plan, unknowns: &Unknowns, points: &[Point], logs: Vec<Log>) -> anyhow::Result<Vec<Trial>> {
    let mut all = Vec::new();
    for (number, mut log) in logs.into_iter().enumerate() {
        let windows = windows(&mut log, plan.config, unknowns)?;
        let flats = flats(plan.config, unknowns, &log.truth);
        let straddles =
            log.bit_weights().any(|weight| weight < flats) && log.bit_weights().any(|weight| weight > flats);
        let seed = 1 + number as u64;
        let (problem, outcome, checked) = if number < plan.checked {
            eprintln!("log {} of {}, checked by full runs", number + 1, plan.logs);
            let settings = StudySettings {
                jobs: plan.jobs,
                seed,
                members: MEMBERS,
            };
            let study = study(plan.config, unknowns.clone(), windows, points, &settings)?;
            let objections = study.objections();
            (study.problem, study.outcome, Some((study.checked, objections)))
        } else {
            let problem = flexdrill_calibration::study::problem(plan.config, unknowns, &windows, points)?;
            let outcome = problem.fit(&SmootherSettings {
                members: MEMBERS,
                seed,
                ..SmootherSettings::default()
            })?;
            (problem, outcome, None)
        };
        all.push(Trial {
            truth: log.truth,
            straddles,
            problem,
            outcome,
            checked,
        });
    }
    Ok(all)
}

/// Counts over logs, of one unknown.
#[derive(Debug, Default, Clone, Copy)]
struct Count {
    /// Logs whose band holds the truth.
    holds: usize,
    identified: usize,
    bounded: usize,
    combined: usize,
    /// Sum of the half widths of the bands over those of the prior.
    width: f64,
    /// Sum of the variance ratios.
    ratio: f64,
}

/// Counts of every unknown over some trials.
fn counts<'a>(trials: impl Iterator<Item = &'a Trial>, unknowns: usize) -> Vec<Count> {
    let mut all = vec![Count::default(); unknowns];
    for trial in trials {
        let of_unknown = trial.problem.unknowns.iter().zip(&trial.outcome.estimates);
        for ((count, (unknown, estimate)), truth) in all.iter_mut().zip(of_unknown).zip(&trial.truth) {
            let [low, high] = estimate.band;
            count.holds += usize::from((low..=high).contains(&unknown.value(*truth)));
            count.width += (unknown.standard(high) - unknown.standard(low)) / (2.0 * flexdrill_calibration::BAND);
            count.ratio += estimate.variance_ratio;
            match estimate.verdict {
                Verdict::Identified => count.identified += 1,
                Verdict::Bounded => count.bounded += 1,
                Verdict::InCombination => count.combined += 1,
                Verdict::NotIdentifiable => {}
            }
        }
    }
    all
}

/// The 95 % interval of a share (Wilson, J. Am. Stat. Assoc. 22, 1927, 209).
fn interval(holds: usize, of: usize) -> [f64; 2] {
    let (n, z) = (of as f64, 1.959_964);
    let share = holds as f64 / n;
    let middle = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    [middle - half, middle + half]
}

fn shown(holds: usize, of: usize) -> String {
    if of == 0 {
        return "-".to_owned();
    }
    let [low, high] = interval(holds, of).map(|share| 100.0 * share);
    format!("{holds} of {of} ({low:.0} to {high:.0} %)")
}

/// Runs all logs; gives the tables.
///
/// # Errors
/// When a run of a log fails, or nothing can be fitted.
pub(crate) fn tables(plan: &Plan) -> anyhow::Result<String> {
    let unknowns = Unknowns::of(plan.config)?;
    // All runs of the twin come first and are kept; fitting takes seconds and can be repeated.
    let logs = (0..plan.logs)
        .map(|number| Log::new(plan.config, &unknowns, number))
        .collect();
    let (points, logs) = runs(plan, &unknowns, logs)?;
    let trials = trials(plan, &unknowns, &points, logs)?;
    let Some(first) = trials.first() else {
        return Ok(String::new());
    };
    let names: Vec<String> = first
        .problem
        .unknowns
        .iter()
        .map(|unknown| unknown.name.clone())
        .collect();
    // A log that straddles the force of the wear flats shows both branches of the bit's law, and determines more.
    let straddling = trials.iter().filter(|trial| trial.straddles).count();
    let each = counts(trials.iter(), names.len());
    let of_straddling = counts(trials.iter().filter(|trial| trial.straddles), names.len());
    let mut bands = Table::new([
        "unknown",
        "90 % band holds the truth (95 % interval)",
        "of logs on both sides of the wear flats' force",
        "half width over the prior's",
        "posterior over prior variance",
        "identified, bounded, in combination",
    ]);
    // The interval of the count comes with it: with few logs a share of nine in ten may be chance.
    for ((name, count), straddles) in names.iter().zip(&each).zip(&of_straddling) {
        let mean = |sum: f64| sum / trials.len() as f64;
        bands.row([
            name.clone(),
            shown(count.holds, trials.len()),
            shown(straddles.holds, straddling),
            format!("{:.2}", mean(count.width)),
            format!("{:.3}", mean(count.ratio)),
            format!("{}, {}, {}", count.identified, count.bounded, count.combined),
        ]);
    }
    let mut surrogates = Table::new([
        "surrogate",
        "runs",
        "range",
        "error of a run left out",
        "over its stated error",
    ]);
    // The surrogates are the same for all logs, so those of the first stand for all.
    for quantity in &first.problem.quantities {
        let (name, unit) = quantity.channel.name_and_unit();
        // Metres per second of a bit are all zeros with one place.
        let (unit, factor) = match quantity.channel {
            Channel::RateOfPenetration => ("m/h", m_per_s_to_m_per_h(1.0)),
            _ => (unit, 1.0),
        };
        let motion = match quantity.motion {
            Activity::OffBottom => "off bottom",
            Activity::Drilling => "drilling",
        };
        let [low, high] = quantity.surrogate.range.map(|end| factor * end);
        surrogates.row([
            format!("{name} ({unit}), {motion}"),
            quantity.surrogate.points.to_string(),
            format!("{low:.1} to {high:.1}"),
            format!("{:.2}", factor * quantity.surrogate.error),
            format!("{:.2}", quantity.surrogate.over_stated()),
        ]);
    }
    let [_, drilling] = covers(plan.config, &unknowns);
    let [slow, fast] = drilling.rotary_speed.map(rad_per_s_to_rpm);
    let [light, heavy] = weights(plan.config).map(n_to_kn);
    let explained = trials.iter().filter(|trial| trial.outcome.explains()).count();
    let mut text = format!(
        "{} logs at {slow:.0} to {fast:.0} r/min and {light:.1} to {heavy:.1} kN, {straddling} of them on both sides of the \
         wear flats' force at the bit. The twin explains {explained}.",
        trials.len()
    );
    // Checks by full runs are costly, so only some logs have them.
    let checked: Vec<&(Vec<Checked>, Vec<Objection>)> =
        trials.iter().filter_map(|trial| trial.checked.as_ref()).collect();
    if !checked.is_empty() {
        let usable = checked.iter().filter(|(_, objections)| objections.is_empty()).count();
        text.push_str(&format!(
            " Full runs checked {} of them and found nothing against {usable}.",
            checked.len()
        ));
        // Sorted, so that equal reasons are neighbours and can be counted.
        let mut reasons: Vec<&str> = checked
            .iter()
            .flat_map(|(_, all)| all.iter().map(Objection::name))
            .collect();
        reasons.sort_unstable();
        for of_one in reasons.chunk_by(|a, b| a == b) {
            text.push_str(&format!(" Against {}: `{}`.", of_one.len(), of_one[0]));
        }
    }
    Ok(format!("{text}\n\n{}\n{}", bands.text(), surrogates.text()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests;
