//! What comes from the rig: the two inputs and, with `use_sim_time`, the clock.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use futures::StreamExt;
use ros2_client::{Node, Subscription};
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{DomainParticipant, QosPolicyBuilder, TopicKind};
use serde::de::DeserializeOwned;

use crate::messages::rosgraph_msgs::Clock;
use crate::messages::std_msgs::Float64;
use crate::messages::topics::TopicInfo;
use crate::ros::NodeError;
use crate::ros::publisher::dds_topic_name;
use flexdrill_core::inputs::{Conditioner, InputKind, Rejection};
use flexdrill_realtime::link::Targets;

/// Samples kept for a moment in which the node is busy; each is conditioned in turn, so the newest wins.
const DEPTH: i32 = 10;
/// How often the targets follow the ages of the inputs.
const UPDATE_INTERVAL: Duration = Duration::from_millis(10);
/// Least time between two log lines about refused samples of one input.
const LOG_INTERVAL: Duration = Duration::from_secs(2);

/// Time as the inputs' ages count it (s).
pub type Now = Arc<dyn Fn() -> f64 + Send + Sync>;

/// A sample as received, for the recording.
#[derive(Debug, Clone, Copy)]
pub struct Received {
    /// The input that it belongs to.
    pub kind: InputKind,
    /// In the unit of the topic.
    pub value: f64,
}

/// Subscribes to a topic, best effort, so that any publisher matches.
///
/// # Errors
/// When DDS refuses the topic or the reader.
pub fn subscribe<M: DeserializeOwned + 'static>(
    node: &mut Node,
    participant: &DomainParticipant,
    name: &str,
    topic: &TopicInfo,
) -> Result<Subscription<M>, NodeError> {
    let failed = |source| NodeError::Topic {
        topic: name.to_owned(),
        source,
    };
    let policies = QosPolicyBuilder::new()
        .reliability(Reliability::BestEffort)
        .durability(Durability::Volatile)
        .history(History::KeepLast { depth: DEPTH })
        .build();
    let handle = participant
        .create_topic(
            dds_topic_name(name),
            topic.kind.dds_type.to_owned(),
            &policies,
            TopicKind::NoKey,
        )
        .map_err(|error| failed(error.into()))?;
    node.create_subscription(&handle, None).map_err(failed)
}

/// Where the samples of the rig go: conditioned into the targets of the solver.
#[derive(Clone)]
pub struct RigInputs {
    /// Judges samples.
    pub conditioner: Arc<Mutex<Conditioner>>,
    /// Where the solver takes its targets from.
    pub targets: Arc<Targets>,
    /// Time of arrival.
    pub now: Now,
}

impl RigInputs {
    /// Brings the targets up to date.
    pub fn update_targets(&self) {
        let now = (self.now)();
        let (inputs, quality) = {
            let conditioner = self.conditioner.lock().unwrap_or_else(PoisonError::into_inner);
            (conditioner.targets(now), conditioner.quality(now))
        };
        self.targets.set(inputs, quality as u8);
    }

    fn offer(&self, kind: InputKind, value: f64) -> Result<(), Rejection> {
        let now = (self.now)();
        let offered = self
            .conditioner
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .offer(kind, value, now);
        self.update_targets();
        offered
    }
}

/// Conditions the samples of one input for as long as it is polled.
pub async fn receive(
    rig: RigInputs,
    kind: InputKind,
    subscription: Subscription<Float64>,
    record: Option<SyncSender<Received>>,
) {
    let mut samples = Box::pin(subscription.async_stream());
    let mut logged: Option<Instant> = None;
    let mut not_logged = 0_u64;
    while let Some(sample) = samples.next().await {
        let value = match sample {
            Ok((sample, _)) => sample.data,
            Err(error) => {
                tracing::warn!("{}: a sample could not be read: {error}", kind.topic());
                continue;
            }
        };
        if let Some(record) = &record {
            // A full queue means that the recording is behind; it counts that itself.
            let _ = record.try_send(Received { kind, value });
        }
        if let Err(rejection) = rig.offer(kind, value) {
            if logged.is_none_or(|at| at.elapsed() >= LOG_INTERVAL) {
                let more = if not_logged > 0 {
                    format!(" ({not_logged} more since the last line)")
                } else {
                    String::new()
                };
                tracing::warn!("{rejection}{more}");
                (logged, not_logged) = (Some(Instant::now()), 0);
            } else {
                not_logged += 1;
            }
        }
    }
}

/// Keeps the targets up to date while no sample comes: ages, holds and ramps.
pub async fn keep_targets(rig: RigInputs) {
    let mut tick = tokio::time::interval(UPDATE_INTERVAL);
    tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        tick.tick().await;
        rig.update_targets();
    }
}

/// Follows `/clock`; `newest` is in ns.
pub async fn follow_clock(rig: RigInputs, subscription: Subscription<Clock>, newest: Arc<AtomicU64>) {
    let mut ticks = Box::pin(subscription.async_stream());
    while let Some(tick) = ticks.next().await {
        let Ok((Clock { clock }, _)) = tick else { continue };
        let time = clock.to_nanoseconds().max(0) as u64;
        let before = newest.swap(time, Ordering::AcqRel);
        if time < before {
            tracing::warn!(
                "/clock went back by {:.3} s; the model goes on from where it is",
                (before - time) as f64 * 1e-9
            );
            rig.conditioner
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .clock_set((rig.now)());
        }
    }
}
