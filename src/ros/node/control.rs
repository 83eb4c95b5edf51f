//! What others may ask of the node: parameters, reset, pause, checkpoint.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Sender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use ros2_client::{Parameter, ParameterValue};

use super::rig::RigInputs;
use crate::dds::port::PortBuilder;
use crate::messages::outputs::{self, ParameterChange};
use crate::messages::std_srvs::{SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse};
use crate::ros::NodeError;
use crate::ros::parameters::{ParameterStore, Task, reconfigured, refresh_ranges};
use crate::ros::service::{ServiceMapping, ServiceServer, at_once, shared};
use flexdrill_config::{Config, ConfigError};
use flexdrill_core::twin::CheckpointError;
use flexdrill_realtime::link::{Command, Gauges, RunState};

/// Longest wait for the solver to hand out its state.
const CHECKPOINT_WAIT: Duration = Duration::from_secs(10);

/// Parameters that changed with the command of this number.
#[derive(Debug)]
pub struct Change {
    /// Acts when the solver has carried out so many commands.
    pub command: u64,
    /// Names and values.
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
    /// The solver is in a step that takes too long.
    #[error("the solver did not answer in time")]
    NoAnswer,
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
            commands: Mutex::new(Commands { sender, sent: 0 }),
            config: Mutex::new(config),
            changes,
            rig_inputs,
            gauges,
        })
    }

    fn config(&self) -> Arc<Config> {
        Arc::clone(&self.config.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Sends commands that belong together. Gives the number of the last one.
    fn send(&self, list: impl IntoIterator<Item = Command>) -> Result<u64, ControlError> {
        let mut commands = self.commands.lock().unwrap_or_else(PoisonError::into_inner);
        for command in list {
            commands.sender.push(command).map_err(|_| ControlError::Busy)?;
            commands.sent += 1;
        }
        Ok(commands.sent)
    }

    /// Whether parameters may take these values together.
    ///
    /// # Errors
    /// When the configuration does not make sense with them.
    pub fn check(&self, candidate: &ParameterStore) -> Result<(), ConfigError> {
        reconfigured(&self.config(), &candidate.all()).map(drop)
    }

    /// Lets accepted values act.
    pub fn apply(&self, store: &mut ParameterStore, changed: &[Parameter]) {
        let Ok(config) = reconfigured(&self.config(), changed) else {
            return;
        };
        let config = Arc::new(config);
        *self.config.lock().unwrap_or_else(PoisonError::into_inner) = Arc::clone(&config);
        refresh_ranges(store, &config);
        self.rig_inputs
            .conditioner
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .set_rules(config.inputs.rules());
        let simulation = config.simulation();
        let sent = self.send([
            Command::Live(config.live()),
            Command::Slew([simulation.rotary_speed_slew, simulation.weight_on_bit_slew]),
            Command::Whirl(config.whirl_settings()),
            Command::Schedule(outputs::schedule(&config)),
        ]);
        match sent {
            Ok(command) => {
                let values = changed
                    .iter()
                    .filter_map(|parameter| Some((parameter.name.clone(), number(&parameter.value)?)))
                    .collect();
                // The publisher has ended: so will the node.
                let _ = self.changes.send(Change {
                    command,
                    values,
                    config,
                });
            }
            Err(why) => tracing::error!("parameters were accepted but could not be passed on: {why}"),
        }
    }

    fn reset(&self) -> TriggerResponse {
        tracing::info!("reset: the model goes back to its state after the start");
        answer(
            self.send([Command::Reset])
                .map(|_| "the model goes back to its state after the start".to_owned()),
        )
    }

    fn pause(&self, pause: bool) -> SetBoolResponse {
        tracing::info!("{}", if pause { "paused" } else { "resumed" });
        let sent = self
            .send([Command::Pause(pause)])
            .map(|_| if pause { "paused" } else { "running" }.to_owned());
        let TriggerResponse { success, message } = answer(sent);
        SetBoolResponse { success, message }
    }

    async fn save_checkpoint(self: Arc<Self>) -> TriggerResponse {
        if self.gauges.run_state() == RunState::Starting {
            return answer(Err(ControlError::Starting));
        }
        let saved = tokio::task::spawn_blocking(move || {
            let (sender, receiver) = sync_channel(1);
            self.send([Command::Checkpoint(sender)])?;
            let bytes = receiver
                .recv_timeout(CHECKPOINT_WAIT)
                .map_err(|_| ControlError::NoAnswer)??;
            let step = self.gauges.step.load(Ordering::Relaxed);
            let path = PathBuf::from(format!(
                "flexdrill_{}_step{step}.checkpoint",
                &self.config().hash()[..12]
            ));
            if let Err(source) = std::fs::write(&path, &bytes) {
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
        Box::pin(server("~/reset", "Trigger")?.serve(at_once(move |_: TriggerRequest| reset.reset()))),
        Box::pin(
            server("~/pause", "SetBool")?.serve(at_once(move |request: SetBoolRequest| pause.pause(request.data))),
        ),
        Box::pin(
            server("~/save_checkpoint", "Trigger")?.serve(shared(Arc::clone(control), |control, _: TriggerRequest| {
                control.save_checkpoint()
            })),
        ),
    ])
}
