//! Steering and requests to the node, for who shows the token.
//!
//! The server steers as any rig does, by `rig/inputs`, ten times a second, and only while it is the one publisher: where
//! another sends an input, it does not begin, and stops. A page that steers says every second that it is still there.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::session::Limit;
use super::token::Token;
use crate::dds::plan::Offer;
use crate::dds::port::{Monitor, PortBuilder, TopicPublisher};
use crate::messages::builtin_interfaces::Time;
use crate::messages::std_msgs::Header;
use crate::messages::std_srvs::{SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse};
use crate::messages::{
    AcknowledgeAlarmRequest, AcknowledgeAlarmResponse, RigInputs, ShelveAlarmRequest, ShelveAlarmResponse, TwinStatus,
    UnshelveAlarmRequest, UnshelveAlarmResponse, to_cdr_body, topics,
};
use crate::ros::args::NodeIdentity;
use crate::ros::client::{CallError, ServiceClient};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Time between two samples.
pub(super) const PERIOD: Duration = Duration::from_millis(100);
/// Steering ends when the page has said nothing for so long: three of its words, which come each second.
pub(super) const DEAD_MAN: Duration = Duration::from_secs(3);
/// A stamp of the twin that is further from the clock than this is that of a recording's or simulator's clock (ns).
const OTHER_CLOCK: i64 = 10_000_000_000;
/// Longest name of an operator (characters).
const LONGEST_NAME: usize = 100;

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

/// What an operator asks of the node.
pub(super) enum Ask {
    Acknowledge {
        id: String,
        reason: String,
    },
    /// For so long (s); without, until its condition has gone.
    Shelve {
        id: String,
        reason: String,
        duration: Option<f64>,
    },
    Unshelve {
        id: String,
        reason: String,
    },
    Reset,
    Pause(bool),
}

/// While the page steers. Values are speed (r/min) and weight (kN).
#[derive(Debug, Clone)]
struct Drive {
    operator: String,
    target: [f64; 2],
    sent: [f64; 2],
    limits: [Limit; 2],
    renewed: Instant,
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

/// Its endpoints, named before DDS is up.
pub(super) struct ControlParts {
    /// Absolute name of this node.
    node: String,
    inputs: TopicPublisher,
    acknowledge: ServiceClient,
    shelve: ServiceClient,
    unshelve: ServiceClient,
    reset: ServiceClient,
    pause: ServiceClient,
}

impl ControlParts {
    /// At `port`, of the node `own` that speaks to the node called `twin`; `identity` is of this process alone.
    pub fn new(port: &mut PortBuilder, own: &NodeIdentity, twin: &NodeIdentity, identity: u64) -> anyhow::Result<Self> {
        let offer = Offer {
            reliable: true,
            latched: false,
            depth: 10,
            rate: 1.0 / PERIOD.as_secs_f64(),
            lifespan: None,
        };
        let inputs = port.publisher(
            &twin.expand(topics::RIG_INPUTS.name)?,
            topics::RIG_INPUTS.kind.dds_type,
            offer,
        );
        let mut client = |name: &str, kind: &str| -> anyhow::Result<ServiceClient> {
            Ok(ServiceClient::new(port, &twin.expand(name)?, kind, identity))
        };
        Ok(Self {
            node: own.full_name(),
            inputs,
            acknowledge: client("~/acknowledge_alarm", "flexdrill/srv/AcknowledgeAlarm")?,
            shelve: client("~/shelve_alarm", "flexdrill/srv/ShelveAlarm")?,
            unshelve: client("~/unshelve_alarm", "flexdrill/srv/UnshelveAlarm")?,
            reset: client("~/reset", "std_srvs/srv/Trigger")?,
            pause: client("~/pause", "std_srvs/srv/SetBool")?,
        })
    }
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

    /// Asks the node; what it says.
    pub async fn ask(&self, operator: &str, ask: Ask) -> Result<String, Refused> {
        let operator_name = named(operator)?;
        let (monitor, parts) = (&self.monitor, &self.parts);
        let asked = match ask {
            Ask::Acknowledge { id, reason } => {
                let request = AcknowledgeAlarmRequest {
                    id,
                    operator_name,
                    reason,
                };
                let answer = parts.acknowledge.call(monitor, &request).await;
                answer.map(|AcknowledgeAlarmResponse { success, message }| (success, message))
            }
            Ask::Shelve { id, reason, duration } => {
                let request = ShelveAlarmRequest {
                    id,
                    one_shot: duration.is_none(),
                    duration: duration.unwrap_or_default(),
                    operator_name,
                    reason,
                };
                let answer = parts.shelve.call(monitor, &request).await;
                answer.map(|ShelveAlarmResponse { success, message }| (success, message))
            }
            Ask::Unshelve { id, reason } => {
                let request = UnshelveAlarmRequest {
                    id,
                    operator_name,
                    reason,
                };
                let answer = parts.unshelve.call(monitor, &request).await;
                answer.map(|UnshelveAlarmResponse { success, message }| (success, message))
            }
            Ask::Reset => {
                tracing::info!("{operator_name} asks for a reset");
                let answer = parts.reset.call(monitor, &TriggerRequest::default()).await;
                answer.map(|TriggerResponse { success, message }| (success, message))
            }
            Ask::Pause(data) => {
                tracing::info!("{operator_name} asks to {}", if data { "pause" } else { "go on" });
                let answer = parts.pause.call(monitor, &SetBoolRequest { data }).await;
                answer.map(|SetBoolResponse { success, message }| (success, message))
            }
        };
        match asked {
            Ok((true, message)) => Ok(message),
            Ok((false, message)) => Err(Refused::Conflict(message)),
            Err(error @ (CallError::NoServer { .. } | CallError::NoReply { .. } | CallError::Encoding { .. })) => {
                Err(Refused::Away(error.to_string()))
            }
        }
    }
}

impl Steering {
    fn end(&mut self, why: String) {
        self.drive = None;
        self.ended = Some(why);
    }
}

impl Drive {
    /// One period towards the targets, no faster than the model follows.
    fn advance(&mut self) {
        for ((sent, target), limit) in self.sent.iter_mut().zip(self.target).zip(self.limits) {
            let most = limit.slew * PERIOD.as_secs_f64();
            *sent += (target - *sent).clamp(-most, most);
        }
    }
}

/// The name of who asks.
fn named(operator: &str) -> Result<String, Refused> {
    let name = operator.trim();
    let length = name.chars().count();
    if length == 0 || length > LONGEST_NAME || name.chars().any(char::is_control) {
        return Err(Refused::Wrong(format!(
            "operator has {length} characters; give a name of 1 to {LONGEST_NAME}"
        )));
    }
    Ok(name.to_owned())
}

/// What acts on the model (r/min, kN).
fn applied(status: &TwinStatus) -> [Option<f64>; 2] {
    let value = |input: usize| {
        status
            .input_applied
            .get(input)
            .copied()
            .filter(|value| value.is_finite())
    };
    [value(0).map(rad_per_s_to_rpm), value(1).map(n_to_kn)]
}

/// The present time on the rig's clock: the system's, or where the twin follows another clock, that one (ns since 1970).
fn measured(status: Option<(&TwinStatus, Instant)>) -> i64 {
    let clock = super::now();
    match status {
        Some((status, arrived)) => {
            let stamp = status.header.stamp.to_nanoseconds();
            let twins = stamp.saturating_add(arrived.elapsed().as_nanos() as i64);
            if (twins - clock).abs() > OTHER_CLOCK {
                twins
            } else {
                clock
            }
        }
        None => clock,
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_values_sent_go_to_the_target_no_faster_than_the_slew_limit() {
        let limit = |slew| Limit {
            min: 0.0,
            max: 100.0,
            slew,
        };
        let mut drive = Drive {
            operator: "Kim".into(),
            target: [40.0, 0.0],
            sent: [35.0, 0.5],
            limits: [limit(20.0), limit(10.0)],
            renewed: Instant::now(),
        };
        drive.advance();
        assert_eq!(drive.sent, [37.0, 0.0]);
        drive.advance();
        drive.advance();
        assert_eq!(drive.sent, [40.0, 0.0]);
    }

    #[test]
    fn who_asks_must_say_his_name() {
        assert_eq!(named(" Kim ").unwrap(), "Kim");
        for wrong in ["", "  ", "a\nb", &"x".repeat(101)] {
            assert!(named(wrong).is_err(), "{wrong}");
        }
    }
}
