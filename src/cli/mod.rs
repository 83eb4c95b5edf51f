//! The command line, one file per subcommand. Exit codes: 0 done, 1 failed with a reason, 2 wrong use.

#[cfg(not(feature = "full"))]
mod absent;
#[cfg(feature = "sweep")]
mod ahead;
#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "bridge")]
mod bridge;
#[cfg_attr(
    not(feature = "full"),
    allow(dead_code, reason = "commands that this build lacks use the rest")
)]
mod built_in;
#[cfg(feature = "calibrate")]
mod calibrate;
mod check;
mod dashboard;
mod demo;
mod drills;
mod first_start;
mod life;
#[cfg(feature = "sweep")]
mod map;
mod new_file;
#[cfg_attr(
    not(feature = "full"),
    allow(dead_code, reason = "commands that this build lacks use the rest")
)]
mod numbers;
#[cfg_attr(
    not(feature = "full"),
    allow(dead_code, reason = "commands that this build lacks use the rest")
)]
mod output;
#[cfg(feature = "paper")]
mod paper;
mod plan;
mod priors;
#[cfg_attr(
    not(feature = "full"),
    allow(dead_code, reason = "commands that this build lacks use the rest")
)]
mod progress;
#[cfg(feature = "sweep")]
mod reach;
mod rebase;
mod record_name;
mod recover;
mod replay;
#[cfg(feature = "report")]
mod report;
mod rig;
mod run;
#[cfg(feature = "sweep")]
mod sensitivity;
mod shell;
mod signals;
#[cfg_attr(
    not(feature = "full"),
    allow(dead_code, reason = "commands that this build lacks use the rest")
)]
mod source;
#[cfg(feature = "sweep")]
mod sweep;
#[cfg(feature = "sweep")]
mod trip;
mod verify;
mod watch;
#[cfg(any(feature = "calibrate", feature = "sweep"))]
mod whole_file;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};

#[cfg(not(feature = "bench"))]
use self::absent::bench;
#[cfg(not(feature = "bridge"))]
use self::absent::bridge;
#[cfg(not(feature = "calibrate"))]
use self::absent::calibrate;
#[cfg(not(feature = "paper"))]
use self::absent::paper;
#[cfg(not(feature = "report"))]
use self::absent::report;
#[cfg(not(feature = "sweep"))]
use self::absent::{ahead, map, reach, sensitivity, sweep, trip};
use crate::cli::output::{tell, tell_text};
use crate::dds::side;
use crate::ros::args;
use flexdrill_text::{printable, printable_lines};

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
    Bridge(bridge::BridgeArgs),
    Replay(replay::ReplayArgs),
    Report(report::ReportArgs),
    Life(life::LifeArgs),
    Check(check::CheckArgs),
    Watch(watch::WatchArgs),
    Dashboard(dashboard::DashboardArgs),
    Demo(demo::DemoArgs),
    Rebase(rebase::RebaseArgs),
    Recover(recover::RecoverArgs),
    Verify(verify::VerifyArgs),
    Paper(Box<paper::PaperArgs>),
    Bench(bench::BenchArgs),
    Reach(reach::ReachArgs),
    Ahead(ahead::AheadArgs),
    Trip(trip::TripArgs),
    Calibrate(Box<calibrate::CalibrateArgs>),
    Map(Box<map::MapArgs>),
    Sweep(sweep::SweepArgs),
    Sensitivity(sensitivity::SensitivityArgs),
    Completions(shell::CompletionsArgs),
    Man(shell::ManArgs),
}

/// The command line is wrong: exit code 2.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct WrongUse(String);

impl WrongUse {
    fn new(why: impl ToString) -> Self {
        Self(why.to_string())
    }
}

/// A signal ended the command before its result was complete: exit code 130.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Ended(String);

const WRONG_USE: u8 = 2;
const FAILED: u8 = 1;

/// Prints what is wrong with the command line and the command probably meant, or the help requested, and ends the
/// program.
fn wrong_use(error: &clap::Error, arguments: &[OsString]) -> ! {
    if error.kind() == ErrorKind::InvalidSubcommand
        && let Some(word) = arguments.get(1).map(|word| word.to_string_lossy())
        && let Some(command) =
            first_start::suggestion(&word, Cli::command().get_subcommands().map(clap::Command::get_name))
    {
        tell!(
            "error: flexdrill has no command '{}'\n\n  try: {}\n",
            printable(&word),
            printable(&command)
        );
        tell!("For more information, try 'flexdrill --help'.");
        std::process::exit(i32::from(WRONG_USE));
    }
    let printed = error.print();
    // The output of --help is a result: if it cannot be printed, the command has failed.
    if !error.use_stderr()
        && let Err(why) = output::judge(printed.err().or_else(output::closed))
    {
        tell!("error: {why}");
        std::process::exit(i32::from(FAILED));
    }
    std::process::exit(error.exit_code());
}

/// Why a command line is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misunderstood {
    /// Whether it only ends too early, as a quotation of its beginning does.
    pub incomplete: bool,
    /// The text for the user.
    pub text: String,
}

/// The arguments outside and inside `--ros-args`. With ROS 2 arguments and no subcommand, as `ros2 run` and `ros2
/// launch` start a program, the subcommand is `run`.
fn split(given: Vec<OsString>) -> (Vec<OsString>, Vec<OsString>) {
    let is_ros = given.iter().any(|argument| argument == "--ros-args");
    let (mut arguments, ros_args) = args::split(given);
    let asks = ["-h", "--help", "-V", "--version"];
    let names_none = |word: &OsString| {
        let word = word.to_string_lossy();
        word.starts_with('-') && !asks.contains(&&*word)
    };
    if is_ros && !arguments.is_empty() && arguments.get(1).is_none_or(names_none) {
        arguments.insert(1, "run".into());
    }
    (arguments, ros_args)
}

/// Parses a command line, which begins with the program's name, and runs nothing.
///
/// # Errors
/// Why it is wrong.
pub fn understand(arguments: impl IntoIterator<Item = String>) -> Result<(), Misunderstood> {
    let (arguments, ros_args) = split(arguments.into_iter().map(OsString::from).collect());
    // The words come from text, so nothing is lost.
    let ros_args: Vec<String> = ros_args
        .iter()
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    match Cli::try_parse_from(arguments) {
        Err(error) if error.use_stderr() => {
            let ends_early = [
                ErrorKind::MissingRequiredArgument,
                ErrorKind::MissingSubcommand,
                ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand,
            ];
            // The line ends with an option that needs a value.
            let no_value = error.kind() == ErrorKind::InvalidValue
                && matches!(error.get(ContextKind::InvalidValue), Some(ContextValue::String(value)) if value.is_empty());
            return Err(Misunderstood {
                incomplete: no_value || ends_early.contains(&error.kind()),
                text: error.to_string(),
            });
        }
        _ => {}
    }
    let ros = args::RosArgs::parse(&ros_args);
    ros.map(drop).map_err(|error| Misunderstood {
        incomplete: matches!(error, args::ArgsError::NoValue(_)),
        text: error.to_string(),
    })
}

/// The arguments after `--ros-args` as text.
fn as_text(arguments: Vec<OsString>) -> Result<Vec<String>, WrongUse> {
    let text = |argument: OsString| {
        argument.into_string().map_err(|argument| {
            let shown = argument.to_string_lossy();
            WrongUse(format!("--ros-args: `{shown}` is not UTF-8; ROS 2 arguments are text"))
        })
    };
    arguments.into_iter().map(text).collect()
}

/// An error and its causes in one line. A cause that the text before it contains is omitted.
fn one_line(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if text.is_empty() {
            text = cause;
        } else if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}

/// Parses the command line, runs the subcommand, reports a failure on standard error. `no_output` states that the
/// program was started without a standard output.
pub fn main(no_output: bool) -> ExitCode {
    if no_output {
        output::close();
    }
    // The node starts itself with this hidden subcommand as its DDS process.
    if std::env::args_os()
        .nth(1)
        .is_some_and(|first| first == side::SUBCOMMAND)
    {
        return side::main();
    }
    demo::end_with_parent();
    #[cfg(feature = "sqlite")]
    flexdrill_sqlite::read_sqlite();
    let (arguments, ros_args) = split(std::env::args_os().collect());
    if arguments.len() < 2 {
        tell_text!("{}", first_start::WELCOME);
        return ExitCode::from(WRONG_USE);
    }
    let cli = Cli::try_parse_from(&arguments).unwrap_or_else(|error| wrong_use(&error, &arguments));
    if let Err(error) = signals::outlive_file_size_limit() {
        tell!("warning: the program ends when a file reaches the size limit (ulimit -f): {error}");
    }
    let result = as_text(ros_args)
        .map_err(anyhow::Error::from)
        .and_then(|ros_args| run_command(cli.command, &ros_args));
    match result.and_then(|()| Ok(output::end()?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tell!("error: {}", printable_lines(&one_line(&error)));
            ExitCode::from(if error.is::<WrongUse>() {
                WRONG_USE
            } else if error.is::<Ended>() {
                signals::ENDED
            } else {
                FAILED
            })
        }
    }
}

fn run_command(command: Command, ros_args: &[String]) -> anyhow::Result<()> {
    match command {
        Command::Run(args) => run::run(&args, ros_args),
        Command::Rig(args) => rig::run(&args, ros_args),
        Command::Bridge(args) => bridge::run(&args, ros_args),
        _ if !ros_args.is_empty() => Err(WrongUse::new("only `run`, `rig` and `bridge` accept --ros-args").into()),
        Command::Replay(args) => replay::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Life(args) => life::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Watch(args) => watch::run(&args),
        Command::Dashboard(args) => dashboard::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Rebase(args) => rebase::run(&args),
        Command::Recover(args) => recover::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Paper(args) => paper::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Reach(args) => reach::run(&args),
        Command::Ahead(args) => ahead::run(&args),
        Command::Trip(args) => trip::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Map(args) => map::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Sensitivity(args) => sensitivity::run(&args),
        Command::Completions(args) => {
            shell::completions(&args);
            Ok(())
        }
        Command::Man(args) => shell::man(&args),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_printed_once() {
        let missing = || std::io::Error::from_raw_os_error(2);
        let shown = output::NotPrinted(missing());
        assert_eq!(one_line(&shown.into()).matches("No such file").count(), 1);
        let context = anyhow::Error::from(missing()).context("log.csv");
        assert_eq!(one_line(&context), format!("log.csv: {}", missing()));
    }

    fn split_line(line: &str) -> (Vec<OsString>, Vec<OsString>) {
        split(line.split_whitespace().map(OsString::from).collect())
    }

    #[test]
    fn ros_arguments_alone_run_the_node() {
        for (line, expected) in [
            ("flexdrill --ros-args -r __ns:=/rig_7", vec!["flexdrill", "run"]),
            ("flexdrill --ros-args", vec!["flexdrill", "run"]),
            (
                "flexdrill --lifecycle --ros-args -p a:=1 -- --domain 3",
                vec!["flexdrill", "run", "--lifecycle", "--domain", "3"],
            ),
            (
                "flexdrill rig log.csv --ros-args -r a:=b",
                vec!["flexdrill", "rig", "log.csv"],
            ),
            ("flexdrill --help --ros-args", vec!["flexdrill", "--help"]),
            ("flexdrill", vec!["flexdrill"]),
        ] {
            assert_eq!(split_line(line).0, expected, "{line}");
        }
    }
}
