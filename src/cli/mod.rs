//! The command line, one file per subcommand. Exit codes: 0 done, 1 failed with a reason, 2 wrong use.

mod check;
mod generate_messages;
mod recover;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Real-time digital twin of a flexible drilling tool, as a ROS 2 node.
#[derive(Debug, Parser)]
#[command(name = "flexdrill", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Check(check::CheckArgs),
    Watch(watch::WatchArgs),
    Recover(recover::RecoverArgs),
    #[command(hide = true)]
    GenerateMessages(generate_messages::Args),
}

/// Parses the command line, runs the subcommand, reports a failure on standard error.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let result: anyhow::Result<()> = match cli.command {
        Command::Check(args) => check::run(&args),
        Command::Watch(args) => watch::run(&args),
        Command::Recover(args) => recover::run(&args),
        Command::GenerateMessages(args) => generate_messages::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
