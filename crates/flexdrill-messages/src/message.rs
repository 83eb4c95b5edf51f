//! The constants of a message type: names, hash, schema.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::generated;

/// A ROS 2 message type.
pub trait Message: Serialize + DeserializeOwned {
    /// ROS package: `flexdrill`.
    const PACKAGE: &'static str;
    /// Name within the package: `BitState`.
    const NAME: &'static str;
    /// Full name: `flexdrill/msg/BitState`.
    const ROS_TYPE: &'static str;
    /// Name of the DDS type: `flexdrill::msg::dds_::BitState_`.
    const DDS_TYPE: &'static str;
    /// Type hash: `RIHS01_` and 64 hexadecimal digits.
    const RIHS01: &'static str;
    /// Schema `ros2msg`, including the schemas of its parts.
    const SCHEMA: &'static str;
    /// The type without its parts as JSON: name and fields in the form that the hash covers, with default values.
    const DESCRIPTION: &'static str;
    /// All of these as a value.
    const INFO: TypeInfo = TypeInfo {
        package: Self::PACKAGE,
        name: Self::NAME,
        ros_type: Self::ROS_TYPE,
        dds_type: Self::DDS_TYPE,
        rihs01: Self::RIHS01,
        schema: Self::SCHEMA,
        description: Self::DESCRIPTION,
    };
}

/// The constants of a [`Message`] as a value, for tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TypeInfo {
    /// [`Message::PACKAGE`].
    pub package: &'static str,
    /// [`Message::NAME`].
    pub name: &'static str,
    /// [`Message::ROS_TYPE`].
    pub ros_type: &'static str,
    /// [`Message::DDS_TYPE`].
    pub dds_type: &'static str,
    /// [`Message::RIHS01`].
    pub rihs01: &'static str,
    /// [`Message::SCHEMA`].
    pub schema: &'static str,
    /// [`Message::DESCRIPTION`].
    pub description: &'static str,
}

impl TypeInfo {
    /// The definition of the type, without those of its parts.
    pub fn source(&self) -> &'static str {
        self.schema.split(SEPARATOR).next().unwrap_or_default()
    }

    /// The comment above a field in the definition, on one line; empty where there is none.
    pub fn comment(&self, field: &str) -> String {
        let mut comment: Vec<&str> = Vec::new();
        for line in self.source().lines() {
            match line.strip_prefix("# ") {
                Some(text) => comment.push(text.trim()),
                None if line.split_whitespace().nth(1) == Some(field) => return comment.join(" "),
                None => comment.clear(),
            }
        }
        String::new()
    }
}

/// The line between two messages of a schema.
const SEPARATOR: &str = "================================================================================\n";

/// The type of that full name, such as `std_msgs/msg/Float64`.
pub fn find_type(ros_type: &str) -> Option<&'static TypeInfo> {
    generated::TYPES.iter().find(|info| info.ros_type == ros_type)
}

/// The constants of a service type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ServiceInfo {
    /// Full name: `std_srvs/srv/Trigger`.
    pub ros_type: &'static str,
    /// Type hash of the service as a whole.
    pub rihs01: &'static str,
    /// Its definition.
    pub source: &'static str,
    /// As [`TypeInfo::description`]: its fields are request, response and event.
    pub description: &'static str,
    /// Full name of its event: `std_srvs/srv/Trigger_Event`.
    pub event_type: &'static str,
    /// The description of the event type.
    pub event_description: &'static str,
}

/// The constants of an action type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ActionInfo {
    /// Full name: `flexdrill/action/WhatIf`.
    pub ros_type: &'static str,
    /// Type hash of the action as a whole.
    pub rihs01: &'static str,
    /// Its definition.
    pub source: &'static str,
    /// As [`TypeInfo::description`]: its fields are goal, result, feedback, and the services and message that carry them.
    pub description: &'static str,
}

/// The action type of that full name.
pub fn find_action(ros_type: &str) -> Option<&'static ActionInfo> {
    generated::ACTIONS.iter().find(|info| info.ros_type == ros_type)
}

/// The service type of that full name.
pub fn find_service(ros_type: &str) -> Option<&'static ServiceInfo> {
    generated::SERVICES.iter().find(|info| info.ros_type == ros_type)
}
