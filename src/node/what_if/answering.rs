//! The thread that answers goals, and between them looks for advice and makes forecasts.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::hole::{holes, with_hole};
use super::{IDLE, Next, WhatIf};
use crate::ahead::{
    ADVICE_SEED, Advisor, Busy, FORECAST_INTERVAL, FORECAST_SEED, Forecasts, Goal, Issued, Start, forecast, look_ahead,
    search, tools_in_which,
};
use crate::alarms::AlarmId;
use crate::ensemble::Forking;
use crate::node::clocks::steady;
use crate::node::control::Control;
use crate::node::inputs::RigInputs;
use crate::node::set_point::SharedSetPoint;
use crate::node::states::SavedRun;
use crate::node::turns::{self, Turn, Turns};
use crate::node::what_if_messages::{feedback, goal, of_candidate, sentence, with_friction};
use flexdrill_config::Config;
use flexdrill_core::twin::{RunInputs, Simulation};
use flexdrill_messages::action_msgs::GoalStatus;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::{WhatIfGoal, WhatIfResult};
use flexdrill_realtime::link::{Gauges, RunState};
use flexdrill_ros2::action::Begun;
use flexdrill_ros2::goal_book::publish;
use flexdrill_text::log_ending;

/// Least time between two feedbacks.
const FEEDBACK_INTERVAL: Duration = Duration::from_millis(100);
/// Factors on the friction of both layers in the extra rows of an answer: a fifth lower and higher. A calibration knows
/// friction to a fifth.
const FRICTION: [f64; 2] = [0.8, 1.2];
/// Most members of such a row: two that see an alarm decide for it, and two that see none show that it is not certain.
const FRICTION_MEMBERS: u32 = 2;

/// What the thread that answers goals works with.
pub struct Answering {
    /// The goals.
    pub what_if: Arc<WhatIf>,
    /// Who has the present state.
    pub control: Arc<Control>,
    /// Where the run is in time.
    pub gauges: Arc<Gauges>,
    /// Who has the surveys of the hole.
    pub inputs: RigInputs,
    /// Who asks for advice on alarms.
    pub advisor: Arc<Advisor>,
    /// Where forecasts go; none where they are off.
    pub forecasts: Option<Arc<Forecasts>>,
    /// What the driller has set.
    pub set_point: Arc<SharedSetPoint>,
    /// Where plausible tools are had from; none where they do not run.
    pub tools: Option<Forking>,
}

/// What a look-ahead begins from.
struct Begins {
    start: Start,
    /// What is set, with the model step of the state.
    set: RunInputs,
    /// Ticks of the state.
    ticks: u64,
    /// Why members are runs of the twin although plausible tools run with it.
    alone: Option<String>,
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
        let twin = self.start(&config, tool)?;
        // The rows of other friction are the twin's own: it has one friction, which plausible tools differ in already.
        let rubbing = FRICTION.map(|factor| twin.start.rubbing(factor));
        let begins = self.among_tools(twin, goal.seed, None);
        let (began, mut told) = (Instant::now(), Instant::now());
        let (mut first, mut stopped_by) = (true, "cancelled");
        let threads = config.look_ahead.threads as usize;
        let mut end = || {
            if turns::is_over(began.elapsed(), self.what_if.is_wanted()) && !begun.stop.load(Ordering::Relaxed) {
                stopped_by = "ended after ten minutes, since other goals wait";
                begun.stop.store(true, Ordering::Relaxed);
            }
        };
        let mut answer = look_ahead(&begins.start, &goal, threads, &begun.stop, |progress| {
            if first || told.elapsed() >= FEEDBACK_INTERVAL {
                (first, told) = (false, Instant::now());
                publish(&self.what_if.feedback, &feedback(begun.id, &progress));
            }
            end();
        });
        let of_friction = Goal {
            members: goal.members.min(FRICTION_MEMBERS),
            ..goal.clone()
        };
        let rows = rubbing.map(|start| look_ahead(&start, &of_friction, threads, &begun.stop, |_| end()));
        answer.stopped |= rows.iter().any(|row| row.stopped);
        // By statics: a second per weight, once the members have ended.
        let holes = holes(&config, &goal.candidates, &self.inputs.surveys(), &begun.stop);
        let candidates = answer.candidates.iter().zip(&holes).enumerate();
        let answers = candidates
            .map(|(index, (of, hole))| {
                let rows = FRICTION
                    .iter()
                    .zip(rows.iter().filter_map(|row| row.candidates.get(index)));
                with_friction(with_hole(of_candidate(of), hole), rows)
            })
            .collect();
        let found = sentence(&answer, &rows.each_ref().map(|row| &row.candidates[..]), stopped_by);
        let before = [
            standing.map(|why| format!("{why}; these runs begin at its present state. ")),
            begins.alone.map(|why| format!("Runs of the twin: {why}. ")),
        ];
        Ok(WhatIfResult {
            from_stamp: self.stamp(begins.ticks, &config),
            from_step: begins.set.step,
            complete: !answer.stopped,
            message: before.into_iter().flatten().chain([found]).collect(),
            answers,
        })
    }

    /// The same with plausible tools as members, where they run with the twin: those in which an alarm stands, where one is
    /// named. They may be a little older than the twin's own state.
    fn among_tools(&self, twin: Begins, seed: u64, in_which: Option<AlarmId>) -> Begins {
        let Some(forking) = &self.tools else { return twin };
        let forks = forking.ask();
        let forks = match in_which {
            Some(alarm) => forks.and_then(|forks| tools_in_which(forks, alarm)),
            None => forks,
        };
        match forks {
            Ok(forks) => {
                let ticks = (forks.time / twin.start.config().solver.time_step).round() as u64;
                let older = twin.ticks.saturating_sub(ticks);
                Begins {
                    start: twin.start.among(forks, seed, &self.set_point.now()),
                    ticks,
                    set: RunInputs {
                        step: twin.set.step.saturating_sub(older),
                        ..twin.set
                    },
                    alone: None,
                }
            }
            Err(why) => Begins {
                alone: Some(why),
                ..twin
            },
        }
    }

    /// The present state of the live run under what the driller has set.
    fn start(&self, config: &Arc<Config>, tool: &mut Option<Simulation>) -> Result<Begins, String> {
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
        let start = start.about(&self.set_point.now());
        let set = RunInputs {
            step: applied.step,
            ..start.applied()
        };
        Ok(Begins {
            start,
            set,
            ticks,
            alone: None,
        })
    }

    /// Looks for the smallest change that ends the alarms that stand, if that is asked for.
    fn advise(&self, tool: &mut Option<Simulation>) {
        let Some((asked, stop)) = self.advisor.due(steady()) else {
            return;
        };
        self.note(Busy::Advice);
        let config = self.control.config();
        // A state that cannot be had ends this question, not the advice on the next alarm.
        let start = match self.start(&config, tool) {
            Ok(begins) => self.among_tools(begins, ADVICE_SEED, Some(asked.leading.alarm)),
            Err(message) => {
                if let Some(more) = log_ending("no advice") {
                    tracing::warn!("advice on {}: {message}{more}", asked.leading.alarm.name());
                }
                return self.advisor.give_up(asked);
            }
        };
        let (began, threads) = (Instant::now(), config.look_ahead.threads as usize);
        let alarm = asked.leading.alarm.name();
        let Begins { start, alone, .. } = start;
        if let Some(why) = alone
            && let Some(more) = log_ending("advice from the twin alone")
        {
            tracing::info!("advice on {alarm} is from runs of the twin alone: {why}{more}");
        }
        // The log has the first answer and the last: how long a driller waits is the time of the first.
        let mut first = None;
        let searched = search(&start, &asked.leading, ADVICE_SEED, threads, &stop, |progress| {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            self.advisor.hear(&asked, &progress, steady());
            if let (None, Some(tested)) = (first, progress.first) {
                first = Some(tested);
                if let Some(more) = log_ending(format!("first advice on {alarm}")) {
                    let (seconds, model) = (began.elapsed().as_secs_f64(), progress.seconds);
                    tracing::info!(
                        "first advice on {alarm} after {seconds:.1} s and {model:.0} s of model time, more runs follow: \
                         {tested}{more}"
                    );
                }
            }
        });
        let Some(searched) = searched.filter(|_| !stop.load(Ordering::Relaxed)) else {
            return;
        };
        if let Some(more) = log_ending(format!("advice on {alarm}")) {
            let seconds = began.elapsed().as_secs_f64();
            tracing::info!("advice on {alarm} after {seconds:.1} s, {searched}{more}");
        }
        self.advisor.answer(asked, searched.tested);
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
        // Within seconds of a change what counts as set is what was set before: a forecast of it would be given up.
        if !self.set_point.is_settled() {
            return forecasts.note(Busy::Changing);
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
            Ok(begins) => {
                let Begins { start, set, ticks, .. } = self.among_tools(begins, FORECAST_SEED, None);
                let threads = settings.threads as usize;
                let found = forecast(&start, settings.forecast_members, FORECAST_SEED, threads, &stop);
                let Some(found) = found else { return };
                // The forecast belongs to the instant of its fork. Viewers compare step and targets with the present
                // ones, and see when it no longer applies.
                Issued {
                    ticks,
                    step: set.step,
                    targets: [set.inputs.rotary_speed, set.inputs.weight_on_bit],
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
        *at = began + Duration::from_secs_f64(FORECAST_INTERVAL);
    }

    /// The instant after so many ticks on the rig's clock.
    fn stamp(&self, ticks: u64, config: &Config) -> Time {
        let begin = self.gauges.start().unwrap_or_default();
        let passed = (ticks as f64 * config.solver.time_step * 1e9).round() as i64;
        Time::from_nanoseconds(begin.saturating_add(passed))
    }
}
