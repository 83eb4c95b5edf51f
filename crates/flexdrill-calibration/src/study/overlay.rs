//! What was found as configuration: the changed keys alone, and the whole.

use std::fmt::Write as _;
use std::io::Read as _;
use std::path::Path;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::Study;
use super::check::At;
use crate::identify::{Estimate, Verdict};
use crate::sensor::Sensor;
use crate::windows::Channel;
use flexdrill_config::{Config, ConfigError};
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn};

/// Where the values come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// File name of the log.
    pub log: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// First and last row that was read.
    pub rows: [u64; 2],
    /// Hash of the configuration that was fitted.
    pub configuration: String,
    /// Version of the program.
    pub version: String,
    /// Seed.
    pub seed: u64,
}

/// SHA-256 of a file, or of the files of a folder in the order of their names.
///
/// # Errors
/// When one cannot be read.
pub fn sha256(path: &Path) -> std::io::Result<String> {
    let mut files = vec![path.to_owned()];
    if path.is_dir() {
        files = std::fs::read_dir(path)?
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<Result<_, _>>()?;
        files.retain(|file| file.is_file());
        files.sort();
    }
    let mut digest = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    for file in files {
        let mut file = std::fs::File::open(file)?;
        loop {
            let read = file.read(&mut buffer)?;
            if read == 0 {
                break;
            }
            digest.update(&buffer[..read]);
        }
    }
    Ok(digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

/// A key of the configuration with its value, its band and what it is.
struct Entry<'a> {
    key: &'static str,
    value: f64,
    band: [f64; 2],
    estimate: &'a Estimate,
    name: &'a str,
    /// Whether the key is a factor on the coefficient that was fitted.
    is_factor: bool,
}

/// All keys that may change, also those that the data do not determine.
fn entries(study: &Study) -> Vec<Entry<'_>> {
    let estimates = &study.outcome.estimates;
    let mut all = Vec::new();
    for (modelled, estimate) in study.unknowns.modelled.iter().zip(estimates) {
        for key in &modelled.keys {
            all.push(Entry {
                key,
                value: modelled.key_value(estimate.value),
                band: estimate.band.map(|end| modelled.key_value(end)),
                estimate,
                name: &modelled.unknown.name,
                is_factor: modelled.per_value != 1.0,
            });
        }
    }
    for (known, estimate) in study
        .unknowns
        .sensors
        .iter()
        .zip(&estimates[study.unknowns.modelled.len()..])
    {
        let Some(key) = known.key else { continue };
        all.push(Entry {
            key,
            value: known.per_value * estimate.value,
            band: estimate.band.map(|end| known.per_value * end),
            estimate,
            name: &known.unknown.name,
            is_factor: false,
        });
    }
    all
}

fn changes(study: &Study) -> Vec<Entry<'_>> {
    let mut all = entries(study);
    all.retain(|entry| entry.estimate.verdict != Verdict::NotIdentifiable);
    all
}

/// The configuration with what was found; keys that the data do not determine keep their values.
///
/// # Errors
/// When the configuration does not allow a value.
pub fn apply(config: &Config, study: &Study) -> Result<Config, ConfigError> {
    config.with_values(
        "calibration",
        changes(study)
            .into_iter()
            .map(|entry| (entry.key, rounded(entry.value))),
    )
}

/// A value with six significant digits, as the files have it.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Comment lines that say why the values are not to be used; empty where they may be.
pub fn warnings(study: &Study) -> String {
    let mut text = String::new();
    for objection in study.objections() {
        // The problem of a run may hold anything.
        let plain = objection.to_string().replace(char::is_control, " ");
        let _ = writeln!(text, "# NOT TO BE USED: {plain}.");
    }
    text
}

/// Comment lines with the provenance.
pub fn header(provenance: &Provenance) -> String {
    format!(
        "# Calibration by flexdrill {} of {} (rows {} to {}, SHA-256 {}),\n# from the configuration of hash {}, seed {}.\n",
        provenance.version,
        // A file name may hold anything.
        provenance.log.replace(char::is_control, "?"),
        provenance.rows[0],
        provenance.rows[1],
        provenance.sha256,
        provenance.configuration,
        provenance.seed
    )
}

/// The changed keys as YAML, with their bands.
pub fn yaml(study: &Study, provenance: &Provenance) -> String {
    let mut text = header(provenance);
    // Warnings stand above the values, as this file is applied by hand.
    text.push_str(&warnings(study));
    text.push_str("# Values with the ends of their 90 % bands. Keys that the log does not determine are at the end.\n");
    if study.problem.indicator != Sensor::default() {
        text.push_str(
            "# A twin takes the weight as the rig shows it. Plausible tools have the indicator's factor and tare; for the twin \
             itself,\n# correct the indicator, or scale the column of the weight in the mapping.\n",
        );
    }
    let mut path: Vec<&str> = Vec::new();
    let mut all = changes(study);
    // Keys of one section stand together.
    all.sort_by_key(|entry| entry.key);
    for entry in all {
        let names: Vec<&str> = entry.key.split('.').collect();
        // Sections that the last key has opened are not written again.
        let shared = names.iter().zip(&path).take_while(|(a, b)| a == b).count();
        let (last, sections) = names
            .split_last()
            .map_or(("", &names[..]), |(last, sections)| (*last, sections));
        for (depth, name) in sections.iter().enumerate().skip(shared) {
            let _ = writeln!(text, "{}{name}:", "  ".repeat(depth));
        }
        let only = if entry.estimate.verdict == Verdict::InCombination {
            "; only in combination"
        } else {
            ""
        };
        // A factor alone does not show the coefficient that was fitted.
        let coefficient = if entry.is_factor {
            format!("; {} {:.4}", entry.name, entry.estimate.value)
        } else {
            String::new()
        };
        let [low, high] = entry.band;
        let _ = writeln!(
            text,
            "{}{last}: {}  # {low:.4} to {high:.4}{coefficient}{only}",
            "  ".repeat(sections.len()),
            rounded(entry.value)
        );
        path = names;
    }
    // What has no key, and keys that the data do not determine, are comments, so that applying the file leaves them as they
    // are.
    for (known, estimate) in study
        .unknowns
        .sensors
        .iter()
        .zip(&study.outcome.estimates[study.unknowns.modelled.len()..])
    {
        if known.key.is_none() && estimate.verdict != Verdict::NotIdentifiable {
            let [value, low, high] =
                [estimate.value, estimate.band[0], estimate.band[1]].map(|value| known.per_value * value);
            let _ = writeln!(
                text,
                "# {}: {value:.4}, {low:.4} to {high:.4}; no key, as `uncertainty.sensors` does not state it",
                known.unknown.name
            );
        }
    }
    for entry in entries(study) {
        if entry.estimate.verdict == Verdict::NotIdentifiable {
            let _ = writeln!(
                text,
                "# hardly moved by this log, left as it is: {} ({}; posterior over prior width {:.2})",
                entry.key,
                entry.name,
                entry.estimate.width_ratio()
            );
        }
    }
    for (name, why) in &study.unknowns.left_out {
        let _ = writeln!(text, "# not fitted: {name}, {why}");
    }
    text
}

/// Everything that was found, for other programs; SI units.
pub fn json(study: &Study, provenance: &Provenance) -> Value {
    // The keys are the contract with other programs; they are never renamed, only added to.
    let problem = &study.problem;
    let name = |index: usize| problem.unknowns[index].name.as_str();
    json!({
        "version": 1,
        // The provenance comes first: with it the result can be repeated.
        "provenance": {
            "log": provenance.log,
            "sha256": provenance.sha256,
            "rows": provenance.rows,
            "configuration_hash": provenance.configuration,
            "flexdrill": provenance.version,
            "seed": provenance.seed,
        },
        "misfit": study.outcome.misfit,
        "explains": study.outcome.explains(),
        // Other programs should look at this one alone before they use a value.
        "usable": study.objections().is_empty(),
        "not_to_be_used": study.objections().iter().map(|objection| json!({
            "why": objection.name(),
            "text": objection.to_string(),
        })).collect::<Vec<_>>(),
        // The order is that of the fit, to which indexes in pairs refer. What is of a sensor has no keys of the model.
        "unknowns": problem.unknowns.iter().zip(&study.outcome.estimates).enumerate().map(|(index, (unknown, estimate))| json!({
            "name": unknown.name,
            "keys": study.unknowns.modelled.get(index).map(|modelled| modelled.keys.clone()),
            "key_per_value": study.unknowns.modelled.get(index).map(|modelled| modelled.per_value),
            "unit": unknown.unit,
            "prior": unknown.prior(),
            "value": estimate.value,
            "band": estimate.band,
            "variance_ratio": estimate.variance_ratio,
            "width_ratio": estimate.width_ratio(),
            "of_sensor": study.unknowns.sensors.get(index.wrapping_sub(study.unknowns.modelled.len())).map(|known| known.key),
            "verdict": match estimate.verdict {
                Verdict::Identified => "identified",
                Verdict::Bounded => "bounded",
                Verdict::InCombination => "in_combination",
                Verdict::NotIdentifiable => "not_identifiable",
            },
        })).collect::<Vec<_>>(),
        "not_in_the_model": study.unknowns.left_out.iter().map(|(name, why)| json!({"name": name, "why": why})).collect::<Vec<_>>(),
        "pairs": study.outcome.pairs.iter().map(|pair| json!({
            "unknowns": pair.unknowns.map(name),
            "correlation": pair.correlation,
            "weights": pair.weights,
            "variance_ratio": pair.variance_ratio,
        })).collect::<Vec<_>>(),
        "refused": study.refused.iter().map(|(channel, refusal)| json!({
            "channel": channel.name_and_unit().0,
            "why": refusal.text(),
        })).collect::<Vec<_>>(),
        "surrogates": problem.quantities.iter().map(|quantity| json!({
            "channel": quantity.channel.name_and_unit().0,
            "motion": format!("{:?}", quantity.motion),
            "points": quantity.surrogate.points,
            "error": quantity.surrogate.error,
            "error_over_stated": quantity.surrogate.over_stated(),
            "range": quantity.surrogate.range,
        })).collect::<Vec<_>>(),
        // Whether the twin explains each quantity: residuals over their stated errors, with the correlation of these.
        "quantities": study.outcome.checks.iter().map(|check| {
            let quantity = &problem.quantities[check.quantity];
            let worst = problem.observations[check.worst].window;
            json!({
                "channel": quantity.channel.name_and_unit().0,
                "motion": format!("{:?}", quantity.motion),
                "windows": check.windows,
                "residuals_over_stated": check.times,
                "at_most": check.most,
                "explained": check.is_explained(),
                "largest_in_rows": study.windows.steady[worst].rows,
            })
        }).collect::<Vec<_>>(),
        // Both lists have one entry per observation.
        "windows": problem.observations.iter().zip(&study.outcome.explained).map(|(observation, explained)| {
            let window = &study.windows.steady[observation.window];
            json!({
                "rows": window.rows,
                "begin_s": window.span[0],
                "end_s": window.span[1],
                "motion": format!("{:?}", window.motion),
                "rotary_speed": window.rotary_speed,
                "weight": window.weight,
                "channel": problem.quantities[observation.quantity].channel.name_and_unit().0,
                "measured": observation.value,
                "prior": explained.prior,
                "predicted": explained.predicted,
                "band": explained.band,
                "standardised": explained.standardised,
            })
        }).collect::<Vec<_>>(),
        "checked_by_full_runs": study.checked.iter().map(|checked| json!({
            "rows": study.windows.steady[checked.window].rows,
            "channel": checked.channel.name_and_unit().0,
            "measured": checked.measured,
            // A run without a figure has a null and its reason, so that it is not taken for agreement.
            "run": checked.run.as_ref().ok(),
            "problem": checked.run.as_ref().err(),
            "at": match checked.at {
                At::Centre => json!("centre"),
                At::Member(number) => json!(number),
            },
            "surrogate": checked.surrogate,
            "surrogate_band": checked.surrogate_band,
            "band": checked.band,
        })).collect::<Vec<_>>(),
        "left_out": study.windows.left_out_by_reason().iter().map(|(reason, samples)| json!({
            "reason": reason.to_string(),
            "samples": samples,
        })).collect::<Vec<_>>(),
        "points_without_figures": study.failed,
    })
}

/// Figures of a channel as the report shows them: unit and factor from SI.
pub fn shown(channel: Channel) -> (&'static str, f64) {
    match channel {
        Channel::SurfaceTorque | Channel::BitTorque => ("N m", 1.0),
        Channel::HookLoad | Channel::BitWeight => ("kN", n_to_kn(1.0)),
        Channel::RateOfPenetration => ("m/h", m_per_s_to_m_per_h(1.0)),
    }
}
