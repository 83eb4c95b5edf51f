//! The first stages of a run: a node is prepared, then started.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};

use tokio::sync::{Notify, oneshot};
use tokio::task::JoinSet;

use super::alarms::{self, AlarmDesk, AlarmRequest};
use super::clocks::{Clocks, steady};
use super::confirmed::{self, Confirmed};
use super::control::{self, Control, ParameterUpdate};
use super::following::{self, Moves};
use super::inputs::RigInputs;
use super::life::JointLife;
use super::publish::{Publisher, PublisherParts};
use super::publishers::Publishers;
use super::receive::{self, SampleReceiver};
use super::received::{self, ReceivedQueue, ReceivedSender};
use super::running::RunningNode;
use super::set_point::SharedSetPoint;
use super::simulator::{self, Simulator};
use super::viewers::{self, Viewers};
use super::what_if::{self, Answering};
use super::{LiveAddress, NodeError, NodeSetup, clock_topic, lifecycle, parameters, surveys};
use crate::ahead::ForecastDesk;
use crate::bag::{RecordingThread, Topic};
use crate::drilling::live::{Point, SharedPoints, split};
use crate::ensemble::{self, Ensemble, Pace, Running};
use crate::live::{Hub, LiveServer, Steering};
use crate::safe_window::SafeWindow;
use crate::session::Session;
use flexdrill_config::Config;
use flexdrill_core::inputs::InputKind;
use flexdrill_core::twin::{BuildError, Run, Simulation};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_realtime::clock::{SimulatedClock, WallClock};
use flexdrill_realtime::link::{Gauges, LoopEnd, PublisherEnd, Targets, link};
use flexdrill_realtime::{INPUT_PERIOD, RealTimeLoop, monotonic};
use flexdrill_ros2::dds::port::{Inbox, PortBuilder, Sample};
use flexdrill_ros2::parameters::Parameters;
use flexdrill_ros2::service::Task;
use flexdrill_ros2::{loggers, logging, type_description};
use flexdrill_text::log_ending;
use flexdrill_uncertainty::Posterior;

/// A node whose names and files are checked and whose endpoints are declared. Nothing runs yet, and nothing is on the
/// network or the disk.
pub(super) struct PreparedNode {
    setup: NodeSetup,
    config: Arc<Config>,
    port: PortBuilder,
    publishers: Publishers,
    clocks: Clocks,
    gauges: Arc<Gauges>,
    loop_end: LoopEnd,
    publisher_end: PublisherEnd,
    inputs: RigInputs,
    parameters: Arc<Parameters>,
    parameter_updates: Receiver<ParameterUpdate>,
    moves: Moves,
    alarm_requests: Receiver<AlarmRequest>,
    answering: Answering,
    simulator: Arc<Simulator>,
    /// Services and `/clock`.
    tasks: Vec<Task>,
    plain_samples: Vec<(InputKind, Arc<Inbox<Sample>>)>,
    stamped_samples: Arc<Inbox<Sample>>,
    measured_samples: Arc<Inbox<Sample>>,
    confirmed: Confirmed,
    surveys: Arc<Inbox<Sample>>,
    received: (ReceivedSender, ReceivedQueue),
    /// What viewers may steer; none without viewers.
    viewers: Option<Arc<Viewers>>,
    checkpoint: Option<Vec<u8>>,
    /// Points of the hole as drilled from the checkpoint.
    earlier: Vec<Point>,
    /// The same of this run, for its checkpoints.
    drilled: Arc<SharedPoints>,
    /// The map of speed and weight, where one is named.
    window: Option<Arc<SafeWindow>>,
    /// What plausible tools are drawn from, where the configuration names it.
    posterior: Option<Arc<Posterior>>,
    /// Notified when a managed node is shut down by its service.
    shut_down: Arc<Notify>,
}

impl PreparedNode {
    /// Prepares a node.
    ///
    /// # Errors
    /// When a name is not allowed or the checkpoint cannot be read.
    pub(super) fn new(setup: NodeSetup) -> Result<Self, NodeError> {
        // Files first: a wrong checkpoint or map ends the program before it appears on the network.
        let file = setup.checkpoint.as_deref().map(read_checkpoint).transpose()?;
        let (checkpoint, earlier) = file.map_or((None, Vec::new()), |(checkpoint, points)| (Some(checkpoint), points));
        let config_file = Path::new(&setup.config_file);
        let (config, posterior) =
            ensemble::named_by(&setup.config, config_file).map_err(|error| NodeError::Stopped(error.to_string()))?;
        let config = Arc::new(config);
        let window = SafeWindow::of(&config, config_file)?.map(Arc::new);
        let node_name = setup.identity.full_name();
        let mut port = PortBuilder::new(&setup.network, &setup.identity.namespace, &setup.identity.name);
        // Log lines from here on also reach `/rosout`; those before it are in the terminal alone.
        if setup.rosout {
            logging::connect(&mut port, &node_name);
        }
        let publishers = Publishers::new(&mut port, &config, &setup.identity, &setup.remapping)?;

        let clocks = Clocks::new(setup.use_sim_time);
        let targets = Targets::new(config.simulation().initial_inputs);
        let gauges = Arc::new(Gauges::default());
        // The solver's end of the link never waits and never allocates; the
        // rings between the two ends are all that they share.
        let (loop_end, publisher_end, requests) = link(Arc::clone(&targets), Arc::clone(&gauges));
        let inputs = RigInputs::new(&config, targets, clocks.clone());
        // The values that the model begins with are logged, because the operator has not sent them.
        inputs.log_assumed();

        let (update_sender, parameter_updates) = channel();
        let control = Control::new(
            requests,
            Arc::clone(&config),
            update_sender,
            inputs.clone(),
            Arc::clone(&gauges),
        );
        // A parameter acts through the control, which checks it against the configuration and the hard limits and sends
        // it to the solver; the store keeps it only if the control accepts.
        let applying = Arc::clone(&control);
        let parameters = Parameters::new(
            &mut port,
            node_name.clone(),
            parameters::declare(&config, &setup.config_file, setup.use_sim_time),
            Box::new(move |candidate, changed, requester| applying.apply(candidate, changed, requester)),
            |client| receive::driver(client).to_string(),
        );

        // All endpoints are declared on `port` before DDS starts: the DDS process gets them as one list.
        let (moves, followed) = following::serve(&parameters, &control);
        let mapping = setup.mapping;
        let service_name = |name: &str| setup.service_name(name);
        let mut tasks = flexdrill_ros2::parameters::serve(&mut port, mapping, &parameters);
        tasks.push(followed);
        tasks.extend(loggers::serve(&mut port, mapping, &node_name));
        tasks.push(Box::pin(type_description::serve(&mut port, mapping, &node_name)));
        tasks.extend(control::serve(&mut port, mapping, &control, service_name)?);
        let (request_sender, alarm_requests) = channel();
        tasks.extend(alarms::serve(&mut port, mapping, &request_sender, service_name)?);
        // Search and goals share the tool and the threads, so that they
        // take turns instead of competing with each other.
        let advisor = Arc::default();
        let (what_if, answering) = what_if::serve(&mut port, mapping, &clocks, &control, &advisor, service_name)?;
        tasks.extend(answering);
        let answering = Answering {
            what_if,
            control: Arc::clone(&control),
            gauges: Arc::clone(&gauges),
            inputs: inputs.clone(),
            advisor,
            forecasts: config.look_ahead.forecast.then(Arc::default),
            set_point: Arc::new(SharedSetPoint::new(&config)),
            tools: None,
        };
        let shut_down = Arc::new(Notify::new());
        // Without `--lifecycle` the services do not exist, and a supervisor sees at once that the node is not managed.
        let mut managed = None;
        if setup.lifecycle {
            let (lifecycle, transitions) = lifecycle::serve(&mut port, mapping, &control, &shut_down, service_name)?;
            tasks.extend(transitions);
            managed = Some(lifecycle);
        }
        let simulator = Simulator::new(&control, &gauges, &clocks, managed);
        tasks.extend(simulator::serve(&mut port, mapping, &simulator, service_name)?);
        tasks.extend(simulator::serve_steps(
            &mut port,
            mapping,
            &clocks,
            &simulator,
            service_name,
        )?);

        let mut subscribe = |topic: &TopicInfo| -> Result<(String, Arc<Inbox<Sample>>), NodeError> {
            let name = setup.topic_name(topic)?;
            let samples = if topic.qos.reliable {
                port.reliable_subscription(&name, topic.kind.dds_type)
            } else {
                port.subscription(&name, topic.kind.dds_type, false)
            };
            Ok((name, samples))
        };
        let mut plain = Vec::new();
        for kind in InputKind::ALL {
            let (name, samples) = subscribe(received::plain_topic(kind))?;
            plain.push((kind, name, samples));
        }
        // The stamped inputs come on one topic with all quantities, for sources that have the time of the measurement.
        let (stamped_name, stamped) = subscribe(&topics::RIG_INPUTS)?;
        let (_, measured) = subscribe(&topics::RIG_MEASURED)?;
        // Bridges report there which mappings persons have confirmed.
        let (confirmed, diagnostics) = confirmed::receive(subscribe(&topics::DIAGNOSTICS)?.1);
        tasks.push(diagnostics);
        let (_, surveys) = subscribe(&topics::RIG_SURVEY)?;
        // With simulated time the clock itself is a subscription: until its first message there is no time.
        if let Some(newest) = clocks.simulated() {
            let (_, ticks) = subscribe(&topics::CLOCK)?;
            tasks.push(Box::pin(clock_topic::follow(inputs.clone(), ticks, Arc::clone(newest))));
        }
        // Viewers that steer use the same inboxes as DDS, so that a sample of theirs passes every check.
        let viewers = setup.live.is_some().then(|| {
            let mut steered: Vec<_> = plain
                .iter()
                .map(|(kind, name, samples)| viewers::input(received::plain_topic(*kind), name.clone(), samples))
                .collect();
            steered.push(viewers::input(&topics::RIG_INPUTS, stamped_name, &stamped));
            Viewers::new(&port, &parameters, &inputs, steered)
        });
        Ok(Self {
            config,
            port,
            publishers,
            clocks,
            gauges,
            loop_end,
            publisher_end,
            inputs,
            parameters,
            parameter_updates,
            moves,
            alarm_requests,
            answering,
            simulator,
            tasks,
            plain_samples: plain.into_iter().map(|(kind, _, samples)| (kind, samples)).collect(),
            stamped_samples: stamped,
            measured_samples: measured,
            confirmed,
            surveys,
            received: received::queue(),
            viewers,
            checkpoint,
            earlier,
            drilled: Arc::clone(control.drilled()),
            window,
            posterior,
            shut_down,
            setup,
        })
    }

    /// Starts the recording, the live server, DDS, the tasks, the publisher and, last, the solver, which needs all of
    /// them.
    ///
    /// # Errors
    /// When one of them cannot be started.
    pub(super) async fn start(self) -> Result<RunningNode, NodeError> {
        let (setup, mut answering) = (self.setup, self.answering);
        let topic_name = |topic: &TopicInfo| topic_name(&setup, topic);
        // The recording starts first, so that it has the first message of every topic.
        let recording = match &setup.record {
            Some(path) => Some(RecordingThread::start(path, topic_name)?),
            None => None,
        };
        let live = match (&setup.live, self.viewers) {
            (Some(at), Some(viewers)) => Some(start_live(at, topic_name, viewers)?),
            _ => None,
        };
        let port = self.port;
        // The start of DDS waits for another process, which would block the tasks of this runtime.
        let port = tokio::task::spawn_blocking(move || port.start())
            .await
            .map_err(|error| NodeError::Stopped(error.to_string()))??;

        let mut tasks = JoinSet::new();
        for task in self.tasks {
            tasks.spawn(task);
        }
        let (record, received) = self.received;
        let receiver = || SampleReceiver {
            inputs: self.inputs.clone(),
            dds: port.monitor(),
            // Samples are copied only where something keeps them.
            record: (recording.is_some() || live.is_some()).then(|| record.clone()),
            confirmed: self.confirmed.clone(),
            warned: Mutex::default(),
        };
        for (kind, samples) in self.plain_samples {
            tasks.spawn(receive::receive_plain(receiver(), kind, samples));
        }
        tasks.spawn(receive::receive_stamped(receiver(), self.stamped_samples));
        tasks.spawn(receive::receive_measured(receiver(), self.measured_samples));
        // Surveys of the last run are there before the first frame, so that all of a recording knows them.
        let survey_file = setup.survey_state.as_deref();
        let survey_file = survey_file.and_then(|path| surveys::open(path, &self.inputs));
        tasks.spawn(receive::receive_surveys(receiver(), self.surveys, survey_file));
        tasks.spawn(receive::update_targets(self.inputs.clone()));

        // The alarms begin with the state of the last run: an acknowledgement survives a restart of the node.
        let finish = Arc::new(AtomicBool::new(false));
        let (book, mut alarms) = AlarmDesk::open(
            &self.config,
            setup.alarm_state.as_deref(),
            self.alarm_requests,
            self.clocks.rig_time(),
        );
        let mut session = Session::new(Arc::clone(&self.config), book);
        session.continue_hole(&self.earlier);
        // A table that has become unreadable since it was checked ends no node.
        match setup.life.as_ref().map(|life| life.living(&self.config)).transpose() {
            Ok(lives) => lives.into_iter().for_each(|lives| session.continue_lives(lives)),
            Err(error) => {
                let topic = topics::AGEING.name;
                if let Some(more) = log_ending(format!("{topic} has no lives")) {
                    tracing::warn!("{topic} has no lives of joints: {error}{more}");
                }
            }
        }
        if let Some(window) = self.window {
            session.judge_by(window);
        }
        let ensemble = Ensemble::of(&self.config, self.posterior);
        if let Some(ensemble) = ensemble.map_err(|error| NodeError::Stopped(error.to_string()))? {
            let running =
                Running::start(ensemble, Pace::Clock).map_err(|error| NodeError::Stopped(error.to_string()))?;
            // Look-aheads have their members from it, without a way through publisher or solver.
            answering.tools = Some(running.forking());
            session.run_with(running);
        }
        if self.config.look_ahead.advice {
            alarms.advised_by(Arc::clone(&answering.advisor));
        }
        // The forecast desk exists only where forecasts are made, so that nothing is published that never changes.
        let forecasts = answering.forecasts.as_ref().map(Arc::clone);
        let life = setup.life.clone().map(JointLife::start).transpose();
        let life = life.map_err(|error| NodeError::Stopped(format!("the joints' life has no thread: {error}")))?;
        let parts = PublisherParts {
            end: self.publisher_end,
            publishers: self.publishers,
            recording,
            live,
            received,
            parameter_updates: self.parameter_updates,
            gauges: Arc::clone(&self.gauges),
            alarms,
            inputs: self.inputs,
            confirmed: self.confirmed,
            clocks: self.clocks.clone(),
            dds: port.monitor(),
            node_name: setup.identity.full_name(),
            finish: Arc::clone(&finish),
            forecasts: forecasts.map(|forecasts| ForecastDesk::new(forecasts, &self.config, steady())),
            set_point: Arc::clone(&answering.set_point),
            moves: self.moves,
            drilled: self.drilled,
            life,
        };
        let publisher = Publisher::new(parts, session).map_err(|error| NodeError::Stopped(error.to_string()))?;
        // The publisher runs before the solver builds its tool, which takes seconds: status and alarms of the node
        // exist from the beginning.
        let publisher_thread = spawn("publisher", move || publisher.run())?;

        let (built_sender, built) = oneshot::channel();
        let time_step = self.config.solver.time_step;
        let solver = Solver {
            config: self.config,
            checkpoint: self.checkpoint,
            clocks: self.clocks,
            loop_end: self.loop_end,
        };
        let solver_thread = spawn("solver", move || solver.run(built_sender))?;
        // The look-ahead has its own thread, because a fork of the run is
        // expensive and must never hold up publisher or solver.
        let what_if = Arc::clone(&answering.what_if);
        let look_ahead_thread = spawn("look-ahead", move || answering.run())?;
        Ok(RunningNode {
            what_if,
            simulator: self.simulator,
            look_ahead_thread,
            port,
            tasks,
            parameters: self.parameters,
            gauges: self.gauges,
            publisher_thread,
            solver_thread,
            // The caller learns by `built` whether the tool could be built; the thread itself ends only with the node.
            built: Some(built),
            finish,
            shut_down: self.shut_down,
            time_step,
            duration: setup.duration,
        })
    }
}

/// The name of a topic. [`Publishers::new`] and the subscriptions have refused every wrong one before.
fn topic_name(setup: &NodeSetup, topic: &TopicInfo) -> String {
    setup.topic_name(topic).unwrap_or_else(|_| topic.name.to_owned())
}

/// State and hole as drilled of a file.
fn read_checkpoint(path: &Path) -> Result<(Vec<u8>, Vec<Point>), NodeError> {
    let refused = |why: String| NodeError::Checkpoint {
        path: path.to_owned(),
        why,
    };
    let file = std::fs::read(path).map_err(|source| refused(source.to_string()))?;
    split(file).map_err(|damaged| refused(damaged.to_string()))
}

/// Starts the server for viewers; those with the token may steer.
fn start_live(
    at: &LiveAddress,
    topic_name: impl Fn(&TopicInfo) -> String,
    viewers: Arc<Viewers>,
) -> Result<LiveServer, NodeError> {
    let offered: Vec<Topic> = topics::ALL
        .iter()
        .map(|topic| Topic::new(topic_name(topic), &topic.kind, topic.qos))
        .collect();
    let hub = Hub::new(&offered);
    let steering = at.token.as_ref().map(|token| {
        let steering = Steering::new(Arc::clone(&viewers) as _);
        viewers.publish_changes(&steering);
        (token.clone(), steering)
    });
    let steers = steering.is_some();
    let live = LiveServer::start("--foxglove", at.address, hub, &at.origins, steering)?;
    tracing::info!("live at ws://{} for Foxglove and Lichtblick", live.address());
    if steers && !live.address().ip().is_loopback() {
        tracing::warn!(
            "--foxglove {} --allow-control: every client with the token can steer from any machine that reaches this \
             address, and the token is sent unencrypted; put a proxy with TLS in front",
            live.address()
        );
    }
    Ok(live)
}

/// What the solver's thread runs.
struct Solver {
    config: Arc<Config>,
    checkpoint: Option<Vec<u8>>,
    clocks: Clocks,
    loop_end: LoopEnd,
}

impl Solver {
    /// Builds the model, reports whether that succeeded, and runs it until it is stopped.
    fn run(self, built: oneshot::Sender<Result<(), BuildError>>) {
        let run = match self.build() {
            Ok(run) => run,
            Err(error) => return drop(built.send(Err(error))),
        };
        // Nobody waits for the result where the node ends during the build.
        let _ = built.send(Ok(()));
        let steps_per_period = (INPUT_PERIOD / self.config.solver.time_step).round().max(1.0) as u64;
        match self.clocks.simulated() {
            Some(newest) => {
                let clock = SimulatedClock::new(Arc::clone(newest));
                RealTimeLoop::new(run, clock, self.loop_end, steps_per_period).run();
            }
            None => RealTimeLoop::new(run, WallClock, self.loop_end, steps_per_period).run(),
        }
    }

    fn build(&self) -> Result<Run, BuildError> {
        let began = std::time::Instant::now();
        let mut simulation = Simulation::new(&self.config.tool(), &self.config.simulation())?;
        if let Some(bytes) = &self.checkpoint {
            simulation.restore(bytes)?;
        }
        simulation.set_clock(monotonic::now);
        tracing::info!(
            "the tool is at its start after {:.1} s; model time runs",
            began.elapsed().as_secs_f64()
        );
        let schedule = flexdrill_outputs::schedule(&self.config, &self.config.outputs.rates);
        Ok(Run::new(simulation, schedule))
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
