//! Operators' requests to the node, and the endpoints for them.

use super::{Control, PERIOD, Refused};
use crate::DashboardError;
use flexdrill_messages::std_srvs::{SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse};
use flexdrill_messages::{
    AcknowledgeAlarmRequest, AcknowledgeAlarmResponse, ConfirmMappingRequest, ConfirmMappingResponse,
    ShelveAlarmRequest, ShelveAlarmResponse, UnshelveAlarmRequest, UnshelveAlarmResponse, topics,
};
use flexdrill_ros2::args::NodeIdentity;
use flexdrill_ros2::client::{CallError, ServiceClient};
use flexdrill_ros2::dds::plan::Offer;
use flexdrill_ros2::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_text::{log_ending, printable};

/// Longest name of an operator (characters).
const LONGEST_NAME: usize = 100;

/// An operator's request to the node, or to the bridge of its rig.
pub(crate) enum Action {
    Acknowledge {
        id: String,
        reason: String,
    },
    /// For `duration` (s), or without one until the condition ends.
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
    /// What a bridge makes of a source was compared with the rig's display.
    ConfirmMapping {
        source: String,
        mapping: String,
    },
}

/// The endpoints for steering and requests.
pub(crate) struct ControlParts {
    /// Absolute name of this node.
    pub node: String,
    pub inputs: TopicPublisher,
    acknowledge: ServiceClient,
    shelve: ServiceClient,
    unshelve: ServiceClient,
    reset: ServiceClient,
    pause: ServiceClient,
    confirm: ServiceClient,
    /// Absolute name of that service.
    pub confirm_name: String,
}

impl ControlParts {
    /// Creates the endpoints at `port`, from the node `own` to the node `twin`; `identity` is unique to this process.
    pub fn new(
        port: &mut PortBuilder,
        own: &NodeIdentity,
        twin: &NodeIdentity,
        identity: u64,
    ) -> Result<Self, DashboardError> {
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
        // The bridge stands in the namespace of the twin, under its usual name.
        let bridge = NodeIdentity::new(&twin.namespace, topics::WITS_BRIDGE)?;
        let confirm_name = bridge.expand(topics::CONFIRM_MAPPING)?;
        let confirm = ServiceClient::new(port, &confirm_name, "flexdrill/srv/ConfirmMapping", identity);
        let mut client = |name: &str, kind: &str| -> Result<ServiceClient, DashboardError> {
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
            confirm,
            confirm_name,
        })
    }
}

impl Control {
    /// Sends a request to the node, and returns the node's message.
    pub async fn carry_out(&self, operator: &str, action: Action) -> Result<String, Refused> {
        // The name is checked once for all actions; the twin writes it into its journal.
        let operator_name = checked_name(operator)?;
        let (monitor, parts) = (&self.monitor, &self.parts);
        let answered = match action {
            Action::Acknowledge { id, reason } => {
                let request = AcknowledgeAlarmRequest {
                    id,
                    operator_name,
                    reason,
                };
                let answer = parts.acknowledge.call(monitor, &request).await;
                answer.map(|AcknowledgeAlarmResponse { success, message }| (success, message))
            }
            Action::Shelve { id, reason, duration } => {
                let request = ShelveAlarmRequest {
                    // Without a duration an alarm is shelved for one occurrence, as ISA 18.2 calls it.
                    id,
                    one_shot: duration.is_none(),
                    duration: duration.unwrap_or_default(),
                    operator_name,
                    reason,
                };
                let answer = parts.shelve.call(monitor, &request).await;
                answer.map(|ShelveAlarmResponse { success, message }| (success, message))
            }
            Action::Unshelve { id, reason } => {
                let request = UnshelveAlarmRequest {
                    id,
                    operator_name,
                    reason,
                };
                let answer = parts.unshelve.call(monitor, &request).await;
                answer.map(|UnshelveAlarmResponse { success, message }| (success, message))
            }
            Action::Reset => {
                // A reset ends the run for everyone, so it is logged here with its
                // operator; the service has no field for the name.
                if let Some(more) = log_ending("requests a reset") {
                    tracing::info!("{operator_name} requests a reset{more}");
                }
                let answer = parts.reset.call(monitor, &TriggerRequest::default()).await;
                answer.map(|TriggerResponse { success, message }| (success, message))
            }
            Action::Pause(data) => {
                let verb = if data { "pause" } else { "resume" };
                if let Some(more) = log_ending(verb) {
                    tracing::info!("{operator_name} requests to {verb}{more}");
                }
                let answer = parts.pause.call(monitor, &SetBoolRequest { data }).await;
                answer.map(|SetBoolResponse { success, message }| (success, message))
            }
            Action::ConfirmMapping { source, mapping } => {
                let request = ConfirmMappingRequest {
                    source,
                    mapping,
                    operator_name,
                };
                let answer = parts.confirm.call(monitor, &request).await;
                answer.map(|ConfirmMappingResponse { success, message }| (success, message))
            }
        };
        // A refusal is the node's answer and is shown as it is; no answer
        // at all is another state, in which a retry helps.
        match answered {
            Ok((true, message)) => Ok(message),
            Ok((false, message)) => Err(Refused::Conflict(message)),
            Err(error @ (CallError::NoServer { .. } | CallError::NoReply { .. } | CallError::Encoding { .. })) => {
                Err(Refused::Away(error.to_string()))
            }
        }
    }
}

/// The operator's name, without blanks at its ends.
///
/// # Errors
/// When it is empty, too long, or has control characters.
pub(crate) fn checked_name(operator: &str) -> Result<String, Refused> {
    let name = operator.trim();
    let length = name.chars().count();
    if length == 0 || length > LONGEST_NAME || printable(name) != name {
        return Err(Refused::Wrong(format!(
            "the operator's name has {length} characters; it must have 1 to {LONGEST_NAME}, and no control characters or marks \
             of direction"
        )));
    }
    Ok(name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_needs_the_operators_name() {
        assert_eq!(checked_name(" Kim ").unwrap(), "Kim");
        for wrong in ["", "  ", "a\nb", "Kim \u{202e}mmiK", &"x".repeat(101)] {
            assert!(checked_name(wrong).is_err(), "{wrong}");
        }
    }
}
