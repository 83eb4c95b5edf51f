//! The bag of a replay, as the host of its session.

use std::collections::VecDeque;
use std::sync::Arc;

use super::look_ahead::LookAhead;
use super::summary::Tally;
use crate::alarms::AlarmBook;
use crate::bag::{BagError, Recorder};
use crate::cli::output::tell;
use crate::cli::source::{FromRig, MeasuredSample, SurveySample};
use crate::messages::topics::{self, TopicInfo};
use crate::messages::{CdrError, RigInputs, to_cdr};
use crate::residuals::{Comparison, RigComparison, Samples};
use crate::rig_inputs::{Measured, SurveyCounts, Surveys};
use crate::session::Host;
use flexdrill_core::twin::Snapshot;
use flexdrill_hole::Survey;
use flexdrill_outputs::Encoded;
use flexdrill_text::fixed;

/// Why a replay has not recorded a message.
#[derive(Debug, thiserror::Error)]
pub(super) enum WriteError {
    #[error(transparent)]
    Cdr(#[from] CdrError),
    #[error(transparent)]
    Bag(#[from] BagError),
}

/// Refused messages of measured values that are reported one by one.
const REFUSALS_SHOWN: u64 = 10;

/// What the rig measured, for the comparison with the twin.
enum Rig {
    /// The newest values, as a node keeps them.
    Received(Box<Measured>),
    /// What a recorded run was compared with, by stamp (ns since 1970), the oldest first.
    Recorded(VecDeque<(i64, Samples)>),
}

/// The surveys of the hole.
enum Hole {
    /// As a node keeps them.
    Received(Box<Surveys>),
    /// Those that a recorded run knew, and the later ones by the instants from which on it knew them (ns since 1970).
    Recorded(Arc<[Survey]>, VecDeque<(i64, Arc<[Survey]>)>),
}

/// A bag that records a session, what the rig gave, and what of it follows the rig.
pub(super) struct BagSink {
    recorder: Recorder,
    topics: Vec<&'static TopicInfo>,
    rig: Rig,
    hole: Hole,
    /// What the rig measured, not yet in the bag, the newest first.
    measured: Vec<MeasuredSample>,
    /// Its surveys, not yet in the bag, the newest first.
    surveys: Vec<SurveySample>,
    /// The inputs as the rig or the log gave them, not yet in the bag, the newest first.
    received: Vec<(i64, RigInputs)>,
    /// Values of what follows the rig, in force and to be, since they were taken last.
    pub(super) moved: Option<[[f64; 2]; 2]>,
    /// The summary that is printed at the end.
    pub(super) tally: Tally,
    /// Advice and forecasts; none where the replay does not look ahead.
    pub(super) look_ahead: Option<LookAhead>,
}

impl BagSink {
    /// A bag with these topics, in this order, for a run with what came `from_rig` since its start, in the order of time.
    /// Its surveys are judged by those of `hole`.
    pub(super) fn new(
        recorder: Recorder,
        topics: Vec<&'static TopicInfo>,
        from_rig: FromRig,
        hole: Surveys,
        tally: Tally,
    ) -> Self {
        let FromRig {
            inputs: mut received,
            mut measured,
            mut surveys,
        } = from_rig;
        // The lists are reversed, so that the next message is taken from the end without moving the others.
        measured.reverse();
        received.reverse();
        surveys.reverse();
        Self {
            recorder,
            topics,
            rig: Rig::Received(Box::default()),
            hole: Hole::Received(Box::new(hole)),
            measured,
            surveys,
            received,
            moved: None,
            tally,
            look_ahead: None,
        }
    }

    /// Compares the run at these stamps (ns since 1970), the oldest first, with what a recorded run was compared with,
    /// instead of with the measured values.
    pub(super) fn compare_with(&mut self, samples: impl IntoIterator<Item = (i64, Samples)>) {
        self.rig = Rig::Recorded(samples.into_iter().collect());
    }

    /// Takes the surveys that a recorded run knew from these instants on (ns since 1970), the oldest first, instead of those that
    /// the rig sent.
    pub(super) fn survey_with(&mut self, surveys: impl IntoIterator<Item = (i64, Arc<[Survey]>)>) {
        self.hole = Hole::Recorded(Arc::default(), surveys.into_iter().collect());
    }

    /// Records what the rig sent up to an instant (ns since 1970), and keeps what it measured for the comparison. `start` is
    /// the instant of the run's first step, and `max_skew` the longest age of a stamp (s).
    ///
    /// # Errors
    /// When the bag cannot be written.
    pub(super) fn record_from_rig(&mut self, until: i64, start: i64, max_skew: f64) -> Result<(), WriteError> {
        while let Some((stamp, message)) = self.received.pop_if(|(time, _)| *time <= until) {
            self.send(Encoded {
                topic: &topics::RIG_INPUTS,
                stamp,
                cdr: &to_cdr(&message)?,
            })?;
        }
        while let Some(sample) = self.measured.pop_if(|sample| sample.time <= until) {
            if let Rig::Received(measured) = &mut self.rig {
                let since_start = sample.time.saturating_sub(start) as f64 * 1e-9;
                let accepted = measured.accept(&sample.message, sample.time, since_start, max_skew);
                let [_, refused, ..] = measured.counts();
                match accepted {
                    Err(why) if refused <= REFUSALS_SHOWN => tell!("at {} s: {why}", fixed(since_start, 2)),
                    _ => {}
                }
            }
            self.send(Encoded {
                topic: &topics::RIG_MEASURED,
                stamp: sample.time,
                cdr: &to_cdr(&sample.message)?,
            })?;
        }
        self.record_surveys(until, start, max_skew)
    }

    /// Records the surveys that the rig sent up to an instant (ns since 1970), and keeps them for the hole ahead. `start` and
    /// `max_skew` as above.
    ///
    /// # Errors
    /// When the bag cannot be written.
    fn record_surveys(&mut self, until: i64, start: i64, max_skew: f64) -> Result<(), WriteError> {
        while let Some(sample) = self.surveys.pop_if(|sample| sample.time <= until) {
            if let Hole::Received(known) = &mut self.hole {
                let accepted = known.accept(&sample.message, sample.time, max_skew);
                let SurveyCounts { refused, waiting, .. } = known.counts();
                let words = match accepted {
                    Err(why) => (refused <= REFUSALS_SHOWN).then(|| why.to_string()),
                    Ok(taken) => taken.advice().filter(|_| waiting <= REFUSALS_SHOWN),
                };
                if let Some(words) = words {
                    let since_start = sample.time.saturating_sub(start) as f64 * 1e-9;
                    tell!("at {} s: {words}", fixed(since_start, 2));
                }
            }
            self.send(Encoded {
                topic: &topics::RIG_SURVEY,
                stamp: sample.time,
                cdr: &to_cdr(&sample.message)?,
            })?;
        }
        Ok(())
    }

    /// Ends the recording. Returns the recorder and the summary.
    pub(super) fn end(self) -> (Recorder, Tally) {
        if let Rig::Received(measured) = &self.rig {
            let [_, refused, ..] = measured.counts();
            if refused > REFUSALS_SHOWN {
                tell!("{refused} messages of measured values were refused in total");
            }
        }
        if let Hole::Received(known) = &self.hole {
            let SurveyCounts { refused, .. } = known.counts();
            if refused > REFUSALS_SHOWN {
                tell!("{refused} surveys were refused in total");
            }
        }
        (self.recorder, self.tally)
    }
}

impl Host for BagSink {
    type Error = WriteError;

    fn send(&mut self, Encoded { topic, stamp, cdr }: Encoded<'_>) -> Result<(), WriteError> {
        match self.topics.iter().position(|known| known.name == topic.name) {
            Some(index) => Ok(self.recorder.record(index, stamp, cdr)?),
            None => Ok(()),
        }
    }

    fn measured(&mut self, rig: &mut RigComparison, ticks: u64, stamp: i64) -> Option<Samples> {
        match &mut self.rig {
            Rig::Received(measured) => rig.is_due(ticks).then(|| rig.samples(measured, stamp)),
            Rig::Recorded(samples) => {
                while samples.front().is_some_and(|(at, _)| *at < stamp) {
                    samples.pop_front();
                }
                samples.pop_front_if(|(at, _)| *at == stamp).map(|(_, samples)| samples)
            }
        }
    }

    fn surveys(&mut self, stamp: i64) -> Arc<[Survey]> {
        match &mut self.hole {
            Hole::Received(known) => known.known(),
            Hole::Recorded(known, later) => {
                while let Some((_, next)) = later.pop_front_if(|(from, _)| *from <= stamp) {
                    *known = next;
                }
                Arc::clone(known)
            }
        }
    }

    fn judged(&mut self, alarms: &mut AlarmBook, _: &Snapshot) {
        if let Some(look_ahead) = &self.look_ahead {
            look_ahead.advise(alarms);
        }
    }

    fn compared(&mut self, comparison: &Comparison) {
        self.tally.rig.observe(&comparison.message);
        if let Some(stopped) = &comparison.stopped {
            tell!("calibration.follow: {stopped}; it follows no further");
        }
        self.moved = comparison.moved;
    }
}
