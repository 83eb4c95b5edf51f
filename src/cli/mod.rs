//! The command line, one file per subcommand. Exit codes: 0 done, 1 failed with a reason, 2 wrong use.

mod bench;
mod check;
mod numbers;
mod paper;
mod progress;
mod recover;
mod replay;
mod report;
mod rig;
mod run;
mod signals;
mod source;
mod verify;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::dds::side;
use crate::ros::args;
use crate::told::printable_lines;

/// Real-time digital twin of a flexible drilling tool, as a ROS 2 node.
#[derive(Debug, Parser)]
#[command(name = "flexdrill", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::RunArgs),
    Rig(rig::RigArgs),
    Replay(replay::ReplayArgs),
    Report(report::ReportArgs),
    Check(check::CheckArgs),
    Watch(watch::WatchArgs),
    Recover(recover::RecoverArgs),
    Verify(verify::VerifyArgs),
    Paper(Box<paper::PaperArgs>),
    Bench(bench::BenchArgs),
}

/// The command line cannot be used as it is: exit code 2.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct WrongUse(String);

impl WrongUse {
    fn new(why: impl ToString) -> Self {
        Self(why.to_string())
    }
}

const WRONG_USE: u8 = 2;

/// Parses the command line, runs the subcommand, reports a failure on standard error.
pub fn main() -> ExitCode {
    // The node's own child, not a subcommand for people.
    if std::env::args_os()
        .nth(1)
        .is_some_and(|first| first == side::SUBCOMMAND)
    {
        return side::main();
    }
    let (arguments, ros_args) = args::split(std::env::args());
    let cli = Cli::parse_from(arguments);
    if let Err(error) = signals::outlive_file_size_limit() {
        eprintln!("warning: a limit of the file size will end the program: {error}");
    }
    let result: anyhow::Result<()> = match cli.command {
        Command::Run(args) => run::run(&args, &ros_args),
        Command::Rig(args) => rig::run(&args, &ros_args),
        _ if !ros_args.is_empty() => Err(WrongUse::new("only `run` and `rig` take --ros-args").into()),
        Command::Replay(args) => replay::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Watch(args) => watch::run(&args),
        Command::Recover(args) => recover::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Paper(args) => paper::run(&args),
        Command::Bench(args) => bench::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", printable_lines(&format!("{error:#}")));
            if error.is::<WrongUse>() {
                ExitCode::from(WRONG_USE)
            } else {
                ExitCode::FAILURE
            }
        }
    }
}
