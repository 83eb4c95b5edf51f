//! `flexdrill report`: a recording as one page to pass on, or two next to each other.

use std::path::{Path, PathBuf};

use clap::Args;

use super::progress::Progress;
use super::{WrongUse, life};
use crate::cli::output::{say, tell};
use crate::report::{self, Comparison, Summary};
use flexdrill_text::printable;

/// Largest number of differences in an error message; the page and --json list all.
const NAMED: usize = 5;

/// Make one HTML page of a recording: inputs, alarms, worst locations with orbits, forces along the tool, health.
///
/// Reads bags of `run --record`, `replay` and `ros2 bag record`, also if they were cut short; the page lists what is
/// missing. The page is a single file, and can be printed. With --against it shows two runs and their differences.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Bag: an .mcap or .db3 file, or a folder with such files.
    bag: PathBuf,
    /// Folder for report.html, created if necessary. An existing report.html is replaced.
    #[arg(long, value_name = "DIR", required_unless_present = "json")]
    out: Option<PathBuf>,
    /// Namespace of the twin, such as /rig_7, if the bag has several.
    #[arg(long, value_name = "NS")]
    namespace: Option<String>,
    /// Table of `flexdrill life`: the page lists the joints to inspect by all of its runs.
    #[arg(long, value_name = "FILE", conflicts_with = "against")]
    life: Option<PathBuf>,
    /// A second bag: the page shows both runs, A and B, with their differences.
    #[arg(long, value_name = "BAG")]
    against: Option<PathBuf>,
    /// Namespace of the twin in the second bag. Default: that of --namespace.
    #[arg(long, value_name = "NS", requires = "against")]
    against_namespace: Option<String>,
    /// With --against: exit code 1 when a mean of the runs differs by more than this share, or an alarm reached another
    /// priority (%). 0 asks for the same figures. Without it the exit code is 0.
    #[arg(long, value_name = "PERCENT", requires = "against")]
    tolerance: Option<f64>,
    /// With --against: print the comparison as JSON, in SI units.
    #[arg(long, requires = "against")]
    json: bool,
}

/// # Errors
/// When a bag cannot be read or has no twin, the page cannot be written, or two runs differ beyond the tolerance.
pub(super) fn run(args: &ReportArgs) -> anyhow::Result<()> {
    if let Some(percent) = args.tolerance.filter(|percent| !(0.0..=200.0).contains(percent)) {
        let why = format!("--tolerance {percent} %: must be 0 to 200 %");
        return Err(WrongUse::new(why).into());
    }
    let Some(other) = &args.against else {
        // A table that cannot be read is named before minutes of reading.
        let lives = args.life.as_deref().map(life::existing).transpose()?;
        let mut summary = read(&args.bag, args.namespace.as_deref(), "")?;
        if let Some(lives) = lives {
            summary = summary.with_lives(lives);
        }
        if let Some(folder) = &args.out {
            let page = report::write(&summary, folder)?;
            say!("wrote {}", page.display());
        }
        return Ok(());
    };
    let namespace = args.against_namespace.as_deref().or(args.namespace.as_deref());
    let a = read(&args.bag, args.namespace.as_deref(), "A: ")?;
    compare(args, &a, &read(other, namespace, "B: ")?)
}

/// Reads a bag. Lines on what it lacks begin with `run`.
fn read(bag: &Path, namespace: Option<&str>, run: &str) -> anyhow::Result<Summary> {
    let mut progress = Progress::share();
    let summary = report::read(bag, namespace, |share| progress.at(share))?;
    progress.done();
    for missing in summary.missing() {
        tell!("{run}{}", printable(missing));
    }
    Ok(summary)
}

fn compare(args: &ReportArgs, a: &Summary, b: &Summary) -> anyhow::Result<()> {
    let tolerance = args.tolerance.map(|percent| 0.01 * percent);
    let comparison = Comparison::new(a, b);
    if let Some(folder) = &args.out {
        let page = report::write_comparison(&comparison, tolerance, folder)?;
        // Standard output belongs to the JSON, if that was asked for.
        if args.json {
            tell!("wrote {}", page.display());
        } else {
            say!("wrote {}", page.display());
        }
    }
    if args.json {
        say!("{}", serde_json::to_string_pretty(&comparison.json(tolerance))?);
    }
    let beyond = tolerance
        .map(|tolerance| comparison.beyond(tolerance))
        .unwrap_or_default();
    if beyond.is_empty() {
        return Ok(());
    }
    let named: Vec<String> = beyond
        .iter()
        .take(NAMED)
        .map(|text| printable(text).to_string())
        .collect();
    let more = match beyond.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(", and {more} more"),
    };
    anyhow::bail!(
        "the runs differ by more than {} %: {}{more}",
        args.tolerance.unwrap_or_default(),
        named.join(", ")
    )
}
