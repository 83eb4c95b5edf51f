//! `cargo xtask search`.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Args;

use super::outcome::{Outcome, csv_header};
use super::plan::{self, Plan, Stage, leaders};
use flexdrill_config::Config;
use flexdrill_paper::write_text;

/// What is tried, and where the table is.
#[derive(Debug, Args)]
pub(crate) struct SearchArgs {
    /// Folder for the results, created if necessary; a search that was stopped continues there.
    #[arg(long)]
    out: PathBuf,
    /// Mesh of the Latin hypercube.
    #[arg(long, default_value = "config/coarse.yaml")]
    coarse: PathBuf,
    /// Mesh of all other stages.
    #[arg(long, default_value = "config/default.yaml")]
    full: PathBuf,
    /// Points of the Latin hypercube.
    #[arg(long, default_value_t = 60)]
    points: usize,
    /// Descents (evolution strategy) from the best trials that are far apart.
    #[arg(long, default_value_t = 2)]
    descents: usize,
    /// Generations of each descent.
    #[arg(long, default_value_t = 12)]
    generations: usize,
    /// Trials per generation.
    #[arg(long, default_value_t = 12)]
    per_generation: usize,
    /// Best trials repeated with the full record.
    #[arg(long, default_value_t = 3)]
    finalists: usize,
    /// Turns recorded by the finalists, after two at full speed; other trials have at most four, after one.
    #[arg(long, default_value_t = 8.0)]
    turns: f64,
    /// Seed of the plan.
    #[arg(long, default_value_t = 20_240_327)]
    seed: u64,
}

/// Turns recorded per trial, or --turns if that is less: the finalists have all of these.
const TRIAL_TURNS: f64 = 4.0;

/// # Errors
/// When a configuration is refused, or a file cannot be read or written.
pub(crate) fn run(args: &SearchArgs) -> anyhow::Result<()> {
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    let plan = Plan {
        coarse: Config::load(&args.coarse)?,
        full: Config::load(&args.full)?,
        points: args.points,
        descents: args.descents,
        generations: args.generations,
        per_generation: args.per_generation,
        finalists: args.finalists,
        seed: args.seed,
        turns: args.turns.min(TRIAL_TURNS),
        full_turns: args.turns,
    };
    let path = args.out.join("search.csv");
    let mut earlier = earlier_lines(&path)?;
    let mut table = csv::Writer::from_path(&path).with_context(|| format!("cannot write {}", path.display()))?;
    table.write_record(csv_header())?;
    let known = |index: usize, stage: Stage, parameters: &[String]| {
        let line = earlier.get_mut(index).map(std::mem::take).unwrap_or_default();
        Ok(Outcome::earlier(line, index, stage.word(), parameters))
    };
    let trials = plan::run(&plan, known, |trial| -> anyhow::Result<()> {
        table.write_record(trial.csv())?;
        // A long search that is stopped keeps the trials so far.
        table.flush()?;
        eprintln!("trial {} of {}", trial.index + 1, plan.total());
        Ok(())
    })?;
    for (stage, trial) in leaders(&trials) {
        let (closeness, agree) = trial.outcome.score();
        println!(
            "{stage:<12} best: trial {:>4}, score {closeness:.3}, {agree} agree",
            trial.index
        );
        if stage == Stage::Confirmation.word() {
            let name = "best.yaml";
            write_text(&args.out, name, &trial.config(&plan.full)?.to_yaml()?)?;
            println!("wrote {}", args.out.join(name).display());
        }
    }
    println!("{} trials: {}", trials.len(), path.display());
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
