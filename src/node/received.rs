//! Samples of the rig as they were received, on their way from the receiving tasks to the recording.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use flexdrill_core::inputs::InputKind;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{RigInputs, RigMeasured, RigSurvey};

/// Most samples that wait for the recording.
const CAPACITY: usize = 1024;
const TOPICS: [&TopicInfo; 7] = [
    &topics::ROTARY_SPEED_RPM,
    &topics::WEIGHT_ON_BIT_KN,
    &topics::RATE_OF_PENETRATION,
    &topics::STANDPIPE_PRESSURE,
    &topics::RIG_INPUTS,
    &topics::RIG_MEASURED,
    &topics::RIG_SURVEY,
];

/// A sample as received.
#[derive(Debug, Clone)]
pub enum Received {
    /// A plain number.
    Plain {
        /// Its input.
        kind: InputKind,
        /// In the unit of the topic.
        value: f64,
    },
    /// A message with stamp, quality and source.
    Stamped(RigInputs),
    /// What the rig measures besides.
    Measured(RigMeasured),
    /// A survey of the hole.
    Survey(RigSurvey),
}

impl Received {
    /// Its topic.
    pub fn topic(&self) -> &'static TopicInfo {
        match self {
            Received::Plain { kind, .. } => plain_topic(*kind),
            Received::Stamped(_) => &topics::RIG_INPUTS,
            Received::Measured(_) => &topics::RIG_MEASURED,
            Received::Survey(_) => &topics::RIG_SURVEY,
        }
    }
}

/// The topic of an input's plain numbers.
pub fn plain_topic(kind: InputKind) -> &'static TopicInfo {
    match kind {
        InputKind::RotarySpeed => &topics::ROTARY_SPEED_RPM,
        InputKind::WeightOnBit => &topics::WEIGHT_ON_BIT_KN,
        InputKind::RateOfPenetration => &topics::RATE_OF_PENETRATION,
        InputKind::StandpipePressure => &topics::STANDPIPE_PRESSURE,
    }
}

/// Samples that the recording misses, by [`TOPICS`].
type Missed = Arc<[AtomicU32; TOPICS.len()]>;

/// Sends samples to the recording. It never waits; samples that find the queue full are counted.
#[derive(Debug, Clone)]
pub struct ReceivedSender {
    samples: SyncSender<Received>,
    missed: Missed,
}

/// The recording's end of the queue.
#[derive(Debug)]
pub struct ReceivedQueue {
    samples: Receiver<Received>,
    missed: Missed,
}

/// Both ends of a new queue.
pub fn queue() -> (ReceivedSender, ReceivedQueue) {
    let (sender, receiver) = sync_channel(CAPACITY);
    let missed = Missed::default();
    (
        ReceivedSender {
            samples: sender,
            missed: Arc::clone(&missed),
        },
        ReceivedQueue {
            samples: receiver,
            missed,
        },
    )
}

impl ReceivedSender {
    /// Queues a sample, or counts it as missed.
    pub fn send(&self, received: Received) {
        let topic = received.topic();
        if self.samples.try_send(received).is_err() {
            self.miss(topic, 1);
        }
    }

    /// Counts samples of a topic that the recording misses.
    pub fn miss(&self, topic: &TopicInfo, samples: u64) {
        if let Some(index) = TOPICS.iter().position(|known| known.name == topic.name) {
            self.missed[index].fetch_add(u32::try_from(samples).unwrap_or(u32::MAX), Ordering::Relaxed);
        }
    }
}

impl ReceivedQueue {
    /// The next sample.
    pub fn pop(&self) -> Option<Received> {
        self.samples.try_recv().ok()
    }

    /// Samples of each topic that were missed since the last call.
    pub fn missed(&self) -> impl Iterator<Item = (&'static TopicInfo, u32)> {
        let counts = self.missed.iter().map(|count| count.swap(0, Ordering::Relaxed));
        TOPICS.into_iter().zip(counts).filter(|(_, count)| *count > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_that_find_the_queue_full_are_counted_by_topic() {
        let (sender, queue) = queue();
        let plain = |kind| Received::Plain { kind, value: 1.0 };
        for _ in 0..CAPACITY + 3 {
            sender.send(plain(InputKind::WeightOnBit));
        }
        sender.send(Received::Stamped(RigInputs::default()));
        sender.miss(&topics::ROTARY_SPEED_RPM, 5);
        let missed = || -> Vec<(&str, u32)> { queue.missed().map(|(topic, count)| (topic.name, count)).collect() };
        let expected = [
            ("rig/rotary_speed_rpm", 5),
            ("rig/weight_on_bit_kn", 3),
            ("rig/inputs", 1),
        ];
        assert_eq!(missed(), expected);
        assert!(missed().is_empty(), "each is reported once");
        assert_eq!(std::iter::from_fn(|| queue.pop()).count(), CAPACITY);
    }
}
