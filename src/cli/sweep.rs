//! `flexdrill sweep`: runs over tables of values, by any number of machines that share a directory.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use clap::{Args, Subcommand};

use super::progress::Progress;
use super::{numbers, signals};
use crate::ahead::keep_priority;
use crate::cli::output::{say, tell};
use crate::map::shared::Shared;
use crate::map::{point, program, study};
use flexdrill_sweep::directory::write_whole;
use flexdrill_sweep::{Chunk, Directory, Spec};
use flexdrill_text::counted;

/// Runs the twin over a table of values, on as many machines as share a directory.
///
/// `plan` writes the directory, `work` computes what has no result yet, as often and wherever it is started, `status` says
/// how far it is, and `collect` writes all results as one table.
#[derive(Debug, Args)]
pub struct SweepArgs {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Plan(PlanArgs),
    Work(WorkArgs),
    Status(StatusArgs),
    Collect(CollectArgs),
}

/// Checks a specification and writes its plan into a directory.
#[derive(Debug, Args)]
struct PlanArgs {
    /// The specification (YAML): configuration, values of its keys, horizon, members, starts, seeds.
    spec: PathBuf,
    /// The directory, created if necessary. One that has another plan is refused.
    dir: PathBuf,
}

/// Computes the points of a directory that have no result yet.
///
/// The command may run any number of times, at the same time, on any machine that shares the directory. A worker that is
/// lost costs the points that it was computing; the same command continues.
#[derive(Debug, Args)]
struct WorkArgs {
    /// The directory of a plan.
    dir: PathBuf,
    /// Only part I of N of the points, counted from 0, as a scheduler's array has them.
    #[arg(long, value_name = "I/N", value_parser = chunk, default_value = "0/1")]
    chunk: Chunk,
    /// Points at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
}

/// Prints how many points have a result, and what is wrong with a directory.
#[derive(Debug, Args)]
struct StatusArgs {
    /// The directory of a plan.
    dir: PathBuf,
}

/// Writes all results as one table (CSV).
#[derive(Debug, Args)]
struct CollectArgs {
    /// The directory of a plan.
    dir: PathBuf,
    /// The table [default: DIR/points.csv].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write the table also where points have no result; their state is `missing`.
    #[arg(long)]
    partial: bool,
}

/// A part of the points, such as `3/32`.
fn chunk(text: &str) -> Result<Chunk, String> {
    const MOST: usize = 100_000;
    let of = |text: &str| -> Option<Chunk> {
        let (part, of) = text.split_once('/')?;
        let chunk = Chunk {
            part: part.parse().ok()?,
            of: of.parse().ok()?,
        };
        ((1..=MOST).contains(&chunk.of) && chunk.part < chunk.of).then_some(chunk)
    };
    of(text).ok_or_else(|| format!("use I/N, such as 0/32: N from 1 to {MOST}, I from 0 to N - 1"))
}

/// Runs the subcommand.
///
/// # Errors
/// When a specification, a plan or a point is refused, a disk refuses a write, or points are missing from a table.
pub fn run(args: &SweepArgs) -> anyhow::Result<()> {
    match &args.command {
        Command::Plan(args) => plan(args),
        Command::Work(args) => work(args),
        Command::Status(args) => status(&args.dir),
        Command::Collect(args) => collect(args),
    }
}

fn plan(args: &PlanArgs) -> anyhow::Result<()> {
    let spec = Spec::load(&args.spec)?;
    let plan = spec.plan(&args.spec, &program())?;
    let directory = Directory::create(&args.dir, &plan)?;
    let plan = directory.plan();
    let time = plan.len() as f64 * f64::from(plan.runs.members) * plan.runs.horizon;
    say!(
        "{}: {} ({} of {}, {}, {}), at most {:.1} h of model time",
        args.dir.display(),
        counted(plan.len() as u64, "point"),
        counted(plan.rows.len() as u64, "row"),
        counted(plan.keys.len() as u64, "value"),
        counted(plan.starts.len() as u64, "start"),
        counted(plan.seeds.len() as u64, "seed"),
        time / 3600.0
    );
    Ok(())
}

fn work(args: &WorkArgs) -> anyhow::Result<()> {
    let directory = Directory::open(&args.dir)?;
    let here = program();
    directory.belongs_to(&here.name, &here.arithmetic)?;
    let config = study::configuration(&directory)?;
    let stop = signals::stop_flag()?;
    let numbers: Vec<usize> = (0..directory.points().len())
        .filter(|number| args.chunk.has(*number))
        .collect();
    keep_priority();
    let mut progress = Progress::share();
    let shared = Arc::new(Shared::of(&args.dir, directory.plan(), &config)?);
    let compute = |point: &_| point::run(directory.plan(), &config, point, &shared, &stop);
    let worked = directory.work(&numbers, args.jobs, &stop, compute, |work| {
        progress.at(work.done as f64 / work.all.max(1) as f64);
    })?;
    progress.done();
    say!(
        "{}: {} computed in {:.0} s, {} had a result",
        counted(numbers.len() as u64, "point"),
        worked.ran,
        progress.elapsed(),
        worked.present
    );
    anyhow::ensure!(
        !stop.load(Ordering::Relaxed),
        "stopped: {} of this part without a result; the same command goes on",
        counted(worked.left as u64, "point")
    );
    Ok(())
}

fn status(dir: &Path) -> anyhow::Result<()> {
    let directory = Directory::open(dir)?;
    let status = directory.status()?;
    let runs = &directory.plan().runs;
    say!(
        "plan        {}, {} arithmetic, configuration {}",
        runs.program,
        runs.arithmetic,
        &runs.hash[..12]
    );
    say!("points      {}", status.points);
    say!("done        {} ({} with a failed member)", status.done, status.failed);
    say!("missing     {}", status.missing());
    say!(
        "unfinished  {} of workers that write or were killed",
        counted(status.unfinished as u64, "file")
    );
    if status.foreign > 0 {
        say!(
            "foreign     {} not of this plan",
            counted(status.foreign as u64, "file")
        );
    }
    for (file, damage) in &status.damaged {
        tell!("damaged: {}: {damage}", file.display());
    }
    anyhow::ensure!(
        status.damaged.is_empty(),
        "{}, left alone: remove what is damaged and run flexdrill sweep work again",
        counted(status.damaged.len() as u64, "damaged file")
    );
    Ok(())
}

fn collect(args: &CollectArgs) -> anyhow::Result<()> {
    let directory = Directory::open(&args.dir)?;
    let table = directory.collect(args.partial)?;
    let out = args.out.clone().unwrap_or_else(|| args.dir.join("points.csv"));
    write_whole(&out, &table)?;
    say!(
        "wrote {}: {}",
        out.display(),
        counted(directory.points().len() as u64, "point")
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_one_of_several() {
        assert_eq!(chunk("3/32"), Ok(Chunk { part: 3, of: 32 }));
        assert_eq!(chunk("0/1"), Ok(Chunk::WHOLE));
        for text in ["", "3", "32/32", "0/0", "-1/3", "1/100001", "a/b", "1/2/3", "1.0/2"] {
            assert!(chunk(text).unwrap_err().starts_with("use I/N"), "{text}");
        }
    }
}
