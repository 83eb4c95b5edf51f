//! What the frames and the inputs of a run become: messages, alarms, and the comparison with the rig.
//!
//! A run is driven by a solver's thread, by a replay, by a look-ahead or by Python, and a [`Session`] is the same for each. A
//! host gives what differs, as [`Host`]: where messages are sent, and what the rig has measured. The node is a host with a
//! clock, DDS, recording and viewers; a replay one with a bag. A member of a look-ahead and the twin of the package for Python
//! judge alone, and begin no outputs: the one asks which alarms stand, the other gives their events next to its columns. What
//! is added here is added for all of them, so that a replay repeats the node.

#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::sync::Arc;

use crate::alarms::AlarmBook;
use crate::drilling::live::{Appended, DrilledHole, LiveHole, Point, Ready};
use crate::ensemble::{self, Forks, Found, Running, Told};
use crate::residuals::{Comparison, RigComparison, Samples, predicted};
use crate::safe_window::SafeWindow;
use flexdrill_config::Config;
use flexdrill_core::twin::{Frame, Output, RunInputs, Snapshot};
use flexdrill_hole::Survey;
use flexdrill_life::LivingJoints;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{Ageing, AlarmEvent, Bands, CdrError, Residuals, to_cdr, topics};
use flexdrill_outputs::{Encoded, Outputs, ParameterChange};

/// What a session takes from the program that hosts it.
pub trait Host {
    /// Why a message is not taken.
    type Error: From<CdrError>;

    /// Takes a message.
    ///
    /// # Errors
    /// When it cannot be written or combined with others.
    fn send(&mut self, encoded: Encoded<'_>) -> Result<(), Self::Error>;

    /// What the rig has measured since the last comparison, if the frame at these ticks is compared with it. `stamp` is the
    /// frame's instant (ns since 1970).
    fn measured(&mut self, rig: &mut RigComparison, ticks: u64, stamp: i64) -> Option<Samples>;

    /// The surveys that are known at an instant of the run (ns since 1970), in the order of arrival.
    fn surveys(&mut self, _stamp: i64) -> Arc<[Survey]> {
        Arc::default()
    }

    /// Looks at the alarms once a snapshot has been judged.
    fn judged(&mut self, _alarms: &mut AlarmBook, _snapshot: &Snapshot) {}

    /// Looks at a comparison with the rig.
    fn compared(&mut self, comparison: &Comparison);
}

/// Seconds of plausible tools that are kept for those who look ahead: a forecast begins five seconds after a change at the
/// earliest, and what they did before it says nothing of how they differ now.
const SECONDS_OF_TOOLS: usize = 5;

/// What a run becomes.
pub struct Session {
    config: Arc<Config>,
    alarms: AlarmBook,
    rig: RigComparison,
    /// The newest comparison of rig and twin.
    residuals: Option<Residuals>,
    window: Option<Arc<SafeWindow>>,
    /// Plausible tools under the same inputs.
    ensemble: Option<Running>,
    /// What plausible tools did in their newest seconds, [`SECONDS_OF_TOOLS`] at most, the newest last.
    bands: VecDeque<Bands>,
    /// Ticks and instant at which those of the newest bands began: a clock that is set must not give them another one.
    begun: Option<(u64, i64)>,
    /// Where the tool drills next.
    hole: LiveHole,
    /// Points of the hole from an earlier run, until they are published.
    earlier: Vec<Appended>,
    /// The lives of the joints; none without a table.
    lives: Option<LivingJoints>,
    /// None before the instant of the first step is known, and in a run that publishes nothing.
    outputs: Option<Outputs>,
}

impl Session {
    /// The session of a run with this configuration, with the alarms that it begins with. It publishes no output before
    /// [`Session::begin`].
    pub fn new(config: Arc<Config>, alarms: AlarmBook) -> Self {
        Self {
            rig: RigComparison::new(&config),
            hole: LiveHole::new(&config),
            earlier: Vec::new(),
            lives: None,
            config,
            alarms,
            residuals: None,
            window: None,
            ensemble: None,
            bands: VecDeque::new(),
            begun: None,
            outputs: None,
        }
    }

    /// Judges speed and weight by a map, which [`Session::begin`] publishes.
    pub fn judge_by(&mut self, window: Arc<SafeWindow>) {
        self.alarms.set_window(Arc::clone(&window));
        self.window = Some(window);
    }

    /// Takes plausible tools that run with it; [`Session::publish_bands`] publishes what they do.
    pub fn run_with(&mut self, ensemble: Running) {
        self.ensemble = Some(ensemble);
        self.rig.judge_by_tools();
    }

    /// Begins the outputs of a run whose tick 0 is at `start` (ns since 1970, on the rig's clock): says what the run is.
    ///
    /// # Errors
    /// When a message cannot be encoded, or what the host says.
    pub fn begin<H: Host>(&mut self, start: i64, host: &mut H) -> Result<(), H::Error> {
        let mut outputs = Outputs::new(&self.config, start);
        if let Some(lives) = &mut self.lives {
            lives.begin(start);
        }
        let configuration = self.config.to_yaml().unwrap_or_default();
        // The session is first in a recording, since all other messages refer to its configuration.
        let sent = outputs.session(&self.config.hash(), &configuration, |encoded| host.send(encoded));
        let header = outputs.header_at(0);
        // A run whose first message cannot be sent has begun all the same: its outputs follow.
        self.outputs = Some(outputs);
        sent?;
        let earlier = std::mem::take(&mut self.earlier);
        self.publish_drilled(earlier, start, host)?;
        let Some(window) = &self.window else { return Ok(()) };
        host.send(Encoded {
            topic: &topics::SAFE_WINDOW,
            stamp: start,
            cdr: &to_cdr(&window.message(header))?,
        })
    }

    /// Whether [`Session::begin`] was called.
    pub fn has_begun(&self) -> bool {
        self.outputs.is_some()
    }

    /// The clock of stamps was set: tick 0 is at `start` (ns since 1970) on it.
    pub fn set_start(&mut self, start: i64) {
        if let Some(outputs) = &mut self.outputs {
            outputs.set_start(start);
        }
    }

    /// The instant of a tick (ns since 1970); `None` before the run has begun.
    pub fn instant(&self, ticks: u64) -> Option<i64> {
        Some(self.outputs.as_ref()?.instant(ticks))
    }

    /// The header of a message at an instant (ns since 1970).
    pub fn header(&self, stamp: i64) -> Header {
        Header {
            stamp: Time::from_nanoseconds(stamp),
            frame_id: self.config.outputs.frame_id.clone(),
        }
    }

    /// The configuration in force.
    pub fn config(&self) -> &Arc<Config> {
        &self.config
    }

    /// The alarms.
    pub fn alarms(&self) -> &AlarmBook {
        &self.alarms
    }

    /// The alarms, for what is not of the run: requests, and the state of a node.
    pub fn alarms_mut(&mut self) -> &mut AlarmBook {
        &mut self.alarms
    }

    /// The newest comparison of rig and twin. It is what the rig's alarm is judged by until the next one.
    pub fn residuals(&self) -> Option<&Residuals> {
        self.residuals.as_ref()
    }

    /// Adopts a configuration that these requests have changed while the run goes on.
    pub fn reconfigure(&mut self, config: &Arc<Config>, changes: &[ParameterChange]) {
        self.alarms.reconfigure(config, changes);
        self.rig.reconfigure(config);
        self.hole.reconfigure(config);
        if let Some(outputs) = &mut self.outputs {
            outputs.reconfigure(config);
        }
        self.config = Arc::clone(config);
    }

    /// Publishes the inputs that act from `ticks` on, with the parameters that changed.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn applied<H: Host>(
        &mut self,
        inputs: &RunInputs,
        changes: &[ParameterChange],
        ticks: u64,
        host: &mut H,
    ) -> Result<(), H::Error> {
        if inputs.reset {
            self.rig.restart();
            self.hole.reset();
        }
        if let Some(ensemble) = &self.ensemble {
            ensemble.tell(Told::Applied(ticks, Box::new(*inputs), Arc::clone(&self.config)));
        }
        match &mut self.outputs {
            Some(outputs) => outputs.applied(inputs, changes, ticks, |encoded| host.send(encoded)),
            None => Ok(()),
        }
    }

    /// Publishes what is due with a frame, judges its alarms, and compares it with the rig.
    ///
    /// # Errors
    /// As [`Session::begin`]. The alarms are judged all the same.
    pub fn frame<H: Host>(&mut self, frame: &Frame, host: &mut H) -> Result<(), H::Error> {
        let Some(outputs) = &mut self.outputs else {
            return Ok(());
        };
        let lives = &mut self.lives;
        let complete = |ageing: &mut Ageing| {
            if let Some(lives) = lives {
                lives.complete(ageing);
            }
        };
        let sent = outputs.frame(frame, complete, |encoded| host.send(encoded));
        // Alarms are judged at their rate in model time, so that a replay judges at the same steps.
        if frame.due.has(Output::Alarms) {
            let stamp = outputs.instant(frame.ticks);
            self.alarms.set_input_quality(frame.input_quality);
            self.observe(&frame.snapshot, stamp);
            self.hole.observe(frame, || host.surveys(stamp));
            host.judged(&mut self.alarms, &frame.snapshot);
            self.compare(frame, stamp, host)?;
        }
        // After the comparison, which is of the same ticks.
        if let Some(ensemble) = &mut self.ensemble {
            ensemble.reached(frame.ticks);
        }
        sent
    }

    /// Repeats the inputs that act, once a second, after [`Session::frame`]: a recording that begins later has those in
    /// force. A replay of a recording has the repetitions among its inputs.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn repeat_applied<H: Host>(&mut self, frame: &Frame, host: &mut H) -> Result<(), H::Error> {
        match &mut self.outputs {
            Some(outputs) => outputs.repeat_applied(frame, |encoded| host.send(encoded)),
            None => Ok(()),
        }
    }

    /// Judges the alarms of a snapshot at its stamp (ns), for a host that sends no messages, and returns their new events.
    pub fn judge(&mut self, snapshot: &Snapshot, stamp: i64) -> Vec<AlarmEvent> {
        self.observe(snapshot, stamp);
        self.alarms.take_events()
    }

    fn observe(&mut self, snapshot: &Snapshot, stamp: i64) {
        self.alarms.observe_tool(snapshot, stamp);
    }

    /// Compares a frame with what the rig has measured: publishes the residuals and judges their alarm.
    fn compare<H: Host>(&mut self, frame: &Frame, stamp: i64, host: &mut H) -> Result<(), H::Error> {
        let Some(samples) = host.measured(&mut self.rig, frame.ticks, stamp) else {
            return Ok(());
        };
        let header = self.header(stamp);
        let Some(comparison) = self.rig.compare(frame, &samples, header) else {
            return Ok(());
        };
        let (compared, followed) = (&comparison.compared, comparison.followed());
        if let Some(ensemble) = &self.ensemble {
            let compared = ensemble::Compared {
                step: comparison.step,
                steady: compared.steady,
                drilling: compared.drilling,
                measured: samples.values,
                predicted: predicted(&frame.snapshot),
            };
            ensemble.tell(Told::Compared(frame.ticks, compared));
        }
        self.alarms
            .observe_rig(comparison.judged(), &followed, samples.bit_depth, stamp);
        self.alarms.observe_adjusted(&comparison.message, stamp);
        self.alarms.observe_friction(&comparison.message, stamp);
        host.compared(&comparison);
        let residuals = self.residuals.insert(comparison.message);
        host.send(Encoded {
            topic: &topics::RESIDUALS,
            stamp,
            cdr: &to_cdr(residuals)?,
        })
    }

    /// Publishes the bands that plausible tools have come to. Once the run has `ended`, and is one that waits for them, those
    /// up to its end.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn publish_bands<H: Host>(&mut self, ended: bool, host: &mut H) -> Result<(), H::Error> {
        let Some(ensemble) = &mut self.ensemble else {
            return Ok(());
        };
        if ended {
            ensemble.finish();
        }
        while let Some(Found {
            ticks,
            begun: from,
            mut bands,
            judgement,
        }) = self.ensemble.as_mut().and_then(Running::take)
        {
            // Members run only once the instant of the first step is known.
            let Some((stamp, begun)) = self.instant(ticks).zip(self.instant(from)) else {
                continue;
            };
            bands.header = self.header(stamp);
            let known = self.begun.filter(|(of, _)| *of == from);
            let (_, begun) = *self.begun.insert(known.unwrap_or((from, begun)));
            bands.begun = Time::from_nanoseconds(begun);
            self.alarms.observe_tools(&bands);
            self.rig.hear_tools(ticks, judgement);
            host.send(Encoded {
                topic: &topics::BANDS,
                stamp,
                cdr: &to_cdr(&bands)?,
            })?;
            if self.bands.len() == SECONDS_OF_TOOLS {
                self.bands.pop_front();
            }
            self.bands.push_back(bands);
        }
        Ok(())
    }

    /// The plausible tools of now, to look ahead from, or in words why there are none; `None` where none run with it. A run
    /// that waits for them waits here, too.
    pub fn plausible_tools(&self) -> Option<Result<Forks, String>> {
        self.ensemble.as_ref().map(Running::forks)
    }

    /// What plausible tools did in the newest seconds that they have come to.
    pub fn seconds_of_tools(&self) -> impl Iterator<Item = &Bands> {
        self.bands.iter()
    }

    /// Publishes where the tool drills next, and judges the alarm on the plan, up to the first message whose answer is not
    /// there. Where the run can `wait` for it, it does.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn publish_hole<H: Host>(&mut self, wait: bool, host: &mut H) -> Result<(), H::Error> {
        while let Some(Ready {
            ticks,
            answered,
            mut message,
            appended,
        }) = self.hole.take(wait)
        {
            // Frames come only once the instant of the first step is known.
            let Some(stamp) = self.instant(ticks) else { continue };
            message.header = self.header(stamp);
            let answered = answered.and_then(|ticks| self.instant(ticks));
            message.answered = answered.map_or_else(Time::default, Time::from_nanoseconds);
            self.alarms.observe_hole(&message, stamp);
            host.send(Encoded {
                topic: &topics::HOLE_AHEAD,
                stamp,
                cdr: &to_cdr(&message)?,
            })?;
            self.publish_drilled(appended, stamp, host)?;
        }
        Ok(())
    }

    /// The hole as drilled.
    pub fn drilled(&self) -> &DrilledHole {
        self.hole.drilled()
    }

    /// Continues the hole of an earlier run, whose points a checkpoint has; [`Session::begin`] publishes them, so that a
    /// recording has all of the hole.
    pub fn continue_hole(&mut self, points: &[Point]) {
        self.earlier = self.hole.continue_with(points);
    }

    /// Continues the lives of the joints, which `twin/ageing` then has by serial number. To be called before the first frame.
    pub fn continue_lives(&mut self, mut lives: LivingJoints) {
        if let Some(outputs) = &self.outputs {
            lives.begin(outputs.instant(0));
        }
        self.lives = Some(lives);
    }

    /// Publishes points of the hole at an instant (ns since 1970).
    fn publish_drilled<H: Host>(&self, appended: Vec<Appended>, stamp: i64, host: &mut H) -> Result<(), H::Error> {
        for (answered, mut message) in appended {
            message.header = self.header(stamp);
            let answered = answered.and_then(|ticks| self.instant(ticks));
            message.answered = answered.map_or_else(Time::default, Time::from_nanoseconds);
            host.send(Encoded {
                topic: &topics::HOLE_DRILLED,
                stamp,
                cdr: &to_cdr(&message)?,
            })?;
        }
        Ok(())
    }

    /// Publishes the alarms' new events, and their list when it is due at an instant of a steady clock (ns). Returns the
    /// events.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn publish_alarms<H: Host>(
        &mut self,
        header: Header,
        clock: i64,
        host: &mut H,
    ) -> Result<Vec<AlarmEvent>, H::Error> {
        self.alarms.publish(header, clock, |encoded| host.send(encoded))
    }
}
