//! `--cases quality`: the model's own estimate of its error, next to the error against finer steps.

use flexdrill_bench::cases::{BenchCase, hard};
use flexdrill_bench::table::Table;
use flexdrill_config::{Config, ConfigError};
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{ModelQuality, QualityLevel};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_verify::step_error::{Course, Record, StepErrorFailure, refined};

/// Beside the hard cases: contacts too stiff for the step, and a longer tool.
const MORE: &[BenchCase] = &[
    BenchCase {
        name: "contact 1e8 / 5e8 N/m, 10 kN",
        wob: 10.0,
        rpm: None,
        changes: |config| {
            config
                .with_value("contact.inner.stiffness", 1e8)?
                .with_value("contact.outer.stiffness", 5e8)
        },
    },
    BenchCase {
        name: "66 links, 10 kN",
        wob: 10.0,
        rpm: None,
        changes: |config| config.with_links(66),
    },
];

/// The step of a run over the configuration's.
pub(crate) const STEPS: &[f64] = &[0.5, 1.0, 1.5, 2.0];

/// Those of the rig's tool, whose mud takes so much energy that only much longer steps spoil the motion.
pub(crate) const RIG_STEPS: &[f64] = &[0.5, 1.0, 2.0, 4.0, 6.0];

/// Schemes that gain energy or damp too much, run with the tool as it is.
const RHO_INFINITY: [f64; 4] = [0.0, 0.2, 0.7, 0.8];

/// Runs every case with every step; gives the table.
///
/// # Errors
/// When a tool cannot be built. A failed step is a row of the table.
pub(crate) fn tables(config: &Config, rpm: f64, duration: f64, steps: &[f64]) -> anyhow::Result<String> {
    let mut table = Table::new([
        "case",
        "step (ms)",
        "ripple of the bit speed (rad/s)",
        "pipe-guide force (N)",
        "guide-wall force (N)",
        "whirl ratio",
        "energy error share",
        "numerical share",
        "share of the mud",
        "model quality, of the time",
    ]);
    for (index, case) in hard(config).iter().chain(MORE).enumerate() {
        let tool = (case.changes)(config)?;
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(case.wob),
            ..Inputs::default()
        };
        // The motion of the tool sets the interval for all its runs.
        let motion = Course::of(&tool, inputs, duration);
        let run = |config: &Config| {
            eprintln!("{}: {duration} s in steps of {} s", case.name, config.solver.time_step);
            // Intervals are whole numbers of each step.
            let motion = Course::of(config, inputs, motion.duration);
            Record::run(config, &motion, 0.0)
        };
        // The fine run is the reference for all others of the case, and comes first.
        let fine = run(&refined(&tool)?)?;
        let first = row(case.name, refined(&tool)?.solver.time_step, &fine, None);
        // Rows are printed as they come: the whole takes hours.
        eprintln!("{}", first.join(" | "));
        table.row(first);
        for (name, config) in variants(case.name, &tool, steps, index == 0)? {
            let step = config.solver.time_step;
            match run(&config) {
                Ok(record) => {
                    let row = row(&name, step, &record, Some(&fine));
                    eprintln!("{}", row.join(" | "));
                    table.row(row);
                }
                // A step that does not converge at this size is a result of the table, not an error.
                Err(StepErrorFailure::Step { failure, .. }) => {
                    table.cells(&[name, format!("{}", 1e3 * step), format!("failed: {failure}")]);
                }
                Err(other) => return Err(other.into()),
            }
        }
    }
    Ok(format!(
        "{duration} s from rest, up to {rpm} r/min, statistics over the last three quarters; in brackets the difference to the first row of the case, an \
        eighth of the step. Forces: root sum square over the layer's stations of their RMS. Shares: means of what was judged.\n\n{}",
        table.text()
    ))
}

/// The case with every step, and with other schemes.
fn variants(
    name: &str,
    tool: &Config,
    steps: &[f64],
    with_schemes: bool,
) -> Result<Vec<(String, Config)>, ConfigError> {
    let step = tool.solver.time_step;
    let mut variants = Vec::new();
    for factor in steps {
        variants.push((name.to_owned(), tool.with_value("solver.time_step", factor * step)?));
    }
    if with_schemes {
        for rho in RHO_INFINITY {
            let config = tool.with_value("solver.rho_infinity", rho)?;
            variants.push((format!("{name}, rho_infinity {rho}"), config));
        }
    }
    Ok(variants)
}

fn row(name: &str, step: f64, record: &Record, fine: Option<&Record>) -> [String; 10] {
    let against = |figure: fn(&Record) -> f64, decimals: usize| {
        let value = figure(record);
        fine.map_or_else(
            || format!("{value:.decimals$}"),
            |fine| format!("{value:.decimals$} ({:+.0} %)", 100.0 * (value / figure(fine) - 1.0)),
        )
    };
    let judged: Vec<&ModelQuality> = record.qualities.iter().filter(|quality| quality.judged).collect();
    let mean = |share: fn(&ModelQuality) -> f64| {
        if judged.is_empty() {
            return "-".to_owned();
        }
        let sum: f64 = judged.iter().map(|quality| share(quality)).sum();
        format!("{:.2}", sum / judged.len() as f64)
    };
    [
        name.to_owned(),
        format!("{}", 1e3 * step),
        against(Record::ripple, 3),
        against(|record| record.force(0), 0),
        against(|record| record.force(1), 0),
        against(|record| record.whirl_ratio, 3),
        mean(|quality| quality.energy_error_share),
        mean(|quality| quality.numerical_share),
        mean(|quality| quality.effects_share),
        words(&judged),
    ]
}

/// Every word that was said, with its share of the time.
fn words(judged: &[&ModelQuality]) -> String {
    if judged.is_empty() {
        return ModelQuality::default().to_string();
    }
    let levels = [QualityLevel::Good, QualityLevel::Degraded, QualityLevel::Poor];
    let said = levels.into_iter().filter_map(|level| {
        let count = judged.iter().filter(|quality| quality.level == level).count();
        let share = 100.0 * count as f64 / judged.len() as f64;
        (count > 0).then(|| format!("{} {share:.0} %", level.name().to_uppercase()))
    });
    said.collect::<Vec<_>>().join(", ")
}
