//! `flexdrill ahead`: where the tool drills in the next metres.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::plan::{Planned, read_table};
use super::progress::Progress;
use super::{WrongUse, built_in, numbers, whole_file};
use crate::cli::output::say;
use crate::hole_ahead::words::{Goal, words};
use crate::hole_ahead::{
    Drilling, Learnt, Plan, Present, Question, Refusal, SPACING, USUAL_LENGTH, USUAL_WEIGHT, advice, answer, learnt,
    picture, plan, surveys, table, tool,
};
use crate::runs::Kept;
use flexdrill_config::Config;
use flexdrill_core::units::kn_to_n;
use flexdrill_hole::{HoleError, Survey};
use flexdrill_text::counted;

/// Computes where the tool drills in the next metres, with the range of plausible tools, and writes ahead.csv and ahead.svg.
///
/// The hole is that of the configuration, up to the bit. With a plan, the words have the distance to it and the weight under
/// which the bit comes nearest. With surveys, the forecast begins in the surveyed direction with the measured curvature.
#[derive(Debug, Args)]
pub struct AheadArgs {
    /// The tool in its hole (YAML).
    config: PathBuf,
    /// Folder for the results, created if necessary.
    #[arg(long)]
    out: PathBuf,
    /// Metres ahead, in whole quarters of a metre.
    #[arg(long, default_value_t = USUAL_LENGTH, value_parser = numbers::metres_ahead)]
    metres: f64,
    /// A recording of the twin, or a state that ~/save_checkpoint has written: the weight that arrives at the bit and the
    /// parameters in force are those at its end.
    #[arg(long, value_name = "BAG|STATE")]
    from: Option<PathBuf>,
    /// Weight at the bit (kN): that of --from by default, else 10.
    #[arg(long, value_parser = numbers::kilonewton)]
    weight: Option<f64>,
    /// Plausible tools, drawn from what is not known.
    #[arg(long, default_value_t = 100, value_parser = numbers::members())]
    members: usize,
    /// Seed of the draws: the same seed gives the same results.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Plan: a table (CSV) with the columns measured_depth_m from the kick-off, inclination_deg and azimuth_deg. Without it
    /// and --radius, the plan is that of the configuration (well.plan).
    #[arg(long, conflicts_with = "radius")]
    plan: Option<PathBuf>,
    /// Plan: an arc of this radius (m) that continues the hole.
    #[arg(long, value_parser = numbers::arc_radius)]
    radius: Option<f64>,
    /// Surveys: a table (CSV) with the columns measured_depth_m from the kick-off, inclination_deg and azimuth_deg, and
    /// optionally inclination_sd_deg and azimuth_sd_deg. An azimuth may be empty.
    #[arg(long)]
    surveys: Option<PathBuf>,
    /// Measured depth (m) from which on this tool has drilled: surveys above it say nothing of the tool. By default
    /// well.drilled_from, else where the arc above the bit begins.
    #[arg(long, requires = "surveys", value_parser = numbers::measured_depth)]
    drilled_from: Option<f64>,
    /// Distance from the plan that counts as on plan (m); that of the configuration's plan by default, else 0.5.
    #[arg(long, value_parser = numbers::distance)]
    target: Option<f64>,
    /// Keeps every plausible tool that has drilled in the folder `tools` of --out, and takes those that are there: the same
    /// command continues an interrupted one.
    #[arg(long)]
    resume: bool,
    /// Tools computed at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
}

/// Distance that counts as on plan where none is given (m).
const USUAL_TARGET: f64 = 0.5;

/// Runs the subcommand.
///
/// # Errors
/// When configuration, plan or surveys are refused, nothing can be predicted for them, or a file cannot be written. A plausible tool
/// without a result is part of the results.
pub fn run(args: &AheadArgs) -> anyhow::Result<()> {
    let (config, name) = built_in::load(&args.config)?;
    let present = match &args.from {
        Some(path) => Some(Present::read(path, &config).with_context(|| format!("--from {}", path.display()))?),
        None => None,
    };
    // The parameters in force count in all that follows.
    let config = present.as_ref().map_or(config, |present| present.config.clone());
    let in_config = |refusal: Refusal| anyhow::anyhow!("{name}: {refusal}");
    tool::check(&config).map_err(in_config)?;
    // What the command line asks for comes before the plan of the configuration.
    let table = match (&args.plan, args.radius) {
        (Some(path), _) => Some(Planned::at(path)?),
        (None, Some(_)) => None,
        (None, None) => Planned::of(&config, &name, &args.config)?,
    };
    let bit = config.well.length();
    if let Some(table) = &table {
        plan::covers(&table.name, &table.rows, bit)?;
    }
    let surveys = match &args.surveys {
        Some(path) => Some(surveyed(path, bit)?),
        None => None,
    };
    // A configuration has no azimuth: the hole lies in the plane of the plan, or else in that of the surveys.
    let planned = table.as_ref().map(|table| [plan::azimuth(&table.rows, bit), 0.0]);
    let measured = surveys.as_ref().and_then(|(_, read)| surveys::plane(read));
    let plane = planned.or(measured).unwrap_or([0.0; 2]);
    let azimuth = plane[0];
    let target = args
        .target
        .or(config.well.plan.as_ref().map(|plan| plan.target))
        .unwrap_or(USUAL_TARGET);
    let question = question(args, &config, present.as_ref(), azimuth)?;
    let drilling = Drilling::of(&config, question.weight, azimuth).map_err(in_config)?;
    let ahead = question.stations as f64 * SPACING;
    let planned = table
        .map(|table| Plan::laid(&table.rows, table.offset, &drilling, bit, ahead))
        .or_else(|| args.radius.map(|radius| Plan::arc(radius, &drilling, bit, ahead)));
    let taken = match &present {
        Some(present) => taken(args, present, &name, &drilling).with_context(|| name.clone())?,
        None => Vec::new(),
    };
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    let mut progress = Progress::share();
    let learnt = match surveys {
        Some((file, read)) => {
            let since = drilled_from(args, &config)?;
            Some(Learnt::of(&config, &drilling, read, since, plane).context(file)?)
        }
        None => None,
    };
    let kept = args.resume.then(|| Kept::open(&args.out.join("tools"))).transpose()?;
    let report = |share| progress.at(share);
    let found = answer(&config, &question, learnt, kept.as_ref(), report).with_context(|| name.clone())?;
    progress.done();
    let goal = planned.as_ref().map(|plan| Goal {
        plan,
        target,
        advice: advice::advise(&config, &question, &found, plan, target),
    });
    let svg = flexdrill_plot::sheet(&picture::figure(&found, planned.as_ref(), azimuth))?;
    whole_file::write(&args.out, "ahead.csv", &table::csv(&found, planned.as_ref()))?;
    whole_file::write(&args.out, "ahead.svg", &svg)?;
    if let Some(learnt) = &found.learnt {
        let used = learnt.surveys.iter().map(|survey| (survey, learnt.corrects(survey)));
        whole_file::write(&args.out, "surveys.csv", &table::surveys_csv(used))?;
    }
    for line in taken {
        say!("{line}");
    }
    for line in words(&config, &question, &found, goal.as_ref()) {
        say!("{line}");
    }
    // Holes that are drawn from what surveys say are no runs.
    let tools = match &found.learnt {
        Some(learnt) if learnt.corrects_curvature() => 0,
        _ => found.members.len() as u64,
    };
    say!(
        "{} in {:.1} s: {} and ahead.svg",
        counted(tools + 1, "run"),
        progress.elapsed(),
        args.out.join("ahead.csv").display()
    );
    Ok(())
}

/// What was taken from a run, in sentences.
fn taken(args: &AheadArgs, present: &Present, name: &str, drilling: &Drilling) -> Result<Vec<String>, HoleError> {
    let from = args.from.as_deref().unwrap_or(Path::new(""));
    let mut lines = present.words(&from.display().to_string(), name, args.weight.map(kn_to_n));
    lines.extend(present.side_force(drilling)?);
    Ok(lines)
}

/// Name and surveys of a table.
fn surveyed(path: &Path, bit: f64) -> anyhow::Result<(String, Vec<Survey>)> {
    let (name, text) = read_table(path, "the surveys of the hole above the bit")?;
    let read = surveys::read(&name, &text, bit)?;
    Ok((name, read))
}

/// Measured depth from which on this tool has drilled (m).
fn drilled_from(args: &AheadArgs, config: &Config) -> Result<f64, WrongUse> {
    let bit = config.well.length();
    let since = args.drilled_from.unwrap_or_else(|| learnt::drilled_from(config));
    if since < bit {
        return Ok(since);
    }
    Err(WrongUse::new(format!(
        "--drilled-from {since} m: must be above the bit, less than {bit:.3} m of measured depth: give the depth at which this \
         tool began to drill{}",
        if args.drilled_from.is_none() {
            ", because the hole as configured has no arc above the bit"
        } else {
            ""
        }
    )))
}

/// Weight at the bit (N): as asked for, or as it arrives in a run.
fn weight(args: &AheadArgs, config: &Config, present: Option<&Present>) -> Result<f64, WrongUse> {
    let allowed = &config.inputs.weight_on_bit;
    match (args.weight, present) {
        (None, None) => Ok(USUAL_WEIGHT),
        // What arrives differs from what is set: the limits of the input are none for it.
        (None, Some(present)) if present.weight > 0.0 => Ok(present.weight),
        (None, Some(_)) => Err(WrongUse::new(
            "--from: the bit is off bottom at the end of the run: must be on bottom, a bit drills under weight only; give \
             the weight at the bit with --weight"
                .to_owned(),
        )),
        (Some(weight), _) if weight > 0.0 && (allowed.min_kn..=allowed.max_kn).contains(&weight) => Ok(kn_to_n(weight)),
        (Some(weight), _) => Err(WrongUse::new(format!(
            "--weight {weight} kN: must be above 0 kN and within inputs.weight_on_bit, {} to {} kN: a bit drills under weight \
             only; give the weight at the bit",
            allowed.min_kn, allowed.max_kn
        ))),
    }
}

/// What is asked, SI.
fn question(args: &AheadArgs, config: &Config, present: Option<&Present>, azimuth: f64) -> Result<Question, WrongUse> {
    let allowed = &config.inputs.weight_on_bit;
    Ok(Question {
        weight: weight(args, config, present)?,
        largest_weight: kn_to_n(allowed.max_kn),
        stations: (args.metres / SPACING - 1e-9).ceil() as usize,
        azimuth,
        members: args.members,
        seed: args.seed,
        jobs: args.jobs,
    })
}
