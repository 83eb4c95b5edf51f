//! The goals of an action's server, shared by its services, by what carries them out, and by clients that wait for results.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::watch;

use crate::action::{Accepted, Begun, GoalId, Goals};
use crate::dds::port::TopicPublisher;
use flexdrill_messages::action_msgs::{CancelGoalRequest, CancelGoalResponse};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::to_cdr_body;
use flexdrill_text::log_ending;

/// Interval at which the states of the goals are published again while one is open. On a busy machine a client would
/// otherwise hear nothing of the node for minutes. A client that ends before it has heard a state of its goal takes it for
/// not running, and does not cancel it.
const SIGN_OF_LIFE: Duration = Duration::from_secs(1);
/// The same after a goal was accepted: a state that arrives before the reply is not taken by the client, and the reply waits
/// until the client's reader is known.
const FIRST_SIGNS: Duration = Duration::from_millis(200);
/// Time for which these go on: the longest wait for a client's reader.
const FIRST_SIGNS_FOR: Duration = Duration::from_secs(4);

/// The goals, and who waits for them. Every change is published as the states of all goals.
pub struct GoalBook<G, R> {
    goals: Mutex<Goals<G, R>>,
    /// A goal was accepted or has ended.
    work: Condvar,
    /// Counts changes of the goals, for those who wait for a result.
    changed: watch::Sender<u64>,
    /// When the newest goal was accepted.
    accepted: Mutex<Option<Instant>>,
    status: TopicPublisher,
}

impl<G, R: Clone> GoalBook<G, R> {
    /// No goals; `most_waiting` of them may wait in addition to the one that runs. `status` has the states.
    pub fn new(most_waiting: usize, status: TopicPublisher) -> Arc<Self> {
        Arc::new(Self {
            goals: Mutex::new(Goals::new(most_waiting)),
            work: Condvar::new(),
            changed: watch::Sender::new(0),
            accepted: Mutex::default(),
            status,
        })
    }

    fn goals(&self) -> MutexGuard<'_, Goals<G, R>> {
        self.goals.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the goals and notifies all who wait for a change.
    pub fn change<T>(&self, change: impl FnOnce(&mut Goals<G, R>) -> T) -> T {
        let (result, states) = {
            let mut goals = self.goals();
            (change(&mut goals), goals.states())
        };
        publish(&self.status, &states);
        self.changed.send_modify(|count| *count += 1);
        self.work.notify_all();
        result
    }

    /// Takes a goal, if there is room for it.
    pub fn accept(&self, id: GoalId, stamp: Time, goal: G) -> Accepted {
        let accepted = self.change(|goals| goals.accept(id, stamp, goal));
        if matches!(accepted, Accepted::Waits(_)) {
            *self.accepted.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
        }
        accepted
    }

    /// Asks for the end of goals, see [`Goals::cancel`].
    pub fn cancel(&self, request: &CancelGoalRequest, unbegun: impl Fn() -> R) -> CancelGoalResponse {
        self.change(|goals| goals.cancel(request, unbegun))
    }

    /// Whether a goal runs or waits.
    pub fn is_open(&self) -> bool {
        self.goals().is_open()
    }

    /// Whether a goal waits.
    pub fn is_waiting(&self) -> bool {
        self.goals().is_waiting()
    }

    /// The next goal that waits, which begins. Its state is published with the next change.
    pub fn begin(&self) -> Option<Begun<G>> {
        self.goals().begin()
    }

    /// The same; blocks for `longest` at most until there is one.
    pub fn begin_within(&self, longest: Duration) -> Option<Begun<G>> {
        let mut goals = self.goals();
        if let Some(begun) = goals.begin() {
            return Some(begun);
        }
        let (mut goals, _) = self
            .work
            .wait_timeout(goals, longest)
            .unwrap_or_else(PoisonError::into_inner);
        goals.begin()
    }

    /// The same; waits for as long as it is polled.
    pub async fn next(&self) -> Option<Begun<G>> {
        let mut changed = self.changed.subscribe();
        loop {
            if let Some(begun) = self.begin() {
                return Some(begun);
            }
            changed.changed().await.ok()?;
        }
    }

    /// State and result of a goal once it has ended: state UNKNOWN and no result where it is not known.
    pub async fn ended(&self, id: GoalId) -> Option<(i8, Option<R>)> {
        let mut changed = self.changed.subscribe();
        loop {
            let result = self.goals().result(id);
            if result.is_some() {
                return result;
            }
            changed.changed().await.ok()?;
        }
    }

    /// Publishes the states of the goals again while one is open.
    pub async fn shows_life(self: Arc<Self>) {
        let mut ticks = tokio::time::interval(FIRST_SIGNS);
        let mut shown = tokio::time::Instant::now();
        loop {
            let now = ticks.tick().await;
            let accepted = *self.accepted.lock().unwrap_or_else(PoisonError::into_inner);
            let is_new = accepted.is_some_and(|at| at.elapsed() < FIRST_SIGNS_FOR);
            if !is_new && now.duration_since(shown) < SIGN_OF_LIFE {
                continue;
            }
            shown = now;
            let open = {
                let goals = self.goals();
                goals.is_open().then(|| goals.states())
            };
            if let Some(states) = open {
                publish(&self.status, &states);
            }
        }
    }
}

/// Publishes a message of an action: its feedback, or the states of its goals.
pub fn publish(to: &TopicPublisher, message: &impl serde::Serialize) {
    match to_cdr_body(message) {
        Ok(body) => to.publish(body),
        Err(error) => {
            if let Some(more) = log_ending("goal not encoded") {
                tracing::error!("a message of an action could not be encoded: {error}{more}");
            }
        }
    }
}
