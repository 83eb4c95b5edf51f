//! `flexdrill map`: the safe window of speed and weight, or of another pair of keys.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, ValueEnum};

use super::progress::Progress;
use super::{WrongUse, built_in, numbers, signals};
use crate::ahead::keep_priority;
use crate::cli::output::say;
use crate::map::shared::Shared;
use crate::map::study::{self, Question, Study};
use crate::map::{picture, table};
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_sweep::Directory;
use flexdrill_sweep::directory::write_whole;
use flexdrill_sweep::envelope::Envelope;
use flexdrill_sweep::map::{MOST_CELLS, MOST_VALUES, Map, ROTARY_SPEED, WEIGHT_ON_BIT};
use flexdrill_sweep::plan::{HORIZONS, MOST_MEMBERS, Plan};
use flexdrill_sweep::values::evenly;
use flexdrill_uncertainty::{Posterior, Priors};

/// Maps the chance of every alarm over rotary speed and weight on bit, or over another pair of keys.
///
/// Every cell is run from rest and from running; the map says where the two differ. Runs are chosen where they show most
/// of the boundary. Other cells are inferred where the runs around them say with 95 % what they are, and are not known
/// elsewhere. The same command continues a map that was interrupted.
#[derive(Debug, Args)]
pub struct MapArgs {
    /// The configuration (YAML).
    config: PathBuf,
    /// Rotary speeds (r/min), as LOW:HIGH.
    #[arg(long, value_name = "A:B", value_parser = range, required_unless_present = "x", conflicts_with = "x")]
    rpm: Option<[f64; 2]>,
    /// Weights on bit (kN), as LOW:HIGH.
    #[arg(long, value_name = "A:B", value_parser = range, required_unless_present = "y", conflicts_with = "y")]
    wob: Option<[f64; 2]>,
    /// Another key along x, in the place of the speed.
    #[arg(long, value_name = "KEY=A:B", value_parser = key_range)]
    x: Option<(String, [f64; 2])>,
    /// Another key along y, in the place of the weight.
    #[arg(long, value_name = "KEY=A:B", value_parser = key_range)]
    y: Option<(String, [f64; 2])>,
    /// Folder for the results and for the runs, created if necessary.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Cells along x and y.
    #[arg(long, value_name = "NxM", value_parser = grid, default_value = "12x10")]
    grid: [usize; 2],
    /// Members per cell and start, at most; a start ends early where they decide every alarm.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_MEMBERS)))]
    members: u32,
    /// Run all members, also where the first ones decide every alarm (six without any): 20 exclude chances above 16 %.
    #[arg(long)]
    run_all: bool,
    /// A map in minutes: a member ends with its first alarm that counts, or after 30 s where its motion has stayed away from all
    /// levels; a run has one member first, and the others next to cells of another class only. Only members without an alarm
    /// have figures.
    #[arg(long)]
    fast: bool,
    /// Members are plausible tools, drawn as `ensemble.from` of the configuration says, from `uncertainty` or from a
    /// calibration: clear means clear for what is not known of the tool and its rig.
    #[arg(long)]
    plausible: bool,
    /// Model time that each member is judged over (s).
    #[arg(long, default_value_t = 60.0, value_parser = numbers::seconds)]
    horizon: f64,
    /// Runs at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
    /// Seed of the disturbances by which members differ.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Largest part of all runs of the grid (%); 100 runs every cell.
    #[arg(long, value_name = "PERCENT", default_value_t = 40, value_parser = clap::value_parser!(u8).range(1..=100))]
    share: u8,
    /// Priority from which on an alarm counts.
    #[arg(long, value_enum, default_value_t = Least::Low)]
    priority: Least,
    /// Rotary speed that the start from running comes from (r/min) [default: the highest of the map].
    #[arg(long, value_name = "RPM", value_parser = numbers::drilling_rpm)]
    running_rpm: Option<f64>,
    /// Values of the configuration to change, as KEY=VALUE with the key's dotted path (may be given more than once).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// [`Priority`] on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Least {
    /// Every alarm.
    Low,
    /// Alarms that require a response soon.
    Medium,
    /// Alarms that require a response at once.
    High,
}

/// Chance above which an alarm must be expected: the chance that the look-ahead counts as excluded.
const LIMIT: f64 = 0.1;

/// A range `A:B`.
fn range(text: &str) -> Result<[f64; 2], String> {
    let of = |text: &str| -> Option<[f64; 2]> {
        let (low, high) = text.split_once(':')?;
        let (low, high) = (low.trim().parse::<f64>().ok()?, high.trim().parse::<f64>().ok()?);
        (low < high && low.abs() < 1e12 && high.abs() < 1e12).then_some([low, high])
    };
    of(text).ok_or_else(|| "use LOW:HIGH, two numbers, such as 20:120".to_owned())
}

/// A key with its range, `KEY=A:B`.
fn key_range(text: &str) -> Result<(String, [f64; 2]), String> {
    let (key, values) = text
        .split_once('=')
        .ok_or("use KEY=LOW:HIGH, such as contact.inner.friction_tangential=0.1:0.7")?;
    Ok((key.trim().to_owned(), range(values)?))
}

/// A grid `NxM`.
fn grid(text: &str) -> Result<[usize; 2], String> {
    let of = |text: &str| -> Option<[usize; 2]> {
        let (columns, rows) = text.split_once('x')?;
        let grid = [columns.parse::<usize>().ok()?, rows.parse::<usize>().ok()?];
        let fits = grid.iter().all(|count| (2..=MOST_VALUES).contains(count)) && grid[0] * grid[1] <= MOST_CELLS;
        fits.then_some(grid)
    };
    of(text).ok_or_else(|| format!("use NxM, such as 12x10: 2 to {MOST_VALUES} each, at most {MOST_CELLS} cells"))
}

/// Runs the subcommand.
///
/// # Errors
/// When the configuration or the axes are refused, the folder has another map, a file cannot be written, or the map was
/// interrupted, or when no member of any run ended: then the map has the causes, and there is no envelope. Otherwise a run
/// that fails is part of the map.
pub fn run(args: &MapArgs) -> anyhow::Result<()> {
    let (config, _) = built_in::load(&args.config)?;
    let config = flexdrill_bench::changed(config, None, &args.set)?;
    let question = question(args)?;
    let mut sample = None;
    let config = if question.plausible {
        // As a run records it: with the checksum of the sample, so that the same points are those of the same tools.
        let (config, posterior) = crate::ensemble::named_by(&config, &args.config)?;
        sample = posterior;
        config
    } else {
        config
    };
    let plan = study::plan(&args.config.display().to_string(), &config, &question)?;
    if question.plausible {
        can_be_drawn(&config, &question, &plan, sample.as_deref())?;
    }
    if let Some(sample) = &sample {
        // A directory of another plan keeps its own.
        Directory::create(&args.out, &plan)?;
        Shared::keep(sample, &args.out)?;
    }
    let shared = Arc::new(Shared::of(&args.out, &plan, &config)?);
    let stop = signals::stop_flag()?;
    keep_priority();
    let mut progress = Progress::share();
    let study = Study {
        config: &config,
        question: &question,
        shared: &shared,
    };
    let made = study::make(&args.out, &plan, study, args.jobs, &stop, |so_far| {
        progress.at(so_far.done as f64 / so_far.most as f64);
    })?;
    progress.done();
    let Some(map) = made else {
        anyhow::bail!("stopped; the same command goes on");
    };
    let files = write(args, &map)?;
    for line in table::words(&map) {
        say!("{line}");
    }
    say!("{:.0} s; wrote {files}", progress.elapsed());
    if let Some(why) = nothing(&map) {
        anyhow::bail!("{why}");
    }
    Ok(())
}

/// Whether the configuration says what is not known of its tool, and leaves the axes to the map; a calibration's sample holds for
/// the tool of every cell.
fn can_be_drawn(config: &Config, question: &Question, plan: &Plan, sample: Option<&Posterior>) -> anyhow::Result<()> {
    let mut priors = Priors::of(config)?;
    if let Some(sample) = sample {
        priors = priors.drawn_from(sample)?;
        // An axis that makes another tool of the cells does so at one of its ends at least.
        for row in [0, plan.rows.len().saturating_sub(1)] {
            sample.belongs_to(&plan.config(config, row)?)?;
        }
    }
    if priors.entries().is_empty() && priors.sensors().is_empty() {
        return Err(WrongUse::new(
            "--plausible: the configuration has no section uncertainty, so that all members would be one tool; leave \
             --plausible out, or state what is not known (config/rig.yaml has an example)",
        )
        .into());
    }
    let drawn = |key: &str| {
        config
            .uncertainty
            .as_ref()
            .is_some_and(|stated| stated.position(key).is_some())
    };
    match question.axes.iter().find(|(key, _)| drawn(key)) {
        Some((key, _)) => Err(WrongUse::new(format!(
            "--plausible: {key} is an axis of the map, and uncertainty.keys draws it too; take it out of one of them"
        ))
        .into()),
        None => Ok(()),
    }
}

/// Why nothing is known, where no member of any run ended.
fn nothing(map: &Map) -> Option<String> {
    if map.members_ended().is_some() {
        return None;
    }
    let failed = map.cells.iter().flat_map(|cell| &cell.starts);
    let mut reasons: Vec<(usize, &str)> = Vec::new();
    for reason in failed
        .map(|start| start.failure.as_str())
        .filter(|reason| !reason.is_empty())
    {
        match reasons.iter_mut().find(|(_, known)| *known == reason) {
            Some((count, _)) => *count += 1,
            None => reasons.push((1, reason)),
        }
    }
    let most = reasons.iter().rev().max_by_key(|(count, _)| *count);
    let reason = most.map_or(String::new(), |(count, reason)| {
        format!(" Reason of {count}: {reason}.")
    });
    Some(format!(
        "all {} runs failed, so that nothing is known of any cell, and there is no envelope.{reason} map.csv has all \
         reasons. Check the configuration with flexdrill check, or choose another range",
        map.runs
    ))
}

fn question(args: &MapArgs) -> anyhow::Result<Question> {
    let axis = |other: &Option<(String, [f64; 2])>, key: &str, range: Option<[f64; 2]>, count: usize| {
        let (key, [low, high]) = match (other, range) {
            (Some((key, range)), _) => (key.clone(), *range),
            (None, Some(range)) => (key.to_owned(), range),
            // One of the two is required.
            (None, None) => (key.to_owned(), [f64::NAN; 2]),
        };
        (key, evenly(low, high, count))
    };
    let [least, most] = HORIZONS;
    if !(least..=most).contains(&args.horizon) {
        return Err(WrongUse::new(format!("--horizon {}: use {least} to {most} s", args.horizon)).into());
    }
    Ok(Question {
        axes: [
            axis(&args.x, ROTARY_SPEED, args.rpm, args.grid[0]),
            axis(&args.y, WEIGHT_ON_BIT, args.wob, args.grid[1]),
        ],
        horizon: args.horizon,
        members: args.members,
        run_all: args.run_all,
        fast: args.fast,
        plausible: args.plausible,
        seed: args.seed,
        running_rpm: args.running_rpm,
        running_time: flexdrill_sweep::spec::RUNNING_TIME,
        priority: match args.priority {
            Least::Low => Priority::Low,
            Least::Medium => Priority::Medium,
            Least::High => Priority::High,
        },
        limit: LIMIT,
        share: f64::from(args.share) / 100.0,
    })
}

/// Writes all files, and names them.
fn write(args: &MapArgs, map: &Map) -> anyhow::Result<String> {
    // What is known of no cell bounds nothing. Tables of an earlier map would be taken for those of this one.
    let envelope = map.members_ended().is_some().then(|| Envelope::of(map, true));
    let figure = picture::figure(map);
    // The page writes title and words itself.
    let page = flexdrill_report::map::page(map, &flexdrill_plot::svg(&figure)?);
    let mut files = vec![
        ("map.csv", table::csv(map)?),
        ("map.svg", flexdrill_plot::sheet(&figure)?.into_bytes()),
        ("map.html", page.into_bytes()),
    ];
    for (name, of) in [("envelope_x.csv", table::Of::X), ("envelope_y.csv", table::Of::Y)] {
        match &envelope {
            Some(envelope) => files.push((name, table::bounds(map, envelope, of)?)),
            None => remove(&args.out.join(name))?,
        }
    }
    // Last: who finds it finds the others.
    files.push(("map.json", map.to_json()?.into_bytes()));
    let mut names = Vec::new();
    for (name, content) in &files {
        let path = args.out.join(name);
        write_whole(&path, content)?;
        names.push(path.display().to_string());
    }
    Ok(names.join(", "))
}

/// Removes a file that may be there.
fn remove(path: &Path) -> anyhow::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(anyhow::Error::new(error).context(format!("{}: cannot be removed", path.display())))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_and_grids_are_refused_in_words() {
        assert_eq!(range("20:140"), Ok([20.0, 140.0]));
        assert_eq!(key_range("a.b=0.1:0.7"), Ok(("a.b".to_owned(), [0.1, 0.7])));
        assert_eq!(grid("12x10"), Ok([12, 10]));
        for text in [
            "",
            "20",
            "140:20",
            "20:20",
            "a:b",
            "nan:3",
            "1:inf",
            "1:2:3",
            "1e300:2e300",
        ] {
            assert!(range(text).unwrap_err().starts_with("use LOW:HIGH"), "{text}");
        }
        for text in ["", "12", "1x5", "201x5", "150x150", "ax5", "-3x4"] {
            assert!(grid(text).unwrap_err().starts_with("use NxM"), "{text}");
        }
        assert!(key_range("a.b").unwrap_err().starts_with("use KEY="));
    }
}
