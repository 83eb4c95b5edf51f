//! The node as the host of its session: it sends messages to DDS, the recording and the viewers, and gives what the rig has
//! measured.

use std::sync::Arc;

use super::clocks::steady;
use super::publish::PublisherParts;
use super::thinned::{Share, Thinned};
use crate::alarms::AlarmBook;
use crate::bag::RecordingThread;
use crate::live::LiveServer;
use crate::residuals::{Comparison, RigComparison, Samples};
use crate::session::Host;
use flexdrill_core::twin::{Frame, Snapshot};
use flexdrill_hole::Survey;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{CdrError, Message, to_cdr};
use flexdrill_outputs::Encoded;
use flexdrill_text::log_ending;

/// The node while its session publishes.
pub(super) struct NodeHost<'a> {
    parts: &'a PublisherParts,
    /// The frame whose messages are sent, and what decides how many of them DDS gets.
    thinned: Option<(&'a mut Thinned, &'a Frame)>,
}

impl<'a> NodeHost<'a> {
    /// Sends everything everywhere.
    pub(super) fn all(parts: &'a PublisherParts) -> Self {
        Self { parts, thinned: None }
    }

    /// Sends the messages of a frame.
    pub(super) fn of_frame(parts: &'a PublisherParts, thinned: &'a mut Thinned, frame: &'a Frame) -> Self {
        Self {
            parts,
            thinned: Some((thinned, frame)),
        }
    }
}

impl Host for NodeHost<'_> {
    type Error = CdrError;

    fn send(&mut self, encoded: Encoded<'_>) -> Result<(), CdrError> {
        let publishers = &self.parts.publishers;
        let share = match &mut self.thinned {
            Some((thinned, frame)) => thinned.share(frame, encoded.topic, encoded.cdr)?,
            None => Share::Same,
        };
        if let Some(life) = &self.parts.life {
            life.take(encoded.topic, encoded.cdr);
        }
        // Each message is encoded once. DDS may get fewer of them, and combined ones; recording and viewers always get all.
        match share {
            Share::Same => publishers.publish(encoded.topic, encoded.cdr),
            Share::Combined(cdr) => publishers.publish(encoded.topic, &cdr),
            Share::Nothing => {}
        }
        self.parts.sinks().write(encoded);
        Ok(())
    }

    fn measured(&mut self, rig: &mut RigComparison, ticks: u64, stamp: i64) -> Option<Samples> {
        let inputs = &self.parts.inputs;
        rig.is_due(ticks)
            .then(|| inputs.with_measured(|measured| rig.samples(measured, stamp)))
    }

    fn surveys(&mut self, _: i64) -> Arc<[Survey]> {
        self.parts.inputs.surveys()
    }

    fn judged(&mut self, alarms: &mut AlarmBook, _: &Snapshot) {
        if let Some(set) = self.parts.set_point.inputs() {
            self.parts.alarms.advise(alarms, set, steady());
        }
    }

    fn compared(&mut self, comparison: &Comparison) {
        if let Some(stopped) = &comparison.stopped {
            tracing::warn!("calibration.follow: {stopped}; it follows no further");
        }
        if let Some(moved) = comparison.moved {
            // Sending fails only where the node ends.
            let _ = self.parts.moves.send(moved);
        }
    }
}

impl PublisherParts {
    pub(super) fn sinks(&self) -> Sinks<'_> {
        Sinks {
            recording: self.recording.as_ref(),
            live: self.live.as_ref(),
        }
    }

    /// Sends a message that is not of the session: status, diagnostics and forecasts.
    pub(super) fn send_message<M: Message>(&self, topic: &'static TopicInfo, message: &M, stamp: i64) {
        match to_cdr(message) {
            Ok(cdr) => {
                // Sending counts a message that finds a queue full, and returns no error.
                self.publishers.publish(topic, &cdr);
                self.sinks().write(Encoded {
                    topic,
                    stamp,
                    cdr: &cdr,
                });
            }
            Err(error) => {
                if let Some(more) = log_ending("message not encoded") {
                    tracing::error!("{error}{more}");
                }
            }
        }
    }
}

/// The recording and the viewers, which get the bytes of every message. Writing to them never waits.
#[derive(Clone, Copy)]
pub(super) struct Sinks<'a> {
    recording: Option<&'a RecordingThread>,
    live: Option<&'a LiveServer>,
}

impl Sinks<'_> {
    pub(super) fn write(&self, Encoded { topic, stamp, cdr }: Encoded<'_>) {
        if let Some(recording) = self.recording {
            recording.record(topic, stamp, cdr);
        }
        if let Some(live) = self.live
            && let Some(number) = topics::ALL.iter().position(|known| known.name == topic.name)
        {
            live.publish(number, stamp, cdr);
        }
    }
}
