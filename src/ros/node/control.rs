//! What others may ask of the node: parameters, reset, pause, checkpoint.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Sender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use ros2_client::{Parameter, ParameterValue};

use super::rig::RigInputs;
use crate::dds::port::PortBuilder;
use crate::messages::outputs::{self, ParameterChange};
use crate::messages::std_srvs::{SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse};
use crate::ros::NodeError;
use crate::ros::parameters::{ParameterStore, Refusal, Task, reconfigured, refresh_ranges};
use crate::ros::service::{ServiceMapping, ServiceServer, asked_by, at_once, shared};
use flexdrill_config::{Config, HardBounds, Rates};
use flexdrill_core::twin::CheckpointError;
use flexdrill_realtime::link::{Command, Gauges, RunState, Settings};

/// Least time between two checkpoints.
const BETWEEN_CHECKPOINTS: Duration = Duration::from_secs(1);
/// Longest wait for the solver to hand out its state.
const CHECKPOINT_WAIT: Duration = Duration::from_secs(10);

/// Parameters that changed with the command of this number.
#[derive(Debug)]
pub struct Change {
    /// Acts when the solver has carried out so many commands.
    pub command: u64,
    /// Names, values, and who asked for them.
    pub values: Vec<ParameterChange>,
    /// The configuration with them.
    pub config: Arc<Config>,
}

struct Commands {
    sender: rtrb::Producer<Command>,
    sent: u64,
}

/// Why a service of the node could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum ControlError {
    /// The ring of commands is full.
    #[error("the solver does not take commands; is a step taking very long?")]
    Busy,
    /// There is no state yet.
    #[error("the model is still being built")]
    Starting,
    /// A managed node runs the model in one state only.
    #[error(
        "the node is managed and {state}: model time runs in the state active only; \
         configure and activate it first (ros2 lifecycle set)"
    )]
    NotActive {
        /// Its state in a word.
        state: &'static str,
    },
    /// The solver is in a step that takes too long.
    #[error("the solver did not answer in time")]
    NoAnswer,
    /// Each checkpoint holds the solver up for a moment.
    #[error("the last checkpoint was asked for {0:.1} s ago; one every {seconds} s is taken", seconds = BETWEEN_CHECKPOINTS.as_secs())]
    TooOften(f64),
    /// The state could not be put into bytes.
    #[error(transparent)]
    State(#[from] CheckpointError),
    /// The file could not be written.
    #[error("{}: {source}", path.display())]
    Write {
        /// File or folder that it is about.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// The task that wrote it was ended.
    #[error(transparent)]
    Ended(#[from] tokio::task::JoinError),
}

/// Sends commands to the solver.
pub struct Control {
    commands: Mutex<Commands>,
    config: Mutex<Arc<Config>>,
    changes: Sender<Change>,
    rig_inputs: RigInputs,
    gauges: Arc<Gauges>,
    hard_bounds: HardBounds,
    /// Publishing rates at the start: recordings keep them.
    begun: Rates,
    /// When one was asked for last.
    checkpoint: Mutex<Option<Instant>>,
    /// State of a managed node that is not active, in which model time stands still.
    inactive: Mutex<Option<&'static str>>,
}

/// What of a configuration acts while the solver runs.
fn settings(config: &Config, begun: &Rates) -> Settings {
    let simulation = config.simulation();
    Settings {
        live: config.live(),
        slew: [simulation.rotary_speed_slew, simulation.weight_on_bit_slew],
        whirl: config.whirl_settings(),
        schedule: outputs::schedule(config, begun),
    }
}

impl Control {
    /// A control of a solver; `changes` go to the publisher.
    pub fn new(
        sender: rtrb::Producer<Command>,
        config: Arc<Config>,
        changes: Sender<Change>,
        rig_inputs: RigInputs,
        gauges: Arc<Gauges>,
    ) -> Arc<Self> {
        Arc::new(Self {
            hard_bounds: HardBounds::of(&config),
            begun: config.outputs.rates,
            commands: Mutex::new(Commands { sender, sent: 0 }),
            config: Mutex::new(config),
            changes,
            rig_inputs,
            gauges,
            checkpoint: Mutex::default(),
            inactive: Mutex::default(),
        })
    }

    fn config(&self) -> Arc<Config> {
        Arc::clone(&self.config.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Sends a command. Its number.
    fn send(&self, command: Command) -> Result<u64, ControlError> {
        self.send_with(command, |_| ())
    }

    /// The same; `then` is called with its number, before the solver can carry it out, and only when there is room.
    fn send_with(&self, command: Command, then: impl FnOnce(u64)) -> Result<u64, ControlError> {
        let mut commands = self.commands.lock().unwrap_or_else(PoisonError::into_inner);
        // Nobody else sends: what has room now has room below.
        if commands.sender.is_full() {
            return Err(ControlError::Busy);
        }
        let number = commands.sent + 1;
        then(number);
        commands.sender.push(command).map_err(|_| ControlError::Busy)?;
        commands.sent = number;
        Ok(number)
    }

    /// Lets changed parameters act together, as one command, or refuses them and changes nothing. `candidate` is the
    /// store with them; `asked_by` is recorded with them.
    ///
    /// # Errors
    /// When the configuration does not make sense with them, they go beyond a hard limit, or the solver takes nothing.
    pub fn act(&self, candidate: &mut ParameterStore, changed: &[Parameter], asked_by: &str) -> Result<(), Refusal> {
        let config = reconfigured(&self.config(), changed)?;
        self.hard_bounds.check(&config)?;
        let config = Arc::new(config);
        let values = changed
            .iter()
            .filter_map(|parameter| {
                Some(ParameterChange {
                    name: parameter.name.clone(),
                    value: number(&parameter.value)?,
                    asked_by: asked_by.to_owned(),
                })
            })
            .collect();
        let tell = |command| {
            let config = Arc::clone(&config);
            // The publisher has ended: so will the node.
            let _ = self.changes.send(Change {
                command,
                values,
                config,
            });
        };
        self.send_with(Command::Settings(settings(&config, &self.begun)), tell)
            .map_err(|why| Refusal::NotPassedOn { why: why.to_string() })?;
        *self.config.lock().unwrap_or_else(PoisonError::into_inner) = Arc::clone(&config);
        refresh_ranges(candidate, &config, &self.hard_bounds);
        self.rig_inputs.set_rules(&config.inputs);
        Ok(())
    }

    /// Has the model go back to its state after the start.
    ///
    /// # Errors
    /// When the solver has no room for another command.
    pub fn go_back(&self) -> Result<(), ControlError> {
        tracing::info!("reset: the model goes back to its state after the start{}", asked_by());
        self.send(Command::Reset).map(drop)
    }

    /// Has model time stand still, or go on.
    ///
    /// # Errors
    /// As [`Control::go_back`]; [`ControlError::NotActive`] where a managed node is to go on that is not active.
    pub fn pause(&self, pause: bool) -> Result<(), ControlError> {
        // Held until the command is sent, so that a transition does not come between.
        let inactive = self.inactive.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(state) = inactive.filter(|_| !pause) {
            return Err(ControlError::NotActive { state });
        }
        self.send(Command::Pause(pause))?;
        tracing::info!("{}{}", if pause { "paused" } else { "resumed" }, asked_by());
        Ok(())
    }

    /// Model time of a managed node runs from now on, or stands still in the `inactive` state of that name.
    ///
    /// # Errors
    /// As [`Control::go_back`]; then nothing has changed.
    pub fn manage(&self, inactive: Option<&'static str>) -> Result<(), ControlError> {
        let mut state = self.inactive.lock().unwrap_or_else(PoisonError::into_inner);
        self.send(Command::Pause(inactive.is_some()))?;
        *state = inactive;
        Ok(())
    }

    fn answer_reset(&self) -> TriggerResponse {
        let done = self.go_back();
        answer(done.map(|()| "the model goes back to its state after the start".to_owned()))
    }

    fn answer_pause(&self, pause: bool) -> SetBoolResponse {
        let said = if pause { "paused" } else { "running" };
        let TriggerResponse { success, message } = answer(self.pause(pause).map(|()| said.to_owned()));
        SetBoolResponse { success, message }
    }

    async fn save_checkpoint(self: Arc<Self>) -> TriggerResponse {
        if self.gauges.run_state() == RunState::Starting {
            return answer(Err(ControlError::Starting));
        }
        {
            let mut last = self.checkpoint.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(passed) = last
                .map(|at: Instant| at.elapsed())
                .filter(|passed| *passed < BETWEEN_CHECKPOINTS)
            {
                return answer(Err(ControlError::TooOften(passed.as_secs_f64())));
            }
            *last = Some(Instant::now());
        }
        let saved = tokio::task::spawn_blocking(move || {
            let (sender, receiver) = sync_channel(1);
            self.send(Command::Checkpoint(sender))?;
            let bytes = receiver
                .recv_timeout(CHECKPOINT_WAIT)
                .map_err(|_| ControlError::NoAnswer)??;
            let step = self.gauges.step.load(Ordering::Relaxed);
            let path = PathBuf::from(format!(
                "flexdrill_{}_step{step}.checkpoint",
                &self.config().hash()[..12]
            ));
            if let Err(source) = write_whole(&path, &bytes) {
                return Err(ControlError::Write { path, source });
            }
            let shown = std::path::absolute(&path).unwrap_or(path);
            Ok(format!("{} ({} bytes)", shown.display(), bytes.len()))
        });
        let result = saved.await.unwrap_or_else(|error| Err(error.into()));
        match &result {
            Ok(message) => tracing::info!("checkpoint saved: {message}"),
            Err(why) => tracing::warn!("no checkpoint: {why}"),
        }
        answer(result)
    }
}

/// Writes a file that is there as a whole or not at all, on the disk when this returns.
fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let temporary = path.with_extension("checkpoint.part");
    let written = File::create(&temporary)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
        .and_then(|()| std::fs::rename(&temporary, path));
    if written.is_err() {
        // What is left of it is of no use; that it cannot be removed adds nothing.
        let _ = std::fs::remove_file(&temporary);
    }
    written
}

fn number(value: &ParameterValue) -> Option<f64> {
    match value {
        ParameterValue::Double(value) => Some(*value),
        ParameterValue::Integer(value) => Some(*value as f64),
        _ => None,
    }
}

fn answer(result: Result<String, ControlError>) -> TriggerResponse {
    match result {
        Ok(message) => TriggerResponse { success: true, message },
        Err(error) => TriggerResponse {
            success: false,
            message: error.to_string(),
        },
    }
}

/// Creates `~/reset`, `~/pause` and `~/save_checkpoint`; `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is wrong.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    control: &Arc<Control>,
    name: impl Fn(&str) -> Result<String, crate::ros::args::ArgsError>,
) -> Result<Vec<Task>, NodeError> {
    let mut server = |private: &str, kind: &str| -> Result<ServiceServer, NodeError> {
        let kind = format!("std_srvs/srv/{kind}");
        Ok(ServiceServer::new(port, &name(private)?, &kind, mapping))
    };
    let (reset, pause) = (Arc::clone(control), Arc::clone(control));
    Ok(vec![
        Box::pin(server("~/reset", "Trigger")?.serve(at_once(move |_: TriggerRequest| reset.answer_reset()))),
        Box::pin(
            server("~/pause", "SetBool")?
                .serve(at_once(move |request: SetBoolRequest| pause.answer_pause(request.data))),
        ),
        Box::pin(
            server("~/save_checkpoint", "Trigger")?.serve(shared(Arc::clone(control), |control, _: TriggerRequest| {
                control.save_checkpoint()
            })),
        ),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::parameters::declare;
    use flexdrill_realtime::link::{LoopEnd, PublisherEnd, Targets, link};
    use std::sync::mpsc::{Receiver, channel};

    struct Bench {
        control: Arc<Control>,
        store: ParameterStore,
        changes: Receiver<Change>,
        _solver: (LoopEnd, PublisherEnd),
    }

    /// A control whose solver takes nothing: it is still being built.
    fn bench() -> Bench {
        let text = include_str!("../../../config/default.yaml");
        let config = Arc::new(Config::from_text("default.yaml", text).unwrap());
        let gauges = Arc::new(Gauges::default());
        let targets = Targets::new(config.simulation().initial_inputs);
        let (loop_end, publisher_end, commands) = link(Arc::clone(&targets), Arc::clone(&gauges));
        let (sender, changes) = channel();
        let rig_inputs = RigInputs::new(&config.inputs, targets, Arc::new(|| 0.0), Arc::new(|| 0));
        Bench {
            store: declare(&config, "default.yaml", false),
            control: Control::new(commands, config, sender, rig_inputs, gauges),
            changes,
            _solver: (loop_end, publisher_end),
        }
    }

    fn set(bench: &mut Bench, key: &str, value: f64) -> Result<Vec<Parameter>, Refusal> {
        let parameter = Parameter {
            name: key.into(),
            value: ParameterValue::Double(value),
        };
        let control = Arc::clone(&bench.control);
        bench
            .store
            .set_atomically(&[parameter], |store, changed| control.act(store, changed, "a test"))
    }

    #[test]
    fn a_managed_node_goes_on_in_the_active_state_only() {
        let control = bench().control;
        let sent = || control.commands.lock().unwrap().sent;
        for (commands, state) in [(1, "unconfigured"), (2, "inactive")] {
            control.manage(Some(state)).unwrap();
            let refused = control.answer_pause(false);
            assert!(
                !refused.success && refused.message.contains(state) && refused.message.contains("activate"),
                "{}",
                refused.message
            );
            assert_eq!(sent(), commands, "a refused request reaches the solver");
        }
        assert!(control.answer_pause(true).success, "what stands still may be paused");
        control.manage(None).unwrap();
        assert!(control.answer_pause(true).success && control.answer_pause(false).success);
        assert_eq!(sent(), 6);
    }

    /// "Successful" means that it acts: what the ring has no room for is refused, and nowhere changed.
    #[test]
    fn what_cannot_be_passed_on_is_refused_and_changes_nothing() {
        let mut bench = bench();
        let key = "contact.inner.friction_axial";
        let friction = |number: u32| 0.2 + 1e-4 * f64::from(number);
        let mut accepted = 0;
        let refusal = loop {
            match set(&mut bench, key, friction(accepted + 1)) {
                Ok(_) => accepted += 1,
                Err(refusal) => break refusal.to_string(),
            }
        };
        // One command per set.
        assert!(accepted >= 120, "{accepted}");
        assert!(
            refusal.contains("cannot be passed on") && refusal.contains("nothing was changed"),
            "{refusal}"
        );
        assert_eq!(bench.store.number(key), Some(friction(accepted)));
        assert_eq!(bench.control.config().contact.inner.friction_axial, friction(accepted));
        let told: Vec<Change> = bench.changes.try_iter().collect();
        assert_eq!(told.len(), accepted as usize);
        for (number, change) in (1..).zip(&told) {
            assert_eq!(change.command, number);
            let expected = ParameterChange {
                name: key.to_owned(),
                value: friction(number as u32),
                asked_by: "a test".to_owned(),
            };
            assert_eq!(change.values, [expected]);
        }
    }

    /// One call must not blank the twin or its recording, nor bring a silent rig to speed.
    #[test]
    fn no_parameter_takes_an_output_out_of_the_recording() {
        use flexdrill_core::twin::Output;
        let mut bench = bench();
        for key in ["outputs.rates.status", "outputs.rates.diagnostics"] {
            let refusal = set(&mut bench, key, 0.0).unwrap_err().to_string();
            assert!(refusal.contains("must be 1 to 1000 Hz"), "{refusal}");
        }
        for (key, value) in [
            ("inputs.rotary_speed.safe_rpm", 120.0),
            ("inputs.weight_on_bit.safe_kn", 60.0),
        ] {
            let refusal = set(&mut bench, key, value).unwrap_err().to_string();
            assert!(refusal.contains("must be at most 0"), "{refusal}");
        }
        for (key, output, rate) in [
            ("outputs.rates.contact_forces", Output::ContactForces, 50.0),
            ("outputs.rates.whirl", Output::Whirl, 10.0),
        ] {
            // Switched off and slowed down it is made as before; a higher rate is followed.
            for (live, made) in [(0.0, rate), (1.0, rate), (100.0, 100.0)] {
                set(&mut bench, key, live).unwrap();
                let sent = settings(&bench.control.config(), &bench.control.begun);
                assert_eq!(sent.schedule.rate(output, 0.5e-3), made, "{key} = {live} Hz");
            }
        }
    }

    #[test]
    fn hard_limits_hold_for_whoever_asks() {
        let mut bench = bench();
        let key = "inputs.rotary_speed.max_rpm";
        let refusal = set(&mut bench, key, 1000.0).unwrap_err().to_string();
        assert!(refusal.contains("inputs.hard_limits.max_rpm"), "{refusal}");
        // In steps, too.
        set(&mut bench, key, 300.0).unwrap();
        let refusal = set(&mut bench, key, 300.5).unwrap_err().to_string();
        assert!(refusal.contains("at most 300 r/min"), "{refusal}");
        assert_eq!(bench.store.number(key), Some(300.0));
        assert_eq!(bench.store.describe(key).floating_point_range[0].to_value, 300.0);
        assert_eq!(bench.changes.try_iter().count(), 1);
    }
}
