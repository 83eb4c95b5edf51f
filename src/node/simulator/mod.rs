//! The services of `simulation_interfaces`, ROS 2's standard for simulators, and its action: a harness that drives other
//! simulators drives the twin by the same requests.
//!
//! They use the paths of the node's own services ([`Control`]). Each answers once the request has taken effect.
//!
//! | state of the standard | the twin |
//! |---|---|
//! | LOADING_WORLD | the model is being built, or waits for the first `/clock` |
//! | STOPPED | at its start and paused, as requested by that state |
//! | PLAYING | model time runs; or a step failed, and the model waits for other inputs |
//! | PAUSED | model time stands still |

mod steps;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::NodeError;
use super::clocks::Clocks;
use super::control::{Control, ControlError};
use super::lifecycle::Lifecycle;
use flexdrill_messages::simulation_interfaces::{
    GetSimulationStateRequest, GetSimulationStateResponse, GetSimulatorFeaturesRequest, GetSimulatorFeaturesResponse,
    ResetSimulationRequest, ResetSimulationResponse, Result as Outcome, SetSimulationStateRequest,
    SetSimulationStateResponse, SimulationState, SimulatorFeatures, StepSimulationRequest, StepSimulationResponse,
};
use flexdrill_realtime::link::{Gauges, RunState};
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::PortBuilder;
use flexdrill_ros2::service::{ServiceMapping, ServiceServer, Task, asked_by, at_once, shared};
use flexdrill_text::log_ending;

pub use steps::serve as serve_steps;

/// What the services work with.
pub struct Simulator {
    control: Arc<Control>,
    gauges: Arc<Gauges>,
    /// `/clock` paces the model.
    follows_clock: bool,
    /// The states of a managed node.
    lifecycle: Option<Arc<Lifecycle>>,
    /// s.
    time_step: f64,
    /// STATE_STOPPED was requested last.
    stopped: AtomicBool,
    /// One request at a time orders steps.
    stepping: tokio::sync::Mutex<()>,
    /// The node ends: no more steps are taken.
    ending: AtomicBool,
}

/// A result with a text for its reader.
fn outcome(result: u8, error_message: impl Into<String>) -> Outcome {
    Outcome {
        result,
        error_message: error_message.into(),
    }
}

fn ok() -> Outcome {
    outcome(Outcome::RESULT_OK, "")
}

fn name(state: u8) -> &'static str {
    match state {
        SimulationState::STATE_STOPPED => "stopped",
        SimulationState::STATE_PLAYING => "playing",
        SimulationState::STATE_PAUSED => "paused",
        SimulationState::STATE_LOADING_WORLD => "still being built or without /clock",
        _ => "in another state",
    }
}

impl Simulator {
    /// The services of a node with this control. `lifecycle` has the states of a managed node.
    pub fn new(
        control: &Arc<Control>,
        gauges: &Arc<Gauges>,
        clocks: &Clocks,
        lifecycle: Option<Arc<Lifecycle>>,
    ) -> Arc<Self> {
        Arc::new(Self {
            control: Arc::clone(control),
            gauges: Arc::clone(gauges),
            follows_clock: clocks.are_simulated(),
            lifecycle,
            time_step: control.first_config().solver.time_step,
            stopped: AtomicBool::new(false),
            stepping: tokio::sync::Mutex::default(),
            ending: AtomicBool::new(false),
        })
    }

    /// Ends the order of steps that is being carried out, as the node ends.
    pub fn end(&self) {
        self.ending.store(true, Ordering::Relaxed);
    }

    /// Why model time cannot be stepped here at all.
    fn cannot_step(&self) -> Option<&'static str> {
        if self.follows_clock {
            Some("/clock paces this twin (use_sim_time): step the program that publishes it")
        } else if self.lifecycle.is_some() {
            Some("the node is managed: model time runs in the state active only, and is never paused there")
        } else {
            None
        }
    }

    /// What the twin offers. Nothing that a request could be refused for in every state is in the list.
    fn features(&self) -> SimulatorFeatures {
        let mut features = vec![
            SimulatorFeatures::SIMULATION_RESET,
            SimulatorFeatures::SIMULATION_RESET_STATE,
            SimulatorFeatures::SIMULATION_STATE_GETTING,
            SimulatorFeatures::SIMULATION_STATE_SETTING,
        ];
        if self.lifecycle.is_none() {
            features.push(SimulatorFeatures::SIMULATION_STATE_PAUSE);
        }
        let steps = if let Some(why) = self.cannot_step() {
            format!("no steps, because {why}")
        } else {
            features.extend([
                SimulatorFeatures::STEP_SIMULATION_SINGLE,
                SimulatorFeatures::STEP_SIMULATION_MULTIPLE,
                SimulatorFeatures::STEP_SIMULATION_ACTION,
            ]);
            format!("one step is {} s of model time", self.time_step)
        };
        SimulatorFeatures {
            features: features.into_iter().map(u16::from).collect(),
            spawn_formats: Vec::new(),
            custom_info: format!(
                "flexdrill {}: the tool and the well are those of the configuration, so that nothing can be spawned or \
                 loaded; {steps}; a reset restores model state and step count, while stamps stay on the rig's clock.",
                env!("CARGO_PKG_VERSION")
            ),
        }
    }

    fn state(&self) -> u8 {
        match self.gauges.run_state() {
            RunState::Starting => SimulationState::STATE_LOADING_WORLD,
            RunState::Paused
                if self.stopped.load(Ordering::Relaxed) && self.gauges.step.load(Ordering::Relaxed) == 0 =>
            {
                SimulationState::STATE_STOPPED
            }
            RunState::Paused => SimulationState::STATE_PAUSED,
            RunState::Running | RunState::Failed => SimulationState::STATE_PLAYING,
        }
    }

    fn get_state(&self) -> GetSimulationStateResponse {
        let text = match self.gauges.run_state() {
            RunState::Failed => "a step failed: the model stands still until the inputs change or it is reset",
            RunState::Starting if self.follows_clock => "the model is being built, or waits for /clock",
            _ => "",
        };
        GetSimulationStateResponse {
            state: SimulationState { state: self.state() },
            result: outcome(Outcome::RESULT_OK, text),
        }
    }

    async fn set_state(&self, target: u8) -> Outcome {
        let now = self.state();
        match target {
            SimulationState::STATE_QUITTING => return self.quit(),
            SimulationState::STATE_STOPPED | SimulationState::STATE_PLAYING | SimulationState::STATE_PAUSED => {}
            _ => {
                let text = format!("{target} is no state that this twin can be set to: use STOPPED, PLAYING or PAUSED");
                return outcome(Outcome::RESULT_FEATURE_UNSUPPORTED, text);
            }
        }
        // The solver would carry the command out after the build, long after this answer.
        if now == SimulationState::STATE_LOADING_WORLD {
            return outcome(
                SetSimulationStateResponse::INCORRECT_TRANSITION,
                format!("the twin is {}", name(now)),
            );
        }
        if now == target {
            return outcome(
                SetSimulationStateResponse::ALREADY_IN_TARGET_STATE,
                format!("the twin is {} already", name(now)),
            );
        }
        match self.change(now, target).await {
            Ok(()) => ok(),
            Err(why) => outcome(SetSimulationStateResponse::STATE_TRANSITION_ERROR, why.to_string()),
        }
    }

    async fn change(&self, now: u8, target: u8) -> Result<(), ControlError> {
        let command = match target {
            SimulationState::STATE_PLAYING => Some(self.control.pause(false)?),
            // A stopped model stands still already.
            SimulationState::STATE_PAUSED if now == SimulationState::STATE_STOPPED => None,
            SimulationState::STATE_PAUSED => Some(self.control.pause(true)?),
            _ => {
                self.control.pause(true)?;
                Some(self.control.reset()?)
            }
        };
        if let Some(command) = command {
            self.control.carried_out(command).await?;
        }
        self.stopped
            .store(target == SimulationState::STATE_STOPPED, Ordering::Relaxed);
        Ok(())
    }

    /// Ends a managed node. Every program on the network can call this service: a rig's twin that no supervisor manages
    /// ends by a signal only.
    fn quit(&self) -> Outcome {
        let Some(lifecycle) = &self.lifecycle else {
            return outcome(
                Outcome::RESULT_FEATURE_UNSUPPORTED,
                "this twin ends by a signal only, because every program on the network can call this service; start it \
                 with --lifecycle to end it by a service",
            );
        };
        if lifecycle.shut_down() {
            ok()
        } else {
            outcome(
                SetSimulationStateResponse::ALREADY_IN_TARGET_STATE,
                "the node is ending",
            )
        }
    }

    async fn reset(&self, scope: u8) -> Outcome {
        let whole = [
            ResetSimulationRequest::SCOPE_DEFAULT,
            ResetSimulationRequest::SCOPE_ALL,
            ResetSimulationRequest::SCOPE_STATE,
        ];
        if !whole.contains(&scope) {
            return outcome(
                Outcome::RESULT_FEATURE_UNSUPPORTED,
                format!(
                    "scope {scope} is not supported: use SCOPE_ALL or SCOPE_STATE; stamps stay on the rig's clock, and \
                     nothing is spawned"
                ),
            );
        }
        if self.gauges.run_state() == RunState::Starting {
            return outcome(Outcome::RESULT_INCORRECT_STATE, ControlError::Starting.to_string());
        }
        let done = match self.control.reset() {
            Ok(command) => self.control.carried_out(command).await,
            Err(why) => Err(why),
        };
        match done {
            Ok(()) => ok(),
            Err(why) => outcome(Outcome::RESULT_OPERATION_FAILED, why.to_string()),
        }
    }
}

/// Creates the services; `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is not allowed.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    simulator: &Arc<Simulator>,
    name: impl Fn(&str) -> Result<String, ArgsError>,
) -> Result<Vec<Task>, NodeError> {
    let mut server = |private: &str, kind: &str| -> Result<ServiceServer, NodeError> {
        let kind = format!("simulation_interfaces/srv/{kind}");
        Ok(ServiceServer::new(port, &name(private)?, &kind, mapping))
    };
    let (features, state) = (Arc::clone(simulator), Arc::clone(simulator));
    // Each service answers its requests one after another. A change of state is therefore never overtaken by the next one,
    // while the states can be read meanwhile.
    Ok(vec![
        Box::pin(
            server("~/get_simulator_features", "GetSimulatorFeatures")?.serve(at_once(
                move |_: GetSimulatorFeaturesRequest| GetSimulatorFeaturesResponse {
                    features: features.features(),
                },
            )),
        ),
        Box::pin(
            server("~/get_simulation_state", "GetSimulationState")?
                .serve(at_once(move |_: GetSimulationStateRequest| state.get_state())),
        ),
        Box::pin(server("~/set_simulation_state", "SetSimulationState")?.serve(shared(
            Arc::clone(simulator),
            |simulator, request: SetSimulationStateRequest| async move {
                SetSimulationStateResponse {
                    result: refusals_logged("the state", simulator.set_state(request.state.state).await),
                }
            },
        ))),
        Box::pin(server("~/reset_simulation", "ResetSimulation")?.serve(shared(
            Arc::clone(simulator),
            |simulator, request: ResetSimulationRequest| async move {
                ResetSimulationResponse {
                    result: refusals_logged("a reset", simulator.reset(request.scope).await),
                }
            },
        ))),
        Box::pin(server("~/step_simulation", "StepSimulation")?.serve(shared(
            Arc::clone(simulator),
            |simulator, request: StepSimulationRequest| async move {
                let stepped = simulator.step(request.steps, &AtomicBool::new(false), |_| ()).await;
                StepSimulationResponse {
                    result: refusals_logged("steps", stepped),
                }
            },
        ))),
    ])
}

/// Logs why a request was not carried out: the reply is all that a harness sees, and harnesses often drop it.
fn refusals_logged(what: &str, result: Outcome) -> Outcome {
    let refused = ![Outcome::RESULT_OK, SetSimulationStateResponse::ALREADY_IN_TARGET_STATE].contains(&result.result);
    if refused && let Some(more) = log_ending(format!("{what} as a simulator refused")) {
        tracing::warn!(
            "simulation_interfaces: {what}: {}{}{more}",
            result.error_message,
            asked_by()
        );
    }
    result
}
