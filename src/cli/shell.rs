//! `flexdrill completions` and `flexdrill man`, generated from the definition of the command line.

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
    /// The shell.
    shell: Shell,
}

/// Write man pages, flexdrill.1 and one for each command.
#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// Output folder, created if necessary.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn completions(args: &CompletionsArgs) {
    // The script is generated in memory, because the generator does not report errors of its output.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "flexdrill", &mut script);
    say_text!("{}", String::from_utf8_lossy(&script));
}

/// # Errors
/// When the folder or a page cannot be written.
pub(super) fn man(args: &ManArgs) -> anyhow::Result<()> {
    let failed = || format!("cannot write the man pages to {}", args.out.display());
    std::fs::create_dir_all(&args.out).with_context(failed)?;
    clap_mangen::generate_to(Cli::command(), &args.out).with_context(failed)
}
