//! What comes from the rig: the two inputs. How samples are judged is [`crate::rig_inputs`]; here is their path from the
//! network.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::dds::plan::Guid;
use crate::dds::port::{Inbox, Monitor, Sample};
use crate::messages::RigInputs as RigInputsMessage;
use crate::messages::std_msgs::Float64;
use crate::messages::topics::{self, TopicInfo};
use crate::messages::{Message, from_cdr_body};
use crate::rig_inputs::{Announcement, Driver, DriverId, Intake, RigSample, SampleRefused, Sent, stamped};
use flexdrill_config::InputsConfig;
use flexdrill_core::inputs::{Conditioner, InputKind, Stamp};
use flexdrill_realtime::link::Targets;
use flexdrill_realtime::monotonic;
use flexdrill_text::{Throttle, Throttles};

/// How often the targets follow the ages of the inputs.
const UPDATE_INTERVAL: Duration = Duration::from_millis(10);
/// Least time between two log lines about samples of one input (s).
const LOG_INTERVAL: f64 = 2.0;
/// Least time between two questions to discovery about a publisher that it does not know all of (s): its announcement
/// may come after its first sample.
const ASK_INTERVAL: f64 = 1.0;

/// Characters of a message's source that are kept: the status carries them.
const LONGEST_SOURCE: usize = 64;

/// Time as the inputs' ages count it (s).
pub type Now = Arc<dyn Fn() -> f64 + Send + Sync>;
/// Present instant on the rig's clock (ns since 1970).
pub type RigTime = Arc<dyn Fn() -> i64 + Send + Sync>;

/// A sample as received, for the recording.
#[derive(Debug, Clone)]
pub enum Received {
    /// A number alone.
    Plain {
        /// The input that it belongs to.
        kind: InputKind,
        /// In the unit of the topic.
        value: f64,
    },
    /// With stamp, quality and source.
    Stamped(RigInputsMessage),
}

/// Samples that may wait for the recording.
const RECEIVED: usize = 1024;
/// Topics that samples come from.
const TOPICS: [&TopicInfo; 3] = [
    &topics::ROTARY_SPEED_RPM,
    &topics::WEIGHT_ON_BIT_KN,
    &topics::RIG_INPUTS,
];

/// Samples that were received and are not on their way to the recording: one number for each of the topics.
type Missed = Arc<[AtomicU32; TOPICS.len()]>;

/// The way of samples as received to the recording. Never waits: what has no room is counted.
#[derive(Debug, Clone)]
pub struct ForRecording {
    samples: SyncSender<Received>,
    missed: Missed,
}

/// The other end of [`ForRecording`].
#[derive(Debug)]
pub struct ToRecord {
    samples: Receiver<Received>,
    missed: Missed,
}

/// Both ends.
pub fn for_recording() -> (ForRecording, ToRecord) {
    let (sender, receiver) = sync_channel(RECEIVED);
    let missed = Missed::default();
    let ends = (Arc::clone(&missed), missed);
    (
        ForRecording {
            samples: sender,
            missed: ends.0,
        },
        ToRecord {
            samples: receiver,
            missed: ends.1,
        },
    )
}

impl ForRecording {
    fn send(&self, received: Received) {
        let topic = received.topic();
        if self.samples.try_send(received).is_err() {
            self.miss(topic, 1);
        }
    }

    fn miss(&self, topic: &TopicInfo, samples: u64) {
        if let Some(index) = TOPICS.iter().position(|known| known.name == topic.name) {
            self.missed[index].fetch_add(u32::try_from(samples).unwrap_or(u32::MAX), Ordering::Relaxed);
        }
    }
}

impl ToRecord {
    /// The next sample.
    pub fn take(&self) -> Option<Received> {
        self.samples.try_recv().ok()
    }

    /// How many samples of each topic were missed since it was asked last.
    pub fn missed(&self) -> impl Iterator<Item = (&'static TopicInfo, u32)> {
        let counts = self.missed.iter().map(|count| count.swap(0, Ordering::Relaxed));
        TOPICS.into_iter().zip(counts).filter(|(_, count)| *count > 0)
    }
}

impl Received {
    /// Where it came from.
    pub fn topic(&self) -> &'static TopicInfo {
        match self {
            Received::Plain { kind, .. } => plain_topic(*kind),
            Received::Stamped(_) => &topics::RIG_INPUTS,
        }
    }
}

fn plain_topic(kind: InputKind) -> &'static TopicInfo {
    match kind {
        InputKind::RotarySpeed => &topics::ROTARY_SPEED_RPM,
        InputKind::WeightOnBit => &topics::WEIGHT_ON_BIT_KN,
    }
}

/// Where the samples of the rig go: conditioned into the targets of the solver.
#[derive(Clone)]
pub struct RigInputs {
    /// Judges values.
    pub conditioner: Arc<Mutex<Conditioner>>,
    /// Judges who sends them. Where both are locked, this comes first.
    pub intake: Arc<Mutex<Intake>>,
    targets: Arc<Targets>,
    now: Now,
    stamp_time: RigTime,
    max_skew: f64,
}

impl RigInputs {
    /// Judges by a configuration; `now` gives the time of arrival, `stamp_time` the same instant on the clock of stamps.
    pub fn new(inputs: &InputsConfig, targets: Arc<Targets>, now: Now, stamp_time: RigTime) -> Self {
        Self {
            conditioner: Arc::new(Mutex::new(Conditioner::new(inputs.rules()))),
            intake: Arc::new(Mutex::new(Intake::new(inputs))),
            targets,
            now,
            stamp_time,
            max_skew: inputs.stamp.max_skew,
        }
    }

    /// Takes over changed limits, ages and safe values.
    pub fn set_rules(&self, inputs: &InputsConfig) {
        locked(&self.intake).set_rules(inputs);
        locked(&self.conditioner).set_rules(inputs.rules(), (self.now)());
    }

    /// Takes over what is known of a publisher that discovery does not know.
    pub fn describe(&self, driver: Driver) {
        let mut intake = locked(&self.intake);
        if !intake.drivers.is_described(driver.id) {
            intake.drivers.describe(driver);
        }
    }

    /// Brings the targets up to date.
    pub fn update_targets(&self) {
        let now = (self.now)();
        let (inputs, quality) = {
            let conditioner = locked(&self.conditioner);
            (conditioner.targets(now), conditioner.quality(now))
        };
        self.targets.set(inputs, quality as u8);
    }

    /// The clock of arrivals was set: ages count from now on.
    pub fn clock_set(&self) {
        let now = (self.now)();
        locked(&self.intake).clock_set(now);
        locked(&self.conditioner).clock_set(now);
    }

    /// Takes a number alone of a publisher. Why it was refused, if it was.
    pub fn take_plain(&self, kind: InputKind, value: f64, id: DriverId) -> Vec<SampleRefused> {
        self.take([(kind, value, None)], id)
    }

    /// Takes a message with a stamp of a publisher. Why its values were refused, of those that were.
    pub fn take_stamped(&self, message: &RigInputsMessage, id: DriverId) -> Vec<SampleRefused> {
        let sent = Sent {
            source: message.source.chars().take(LONGEST_SOURCE).collect(),
            suspect: stamped::is_suspect(message),
        };
        let given = stamped::values(message, (self.stamp_time)(), self.max_skew);
        let samples = InputKind::ALL.into_iter().zip(given);
        self.take(
            samples.filter_map(|(kind, given)| given.map(|(value, stamp)| (kind, value, Some((stamp, sent.clone()))))),
            id,
        )
    }

    /// Why samples were refused, of those that were.
    fn take(
        &self,
        samples: impl IntoIterator<Item = (InputKind, f64, Option<(Stamp, Sent)>)>,
        id: DriverId,
    ) -> Vec<SampleRefused> {
        let time = (self.now)();
        let refused = {
            let (mut intake, mut conditioner) = (locked(&self.intake), locked(&self.conditioner));
            let samples = samples.into_iter().map(|(kind, value, stamp)| RigSample {
                kind,
                value,
                id,
                time,
                stamp,
            });
            samples
                .filter_map(|sample| intake.take(&mut conditioner, &sample).err())
                .collect()
        };
        self.update_targets();
        refused
    }

    /// Tells what has changed of the inputs' way to their safe values.
    fn announce(&self) {
        let now = (self.now)();
        for kind in InputKind::ALL {
            let announcement = locked(&self.intake).announce(kind, &locked(&self.conditioner), now);
            match announcement {
                Some(Announcement::Leaving(text)) => tracing::warn!("{text}"),
                Some(Announcement::Back(text)) => tracing::info!("{text}"),
                None => {}
            }
        }
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What discovery knows of a publisher.
fn describe(dds: &Monitor, id: DriverId) -> Driver {
    let peer = dds.writers().into_iter().flatten().find(|peer| peer.id == id.0);
    peer.map_or_else(
        || Driver::unknown(id),
        |peer| Driver {
            id,
            node: peer.node,
            host: peer.address,
        },
    )
}

/// The way of the samples of one topic.
pub struct Door {
    /// Where they go.
    pub rig: RigInputs,
    /// Who knows the publishers.
    pub dds: Monitor,
    /// Takes a copy for the recording, if there is one.
    pub record: Option<ForRecording>,
}

impl Door {
    fn ask_about(&self, id: DriverId, asked: &mut HashMap<DriverId, f64>) {
        let now = monotonic::now() as f64 * 1e-9;
        if locked(&self.rig.intake).drivers.is_described(id)
            || asked.get(&id).is_some_and(|last| now - last < ASK_INTERVAL)
        {
            return;
        }
        if asked.len() > MOST_ASKED {
            asked.clear();
        }
        asked.insert(id, now);
        let driver = describe(&self.dds, id);
        locked(&self.rig.intake).drivers.describe(driver);
    }

    fn record(&self, received: Received) {
        if let Some(record) = &self.record {
            record.send(received);
        }
    }

    /// Counts samples of a topic that nobody has seen.
    fn overrun(&self, topic: &TopicInfo, kinds: &[InputKind], samples: u64) {
        locked(&self.rig.intake).count_overrun(kinds, samples);
        if let Some(record) = &self.record {
            record.miss(topic, samples);
        }
    }
}

/// Publishers that are kept for asking again.
const MOST_ASKED: usize = 64;

/// Takes the samples of one topic for as long as it is polled; `take` judges one and says what was refused, `kinds` are
/// the inputs that it carries.
async fn receive<M: Message>(
    door: Door,
    topic: &'static TopicInfo,
    kinds: &'static [InputKind],
    samples: &Inbox<Sample>,
    take: impl Fn(&Door, M, DriverId) -> Vec<SampleRefused>,
) {
    let mut refused_lines = Throttles::new(LOG_INTERVAL);
    let mut unreadable_lines = Throttle::new(LOG_INTERVAL);
    let mut overrun_lines = Throttle::new(LOG_INTERVAL);
    let mut asked = HashMap::new();
    let mut given_up = 0;
    loop {
        let sample = samples.next().await;
        let clock = monotonic::now() as f64 * 1e-9;
        let before = std::mem::replace(&mut given_up, samples.given_up());
        if given_up > before {
            door.overrun(topic, kinds, given_up - before);
            if let Some(more) = overrun_lines.ending(clock) {
                tracing::warn!(
                    "{}: {} samples came faster than they were taken, and nobody has seen them; is a publisher flooding \
                     it?{more}",
                    topic.name,
                    given_up - before
                );
            }
        }
        let (message, id) = match decode(sample) {
            Ok((message, writer)) => (message, DriverId(writer)),
            Err(error) => {
                locked(&door.rig.intake).count_unreadable(kinds);
                if let Some(more) = unreadable_lines.ending(clock) {
                    tracing::warn!("{}: a sample could not be read: {error}{more}", topic.name);
                }
                continue;
            }
        };
        door.ask_about(id, &mut asked);
        for refused in take(&door, message, id) {
            let why = match &refused {
                SampleRefused::Driver(_) => usize::MAX,
                SampleRefused::Value(rejection) => rejection.reason.index(),
            };
            if let Some(more) = refused_lines.ending(why, clock) {
                tracing::warn!("{refused}{more}");
            }
        }
    }
}

/// A sample as its message, and who wrote it.
pub(super) fn decode<M: Message>(sample: Sample) -> Result<(M, Guid), String> {
    match sample {
        Sample::Body { writer, body } => from_cdr_body(&body)
            .map(|(message, _)| (message, writer))
            .map_err(|error| error.to_string()),
        Sample::Unreadable(why) => Err(why),
    }
}

/// Conditions the samples of one input for as long as it is polled.
pub async fn receive_plain(door: Door, kind: InputKind, samples: Arc<Inbox<Sample>>) {
    let kinds = match kind {
        InputKind::RotarySpeed => &InputKind::ALL[..1],
        InputKind::WeightOnBit => &InputKind::ALL[1..],
    };
    receive(
        door,
        plain_topic(kind),
        kinds,
        &samples,
        move |door, Float64 { data: value }, id| {
            door.record(Received::Plain { kind, value });
            door.rig.take_plain(kind, value, id)
        },
    )
    .await;
}

/// Conditions the samples of `rig/inputs` for as long as it is polled.
pub async fn receive_stamped(door: Door, samples: Arc<Inbox<Sample>>) {
    receive(
        door,
        &topics::RIG_INPUTS,
        &InputKind::ALL,
        &samples,
        |door, message, id| {
            let refused = door.rig.take_stamped(&message, id);
            door.record(Received::Stamped(message));
            refused
        },
    )
    .await;
}

/// Keeps the targets up to date while no sample comes: ages, holds and ramps.
pub async fn keep_targets(rig: RigInputs) {
    let mut tick = tokio::time::interval(UPDATE_INTERVAL);
    tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        tick.tick().await;
        rig.update_targets();
        rig.announce();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_finds_no_room_on_its_way_to_the_recording_is_counted_by_topic() {
        let (sender, receiver) = for_recording();
        let plain = |kind| Received::Plain { kind, value: 1.0 };
        for _ in 0..RECEIVED + 3 {
            sender.send(plain(InputKind::WeightOnBit));
        }
        sender.send(Received::Stamped(RigInputsMessage::default()));
        sender.miss(&topics::ROTARY_SPEED_RPM, 5);
        let missed = |receiver: &ToRecord| -> Vec<(&str, u32)> {
            receiver.missed().map(|(topic, count)| (topic.name, count)).collect()
        };
        let expected = [
            ("rig/rotary_speed_rpm", 5),
            ("rig/weight_on_bit_kn", 3),
            ("rig/inputs", 1),
        ];
        assert_eq!(missed(&receiver), expected);
        assert!(missed(&receiver).is_empty(), "told once");
        assert_eq!(std::iter::from_fn(|| receiver.take()).count(), RECEIVED);
    }
}
