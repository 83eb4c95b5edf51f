//! `cargo xtask measure`: the measurements of `docs/measurements.md` that take minutes to hours.

mod calibration;
mod document;
mod faults;
mod memory;
mod parts;
mod physics;
mod quality;
mod rig_map;
mod scaling;
mod step_error;
mod truth;

use std::path::{Path, PathBuf};

use anyhow::ensure;
use clap::{Parser, ValueEnum};

use flexdrill_bench::measure::Load;
use flexdrill_bench::{changed, machine, real_time};
use flexdrill_config::Config;
use flexdrill_core::Instructions;

/// Runs a set of measurements and prints its tables, as Markdown.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask measure")]
struct Measurements {
    /// Configurations to run; the first one, of step-error the others too [default: config/default.yaml, of step-error
    /// also config/coarse.yaml].
    #[arg(long = "config", value_name = "FILE")]
    configs: Vec<PathBuf>,
    /// The set of runs.
    #[arg(long, value_enum)]
    cases: Cases,
    /// Writes the tables into this document, between its markers.
    #[arg(long, value_name = "DOCUMENT")]
    write: Option<PathBuf>,
    /// Model time after the static start (s) [default: 60 real-time, 10 scaling and physics, 3600 memory, 30 step-error and quality,
    /// 86400 rig-faults: the length of a run without a fault,
    /// 40 truth and rig-truth, 60 rig-map].
    #[arg(long)]
    duration: Option<f64>,
    /// Runs per row of truth and rig-truth, which show their mean and its error; logs of calibration.
    #[arg(long, default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// Logs of calibration whose result is checked by full runs, up to 18 each.
    #[arg(long, default_value_t = 3)]
    checked: u32,
    /// Folder in which truth, rig-truth and calibration keep every run that is done: the same command continues from
    /// there.
    #[arg(long, value_name = "FOLDER")]
    parts: Option<PathBuf>,
    /// Only the first so many cases of truth and rig-truth.
    #[arg(long, value_name = "N")]
    first: Option<usize>,
    /// Runs of truth, rig-truth, rig-map and calibration at the same time, a thread each. The figures do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64))]
    jobs: u8,
    /// Rotary speed (r/min).
    #[arg(long, default_value_t = 40.0)]
    rpm: f64,
    /// Weight on bit (kN) of scaling and memory, on from the start.
    #[arg(long, default_value_t = 10.0)]
    wob: f64,
    /// Another model step than the configuration's (s).
    #[arg(long)]
    time_step: Option<f64>,
    /// Values to change, as KEY=VALUE with the key's dotted path (may be given more than once).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Sets of runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Cases {
    /// The tool as it is and harder ones, with speed, iterations, energy error and time per phase; also `flexdrill bench
    /// --cases real-time`.
    RealTime,
    /// 8 to 132 links.
    Scaling,
    /// What each piece of the rig's physics costs; of config/rig.yaml unless another is named.
    Physics,
    /// Resident memory over an hour of model time.
    Memory,
    /// The step against an eighth of it, for the same tools: minutes each.
    StepError,
    /// Statistics of the same tools with an eighth, a quarter, half of the step and all of it, over several runs each: an
    /// hour.
    Truth,
    /// The same of a tool below a string, with what arrives at the bit; of config/rig.yaml unless another is named.
    RigTruth,
    /// `model_quality` of the same tools, of others and of poor steps, against an eighth of the step: an hour.
    Quality,
    /// The same for a tool below a string, where mud and rubbing take energy too; of config/rig.yaml unless another is
    /// named.
    RigQuality,
    /// Faults of the rig and the alarm of the comparison with the twin; of config/rig.yaml unless another is named.
    RigFaults,
    /// Stick-slip index and rate of penetration over speed and weight, with three guides, and their picture; of
    /// config/rig.yaml unless another is named.
    RigMap,
    /// How often the bands of a calibration hold the truth of full runs; of config/rig.yaml unless another is named.
    Calibration,
    /// All of them.
    All,
}

impl Cases {
    fn each(&self) -> &[Self] {
        match self {
            Self::All => &[
                Self::RealTime,
                Self::StepError,
                Self::Truth,
                Self::RigTruth,
                Self::Quality,
                Self::RigQuality,
                Self::RigFaults,
                Self::RigMap,
                Self::Calibration,
                Self::Scaling,
                Self::Physics,
                Self::Memory,
            ],
            one => std::slice::from_ref(one),
        }
    }

    /// As on the command line and in the markers.
    fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Model time (s).
    fn usual_duration(self) -> f64 {
        match self {
            Self::RealTime => 60.0,
            Self::StepError | Self::Quality | Self::RigQuality => 30.0,
            Self::Truth | Self::RigTruth => 40.0,
            Self::RigMap => 60.0,
            Self::Scaling | Self::Physics => 10.0,
            Self::Memory | Self::All => 3600.0,
            Self::RigFaults => 86_400.0,
            // Each run lasts until its means have settled.
            Self::Calibration => 0.0,
        }
    }
}

fn main() -> anyhow::Result<()> {
    let args = Measurements::parse();
    if let Some(duration) = args.duration {
        ensure!(
            duration > 0.0 && duration.is_finite(),
            "--duration {duration}: a time above 0 s"
        );
    }
    let configs = configurations(&args)?;
    if let Some(document) = &args.write {
        for case in args.cases.each() {
            document::check(document, &case.name())?;
        }
    }
    for case in args.cases.each() {
        let text = measure(*case, &configs, &args)?;
        println!("\n### {}\n\n{text}", case.name());
        if let Some(document) = &args.write {
            document::write(document, &case.name(), &text)?;
            eprintln!("written to {}", document.display());
        }
    }
    Ok(())
}

/// The configurations with their names: those asked for, or both shipped meshes.
fn configurations(args: &Measurements) -> anyhow::Result<Vec<(String, Config)>> {
    let usual = ["config/default.yaml", "config/coarse.yaml"].map(PathBuf::from);
    let files = if args.configs.is_empty() {
        &usual[..]
    } else {
        &args.configs[..]
    };
    let load = |file: &PathBuf| {
        Ok((
            file.display().to_string(),
            changed(Config::load(file)?, args.time_step, &args.set)?,
        ))
    };
    files.iter().map(load).collect()
}

/// Runs one set, and gives its section.
fn measure(case: Cases, configs: &[(String, Config)], args: &Measurements) -> anyhow::Result<String> {
    let (name, config) = &configs[0];
    // Sets of the rig's tool have another configuration.
    let of_the_rig = matches!(
        case,
        Cases::Physics | Cases::RigTruth | Cases::RigQuality | Cases::RigFaults | Cases::RigMap | Cases::Calibration
    ) && args.configs.is_empty();
    // The options apply to the rig's configuration as well, since it is loaded here and not with the others.
    let load = |file: &str| anyhow::Ok(changed(Config::load(file)?, args.time_step, &args.set)?);
    let rig = of_the_rig.then(|| load("config/rig.yaml")).transpose()?;
    let (name, config) = match &rig {
        Some(rig) => ("config/rig.yaml", rig),
        None => (name.as_str(), config),
    };
    // Each case has a duration in which its statistics settle.
    let duration = args.duration.unwrap_or_else(|| case.usual_duration());
    let constant = Load {
        rpm: args.rpm,
        wob: args.wob,
        instructions: Instructions::best(),
    };
    let tables = match case {
        Cases::RealTime => {
            let tables = real_time::tables(config, constant, duration, |line| eprintln!("{line}"))?;
            // Real time has its own head: it is quoted elsewhere.
            return Ok(real_time::section(name, duration, &tables));
        }
        Cases::StepError => step_error::tables(configs, args.rpm, duration)?,
        Cases::Truth | Cases::RigTruth => {
            let of_the_rig = case == Cases::RigTruth;
            truth::tables(&truth::Plan {
                config,
                rpm: args.rpm,
                duration,
                runs: args.runs,
                steps: if of_the_rig { truth::RIG_STEPS } else { truth::STEPS },
                with_transfer: of_the_rig,
                first: args.first.unwrap_or(usize::MAX),
                jobs: args.jobs.into(),
                parts: args.parts.as_ref().map(|folder| folder.join(case.name())),
            })?
        }
        Cases::RigFaults => faults::tables(config, duration)?,
        Cases::RigMap => {
            let (tables, figure) = rig_map::tables(config, duration, args.jobs.into())?;
            // The picture is only written next to the document that shows it.
            if let Some(folder) = args.write.as_deref().and_then(Path::parent) {
                std::fs::write(folder.join("images/rig_map.svg"), flexdrill_plot::svg(&figure)?)?;
            }
            tables
        }
        Cases::Calibration => calibration::tables(&calibration::Plan {
            config,
            logs: args.runs as usize,
            checked: args.checked as usize,
            jobs: args.jobs.into(),
            parts: args.parts.as_ref().map(|folder| folder.join(case.name())),
        })?,
        Cases::Quality => quality::tables(config, args.rpm, duration, quality::STEPS)?,
        Cases::RigQuality => quality::tables(config, args.rpm, duration, quality::RIG_STEPS)?,
        Cases::Physics => physics::tables(config, &load("config/default.yaml")?, constant, duration)?,
        Cases::Scaling => scaling::tables(config, constant, duration)?,
        // `All` is resolved by the caller; it stands here to complete the match.
        Cases::Memory | Cases::All => memory::tables(config, constant, duration)?,
    };
    // The command is printed with the options that determine the figures, so that a reader can repeat it.
    let options = match case {
        Cases::Truth | Cases::RigTruth => {
            let first = args.first.map_or_else(String::new, |first| format!(" --first {first}"));
            format!(" --runs {}{first} --duration {duration}", args.runs)
        }
        Cases::Calibration => {
            let config = args.configs.first();
            let config = config.map_or_else(String::new, |file| format!(" --config {}", file.display()));
            format!("{config} --runs {} --checked {}", args.runs, args.checked)
        }
        _ => format!(" --duration {duration}"),
    };
    Ok(format!(
        "Command: `cargo xtask measure --cases {}{options}`, `{name}`. {}\n\n{tables}",
        case.name(),
        machine::describe()
    ))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Measurements::command().debug_assert();
        let args = Measurements::try_parse_from(["bench", "--cases", "step-error", "--duration", "3"]).unwrap();
        assert_eq!((args.cases, args.duration), (Cases::StepError, Some(3.0)));
        assert!(Measurements::try_parse_from(["bench"]).is_err(), "a set must be named");
    }

    #[test]
    fn every_set_has_its_markers_in_the_document() {
        let measurements = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/measurements.md"));
        for case in Cases::All.each() {
            document::check(&measurements, &case.name()).unwrap();
        }
    }

    #[test]
    fn a_set_runs_and_says_its_command() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let config = format!("{root}/tests/data/small.yaml");
        let args =
            Measurements::try_parse_from(["bench", "--cases", "scaling", "--duration", "0.05", "--config", &config]);
        let args = args.unwrap();
        let text = measure(args.cases, &configurations(&args).unwrap(), &args).unwrap();
        assert!(
            text.starts_with("Command: `cargo xtask measure --cases scaling --duration 0.05`"),
            "{text}"
        );
        assert!(text.contains("| 132 |"), "{text}");
    }
}
