//! The node: what runs where, and how it begins and ends.
//!
//! - the solver's thread: [`flexdrill_realtime`];
//! - the publisher's thread: `publish`; the recorder's thread: [`RecordingThread`];
//! - tokio tasks: inputs (`rig`), `/clock` (`clock`), services and parameters (`control`).

pub mod alarms;
mod clock;
pub mod control;
mod ending;
pub mod publish;
pub mod publishers;
pub mod rig;
mod thinned;
pub mod viewers;

use std::future::Future;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::channel;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use tokio::sync::Notify;
use tokio::task::JoinSet;

use self::alarms::AlarmDesk;
use self::control::Control;
use self::ending::{Ended, Ending};
use self::publish::{Publisher, PublisherParts};
use self::publishers::Publishers;
use self::rig::{Now, RigInputs, RigTime};
use self::viewers::Viewers;
use super::args::{NodeIdentity, Remapping};
use super::parameters::{self, Parameters};
use super::service::ServiceMapping;
use super::{DEFAULT_NODE_NAME, NodeError, lifecycle, loggers, logging, type_description};
use crate::bag::{Recording, RecordingThread, Topic};
use crate::dds::network::Network;
use crate::dds::port::{Monitor, PortBuilder};
use crate::live::{Hub, LiveServer, Steering, Token};
use crate::messages::topics::{self, TopicInfo};
use crate::messages::{TwinStatus, outputs};
use flexdrill_config::Config;
use flexdrill_core::inputs::InputKind;
use flexdrill_core::twin::{BuildError, Run, Simulation};
use flexdrill_realtime::clock::{SimulatedClock, WallClock, rig_clock};
use flexdrill_realtime::link::{Gauges, Targets, link};
use flexdrill_realtime::monotonic;
use flexdrill_realtime::{INPUT_PERIOD, RealTimeLoop};

/// Longest wait for the solver to end: a step that is split to its limit takes this long on a slow machine.
const SOLVER_END: Duration = Duration::from_secs(5);

/// Longest wait for the answers to requests that came before the end.
const LAST_ANSWERS: Duration = Duration::from_secs(2);

/// All that decides how a node runs.
#[derive(Debug, Clone)]
pub struct NodeSetup {
    /// Configuration, overrides included.
    pub config: Config,
    /// Where it was read from.
    pub config_file: String,
    /// Domain and reach.
    pub network: Network,
    /// Name and namespace, remapped.
    pub identity: NodeIdentity,
    /// Rules for topics and services.
    pub remapping: Remapping,
    /// Form of the services.
    pub mapping: ServiceMapping,
    /// File to record to.
    pub record: Option<PathBuf>,
    /// Show what is published live at this address, in Foxglove's protocol.
    pub live: Option<LiveAddress>,
    /// `/clock` paces the model.
    pub use_sim_time: bool,
    /// Log lines on `/rosout`.
    pub rosout: bool,
    /// State to start from.
    pub checkpoint: Option<PathBuf>,
    /// File that the alarms' state is kept in over a restart.
    pub alarm_state: Option<PathBuf>,
    /// A managed node: it begins unconfigured and follows `~/change_state`.
    pub lifecycle: bool,
    /// Model time after which it ends, or wall time for which model time may stand still (s).
    pub duration: Option<f64>,
}

/// Where and to whom the node shows what it publishes live.
#[derive(Debug, Clone)]
pub struct LiveAddress {
    /// To listen at.
    pub address: SocketAddr,
    /// Pages that may look beside this machine's own, as `https://viewer.example`.
    pub origins: Vec<String>,
    /// Who shows it may steer; nobody without.
    pub token: Option<Token>,
}

/// What a node's run came to.
#[derive(Debug)]
pub struct RunSummary {
    /// The last status.
    pub status: TwinStatus,
    /// The finished recording.
    pub recording: Option<Recording>,
}

impl NodeSetup {
    /// The absolute name of a topic.
    ///
    /// # Errors
    /// When a remapped name is wrong.
    pub fn topic_name(&self, topic: &TopicInfo) -> Result<String, NodeError> {
        Ok(self.remapping.topic(&self.identity, DEFAULT_NODE_NAME, topic.name)?)
    }
}

/// Runs a node until `shutdown` is done or the configured duration has passed.
///
/// # Errors
/// When DDS, the model or the recording cannot be started, or the recording could not be finished.
pub async fn run(setup: NodeSetup, shutdown: impl Future<Output = ()>) -> Result<RunSummary, NodeError> {
    let result = run_until(setup, shutdown).await;
    logging::disconnect();
    result
}

async fn run_until(setup: NodeSetup, shutdown: impl Future<Output = ()>) -> Result<RunSummary, NodeError> {
    let mut port = PortBuilder::new(&setup.network, &setup.identity.namespace, &setup.identity.name);
    if setup.rosout {
        logging::connect(&mut port, &setup.identity.full_name());
    }
    let config = Arc::new(setup.config.clone());
    let publishers = Publishers::new(&mut port, &config, &setup.identity, &setup.remapping)?;
    let recording = match &setup.record {
        Some(path) => {
            // Names were checked when the publishers were made.
            let name = |topic: &TopicInfo| setup.topic_name(topic).unwrap_or_else(|_| topic.name.to_owned());
            Some(RecordingThread::start(path, name)?)
        }
        None => None,
    };

    let simulated = Arc::new(AtomicU64::new(0));
    let now: Now = time_of_inputs(setup.use_sim_time.then(|| Arc::clone(&simulated)));
    let stamp_time = stamp_time(setup.use_sim_time.then(|| Arc::clone(&simulated)));
    let rig_time = rig_time(setup.use_sim_time.then(|| Arc::clone(&simulated)));
    let settings = config.simulation();
    let targets = Targets::new(settings.initial_inputs);
    let gauges = Arc::new(Gauges::default());
    let (loop_end, publisher_end, commands) = link(Arc::clone(&targets), Arc::clone(&gauges));
    let rig_inputs = RigInputs::new(&config.inputs, targets, Arc::clone(&now), stamp_time);

    let (change_sender, changes) = channel();
    let control = Control::new(
        commands,
        Arc::clone(&config),
        change_sender,
        rig_inputs.clone(),
        Arc::clone(&gauges),
    );
    let store = parameters::declare(&config, &setup.config_file, setup.use_sim_time);
    let acting = Arc::clone(&control);
    let parameters = Parameters::new(
        &mut port,
        setup.identity.full_name(),
        store,
        Box::new(move |candidate, changed, asked_by| acting.act(candidate, changed, asked_by)),
    );

    let mut tasks = JoinSet::new();
    for task in parameters::serve(&mut port, setup.mapping, &parameters) {
        tasks.spawn(task);
    }
    for task in loggers::serve(&mut port, setup.mapping, &setup.identity.full_name()) {
        tasks.spawn(task);
    }
    tasks.spawn(type_description::serve(
        &mut port,
        setup.mapping,
        &setup.identity.full_name(),
    ));
    let service_name = |name: &str| setup.remapping.service(&setup.identity, DEFAULT_NODE_NAME, name);
    for task in control::serve(&mut port, setup.mapping, &control, service_name)? {
        tasks.spawn(task);
    }
    let (asked_sender, asked) = channel();
    for task in alarms::serve(&mut port, setup.mapping, &asked_sender, service_name)? {
        tasks.spawn(task);
    }
    let ended = Arc::new(Notify::new());
    if setup.lifecycle {
        for task in lifecycle::serve(&mut port, setup.mapping, &control, &ended, service_name)? {
            tasks.spawn(task);
        }
    }
    let (for_recording, received) = rig::for_recording();
    let mut inputs = Vec::new();
    let mut plain = Vec::new();
    for (kind, topic) in [
        (InputKind::RotarySpeed, &topics::ROTARY_SPEED_RPM),
        (InputKind::WeightOnBit, &topics::WEIGHT_ON_BIT_KN),
    ] {
        let name = setup.topic_name(topic)?;
        let samples = port.subscription(&name, topic.kind.dds_type, false);
        inputs.push(viewers::input(topic, name, &samples));
        plain.push((kind, samples));
    }
    let topic = &topics::RIG_INPUTS;
    let name = setup.topic_name(topic)?;
    let stamped = port.subscription(&name, topic.kind.dds_type, false);
    inputs.push(viewers::input(topic, name, &stamped));
    if setup.use_sim_time {
        let name = setup.topic_name(&topics::CLOCK)?;
        let ticks = port.subscription(&name, topics::CLOCK.kind.dds_type, false);
        tasks.spawn(clock::follow(rig_inputs.clone(), ticks, Arc::clone(&simulated)));
    }
    let live = match &setup.live {
        Some(at) => Some(start_live(&setup, at, || {
            Viewers::new(&port, &parameters, &rig_inputs, inputs)
        })?),
        None => None,
    };
    let port = tokio::task::spawn_blocking(move || port.start())
        .await
        .map_err(|error| NodeError::Stopped(error.to_string()))??;
    let door = || rig::Door {
        rig: rig_inputs.clone(),
        dds: port.monitor(),
        record: (recording.is_some() || live.is_some()).then(|| for_recording.clone()),
    };
    for (kind, samples) in plain {
        tasks.spawn(rig::receive_plain(door(), kind, samples));
    }
    tasks.spawn(rig::receive_stamped(door(), stamped));
    let (conditioner, intake) = (Arc::clone(&rig_inputs.conditioner), Arc::clone(&rig_inputs.intake));
    tasks.spawn(rig::keep_targets(rig_inputs));

    let finish = Arc::new(AtomicBool::new(false));
    let publisher = Publisher::new(PublisherParts {
        end: publisher_end,
        publishers,
        recording,
        live,
        received,
        changes,
        config: Arc::clone(&config),
        gauges: Arc::clone(&gauges),
        alarms: AlarmDesk::new(Arc::clone(&config), setup.alarm_state.as_deref(), asked, rig_time()),
        conditioner,
        intake,
        now,
        use_sim_time: setup.use_sim_time,
        rig_time,
        dds: port.monitor(),
        node_name: setup.identity.full_name(),
        finish: Arc::clone(&finish),
    })
    .map_err(|error| NodeError::Stopped(error.to_string()))?;
    let publisher_thread = spawn("publisher", move || publisher.run())?;

    let (built_sender, built) = tokio::sync::oneshot::channel::<Result<(), BuildError>>();
    let steps_per_period = (INPUT_PERIOD / settings.time_step).round().max(1.0) as u64;
    let checkpoint = read_checkpoint(&setup)?;
    let clock_cell = setup.use_sim_time.then_some(simulated);
    let solver_thread = spawn("solver", move || {
        let run = match build(&config, checkpoint.as_deref()) {
            Ok(run) => run,
            Err(error) => return drop(built_sender.send(Err(error))),
        };
        // The node may be ending meanwhile.
        let _ = built_sender.send(Ok(()));
        match clock_cell {
            Some(cell) => RealTimeLoop::new(run, SimulatedClock::new(cell), loop_end, steps_per_period).run(),
            None => RealTimeLoop::new(run, WallClock, loop_end, steps_per_period).run(),
        }
    })?;

    let shutdown = async {
        tokio::select! {
            () = shutdown => {}
            () = ended.notified() => {}
        }
    };
    let outcome = wait(built, &gauges, settings.time_step, setup.duration, shutdown).await;

    answered(&port.monitor()).await;
    // The solver first, so that all it did is published; then the tasks; then what is left is written.
    gauges.stop.store(true, Ordering::Relaxed);
    let solver_ended = joined(solver_thread, SOLVER_END).await;
    if !solver_ended {
        tracing::warn!(
            "the solver is still in a step after {} s; it is left behind",
            SOLVER_END.as_secs()
        );
    }
    tasks.shutdown().await;
    finish.store(true, Ordering::Release);
    let (recording, status) = tokio::task::spawn_blocking(move || publisher_thread.join())
        .await
        .ok()
        .and_then(Result::ok)
        .ok_or_else(|| NodeError::Stopped("the publisher's thread ended badly".into()))?;
    drop(parameters);
    logging::disconnect();
    // Leaves the network, after the last status has gone out.
    tokio::task::spawn_blocking(move || drop(port))
        .await
        .map_err(|error| NodeError::Stopped(error.to_string()))?;
    let recording = match recording {
        Some(recording) => Some(
            tokio::task::spawn_blocking(move || recording.finish())
                .await
                .map_err(|e| NodeError::Stopped(e.to_string()))??,
        ),
        None => None,
    };
    outcome?;
    Ok(RunSummary { status, recording })
}

/// Shows what is published, and lets who has the token steer.
fn start_live(
    setup: &NodeSetup,
    at: &LiveAddress,
    steered: impl FnOnce() -> Arc<Viewers>,
) -> Result<LiveServer, NodeError> {
    // Names were checked when the publishers were made.
    let name = |topic: &TopicInfo| setup.topic_name(topic).unwrap_or_else(|_| topic.name.to_owned());
    let offered: Vec<Topic> = topics::ALL
        .iter()
        .map(|topic| Topic::new(name(topic), &topic.kind, topic.qos))
        .collect();
    let hub = Hub::new(&offered);
    let steering = match &at.token {
        None => None,
        Some(token) => {
            let viewers = steered();
            let steering = Steering::new(Arc::clone(&viewers) as _);
            viewers.tell_changes(&steering);
            Some((token.clone(), steering))
        }
    };
    let steers = steering.is_some();
    let live = LiveServer::start("--foxglove", at.address, hub, &at.origins, steering)?;
    tracing::info!("live at ws://{} for Foxglove and Lichtblick", live.address());
    if steers && !live.address().ip().is_loopback() {
        tracing::warn!(
            "--foxglove {} --allow-control: who has the token can steer from any machine that reaches this address, and the \
             token goes in the clear; put a proxy with TLS in front",
            live.address()
        );
    }
    Ok(live)
}

fn build(config: &Config, checkpoint: Option<&[u8]>) -> Result<Run, BuildError> {
    let began = std::time::Instant::now();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    if let Some(bytes) = checkpoint {
        simulation.restore(bytes)?;
    }
    simulation.set_clock(monotonic::now);
    tracing::info!(
        "the tool is at its start after {:.1} s; model time runs",
        began.elapsed().as_secs_f64()
    );
    Ok(Run::new(simulation, outputs::schedule(config, &config.outputs.rates)))
}

fn read_checkpoint(setup: &NodeSetup) -> Result<Option<Vec<u8>>, NodeError> {
    let read = |path: &PathBuf| {
        std::fs::read(path).map_err(|source| NodeError::Checkpoint {
            path: path.clone(),
            why: source.to_string(),
        })
    };
    setup.checkpoint.as_ref().map(read).transpose()
}

/// Waits for the end of the run: on request, after the duration, or because the model could not be built.
async fn wait(
    built: tokio::sync::oneshot::Receiver<Result<(), BuildError>>,
    gauges: &Gauges,
    time_step: f64,
    duration: Option<f64>,
    shutdown: impl Future<Output = ()>,
) -> Result<(), NodeError> {
    tokio::pin!(shutdown);
    tokio::select! {
        () = &mut shutdown => return Ok(()),
        result = built => match result {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(error.into()),
            Err(_) => return Err(NodeError::Stopped("the solver's thread ended badly".into())),
        },
    }
    let over = async {
        let Some(duration) = duration else {
            return std::future::pending().await;
        };
        let mut ending = Ending::new(duration, monotonic::now() as f64 * 1e-9);
        let why = loop {
            let model_time = gauges.step.load(Ordering::Relaxed) as f64 * time_step;
            if let Some(why) = ending.look(model_time, monotonic::now() as f64 * 1e-9) {
                break why;
            }
            tokio::time::sleep(Duration::from_millis(20)).await;
        };
        match why {
            Ended::ModelTime => tracing::info!("the configured duration of {duration} s has passed"),
            Ended::StandsStill => tracing::warn!(
                "model time has stood still for the configured duration of {duration} s: is /clock published, is the node \
                 paused, has a step failed?"
            ),
        }
    };
    tokio::select! {
        () = shutdown => Ok(()),
        () = over => Ok(()),
    }
}

fn spawn<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<std::thread::JoinHandle<T>, NodeError> {
    std::thread::Builder::new()
        .name(name.to_owned())
        .spawn(work)
        .map_err(|error| NodeError::Stopped(format!("the {name}'s thread could not be started: {error}")))
}

/// Waits until all requests have their answers, [`LAST_ANSWERS`] at most.
async fn answered(dds: &Monitor) {
    let deadline = tokio::time::Instant::now() + LAST_ANSWERS;
    while dds.open_requests() > 0 && tokio::time::Instant::now() < deadline {
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
}

/// Joins a thread, at most so long. Whether it ended.
async fn joined(thread: std::thread::JoinHandle<()>, most: Duration) -> bool {
    let deadline = tokio::time::Instant::now() + most;
    while !thread.is_finished() {
        if tokio::time::Instant::now() >= deadline {
            return false;
        }
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    thread.join().is_ok()
}

fn time_of_inputs(simulated: Option<Arc<AtomicU64>>) -> Now {
    match simulated {
        Some(cell) => Arc::new(move || cell.load(Ordering::Acquire) as f64 * 1e-9),
        None => Arc::new(|| monotonic::now() as f64 * 1e-9),
    }
}

/// The clock that stamps of others are held against. Ours keep to the clock as it was at the start; theirs follow the
/// system's clock, also when that is set.
fn stamp_time(simulated: Option<Arc<AtomicU64>>) -> RigTime {
    match simulated {
        Some(cell) => Arc::new(move || cell.load(Ordering::Acquire) as i64),
        None => Arc::new(|| {
            SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |since| since.as_nanos() as i64)
        }),
    }
}

fn rig_time(simulated: Option<Arc<AtomicU64>>) -> RigTime {
    match simulated {
        Some(cell) => Arc::new(move || cell.load(Ordering::Acquire) as i64),
        None => Arc::new(|| rig_clock() as i64),
    }
}
