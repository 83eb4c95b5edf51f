//! `flexdrill run`: the node.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::Context as _;
use clap::Args;

use super::built_in::{self, BuiltIn};
use super::{WrongUse, numbers, plan, record_name, signals};
use crate::bag::Losses;
use crate::cli::output::say;
use crate::dds::network::Network;
use crate::life_table;
use crate::live::Token;
use crate::messages::TwinStatus;
use crate::messages::topics::{self, Cadence};
use crate::node::DEFAULT_NODE_NAME;
use crate::node::life::LifeSetup;
use crate::node::parameters;
use crate::node::{self, LiveAddress, NodeSetup, RunSummary};
use crate::ros::args::RosArgs;
use crate::ros::service::ServiceMapping;
use crate::state_file;
use flexdrill_config::Config;
use flexdrill_core::twin::Output;
use flexdrill_ros2::dds::network::Reach;
use flexdrill_ros2::logging;
use flexdrill_text::counted;

/// Name of the configuration of a node without a given one.
const DEFAULT_CONFIG_NAME: &str = BuiltIn::Default.name();

/// Run the twin as a ROS 2 node.
#[derive(Debug, Args)]
#[command(
    after_help = "ROS 2 arguments follow --ros-args, up to -- or the end: -r from:=to, -r __ns:=/rig_7, -r __node:=name, \
    -p name:=value, --params-file FILE, --log-level LEVEL. With them `run` may be omitted, as in `ros2 run flexdrill flexdrill --ros-args \
    -p config_file:=FILE`.\nEvery key of the configuration is a parameter of the same dotted name; \
    -p and parameter files override the configuration file.\nROS_DOMAIN_ID, ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS and \
    RMW_IMPLEMENTATION are honoured; RUST_LOG sets the log filter."
)]
pub(super) struct RunArgs {
    /// Configuration (YAML), also as the parameter config_file; without it the paper's case, built in.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Record inputs and outputs into FILE.mcap, or into a folder as rosbag2 does. {start} in the name becomes the time
    /// of the start (UTC), for a supervisor that runs the same command again.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// DDS domain, 0 to 232; overrides ROS_DOMAIN_ID.
    #[arg(long, value_name = "ID")]
    domain: Option<u16>,
    /// Namespace of the node and its topics.
    #[arg(long, value_name = "NS", default_value = "/")]
    namespace: String,
    /// Mapping of services: auto (as each client uses), enhanced (rmw_fastrtps) or cyclone (rmw_cyclonedds).
    #[arg(long, value_name = "MAPPING", default_value = "auto")]
    service_mapping: ServiceMapping,
    /// Run as a managed node of ROS 2: start unconfigured, with model time stopped, and follow ~/change_state.
    #[arg(long)]
    lifecycle: bool,
    /// End after this much model time (s), or when model time has been stopped for as long, as without /clock.
    #[arg(long, value_name = "SECONDS", value_parser = numbers::seconds)]
    duration: Option<f64>,
    /// Folder for what survives a restart: the acknowledged and shelved alarms, and the surveys of the hole; default
    /// $XDG_STATE_HOME/flexdrill or ~/.local/state/flexdrill.
    #[arg(long, value_name = "DIR")]
    state_dir: Option<PathBuf>,
    /// Add the run to this table of `flexdrill life` while it runs, every minute and at its end.
    #[arg(long, value_name = "FILE.csv")]
    life: Option<PathBuf>,
    /// Serial number of a joint whose life begins with this run. A new table needs none.
    #[arg(long, value_name = "SERIAL", requires = "life")]
    new: Vec<String>,
    /// Also publish over WebSocket, for Foxglove and Lichtblick; 127.0.0.1:8765 is their default. Viewers cannot act on
    /// the twin without --allow-control.
    #[arg(long, value_name = "ADDRESS:PORT")]
    foxglove: Option<SocketAddr>,
    /// Admit a viewer from this page too, such as https://viewer.example, or file:// for viewers opened from a file;
    /// pages of this machine and of Foxglove are always admitted.
    #[arg(long, value_name = "ORIGIN", requires = "foxglove")]
    allow_origin: Vec<String>,
    /// Let a viewer at ws://ADDRESS:PORT/?token=TOKEN set parameters, call services and drive; the program prints the
    /// token.
    #[arg(long, requires = "foxglove")]
    allow_control: bool,
    /// File with the token; without it the program generates one.
    #[arg(long, value_name = "FILE", requires = "allow_control")]
    token_file: Option<PathBuf>,
    /// Start from a state that ~/save_checkpoint has written. A recording of such a run cannot be replayed.
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
}

/// # Errors
/// When an argument, the configuration or the network cannot be used, or the recording failed.
pub(super) fn run(args: &RunArgs, ros_args: &[String]) -> anyhow::Result<()> {
    let ros_args = RosArgs::parse(ros_args).map_err(WrongUse::new)?;
    // Logging begins before anything that can warn; its level is an argument of ROS.
    logging::start(&ros_args);
    let identity = ros_args
        .remapping
        .identity(&args.namespace, DEFAULT_NODE_NAME)
        .map_err(WrongUse::new)?;
    // Overrides are for a node by its name, so the identity comes before them. The file that they may name comes before
    // their values, which apply on top of it.
    let overrides = ros_args.overrides.for_node(&identity);
    let named = parameters::config_file(&overrides).map_err(WrongUse::new)?;
    let (config, config_file) = load_config(chosen_config(args.config.as_deref(), named)?)?;
    let started = parameters::apply_overrides(&config, &overrides)?;
    let (network, notes) = Network::read(args.domain, |name| std::env::var(name).ok()).map_err(WrongUse::new)?;
    let asked = &started.config.network;
    let network = network
        .configured(reach(asked.reach), &asked.interfaces, &asked.peers)
        .map_err(WrongUse::new)?;
    // Alarms and surveys survive a restart only in files for this domain and name: two nodes on one machine must not share them.
    let state_dir = args
        .state_dir
        .clone()
        .or_else(|| state_file::default_folder(|name| std::env::var(name).ok()));
    let state = |of: &str, extension: &str| {
        let name = state_file::file_name(of, network.domain_id, &identity.full_name(), extension);
        state_dir.as_ref().map(|folder| folder.join(name))
    };
    let (alarm_state, survey_state) = (state("alarms", "json"), state("surveys", "csv"));
    // The token is read before the node starts, so that a missing file
    // ends the program at once and not after the first viewer.
    let token = Token::where_allowed(args.allow_control, args.token_file.as_deref())?;
    let setup = NodeSetup {
        config: started.config,
        config_file,
        network,
        identity,
        remapping: ros_args.remapping.clone(),
        mapping: args.service_mapping,
        live: args.foxglove.map(|address| LiveAddress {
            address,
            origins: args.allow_origin.clone(),
            token,
        }),
        record: args
            .record
            .as_deref()
            .map(|path| record_name::at_start(path, SystemTime::now())),
        use_sim_time: started.use_sim_time,
        rosout: ros_args.rosout.unwrap_or(true),
        checkpoint: args.checkpoint.clone(),
        alarm_state,
        survey_state,
        life: args.life.clone().map(|table| LifeSetup {
            table,
            new: args.new.clone(),
        }),
        lifecycle: args.lifecycle,
        duration: args.duration.or(config.run.duration),
    };
    // A table that refuses the run is named before the node starts.
    if let Some(LifeSetup { table, new }) = &setup.life {
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        let now = now.map_or(0, |since| since.as_nanos() as i64);
        life_table::check(table, &setup.config, now, new).with_context(|| format!("--life {}", table.display()))?;
    }
    // The banner resolves every topic name, so that a remapping that is
    // not allowed fails before the network is entered.
    print_banner(&setup)?;
    for note in notes.iter().chain(&setup.config.warnings()) {
        tracing::warn!("{note}");
    }
    // Two workers serve inputs and services. The solver and the publisher
    // have their own threads and must not wait for a task.
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()?;
    let summary = runtime.block_on(async {
        // Signals are caught before the node runs: a recording that is cut off by one would need a recovery.
        let shutdown = signals::shutdown(setup.record.is_some())?;
        anyhow::Ok(node::run(setup, shutdown).await?)
    })?;
    print_summary(&summary);
    Ok(())
}

/// The configuration file of the option or of the parameter `config_file`; `None` for the built-in one. `named` is the
/// parameter with its origin.
///
/// # Errors
/// When both are given and are different files.
fn chosen_config<'a>(option: Option<&'a Path>, named: Option<(&'a str, &str)>) -> Result<Option<&'a Path>, WrongUse> {
    let Some((path, origin)) = named else { return Ok(option) };
    // A node with the built-in configuration has this value, and `ros2 param dump` writes it.
    let named = (path != DEFAULT_CONFIG_NAME).then(|| Path::new(path));
    let is_same =
        |a: &Path, b: &Path| a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    match (option, named) {
        (None, named) => Ok(named),
        (Some(option), Some(named)) if is_same(option, named) => Ok(Some(option)),
        (Some(option), _) => Err(WrongUse::new(format!(
            "--config {} and the parameter config_file = {path} ({origin}) name different configurations; give one of them",
            option.display()
        ))),
    }
}

/// The configuration and the name of its source.
pub(super) fn load_config(path: Option<&std::path::Path>) -> anyhow::Result<(Config, String)> {
    let Some(path) = path else {
        return Ok((BuiltIn::Default.or_file(None)?, DEFAULT_CONFIG_NAME.to_owned()));
    };
    let (config, name) = built_in::load(path)?;
    Ok((plan::with_stations(config, &name, path)?, name))
}

fn print_banner(setup: &NodeSetup) -> anyhow::Result<()> {
    let config = &setup.config;
    let row = |name: &str, value: String| say!("  {name:<14} {value}");
    say!(
        "flexdrill {}, node {}",
        env!("CARGO_PKG_VERSION"),
        setup.identity.full_name()
    );
    // The hash links this output to recordings and reports of the same configuration.
    row(
        "configuration",
        format!("{}, hash {}", setup.config_file, &config.hash()[..12]),
    );
    row(
        "model",
        format!(
            "{} links of {} elements, {} unknowns, step {}",
            config.tool.links,
            config.tool.elements_per_link,
            config.unknowns().total(),
            config.solver.step_in_words()
        ),
    );
    row("network", setup.network.describe());
    row("services", setup.mapping.describe().to_owned());
    if setup.use_sim_time {
        row("clock", format!("{} (use_sim_time)", setup.topic_name(&topics::CLOCK)?));
    }
    // These two topics are enough for a rig; the row names the type
    // because a publisher of another type is not matched by DDS.
    for (topic, unit) in [(&topics::ROTARY_SPEED_RPM, "r/min"), (&topics::WEIGHT_ON_BIT_KN, "kN")] {
        row(
            "input",
            format!("{} [{}, {unit}]", setup.topic_name(topic)?, topic.kind.ros_type),
        );
    }
    for (topic, what) in [
        (&topics::RIG_INPUTS, "both, with stamp"),
        (&topics::RIG_MEASURED, "what the rig measures besides, for comparison"),
        (&topics::RIG_SURVEY, "surveys of the hole, for the hole ahead"),
    ] {
        row(
            "input",
            format!("{} [{}, {what}]", setup.topic_name(topic)?, topic.kind.ros_type),
        );
    }
    // These are the rates on DDS; recordings and viewers may have higher ones.
    let schedule = flexdrill_outputs::published(config);
    for topic in topics::ALL.iter().filter(|topic| topic.cadence != Cadence::Received) {
        let rate = match topic.cadence {
            Cadence::Rate(key) => rate(config, &schedule, key),
            _ => "on change".to_owned(),
        };
        row(
            "output",
            format!("{} [{}, {rate}]", setup.topic_name(topic)?, topic.kind.ros_type),
        );
    }
    row(
        "action",
        format!("{} [flexdrill/action/WhatIf]", setup.service_name("~/what_if")?),
    );
    row(
        "action",
        format!(
            "{} [simulation_interfaces/action/SimulateSteps]",
            setup.service_name("~/simulate_steps")?
        ),
    );
    match &setup.alarm_state {
        Some(path) => row("alarm state", path.display().to_string()),
        None => row(
            "alarm state",
            "not kept, because there is no home folder; use --state-dir".to_owned(),
        ),
    }
    if let Some(path) = &setup.survey_state {
        row("surveys", path.display().to_string());
    }
    // The address with the token is shown once, here: who has it may steer.
    if let Some(live) = &setup.live {
        row("live", format!("ws://{}", live.address));
        if let Some(token) = &live.token {
            row("steering", format!("ws://{}/?token={}", live.address, token.text()));
        }
    }
    if let Some(life) = &setup.life {
        row("joint life", life.table.display().to_string());
    }
    if let Some(path) = &setup.record {
        row("recording", path.display().to_string());
    }
    say!("  Ctrl-C ends it.");
    Ok(())
}

fn rate(config: &Config, schedule: &flexdrill_core::twin::Schedule, key: &str) -> String {
    let of = |output| schedule.rate(output, config.solver.time_step);
    let rate = match key {
        "joint_deflections" => of(Output::JointDeflections),
        "joint_states" => of(Output::JointStates),
        "contact_forces" => of(Output::ContactForces),
        "bit_state" => of(Output::BitState),
        "whirl" => of(Output::Whirl),
        "tool_shape" => of(Output::ToolShape),
        "ageing" => of(Output::Ageing),
        "reactions" => of(Output::Reactions),
        "transfer" => of(Output::Transfer),
        "status" => config.outputs.rates.status,
        "diagnostics" => config.outputs.rates.diagnostics,
        _ => 0.0,
    };
    if rate > 0.0 {
        format!("{} Hz", (rate * 100.0).round() / 100.0)
    } else {
        "off".to_owned()
    }
}

fn print_summary(summary: &RunSummary) {
    let TwinStatus {
        model_time,
        step_count,
        steps_skipped,
        steps_stood_still,
        deadline_misses,
        halved_steps,
        failed_steps,
        ..
    } = summary.status;
    // Paused time is no fault of the machine, and is kept apart from skipped steps.
    let not_taken = match steps_stood_still {
        0 => String::new(),
        steps => format!(", {steps} not taken (paused or failed)"),
    };
    say!(
        "ended after {model_time:.2} s of model time: {step_count} steps, {steps_skipped} skipped, {deadline_misses} late, \
         {halved_steps} halved, {failed_steps} failed{not_taken}"
    );
    if let Some(recording) = &summary.recording {
        let files = match recording.files {
            1 => String::new(),
            files => format!(" and {} more", files - 1),
        };
        say!(
            "recorded {} to {}{files}",
            counted(recording.messages, "message"),
            recording.path.display()
        );
        // The `refused` ones may be on the disk, and have their own line below.
        if recording.lost > 0 {
            let lost = Losses {
                refused: 0,
                ..recording.losses
            };
            say!(
                "{} missing in the recording: {lost}",
                counted(recording.lost, "message")
            );
        }
        // After a failed sync the kernel may have dropped pages that it had accepted: the program cannot know which.
        if recording.doubtful > 0 {
            say!(
                "perhaps lost: {} of the recording, which the disk failed to sync",
                counted(recording.doubtful, "message")
            );
        }
    }
}

/// The reach that the configuration asks for; `None` where ROS 2's variables decide.
fn reach(asked: flexdrill_config::Reach) -> Option<Reach> {
    match asked {
        flexdrill_config::Reach::Environment => None,
        flexdrill_config::Reach::Subnet => Some(Reach::Subnet),
        flexdrill_config::Reach::Localhost => Some(Reach::Localhost),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parameter_names_the_configuration_as_the_option_does() {
        let here = Path::new("Cargo.toml");
        let chosen = |option, named: Option<&'static str>| chosen_config(option, named.map(|path| (path, "-p")));
        assert_eq!(chosen(None, None).unwrap(), None);
        assert_eq!(chosen(Some(here), None).unwrap(), Some(here));
        assert_eq!(chosen(None, Some("Cargo.toml")).unwrap(), Some(here));
        assert_eq!(chosen(Some(here), Some("./src/../Cargo.toml")).unwrap(), Some(here));
        assert_eq!(chosen(None, Some(DEFAULT_CONFIG_NAME)).unwrap(), None);
        for other in ["Cargo.lock", "nowhere.yaml", DEFAULT_CONFIG_NAME] {
            let refused = chosen(Some(here), Some(other)).unwrap_err().to_string();
            assert!(refused.contains("Cargo.toml") && refused.contains(other), "{refused}");
        }
    }
}
