//! Questions of pages to the twin's action `~/what_if`: one at a time, its answers as they come.
//!
//! Asking needs the token, although a look-ahead changes nothing that runs: it takes the look-ahead's threads from the
//! search for advice and from the forecast, and its answer replaces the one that all pages see. Everyone may read the
//! answer.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde::Deserialize;
use serde_json::{Value, json};

use crate::DashboardError;
use crate::control::Refused;
use flexdrill_messages::action_msgs::{CancelGoalRequest, CancelGoalResponse, GoalInfo, GoalStatus, GoalStatusArray};
use flexdrill_messages::unique_identifier_msgs::UUID;
use flexdrill_messages::{
    WhatIfAnswer, WhatIfCandidate, WhatIfFeedbackMessage, WhatIfGetResultRequest, WhatIfGetResultResponse, WhatIfGoal,
    WhatIfSendGoalRequest, WhatIfSendGoalResponse, from_cdr_body,
};
use flexdrill_ros2::args::NodeIdentity;
use flexdrill_ros2::client::{CallError, ServiceClient};
use flexdrill_ros2::dds::plan::dds_type_name;
use flexdrill_ros2::dds::port::{Inbox, Monitor, PortBuilder, Sample};
use flexdrill_text::log_ending;

/// Most candidates of a question, as of a goal of the node.
const MOST_CANDIDATES: usize = 16;
/// Least time between two questions: a page that asks without end costs the server and the node nothing.
const INTERVAL: Duration = Duration::from_secs(1);
/// After this time without feedback or states of goals the twin counts as gone. It publishes the states of open goals every
/// second, even when a busy machine has no time for the look-ahead.
const SILENCE: Duration = Duration::from_secs(30);
/// How often a silent twin is looked for.
const LOOK: Duration = Duration::from_secs(1);

/// What a page asks.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Question {
    operator: String,
    candidates: Vec<Point>,
    /// s.
    horizon: f64,
    members: u32,
}

/// A speed and a weight.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Point {
    rotary_speed_rpm: f64,
    weight_on_bit_kn: f64,
}

/// The endpoints of the action.
pub(crate) struct WhatIfParts {
    send_goal: ServiceClient,
    get_result: ServiceClient,
    cancel_goal: ServiceClient,
    feedback: Arc<Inbox<Sample>>,
    status: Arc<Inbox<Sample>>,
}

impl WhatIfParts {
    /// Creates the endpoints at `port` to the node `twin`; `identity` is unique to this process.
    pub fn new(port: &mut PortBuilder, twin: &NodeIdentity, identity: u64) -> Result<Self, DashboardError> {
        let name = |end: &str| twin.expand(&format!("~/what_if/_action/{end}"));
        let kind = |end: &str| format!("flexdrill/action/WhatIf_{end}");
        let send_goal = ServiceClient::new(port, &name("send_goal")?, &kind("SendGoal"), identity);
        let get_result = ServiceClient::new(port, &name("get_result")?, &kind("GetResult"), identity);
        let cancel_goal = ServiceClient::new(port, &name("cancel_goal")?, "action_msgs/srv/CancelGoal", identity);
        let mut topic = |end: &str, kind: &str, latched| -> Result<Arc<Inbox<Sample>>, DashboardError> {
            Ok(port.subscription(&name(end)?, &dds_type_name(kind), latched))
        };
        let feedback = topic("feedback", &kind("FeedbackMessage"), false)?;
        let status = topic("status", "action_msgs/msg/GoalStatusArray", true)?;
        Ok(Self {
            send_goal,
            get_result,
            cancel_goal,
            feedback,
            status,
        })
    }
}

/// The newest question and what is known of its answer.
#[derive(Debug, Default)]
struct Asked {
    /// Counts the questions.
    number: u64,
    id: [u8; 16],
    operator: String,
    horizon: f64,
    members: u32,
    running: bool,
    done: u32,
    remaining: u32,
    answers: Vec<WhatIfAnswer>,
    message: String,
    /// Whether the message is a reason for which there is no answer.
    failed: bool,
    at: Option<Instant>,
    heard: Option<Instant>,
}

/// Asks the twin, and keeps the answer for all pages.
pub(crate) struct WhatIf {
    monitor: Monitor,
    parts: WhatIfParts,
    /// Random beginning of the goals' identifiers.
    identity: u64,
    asked: Mutex<Asked>,
}

impl WhatIf {
    pub fn new(monitor: Monitor, parts: WhatIfParts, identity: u64) -> Arc<Self> {
        Arc::new(Self {
            monitor,
            parts,
            identity,
            asked: Mutex::default(),
        })
    }

    fn asked(&self) -> MutexGuard<'_, Asked> {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Asks a question. The answer comes later, to [`WhatIf::json`].
    ///
    /// # Errors
    /// When it is malformed, another question is being answered, or the twin does not accept it.
    pub async fn ask(self: &Arc<Self>, question: Question) -> Result<String, Refused> {
        // Checked here although the twin checks too: the page gets its answer without a network.
        let operator = crate::control::checked_name(&question.operator)?;
        let count = question.candidates.len();
        if !(1..=MOST_CANDIDATES).contains(&count) {
            return Err(Refused::Wrong(format!(
                "{count} candidates: give 1 to {MOST_CANDIDATES} speeds and weights"
            )));
        }
        let candidates = question.candidates.iter().map(|point| WhatIfCandidate {
            rotary_speed: point.rotary_speed_rpm,
            weight_on_bit: point.weight_on_bit_kn,
            ..WhatIfCandidate::default()
        });
        let goal = WhatIfGoal {
            candidates: candidates.collect(),
            horizon: question.horizon,
            members: question.members,
            // Not all members need to run: once the first ones decide, the page has its answer.
            run_all: false,
            seed: 1,
        };
        // The lock covers check and entry, so that two questions cannot both
        // find the place free; it ends before the call, which waits.
        let (number, id) = {
            let mut asked = self.asked();
            if asked.running {
                return Err(Refused::Conflict(format!(
                    "a question of {} is being answered; wait for its end or cancel it",
                    asked.operator
                )));
            }
            // A second between questions bounds what a page in a loop can cost the twin.
            if asked.at.is_some_and(|at| at.elapsed() < INTERVAL) {
                return Err(Refused::Conflict("one question a second; ask again".into()));
            }
            let number = asked.number + 1;
            // The identifier of a goal must be unique in the network: this server's identity and a count.
            let mut id = [0; 16];
            id[..8].copy_from_slice(&self.identity.to_le_bytes());
            id[8..].copy_from_slice(&number.to_le_bytes());
            *asked = Asked {
                number,
                id,
                operator: operator.clone(),
                horizon: goal.horizon,
                members: goal.members,
                running: true,
                at: Some(Instant::now()),
                heard: Some(Instant::now()),
                ..Asked::default()
            };
            (number, id)
        };
        if let Some(more) = log_ending("asks what if") {
            tracing::info!("{operator} asks what if, with {count} candidates{more}");
        }
        // The entry is made before the request is sent: its answers may come before the call returns.
        let request = WhatIfSendGoalRequest {
            goal_id: UUID { uuid: id },
            goal,
        };
        let sent = self.parts.send_goal.call(&self.monitor, &request).await;
        let refused = match sent {
            Ok(WhatIfSendGoalResponse { accepted: true, .. }) => {
                // A separate task follows the goal, since the page does not wait for its answer.
                tokio::spawn(Arc::clone(self).follow(number, id));
                return Ok("the twin looks ahead".into());
            }
            // The twin keeps the reason under the goal's identifier.
            Ok(_) => match self.result(id).await {
                Ok(WhatIfGetResultResponse { result, .. }) => Refused::Conflict(result.message),
                Err(error) => Refused::Conflict(format!(
                    "the twin did not accept the question, and the reason is unknown: {error}"
                )),
            },
            Err(error) => Refused::Away(error.to_string()),
        };
        // The entry is ended on every refusal, or no further question would be accepted.
        self.end(number, true, refused.to_string(), None);
        Err(refused)
    }

    /// Cancels the question that is being answered.
    ///
    /// # Errors
    /// When there is none, or the twin does not answer.
    pub async fn cancel(&self, operator: &str) -> Result<String, Refused> {
        let operator = crate::control::checked_name(operator)?;
        let id = {
            let asked = self.asked();
            if !asked.running {
                return Ok("no question is being answered".into());
            }
            asked.id
        };
        if let Some(more) = log_ending("cancels the question") {
            tracing::info!("{operator} cancels the question{more}");
        }
        let request = CancelGoalRequest {
            goal_info: GoalInfo {
                goal_id: UUID { uuid: id },
                ..GoalInfo::default()
            },
        };
        let answer = self.parts.cancel_goal.call(&self.monitor, &request).await;
        answer
            .map(|CancelGoalResponse { .. }| "cancelled".to_owned())
            .map_err(|error| Refused::Away(error.to_string()))
    }

    /// Takes feedback until the goal has ended, then fetches the result.
    async fn follow(self: Arc<Self>, number: u64, id: [u8; 16]) {
        let mut look = tokio::time::interval(LOOK);
        loop {
            tokio::select! {
                sample = self.parts.feedback.next() => {
                    if let Sample::Body { body, .. } = sample {
                        self.hear(&body, number, id);
                    }
                }
                sample = self.parts.status.next() => {
                    if let Sample::Body { body, .. } = sample && self.has_ended(&body, id) {
                        break;
                    }
                }
                _ = look.tick() => {
                    if self.is_silent() {
                        return self.end(number, true, "the twin does not answer".into(), None);
                    }
                }
            }
        }
        match self.result(id).await {
            Ok(WhatIfGetResultResponse { status, result }) => {
                let failed = status != GoalStatus::STATUS_SUCCEEDED && status != GoalStatus::STATUS_CANCELED;
                self.end(number, failed, result.message, Some(result.answers));
            }
            Err(error) => self.end(number, true, error.to_string(), None),
        }
    }

    async fn result(&self, id: [u8; 16]) -> Result<WhatIfGetResultResponse, CallError> {
        let request = WhatIfGetResultRequest {
            goal_id: UUID { uuid: id },
        };
        self.parts.get_result.call(&self.monitor, &request).await
    }

    /// Whether the states of the twin's goals have this one as ended.
    fn has_ended(&self, body: &[u8], id: [u8; 16]) -> bool {
        let Ok((states, _)) = from_cdr_body::<GoalStatusArray>(body) else {
            return false;
        };
        self.asked().heard = Some(Instant::now());
        let own = states
            .status_list
            .iter()
            .filter(|state| state.goal_info.goal_id.uuid == id);
        own.into_iter()
            .any(|state| state.status >= GoalStatus::STATUS_SUCCEEDED)
    }

    fn is_silent(&self) -> bool {
        self.asked().heard.is_none_or(|heard| heard.elapsed() > SILENCE)
    }

    fn hear(&self, body: &[u8], number: u64, id: [u8; 16]) {
        let Ok((message, _)) = from_cdr_body::<WhatIfFeedbackMessage>(body) else {
            return;
        };
        let mut asked = self.asked();
        // The feedback of other clients' goals comes here too. It shows that the twin works.
        asked.heard = Some(Instant::now());
        if message.goal_id.uuid == id && asked.number == number && asked.running {
            (asked.done, asked.remaining) = (message.feedback.done, message.feedback.remaining);
            asked.answers = message.feedback.answers;
        }
    }

    fn end(&self, number: u64, failed: bool, message: String, answers: Option<Vec<WhatIfAnswer>>) {
        let mut asked = self.asked();
        if asked.number != number {
            return;
        }
        (asked.running, asked.failed, asked.remaining) = (false, failed, 0);
        asked.message = message;
        if let Some(answers) = answers.filter(|answers| !answers.is_empty()) {
            asked.answers = answers;
        }
    }

    /// The newest question with its answers so far, for the page.
    pub fn json(&self) -> Value {
        let asked = self.asked();
        json!({
            "number": asked.number,
            "by": asked.operator,
            "horizon": asked.horizon,
            "members": asked.members,
            "running": asked.running,
            "done": asked.done,
            "remaining": asked.remaining,
            "failed": asked.failed,
            "message": asked.message,
            // JSON has null for a number that is not finite.
            "answers": serde_json::to_value(&asked.answers).unwrap_or_default(),
        })
    }
}
