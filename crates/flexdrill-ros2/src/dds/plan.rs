//! The endpoints that the DDS process creates: names, types and qualities of service.

use serde::{Deserialize, Serialize};

use crate::dds::network::Network;

/// Time for which a reader may stall before writes are refused (s): longer than the lease after which DDS drops a dead
/// reader.
const STALL_TIME: f64 = 15.0;

/// Longest reply of a service (bytes): a client may ask for any number of parameters at once.
pub const MOST_REPLY: usize = 120_000;

/// Bytes of the prefix that all endpoints of a participant share.
pub type GuidPrefix = [u8; 12];
/// The global id of an endpoint on the network.
pub type Guid = [u8; 16];

/// One node with all its endpoints.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Plan {
    /// Domain and reach.
    pub network: Network,
    /// Namespace of the node.
    pub namespace: String,
    /// Name of the node.
    pub node: String,
    /// Topics to write.
    pub writers: Vec<WriterPlan>,
    /// Topics to read.
    pub readers: Vec<ReaderPlan>,
    /// Services to serve.
    pub services: Vec<ServicePlan>,
    /// Earlier participants of this node, which other programs may not have dropped yet.
    pub former: Vec<GuidPrefix>,
}

/// A topic to write.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WriterPlan {
    /// Absolute name.
    pub topic: String,
    /// DDS type, such as `std_msgs::msg::dds_::Float64_`.
    pub dds_type: String,
    /// Its qualities of service.
    pub offer: Offer,
}

/// A topic to read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReaderPlan {
    /// Absolute name.
    pub topic: String,
    /// DDS type, such as `std_msgs::msg::dds_::Float64_`.
    pub dds_type: String,
    /// Requests the samples written before, and lost samples again.
    pub latched: bool,
    /// Requests lost samples again.
    pub reliable: bool,
}

/// A service.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ServicePlan {
    /// Absolute name.
    pub name: String,
    /// Type, such as `std_srvs/srv/Trigger`.
    pub ros_type: String,
}

/// The qualities of service that a writer offers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Offer {
    /// Sends lost samples again.
    pub reliable: bool,
    /// Keeps the last samples for readers that come later.
    pub latched: bool,
    /// History depth as announced to readers.
    pub depth: i32,
    /// Highest rate of publication (Hz), for the size of the history.
    pub rate: f64,
    /// How long a sample is valid (s); none: for ever.
    pub lifespan: Option<f64>,
}

impl Offer {
    /// Reliable, the last ten samples for readers that are there, at this rate at most (Hz): what ROS 2 offers by default.
    pub const fn usual(rate: f64) -> Self {
        Self {
            reliable: true,
            latched: false,
            depth: 10,
            rate,
            lifespan: None,
        }
    }

    /// Most samples kept for readers that have not acknowledged.
    pub fn max_samples(&self) -> i32 {
        if self.latched {
            // A late reader receives all samples in the history, so that it must not be longer than the depth.
            self.depth.max(1)
        } else {
            ((self.rate * STALL_TIME).ceil() as i32).clamp(32, 8192)
        }
    }

    /// Whether its newest sample is a state that a restarted process must publish again.
    pub fn is_state(&self) -> bool {
        self.latched && self.depth == 1
    }
}

/// The DDS name of an absolute ROS topic: `/a/b` is `rt/a/b`. A name without a leading slash is a DDS name already, such as
/// those of [`service_topics`].
pub fn dds_topic_name(topic: &str) -> String {
    match topic.strip_prefix('/') {
        Some(_) => format!("rt{topic}"),
        None => topic.to_owned(),
    }
}

/// The DDS topics of a service, with their types: its requests and its replies. `/a/b` is `rq/a/bRequest` and `rr/a/bReply`,
/// `std_srvs/srv/Trigger` is `std_srvs::srv::dds_::Trigger_Request_` and `..._Response_`; a service of an action has `action`
/// in the place of `srv`.
pub fn service_topics(name: &str, ros_type: &str) -> [(String, String); 2] {
    let (package, kind) = ros_type.split_once('/').unwrap_or((ros_type, ""));
    let (folder, kind) = kind.rsplit_once('/').unwrap_or(("srv", kind));
    let dds_type = |part: &str| format!("{package}::{folder}::dds_::{kind}_{part}_");
    [
        (format!("rq{name}Request"), dds_type("Request")),
        (format!("rr{name}Reply"), dds_type("Response")),
    ]
}

/// The DDS name of a ROS message type: `std_msgs/msg/Float64` is `std_msgs::msg::dds_::Float64_`.
pub fn dds_type_name(ros_type: &str) -> String {
    let (package, name) = ros_type.split_once('/').unwrap_or((ros_type, ""));
    let (folder, name) = name.rsplit_once('/').unwrap_or(("msg", name));
    format!("{package}::{folder}::dds_::{name}_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_on_the_wire() {
        assert_eq!(dds_topic_name("/rig_7/twin/status"), "rt/rig_7/twin/status");
        let [requests, replies] = service_topics("/rig_7/flexdrill/reset", "std_srvs/srv/Trigger");
        assert_eq!(dds_topic_name(&requests.0), "rq/rig_7/flexdrill/resetRequest");
        assert_eq!(dds_topic_name(&replies.0), "rr/rig_7/flexdrill/resetReply");
        assert_eq!(requests.1, "std_srvs::srv::dds_::Trigger_Request_");
        assert_eq!(replies.1, "std_srvs::srv::dds_::Trigger_Response_");
        let [requests, replies] =
            service_topics("/flexdrill/a/_action/get_result", "flexdrill/action/WhatIf_GetResult");
        assert_eq!(requests.0, "rq/flexdrill/a/_action/get_resultRequest");
        assert_eq!(replies.1, "flexdrill::action::dds_::WhatIf_GetResult_Response_");
        assert_eq!(
            dds_type_name("flexdrill/action/WhatIf_FeedbackMessage"),
            "flexdrill::action::dds_::WhatIf_FeedbackMessage_"
        );
        assert_eq!(
            dds_type_name("flexdrill/msg/TwinStatus"),
            "flexdrill::msg::dds_::TwinStatus_"
        );
    }

    #[test]
    fn history_outlasts_a_stall_and_latched_topics_keep_one() {
        let offer = Offer {
            reliable: true,
            latched: false,
            depth: 10,
            rate: 50.0,
            lifespan: None,
        };
        assert_eq!(offer.max_samples(), 750);
        let state = Offer {
            latched: true,
            depth: 1,
            ..offer
        };
        assert_eq!(state.max_samples(), 1);
        assert!(state.is_state() && !offer.is_state());
    }
}
