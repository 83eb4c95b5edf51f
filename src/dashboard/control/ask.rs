//! What operators ask of the node, and the endpoints that it is asked by.

use super::{Control, PERIOD, Refused};
use crate::dds::plan::Offer;
use crate::dds::port::{PortBuilder, TopicPublisher};
use crate::messages::std_srvs::{SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse};
use crate::messages::{
    AcknowledgeAlarmRequest, AcknowledgeAlarmResponse, ShelveAlarmRequest, ShelveAlarmResponse, UnshelveAlarmRequest,
    UnshelveAlarmResponse, topics,
};
use crate::ros::args::NodeIdentity;
use crate::ros::client::{CallError, ServiceClient};

/// Longest name of an operator (characters).
const LONGEST_NAME: usize = 100;

/// What an operator asks of the node.
pub(in crate::dashboard) enum Ask {
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

/// Its endpoints, named before DDS is up.
pub(in crate::dashboard) struct ControlParts {
    /// Absolute name of this node.
    pub node: String,
    pub inputs: TopicPublisher,
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

/// The name of who asks.
pub(super) fn named(operator: &str) -> Result<String, Refused> {
    let name = operator.trim();
    let length = name.chars().count();
    if length == 0 || length > LONGEST_NAME || name.chars().any(char::is_control) {
        return Err(Refused::Wrong(format!(
            "operator has {length} characters; give a name of 1 to {LONGEST_NAME}"
        )));
    }
    Ok(name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_asks_must_say_his_name() {
        assert_eq!(named(" Kim ").unwrap(), "Kim");
        for wrong in ["", "  ", "a\nb", &"x".repeat(101)] {
            assert!(named(wrong).is_err(), "{wrong}");
        }
    }
}
