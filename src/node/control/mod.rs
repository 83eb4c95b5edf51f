//! Requests of clients that change the run: parameters, reset, pause, checkpoint.

mod services;

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use super::inputs::RigInputs;
use super::parameters::{reconfigured, refresh_ranges};
use super::states::{SavedRun, States};
use crate::drilling::live::SharedPoints;
use flexdrill_config::{Config, HardBounds, Rates};
use flexdrill_core::twin::CheckpointError;
use flexdrill_outputs::ParameterChange;
use flexdrill_realtime::link::{Command, Gauges, RequestEnd, RunState, Settings};
use flexdrill_ros2::parameters::{Parameter, ParameterStore, ParameterValue, Refusal};
use flexdrill_ros2::service::asked_by;
use flexdrill_text::log_ending;
pub use services::serve;

/// Least time between two checkpoints: each one delays the solver for a moment.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(1);
/// Longest wait for a command to be carried out: a step that is split to its limit takes this long on a slow machine.
const CARRIED_OUT_WITHIN: Duration = Duration::from_secs(2);
/// Between two looks at what the solver has done; it carries out commands every few milliseconds.
const LOOK: Duration = Duration::from_millis(1);

/// Parameters that changed together, on their way to the publisher.
#[derive(Debug)]
pub struct ParameterUpdate {
    /// Number of the command with which they act: the solver counts the commands that it has carried out.
    pub command: u64,
    /// Names, values and requesters.
    pub values: Vec<ParameterChange>,
    /// The configuration with these values.
    pub config: Arc<Config>,
}

struct Commands {
    sender: rtrb::Producer<Command>,
    sent: u64,
}

/// Who decides whether model time runs.
#[derive(Debug, Clone, Copy, Default)]
enum Managed {
    /// The node is not managed: `~/pause` decides.
    #[default]
    No,
    /// The node is managed and in this state, in which model time stands still.
    Inactive(&'static str),
    /// The node is managed and active.
    Active,
}

/// Why a service could not carry out a request.
#[derive(Debug, thiserror::Error)]
pub enum ControlError {
    /// The ring of commands is full.
    #[error("the solver's queue of commands is full; a step may be taking very long")]
    Busy,
    /// The model has no state yet.
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
    /// A managed node that is active computes.
    #[error(
        "the node is managed and active, and would say so while its model stands still; deactivate it instead \
         (ros2 lifecycle set)"
    )]
    Active,
    /// The solver is in a step that takes too long.
    #[error("the solver did not answer in time")]
    NoAnswer,
    /// Another checkpoint was requested a moment ago.
    #[error("the last checkpoint was requested {0:.1} s ago; wait {seconds} s between checkpoints", seconds = CHECKPOINT_INTERVAL.as_secs())]
    TooOften(f64),
    /// The state could not be encoded.
    #[error(transparent)]
    State(#[from] CheckpointError),
    /// The file could not be written.
    #[error("{}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// The parameters that follow the rig could not be set back.
    #[error("the model was not reset, because the parameters that follow the rig could not be set back: {0}")]
    NotRestored(#[from] Refusal),
    /// The task that wrote the file was ended.
    #[error(transparent)]
    Ended(#[from] tokio::task::JoinError),
}

/// Sets what follows the rig back to its configured values.
pub type Restore = dyn Fn() -> Result<(), Refusal> + Send + Sync;

/// Sends commands to the solver.
pub struct Control {
    commands: Mutex<Commands>,
    states: Mutex<States>,
    config: Mutex<Arc<Config>>,
    updates: Sender<ParameterUpdate>,
    rig_inputs: RigInputs,
    gauges: Arc<Gauges>,
    hard_bounds: HardBounds,
    /// The configuration at the start: the tool was built by it.
    first_config: Arc<Config>,
    /// Publishing rates at the start. Recordings keep them.
    initial_rates: Rates,
    /// When the last checkpoint was requested.
    checkpoint: Mutex<Option<Instant>>,
    /// The hole as drilled, which a checkpoint has too.
    drilled: Arc<SharedPoints>,
    /// What the states of a managed node ask for.
    managed: Mutex<Managed>,
    /// Acts before a reset.
    restore: OnceLock<Box<Restore>>,
}

/// The part of a configuration that may change while the solver runs.
fn settings(config: &Config, initial_rates: &Rates) -> Settings {
    let simulation = config.simulation();
    Settings {
        live: config.live(),
        slew: simulation.slew(),
        whirl: config.whirl_settings(),
        schedule: flexdrill_outputs::schedule(config, initial_rates),
    }
}

impl Control {
    /// The control of a solver; `updates` go to the publisher.
    pub fn new(
        requests: RequestEnd,
        config: Arc<Config>,
        updates: Sender<ParameterUpdate>,
        rig_inputs: RigInputs,
        gauges: Arc<Gauges>,
    ) -> Arc<Self> {
        Arc::new(Self {
            hard_bounds: HardBounds::of(&config),
            initial_rates: config.outputs.rates,
            commands: Mutex::new(Commands {
                sender: requests.commands,
                sent: 0,
            }),
            states: Mutex::new(States::new(requests.states)),
            first_config: Arc::clone(&config),
            config: Mutex::new(config),
            updates,
            rig_inputs,
            gauges,
            checkpoint: Mutex::default(),
            drilled: Arc::default(),
            managed: Mutex::default(),
            restore: OnceLock::new(),
        })
    }

    /// The configuration in force.
    pub fn config(&self) -> Arc<Config> {
        Arc::clone(&self.config.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The hole as drilled, which the publisher keeps up to date.
    pub fn drilled(&self) -> &Arc<SharedPoints> {
        &self.drilled
    }

    /// The configuration at the start, by which the tool was built.
    pub fn first_config(&self) -> &Arc<Config> {
        &self.first_config
    }

    /// Sends a command and returns its number.
    fn send(&self, command: Command) -> Result<u64, ControlError> {
        self.send_with(command, |_| ())
    }

    /// Sends a command. `before` is called with its number before the solver can carry it out, and only if the queue has
    /// room.
    fn send_with(&self, command: Command, before: impl FnOnce(u64)) -> Result<u64, ControlError> {
        let mut commands = self.commands.lock().unwrap_or_else(PoisonError::into_inner);
        // The lock makes this the only sender, so that the room cannot be lost before the push.
        if commands.sender.is_full() {
            return Err(ControlError::Busy);
        }
        let number = commands.sent + 1;
        before(number);
        commands.sender.push(command).map_err(|_| ControlError::Busy)?;
        commands.sent = number;
        Ok(number)
    }

    /// Applies changed parameters together, as one command, or refuses them and changes nothing. `candidate` is the store
    /// with the new values; the recording names the `requester`.
    ///
    /// # Errors
    /// When the configuration is not valid with the values, a value exceeds a hard limit, or the solver's queue is full.
    pub fn apply(&self, candidate: &mut ParameterStore, changed: &[Parameter], requester: &str) -> Result<(), Refusal> {
        let config = reconfigured(&self.config(), changed).map_err(|why| Refusal::Invalid(why.into()))?;
        self.hard_bounds
            .check(&config)
            .map_err(|why| Refusal::Invalid(why.into()))?;
        let config = Arc::new(config);
        let values = changed
            .iter()
            .filter_map(|parameter| {
                Some(ParameterChange {
                    name: parameter.name.clone(),
                    value: number(&parameter.value)?,
                    asked_by: requester.to_owned(),
                })
            })
            .collect();
        let publish = |command| {
            let config = Arc::clone(&config);
            // Sending fails only where the publisher has ended, and the node ends with it.
            let _ = self.updates.send(ParameterUpdate {
                command,
                values,
                config,
            });
        };
        self.send_with(Command::Settings(settings(&config, &self.initial_rates)), publish)
            .map_err(|why| Refusal::NotPassedOn { why: why.to_string() })?;
        *self.config.lock().unwrap_or_else(PoisonError::into_inner) = Arc::clone(&config);
        refresh_ranges(candidate, &config, &self.hard_bounds);
        self.rig_inputs.set_rules(&config.inputs);
        Ok(())
    }

    /// Calls `restore` before every reset. Only the first one counts.
    pub fn restore_with(&self, restore: Box<Restore>) {
        let _ = self.restore.set(restore);
    }

    /// Resets the model to its state after the start, with the configured values of what follows the rig. Returns the
    /// number of the command, as [`Control::pause`] does.
    ///
    /// # Errors
    /// When the solver's queue of commands is full.
    pub fn reset(&self) -> Result<u64, ControlError> {
        if let Some(restore) = self.restore.get() {
            restore()?;
        }
        let text = "reset: the model returns to its state after the start";
        match log_ending("reset") {
            Some(more) => tracing::info!("{text}{}{more}", asked_by()),
            None => tracing::debug!("{text}{}", asked_by()),
        }
        self.send(Command::Reset)
    }

    /// Pauses or resumes model time. Returns the number of the command, for [`Control::carried_out`].
    ///
    /// # Errors
    /// As [`Control::reset`]; [`ControlError::NotActive`] where a managed node that is not active is to resume, and
    /// [`ControlError::Active`] where one that is active is to pause: its state would say that it computes.
    pub fn pause(&self, pause: bool) -> Result<u64, ControlError> {
        // The lock is held until the command is sent, so that no transition comes in between.
        let managed = self.managed.lock().unwrap_or_else(PoisonError::into_inner);
        match (*managed, pause) {
            (Managed::Inactive(state), false) => return Err(ControlError::NotActive { state }),
            (Managed::Active, true) => return Err(ControlError::Active),
            _ => {}
        }
        let command = self.send(Command::Pause(pause))?;
        let done = if pause { "paused" } else { "resumed" };
        if let Some(more) = log_ending(done) {
            tracing::info!("{done}{}{more}", asked_by());
        }
        Ok(command)
    }

    /// Orders steps of a model that is paused. [`Gauges::order`] says how many are left of the command whose number this
    /// returns. A pause, a resumption and a reset end the order.
    ///
    /// # Errors
    /// As [`Control::pause`]; in a managed node, where model time runs in the state active only.
    pub fn step(&self, steps: u64) -> Result<u64, ControlError> {
        let managed = self.managed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Managed::Inactive(state) = *managed {
            return Err(ControlError::NotActive { state });
        }
        self.send(Command::Step(steps))
    }

    /// Ends the order of steps that is being carried out.
    ///
    /// # Errors
    /// When the solver's queue of commands is full.
    pub fn stop_steps(&self) -> Result<u64, ControlError> {
        self.send(Command::StopSteps)
    }

    /// Waits until a command has been carried out; 2 s at most.
    ///
    /// # Errors
    /// When the solver does not answer in time: a step takes very long, or `/clock` stands still.
    pub async fn carried_out(&self, command: u64) -> Result<(), ControlError> {
        let until = tokio::time::Instant::now() + CARRIED_OUT_WITHIN;
        while self.gauges.commands.load(Ordering::Acquire) < command {
            if tokio::time::Instant::now() >= until {
                return Err(ControlError::NoAnswer);
            }
            tokio::time::sleep(LOOK).await;
        }
        Ok(())
    }

    /// Resumes the model time of a managed node that becomes active, or stops it for a state other than active.
    ///
    /// # Errors
    /// As [`Control::reset`]; then nothing has changed.
    pub fn set_inactive(&self, inactive: Option<&'static str>) -> Result<(), ControlError> {
        let mut managed = self.managed.lock().unwrap_or_else(PoisonError::into_inner);
        self.send(Command::Pause(inactive.is_some()))?;
        *managed = inactive.map_or(Managed::Active, Managed::Inactive);
        Ok(())
    }

    /// Why model time stands still, in words; `None` while it runs.
    pub fn stands_still(&self) -> Option<String> {
        let managed = *self.managed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Managed::Inactive(state) = managed {
            return Some(format!("the node is managed and {state}, and model time stands still"));
        }
        let why = match self.gauges.run_state() {
            RunState::Running => return None,
            RunState::Starting => "the model is still being built",
            RunState::Paused => "the twin is paused",
            RunState::Failed => "a step of the twin failed, and it stands still",
        };
        Some(why.to_owned())
    }

    /// The whole state of the model. It blocks until the solver has answered, between two periods.
    ///
    /// # Errors
    /// Before the model is built, when the solver does not answer, or the state cannot be encoded.
    pub fn state(&self) -> Result<SavedRun, ControlError> {
        if self.gauges.run_state() == RunState::Starting {
            return Err(ControlError::Starting);
        }
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        states.get(|command| self.send(command))
    }
}

fn number(value: &ParameterValue) -> Option<f64> {
    match value {
        ParameterValue::Double(value) => Some(*value),
        ParameterValue::Integer(value) => Some(*value as f64),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
