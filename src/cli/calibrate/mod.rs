//! `flexdrill calibrate`: fits coefficients of the twin to a log or a bag.

mod samples;

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Args;

use super::WrongUse;
use super::built_in;
use super::numbers;
use super::progress::Progress;
use super::source::{SourceArgs, is_bag};
use super::whole_file;
use crate::cli::output::{say, tell};
use crate::report::calibration as page;
use flexdrill_calibration::CalibrationError;
use flexdrill_calibration::fit::refusals;
use flexdrill_calibration::identify::Verdict;
use flexdrill_calibration::study::check::At;
use flexdrill_calibration::study::overlay::{self, Provenance};
use flexdrill_calibration::study::points::{self, Cover, Point};
use flexdrill_calibration::study::posterior::sample;
use flexdrill_calibration::study::unknowns::Unknowns;
use flexdrill_calibration::study::{self, Study, StudySettings};
use flexdrill_calibration::windows::{self, Activity, Channel, Sample, WindowSettings, Windows};
use flexdrill_config::Config;
use flexdrill_text::{counted, printable};

/// File of the twin's points, by which an interrupted calibration continues.
const POINTS: &str = "points.csv";
/// File of the sample that plausible tools are drawn from.
const POSTERIOR: &str = flexdrill_uncertainty::posterior::FILE;

/// Fit friction, bit, rock and the sensors' factors and tares to a field log or a bag with what the rig measured.
///
/// The steady parts of the log are compared with runs of the twin. What the log does not determine is left as it is and
/// said so. Full runs check what was found: where they contradict it, the values are not to be used, and the exit code
/// is 1. Writes overlay.yaml (the changed keys with their 90 % bands), calibrated.yaml (a whole configuration, to run),
/// calibration.json, report.html, and posterior.csv, the sample that plausible tools are drawn from. The twin's runs are
/// kept in points.csv: the same command goes on after an interruption.
#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    /// Field log (CSV) or bag with rig/measured.
    log: PathBuf,
    /// Configuration to fit.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// Folder for the results, created if necessary.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    source: SourceArgs,
    /// Runs of the twin at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
    /// Seed of the design and of the ensemble.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Members of the ensemble.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(100..=100_000))]
    members: u32,
    /// Only list the steady windows and what is left out; the twin is not run.
    #[arg(long)]
    windows: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When log or configuration cannot be read, nothing can be fitted, or a file cannot be written.
pub(super) fn run(args: &CalibrateArgs) -> anyhow::Result<()> {
    if args.source.ends_with_guess(&args.log)? {
        return Ok(());
    }
    let (config, _) = built_in::load(&args.config)?;
    let samples = read(args, &config)?;
    let windows = windows::find(&samples, &WindowSettings::default());
    // The windows are printed before anything can fail: they show why a log is of no use.
    tell_windows(&samples, &windows);
    let refused = refusals(&windows);
    for (channel, refusal) in &refused {
        say!("{} is not used: {}", channel.name_and_unit().0, refusal.text());
    }
    if args.windows {
        return Ok(());
    }
    // The check costs nothing, and the runs that follow take minutes to hours.
    let usable = windows.steady.iter().any(|window| {
        let mut measured = Channel::ALL
            .into_iter()
            .filter(|channel| window.measured[*channel as usize].is_some());
        measured.any(|channel| !refused.iter().any(|(known, _)| *known == channel))
    });
    if !usable {
        // The first refusal is the reason that helps; "nothing observed" alone leaves the reader searching.
        let why = anyhow::Error::from(CalibrationError::NothingObserved);
        return Err(match refused.first() {
            Some((channel, refusal)) => why.context(format!("{}: {}", channel.name_and_unit().0, refusal.text())),
            None => why,
        });
    }
    check_weight(&config, &windows)?;
    let unknowns = Unknowns::of(&config)?;
    // Off bottom and drilling need separate designs: off bottom the
    // weight is zero and the bit has no part in the torque.
    let covers: Vec<Cover> = [Activity::OffBottom, Activity::Drilling]
        .into_iter()
        .filter_map(|motion| study::cover(&config, &unknowns, &windows, motion))
        .collect();
    check_covers(&config, &covers)?;
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    // The folder comes before the runs, so that hours of computing never end in a path that cannot be written. Points
    // that were run are kept in it and found again.
    let points = run_points(args, &config, &unknowns, &covers)?;
    let settings = StudySettings {
        jobs: args.jobs,
        seed: args.seed,
        members: args.members as usize,
    };
    tell!("fitting, and checking what was found by full runs");
    let study = study::study(&config, unknowns, windows, &points, &settings)?;
    let rows = [samples.first(), samples.last()].map(|sample| sample.map_or(0, |sample| sample.row));
    // The name alone: the path of one machine has no meaning in a file that is passed on.
    let name = args
        .log
        .file_name()
        .unwrap_or(args.log.as_os_str())
        .to_string_lossy()
        .into_owned();
    let provenance = Provenance {
        log: name,
        sha256: overlay::sha256(&args.log).with_context(|| format!("{}", args.log.display()))?,
        rows,
        configuration: config.hash(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: args.seed,
    };
    // The results are written before the objections are raised, since they are what the objections are judged by.
    write(args, &config, &study, &provenance)?;
    tell_result(&study);
    // A failed objection ends with an error, so that a script does not use the values.
    let objections: Vec<String> = study.objections().iter().map(ToString::to_string).collect();
    anyhow::ensure!(
        objections.is_empty(),
        "the values are not to be used: {}",
        objections.join("; ")
    );
    Ok(())
}

fn read(args: &CalibrateArgs, config: &Config) -> anyhow::Result<Vec<Sample>> {
    let samples = if is_bag(&args.log)? {
        if args.source.is_given() {
            return Err(WrongUse::new(
                "--mapping, --guess, --from and --to belong to field logs; a bag is used as a whole",
            )
            .into());
        }
        // An input that is older than its limit is not known.
        samples::of_bag(&args.log, config.inputs.rotary_speed.max_age)?
    } else {
        samples::of_log(&args.source.log(&args.log)?)
    };
    // The rate of penetration alone shows neither friction nor tares, and every log has it as an input.
    let enough = Channel::ALL.map(|channel| channel != Channel::RateOfPenetration);
    let has_enough = |sample: &Sample| {
        sample
            .measured
            .iter()
            .zip(enough)
            .any(|(value, is)| is && value.is_finite())
    };
    anyhow::ensure!(
        samples.iter().any(has_enough),
        "{}: it has no measured torque, hook load, or torque or weight at the bit; a field log needs columns.torque, \
         a hookload or columns.measured in its mapping, a bag the topic rig/measured",
        args.log.display()
    );
    Ok(samples)
}

fn tell_windows(samples: &[Sample], windows: &Windows) {
    let used: usize = windows.steady.iter().map(|window| window.samples).sum();
    let count = |motion| windows.steady.iter().filter(|window| window.motion == motion).count();
    say!(
        "{used} of {} samples are in steady windows: {} off bottom, {} drilling",
        samples.len(),
        count(Activity::OffBottom),
        count(Activity::Drilling)
    );
    for (reason, samples) in windows.left_out_by_reason() {
        say!("  left out: {}, {reason}", counted(samples as u64, "sample"));
    }
}

/// The twin must be able to run with the weights of the log.
fn check_weight(config: &Config, windows: &Windows) -> anyhow::Result<()> {
    let drilling = windows
        .steady
        .iter()
        .filter(|window| window.motion == Activity::Drilling);
    let kn = flexdrill_core::units::n_to_kn(drilling.map(|window| window.weight).fold(0.0, f64::max));
    let most = config.inputs.weight_on_bit.max_kn;
    anyhow::ensure!(
        kn <= most,
        "the log drills with up to {kn:.0} kN: must be at most inputs.weight_on_bit.max_kn, {most} kN; scale the weight in the \
         mapping or change the configuration"
    );
    Ok(())
}

/// The twin must be able to run at the speeds of the design.
fn check_covers(config: &Config, covers: &[Cover]) -> anyhow::Result<()> {
    let most = config.inputs.rotary_speed.max_rpm;
    for cover in covers {
        let rpm = flexdrill_core::units::rad_per_s_to_rpm(cover.rotary_speed[1]);
        anyhow::ensure!(
            rpm <= most,
            "the log drills at up to {rpm:.0} r/min: must be at most inputs.rotary_speed.max_rpm, {most} r/min; scale the speed \
             in the mapping or change the configuration"
        );
    }
    Ok(())
}

fn run_points(
    args: &CalibrateArgs,
    config: &Config,
    unknowns: &Unknowns,
    covers: &[Cover],
) -> anyhow::Result<Vec<Point>> {
    let mut all: Vec<Point> = covers
        .iter()
        .flat_map(|cover| points::design(unknowns, cover, args.seed))
        .collect();
    let path = args.out.join(POINTS);
    if let Ok(text) = std::fs::read_to_string(&path) {
        let known = points::fill(&path, &text, config, unknowns, args.seed, &mut all)?;
        tell!("{known} of {} runs of the twin are in {}", all.len(), path.display());
    }
    let total = all.len();
    let mut progress = Progress::share();
    let mut problem = None;
    let found = points::run(config, unknowns, all, args.jobs, |points, left| {
        let text = points::to_csv(config, unknowns, args.seed, points);
        problem = problem.take().or(whole_file::write(&args.out, POINTS, &text).err());
        progress.at((total - left) as f64 / total as f64);
    });
    progress.done();
    problem.map_or(Ok(found), Err)
}

fn write(args: &CalibrateArgs, config: &Config, study: &Study, provenance: &Provenance) -> anyhow::Result<()> {
    // The whole configuration is formed first: if the overlay does not fit it, no file is written.
    let calibrated = overlay::apply(config, study)?;
    let whole = overlay::header(provenance) + &overlay::warnings(study) + &calibrated.to_yaml()?;
    let json = serde_json::to_string_pretty(&overlay::json(study, provenance))?;
    write_posterior(&args.out, config, study, provenance)?;
    whole_file::write(&args.out, "overlay.yaml", &overlay::yaml(study, provenance))?;
    whole_file::write(&args.out, "calibrated.yaml", &whole)?;
    whole_file::write(&args.out, "calibration.json", &(json + "\n"))?;
    // The page needs plain data: the report knows neither the study nor its runs.
    let about = page::About {
        log: provenance.log.clone(),
        lines: overlay::header(provenance)
            .lines()
            .map(|line| line.trim_start_matches("# ").to_owned())
            .collect(),
        left_out: study.unknowns.left_out.clone(),
        refused: study
            .refused
            .iter()
            .map(|(channel, refusal)| (channel.name_and_unit().0, refusal.text()))
            .collect(),
        checked: study
            .checked
            .iter()
            .map(|checked| page::Checked {
                window: checked.window,
                channel: checked.channel,
                // Readers count members from 1.
                at: match checked.at {
                    At::Centre => "values found".to_owned(),
                    At::Member(number) => format!("member {}", number + 1),
                },
                measured: checked.measured,
                run: checked.run.clone(),
                surrogate: checked.surrogate,
                surrogate_band: checked.surrogate_band,
                band: checked.band,
            })
            .collect(),
        failed: study.failed.clone(),
        objections: study.objections().iter().map(ToString::to_string).collect(),
    };
    let html = page::html(&about, &study.windows, &study.problem, &study.outcome)?;
    whole_file::write(&args.out, crate::report::FILE, &html)?;
    for name in [
        "overlay.yaml",
        "calibrated.yaml",
        "calibration.json",
        crate::report::FILE,
    ] {
        say!("wrote {}", args.out.join(name).display());
    }
    Ok(())
}

/// Writes the sample of the posterior. Where the log determines nothing there is none, and an older one is removed, which
/// would be taken for one of this log.
fn write_posterior(folder: &Path, config: &Config, study: &Study, provenance: &Provenance) -> anyhow::Result<()> {
    let sampled = sample(&config.numbers(), &study.unknowns, &study.outcome);
    let path = folder.join(POSTERIOR);
    if sampled.keys.is_empty() {
        say!("no {POSTERIOR}: the log determines no key");
        return match std::fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(error).with_context(|| format!("cannot remove {}", path.display()))
            }
            _ => Ok(()),
        };
    }
    let from = flexdrill_uncertainty::posterior::Provenance {
        version: provenance.version.clone(),
        tool: config.tool_hash(sampled.keys.iter().copied()),
        configuration: provenance.configuration.clone(),
        log: provenance.log.clone(),
        sha256: provenance.sha256.clone(),
        rows: provenance.rows,
        seed: provenance.seed,
        objections: study.objections().iter().map(ToString::to_string).collect(),
    };
    let rows = sampled.members.iter().map(|values| (1.0, values.as_slice()));
    let text = flexdrill_uncertainty::posterior::to_csv(&from, &sampled.keys, rows);
    whole_file::write(folder, POSTERIOR, &text)?;
    if sampled.beyond_limits > 0 {
        say!(
            "{POSTERIOR} leaves out {} with a value beyond the limits of its key",
            counted(sampled.beyond_limits as u64, "member")
        );
    }
    say!("wrote {}", path.display());
    Ok(())
}

fn tell_result(study: &Study) {
    for (unknown, estimate) in study.problem.unknowns.iter().zip(&study.outcome.estimates) {
        let [value, low, high] =
            [estimate.value, estimate.band[0], estimate.band[1]].map(|v| page::shown(unknown.unit, v));
        match estimate.verdict {
            Verdict::Identified | Verdict::Bounded => {
                say!("{}: {value}, 90 % band {low} to {high}", unknown.name);
            }
            Verdict::InCombination => say!(
                "{}: {value}, 90 % band {low} to {high}, only in combination",
                unknown.name
            ),
            Verdict::NotIdentifiable => say!(
                "{}: this log can hardly move it (posterior over prior width {:.2}), left as it is",
                unknown.name,
                estimate.width_ratio()
            ),
        }
    }
    for (name, why) in &study.unknowns.left_out {
        say!("{name}: not fitted, {why}");
    }
    for pair in &study.outcome.pairs {
        let [a, b] = pair.unknowns.map(|index| study.problem.unknowns[index].name.as_str());
        let what = if pair.correlation < 0.0 { "sum" } else { "difference" };
        say!(
            "the log shows only the {what} of {a} and {b} (correlation {:.2})",
            pair.correlation
        );
    }
    for problem in study.failed.iter().take(3) {
        tell!("a run of the twin gave no figure: {}", printable(problem));
    }
}
