//! `flexdrill replay`: runs a bag or a field log through the model as fast as possible.

mod alarms;
mod episodes;
mod inputs;
mod log;
mod look_ahead;
mod player;
mod recording;
mod show;
mod sink;
mod steady;
mod steps;
mod summary;

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::Context as _;
use clap::Args;

use self::inputs::Along;
use self::player::Player;
pub(super) use self::steady::record_case;
use super::progress::Progress;
use super::run::load_config;
use super::{Ended, WrongUse, life, numbers, source};
use crate::bag;
use crate::cli::output::{say, say_text, tell};
use crate::life_table::{self, TableError};
use crate::messages::topics;
use crate::safe_window::SafeWindow;
use flexdrill_config::Config;
use flexdrill_life::LivingJoints;
use flexdrill_text::{counted, printable};

/// Run a bag or a field log through the model as fast as possible, into a bag.
///
/// A recording of flexdrill is replayed with its own configuration and applied inputs: the outputs are the same to the
/// bit. A bag of the twin that another program recorded (ros2 bag record -a) is replayed from its beginning, and the
/// command states what is not exact. Of other bags and of field logs, the rig's inputs are used.
#[derive(Debug, Args)]
pub(super) struct ReplayArgs {
    /// Bag (MCAP, SQLite or their folder; also compressed, .zstd), field log (CSV) or capture of a WITS line.
    input: PathBuf,
    /// The input is a capture of a WITS line, or the bytes of one alone. A capture of flexdrill bridge is known without it.
    #[arg(long)]
    wits: bool,
    /// Bag to write: FILE.mcap or a folder.
    #[arg(long, value_name = "OUT", required_unless_present_any = ["foxglove", "guess"])]
    out: Option<PathBuf>,
    /// Show a recording unchanged in Foxglove and Lichtblick, which play, pause and seek; 127.0.0.1:8765 is their
    /// default. With --out, show the new bag.
    #[arg(long, value_name = "ADDRESS:PORT")]
    foxglove: Option<SocketAddr>,
    /// Admit a viewer from this page too, such as https://viewer.example, or file:// for viewers opened from a file;
    /// pages of this machine and of Foxglove are always admitted.
    #[arg(long, value_name = "ORIGIN", requires = "foxglove")]
    allow_origin: Vec<String>,
    /// Configuration, if the input has none of its own; default: the paper's case, built in.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Plausible tools that run with the twin, for the bands of a log; a recording has its own. Each takes the time of another
    /// run.
    #[arg(long, value_name = "NUMBER")]
    members: Option<u32>,
    /// Also search for advice on alarms and forecast the next minute, as the configuration asks (look_ahead). The run waits
    /// for each answer: a search takes 400 to 1000 s of model time, a forecast 60 s for each of its runs.
    #[arg(long, requires = "out")]
    look_ahead: bool,
    /// Sample that the plausible tools of a recording were drawn from, where its configuration names one (ensemble.from).
    /// Default: that name, next to the recording.
    #[arg(long, value_name = "FILE")]
    posterior: Option<PathBuf>,
    /// Longest model time (s).
    #[arg(long, value_name = "SECONDS", value_parser = numbers::seconds)]
    duration: Option<f64>,
    /// Also write the incidents (whirl, stick-slip, shock) as JSON.
    #[arg(long, value_name = "FILE.json")]
    incidents: Option<PathBuf>,
    /// Also add the new bag to this table of `flexdrill life`.
    #[arg(long, value_name = "FILE.csv", requires = "out")]
    life: Option<PathBuf>,
    #[command(flatten)]
    source: source::SourceArgs,
}

impl ReplayArgs {
    /// Refuses to look ahead where the configuration asks for nothing of it.
    fn may_look_ahead(&self, config: &Config) -> Result<(), WrongUse> {
        let asked = &config.look_ahead;
        if !self.look_ahead || asked.advice || asked.forecast {
            return Ok(());
        }
        Err(WrongUse::new(
            "--look-ahead: the configuration asks for nothing of the look-ahead; set look_ahead.advice or \
             look_ahead.forecast to true in it, or omit the option",
        ))
    }
}

/// # Errors
/// When the input cannot be used, a step fails, or the bag cannot be written.
pub(super) fn run(args: &ReplayArgs) -> anyhow::Result<()> {
    if args.source.ends_with_guess(&args.input)? {
        return Ok(());
    }
    if args.out.is_none() && args.foxglove.is_none() {
        return Err(WrongUse::new("--yes runs the log into a bag: add --out FILE.mcap").into());
    }
    if let Some(out) = &args.out {
        // A table that cannot be read is named before the run, which may take long.
        args.life.as_deref().map_or(Ok(()), life::is_readable)?;
        replay(args, out)?;
        if let Some(table) = &args.life {
            life::add_recording(table, out)?;
        }
    }
    let Some(address) = args.foxglove else { return Ok(()) };
    let recording = args.out.as_deref().unwrap_or(&args.input);
    if !source::is_bag(recording)? {
        return Err(WrongUse::new(format!(
            "{}: --foxglove needs a recording; add --out FILE.mcap to replay this log into one first",
            recording.display()
        ))
        .into());
    }
    show::show(recording, address, &args.allow_origin)
}

fn replay(args: &ReplayArgs, out: &Path) -> anyhow::Result<()> {
    // A recording of flexdrill repeats bit for bit from its own configuration and applied inputs. Any other source
    // passes the conditioner first, as live samples do.
    if !args.wits && source::is_bag(&args.input)? && recording::is_ours(&bag::open(&args.input)?) {
        // An option that would change the run is refused, not ignored: the result would be taken for the recorded run.
        if args.config.is_some() || args.members.is_some() || args.source.is_given() {
            return Err(WrongUse::new("a recording of flexdrill has its own configuration and inputs: omit --config, --members, --from, --to, --mapping and --guess, or use \
                 another bag").into());
        }
        let script = recording::Script::read(&args.input)?;
        let exactness = script.exactness();
        // Departures are said before the run, which may take long, and once more as its verdict.
        for departure in &exactness.departures {
            tell!("not exact: {}", printable(departure));
        }
        for note in &exactness.notes {
            tell!("{}", printable(note));
        }
        // Without applied inputs the samples of the rig are the next best source;
        // they are conditioned again, so the replay is not exact.
        let config = script.config()?;
        args.may_look_ahead(&config)?;
        let posterior = script.posterior(&config, args.posterior.as_deref(), &args.input)?;
        let done = if script.is_empty() {
            let samples = args.source.read(&args.input).with_context(|| {
                format!(
                    "{}: it does not record what drove the model, neither {} nor the rig's inputs",
                    args.input.display(),
                    topics::APPLIED_INPUTS.name
                )
            })?;
            let along = Along {
                posterior,
                window: script.window(),
                looks_ahead: args.look_ahead,
                ..Along::default()
            };
            inputs::replay(config, samples, out, args.duration, along)?
        } else {
            script.replay(out, args.duration, posterior, args.look_ahead)?
        };
        finish(done, args.incidents.as_deref())?;
        match exactness.departures.as_slice() {
            [] => say!("  exact: the recording has everything that drove the model"),
            departures => say!("  not exact: {}", printable(&departures.join("; "))),
        }
        return Ok(());
    }
    if args.posterior.is_some() {
        return Err(WrongUse::new("--posterior belongs to a recording of flexdrill; for other inputs the configuration names the file, ensemble.from").into());
    }
    let (mut config, name) = load_config(args.config.as_deref())?;
    if let Some(members) = args.members {
        config = config.with_members("--members", members)?;
    }
    args.may_look_ahead(&config)?;
    let mut posterior = None;
    if player::asks_for_members(&config) {
        let file = args.config.as_deref().unwrap_or(Path::new(""));
        (config, posterior) = crate::ensemble::named_by(&config, file)?;
    }
    say!("configuration {name}, hash {}", &config.hash()[..12]);
    let samples = if args.wits {
        args.source.read_wits(&args.input)?
    } else {
        args.source.read(&args.input)?
    };
    // Before the run, which may take long: a tool without a class or serial numbers has no lives.
    let table = args.life.as_deref();
    let lives = table.map(|table| Ok::<_, TableError>(LivingJoints::of_table(&config, life_table::read(table)?)?));
    // A relative path is relative to the folder of the configuration, as for the node.
    let window = SafeWindow::of(&config, args.config.as_deref().unwrap_or(Path::new("")))?.map(Arc::new);
    let lives = lives.transpose()?;
    let along = Along {
        posterior,
        lives,
        window,
        looks_ahead: args.look_ahead,
    };
    let done = inputs::replay(config, samples, out, args.duration, along)?;
    finish(done, args.incidents.as_deref())
}

/// Ends the bag, prints the summary of the replay, and writes the incidents to `json`.
fn finish((player, progress): (Player, Progress), json: Option<&Path>) -> anyhow::Result<()> {
    progress.done();
    let (wall, time_step) = (progress.elapsed(), player.config().solver.time_step);
    let stopped = player.is_stopped().then(|| player.time_of(player.step()));
    let joints = episodes::Joints(player.joint_stations().to_vec());
    let (recording, mut tally) = player.finish()?;
    say!(
        "wrote {} to {}",
        counted(recording.messages, "message"),
        recording.path.display()
    );
    tally.print(wall, time_step);
    say_text!("{}", tally.alarms);
    let found = tally.episodes();
    say_text!("{}", episodes::table(&found, &joints, &tally.alarms.log));
    if let Some(path) = json {
        episodes::write_json(path, &found, &joints)?;
    }
    let Some(time) = stopped else { return Ok(()) };
    Err(Ended(format!(
        "a signal ended the replay after {time:.2} s of model time since its start or last reset; {} is complete up to there",
        recording.path.display()
    ))
    .into())
}
