//! `flexdrill bench`: runs at constant inputs as fast as they go, with the figures that `docs/measurements.md` quotes.

mod cases;
mod document;
mod figures;
mod machine;
mod measure;
mod memory;
mod quality;
mod real_time;
mod scaling;
mod step_error;
mod truth;

use std::path::PathBuf;

use anyhow::Context as _;
use clap::{Args, ValueEnum};

use self::document::Table;
use self::measure::{Load, Measured, percentiles};
use super::built_in::BuiltIn;
use super::{WrongUse, numbers};
use crate::cli::output::{say, say_text, tell};
use flexdrill_config::Config;
use flexdrill_core::Instructions;
use flexdrill_core::dynamics::phases::Phase;
use flexdrill_core::twin::ModelQuality;

/// Runs a configuration at constant inputs as fast as it goes and prints its speed and its figures, as Markdown.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Configurations to run, one after another; with --cases the first one, of step-error the others too, as they are
    /// [default: config/default.yaml, without --cases and of step-error also config/coarse.yaml, both built in].
    #[arg(long = "config", value_name = "FILE")]
    configs: Vec<PathBuf>,
    /// A set of runs instead of a single one.
    #[arg(long, value_enum)]
    cases: Option<Cases>,
    /// Writes the tables of --cases into this document, between its markers.
    #[arg(long, value_name = "DOCUMENT", requires = "cases")]
    write: Option<PathBuf>,
    /// Model time after the static start (s) [default: 20; 60 real-time, 10 scaling, 3600 memory,
    /// 30 step-error and quality, 40 truth].
    #[arg(long, value_parser = numbers::seconds)]
    duration: Option<f64>,
    /// Runs per row of truth; their mean and its error are told.
    #[arg(long, default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// Rotary speed (r/min).
    #[arg(long, default_value_t = 40.0, value_parser = numbers::rpm)]
    rpm: f64,
    /// Weight on bit (kN), on from the start; real-time, step-error and quality have their own.
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

/// Sets of runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Cases {
    /// The tool as it is and three harder ones, with speed, iterations, energy error and time per phase.
    RealTime,
    /// 8 to 132 links.
    Scaling,
    /// Resident memory over an hour of model time.
    Memory,
    /// The step against an eighth of it, for the same tools: minutes each.
    StepError,
    /// Statistics of the same tools with an eighth, a quarter, half of the step and all of it, over several runs each: an hour.
    Truth,
    /// What `model_quality` says of the same tools, of others and of poor steps, against an eighth of the step: an hour.
    Quality,
    /// All of them.
    All,
}

impl Cases {
    fn each(self) -> &'static [Self] {
        match self {
            Self::All => &[
                Self::RealTime,
                Self::StepError,
                Self::Truth,
                Self::Quality,
                Self::Scaling,
                Self::Memory,
            ],
            Self::RealTime => &[Self::RealTime],
            Self::Scaling => &[Self::Scaling],
            Self::Memory => &[Self::Memory],
            Self::StepError => &[Self::StepError],
            Self::Truth => &[Self::Truth],
            Self::Quality => &[Self::Quality],
        }
    }

    /// As on the command line and in the markers.
    fn name(self) -> &'static str {
        match self {
            Self::RealTime => "real-time",
            Self::Scaling => "scaling",
            Self::Memory => "memory",
            Self::StepError => "step-error",
            Self::Truth => "truth",
            Self::Quality => "quality",
            Self::All => "all",
        }
    }

    /// s.
    fn usual_duration(self) -> f64 {
        match self {
            Self::RealTime => 60.0,
            Self::StepError | Self::Quality => 30.0,
            Self::Truth => 40.0,
            Self::Scaling => 10.0,
            Self::Memory | Self::All => 3600.0,
        }
    }
}

/// Runs the subcommand.
///
/// # Errors
/// When a configuration is refused, a step fails, or the document cannot be written.
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
    if let Some(document) = &args.write {
        for case in cases.each() {
            document::check(document, case.name())?;
        }
    }
    let constant = Load {
        rpm: args.rpm,
        wob: args.wob,
        instructions: instructions(args)?,
    };
    for case in cases.each() {
        let duration = args.duration.unwrap_or_else(|| case.usual_duration());
        let tables = match case {
            Cases::RealTime => real_time::tables(&config, constant, duration)?,
            Cases::StepError => step_error::tables(&named(args)?, args.rpm, duration)?,
            Cases::Truth => truth::tables(&config, args.rpm, duration, args.runs)?,
            Cases::Quality => quality::tables(&config, args.rpm, duration)?,
            Cases::Scaling => scaling::tables(&config, constant, duration)?,
            Cases::Memory | Cases::All => memory::tables(&config, constant, duration)?,
        };
        let runs = match case {
            Cases::Truth => format!(" --runs {}", args.runs),
            _ => String::new(),
        };
        let text = format!(
            "Command: `flexdrill bench --cases {}{runs} --duration {duration}`, `{}`. {}\n\n{tables}",
            case.name(),
            name,
            machine::describe()
        );
        say!("\n### {}\n\n{text}", case.name());
        if let Some(document) = &args.write {
            document::write(document, case.name(), &text)?;
            tell!("written to {}", document.display());
        }
    }
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
        let measured = measure::run(&config, load, duration, |_| {})?;
        say_text!("{}", figures_of(&measured).text());
        if let Some(failure) = measured.failure {
            anyhow::bail!("a step failed at model time {:.4} s: {}", failure.time, failure);
        }
    }
    Ok(())
}

/// The configuration with the changes that the command line asks for.
fn load(usual: BuiltIn, path: Option<&std::path::Path>, args: &BenchArgs) -> anyhow::Result<Config> {
    let mut config = usual.or_file(path)?;
    if let Some(step) = args.time_step {
        config = config.with_value("solver.time_step", step)?;
    }
    for change in &args.set {
        let (key, value) = change
            .split_once('=')
            .ok_or_else(|| WrongUse::new(format!("--set {change}: expected KEY=VALUE")))?;
        // What is no number, true or false is a word, such as `shared`.
        let value = serde_json::from_str(value).unwrap_or_else(|_| serde_json::Value::from(value));
        config = config
            .with_value(key, value)
            .with_context(|| format!("--set {change}"))?;
    }
    Ok(config)
}

/// Word, share and cause.
fn quality_of(quality: &ModelQuality) -> String {
    let share = 100.0 * quality.energy_error_share;
    let cause = quality.to_string();
    let cause = if cause.is_empty() { cause } else { format!(": {cause}") };
    format!(
        "{}, energy error {share:.0} % of what vibration loses{cause}",
        quality.level
    )
}

fn figures_of(measured: &Measured) -> Table {
    let mut table = Table::new(["figure", "value"]);
    let mut row = |figure: &str, value: String| table.row([figure.to_owned(), value]);
    let milliseconds = |times| percentiles(times).map(|time| format!("{time:.3}")).join(", ");
    row("static start", format!("{:.3} s", measured.start));
    row(
        "unknowns, step",
        format!("{}, {} ms", measured.unknowns, 1e3 * measured.time_step),
    );
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
    table.row([
        "peak memory".into(),
        machine::status_kb("VmHWM:").map_or_else(|| "unknown".to_owned(), |kb| format!("{kb} kB")),
    ]);
    table
}
