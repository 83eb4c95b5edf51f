//! What is not known of a tool, for `flexdrill check`: the priors, with their effects where they were computed.

use std::path::{Path, PathBuf};

use flexdrill_config::Form;
use flexdrill_text::{counted, printable, six_digits};
use flexdrill_uncertainty::effects::{Effects, FILE};
use flexdrill_uncertainty::{Entry, Posterior, Priors, Sensor};

/// Ends of 90 % of a distribution.
const ENDS: [f64; 2] = [0.05, 0.95];

/// The folder of the results of `flexdrill sensitivity` for a configuration: next to it, under its name.
pub(super) fn folder(config: &Path) -> PathBuf {
    let mut name = config.file_stem().unwrap_or_default().to_owned();
    name.push("_sensitivity");
    config.with_file_name(name)
}

/// The lines of the priors; none where nothing is uncertain. `hash` is that of the configuration in `path`.
pub(super) fn lines(priors: &Priors, path: &Path, hash: &str) -> Vec<String> {
    if priors.is_empty() {
        return Vec::new();
    }
    let (effects, why) = effects(path, hash);
    let mut lines = vec![
        String::new(),
        "What is not known, as 90 % of each distribution (docs/uncertainty.md):".to_owned(),
    ];
    for entry in priors.entries() {
        lines.push(format!("  {}", range(entry)));
        lines.push(format!("    source: {}", printable(&entry.source)));
        if let Some(effects) = &effects {
            lines.push(format!(
                "    effect: {}",
                printable(&effects.largest_in_words(entry.name()))
            ));
        }
    }
    let sensors = priors.sensors().iter().filter_map(errors);
    lines.extend(sensors.map(|of| format!("  {of}")));
    lines.push(why);
    lines
}

/// What a calibration has found, where plausible tools are drawn from it.
pub(super) fn posterior(posterior: &Posterior) -> String {
    let from = &posterior.provenance;
    format!(
        "Plausible tools are drawn from {}: {}, {} alike by their weights, fitted to rows {} to {} of {} by flexdrill {}, of {}. \
         Other keys are drawn from uncertainty, given these.",
        posterior.file(),
        counted(posterior.members().len() as u64, "member"),
        six_digits(posterior.effective_number().round()),
        from.rows[0],
        from.rows[1],
        printable(&from.log),
        printable(&from.version),
        printable(&posterior.keys().join(", "))
    )
}

/// The table that was computed before, and a sentence about it.
fn effects(path: &Path, hash: &str) -> (Option<Effects>, String) {
    let folder = folder(path);
    let file = folder.join(FILE);
    let command = format!("`flexdrill sensitivity {}` computes it", path.display());
    match Effects::load(&folder) {
        Ok(Some(effects)) if effects.configuration == hash => {
            let load = format!(
                "{} r/min and {} kN",
                six_digits(effects.rotary_speed_rpm),
                six_digits(effects.weight_on_bit_kn)
            );
            (Some(effects), format!("Effects at {load}, from {}.", file.display()))
        }
        Ok(Some(_)) => (
            None,
            format!(
                "{} is the effect of another configuration; {command} again.",
                file.display()
            ),
        ),
        Ok(None) => (None, format!("The effect of each is not computed yet: {command}.")),
        Err(error) => (None, format!("{}; {command} again.", printable(&error.to_string()))),
    }
}

/// Keys, distribution and range of an entry.
fn range(entry: &Entry) -> String {
    let [low, high] = ENDS.map(|end| entry.draw(end));
    let names: Vec<&str> = entry.keys().iter().map(|key| key.name.as_str()).collect();
    let unit = entry.keys().first().map_or("", |key| key.unit);
    let space = if unit.is_empty() { "" } else { " " };
    // The first key stands for all in the unit of the file; a factor is the same for all.
    let values = |draw: f64| entry.values(draw).next().map_or(f64::NAN, |(_, value)| value);
    let [from, to] = [low, high].map(values).map(six_digits);
    let form = match entry.form {
        Form::Value => String::new(),
        Form::Factor => format!(", a factor of {} to {}", six_digits(low), six_digits(high)),
        Form::Offset => format!(
            ", an offset of {} to {}{space}{unit}",
            six_digits(low),
            six_digits(high)
        ),
    };
    let configured = entry.keys().first().map_or(f64::NAN, |key| key.configured);
    format!(
        "{}: {from} to {to}{space}{unit} ({}{form}; configured {})",
        names.join(" and "),
        entry.distribution.name(),
        six_digits(configured)
    )
}

/// The errors of a sensor; none where it is exact.
fn errors(sensor: &Sensor) -> Option<String> {
    let unit = sensor.channel.unit();
    let mut parts = Vec::new();
    if sensor.factor_error > 0.0 {
        // A factor other than 1 is one that a calibration has found.
        let about = match sensor.expected_factor {
            1.0 => String::new(),
            found => format!(" of {}", six_digits(found)),
        };
        parts.push(format!(
            "factor within {} %{about}",
            six_digits(100.0 * sensor.factor_error)
        ));
    }
    for (name, value) in [
        ("tare within", sensor.tare_range),
        ("noise of", sensor.noise),
        ("drift in an hour of", sensor.drift),
    ] {
        if value > 0.0 {
            parts.push(format!("{name} {} {unit}", six_digits(value)));
        }
    }
    (!parts.is_empty()).then(|| format!("sensor {}: {}", sensor.channel.name(), parts.join(", ")))
}
