//! Drives a run as fast as possible and records what the node would have published.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context as _, bail};

use super::log::LogPlace;
use super::look_ahead::LookAhead;
use super::sink::{BagSink, WriteError};
use super::summary::Tally;
use crate::alarms::{AlarmBook, Unknown};
use crate::bag::{Recorder, Recording, Topic};
use crate::cli::signals;
use crate::cli::source::FromRig;
use crate::ensemble::{Ensemble, Generation, Pace, Running};
use crate::field_log::LogRows;
use crate::messages::to_cdr;
use crate::messages::topics::{self, Cadence, TopicInfo};
use crate::residuals::{self, Samples};
use crate::rig_inputs::Surveys;
use crate::safe_window::SafeWindow;
use crate::session::{Host as _, Session};
use flexdrill_config::{Config, Members, Rates};
use flexdrill_core::dynamics::{StepFailure, StepOutcome};
use flexdrill_core::twin::{Frame, Output, Run, RunInputs, Simulation, SimulationSettings};
use flexdrill_hole::Survey;
use flexdrill_life::LivingJoints;
use flexdrill_outputs::{Encoded, ParameterChange, schedule};
use flexdrill_realtime::monotonic;
use flexdrill_uncertainty::Posterior;

/// The topics of a replay: all that do not depend on wall-clock time.
fn replayed() -> impl Iterator<Item = &'static TopicInfo> {
    topics::ALL
        .iter()
        .filter(|topic| topic.cadence != Cadence::Received)
        .filter(|topic| ![topics::STATUS.name, topics::DIAGNOSTICS.name].contains(&topic.name))
}

/// Interval at which the worst moments of the alarms are taken for the summary (ns): as often as lists are published, so
/// that a report of the bag has the same ones.
const MOMENTS_TAKEN: i64 = 1_000_000_000;

/// A run that is recorded into a bag.
pub(super) struct Player {
    run: Run,
    session: Session,
    sink: BagSink,
    /// Instant of the run's first step (ns since 1970).
    start: i64,
    /// Publishing rates at the start: no output is recorded less often.
    initial_rates: Rates,
    frame: Frame,
    /// When the alarms' worst moments were last taken (ns since 1970).
    listed: Option<i64>,
    /// A signal sets it, where signals are caught.
    stop: Arc<AtomicBool>,
}

impl Player {
    /// Builds the model and creates the bag. `start` is in ns since 1970, as are the times of what came `from_rig`; speed and
    /// weight are judged by `window`, where there is a map; `name` makes topics absolute.
    pub(super) fn new(
        config: Config,
        start: i64,
        from_rig: FromRig,
        window: Option<Arc<SafeWindow>>,
        out: &Path,
        name: impl Fn(&TopicInfo) -> String,
    ) -> anyhow::Result<Self> {
        let settings = config.simulation();
        Self::with_settings(config, &settings, start, from_rig, window, out, name)
    }

    /// The same with other settings than those of the configuration.
    pub(super) fn with_settings(
        config: Config,
        settings: &SimulationSettings,
        start: i64,
        mut from_rig: FromRig,
        window: Option<Arc<SafeWindow>>,
        out: &Path,
        name: impl Fn(&TopicInfo) -> String,
    ) -> anyhow::Result<Self> {
        from_rig.measured.retain(|sample| sample.time >= start);
        from_rig.inputs.retain(|(time, _)| *time >= start);
        from_rig.surveys.retain(|sample| sample.time >= start);
        let mut rows = LogRows::default();
        let inputs = from_rig.inputs.iter();
        inputs.for_each(|(time, message)| rows.push(*time, &message.source));
        // A topic without messages is not announced: a viewer would wait for it.
        let given = [
            (!from_rig.measured.is_empty()).then_some(&topics::RIG_MEASURED),
            (!from_rig.inputs.is_empty()).then_some(&topics::RIG_INPUTS),
            (!from_rig.surveys.is_empty()).then_some(&topics::RIG_SURVEY),
        ];
        let topics: Vec<_> = replayed().chain(given.into_iter().flatten()).collect();
        let recorded: Vec<Topic> = topics
            .iter()
            .map(|topic| Topic::new(name(topic), &topic.kind, topic.qos))
            .collect();
        let recorder = Recorder::create(out, &recorded)?;
        // The clock measures the time per step only. The simulation itself reads none, which keeps the replay exact.
        let mut simulation = Simulation::new(&config.tool(), settings)?;
        simulation.set_clock(monotonic::now);
        let run = Run::new(simulation, schedule(&config, &config.outputs.rates));
        let initial_rates = config.outputs.rates;
        let config = Arc::new(config);
        let tally = Tally::of_log(LogPlace { rows, start });
        let mut sink = BagSink::new(recorder, topics, from_rig, Surveys::new(&config), tally);
        let mut session = Session::new(Arc::clone(&config), AlarmBook::fresh(config, start));
        if let Some(window) = window {
            session.judge_by(window);
        }
        session.begin(start, &mut sink)?;
        Ok(Self {
            frame: run.new_frame(),
            run,
            session,
            sink,
            start,
            initial_rates,
            listed: None,
            stop: Arc::default(),
        })
    }

    /// Runs plausible tools with the twin: those of a recorded run, or where none is given as many as the configuration asks
    /// for by a number, drawn from the posterior that the configuration names. Call it before the first inputs.
    ///
    /// # Errors
    /// When nothing can be drawn, or there is no thread for them.
    pub(super) fn run_ensemble(
        &mut self,
        recorded: Vec<Generation>,
        posterior: Option<Arc<Posterior>>,
    ) -> anyhow::Result<()> {
        if recorded.is_empty() && !asks_for_members(self.config()) {
            return Ok(());
        }
        if let Some(ensemble) = Ensemble::of(self.session.config(), posterior)? {
            self.session.run_with(Running::start(ensemble, Pace::Waits(recorded))?);
        }
        Ok(())
    }

    /// Searches for advice and forecasts as the configuration asks. Call it before the first inputs.
    pub(super) fn look_ahead(&mut self) {
        self.sink.look_ahead = LookAhead::of(self.config());
    }

    /// From now on a signal ends the run instead of the process, so that the bag gets its end.
    ///
    /// # Errors
    /// When signals cannot be caught.
    pub(super) fn end_by_signal(&mut self) -> anyhow::Result<()> {
        self.stop = signals::stop_recording().context("signals cannot be caught")?;
        Ok(())
    }

    /// Whether a signal has requested the end.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Compares the run at these stamps (ns since 1970), the oldest first, with what a recorded run was compared with,
    /// instead of with the measured values.
    pub(super) fn compare_with(&mut self, samples: impl IntoIterator<Item = (i64, Samples)>) {
        self.sink.compare_with(samples);
    }

    /// Takes the surveys that a recorded run knew from these instants on (ns since 1970), the oldest first, instead of those that
    /// the rig sent.
    pub(super) fn survey_with(&mut self, surveys: impl IntoIterator<Item = (i64, Arc<[Survey]>)>) {
        self.sink.survey_with(surveys);
    }

    /// Continues the lives of the joints. Call it before the first inputs.
    pub(super) fn continue_lives(&mut self, lives: LivingJoints) {
        self.session.continue_lives(lives);
    }

    /// The parameters that are to follow the rig from now on, as changes; none where none moves. A recorded run has them
    /// among its inputs.
    pub(super) fn take_followed(&mut self) -> Vec<ParameterChange> {
        let moved = self.sink.moved.take();
        moved.map_or_else(Vec::new, |[from, to]| residuals::changes(from, to))
    }

    /// Steps taken since the start or the last reset.
    pub(super) fn step(&self) -> u64 {
        self.run.simulation().step()
    }

    /// Model time of a step (s).
    pub(super) fn time_of(&self, step: u64) -> f64 {
        step as f64 * self.config().solver.time_step
    }

    /// Stations of the joints, top to bottom.
    pub(super) fn joint_stations(&self) -> &[usize] {
        self.run.simulation().joint_stations()
    }

    /// The inputs in force.
    pub(super) fn inputs(&self) -> RunInputs {
        self.run.applied()
    }

    /// The refinement of steps that the motion requires. A replay always grants it, because it has no deadline.
    pub(super) fn wanted_refinement(&self) -> u32 {
        self.run.wanted_refinement()
    }

    /// Adopts a configuration that these requests have changed.
    pub(super) fn reconfigure(&mut self, config: Config, changes: &[ParameterChange]) {
        if let Some(look_ahead) = &mut self.sink.look_ahead {
            look_ahead.reconfigure(&config);
        }
        self.session.reconfigure(&Arc::new(config), changes);
    }

    /// Publishing rates at the start.
    pub(super) fn initial_rates(&self) -> &Rates {
        &self.initial_rates
    }

    pub(super) fn config(&self) -> &Config {
        self.session.config()
    }

    /// Applies new inputs. At the start and after a reset it also records the state.
    pub(super) fn apply(&mut self, inputs: &RunInputs, changes: &[ParameterChange], first: bool) -> anyhow::Result<()> {
        self.run.apply(inputs);
        if let Some(look_ahead) = &mut self.sink.look_ahead {
            look_ahead.ask(inputs);
        }
        let ticks = self.run.ticks();
        self.session.applied(inputs, changes, ticks, &mut self.sink)?;
        if inputs.reset {
            self.sink.tally.resets += 1;
        }
        if first || inputs.reset { self.capture() } else { Ok(()) }
    }

    /// Takes which of the rig's values are not known.
    pub(super) fn set_unknown(&mut self, unknown: Unknown) {
        self.session.alarms_mut().set_unknown(unknown);
    }

    /// Takes one step.
    ///
    /// # Errors
    /// When the step fails or the bag cannot be written.
    pub(super) fn advance(&mut self) -> anyhow::Result<Result<(), StepFailure>> {
        match self.run.advance() {
            StepOutcome::Advanced { iterations, halvings } => {
                self.sink.tally.step(iterations, halvings);
                self.capture()?;
                Ok(Ok(()))
            }
            StepOutcome::Failed(failure) => Ok(Err(failure)),
        }
    }

    /// Takes one step; a failed step is an error.
    pub(super) fn advance_or_fail(&mut self) -> anyhow::Result<()> {
        if let Err(failure) = self.advance()? {
            bail!(
                "step {} at model time {:.4} s failed: {}; the bag holds the replay up to there",
                self.step(),
                failure.time,
                failure
            );
        }
        Ok(())
    }

    fn capture(&mut self) -> anyhow::Result<()> {
        let ticks = self.run.ticks();
        let stamp = self.session.instant(ticks).unwrap_or(self.start);
        self.record_from_rig(stamp)?;
        if self.run.due().is_empty() {
            return Ok(());
        }
        self.run.capture(&mut self.frame);
        self.sink.tally.observe(&self.frame.snapshot);
        let began = monotonic::now();
        let judges = self.frame.due.has(Output::Alarms);
        if judges {
            // A replay has no other clock than the run's, so requests and lists follow it, too.
            self.session.alarms_mut().advance(stamp);
        }
        if let Some(look_ahead) = &mut self.sink.look_ahead {
            look_ahead.observe(&self.frame);
        }
        self.session.frame(&self.frame, &mut self.sink)?;
        if judges {
            // The hole ahead has an alarm, whose event is of this instant.
            self.session.publish_hole(true, &mut self.sink)?;
            self.publish_alarms(stamp)?;
            self.session.publish_bands(false, &mut self.sink)?;
        }
        self.sink.tally.publishing(monotonic::now().saturating_sub(began));
        if judges {
            self.answer(stamp)?;
        }
        Ok(())
    }

    /// Has the look-ahead answer what is due, and records its forecast.
    fn answer(&mut self, stamp: i64) -> Result<(), WriteError> {
        let Some(look_ahead) = &mut self.sink.look_ahead else {
            return Ok(());
        };
        look_ahead.answer(&self.run, &self.session, &self.stop);
        // The answer has waited for plausible tools: what they have come to by now is the same in each replay.
        self.session.publish_bands(false, &mut self.sink)?;
        let look_ahead = self.sink.look_ahead.as_mut();
        let Some(forecast) = look_ahead.and_then(|look_ahead| look_ahead.take(&self.session)) else {
            return Ok(());
        };
        self.sink.send(Encoded {
            topic: &topics::FORECAST,
            stamp,
            cdr: &to_cdr(&forecast)?,
        })
    }

    /// Publishes the alarms at an instant of the run (ns since 1970), and takes them for the summary.
    fn publish_alarms(&mut self, stamp: i64) -> anyhow::Result<()> {
        let header = self.session.header(stamp);
        let events = self.session.publish_alarms(header.clone(), stamp, &mut self.sink)?;
        let alarms = &mut self.sink.tally.alarms;
        let changed = !events.is_empty();
        alarms.add((stamp - self.start) as f64 * 1e-9, events);
        if changed || self.listed.is_none_or(|at| stamp - at >= MOMENTS_TAKEN) {
            self.listed = Some(stamp);
            alarms.worsen(&self.session.alarms().list(header).alarms);
        }
        Ok(())
    }

    /// Records what the rig sent up to an instant (ns since 1970), and keeps what it measured for the comparison.
    ///
    /// # Errors
    /// When the bag cannot be written.
    pub(super) fn record_from_rig(&mut self, until: i64) -> anyhow::Result<()> {
        let max_skew = self.session.config().inputs.stamp.max_skew;
        Ok(self.sink.record_from_rig(until, self.start, max_skew)?)
    }

    /// Ends the bag.
    pub(super) fn finish(mut self) -> anyhow::Result<(Recording, Tally)> {
        self.session.publish_bands(true, &mut self.sink)?;
        let (recorder, mut tally) = self.sink.end();
        tally.alarms.finish(self.session.alarms().figures());
        tally.phases(self.run.simulation().phase_times());
        let recording = recorder.finish().context("the bag could not be finished")?;
        Ok((recording, tally))
    }
}

/// Whether a configuration asks for a number of plausible tools. `auto` is for a run by a clock: as many as it leaves time
/// for.
pub(super) fn asks_for_members(config: &Config) -> bool {
    let members = config.ensemble.as_ref().map(|ensemble| ensemble.members);
    matches!(members, Some(Members::Count(_)))
}
