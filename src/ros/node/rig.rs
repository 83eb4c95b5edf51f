//! What comes from the rig: the two inputs and, with `use_sim_time`, the clock.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::dds::plan::Guid;
use crate::dds::port::{Inbox, Sample};
use crate::messages::rosgraph_msgs::Clock;
use crate::messages::std_msgs::Float64;
use crate::messages::{Message, from_cdr_body};
use flexdrill_core::inputs::{Conditioner, InputKind, Rejection};
use flexdrill_realtime::link::Targets;

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

/// A sample as its message, and who wrote it.
fn decode<M: Message>(sample: Sample) -> Result<(M, Guid), String> {
    match sample {
        Sample::Body { writer, body } => from_cdr_body(&body)
            .map(|(message, _)| (message, writer))
            .map_err(|error| error.to_string()),
        Sample::Unreadable(why) => Err(why),
    }
}

/// Conditions the samples of one input for as long as it is polled.
pub async fn receive(
    rig: RigInputs,
    kind: InputKind,
    samples: Arc<Inbox<Sample>>,
    record: Option<SyncSender<Received>>,
) {
    let mut logged: Option<Instant> = None;
    let mut not_logged = 0_u64;
    loop {
        let value = match decode::<Float64>(samples.next().await) {
            Ok((sample, _writer)) => sample.data,
            Err(why) => {
                tracing::warn!("{}: a sample could not be read: {why}", kind.topic());
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
pub async fn follow_clock(rig: RigInputs, ticks: Arc<Inbox<Sample>>, newest: Arc<AtomicU64>) {
    loop {
        let Ok((Clock { clock }, _)) = decode::<Clock>(ticks.next().await) else {
            continue;
        };
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
