//! The five endpoints of a ROS 2 action's server: three services and two topics, and the life of its goals.
//!
//! ROS 2 has no wire format for actions. A client sends a goal by one service, asks for its result by another, which
//! answers once there is one, and cancels by a third; feedback and the states of all goals are topics.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::service::{ServiceMapping, ServiceServer};
use crate::dds::plan::{Offer, dds_type_name};
use crate::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_messages::action_msgs::{CancelGoalRequest, CancelGoalResponse, GoalInfo, GoalStatus, GoalStatusArray};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::unique_identifier_msgs::UUID;

/// Ended goals that are kept for clients that ask for their results.
const KEPT: usize = 32;
/// Time for which they are kept: that of ROS 2's own servers.
const KEPT_FOR: Duration = Duration::from_secs(15 * 60);

/// The endpoints of an action.
pub struct ActionEnds {
    /// `<name>/_action/send_goal`.
    pub send_goal: ServiceServer,
    /// `<name>/_action/cancel_goal`.
    pub cancel_goal: ServiceServer,
    /// `<name>/_action/get_result`.
    pub get_result: ServiceServer,
    /// `<name>/_action/feedback`.
    pub feedback: TopicPublisher,
    /// `<name>/_action/status`.
    pub status: TopicPublisher,
}

impl ActionEnds {
    /// Endpoints at `port`. `name` is absolute, `ros_type` is such as `package/action/Type`.
    pub fn new(port: &mut PortBuilder, name: &str, ros_type: &str, mapping: ServiceMapping) -> Self {
        let offer = |latched: bool, depth: i32| Offer {
            latched,
            depth,
            ..Offer::usual(10.0)
        };
        let mut service = |part: &str, kind: &str| {
            let name = format!("{name}/_action/{part}");
            ServiceServer::new(port, &name, kind, mapping)
        };
        let send_goal = service("send_goal", &format!("{ros_type}_SendGoal"));
        let cancel_goal = service("cancel_goal", "action_msgs/srv/CancelGoal");
        let get_result = service("get_result", &format!("{ros_type}_GetResult"));
        let mut topic = |part: &str, kind: &str, offer: Offer| {
            port.publisher(&format!("{name}/_action/{part}"), &dds_type_name(kind), offer)
        };
        Self {
            send_goal,
            cancel_goal,
            get_result,
            feedback: topic("feedback", &format!("{ros_type}_FeedbackMessage"), offer(false, 10)),
            status: topic("status", "action_msgs/msg/GoalStatusArray", offer(true, 1)),
        }
    }
}

/// The identifier of a goal.
pub type GoalId = [u8; 16];

/// A goal that was accepted.
#[derive(Debug)]
struct Entry<G, R> {
    id: GoalId,
    stamp: Time,
    /// Until it begins.
    goal: Option<G>,
    status: i8,
    stop: Arc<AtomicBool>,
    result: Option<R>,
    ended: Option<Instant>,
}

/// The goals of a server: one runs, some wait, and the results of those that ended are kept for a while.
#[derive(Debug)]
pub struct Goals<G, R> {
    entries: VecDeque<Entry<G, R>>,
    /// Goals that may wait.
    most_waiting: usize,
}

/// A goal that begins.
#[derive(Debug)]
pub struct Begun<G> {
    /// Which.
    pub id: GoalId,
    /// What is asked.
    pub goal: G,
    /// Is set when the goal is cancelled.
    pub stop: Arc<AtomicBool>,
}

/// Whether a goal was accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accepted {
    /// It begins at once, or when those before it have ended: so many.
    Waits(usize),
    /// As many goals as may wait do.
    Full,
    /// A goal of this identifier is there already.
    Known,
}

impl<G, R: Clone> Goals<G, R> {
    /// No goals; `most_waiting` of them may wait in addition to the one that runs.
    pub fn new(most_waiting: usize) -> Self {
        Self {
            entries: VecDeque::new(),
            most_waiting,
        }
    }

    /// Takes a goal.
    pub fn accept(&mut self, id: GoalId, stamp: Time, goal: G) -> Accepted {
        self.forget_old();
        if self.entries.iter().any(|entry| entry.id == id) {
            return Accepted::Known;
        }
        let before = self.entries.iter().filter(|entry| entry.ended.is_none()).count();
        if before > self.most_waiting {
            return Accepted::Full;
        }
        self.entries.push_back(Entry {
            id,
            stamp,
            goal: Some(goal),
            status: GoalStatus::STATUS_ACCEPTED,
            stop: Arc::new(AtomicBool::new(false)),
            result: None,
            ended: None,
        });
        Accepted::Waits(before)
    }

    /// Whether a goal waits to begin.
    pub fn is_waiting(&self) -> bool {
        self.entries.iter().any(|entry| entry.goal.is_some())
    }

    /// Whether a goal runs or waits.
    pub fn is_open(&self) -> bool {
        self.entries.iter().any(|entry| entry.ended.is_none())
    }

    /// The next goal that waits, which begins.
    pub fn begin(&mut self) -> Option<Begun<G>> {
        let next = self.entries.iter_mut().find(|entry| entry.goal.is_some())?;
        if next.status == GoalStatus::STATUS_ACCEPTED {
            next.status = GoalStatus::STATUS_EXECUTING;
        }
        Some(Begun {
            id: next.id,
            goal: next.goal.take()?,
            stop: Arc::clone(&next.stop),
        })
    }

    /// Ends a goal: as cancelled where that was asked for, else as `status` says, SUCCEEDED or ABORTED.
    pub fn end(&mut self, id: GoalId, status: i8, result: R) {
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == id) {
            entry.status = if entry.status == GoalStatus::STATUS_CANCELING {
                GoalStatus::STATUS_CANCELED
            } else {
                status
            };
            (entry.result, entry.ended) = (Some(result), Some(Instant::now()));
        }
    }

    /// Asks for the end of goals, as ROS 2 defines it: all where identifier and stamp are zero; the one of the identifier
    /// and, where the stamp is not zero, those accepted at the stamp or before. A goal that waits ends at once, with
    /// `unbegun` as its result; one that runs ends when [its flag](Begun::stop) is seen.
    pub fn cancel(&mut self, request: &CancelGoalRequest, unbegun: impl Fn() -> R) -> CancelGoalResponse {
        let GoalInfo { goal_id, stamp } = &request.goal_info;
        let (no_id, no_stamp) = (goal_id.uuid == [0; 16], *stamp == Time::default());
        let asked = |entry: &Entry<G, R>| {
            no_id && no_stamp
                || !no_id && entry.id == goal_id.uuid
                || !no_stamp && entry.stamp.to_nanoseconds() <= stamp.to_nanoseconds()
        };
        let mut goals_canceling = Vec::new();
        for entry in self.entries.iter_mut().filter(|entry| asked(entry)) {
            if entry.ended.is_none() {
                entry.status = GoalStatus::STATUS_CANCELING;
                entry.stop.store(true, Ordering::Relaxed);
                if entry.goal.take().is_some() {
                    entry.status = GoalStatus::STATUS_CANCELED;
                    (entry.result, entry.ended) = (Some(unbegun()), Some(Instant::now()));
                }
                goals_canceling.push(info(entry.id, &entry.stamp));
            }
        }
        let known = self.entries.iter().any(|entry| entry.id == goal_id.uuid);
        let return_code = match (no_id, known, goals_canceling.is_empty()) {
            (false, false, _) => CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID,
            (false, true, true) => CancelGoalResponse::ERROR_GOAL_TERMINATED,
            _ => CancelGoalResponse::ERROR_NONE,
        };
        CancelGoalResponse {
            return_code,
            goals_canceling,
        }
    }

    /// Asks for the end of all goals, as the node ends.
    pub fn cancel_all(&mut self, unbegun: impl Fn() -> R) {
        let _ = self.cancel(&CancelGoalRequest::default(), unbegun);
    }

    /// The end of a goal: `None` while it has none, status UNKNOWN where the goal is not known.
    pub fn result(&self, id: GoalId) -> Option<(i8, Option<R>)> {
        match self.entries.iter().find(|entry| entry.id == id) {
            None => Some((GoalStatus::STATUS_UNKNOWN, None)),
            Some(entry) => entry.result.clone().map(|result| (entry.status, Some(result))),
        }
    }

    /// The states of all goals.
    pub fn states(&self) -> GoalStatusArray {
        let of = |entry: &Entry<G, R>| GoalStatus {
            goal_info: info(entry.id, &entry.stamp),
            status: entry.status,
        };
        GoalStatusArray {
            status_list: self.entries.iter().map(of).collect(),
        }
    }

    /// Forgets ended goals that are old, and the oldest of them where there are many.
    fn forget_old(&mut self) {
        self.entries
            .retain(|entry| entry.ended.is_none_or(|ended| ended.elapsed() < KEPT_FOR));
        while self.entries.iter().filter(|entry| entry.ended.is_some()).count() >= KEPT {
            if let Some(oldest) = self.entries.iter().position(|entry| entry.ended.is_some()) {
                self.entries.remove(oldest);
            }
        }
    }
}

fn info(id: GoalId, stamp: &Time) -> GoalInfo {
    GoalInfo {
        goal_id: UUID { uuid: id },
        stamp: stamp.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(sec: i32) -> Time {
        Time { sec, nanosec: 0 }
    }

    fn cancel(id: u8, stamp: i32) -> CancelGoalRequest {
        CancelGoalRequest {
            goal_info: info([id; 16], &at(stamp)),
        }
    }

    #[test]
    fn goals_wait_run_and_end_in_turn() {
        let mut goals: Goals<&str, &str> = Goals::new(1);
        assert!(!goals.is_open());
        assert_eq!(goals.accept([1; 16], at(10), "first"), Accepted::Waits(0));
        assert!(goals.is_open());
        assert_eq!(goals.accept([1; 16], at(10), "again"), Accepted::Known);
        assert_eq!(goals.accept([2; 16], at(11), "second"), Accepted::Waits(1));
        assert_eq!(goals.accept([3; 16], at(12), "third"), Accepted::Full);
        let first = goals.begin().unwrap();
        assert_eq!((first.id, first.goal), ([1; 16], "first"));
        assert_eq!(goals.result([1; 16]), None);
        goals.end([1; 16], GoalStatus::STATUS_SUCCEEDED, "done");
        assert_eq!(
            goals.result([1; 16]),
            Some((GoalStatus::STATUS_SUCCEEDED, Some("done")))
        );
        assert_eq!(goals.result([9; 16]), Some((GoalStatus::STATUS_UNKNOWN, None)));
        assert_eq!(goals.begin().unwrap().goal, "second");
        assert!(goals.begin().is_none());
        let states: Vec<i8> = goals.states().status_list.iter().map(|state| state.status).collect();
        assert_eq!(states, [GoalStatus::STATUS_SUCCEEDED, GoalStatus::STATUS_EXECUTING]);
        assert!(goals.is_open() && !goals.is_waiting());
        goals.end([2; 16], GoalStatus::STATUS_SUCCEEDED, "done");
        assert!(!goals.is_open());
    }

    #[test]
    fn cancelling_follows_the_rules_of_ros() {
        let filled = || {
            let mut goals: Goals<(), ()> = Goals::new(5);
            for id in 1..=3_u8 {
                goals.accept([id; 16], at(i32::from(id)), ());
            }
            goals
        };
        let count = |request| {
            let response = filled().cancel(&request, || ());
            (response.return_code, response.goals_canceling.len())
        };
        assert_eq!(count(cancel(0, 0)), (CancelGoalResponse::ERROR_NONE, 3));
        assert_eq!(count(cancel(2, 0)), (CancelGoalResponse::ERROR_NONE, 1));
        assert_eq!(count(cancel(0, 2)), (CancelGoalResponse::ERROR_NONE, 2));
        assert_eq!(count(cancel(3, 1)), (CancelGoalResponse::ERROR_NONE, 2));
        assert_eq!(count(cancel(9, 0)), (CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID, 0));
        let mut goals = filled();
        let begun = goals.begin().unwrap();
        goals.cancel(&cancel(0, 0), || ());
        assert!(begun.stop.load(Ordering::Relaxed));
        // The one that runs is asked to end; those that wait have ended, and none begins.
        assert_eq!(goals.result(begun.id), None);
        for waiting in [2, 3] {
            assert_eq!(
                goals.result([waiting; 16]),
                Some((GoalStatus::STATUS_CANCELED, Some(())))
            );
        }
        assert!(goals.begin().is_none() && goals.is_open());
        goals.end(begun.id, GoalStatus::STATUS_SUCCEEDED, ());
        assert_eq!(goals.result(begun.id), Some((GoalStatus::STATUS_CANCELED, Some(()))));
        assert_eq!(
            goals.cancel(&cancel(1, 0), || ()).return_code,
            CancelGoalResponse::ERROR_GOAL_TERMINATED
        );
    }

    #[test]
    fn memory_is_bounded() {
        let mut goals: Goals<(), ()> = Goals::new(1);
        for number in 0..200_u8 {
            goals.accept([number + 1; 16], at(0), ());
            let begun = goals.begin().unwrap();
            goals.end(begun.id, GoalStatus::STATUS_SUCCEEDED, ());
        }
        assert!(goals.entries.len() <= KEPT + 1);
    }
}
