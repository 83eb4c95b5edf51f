//! `flexdrill paper`: the paper's figures and findings from a run, or the search for parameters that agree with them.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::built_in::BuiltIn;
use super::numbers;
use super::progress::Progress;
use crate::cli::output::{say, tell};
use flexdrill_paper::hinge::Hinge;
use flexdrill_paper::search::{self, Outcome, Plan, Stage};
use flexdrill_paper::{
    Case, Finding, PaperError, Record, Report, Verdict, figures, findings, findings_csv, record, write_figures,
    write_text,
};
use flexdrill_text::counted;

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
    /// Turns recorded, after two at full speed; trials of a search have at most four, after one.
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
    /// Search for parameter sets instead; writes search.csv with a line per trial.
    #[arg(long)]
    search: bool,
    #[command(flatten)]
    plan: PlanArgs,
}

/// The plan of `--search`.
#[derive(Debug, Args)]
struct PlanArgs {
    /// Mesh of the Latin hypercube [default: config/coarse.yaml, built in].
    #[arg(long, requires = "search")]
    coarse: Option<PathBuf>,
    /// Mesh of all other stages [default: config/default.yaml, built in].
    #[arg(long, requires = "search")]
    full: Option<PathBuf>,
    /// Points of the Latin hypercube.
    #[arg(long, default_value_t = 60, requires = "search", value_parser = numbers::count())]
    points: usize,
    /// Descents (evolution strategy) from the best trials that are far apart.
    #[arg(long, default_value_t = 2, requires = "search", value_parser = numbers::count())]
    descents: usize,
    /// Generations of each descent.
    #[arg(long, default_value_t = 12, requires = "search", value_parser = numbers::count())]
    generations: usize,
    /// Trials per generation.
    #[arg(long, default_value_t = 12, requires = "search", value_parser = numbers::count())]
    per_generation: usize,
    /// Best trials repeated with the full record of eight turns.
    #[arg(long, default_value_t = 3, requires = "search", value_parser = numbers::count())]
    finalists: usize,
    /// Seed of the plan.
    #[arg(long, default_value_t = 20_240_327, requires = "search")]
    seed: u64,
}

/// Turns recorded per trial of the search, or --turns if that is less: the finalists have all of these.
const SEARCH_TURNS: f64 = 4.0;

/// Runs the subcommand.
///
/// # Errors
/// When a configuration is refused, a run or its energy audit fails, or a file cannot be written.
pub fn run(args: &PaperArgs) -> anyhow::Result<()> {
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    if args.search {
        search_parameters(args)
    } else {
        draw(args)
    }
}

fn case(args: &PaperArgs) -> anyhow::Result<Case> {
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
    let mut case = Case::new(config.with_values("parameter", values)?);
    case.rotary_speed_rpm = args.rpm.unwrap_or(case.rotary_speed_rpm);
    case.weight_on_bit_kn = args.wob.unwrap_or(case.weight_on_bit_kn);
    case.turns = args.turns;
    Ok(case)
}

fn recorded(case: &Case, what: &str) -> Result<Record, PaperError> {
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
    let half: Option<Vec<Finding>> = if args.no_step_check {
        None
    } else {
        let step = 0.5 * case.config.solver.time_step;
        let half = Case {
            config: case.config.with_value("solver.time_step", step)?,
            ..case.clone()
        };
        Some(findings(&recorded(&half, "the same at half the step")?))
    };
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
    write_text(&args.out, "findings.csv", &findings_csv(&found))?;
    write_text(&args.out, "report.md", &report.markdown())?;
    write_text(&args.out, "report.html", &report.html())?;
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

fn search_parameters(args: &PaperArgs) -> anyhow::Result<()> {
    let plan = Plan {
        coarse: BuiltIn::Coarse.or_file(args.plan.coarse.as_deref())?,
        full: BuiltIn::Default.or_file(args.plan.full.as_deref())?,
        points: args.plan.points,
        descents: args.plan.descents,
        generations: args.plan.generations,
        per_generation: args.plan.per_generation,
        finalists: args.plan.finalists,
        seed: args.plan.seed,
        turns: args.turns.min(SEARCH_TURNS),
        full_turns: args.turns,
    };
    let path = args.out.join("search.csv");
    let mut earlier = earlier_lines(&path)?;
    let mut table = csv::Writer::from_path(&path).with_context(|| format!("cannot write {}", path.display()))?;
    table.write_record(search::csv_header())?;
    let mut progress = Progress::counted(plan.total() as f64);
    let known = |index: usize, stage: Stage, parameters: &[String]| {
        let line = earlier.get_mut(index).map(std::mem::take).unwrap_or_default();
        Ok(Outcome::earlier(line, index, stage.word(), parameters))
    };
    let trials = search::run(&plan, known, |trial| -> anyhow::Result<()> {
        table.write_record(trial.csv())?;
        // A long search that is stopped keeps the trials so far.
        table.flush()?;
        progress.at((trial.index + 1) as f64);
        Ok(())
    })?;
    progress.done();
    for (stage, trial) in search::leaders(&trials) {
        let (closeness, agree) = trial.outcome.score();
        say!(
            "{stage:<12} best: trial {:>4}, score {closeness:.3}, {agree} agree",
            trial.index
        );
        if stage == Stage::Confirmation.word() {
            let name = "best.yaml";
            let config = trial.config(&plan.full)?;
            write_text(Path::new(&args.out), name, &config.to_yaml()?)?;
            say!("wrote {}", args.out.join(name).display());
        }
    }
    say!("{}: {}", counted(trials.len() as u64, "trial"), path.display());
    Ok(())
}

/// Lines of the table of a search that was stopped, if there is one.
fn earlier_lines(path: &Path) -> anyhow::Result<Vec<Vec<String>>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut table = csv::ReaderBuilder::new().flexible(true).from_path(path)?;
    let mut lines = Vec::new();
    for line in table.records() {
        lines.push(line?.iter().map(str::to_owned).collect());
    }
    Ok(lines)
}
