//! `--cases real-time`: the default tool and the hard cases, each with its speed.

use super::cases::{WHIRLING, hard};
use super::machine;
use super::measure::{Load, Measured, percentiles, run};
use super::table::Table;
use flexdrill_config::Config;
use flexdrill_core::dynamics::phases::Phase;

/// Runs all cases, each announced to `say`; gives the tables.
///
/// # Errors
/// When a tool cannot be built. A failed step is a line of the table.
pub fn tables(config: &Config, load: Load, duration: f64, mut say: impl FnMut(&str)) -> anyhow::Result<String> {
    // Times in percentiles, because the deadline is missed by the slowest steps and not by the mean.
    let mut speed = Table::new([
        "case",
        "real-time factor",
        "of processor time",
        "step: p50, p99, p99.9, max (ms)",
        "frame of 20 ms: p50, p99, p99.9, max (ms)",
        "iterations: mean, most",
        "halved, rejected",
        "energy error",
    ]);
    // The columns follow the phases of the stepper, so that a new phase appears by itself.
    let names: Vec<&str> = std::iter::once("case")
        .chain(Phase::ALL.map(Phase::name))
        .chain(["sum"])
        .collect();
    let mut phases = Table::with_head(&names);
    let mut failures = String::new();
    // The hard cases change the tool; the last one, a whirling pipe, changes the motion.
    for case in hard(config).iter().chain([&WHIRLING]) {
        say(&format!("{}: {duration} s of model time", case.name));
        let config = (case.changes)(config)?;
        // A case may have its own speed, at which its difficulty shows.
        let load = Load {
            wob: case.wob,
            rpm: case.rpm.unwrap_or(load.rpm),
            ..load
        };
        let measured = run(&config, load, duration, |_| {})?;
        speed.row(speed_row(case.name, &measured));
        let times = Phase::ALL.map(|phase| measured.phase(phase));
        let cells: Vec<String> = std::iter::once(case.name.to_owned())
            .chain(
                times
                    .iter()
                    .chain([&measured.step_time()])
                    .map(|time| format!("{time:.1}")),
            )
            .collect();
        phases.cells(&cells);
        // A failed step is a finding on that case and must not end the other cases.
        if let Some(failure) = measured.failure {
            failures.push_str(&format!(
                "\nFailed: {}, at model time {:.3} s: {}.\n",
                case.name, failure.time, failure
            ));
        }
    }
    Ok(format!(
        "Each {duration} s of model time from rest, up to {} r/min unless the case says otherwise, one thread; {} links x {} elements, step {} ms, {}.\n\n{}{failures}\nMean processor time per step (us), shared out as the phases share the wall time:\n\n{}",
        load.rpm,
        config.tool.links,
        config.tool.elements_per_link,
        1e3 * config.solver.time_step,
        config.solver.scheme_in_words(),
        speed.text(),
        phases.text()
    ))
}

/// The section of a document that [`tables`] of the configuration `name` make.
pub fn section(name: &str, duration: f64, tables: &str) -> String {
    format!(
        "Command: `flexdrill bench --cases real-time --duration {duration}`, `{name}`. {}\n\n{tables}",
        machine::describe()
    )
}

fn speed_row(name: &str, measured: &Measured) -> [String; 8] {
    let times = |times| {
        let [p50, p99, p999, max] = percentiles(times);
        format!("{p50:.3}, {p99:.3}, {p999:.3}, {max:.2}")
    };
    [
        name.to_owned(),
        format!("{:.2}", measured.real_time_factor()),
        format!("{:.2}", measured.processor_factor()),
        times(&measured.step_times),
        times(&measured.frame_times),
        format!("{:.2}, {}", measured.iterations(), measured.most_iterations),
        format!("{}, {}", measured.counters.halved_steps, measured.counters.rejected),
        format!("{:.3} %", measured.energy_error()),
    ]
}
