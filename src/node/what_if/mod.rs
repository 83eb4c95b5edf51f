//! The action `~/what_if`: what the tool would do under other speeds and weights, from the present state of the live run.
//!
//! One goal runs at a time, on threads of low priority; up to [`MOST_WAITING`] wait. The search for advice and the forecast
//! run when no goal is open, and have turns next to goals ([`turns`]). ROS 2 has no words for a goal that is not accepted:
//! the reason is in the log, and in the answer to a client that asks for the result nevertheless.

mod answering;
mod hole;

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::NodeError;
use super::clocks::Clocks;
use super::control::Control;
use super::what_if_messages::goal;
use crate::ahead::Advisor;
use flexdrill_messages::action_msgs::CancelGoalRequest;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::{
    WhatIfGetResultRequest, WhatIfGetResultResponse, WhatIfGoal, WhatIfResult, WhatIfSendGoalRequest,
    WhatIfSendGoalResponse,
};
use flexdrill_ros2::action::{Accepted, ActionEnds, Begun, GoalId, Goals};
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_ros2::goal_book::GoalBook;
use flexdrill_ros2::service::{ServiceMapping, Task, asked_by, at_once};
use flexdrill_text::log_ending;

pub use answering::Answering;

/// Goals that may wait while one runs.
const MOST_WAITING: usize = 4;
/// Clients that may wait for results at the same time.
const MOST_CLIENTS: usize = 32;
/// Longest wait for a goal before advice is looked for.
const IDLE: Duration = Duration::from_millis(200);
/// Reasons of refused goals that are kept for clients that ask for them.
const KEPT_REFUSALS: usize = 32;

/// What the thread that looks ahead does next.
enum Next {
    Goal(Begun<WhatIfGoal>),
    Nothing,
    /// The node ends, and no goal waits.
    End,
}

/// The goals, and who waits for them.
pub struct WhatIf {
    book: Arc<GoalBook<WhatIfGoal, WhatIfResult>>,
    ending: Mutex<bool>,
    /// Why the latest refused goals were refused.
    refused: Mutex<VecDeque<(GoalId, String)>>,
    feedback: TopicPublisher,
    clocks: Clocks,
    control: Arc<Control>,
    advisor: Arc<Advisor>,
}

impl WhatIf {
    /// Changes the goals and notifies all who wait for a change.
    fn change<T>(&self, change: impl FnOnce(&mut Goals<WhatIfGoal, WhatIfResult>) -> T) -> T {
        self.book.change(change)
    }

    fn accept(&self, request: WhatIfSendGoalRequest) -> WhatIfSendGoalResponse {
        let stamp = Time::from_nanoseconds(self.clocks.rig_time());
        let id = request.goal_id.uuid;
        let refusal = match self.take(id, stamp.clone(), request.goal) {
            Ok(before) => {
                if let Some(more) = log_ending("goal accepted") {
                    tracing::info!("what if: a goal is accepted, {before} before it{}{more}", asked_by());
                }
                None
            }
            Err(why) => {
                if let Some(more) = log_ending("goal refused") {
                    tracing::warn!("what if: a goal is refused: {why}{}{more}", asked_by());
                }
                Some(why)
            }
        };
        let accepted = refusal.is_none();
        if let Some(why) = refusal {
            let mut refused = self.refused.lock().unwrap_or_else(PoisonError::into_inner);
            refused.truncate(KEPT_REFUSALS - 1);
            refused.push_front((id, why));
        }
        WhatIfSendGoalResponse { accepted, stamp }
    }

    /// Takes a goal; the number of those before it, or why it is refused.
    fn take(&self, id: GoalId, stamp: Time, asked: WhatIfGoal) -> Result<usize, String> {
        goal(&asked)
            .check(&self.control.config())
            .map_err(|error| error.to_string())?;
        match self.book.accept(id, stamp, asked) {
            Accepted::Waits(before) => {
                // A question of a person comes before the search for advice, unless that has its turn.
                self.advisor.yield_to_goal();
                Ok(before)
            }
            Accepted::Full => Err(format!(
                "one runs and {MOST_WAITING} wait; cancel one or try again later"
            )),
            Accepted::Known => Err("its identifier is in use".to_owned()),
        }
    }

    /// What a client hears that asks for the result of a goal that is not known.
    fn no_such(&self, id: GoalId) -> WhatIfResult {
        let refused = self.refused.lock().unwrap_or_else(PoisonError::into_inner);
        let why = refused.iter().find(|(refused, _)| *refused == id);
        let message = why.map_or_else(
            || "no such goal; results are kept for 15 min".to_owned(),
            |(_, why)| format!("the goal was not accepted: {why}"),
        );
        WhatIfResult {
            message,
            ..WhatIfResult::default()
        }
    }

    async fn result(self: Arc<Self>, id: GoalId) -> WhatIfGetResultResponse {
        match self.book.ended(id).await {
            None => WhatIfGetResultResponse::default(),
            Some((status, result)) => WhatIfGetResultResponse {
                status,
                result: result.unwrap_or_else(|| self.no_such(id)),
            },
        }
    }

    /// Stops what runs and what waits, as the node ends.
    pub fn end(&self) {
        *self.ending.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.advisor.interrupt();
        self.change(|goals| goals.cancel_all(unbegun));
    }

    fn is_ending(&self) -> bool {
        *self.ending.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a goal waits or the node ends.
    fn is_wanted(&self) -> bool {
        self.book.is_waiting() || self.is_ending()
    }

    /// Whether a goal runs or waits.
    fn is_open(&self) -> bool {
        self.book.is_open()
    }

    /// What is to be done next; waits a moment for it.
    fn next(&self) -> Next {
        if self.is_ending() {
            return self.book.begin().map_or(Next::End, Next::Goal);
        }
        self.book.begin_within(IDLE).map_or(Next::Nothing, Next::Goal)
    }
}

/// The result of a goal that was cancelled before it began.
fn unbegun() -> WhatIfResult {
    WhatIfResult {
        message: "cancelled before it began".to_owned(),
        ..WhatIfResult::default()
    }
}

/// Creates the endpoints of `~/what_if`; `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is not allowed.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    clocks: &Clocks,
    control: &Arc<Control>,
    advisor: &Arc<Advisor>,
    name: impl Fn(&str) -> Result<String, ArgsError>,
) -> Result<(Arc<WhatIf>, Vec<Task>), NodeError> {
    let ends = ActionEnds::new(port, &name("~/what_if")?, "flexdrill/action/WhatIf", mapping);
    let what_if = Arc::new(WhatIf {
        book: GoalBook::new(MOST_WAITING, ends.status),
        ending: Mutex::new(false),
        refused: Mutex::default(),
        feedback: ends.feedback,
        clocks: clocks.clone(),
        control: Arc::clone(control),
        advisor: Arc::clone(advisor),
    });
    let (accepting, cancelling, asking) = (Arc::clone(&what_if), Arc::clone(&what_if), Arc::clone(&what_if));
    let tasks: Vec<Task> = vec![
        Box::pin(Arc::clone(&what_if.book).shows_life()),
        Box::pin(
            ends.send_goal
                .serve(at_once(move |request: WhatIfSendGoalRequest| accepting.accept(request))),
        ),
        Box::pin(ends.cancel_goal.serve(at_once(move |request: CancelGoalRequest| {
            if let Some(more) = log_ending("goals cancelled") {
                tracing::info!("what if: goals are cancelled{}{more}", asked_by());
            }
            cancelling.book.cancel(&request, unbegun)
        }))),
        Box::pin(
            ends.get_result
                .serve_each(MOST_CLIENTS, move |request: WhatIfGetResultRequest| {
                    Arc::clone(&asking).result(request.goal_id.uuid)
                }),
        ),
    ];
    Ok((what_if, tasks))
}
