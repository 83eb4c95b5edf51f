//! The tasks that receive the rig's samples. How samples are judged is [`crate::rig_inputs`].

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::clocks::steady;
use super::confirmed::Confirmed;
use super::inputs::RigInputs;
use super::received::{Received, ReceivedSender, plain_topic};
use super::surveys::SurveyFile;
use crate::rig_inputs::{Carried, Driver, DriverId, SampleRefused, Taken};
use flexdrill_core::inputs::InputKind;
use flexdrill_messages::std_msgs::Float64;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{Message, RigMeasured, RigSurvey, message_from_cdr_body};
use flexdrill_outputs::{InputValues as _, MeasuredValues as _};
use flexdrill_ros2::dds::frames::Peer;
use flexdrill_ros2::dds::plan::Guid;
use flexdrill_ros2::dds::port::{Inbox, Monitor, Sample};
use flexdrill_text::log_ending;

/// How often the targets follow the ages of the inputs.
const UPDATE_INTERVAL: Duration = Duration::from_millis(10);
/// Least time between two questions to discovery about a publisher that it does not fully know (s): the announcement may
/// come after the first sample.
const QUERY_INTERVAL: f64 = 1.0;
/// Most publishers for which the time of the last question is kept.
const MOST_QUERIED: usize = 64;
/// Most publishers that are warned of their zeros.
const MOST_WARNED: usize = 64;

/// Receives samples: their path from a topic to the inputs and the recording.
pub struct SampleReceiver {
    /// The inputs.
    pub inputs: RigInputs,
    /// Discovery, which knows the publishers.
    pub dds: Monitor,
    /// The queue to the recording and the viewers, if there are any.
    pub record: Option<ReceivedSender>,
    /// Confirmations of the bridges that send.
    pub confirmed: Confirmed,
    /// Publishers that were warned of their zeros.
    pub warned: Mutex<HashSet<DriverId>>,
}

impl SampleReceiver {
    /// Asks discovery about a publisher whose node or host is not known yet.
    fn query_publisher(&self, id: DriverId, queried: &mut HashMap<DriverId, f64>) {
        let now = steady();
        if self.inputs.is_described(id) || queried.get(&id).is_some_and(|last| now - last < QUERY_INTERVAL) {
            return;
        }
        if queried.len() > MOST_QUERIED {
            queried.clear();
        }
        queried.insert(id, now);
        let peer = self.dds.writers().into_iter().flatten().find(|peer| peer.id == id.0);
        self.inputs.describe(peer.map_or_else(|| Driver::unknown(id), driver));
    }

    fn record(&self, received: Received) {
        if let Some(record) = &self.record {
            record.send(received);
        }
    }

    /// Says once per publisher that a value of 0 was taken as not given.
    fn warn_of_zeros(&self, is_doubtful: bool, topic: &TopicInfo, id: DriverId) {
        if !is_doubtful {
            return;
        }
        let mut warned = self.warned.lock().unwrap_or_else(PoisonError::into_inner);
        if warned.len() < MOST_WARNED
            && warned.insert(id)
            && let Some(more) = log_ending(format!("zeros on {}", topic.name))
        {
            let peer = self.dds.writers().into_iter().flatten().find(|peer| peer.id == id.0);
            let who = peer.map_or_else(|| "a publisher".to_owned(), |peer| peer.to_string());
            tracing::warn!(
                "{}: {who} leaves values at 0 and does not say in the field `given` which of its values are measured: they are \
                 not used. Set `given`, or set values that are not measured to NaN{more}",
                topic.name
            );
        }
    }

    fn count_overrun(&self, topic: &TopicInfo, carried: Carried, samples: u64) {
        self.inputs.count_overrun(carried, samples);
        if let Some(record) = &self.record {
            record.miss(topic, samples);
        }
    }
}

/// A program of the network as the publisher of an input.
pub(super) fn driver(peer: Peer) -> Driver {
    Driver {
        id: DriverId(peer.id),
        node: peer.node,
        host: peer.address,
        source: String::new(),
    }
}

/// Receives the samples of one topic for as long as it is polled. `accept` judges a message and returns the refusals;
/// `carried` is what the topic carries.
async fn receive<M: Message>(
    receiver: SampleReceiver,
    topic: &'static TopicInfo,
    carried: Carried,
    samples: &Inbox<Sample>,
    accept: impl Fn(&SampleReceiver, M, DriverId) -> Vec<SampleRefused>,
) {
    let mut queried = HashMap::new();
    let mut dropped = 0;
    loop {
        let sample = samples.next().await;
        let before = std::mem::replace(&mut dropped, samples.dropped());
        if dropped > before {
            receiver.count_overrun(topic, carried, dropped - before);
            if let Some(more) = log_ending(format!("{}: overrun", topic.name)) {
                tracing::warn!(
                    "{}: {} samples came faster than the node reads them and were dropped; check whether a publisher floods \
                     the topic{more}",
                    topic.name,
                    dropped - before
                );
            }
        }
        let (message, id) = match decode(sample) {
            Ok((message, writer)) => (message, DriverId(writer)),
            Err(error) => {
                receiver.inputs.count_unreadable(carried);
                if let Some(more) = log_ending(format!("{}: unreadable", topic.name)) {
                    tracing::warn!("{}: a sample could not be read: {error}{more}", topic.name);
                }
                continue;
            }
        };
        receiver.query_publisher(id, &mut queried);
        for refused in accept(&receiver, message, id) {
            let cause = match &refused {
                SampleRefused::Driver(_) => usize::MAX,
                SampleRefused::Value(rejection) => rejection.reason.index(),
                SampleRefused::Measured(refused) => usize::MAX - 1 - refused.index(),
                SampleRefused::Survey(refused) => refused.index(),
            };
            if let Some(more) = log_ending(format!("{}: refused {cause}", topic.name)) {
                tracing::warn!("{refused}{more}");
            }
        }
    }
}

/// The message of a sample, and its writer.
pub(super) fn decode<M: Message>(sample: Sample) -> Result<(M, Guid), String> {
    match sample {
        Sample::Body { writer, body } => message_from_cdr_body(&body)
            .map(|message| (message, writer))
            .map_err(|error| error.to_string()),
        Sample::Unreadable(why) => Err(why),
    }
}

/// Receives the plain numbers of one input for as long as it is polled.
pub async fn receive_plain(receiver: SampleReceiver, kind: InputKind, samples: Arc<Inbox<Sample>>) {
    let kinds = match kind {
        InputKind::RotarySpeed => &[InputKind::RotarySpeed],
        InputKind::WeightOnBit => &[InputKind::WeightOnBit],
        InputKind::RateOfPenetration => &[InputKind::RateOfPenetration],
        InputKind::StandpipePressure => &[InputKind::StandpipePressure],
    };
    receive(
        receiver,
        plain_topic(kind),
        Carried::Inputs(kinds),
        &samples,
        move |receiver, Float64 { data: value }, id| {
            receiver.record(Received::Plain { kind, value });
            receiver.inputs.accept_plain(kind, value, id)
        },
    )
    .await;
}

/// Receives the messages on `rig/inputs` for as long as it is polled.
pub async fn receive_stamped(receiver: SampleReceiver, samples: Arc<Inbox<Sample>>) {
    receive(
        receiver,
        &topics::RIG_INPUTS,
        Carried::Inputs(&InputKind::ALL),
        &samples,
        |receiver, message: flexdrill_messages::RigInputs, id| {
            receiver.confirmed.rig_message(id);
            receiver.warn_of_zeros(message.has_doubtful_zero(), &topics::RIG_INPUTS, id);
            let refused = receiver.inputs.accept_stamped(&message, id);
            receiver.record(Received::Stamped(message));
            refused
        },
    )
    .await;
}

/// Receives the messages on `rig/measured` for as long as it is polled.
pub async fn receive_measured(receiver: SampleReceiver, samples: Arc<Inbox<Sample>>) {
    receive(
        receiver,
        &topics::RIG_MEASURED,
        Carried::Measured,
        &samples,
        |receiver, message: RigMeasured, id| {
            receiver.confirmed.rig_message(id);
            receiver.warn_of_zeros(message.has_doubtful_zero(), &topics::RIG_MEASURED, id);
            let refused = receiver.inputs.accept_measured(&message);
            receiver.record(Received::Measured(message));
            refused.into_iter().collect()
        },
    )
    .await;
}

/// Receives the surveys on `rig/survey` for as long as it is polled, and keeps them in a file where there is one.
pub async fn receive_surveys(receiver: SampleReceiver, samples: Arc<Inbox<Sample>>, file: Option<SurveyFile>) {
    receive(
        receiver,
        &topics::RIG_SURVEY,
        Carried::Surveys,
        &samples,
        move |receiver, message: RigSurvey, _| {
            let taken = receiver.inputs.accept_survey(&message);
            receiver.record(Received::Survey(message));
            if let (Ok(Taken::New | Taken::Waits { .. }), Some(file)) = (&taken, &file) {
                file.save(receiver.inputs.kept_surveys());
            }
            if let Some(advice) = taken.as_ref().ok().and_then(|taken| taken.advice())
                && let Some(more) = log_ending("rig/survey: waits")
            {
                tracing::warn!("{advice}{more}");
            }
            taken.err().into_iter().collect()
        },
    )
    .await;
}

/// Updates the targets also while no sample comes, so that inputs age, hold and ramp to their safe values.
pub async fn update_targets(inputs: RigInputs) {
    let mut tick = tokio::time::interval(UPDATE_INTERVAL);
    tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        tick.tick().await;
        inputs.update_targets();
        inputs.log_safe_values();
    }
}
