//! `flexdrill report`: a recording as one page to send on.

use std::path::PathBuf;

use clap::Args;

use super::progress::Progress;
use crate::cli::output::{say, tell};
use crate::report;
use flexdrill_text::printable;

/// Make one HTML page of a recording: inputs, alarms, worst places with orbits, forces along the tool, health.
///
/// Takes what `run --record`, `replay` and `ros2 bag record` write, also when it was cut short, and says on the page what
/// is missing. The page needs nothing beside itself, and can be printed.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Bag: an .mcap or .db3 file, or a folder with such files.
    bag: PathBuf,
    /// Folder for report.html; made if it is not there. A report.html that is there is replaced.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The twin to report on, where the bag holds several: its namespace, such as /rig_7.
    #[arg(long, value_name = "NS")]
    namespace: Option<String>,
}

/// # Errors
/// When the bag cannot be read or holds no twin, or the page cannot be written.
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
