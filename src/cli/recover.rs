//! `flexdrill recover IN --out OUT`: writes a complete bag from an interrupted recording.

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use crate::bag;
use crate::cli::output::{say, tell};
use flexdrill_text::{counted, printable};

/// Largest number of damaged parts listed.
const NAMED: usize = 100;

/// Write a complete bag from one that was cut short or damaged.
#[derive(Debug, clap::Args)]
pub struct RecoverArgs {
    /// Bag: an .mcap or .db3 file, which may be compressed (.zstd), or a folder with such files.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// New bag: a file if it ends in .mcap, else a folder.
    #[arg(long, value_name = "OUT")]
    out: PathBuf,
}

/// Prints a table of topics and messages on standard output, and the losses on standard error.
///
/// # Errors
/// When the input is not a bag, has no readable message, or the output cannot be written.
pub fn run(args: &RecoverArgs) -> anyhow::Result<()> {
    let bar = ProgressBar::new(0).with_style(
        ProgressStyle::with_template("{bar:40} {human_pos}/{human_len} messages {eta}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let recovered = bag::recover_with(&args.input, &args.out, |done, total| {
        if done % 256 == 0 {
            bar.set_length(total.unwrap_or(done));
            bar.set_position(done);
        }
    });
    bar.finish_and_clear();
    let recovered = recovered?;
    name_losses(&recovered);
    for (topic, count) in recovered.topics.iter().zip(&recovered.recording.per_topic) {
        say!(
            "{count:>10}  {}  {}",
            printable(&topic.name),
            printable(&topic.ros_type)
        );
    }
    say!(
        "{:>10}  messages in {}",
        recovered.recording.messages,
        recovered.recording.path.display()
    );
    if recovered.recording.messages == 0 {
        anyhow::bail!("{} has no readable message", args.input.display());
    }
    Ok(())
}

/// Names on standard error what the new bag lacks of the old one, and why.
fn name_losses(recovered: &bag::Recovered) {
    for fault in &recovered.faults {
        tell!("{}", printable(&fault.to_string()));
    }
    for cut in &recovered.cuts {
        tell!("{}: {} (byte {})", cut.path.display(), cut.reason, cut.offset);
    }
    for damage in recovered.damaged.iter().take(NAMED) {
        tell!("damaged: {}", printable(&damage.to_string()));
    }
    if let Some(more) = recovered.damaged.len().checked_sub(NAMED).filter(|more| *more > 0) {
        tell!("damaged: {} more", counted(more as u64, "part"));
    }
    for gap in &recovered.gaps {
        tell!("lost during the recording: {gap}");
    }
}
