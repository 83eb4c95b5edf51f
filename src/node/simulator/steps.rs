//! Steps of a paused twin: the service `~/step_simulation` and the action `~/simulate_steps` order them, and wait until the
//! solver has taken them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::{Simulator, name, outcome};
use crate::node::NodeError;
use crate::node::clocks::Clocks;
use crate::node::control::ControlError;
use flexdrill_messages::action_msgs::{CancelGoalRequest, GoalStatus};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::simulation_interfaces::{
    Result as Outcome, SimulateStepsFeedback, SimulateStepsFeedbackMessage, SimulateStepsGetResultRequest,
    SimulateStepsGetResultResponse, SimulateStepsGoal, SimulateStepsResult, SimulateStepsSendGoalRequest,
    SimulateStepsSendGoalResponse, SimulationState,
};
use flexdrill_messages::unique_identifier_msgs::UUID;
use flexdrill_realtime::link::{OrderEnd, StepOrder};
use flexdrill_ros2::action::{Accepted, ActionEnds, Begun};
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_ros2::goal_book::{GoalBook, publish};
use flexdrill_ros2::service::{ServiceMapping, Task, asked_by, at_once};
use flexdrill_text::log_ending;

/// Between two looks at the steps that are left; the solver takes some every few milliseconds.
const LOOK: Duration = Duration::from_millis(1);
/// Least time between two feedbacks: one per step would be thousands a second.
const FEEDBACK_INTERVAL: Duration = Duration::from_millis(50);
/// Clients that may wait for results at the same time.
const MOST_CLIENTS: usize = 32;

impl Simulator {
    /// Takes so many steps of a paused model and waits for their end, or until `stop` is set. `progress` is called with the
    /// steps that were taken so far, again and again.
    pub(super) async fn step(&self, steps: u64, stop: &AtomicBool, progress: impl FnMut(u64)) -> Outcome {
        if let Some(why) = self.cannot_step() {
            return outcome(Outcome::RESULT_FEATURE_UNSUPPORTED, why);
        }
        let failed = |why: String| outcome(Outcome::RESULT_OPERATION_FAILED, why);
        if steps == 0 {
            return failed("steps is 0: ask for 1 or more".to_owned());
        }
        let Ok(_alone) = self.stepping.try_lock() else {
            return failed("another request is stepping the model".to_owned());
        };
        let state = self.state();
        if state != SimulationState::STATE_PAUSED {
            return failed(format!("the twin is {}: set STATE_PAUSED first", name(state)));
        }
        let order = match self.ordered(steps, stop, progress).await {
            Ok(order) => order,
            Err(why) => return failed(why.to_string()),
        };
        let taken = steps.saturating_sub(order.left);
        match order.end {
            OrderEnd::Done => super::ok(),
            OrderEnd::Failed => failed(format!(
                "a step failed after {taken} of {steps} steps; the log has the cause, and the model stands still there"
            )),
            OrderEnd::Open | OrderEnd::Stopped => failed(format!(
                "ended after {taken} of {steps} steps: cancelled, or model time was resumed, paused or reset meanwhile"
            )),
        }
    }

    /// Orders steps and waits for the end of the order.
    async fn ordered(
        &self,
        steps: u64,
        stop: &AtomicBool,
        mut progress: impl FnMut(u64),
    ) -> Result<StepOrder, ControlError> {
        let command = self.control.step(steps)?;
        let mut stopped = false;
        loop {
            let order = self.gauges.order();
            if order.command >= command {
                progress(steps.saturating_sub(order.left));
                if order.end != OrderEnd::Open {
                    return Ok(order);
                }
            }
            let wanted = stop.load(Ordering::Relaxed) || self.ending.load(Ordering::Relaxed);
            // A full queue of commands is tried again.
            stopped = stopped || wanted && self.control.stop_steps().is_ok();
            tokio::time::sleep(LOOK).await;
        }
    }
}

/// The action's server.
struct SimulateSteps {
    simulator: Arc<Simulator>,
    book: Arc<GoalBook<SimulateStepsGoal, SimulateStepsResult>>,
    feedback: TopicPublisher,
    clocks: Clocks,
}

impl SimulateSteps {
    fn accept(&self, request: SimulateStepsSendGoalRequest) -> SimulateStepsSendGoalResponse {
        let stamp = Time::from_nanoseconds(self.clocks.rig_time());
        let taken = self.book.accept(request.goal_id.uuid, stamp.clone(), request.goal);
        let accepted = matches!(taken, Accepted::Waits(_));
        if !accepted && let Some(more) = log_ending("steps not accepted") {
            let why = if taken == Accepted::Known {
                "its identifier is in use"
            } else {
                "another goal is stepping the model; cancel it or wait for its end"
            };
            tracing::warn!("simulate_steps: a goal is not accepted: {why}{}{more}", asked_by());
        }
        SimulateStepsSendGoalResponse { accepted, stamp }
    }

    /// Carries out goals, one after another.
    async fn run(self: Arc<Self>) {
        while let Some(begun) = self.book.next().await {
            self.book.change(|_| ());
            let result = self.carry_out(&begun).await;
            let status = if result.result == Outcome::RESULT_OK {
                GoalStatus::STATUS_SUCCEEDED
            } else {
                GoalStatus::STATUS_ABORTED
            };
            let result = SimulateStepsResult {
                result: super::refusals_logged("steps", result),
            };
            self.book.change(|goals| goals.end(begun.id, status, result));
        }
    }

    async fn carry_out(&self, begun: &Begun<SimulateStepsGoal>) -> Outcome {
        let steps = begun.goal.steps;
        let (mut published, mut last) = (Instant::now(), 0);
        let progress = |completed: u64| {
            let is_due = completed == steps || published.elapsed() >= FEEDBACK_INTERVAL;
            if completed == last || !is_due {
                return;
            }
            (published, last) = (Instant::now(), completed);
            let message = SimulateStepsFeedbackMessage {
                goal_id: UUID { uuid: begun.id },
                feedback: SimulateStepsFeedback {
                    completed_steps: completed,
                    remaining_steps: steps - completed,
                },
            };
            publish(&self.feedback, &message);
        };
        self.simulator.step(steps, &begun.stop, progress).await
    }

    async fn result(self: Arc<Self>, request: SimulateStepsGetResultRequest) -> SimulateStepsGetResultResponse {
        let (status, result) = self.book.ended(request.goal_id.uuid).await.unwrap_or_default();
        SimulateStepsGetResultResponse {
            status,
            result: result.unwrap_or_else(|| SimulateStepsResult {
                result: outcome(
                    Outcome::RESULT_NOT_FOUND,
                    "no such goal, or it was not accepted; results are kept for 15 min",
                ),
            }),
        }
    }
}

/// The result of a goal that was cancelled before it began.
fn unbegun() -> SimulateStepsResult {
    SimulateStepsResult {
        result: outcome(Outcome::RESULT_OPERATION_FAILED, "cancelled before it began"),
    }
}

/// Creates the endpoints of `~/simulate_steps`; `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is not allowed.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    clocks: &Clocks,
    simulator: &Arc<Simulator>,
    name: impl Fn(&str) -> Result<String, ArgsError>,
) -> Result<Vec<Task>, NodeError> {
    let kind = "simulation_interfaces/action/SimulateSteps";
    let ends = ActionEnds::new(port, &name("~/simulate_steps")?, kind, mapping);
    let server = Arc::new(SimulateSteps {
        simulator: Arc::clone(simulator),
        // A goal that waited would step a model that its client expects elsewhere.
        book: GoalBook::new(0, ends.status),
        feedback: ends.feedback,
        clocks: clocks.clone(),
    });
    let (accepting, cancelling, asking) = (Arc::clone(&server), Arc::clone(&server), Arc::clone(&server));
    Ok(vec![
        Box::pin(Arc::clone(&server.book).shows_life()),
        Box::pin(server.run()),
        Box::pin(
            ends.send_goal
                .serve(at_once(move |request: SimulateStepsSendGoalRequest| {
                    accepting.accept(request)
                })),
        ),
        Box::pin(ends.cancel_goal.serve(at_once(move |request: CancelGoalRequest| {
            cancelling.book.cancel(&request, unbegun)
        }))),
        Box::pin(
            ends.get_result
                .serve_each(MOST_CLIENTS, move |request| Arc::clone(&asking).result(request)),
        ),
    ])
}
