//! `flexdrill generate-demo-log FILE`: writes the synthetic rig log again.

use std::path::PathBuf;

use anyhow::Context;

use crate::field_log::demo::demo_log;

/// Writes the synthetic rig log of the demonstration (`config/field_logs/demo.csv`), the same bytes every time.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Where to.
    file: PathBuf,
}

/// # Errors
/// When the file cannot be written.
pub(super) fn run(args: &Args) -> anyhow::Result<()> {
    std::fs::write(&args.file, demo_log()).with_context(|| format!("{}", args.file.display()))
}
