//! `flexdrill bench`: runs at constant inputs as fast as they go, with the figures that `docs/measurements.md` quotes.

#[cfg(feature = "bridge")]
mod first_sample;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::built_in::BuiltIn;
use super::progress::Progress;
use super::{WrongUse, numbers};
use crate::cli::output::{say, say_text, tell};
use flexdrill_bench::measure::{Load, Measured, percentiles};
use flexdrill_bench::table::Table;
use flexdrill_bench::{ChangeError, batch, machine, measure, real_time};
use flexdrill_config::Config;
use flexdrill_core::Instructions;
use flexdrill_core::dynamics::phases::Phase;
use flexdrill_core::twin::ModelQuality;
use flexdrill_text::percent;

/// Runs a configuration at constant inputs as fast as it goes and prints its speed and its figures, as Markdown.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Configurations to run, one after another; with --cases the first one [default: config/default.yaml, without
    /// --cases also config/coarse.yaml, both built in].
    #[arg(long = "config", value_name = "FILE")]
    configs: Vec<PathBuf>,
    /// A set of runs instead of a single one.
    #[arg(long, value_enum)]
    cases: Option<Cases>,
    /// Model time after the static start (s) [default: 20; 60 with --cases real-time].
    #[arg(long, value_parser = numbers::seconds)]
    duration: Option<f64>,
    /// Rotary speed (r/min).
    #[arg(long, default_value_t = 40.0, value_parser = numbers::rpm)]
    rpm: f64,
    /// Weight on bit (kN), on from the start; --cases have their own.
    #[arg(long, default_value_t = 10.0, value_parser = numbers::kilonewton)]
    wob: f64,
    /// Another model step than the configuration's (s).
    #[arg(long, value_parser = numbers::time_step)]
    time_step: Option<f64>,
    /// Values to change, as KEY=VALUE with the key's dotted path (may be given more than once).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Vector instructions to use at most, to see what another machine would do [default: the best that this one has].
    #[arg(long, value_enum)]
    instructions: Option<Vectors>,
}

/// [`Instructions`] on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Vectors {
    /// Without any.
    Portable,
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Vectors {
    const fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => "avx512",
        }
    }
}

/// Sets of runs. Those that take minutes to hours are `cargo xtask measure`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Cases {
    /// The tool as it is and harder ones, with speed, iterations, energy error and time per phase.
    RealTime,
    /// Forks as look-aheads, maps and sweeps run them, on one core and on several, alone and next to a live run; the
    /// duration is wall time per row.
    Batch,
    /// Made recorders that are plugged into a bridge, with the time to the first sample at a twin's input.
    #[cfg(feature = "bridge")]
    FirstSample,
}

/// Runs the subcommand.
///
/// # Errors
/// When a configuration is refused, or a step fails.
pub fn run(args: &BenchArgs) -> anyhow::Result<()> {
    if let Some(duration) = args.duration
        && !(duration > 0.0 && duration.is_finite())
    {
        return Err(WrongUse::new(format!("--duration {duration}: a time above 0 s")).into());
    }
    match args.cases {
        Some(cases) => run_cases(args, cases),
        None => run_plain(args),
    }
}

/// The vector instructions that are asked for, or the best that this machine has.
fn instructions(args: &BenchArgs) -> anyhow::Result<Instructions> {
    let Some(asked) = args.instructions else {
        return Ok(Instructions::best());
    };
    Instructions::available()
        .find(|instructions| instructions.name() == asked.name())
        .ok_or_else(|| WrongUse::new(format!("--instructions: this machine does not have {}", asked.name())).into())
}

fn run_cases(args: &BenchArgs, cases: Cases) -> anyhow::Result<()> {
    let (name, config) = match args.configs.first() {
        Some(path) => (path.display().to_string(), load(BuiltIn::Default, Some(path), args)?),
        None => (BuiltIn::Default.file().to_owned(), load(BuiltIn::Default, None, args)?),
    };
    let constant = Load {
        rpm: args.rpm,
        wob: args.wob,
        instructions: instructions(args)?,
    };
    let (title, section) = match cases {
        Cases::RealTime => {
            let duration = args.duration.unwrap_or(60.0);
            let tables = real_time::tables(&config, constant, duration, |line| tell!("{line}"))?;
            ("real-time", real_time::section(&name, duration, &tables))
        }
        Cases::Batch => {
            let duration = args.duration.unwrap_or(20.0);
            let tables = batch::tables(&config, constant, duration, |line| tell!("{line}"))?;
            ("batch", batch::section(&name, duration, &tables))
        }
        #[cfg(feature = "bridge")]
        Cases::FirstSample => {
            if args.duration.is_some() {
                return Err(
                    WrongUse::new("--duration: the recorders of --cases first-sample have their own times").into(),
                );
            }
            ("first-sample", first_sample::section(&config, |line| tell!("{line}"))?)
        }
    };
    say!("\n### {title}\n\n{section}");
    Ok(())
}

/// The configurations asked for, or both shipped meshes.
fn named(args: &BenchArgs) -> anyhow::Result<Vec<(String, Config)>> {
    if args.configs.is_empty() {
        let usual = [BuiltIn::Default, BuiltIn::Coarse].into_iter();
        return usual
            .map(|usual| Ok((usual.file().to_owned(), load(usual, None, args)?)))
            .collect();
    }
    let given = args.configs.iter();
    given
        .map(|path| Ok((path.display().to_string(), load(BuiltIn::Default, Some(path), args)?)))
        .collect()
}

fn run_plain(args: &BenchArgs) -> anyhow::Result<()> {
    let duration = args.duration.unwrap_or(20.0);
    for (path, config) in named(args)? {
        say!("\n### {path}, {} r/min, {} kN, {duration} s\n", args.rpm, args.wob);
        let load = Load {
            rpm: args.rpm,
            wob: args.wob,
            instructions: instructions(args)?,
        };
        let mut progress = Progress::new(duration);
        let measured = measure::run(&config, load, duration, |time| progress.at(time))?;
        progress.done();
        say_text!("{}", figures_of(&measured).text());
        if let Some(failure) = measured.failure {
            anyhow::bail!("a step failed at model time {:.4} s: {}", failure.time, failure);
        }
    }
    Ok(())
}

/// The configuration with the changes that the command line asks for.
fn load(usual: BuiltIn, path: Option<&std::path::Path>, args: &BenchArgs) -> anyhow::Result<Config> {
    let config = usual.or_file(path)?;
    flexdrill_bench::changed(config, args.time_step, &args.set).map_err(|error| match error {
        ChangeError::NoPair(_) => WrongUse::new(error.to_string()).into(),
        _ => error.into(),
    })
}

/// Word, share and cause.
fn quality_of(quality: &ModelQuality) -> String {
    let share = percent(quality.energy_error_share);
    let cause = quality.to_string();
    let cause = if cause.is_empty() { cause } else { format!(": {cause}") };
    format!("{}, energy error {share} of what vibration loses{cause}", quality.level)
}

// Rows are strings, because each figure has its own unit and digits.
fn figures_of(measured: &Measured) -> Table {
    let mut table = Table::new(["figure", "value"]);
    let mut row = |figure: &str, value: String| table.row([figure.to_owned(), value]);
    // Percentiles next to the median: the deadline of real time is missed by the tail.
    let milliseconds = |times| percentiles(times).map(|time| format!("{time:.3}")).join(", ");
    row("static start", format!("{:.3} s", measured.start));
    row(
        "unknowns, step",
        format!("{}, {} ms", measured.unknowns, 1e3 * measured.time_step),
    );
    // Processor time next to wall time: on a shared machine the first shows the program, the second the neighbours.
    row(
        "real-time factor, of processor time",
        format!("{:.2}, {:.2}", measured.real_time_factor(), measured.processor_factor()),
    );
    row(
        "step: median, p99, p99.9, max",
        format!("{} ms", milliseconds(&measured.step_times)),
    );
    row(
        "frame of 20 ms: median, p99, p99.9, max",
        format!("{} ms", milliseconds(&measured.frame_times)),
    );
    // Phases of the step in its order, in microseconds, to see which part a change has moved.
    row(
        "time per step",
        format!(
            "{} us",
            Phase::ALL
                .map(|phase| format!("{} {:.1}", phase.name(), measured.phase(phase)))
                .join(", ")
        ),
    );
    row(
        "Newton iterations per step: mean, most",
        format!("{:.2}, {}", measured.iterations(), measured.most_iterations),
    );
    let counters = &measured.counters;
    row(
        "halved, rejected, failed steps",
        format!(
            "{}, {}, {}",
            counters.halved_steps, counters.rejected, counters.failed_steps
        ),
    );
    row("model quality", quality_of(&measured.last.quality));
    measured.figures.rows(&measured.last, &mut table);
    let energy = &measured.energy;
    // The error stands next to the terms of the balance: only against
    // them does it say whether the scheme keeps the energy.
    table.row([
        "energy: drive, bit, friction, error".into(),
        format!(
            "{:.0}, {:.0}, {:.0}, {:.2} J ({:.3} %)",
            energy.drive,
            energy.bit,
            energy.friction,
            energy.error,
            measured.energy_error()
        ),
    ]);
    // The peak comes from the kernel, because no allocator counts what libraries map.
    table.row([
        "peak memory".into(),
        machine::status_kb("VmHWM:").map_or_else(|| "unknown".to_owned(), |kb| format!("{kb} kB")),
    ]);
    table
}
