//! Steering and requests to the node, for who shows the token.
//!
//! The server steers as any rig does, by `rig/inputs`, ten times a second, and only while it is the one publisher:
//! where another sends an input, it does not begin, and stops. A page that steers says every second that it is still
//! there.

mod ask;
mod drive;

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use self::ask::named;
pub(super) use self::ask::{Ask, ControlParts};
use self::drive::{Drive, applied, measured};
use super::session::Limit;
use crate::dds::port::Monitor;
use crate::live::Token;
use crate::messages::builtin_interfaces::Time;
use crate::messages::std_msgs::Header;
use crate::messages::{RigInputs, TwinStatus, to_cdr_body};

/// Time between two samples.
pub(super) const PERIOD: Duration = Duration::from_millis(100);
/// Steering ends when the page has said nothing for so long: three of its words, which come each second.
pub(super) const DEAD_MAN: Duration = Duration::from_secs(3);

/// Why a request is not carried out.
#[derive(Debug, PartialEq, thiserror::Error)]
pub(super) enum Refused {
    /// The request itself.
    #[error("{0}")]
    Wrong(String),
    /// Somebody else, or the node.
    #[error("{0}")]
    Conflict(String),
    /// The twin does not answer.
    #[error("{0}")]
    Away(String),
}

#[derive(Debug, Default)]
struct Steering {
    drive: Option<Drive>,
    /// Why it ended the last time.
    ended: Option<String>,
}

/// Acts on the twin.
pub(super) struct Control {
    token: Token,
    monitor: Monitor,
    parts: ControlParts,
    steering: Mutex<Steering>,
}

impl Control {
    pub fn new(token: Token, monitor: Monitor, parts: ControlParts) -> Self {
        Self {
            token,
            monitor,
            parts,
            steering: Mutex::default(),
        }
    }

    /// Whether who asks has shown the token.
    pub fn admits(&self, offered: &str) -> bool {
        self.token.is(offered)
    }

    fn steering(&self) -> MutexGuard<'_, Steering> {
        self.steering.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Somebody else who sends an input, as the twin names him.
    pub fn other_driver(&self, status: &TwinStatus) -> Option<String> {
        let own_id = self.monitor.health().participant.map(|prefix| hex(&prefix));
        let own_node = format!("{} @ ", self.parts.node);
        let is_own = |publisher: &str| {
            publisher.starts_with(&own_node) || own_id.as_ref().is_some_and(|id| publisher.contains(&format!("({id}.")))
        };
        let publishers = status.input_publishers.iter().flat_map(|all| all.split(", "));
        publishers
            .filter(|publisher| !publisher.is_empty() && !is_own(publisher))
            .map(str::to_owned)
            .next()
    }

    /// Begins to steer, changes the targets, or goes on.
    pub fn steer(
        &self,
        operator: &str,
        target: [f64; 2],
        limits: Option<[Limit; 2]>,
        status: Option<&TwinStatus>,
    ) -> Result<String, Refused> {
        let operator = named(operator)?;
        let limits =
            limits.ok_or_else(|| Refused::Away("the limits are not known: the twin was not heard yet".into()))?;
        for ((value, limit), (name, unit)) in target
            .iter()
            .zip(&limits)
            .zip([("rotary_speed_rpm", "r/min"), ("weight_on_bit_kn", "kN")])
        {
            if !(limit.min..=limit.max).contains(value) {
                return Err(Refused::Wrong(format!(
                    "{name} is {value}; it is between {} and {} {unit}",
                    limit.min, limit.max
                )));
            }
        }
        let status = status.ok_or_else(|| Refused::Away("the twin has gone: no status for 2 s".into()))?;
        if let Some(other) = self.other_driver(status) {
            return Err(Refused::Conflict(format!(
                "{other} drives; stop it and wait until it has been silent for the input's max_age"
            )));
        }
        let mut steering = self.steering();
        let now = Instant::now();
        if let Some(drive) = &mut steering.drive {
            if drive.operator != operator {
                return Err(Refused::Conflict(format!(
                    "{} steers on this page's server; he must release first",
                    drive.operator
                )));
            }
            (drive.target, drive.renewed) = (target, now);
        } else {
            let sent = applied(status);
            let sent = std::array::from_fn(|input| {
                let start = sent[input].unwrap_or(limits[input].min);
                start.clamp(limits[input].min, limits[input].max)
            });
            tracing::info!("{operator} steers from this page's server");
            steering.drive = Some(Drive {
                operator,
                target,
                sent,
                limits,
                renewed: now,
            });
            steering.ended = None;
        }
        Ok(format!("towards {} r/min and {} kN", target[0], target[1]))
    }

    /// Stops steering.
    pub fn release(&self, operator: &str) -> Result<String, Refused> {
        let operator = named(operator)?;
        let mut steering = self.steering();
        if steering.drive.is_none() {
            return Ok("nobody steers".into());
        }
        steering.end(format!("{operator} released it"));
        Ok("released: the node holds the values, then brings them to the safe ones".into())
    }

    /// Whether a page steers.
    pub fn is_steering(&self) -> bool {
        self.steering().drive.is_some()
    }

    /// Sends the next sample, if the page steers; to be called every [`PERIOD`].
    pub fn tick(&self, status: Option<(&TwinStatus, Instant)>) {
        let mut steering = self.steering();
        let Some(drive) = &mut steering.drive else { return };
        let end = if drive.renewed.elapsed() >= DEAD_MAN {
            Some(format!(
                "the page of {} has said nothing for {} s",
                drive.operator,
                DEAD_MAN.as_secs()
            ))
        } else {
            let other = status.and_then(|(status, _)| self.other_driver(status));
            other.map(|other| format!("{other} began to drive"))
        };
        if let Some(why) = end {
            tracing::warn!("steering ended: {why}");
            return steering.end(why);
        }
        drive.advance();
        let message = RigInputs {
            header: Header {
                stamp: Time::from_nanoseconds(measured(status)),
                frame_id: String::new(),
            },
            rotary_speed_rpm: drive.sent[0],
            weight_on_bit_kn: drive.sent[1],
            quality: RigInputs::GOOD,
            source: format!("dashboard: {}", drive.operator),
        };
        if let Ok(body) = to_cdr_body(&message) {
            self.parts.inputs.publish(body);
        }
    }

    /// How it steers, as the page gets it.
    pub fn json(&self, status: Option<&TwinStatus>) -> Value {
        let steering = self.steering();
        let drive = steering.drive.as_ref();
        let of = |values: Option<[f64; 2]>, input: usize| values.map(|values| values[input]);
        let (target, sent) = (drive.map(|drive| drive.target), drive.map(|drive| drive.sent));
        let applied = status.map_or([None; 2], applied);
        json!({
            "allowed": true,
            "driving": drive.is_some(),
            "by": drive.map(|drive| &drive.operator),
            "target_rpm": of(target, 0),
            "target_wob_kn": of(target, 1),
            "sent_rpm": of(sent, 0),
            "sent_wob_kn": of(sent, 1),
            "applied_rpm": applied[0],
            "applied_wob_kn": applied[1],
            "other_driver": status.and_then(|status| self.other_driver(status)),
            "ended": steering.ended,
            "renew_within_s": DEAD_MAN.as_secs(),
        })
    }
}

impl Steering {
    fn end(&mut self, why: String) {
        self.drive = None;
        self.ended = Some(why);
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
