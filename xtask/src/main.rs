//! `cargo xtask`: generates what is checked in.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Context;
use clap::Parser;

/// Generates files that are checked in. Tests compare them with what would be written.
#[derive(Debug, Parser)]
#[command(name = "xtask")]
enum Task {
    /// Writes crates/flexdrill-messages/src/generated.rs and the rig page's messages.ts from msg/ and crates/flexdrill-messages/external/.
    Messages {
        /// Root of the repository.
        #[arg(long, default_value = ".")]
        root: PathBuf,
    },
    /// Prints a reference page of the manual: topics or configuration.
    Reference {
        /// Which page.
        page: String,
    },
    /// Writes the synthetic rig log of the demonstration, the same bytes every time.
    DemoLog {
        /// Where to.
        #[arg(default_value = "config/field_logs/demo.csv")]
        file: PathBuf,
    },
}

fn main() -> anyhow::Result<()> {
    match Task::parse() {
        Task::Messages { root } => {
            for path in xtask::messages::write(&root)? {
                println!("wrote {}", path.display());
            }
        }
        Task::Reference { page } => {
            let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
            let status = Command::new(cargo)
                .args([
                    "run",
                    "--quiet",
                    "--release",
                    "--locked",
                    "--package",
                    "flexdrill-pages",
                    "--",
                    &page,
                ])
                .status()
                .context("cargo cannot be started")?;
            anyhow::ensure!(status.success(), "the page `{page}` was not written: {status}");
        }
        Task::DemoLog { file } => {
            std::fs::write(&file, xtask::demo_log::demo_log()).with_context(|| format!("{}", file.display()))?;
            println!("wrote {}", file.display());
        }
    }
    Ok(())
}
