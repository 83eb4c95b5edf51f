//! `flexdrill report`: a recording as one page to pass on.

use std::path::PathBuf;

use clap::Args;

use super::progress::Progress;
use crate::cli::output::{say, tell};
use crate::report;
use flexdrill_text::printable;

/// Make one HTML page of a recording: inputs, alarms, worst locations with orbits, forces along the tool, health.
///
/// Reads bags of `run --record`, `replay` and `ros2 bag record`, also if they were cut short; the page lists what is
/// missing. The page is a single file, and can be printed.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Bag: an .mcap or .db3 file, or a folder with such files.
    bag: PathBuf,
    /// Folder for report.html, created if necessary. An existing report.html is replaced.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Namespace of the twin, such as /rig_7, if the bag has several.
    #[arg(long, value_name = "NS")]
    namespace: Option<String>,
}

/// # Errors
/// When the bag cannot be read or has no twin, or the page cannot be written.
pub(super) fn run(args: &ReportArgs) -> anyhow::Result<()> {
    let mut progress = Progress::share();
    let summary = report::read(&args.bag, args.namespace.as_deref(), |share| progress.at(share))?;
    progress.done();
    for missing in summary.missing() {
        tell!("{}", printable(missing));
    }
    let page = report::write(&summary, &args.out)?;
    say!("wrote {}", page.display());
    Ok(())
}
