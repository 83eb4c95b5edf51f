//! Drives a run as fast as possible and records what the node would have published.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context as _, bail};

use super::log::LogPlace;
use super::summary::Tally;
use crate::alarms::{AlarmBook, Unknown};
use crate::bag::{BagError, Recorder, Recording, Topic};
use crate::cli::output::tell;
use crate::cli::source::{FromRig, MeasuredSample};
use crate::compare::{self, RigComparison, Samples};
use crate::field_log::LogRows;
use crate::messages::topics::{self, Cadence, TopicInfo};
use crate::messages::{CdrError, RigInputs, to_cdr};
use crate::rig_inputs::Measured;
use flexdrill_config::{Config, Rates};
use flexdrill_core::dynamics::{StepFailure, StepOutcome};
use flexdrill_core::twin::{Frame, Output, Run, RunInputs, Simulation, SimulationSettings};
use flexdrill_outputs::{Encoded, Outputs, ParameterChange, schedule};
use flexdrill_realtime::monotonic;

/// The topics of a replay: all that do not depend on wall-clock time.
fn replayed() -> impl Iterator<Item = &'static TopicInfo> {
    topics::ALL
        .iter()
        .filter(|topic| topic.cadence != Cadence::Received)
        .filter(|topic| ![topics::STATUS.name, topics::DIAGNOSTICS.name].contains(&topic.name))
}

#[derive(Debug, thiserror::Error)]
enum WriteError {
    #[error(transparent)]
    Cdr(#[from] CdrError),
    #[error(transparent)]
    Bag(#[from] BagError),
}

/// Interval at which the worst moments of the alarms are taken for the summary (ns): as often as lists are published, so
/// that a report of the bag has the same ones.
const MOMENTS_TAKEN: i64 = 1_000_000_000;

/// Refused messages of measured values that are reported one by one.
const REFUSALS_SHOWN: u64 = 10;

/// What the rig measured, for the comparison with the twin.
enum RigSource {
    /// The newest values, as a node keeps them.
    Received(Box<Measured>),
    /// What a recorded run was compared with, by stamp (ns since 1970), the oldest first.
    Recorded(VecDeque<(i64, Samples)>),
}

/// A run that is recorded into a bag.
pub(super) struct Player {
    run: Run,
    config: Config,
    /// Publishing rates at the start: no output is recorded less often.
    initial_rates: Rates,
    frame: Frame,
    outputs: Outputs,
    alarms: AlarmBook,
    rig: RigComparison,
    source: RigSource,
    /// Values of what follows the rig, in force and to be, since they were taken last.
    moved: Option<[[f64; 2]; 2]>,
    recorder: Recorder,
    topics: Vec<&'static TopicInfo>,
    /// What the rig measured, not yet in the bag, the newest first.
    measured: Vec<MeasuredSample>,
    /// The inputs as the rig or the log gave them, not yet in the bag, the newest first.
    received: Vec<(i64, RigInputs)>,
    /// When the alarms' worst moments were last taken (ns since 1970).
    listed: Option<i64>,
    /// The summary that is printed at the end.
    pub tally: Tally,
}

impl Player {
    /// Builds the model and creates the bag. `start` is in ns since 1970, as are the times of what came `from_rig`; `name`
    /// makes topics absolute.
    pub(super) fn new(
        config: Config,
        start: i64,
        from_rig: FromRig,
        out: &Path,
        name: impl Fn(&TopicInfo) -> String,
    ) -> anyhow::Result<Self> {
        let settings = config.simulation();
        Self::with_settings(config, &settings, start, from_rig, out, name)
    }

    /// The same with other settings than those of the configuration.
    pub(super) fn with_settings(
        config: Config,
        settings: &SimulationSettings,
        start: i64,
        from_rig: FromRig,
        out: &Path,
        name: impl Fn(&TopicInfo) -> String,
    ) -> anyhow::Result<Self> {
        let FromRig {
            inputs: mut received,
            mut measured,
        } = from_rig;
        // Both lists are reversed, so that the next message is taken from the end without moving the others.
        measured.retain(|sample| sample.time >= start);
        measured.reverse();
        received.retain(|(time, _)| *time >= start);
        let mut rows = LogRows::default();
        received
            .iter()
            .for_each(|(time, message)| rows.push(*time, &message.source));
        received.reverse();
        // A topic without messages is not announced: a viewer would wait for it.
        let given = [
            (!measured.is_empty()).then_some(&topics::RIG_MEASURED),
            (!received.is_empty()).then_some(&topics::RIG_INPUTS),
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
        let mut player = Self {
            frame: run.new_frame(),
            run,
            outputs: Outputs::new(&config, start),
            rig: RigComparison::new(&config),
            source: RigSource::Received(Box::default()),
            moved: None,
            alarms: AlarmBook::fresh(Arc::new(config.clone()), start),
            initial_rates: config.outputs.rates,
            config,
            recorder,
            topics,
            measured,
            received,
            listed: None,
            tally: Tally::of_log(LogPlace { rows, start }),
        };
        let (hash, yaml) = (player.config.hash(), player.config.to_yaml()?);
        // The session comes first in the recording, since all other messages refer to its configuration.
        let (recorder, topics) = (&mut player.recorder, &player.topics);
        player
            .outputs
            .session(&hash, &yaml, |encoded| write(recorder, topics, encoded))?;
        Ok(player)
    }

    /// Compares the run at these stamps (ns since 1970), the oldest first, with what a recorded run was compared with,
    /// instead of with the measured values.
    pub(super) fn compare_with(&mut self, samples: impl IntoIterator<Item = (i64, Samples)>) {
        self.source = RigSource::Recorded(samples.into_iter().collect());
    }

    /// The parameters that are to follow the rig from now on, as changes; none where none moves. A recorded run has them
    /// among its inputs.
    pub(super) fn take_followed(&mut self) -> Vec<ParameterChange> {
        let moved = self.moved.take();
        moved.map_or_else(Vec::new, |[from, to]| compare::changes(from, to))
    }

    /// Steps taken since the start or the last reset.
    pub(super) fn step(&self) -> u64 {
        self.run.simulation().step()
    }

    /// Model time of a step (s).
    pub(super) fn time_of(&self, step: u64) -> f64 {
        step as f64 * self.config.solver.time_step
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
        self.outputs.reconfigure(&config);
        self.alarms.reconfigure(&Arc::new(config.clone()), changes);
        self.rig.reconfigure(&config);
        self.config = config;
    }

    /// Publishing rates at the start.
    pub(super) fn initial_rates(&self) -> &Rates {
        &self.initial_rates
    }

    pub(super) fn config(&self) -> &Config {
        &self.config
    }

    /// Applies new inputs. At the start and after a reset it also records the state.
    pub(super) fn apply(&mut self, inputs: &RunInputs, changes: &[ParameterChange], first: bool) -> anyhow::Result<()> {
        self.run.apply(inputs);
        let ticks = self.run.ticks();
        let (recorder, topics) = (&mut self.recorder, &self.topics);
        self.outputs
            .applied(inputs, changes, ticks, |encoded| write(recorder, topics, encoded))?;
        if inputs.reset {
            self.tally.resets += 1;
            self.rig.restart();
        }
        if first || inputs.reset { self.capture() } else { Ok(()) }
    }

    /// Takes which of the rig's values are not known.
    pub(super) fn set_unknown(&mut self, unknown: Unknown) {
        self.alarms.set_unknown(unknown);
    }

    /// Takes one step.
    ///
    /// # Errors
    /// When the step fails or the bag cannot be written.
    pub(super) fn advance(&mut self) -> anyhow::Result<Result<(), StepFailure>> {
        match self.run.advance() {
            StepOutcome::Advanced { iterations, halvings } => {
                self.tally.step(iterations, halvings);
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
        self.record_from_rig(self.outputs.instant(self.run.ticks()))?;
        if self.run.due().is_empty() {
            return Ok(());
        }
        self.run.capture(&mut self.frame);
        self.tally.observe(&self.frame.snapshot);
        let (recorder, topics) = (&mut self.recorder, &self.topics);
        let began = monotonic::now();
        self.outputs
            .frame(&self.frame, |encoded| write(recorder, topics, encoded))?;
        if self.frame.due.has(Output::Alarms) {
            let (header, stamp) = (
                self.outputs.header_at(self.frame.ticks),
                self.outputs.instant(self.frame.ticks),
            );
            self.alarms.advance(stamp);
            self.alarms.observe_tool(&self.frame.snapshot, stamp);
            self.compare_with_rig(stamp)?;
            let (recorder, topics) = (&mut self.recorder, &self.topics);
            let events = self
                .alarms
                .publish(header, stamp, |encoded| write(recorder, topics, encoded))?;
            let run = (stamp - self.outputs.instant(0)) as f64 * 1e-9;
            let changed = !events.is_empty();
            self.tally.alarms.add(run, events);
            if changed || self.listed.is_none_or(|at| stamp - at >= MOMENTS_TAKEN) {
                self.listed = Some(stamp);
                let list = self.alarms.list(self.outputs.header_at(self.frame.ticks));
                self.tally.alarms.worsen(&list.alarms);
            }
        }
        self.tally.publishing(monotonic::now().saturating_sub(began));
        Ok(())
    }

    /// Compares the frame with what the rig has measured, once per second of model time.
    fn compare_with_rig(&mut self, stamp: i64) -> anyhow::Result<()> {
        let samples = match &mut self.source {
            RigSource::Received(measured) => self
                .rig
                .is_due(self.frame.ticks)
                .then(|| self.rig.samples(measured, stamp)),
            RigSource::Recorded(samples) => {
                while samples.front().is_some_and(|(at, _)| *at < stamp) {
                    samples.pop_front();
                }
                samples.pop_front_if(|(at, _)| *at == stamp).map(|(_, samples)| samples)
            }
        };
        let Some(samples) = samples else { return Ok(()) };
        let header = self.outputs.header_at(self.frame.ticks);
        let Some(comparison) = self.rig.compare(&self.frame, &samples, header) else {
            return Ok(());
        };
        let encoded = Encoded {
            topic: &topics::RESIDUALS,
            stamp,
            cdr: &to_cdr(&comparison.message)?,
        };
        write(&mut self.recorder, &self.topics, encoded)?;
        self.alarms
            .observe_rig(&comparison.compared, &comparison.followed(), samples.bit_depth, stamp);
        self.alarms.observe_adjusted(&comparison.message, stamp);
        self.tally.rig.observe(&comparison.message);
        if let Some(stopped) = comparison.stopped {
            tell!("calibration.follow: {stopped}; it follows no further");
        }
        self.moved = comparison.moved;
        Ok(())
    }

    /// Records what the rig sent up to an instant (ns since 1970), and keeps what it measured for the comparison.
    ///
    /// # Errors
    /// When the bag cannot be written.
    pub(super) fn record_from_rig(&mut self, until: i64) -> anyhow::Result<()> {
        while let Some((stamp, message)) = self.received.pop_if(|(time, _)| *time <= until) {
            let encoded = Encoded {
                topic: &topics::RIG_INPUTS,
                stamp,
                cdr: &to_cdr(&message)?,
            };
            write(&mut self.recorder, &self.topics, encoded)?;
        }
        while let Some(sample) = self.measured.pop_if(|sample| sample.time <= until) {
            if let RigSource::Received(measured) = &mut self.source {
                let since_start = sample.time.saturating_sub(self.outputs.instant(0)) as f64 * 1e-9;
                let skew = self.config.inputs.stamp.max_skew;
                let accepted = measured.accept(&sample.message, sample.time, since_start, skew);
                let [_, refused, ..] = measured.counts();
                match accepted {
                    Err(why) if refused <= REFUSALS_SHOWN => tell!("at {since_start:.2} s: {why}"),
                    _ => {}
                }
            }
            let encoded = Encoded {
                topic: &topics::RIG_MEASURED,
                stamp: sample.time,
                cdr: &to_cdr(&sample.message)?,
            };
            write(&mut self.recorder, &self.topics, encoded)?;
        }
        Ok(())
    }

    /// Ends the bag.
    pub(super) fn finish(mut self) -> anyhow::Result<(Recording, Tally)> {
        if let RigSource::Received(measured) = &self.source {
            let [_, refused, ..] = measured.counts();
            if refused > REFUSALS_SHOWN {
                tell!("{refused} messages of measured values were refused in total");
            }
        }
        self.tally.alarms.finish(self.alarms.figures());
        self.tally.phases(self.run.simulation().phase_times());
        let recording = self.recorder.finish().context("the bag could not be finished")?;
        Ok((recording, self.tally))
    }
}

fn write(recorder: &mut Recorder, topics: &[&TopicInfo], encoded: Encoded<'_>) -> Result<(), WriteError> {
    match topics.iter().position(|topic| topic.name == encoded.topic.name) {
        Some(index) => Ok(recorder.record(index, encoded.stamp, encoded.cdr)?),
        None => Ok(()),
    }
}
