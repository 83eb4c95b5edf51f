//! Sensitivity: what each prior of a configuration moves, one at a time.
//!
//! Each uncertain key, and each error of the sensors of the inputs, is set to its 5 % and its 95 % quantile, with all
//! others as configured. Every such point is a run of the twin ([`point`]). Two more runs, which differ from the nominal
//! one by 1 N of weight, show how far equal runs scatter.

mod kept;
pub mod picture;
pub mod point;
pub mod table;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};

use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_uncertainty::effects::{Effects, FORMAT, Output, Row};
use flexdrill_uncertainty::{Channel, Priors};

pub use kept::{KeepError, Kept};
pub use point::{Figure, Found, Load, Point};

/// Quantiles at which a prior is tried: the ends of 90 %.
pub const QUANTILES: [f64; 2] = [0.05, 0.95];
/// Weight (N) by which two runs differ that ought to be equal.
const DIFFERENCE: f64 = 1.0;

/// A run of a prior, with what the table says of it.
struct Trial {
    key: String,
    quantile: f64,
    value: f64,
    unit: &'static str,
    /// Or why the configuration refuses the value.
    point: Result<Point, String>,
}

/// The runs of all priors, two for each: keys in the order of the file, then the sensors of the inputs.
fn trials(priors: &Priors, load: &Load) -> Vec<Trial> {
    let mut trials = Vec::new();
    for entry in priors.entries() {
        for quantile in QUANTILES {
            let values: Vec<(&str, f64)> = entry.values(entry.draw(quantile)).collect();
            let config = priors.base().with_values("sensitivity", values.iter().copied());
            trials.push(Trial {
                key: entry.name().to_owned(),
                quantile,
                value: values.first().map_or(f64::NAN, |(_, value)| *value),
                unit: entry.keys().first().map_or("", |key| key.unit),
                point: config
                    .map_err(|error| error.to_string())
                    .and_then(|config| Point::new(config, *load)),
            });
        }
    }
    trials.extend(of_sensors(priors, load));
    trials
}

/// The runs of the sensors of the inputs: the reading is that of the load, and the truth differs.
fn of_sensors(priors: &Priors, load: &Load) -> Vec<Trial> {
    let mut trials = Vec::new();
    for sensor in priors.sensors() {
        for (part, law) in [("factor", sensor.factor()), ("tare", sensor.tare())] {
            // What has no range is exact.
            let Some(law) = law else { continue };
            for quantile in QUANTILES {
                let value = law.quantile(quantile);
                let [factor, tare] = if part == "factor" { [value, 0.0] } else { [1.0, value] };
                let truth = |reading: f64| (reading - tare) / factor;
                let (load, shown, unit) = match sensor.channel {
                    Channel::WeightIndicator if part == "tare" => {
                        (load.with_weight(truth(load.weight)), n_to_kn(value), "kN")
                    }
                    Channel::WeightIndicator => (load.with_weight(truth(load.weight)), value, ""),
                    Channel::RotarySpeed => (load.with_speed(truth(load.speed)), value, ""),
                    // No other sensor drives the twin.
                    _ => continue,
                };
                trials.push(Trial {
                    key: format!("uncertainty.sensors.{}.{part}", sensor.channel.name()),
                    quantile,
                    value: shown,
                    unit,
                    point: Point::new(priors.base().clone(), load),
                });
            }
        }
    }
    trials
}

/// Runs all points on `jobs` threads. The results do not depend on the number of threads. `progress` gets the share of
/// the work that is done, 0 to 1. Points that are `kept` are not run, and every run is kept. `configuration` is the hash of
/// the configuration with its priors.
///
/// # Errors
/// When a point cannot be kept. A run that fails is part of the results.
pub fn study(
    configuration: String,
    priors: &Priors,
    load: &Load,
    jobs: usize,
    kept: Option<&Kept>,
    progress: impl FnMut(f64),
) -> Result<Effects, KeepError> {
    // The nominal run and its two neighbours are the reference of all others.
    let equal = [0.0, DIFFERENCE, -DIFFERENCE].map(|difference| load.with_weight(load.weight + difference));
    let equal = equal.map(|load| Point::new(priors.base().clone(), load));
    let trials = trials(priors, load);
    let points: Vec<&Result<Point, String>> = equal.iter().chain(trials.iter().map(|trial| &trial.point)).collect();
    let found = run_all(&points, jobs, kept, progress)?;
    let (equal, found) = found.split_at(equal.len());
    let of = |found: &Result<Found, String>, figure: Figure| {
        let value = figure.shown(found.as_ref().ok()?[figure as usize]);
        value.is_finite().then_some(value)
    };
    let outputs = Figure::ALL.map(|figure| {
        let (name, unit) = figure.name_and_unit();
        let nominal = equal.first().and_then(|found| of(found, figure));
        let distances = equal
            .iter()
            .skip(1)
            .filter_map(|found| Some((of(found, figure)? - nominal?).abs()));
        Output {
            name: name.to_owned(),
            unit: unit.to_owned(),
            nominal,
            scatter: distances.reduce(f64::max),
        }
    });
    let rows = trials.into_iter().zip(found).map(|(trial, found)| Row {
        key: trial.key,
        quantile: trial.quantile,
        value: trial.value,
        unit: trial.unit.to_owned(),
        results: Figure::ALL.map(|figure| of(found, figure)).to_vec(),
        cause: found.as_ref().err().cloned().unwrap_or_default(),
    });
    Ok(Effects {
        format: FORMAT,
        program: concat!("flexdrill ", env!("CARGO_PKG_VERSION")).to_owned(),
        configuration,
        rotary_speed_rpm: rad_per_s_to_rpm(load.speed),
        weight_on_bit_kn: n_to_kn(load.weight),
        seconds: load.seconds,
        outputs: outputs.to_vec(),
        rows: rows.collect(),
    })
}

/// The results of all points, in their order.
fn run_all(
    points: &[&Result<Point, String>],
    jobs: usize,
    kept: Option<&Kept>,
    mut progress: impl FnMut(f64),
) -> Result<Vec<Result<Found, String>>, KeepError> {
    let next = AtomicUsize::new(0);
    let found = Mutex::new(vec![None; points.len()]);
    let unkept = Mutex::new(None);
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel::<f64>();
        for _ in 0..jobs.clamp(1, points.len().max(1)) {
            let (sender, next, found, unkept) = (sender.clone(), &next, &found, &unkept);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(point) = points.get(index) else { break };
                    let mut reported = 0.0;
                    // Only the increase is sent, as all threads share one sum.
                    let mut report = |share: f64| {
                        // The receiver outlives all threads of this scope.
                        let _ = sender.send(share - reported);
                        reported = share;
                    };
                    let result = match point {
                        Err(cause) => Err(cause.clone()),
                        Ok(point) => kept.and_then(|kept| kept.read(point)).unwrap_or_else(|| {
                            let result = point.run(&mut report);
                            if let Some(Err(error)) = kept.map(|kept| kept.write(point, &result)) {
                                *unkept.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                                // What cannot be kept is not worth the time.
                                next.store(points.len(), Ordering::Relaxed);
                            }
                            result
                        }),
                    };
                    report(1.0);
                    found.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(result);
                }
            });
        }
        // The loop below ends with the last sender of the threads.
        drop(sender);
        let mut done = 0.0;
        for part in receiver {
            done += part;
            progress((done / points.len() as f64).min(1.0));
        }
    });
    if let Some(error) = unkept.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(error);
    }
    let found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    let none = || Err("the run did not take place".to_owned());
    Ok(found.into_iter().map(|found| found.unwrap_or_else(none)).collect())
}
