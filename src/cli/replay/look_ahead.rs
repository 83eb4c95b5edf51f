//! Advice and forecasts of a replay: what a node would say that has its answers at once.
//!
//! The run waits for each answer, so that a replay of the same inputs has the same ones. A node has them some time later, by
//! the speed of its machine.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::ahead::{
    ADVICE_SEED, Acting, Advisor, FORECAST_INTERVAL, FORECAST_SEED, ForecastDesk, Forecasts, InForce, Issued, SetPoint,
    Start, forecast, keep_priority, search, tools_in_which,
};
use crate::alarms::AlarmBook;
use crate::cli::output::tell;
use crate::session::Session;
use flexdrill_config::Config;
use flexdrill_core::twin::{Frame, Output, Run, RunInputs};
use flexdrill_messages as messages;
use flexdrill_text::fixed;

/// When the first forecast is due (s of the run): what is set is the median of ten seconds, and nothing is at their
/// beginning.
const BEGINS: f64 = 10.0;

/// The look-ahead of a replay.
pub(super) struct LookAhead {
    /// None where the configuration asks for no advice.
    advisor: Option<Advisor>,
    /// None where it asks for no forecasts.
    forecasts: Option<Forecasting>,
    /// The parameters in force that advice depends on.
    parameters: InForce,
    /// What the driller has set.
    set_point: SetPoint,
    time_step: f64,
    /// Time of the newest frame (s of the run).
    now: f64,
}

/// The forecasts of a replay.
struct Forecasting {
    desk: ForecastDesk,
    issued: Arc<Forecasts>,
    /// When the next one is due (s of the run).
    due: f64,
}

impl LookAhead {
    /// What this configuration asks of the look-ahead; `None` where it asks for nothing.
    pub(super) fn of(config: &Config) -> Option<Self> {
        let asked = &config.look_ahead;
        if !(asked.advice || asked.forecast) {
            return None;
        }
        // A replay has no deadline that its members could miss.
        keep_priority();
        Some(Self {
            advisor: asked.advice.then(Advisor::default),
            forecasts: asked.forecast.then(|| {
                let issued = Arc::<Forecasts>::default();
                Forecasting {
                    desk: ForecastDesk::new(Arc::clone(&issued), config, 0.0),
                    issued,
                    due: BEGINS,
                }
            }),
            parameters: InForce::of(config),
            set_point: SetPoint::new(&config.inputs),
            time_step: config.solver.time_step,
            now: 0.0,
        })
    }

    /// Adopts the parameters of a changed configuration.
    pub(super) fn reconfigure(&mut self, config: &Config) {
        self.parameters = InForce::of(config);
    }

    /// Takes what is asked for from now on.
    pub(super) fn ask(&mut self, inputs: &RunInputs) {
        if let Some(forecasts) = &mut self.forecasts {
            forecasts.desk.ask(inputs);
        }
    }

    /// Takes a frame, before its alarms are judged.
    pub(super) fn observe(&mut self, frame: &Frame) {
        self.now = frame.ticks as f64 * self.time_step;
        if frame.due.has(Output::Alarms) {
            self.set_point.take(self.now, &frame.snapshot.applied);
        }
        if let Some(forecasts) = &mut self.forecasts {
            forecasts.desk.observe(frame);
        }
    }

    /// Gives the alarms that stand what was found for them.
    pub(super) fn advise(&self, alarms: &mut AlarmBook) {
        if let Some((advisor, set)) = self.advisor.as_ref().zip(self.set_point.inputs()) {
            advisor.advise(alarms, &Acting::new(set, &self.parameters), self.now);
        }
    }

    /// Searches for advice and makes the forecast, as far as they are due, from the present state of a run. What `stop` ends has no
    /// answer.
    pub(super) fn answer(&mut self, run: &Run, session: &Session, stop: &AtomicBool) {
        self.search(run, session, stop);
        self.forecast(run, session, stop);
    }

    /// The forecast that is to be published, once the session has published what plausible tools have come to.
    pub(super) fn take(&mut self, session: &Session) -> Option<messages::Forecast> {
        let forecasts = self.forecasts.as_mut()?;
        let frame_id = &session.config().outputs.frame_id;
        let instant = |ticks| session.instant(ticks).unwrap_or_default();
        let tools = session.seconds_of_tools();
        forecasts.desk.take(self.now, frame_id, tools, instant)
    }

    /// The state of a run under what the driller has set.
    fn start(&self, run: &Run, session: &Session) -> Start {
        let twin = Start::new(Arc::clone(session.config()), run.simulation().fork(), &run.applied());
        twin.about(&self.set_point)
    }

    fn search(&self, run: &Run, session: &Session, stop: &AtomicBool) {
        // Within seconds of a change what counts as set is what was set before: a node ends such a search with the change.
        if !self.set_point.is_settled() {
            return;
        }
        // A flag of the advisor's ends a search in a node whose alarms change meanwhile. Here they wait.
        let due = self
            .advisor
            .as_ref()
            .and_then(|advisor| Some((advisor, advisor.due(self.now)?)));
        let Some((advisor, (asked, _))) = due else {
            return;
        };
        let alarm = asked.leading.alarm;
        let tools = session.plausible_tools();
        let tools = tools.map(|tools| tools.and_then(|tools| tools_in_which(tools, alarm)));
        let start = self.start(run, session);
        let at = fixed(self.now, 1);
        let start = match tools {
            Some(Ok(tools)) => start.among(tools, ADVICE_SEED, &self.set_point),
            Some(Err(why)) => {
                tell!(
                    "at {at} s: advice on {} is from runs of the twin alone: {why}",
                    alarm.name()
                );
                start
            }
            None => start,
        };
        let threads = session.config().look_ahead.threads as usize;
        match search(&start, &asked.leading, ADVICE_SEED, threads, stop, |_| ()) {
            Some(searched) => {
                tell!("at {at} s: advice on {} after {searched}", alarm.name());
                advisor.answer(asked, searched.tested);
            }
            None => advisor.give_up(asked),
        }
    }

    fn forecast(&mut self, run: &Run, session: &Session, stop: &AtomicBool) {
        let now = self.now;
        let is_due = self.forecasts.as_ref().is_some_and(|forecasts| now >= forecasts.due);
        if !is_due || !self.set_point.is_settled() {
            return;
        }
        let start = self.start(run, session);
        let set = RunInputs {
            step: run.applied().step,
            ..start.applied()
        };
        let settings = &session.config().look_ahead;
        let (mut ticks, mut step) = (run.ticks(), set.step);
        let start = match session.plausible_tools() {
            Some(Ok(tools)) => {
                // Their state is that of the last slice that they have come to.
                let of_tools = (tools.time / self.time_step).round() as u64;
                step = step.saturating_sub(ticks.saturating_sub(of_tools));
                ticks = of_tools;
                start.among(tools, FORECAST_SEED, &self.set_point)
            }
            // Why they are not, as in their first minute, the bands say.
            Some(Err(_)) | None => start,
        };
        let threads = settings.threads as usize;
        let found = forecast(&start, settings.forecast_members, FORECAST_SEED, threads, stop);
        if let Some((forecasts, found)) = self.forecasts.as_mut().zip(found) {
            forecasts.issued.put(Issued {
                ticks,
                step,
                targets: [set.inputs.rotary_speed, set.inputs.weight_on_bit],
                forecast: Ok(found),
            });
            forecasts.due = now + FORECAST_INTERVAL;
        }
    }
}
