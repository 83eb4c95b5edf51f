//! `flexdrill completions` and `flexdrill man`: made from the command line itself.

use std::path::PathBuf;

use anyhow::Context as _;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::Cli;
use crate::cli::output::say_text;

/// Print the completions of a shell.
#[derive(Debug, Args)]
#[command(after_help = "Bash: flexdrill completions bash > ~/.local/share/bash-completion/completions/flexdrill")]
pub(super) struct CompletionsArgs {
    /// Which shell.
    shell: Shell,
}

/// Write man pages, flexdrill.1 and one for each command.
#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// Folder to write to; made if it is not there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn completions(args: &CompletionsArgs) {
    // By way of memory: the generator does not tell what a full disk does.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "flexdrill", &mut script);
    say_text!("{}", String::from_utf8_lossy(&script));
}

/// # Errors
/// When the folder or a page cannot be written.
pub(super) fn man(args: &ManArgs) -> anyhow::Result<()> {
    let failed = || format!("the man pages could not be written to {}", args.out.display());
    std::fs::create_dir_all(&args.out).with_context(failed)?;
    clap_mangen::generate_to(Cli::command(), &args.out).with_context(failed)
}
