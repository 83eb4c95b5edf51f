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
    /// Prints a reference page of the manual (topics, configuration or validation), the rows of the rig page (figures), or
    /// the columns of the Python package (columns).
    Reference {
        /// Which page.
        page: String,
    },
    /// Runs the measurements of docs/measurements.md that take minutes to hours: --cases real-time, scaling, physics,
    /// memory, step-error, truth, quality, rig-faults or all.
    #[command(disable_help_flag = true)]
    Measure {
        /// What the measurements accept; --help lists it.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Draws a picture of the documents: physics, speed or whirl, and where to.
    #[command(disable_help_flag = true)]
    Figure {
        /// Picture and place; --help lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Searches for parameter sets that agree with the paper's findings.
    #[command(disable_help_flag = true)]
    Search {
        /// What the search accepts; --help lists it.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
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
            package("flexdrill-pages", &[page])?;
        }
        Task::Measure { arguments } => package("flexdrill-measurements", &arguments)?,
        Task::Figure { arguments } => study("figure", arguments)?,
        Task::Search { arguments } => study("search", arguments)?,
        Task::DemoLog { file } => {
            std::fs::write(&file, xtask::demo_log::demo_log()).with_context(|| format!("{}", file.display()))?;
            println!("wrote {}", file.display());
        }
    }
    Ok(())
}

/// Runs a command of the package of studies.
fn study(command: &str, arguments: Vec<String>) -> anyhow::Result<()> {
    package("flexdrill-studies", &[vec![command.to_owned()], arguments].concat())
}

/// Builds and runs another package of the workshop.
fn package(name: &str, arguments: &[String]) -> anyhow::Result<()> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--quiet", "--release", "--locked", "--package", name, "--"])
        .args(arguments)
        .status()
        .context("cargo cannot be started")?;
    anyhow::ensure!(status.success(), "{name} ended with {status}");
    Ok(())
}
