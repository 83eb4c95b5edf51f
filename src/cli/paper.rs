//! `flexdrill paper`: the paper's figures and findings from a run.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::built_in::BuiltIn;
use super::numbers;
use super::progress::Progress;
use crate::cli::output::{say, tell};
use flexdrill_paper::hinge::Hinge;
use flexdrill_paper::{
    Finding, PaperError, Record, Report, Setup, Verdict, figures, findings, findings_csv, record, write_figures,
    write_text,
};

/// Runs the paper's case and writes its figures 9 to 17 (SVG, CSV), findings and a report.
#[derive(Debug, Args)]
pub struct PaperArgs {
    /// Folder for the results, created if necessary.
    #[arg(long)]
    out: PathBuf,
    /// The tool [default: config/paper.yaml, built in, the parameter set that agrees best].
    #[arg(long)]
    config: Option<PathBuf>,
    /// Rotary speed (r/min), instead of inputs.rotary_speed.initial_rpm (40 if that is 0).
    #[arg(long, value_parser = numbers::rpm)]
    rpm: Option<f64>,
    /// Weight on bit (kN), instead of inputs.weight_on_bit.initial_kn (10 if that is 0).
    #[arg(long, value_parser = numbers::kilonewton)]
    wob: Option<f64>,
    /// Turns recorded, after two at full speed.
    #[arg(long, default_value_t = 8.0, value_parser = numbers::turns)]
    turns: f64,
    /// Another model step than the configuration's (s).
    #[arg(long, value_parser = numbers::time_step)]
    time_step: Option<f64>,
    /// Values to change, as KEY=VALUE with the key's dotted path (may be given more than once).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Omit the second run at half the step, which shows the step's error.
    #[arg(long)]
    no_step_check: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When a configuration is refused, a run or its energy audit fails, or a file cannot be written.
pub fn run(args: &PaperArgs) -> anyhow::Result<()> {
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    draw(args)
}

fn case(args: &PaperArgs) -> anyhow::Result<Setup> {
    let mut config = BuiltIn::Paper.or_file(args.config.as_deref())?;
    if let Some(step) = args.time_step {
        config = config.with_value("solver.time_step", step)?;
    }
    let mut values = Vec::new();
    for change in &args.set {
        let (key, value) = change
            .split_once('=')
            .ok_or_else(|| super::WrongUse::new(format!("--set {change}: expected KEY=VALUE")))?;
        // A whole number stays whole, as `tool.links` requires.
        let whole = value.parse::<i64>().map(serde_json::Value::from);
        let number = || value.parse::<f64>().map(serde_json::Value::from);
        let value = whole.or_else(|_| number()).unwrap_or_else(|_| value.into());
        values.push((key, value));
    }
    let mut case = Setup::new(config.with_values("parameter", values)?);
    case.rotary_speed_rpm = args.rpm.unwrap_or(case.rotary_speed_rpm);
    case.weight_on_bit_kn = args.wob.unwrap_or(case.weight_on_bit_kn);
    case.turns = args.turns;
    Ok(case)
}

fn recorded(case: &Setup, what: &str) -> Result<Record, PaperError> {
    tell!(
        "{what}: {:.1} s of model time at a step of {} ms",
        case.times()[1],
        1e3 * case.config.solver.time_step
    );
    let mut progress = Progress::new(case.times()[1]);
    let result = record(case, |time| progress.at(time));
    progress.done();
    result
}

fn draw(args: &PaperArgs) -> anyhow::Result<()> {
    let case = case(args)?;
    let run = recorded(&case, "run")?;
    let found = findings(&run);
    // The run at the configured step is the one that is shown; the same at half the step says how far its findings
    // depend on it.
    let half: Option<Vec<Finding>> = if args.no_step_check {
        None
    } else {
        let step = 0.5 * case.config.solver.time_step;
        let half = Setup {
            config: case.config.with_value("solver.time_step", step)?,
            ..case.clone()
        };
        Some(findings(&recorded(&half, "the same at half the step")?))
    };
    // The hinge of Fig. 9 is a separate case, a hinged beam in a tube, and takes some seconds.
    tell!("the hinge of Fig. 9");
    let hinge = Hinge::run()?;
    let figures = write_figures(&args.out, figures::figures(&run, &hinge))?;
    let report = Report {
        case: &case,
        record: &run,
        findings: &found,
        half_step: half.as_deref(),
        hinge: &hinge,
        figures: &figures,
    };
    // The findings are written before the pages that refer to them: the table then exists even if a page cannot be
    // written.
    write_text(&args.out, "findings.csv", &findings_csv(&found))?;
    write_text(&args.out, "report.md", &report.markdown())?;
    write_text(&args.out, "report.html", &report.html())?;
    // Verdicts in the terminal too: they are the result, and the files are their evidence.
    say!("{:<16} {:<6} {:<8} ours", "finding", "figure", "agrees?");
    for finding in &found {
        say!(
            "{:<16} {:<6} {:<8} {}",
            finding.key,
            finding.figure,
            finding.verdict.word(),
            finding.ours
        );
    }
    let agree = found.iter().filter(|f| f.verdict == Verdict::Agrees).count();
    say!(
        "{agree} of {} agree; energy error {:.1e} of the drive's work; report: {}",
        found.len(),
        run.energy_error(),
        args.out.join("report.html").display()
    );
    Ok(())
}
