//! Where encoded messages are sent: DDS, the recording and the viewers.

use super::publish::PublisherParts;
use crate::bag::RecordingThread;
use crate::live::LiveServer;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{CdrError, Message, to_cdr};
use flexdrill_outputs::Encoded;
use flexdrill_text::log_ending;

impl PublisherParts {
    pub(super) fn send(&self, encoded: Encoded<'_>) -> Result<(), CdrError> {
        self.publishers.publish(encoded.topic, encoded.cdr);
        self.sinks().write(encoded);
        Ok(())
    }

    pub(super) fn sinks(&self) -> Sinks<'_> {
        Sinks {
            recording: self.recording.as_ref(),
            live: self.live.as_ref(),
        }
    }

    pub(super) fn send_message<M: Message>(&self, topic: &'static TopicInfo, message: &M, stamp: i64) {
        match to_cdr(message) {
            // Sending counts a message that finds a queue full, and returns no error.
            Ok(cdr) => drop(self.send(Encoded {
                topic,
                stamp,
                cdr: &cdr,
            })),
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
    pub(super) recording: Option<&'a RecordingThread>,
    pub(super) live: Option<&'a LiveServer>,
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
