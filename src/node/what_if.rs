//! The action `~/what_if`: what the tool would do under other speeds and weights, from the present state of the live run.
//!
//! One goal runs at a time, on threads of low priority; up to [`MOST_WAITING`] wait. The search for advice and the forecast
//! run when no goal is open, and have turns next to goals ([`turns`]). ROS 2 has no words for a goal that is not accepted:
//! the reason is in the log, and in the answer to a client that asks for the result nevertheless.

use std::collections::VecDeque;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::watch;

use super::NodeError;
use super::advisor::Advisor;
use super::clocks::Clocks;
use super::control::Control;
use super::forecast::{Busy, Forecasts, Issued};
use super::states::SavedRun;
use super::turns::{self, Turn, Turns};
use super::what_if_messages::{feedback, goal, of_candidate, sentence};
use crate::ahead::{Start, forecast, look_ahead, search};
use flexdrill_config::Config;
use flexdrill_core::twin::{RunInputs, Simulation};
use flexdrill_messages::action_msgs::{CancelGoalRequest, GoalStatus};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::{
    WhatIfGetResultRequest, WhatIfGetResultResponse, WhatIfGoal, WhatIfResult, WhatIfSendGoalRequest,
    WhatIfSendGoalResponse, to_cdr_body,
};
use flexdrill_realtime::link::{Gauges, RunState};
use flexdrill_ros2::action::{Accepted, ActionEnds, Begun, GoalId, Goals};
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_ros2::service::{ServiceMapping, Task, asked_by, at_once};
use flexdrill_text::log_ending;

/// Goals that may wait while one runs.
const MOST_WAITING: usize = 4;
/// Clients that may wait for results at the same time.
const MOST_CLIENTS: usize = 32;
/// Least time between two feedbacks.
const FEEDBACK_INTERVAL: Duration = Duration::from_millis(100);

/// Interval at which the node publishes the states of its goals again while one is open. Looking ahead is idle work: on a
/// busy machine a client would otherwise hear nothing of the node for minutes. A client that ends before it has heard a
/// state of its goal takes it for not running, and does not cancel it.
const SIGN_OF_LIFE: Duration = Duration::from_secs(1);
/// The same after a goal was accepted: a state that arrives before the reply is not taken by the client, and the reply waits
/// until the client's reader is known.
const FIRST_SIGNS: Duration = Duration::from_millis(200);
/// Time for which these go on: the longest wait for a client's reader.
const FIRST_SIGNS_FOR: Duration = Duration::from_secs(4);
/// Reasons of refused goals that are kept for clients that ask for them.
const KEPT_REFUSALS: usize = 32;
/// Longest wait for a goal before advice is looked for.
const IDLE: Duration = Duration::from_millis(200);
/// Fixed, so that the same state gives the same advice.
const ADVICE_SEED: u64 = 1;
/// Fixed, so that the same state gives the same forecast.
const FORECAST_SEED: u64 = 1;
/// From the beginning of a forecast to that of the next.
const FORECAST_INTERVAL: Duration = Duration::from_secs(30);

/// What the thread that looks ahead does next.
enum Next {
    Goal(Begun<WhatIfGoal>),
    Nothing,
    /// The node ends, and no goal waits.
    End,
}

type Book = Goals<WhatIfGoal, WhatIfResult>;

/// The goals, and who waits for them.
pub struct WhatIf {
    goals: Mutex<Book>,
    /// A goal was accepted, or the node ends.
    work: Condvar,
    /// Counts changes of the goals, for those who wait for a result.
    changed: watch::Sender<u64>,
    ending: Mutex<bool>,
    /// When the newest goal was accepted.
    accepted: Mutex<Option<Instant>>,
    /// Why the latest refused goals were refused.
    refused: Mutex<VecDeque<(GoalId, String)>>,
    feedback: TopicPublisher,
    status: TopicPublisher,
    clocks: Clocks,
    control: Arc<Control>,
    advisor: Arc<Advisor>,
}

impl WhatIf {
    fn goals(&self) -> MutexGuard<'_, Book> {
        self.goals.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the goals and notifies all who wait for a change.
    fn change<T>(&self, change: impl FnOnce(&mut Book) -> T) -> T {
        let (result, states) = {
            let mut goals = self.goals();
            (change(&mut goals), goals.states())
        };
        publish(&self.status, &states);
        self.changed.send_modify(|count| *count += 1);
        self.work.notify_all();
        result
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
        match self.change(|goals| goals.accept(id, stamp, asked)) {
            Accepted::Waits(before) => {
                // A question of a person comes before the search for advice, unless that has its turn.
                self.advisor.yield_to_goal();
                *self.accepted.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
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

    /// Publishes the states of the goals while one is open.
    async fn shows_life(self: Arc<Self>) {
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

    async fn result(self: Arc<Self>, id: GoalId) -> WhatIfGetResultResponse {
        let mut changed = self.changed.subscribe();
        loop {
            let result = self.goals().result(id);
            if let Some((status, result)) = result {
                return WhatIfGetResultResponse {
                    status,
                    result: result.unwrap_or_else(|| self.no_such(id)),
                };
            }
            if changed.changed().await.is_err() {
                return WhatIfGetResultResponse::default();
            }
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
        self.goals().is_waiting() || self.is_ending()
    }

    /// Whether a goal runs or waits.
    fn is_open(&self) -> bool {
        self.goals().is_open()
    }

    /// What is to be done next; waits a moment for it.
    fn next(&self) -> Next {
        let mut goals = self.goals();
        if let Some(begun) = goals.begin() {
            return Next::Goal(begun);
        }
        if self.is_ending() {
            return Next::End;
        }
        let (mut goals, _) = self
            .work
            .wait_timeout(goals, IDLE)
            .unwrap_or_else(PoisonError::into_inner);
        goals.begin().map_or(Next::Nothing, Next::Goal)
    }
}

/// The result of a goal that was cancelled before it began.
fn unbegun() -> WhatIfResult {
    WhatIfResult {
        message: "cancelled before it began".to_owned(),
        ..WhatIfResult::default()
    }
}

fn publish(to: &TopicPublisher, message: &impl serde::Serialize) {
    match to_cdr_body(message) {
        Ok(body) => to.publish(body),
        Err(error) => {
            if let Some(more) = log_ending("goal not encoded") {
                tracing::error!("what if: a message could not be encoded: {error}{more}");
            }
        }
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
        goals: Mutex::new(Goals::new(MOST_WAITING)),
        work: Condvar::new(),
        changed: watch::Sender::new(0),
        ending: Mutex::new(false),
        accepted: Mutex::default(),
        refused: Mutex::default(),
        feedback: ends.feedback,
        status: ends.status,
        clocks: clocks.clone(),
        control: Arc::clone(control),
        advisor: Arc::clone(advisor),
    });
    let (accepting, cancelling, asking) = (Arc::clone(&what_if), Arc::clone(&what_if), Arc::clone(&what_if));
    let tasks: Vec<Task> = vec![
        Box::pin(Arc::clone(&what_if).shows_life()),
        Box::pin(
            ends.send_goal
                .serve(at_once(move |request: WhatIfSendGoalRequest| accepting.accept(request))),
        ),
        Box::pin(ends.cancel_goal.serve(at_once(move |request: CancelGoalRequest| {
            if let Some(more) = log_ending("goals cancelled") {
                tracing::info!("what if: goals are cancelled{}{more}", asked_by());
            }
            cancelling.change(|goals| goals.cancel(&request, unbegun))
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

/// What the thread that answers goals works with.
pub struct Answering {
    /// The goals.
    pub what_if: Arc<WhatIf>,
    /// Who has the present state.
    pub control: Arc<Control>,
    /// Where the run is in time.
    pub gauges: Arc<Gauges>,
    /// Who asks for advice on alarms.
    pub advisor: Arc<Advisor>,
    /// Where forecasts go; none where they are off.
    pub forecasts: Option<Arc<Forecasts>>,
}

impl Answering {
    /// Answers goals until the node ends.
    pub fn run(self) {
        std::thread::scope(|scope| {
            let others = std::thread::Builder::new().name("advice".to_owned());
            if let Err(error) = others.spawn_scoped(scope, || self.take_turns())
                && let Some(more) = log_ending("no thread for advice")
            {
                tracing::error!("no thread for advice and forecast: {error}; there are none{more}");
            }
            self.answer_goals();
        });
    }

    /// Searches for advice and forecasts until the node ends: while no goal is open, and in turns next to goals.
    fn take_turns(&self) {
        let (mut tool, mut forecast_at, mut turns) = (None, Instant::now(), Turns::default());
        while !self.what_if.is_ending() {
            let turn = turns.next(self.what_if.is_open(), Instant::now());
            let Some(turn) = turn else {
                self.note(Busy::Goals);
                std::thread::sleep(IDLE);
                continue;
            };
            self.advisor.keep(turn == Turn::Kept);
            self.advise(&mut tool);
            self.forecast(&mut tool, &mut forecast_at);
            self.advisor.keep(false);
            if turn == Turn::Kept {
                turns.ended(Instant::now());
            }
            std::thread::sleep(IDLE);
        }
    }

    /// Says what the look-ahead does, for the case that no forecast comes.
    fn note(&self, busy: Busy) {
        if let Some(forecasts) = &self.forecasts {
            forecasts.note(busy);
        }
    }

    fn answer_goals(&self) {
        // The tool is built once, when the first goal comes.
        let mut tool = None;
        loop {
            let begun = match self.what_if.next() {
                Next::Goal(begun) => begun,
                Next::Nothing => continue,
                Next::End => return,
            };
            self.what_if.change(|_| ());
            let began = Instant::now();
            let (status, result) = match self.answer(&begun, &mut tool) {
                Ok(result) => (GoalStatus::STATUS_SUCCEEDED, result),
                Err(message) => {
                    if let Some(more) = log_ending("goal aborted") {
                        tracing::warn!("what if: {message}{more}");
                    }
                    let result = WhatIfResult {
                        message,
                        ..WhatIfResult::default()
                    };
                    (GoalStatus::STATUS_ABORTED, result)
                }
            };
            if let Some(more) = log_ending("goal answered") {
                tracing::info!(
                    "what if: answered after {:.1} s: {}{more}",
                    began.elapsed().as_secs_f64(),
                    result.message
                );
            }
            self.what_if.change(|goals| goals.end(begun.id, status, result));
        }
    }

    fn answer(&self, begun: &Begun<WhatIfGoal>, tool: &mut Option<Simulation>) -> Result<WhatIfResult, String> {
        let config = self.control.config();
        let goal = goal(&begun.goal);
        // The limits may have changed since it was accepted.
        goal.check(&config).map_err(|error| error.to_string())?;
        let standing = self.control.stands_still();
        let (start, applied, ticks) = self.start(&config, tool)?;
        let (began, mut told) = (Instant::now(), Instant::now());
        let (mut first, mut stopped_by) = (true, "cancelled");
        let threads = config.look_ahead.threads as usize;
        let answer = look_ahead(&start, &goal, threads, &begun.stop, |progress| {
            if first || told.elapsed() >= FEEDBACK_INTERVAL {
                (first, told) = (false, Instant::now());
                publish(&self.what_if.feedback, &feedback(begun.id, &progress));
            }
            if turns::is_over(began.elapsed(), self.what_if.is_wanted()) && !begun.stop.load(Ordering::Relaxed) {
                stopped_by = "ended after ten minutes, since other goals wait";
                begun.stop.store(true, Ordering::Relaxed);
            }
        });
        Ok(WhatIfResult {
            from_stamp: self.stamp(ticks, &config),
            from_step: applied.step,
            complete: !answer.stopped,
            message: match standing {
                Some(why) => format!(
                    "{why}; these runs begin at its present state. {}",
                    sentence(&answer, stopped_by)
                ),
                None => sentence(&answer, stopped_by),
            },
            answers: answer.candidates.iter().map(of_candidate).collect(),
        })
    }

    /// The present state of the live run, what acts on it, and its ticks.
    fn start(&self, config: &Arc<Config>, tool: &mut Option<Simulation>) -> Result<(Start, RunInputs, u64), String> {
        let SavedRun {
            checkpoint,
            applied,
            ticks,
        } = self.control.state().map_err(|error| error.to_string())?;
        let tool = match tool {
            Some(tool) => tool,
            // What may change while the node runs is in the checkpoint; the tool itself stays as it was built.
            None => {
                let first = self.control.first_config();
                let built = Simulation::new(&first.tool(), &first.simulation()).map_err(|error| error.to_string())?;
                tool.insert(built)
            }
        };
        let start =
            Start::restored(Arc::clone(config), tool, &checkpoint, &applied).map_err(|error| error.to_string())?;
        Ok((start, applied, ticks))
    }

    /// Looks for the smallest change that ends the alarms that stand, if that is asked for.
    fn advise(&self, tool: &mut Option<Simulation>) {
        let Some((asked, stop)) = self.advisor.due() else {
            return;
        };
        self.note(Busy::Advice);
        let config = self.control.config();
        let start = match self.start(&config, tool) {
            Ok((start, ..)) => start,
            Err(message) => {
                if let Some(more) = log_ending("no advice") {
                    tracing::warn!("advice on {}: {message}{more}", asked.leading.alarm.name());
                }
                return self.advisor.give_up(asked);
            }
        };
        let (began, threads) = (Instant::now(), config.look_ahead.threads as usize);
        let tested = search(&start, &asked.leading, ADVICE_SEED, threads, &stop);
        if stop.load(Ordering::Relaxed) {
            return;
        }
        let alarm = asked.leading.alarm.name();
        if let Some(more) = log_ending(format!("advice on {alarm}")) {
            tracing::info!(
                "advice on {alarm} after {:.1} s: {}{more}",
                began.elapsed().as_secs_f64(),
                tested.map_or_else(
                    || "no change of speed or weight within the limits ends it in 9 of 10 runs".to_owned(),
                    |tested| tested.to_string()
                )
            );
        }
        self.advisor.answer(asked, tested, began.elapsed());
    }

    /// Forecasts the next minute, once that is due at `at`. A forecast that a goal or a search stops is made later.
    fn forecast(&self, tool: &mut Option<Simulation>, at: &mut Instant) {
        let Some(forecasts) = &self.forecasts else {
            return;
        };
        // A fork of a failed or paused run would forecast a motion that does not take place.
        if self.gauges.run_state() != RunState::Running {
            return forecasts.note(Busy::StandsStill);
        }
        if Instant::now() < *at {
            return;
        }
        // The flag comes before the check below: between them a goal can
        // only come that sees the flag and stops this forecast.
        forecasts.note(Busy::Forecast);
        let stop = self.advisor.forecasts();
        // A goal that came before the flag was there is not kept waiting, and neither is the end of the node.
        if self.what_if.is_ending() || (self.what_if.is_open() && !self.advisor.is_kept()) {
            return;
        }
        let began = Instant::now();
        let config = self.control.config();
        let settings = &config.look_ahead;
        let issued = match self.start(&config, tool) {
            Ok((start, applied, ticks)) => {
                let threads = settings.threads as usize;
                let found = forecast(&start, settings.forecast_members, FORECAST_SEED, threads, &stop);
                let Some(found) = found else { return };
                // The forecast belongs to the instant of its fork. Viewers compare step and targets with the present
                // ones, and see when it no longer applies.
                Issued {
                    ticks,
                    step: applied.step,
                    targets: [applied.inputs.rotary_speed, applied.inputs.weight_on_bit],
                    forecast: Ok(found),
                }
            }
            // A forecast that could not be made is issued too, because the page must not keep showing the last one.
            Err(why) => {
                if let Some(more) = log_ending("no forecast") {
                    tracing::warn!("forecast: {why}{more}");
                }
                Issued {
                    ticks: self.gauges.ticks.load(Ordering::Relaxed),
                    step: self.gauges.step.load(Ordering::Relaxed),
                    targets: [f64::NAN; 2],
                    forecast: Err(why),
                }
            }
        };
        tracing::debug!("forecast after {:.1} s", began.elapsed().as_secs_f64());
        forecasts.put(issued);
        // The interval counts from the beginning, so that the computing time is part of it.
        *at = began + FORECAST_INTERVAL;
    }

    /// The instant after so many ticks on the rig's clock.
    fn stamp(&self, ticks: u64, config: &Config) -> Time {
        let begin = self.gauges.start().unwrap_or_default();
        let passed = (ticks as f64 * config.solver.time_step * 1e9).round() as i64;
        Time::from_nanoseconds(begin.saturating_add(passed))
    }
}
