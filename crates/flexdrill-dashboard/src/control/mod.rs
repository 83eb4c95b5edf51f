//! Steering and requests to the node, for clients with the token.
//!
//! The server steers as any rig does, over `rig/inputs`, ten times per second, and only while it is the only publisher
//! of the inputs: otherwise it does not begin, or it stops. A page that steers renews its request every second.

mod action;
mod drive;

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

pub(crate) use self::action::{Action, ControlParts, checked_name};
use self::drive::{Drive, applied, measured};
use super::session::Limit;
use flexdrill_live::Token;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{RigInputs, TwinStatus, to_cdr_body};
use flexdrill_outputs::InputValues as _;
use flexdrill_ros2::dds::port::Monitor;
use flexdrill_text::{beyond, hex, log_ending, six_digits};

/// Time between two samples.
pub(crate) const PERIOD: Duration = Duration::from_millis(100);
/// Steering ends when the page has not renewed its request for this time: three renewals.
pub(crate) const DEAD_MAN: Duration = Duration::from_secs(3);

/// Why a request is refused.
#[derive(Debug, PartialEq, thiserror::Error)]
pub(crate) enum Refused {
    /// The request is malformed or out of bounds.
    #[error("{0}")]
    Wrong(String),
    /// Another driver or operator is in the way, or the node refuses.
    #[error("{0}")]
    Conflict(String),
    /// The twin does not respond.
    #[error("{0}")]
    Away(String),
}

#[derive(Debug, Default)]
struct Steering {
    drive: Option<Drive>,
    /// Why steering ended the last time.
    ended: Option<String>,
}

/// Steering of and requests to the twin.
pub(crate) struct Control {
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

    /// Absolute name of the service that confirms what a bridge makes of a rig's line.
    pub fn confirm_service(&self) -> &str {
        &self.parts.confirm_name
    }

    /// Whether the client has sent the right token.
    pub fn admits(&self, offered: &str) -> bool {
        self.token.is(offered)
    }

    fn steering(&self) -> MutexGuard<'_, Steering> {
        self.steering.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Another publisher of an input, as the twin names it.
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

    /// Begins to steer, changes the targets, or renews the request.
    pub fn steer(
        &self,
        operator: &str,
        target: [f64; 2],
        limits: Option<[Limit; 2]>,
        status: Option<&TwinStatus>,
    ) -> Result<String, Refused> {
        // The name stands in the journal, so it is checked before anything else can refer to it.
        let operator = checked_name(operator)?;
        // Limits come from the twin. Without them a target cannot be judged, and is refused rather than sent.
        let limits = limits.ok_or_else(|| {
            Refused::Away("the limits are not known, because no message of the twin has arrived yet".into())
        })?;
        for ((value, limit), (name, unit)) in target
            .iter()
            .zip(&limits)
            .zip([("rotary_speed_rpm", "r/min"), ("weight_on_bit_kn", "kN")])
        {
            // `contains` is false for NaN.
            if !(limit.min..=limit.max).contains(value) {
                let bound = if *value > limit.max { limit.max } else { limit.min };
                return Err(Refused::Wrong(format!(
                    "{name} is {}; it must be between {} and {} {unit}",
                    beyond(*value, bound),
                    six_digits(limit.min),
                    six_digits(limit.max)
                )));
            }
        }
        // A twin that is silent may have another driver by now, so nothing is sent to it.
        let status = status.ok_or_else(|| Refused::Away("the twin has not sent a status for 2 s".into()))?;
        // Two publishers of an input would raise the alarm on two drivers; this server yields to any other.
        if let Some(other) = self.other_driver(status) {
            return Err(Refused::Conflict(format!(
                "{other} drives; stop it and wait until it has been silent for the input's max_age"
            )));
        }
        // The lock comes after all checks that need none, and is held to the end: two pages cannot both begin.
        let mut steering = self.steering();
        let now = Instant::now();
        if let Some(drive) = &mut steering.drive {
            if drive.operator != operator {
                return Err(Refused::Conflict(format!(
                    "{} steers over this server; the other operator must release it first",
                    drive.operator
                )));
            }
            // A renewed request changes the target only. What has been sent so far remains the start of the ramp.
            (drive.target, drive.renewed) = (target, now);
        } else {
            // The ramp begins at what acts now, within the limits, so that taking over does not cause a jump.
            let sent = applied(status);
            let sent = std::array::from_fn(|input| {
                let start = sent[input].unwrap_or(limits[input].min);
                start.clamp(limits[input].min, limits[input].max)
            });
            if let Some(more) = log_ending("begins to steer") {
                tracing::info!("{operator} begins to steer over this server{more}");
            }
            steering.drive = Some(Drive {
                operator,
                target,
                sent,
                limits,
                renewed: now,
            });
            steering.ended = None;
        }
        Ok(format!(
            "towards {} r/min and {} kN",
            six_digits(target[0]),
            six_digits(target[1])
        ))
    }

    /// Stops steering.
    pub fn release(&self, operator: &str) -> Result<String, Refused> {
        let operator = checked_name(operator)?;
        let mut steering = self.steering();
        if steering.drive.is_none() {
            return Ok("no operator steers".into());
        }
        steering.end(format!("{operator} released it"));
        Ok("released: the node holds the values, then ramps them to the safe values".into())
    }

    /// Whether a page steers.
    pub fn is_steering(&self) -> bool {
        self.steering().drive.is_some()
    }

    /// Sends the next sample if a page steers. The caller runs it every [`PERIOD`].
    pub fn tick(&self, status: Option<(&TwinStatus, Instant)>) {
        let mut steering = self.steering();
        let Some(drive) = &mut steering.drive else { return };
        let end = if drive.renewed.elapsed() >= DEAD_MAN {
            Some(format!(
                "the page of {} has not responded for {} s",
                drive.operator,
                DEAD_MAN.as_secs()
            ))
        } else {
            let other = status.and_then(|(status, _)| self.other_driver(status));
            other.map(|other| format!("{other} began to drive"))
        };
        if let Some(why) = end {
            if let Some(more) = log_ending("steering ended") {
                tracing::warn!("steering ended: {why}{more}");
            }
            return steering.end(why);
        }
        drive.advance();
        let header = Header {
            stamp: Time::from_nanoseconds(measured(status)),
            frame_id: String::new(),
        };
        let [speed, weight] = drive.sent;
        let source = format!("dashboard: {}", drive.operator);
        // The page drives speed and weight; the rig's other inputs keep acting.
        let values = [Some(speed), Some(weight), None, None];
        let message = RigInputs::of(header, values, RigInputs::GOOD, source);
        if let Ok(body) = to_cdr_body(&message) {
            self.parts.inputs.publish(body);
        }
    }

    /// The state of steering, for the page.
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
