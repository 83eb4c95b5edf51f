//! Sensitivity: what each prior of a configuration moves, one at a time.
//!
//! Each uncertain key, and each error of the sensors of the inputs, is set to its 5 % and its 95 % quantile, with all
//! others as configured; where a calibration's sample decides a key, its quantiles are those of the sample. Every such point is a run of the twin ([`point`]). Two more runs, which differ from the nominal
//! one by 1 N of weight, show how far equal runs scatter.

pub mod picture;
pub mod point;
pub mod table;

use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_uncertainty::effects::{Effects, FORMAT, Output, Row};
use flexdrill_uncertainty::{Channel, Priors};

use crate::runs::{KeepError, Kept, KeptAs, Work, run_all};

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
    for (index, entry) in priors.entries().iter().enumerate() {
        for quantile in QUANTILES {
            let values: Vec<(&str, f64)> = entry.values(priors.draw(index, quantile)).collect();
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

/// Runs all points ([`run_all`]). `configuration` is the hash of the configuration with its priors.
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

/// A point, or why the configuration refuses it.
impl Work for &Result<Point, String> {
    type Found = Found;

    fn cost(&self) -> f64 {
        1.0
    }

    /// The weight is part of the configuration; speed and time are not.
    fn kept_as(&self) -> Option<KeptAs> {
        let Point { config, load } = self.as_ref().ok()?;
        let config = config.hash();
        let [speed, seconds] = [load.speed, load.seconds].map(f64::to_bits);
        Some(KeptAs {
            name: format!("{config:.16}_{speed:016x}_{seconds:016x}"),
            config,
            load: format!("{load:?}"),
        })
    }

    fn run(&self, report: &mut impl FnMut(f64)) -> Result<Found, String> {
        self.as_ref().map_err(Clone::clone)?.run(report)
    }

    fn figures(found: &Found) -> Vec<f64> {
        found.to_vec()
    }

    fn found(figures: Vec<f64>) -> Option<Found> {
        figures.try_into().ok()
    }
}
