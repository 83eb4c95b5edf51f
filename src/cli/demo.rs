//! `flexdrill demo`: a twin, a rig that plays a log into it, and a view of both, as processes of this program that end
//! together.

use std::fs::{DirBuilder, File};
use std::os::unix::fs::DirBuilderExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context as _, bail};
use clap::Args;
use rustix::process::{Pid, Signal, getppid, kill_process};

use super::built_in::{BuiltIn, DemoLog};
use super::{numbers, signals};
use crate::cli::output::{say, tell, tell_text};
use flexdrill_text::printable_lines;

/// Variable by which a process of the demonstration knows the one that it ends with, by its number.
const PARENT: &str = "FLEXDRILL_DEMO_PROCESS";
/// ROS 2's variable that keeps DDS on this machine.
const LOCALHOST_ONLY: &str = "ROS_LOCALHOST_ONLY";
/// How often processes and signals are looked at.
const POLL: Duration = Duration::from_millis(50);
/// Time for twin and rig to start or to fail, before the view begins.
const START: Duration = Duration::from_secs(2);
/// Longest orderly end of a process; it may write the end of a recording.
const PATIENCE: Duration = Duration::from_secs(10);
/// A Ctrl-C reaches all processes at once: the end of another one may be seen before the signal.
const SAME_SIGNAL: Duration = Duration::from_millis(500);
/// The built-in log begins with a connection; from this second (s) on the tool turns, and drilling is near.
const BEGIN: &str = "45";
/// Lines of a log that are shown after a failure.
const LAST_LINES: usize = 15;

/// Plays a drilling log into a twin and shows the twin, all on this machine; q or Ctrl-C ends it.
#[derive(Debug, Args)]
pub(super) struct DemoArgs {
    /// Field log (CSV) or bag to play, again and again [default: the built-in log, from second 45].
    #[arg(conflicts_with = "steer")]
    log: Option<PathBuf>,
    /// Mapping of the log's columns (YAML) [default: config/field_logs/rig_1hz.yaml, built in].
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Play the log from here (s, or row:N).
    #[arg(long, value_name = "POSITION")]
    from: Option<String>,
    /// Play the log up to here.
    #[arg(long, value_name = "POSITION")]
    to: Option<String>,
    /// Configuration of the twin [default: config/rig.yaml, built in].
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Record a bag meanwhile.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// End after this time of viewing (s).
    #[arg(long, value_name = "S", value_parser = numbers::seconds)]
    seconds: Option<f64>,
    /// Print lines instead of a full screen.
    #[arg(long)]
    plain: bool,
    /// Show the twin in this machine's browser instead of this terminal; the address is printed too.
    #[arg(long, conflicts_with = "plain")]
    web: bool,
    /// Without a rig: the page steers.
    #[arg(long, requires = "web")]
    steer: bool,
}

/// # Errors
/// When a process cannot be started, or ends before the view.
pub(super) fn run(args: &DemoArgs) -> anyhow::Result<()> {
    let stop = signals::stop_flag()?;
    let mut demo = Demo::new()?;
    let result = demo.show(args, &stop);
    demo.end();
    if result.is_err() {
        demo.tell_last_words();
    }
    say!("stopped");
    result
}

/// Where this process was started by a demonstration, it ends with it, however that ends.
pub(super) fn end_with_parent() {
    let parent = std::env::var(PARENT).ok().and_then(|id| id.parse::<i32>().ok());
    let Some(parent) = parent.and_then(Pid::from_raw) else {
        return;
    };
    #[cfg(target_os = "linux")]
    let _ = rustix::process::set_parent_process_death_signal(Some(Signal::TERM));
    // It may have ended before the signal was asked for.
    if getppid() != Some(parent) {
        std::process::exit(1);
    }
}

/// A process of the demonstration.
struct Program {
    name: &'static str,
    process: Child,
    /// What it prints, unless that is the view.
    log: Option<PathBuf>,
}

impl Program {
    /// Ends it: politely, so that recordings are finished, then firmly.
    fn end(&mut self) {
        if !matches!(self.process.try_wait(), Ok(None)) {
            return;
        }
        let _ = kill_process(Pid::from_child(&self.process), Signal::TERM);
        let asked = Instant::now();
        while asked.elapsed() < PATIENCE {
            if !matches!(self.process.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(POLL);
        }
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The processes, and the folder with what they write. Both end with it, also in a panic.
struct Demo {
    folder: PathBuf,
    programs: Vec<Program>,
    /// The process whose end is a failure.
    failed: Option<&'static str>,
}

impl Drop for Demo {
    fn drop(&mut self) {
        self.end();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

impl Demo {
    fn new() -> anyhow::Result<Self> {
        // Of an earlier process with the same number a folder may remain.
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default()
            .as_nanos();
        let folder = std::env::temp_dir().join(format!("flexdrill_demo_{}_{now}", std::process::id()));
        // A folder that exists is not ours.
        DirBuilder::new()
            .mode(0o700)
            .create(&folder)
            .with_context(|| format!("{}: cannot be made", folder.display()))?;
        Ok(Self {
            folder,
            programs: Vec::new(),
            failed: None,
        })
    }

    fn show(&mut self, args: &DemoArgs, stop: &AtomicBool) -> anyhow::Result<()> {
        let local = std::env::var(LOCALHOST_ONLY).unwrap_or_else(|_| "1".to_owned());
        say!(
            "DDS domain {}, {}",
            std::env::var("ROS_DOMAIN_ID").unwrap_or_else(|_| "0".to_owned()),
            if local == "1" {
                "this machine only"
            } else {
                "all networks"
            }
        );
        let config = args.config.as_deref().unwrap_or(Path::new(BuiltIn::Rig.name()));
        say!("starting the twin: {}", config.display());
        let mut twin = self.command(&local)?;
        // Alarms of a twin that is left running are not those of a demonstration.
        twin.arg("run").arg("--state-dir").arg(self.folder.join("state"));
        twin.arg("--config").arg(config);
        if let Some(record) = &args.record {
            twin.arg("--record").arg(record);
        }
        self.start("twin", twin)?;
        if !args.steer {
            let rig = self.rig(args, &local)?;
            self.start("rig", rig)?;
        }
        let begun = Instant::now();
        while begun.elapsed() < START {
            if self.has_ended(stop)? {
                return Ok(());
            }
            std::thread::sleep(POLL);
        }
        let mut view = self.command(&local)?;
        if args.web {
            if !args.steer {
                say!("the rig drives, so the page may not; --steer leaves the rig out");
            }
            view.args(["dashboard", "--open", "--allow-control"]);
        } else {
            view.arg("watch");
            view.args(args.plain.then_some("--plain"));
            if let Some(seconds) = args.seconds {
                view.args(["--duration", &seconds.to_string()]);
            }
        }
        let process = view.spawn().context("the view cannot be started")?;
        self.programs.push(Program {
            name: "view",
            process,
            log: None,
        });
        // The terminal view ends by itself, the page's server does not.
        let most = args.seconds.filter(|_| args.web).map(Duration::from_secs_f64);
        let shown = Instant::now();
        while !self.has_ended(stop)? && most.is_none_or(|most| shown.elapsed() < most) {
            std::thread::sleep(POLL);
        }
        Ok(())
    }

    /// The rig with its log.
    fn rig(&self, args: &DemoArgs, local: &str) -> anyhow::Result<Command> {
        let mut rig = self.command(local)?;
        rig.arg("rig");
        match &args.log {
            Some(log) => rig.arg(log),
            None => rig.arg(DemoLog.name()),
        };
        rig.arg("--loop");
        say!(
            "starting the rig: {}",
            args.log
                .as_ref()
                .map_or_else(|| DemoLog.name(), |log| log.display().to_string())
        );
        let is_table = |log: &PathBuf| log.extension().is_some_and(|extension| extension == "csv");
        if let Some(mapping) = &args.mapping {
            rig.arg("--mapping").arg(mapping);
        } else if args.log.as_ref().is_some_and(is_table) {
            let path = self.folder.join("rig_1hz.yaml");
            std::fs::write(&path, DemoLog.mapping_text()).with_context(|| path.display().to_string())?;
            rig.arg("--mapping").arg(path);
        }
        let is_whole = args.log.is_none() && args.from.is_none() && args.to.is_none();
        if let Some(from) = args.from.as_deref().or(is_whole.then_some(BEGIN)) {
            rig.args(["--from", from]);
        }
        if let Some(to) = &args.to {
            rig.args(["--to", to]);
        }
        Ok(rig)
    }

    /// This program again, with the variables of a process of the demonstration.
    fn command(&self, local: &str) -> anyhow::Result<Command> {
        let program = std::env::current_exe().context("the path of this program is not known")?;
        let mut command = Command::new(program);
        command
            .env(PARENT, std::process::id().to_string())
            .env(LOCALHOST_ONLY, local);
        Ok(command)
    }

    /// Starts a process that prints into a log.
    fn start(&mut self, name: &'static str, mut command: Command) -> anyhow::Result<()> {
        let path = self.folder.join(format!("{name}.log"));
        let log = File::create(&path).with_context(|| path.display().to_string())?;
        let process = command
            .stdin(Stdio::null())
            .stdout(log.try_clone()?)
            .stderr(log)
            .spawn()
            .with_context(|| format!("the {name} cannot be started"))?;
        self.programs.push(Program {
            name,
            process,
            log: Some(path),
        });
        Ok(())
    }

    /// Whether the demonstration has ended: by a signal, or because the view has.
    ///
    /// # Errors
    /// When a process has ended that should not.
    fn has_ended(&mut self, stop: &AtomicBool) -> anyhow::Result<bool> {
        let is_stopped = || stop.load(Ordering::Relaxed);
        if is_stopped() {
            return Ok(true);
        }
        let ended = self.programs.iter_mut().find_map(|program| {
            let status = program.process.try_wait().ok().flatten()?;
            Some((program.name, program.log.is_none(), status))
        });
        let Some((name, is_view, status)) = ended else {
            return Ok(false);
        };
        if is_view && status.success() {
            return Ok(true);
        }
        let seen = Instant::now();
        while seen.elapsed() < SAME_SIGNAL {
            if is_stopped() {
                return Ok(true);
            }
            std::thread::sleep(POLL);
        }
        self.failed = Some(name);
        bail!("the {name} ended: {}", in_words(status))
    }

    /// Ends all processes, the last one first: the rig outlives its viewers, and the twin its rig.
    fn end(&mut self) {
        self.programs.iter_mut().rev().for_each(Program::end);
    }

    /// Prints the end of the log of the process that failed; of the view, which has none, the twin's.
    fn tell_last_words(&self) {
        let of_failed = |program: &&Program| self.failed == Some(program.name) && program.log.is_some();
        let program = self.programs.iter().find(of_failed).or(self.programs.first());
        let Some(program) = program.filter(|_| self.failed.is_some()) else {
            return;
        };
        let text = program.log.as_ref().and_then(|log| std::fs::read(log).ok());
        let text = text.unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let lines: Vec<&str> = text.lines().collect();
        let last = &lines[lines.len().saturating_sub(LAST_LINES)..];
        tell!("the last lines of the {}:", program.name);
        tell_text!("{}\n", printable_lines(&last.join("\n")));
    }
}

fn in_words(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("exit code {code}"),
        None => status.to_string(),
    }
}
