//! A topic of a bag.

use crate::BagError;
use flexdrill_messages::TypeInfo;
use flexdrill_messages::topics::Qos;

/// Encoding of the messages of ROS 2.
const CDR: &str = "cdr";

/// A topic with its type, as recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// Absolute name, such as `/rig_7/twin/status`.
    pub name: String,
    /// Type, such as `flexdrill/msg/TwinStatus`.
    pub ros_type: String,
    /// Encoding of the messages: `cdr`.
    pub encoding: String,
    /// Definition of the type; empty when the bag has none.
    pub schema: String,
    /// Language of the definition: `ros2msg`, `ros2idl`, or empty.
    pub schema_encoding: String,
    /// RIHS01 hash of the type; empty when the bag has none.
    pub type_hash: String,
    /// Offered qualities of service.
    pub qos: Vec<Qos>,
}

impl Topic {
    /// A topic with one of flexdrill's types.
    pub fn new(absolute_name: impl Into<String>, kind: &TypeInfo, qos: Qos) -> Self {
        Self {
            name: absolute_name.into(),
            ros_type: kind.ros_type.to_owned(),
            encoding: CDR.to_owned(),
            schema: kind.schema.to_owned(),
            schema_encoding: "ros2msg".to_owned(),
            type_hash: kind.rihs01.to_owned(),
            qos: vec![qos],
        }
    }

    /// Name and type, with the encoding where it is not that of ROS 2.
    pub(crate) fn in_words(&self) -> String {
        let ros_type = if self.ros_type.is_empty() {
            "no type"
        } else {
            &self.ros_type
        };
        match self.encoding.as_str() {
            CDR => format!("{} [{ros_type}]", self.name),
            other => format!("{} [{ros_type} as {other:?}]", self.name),
        }
    }

    /// Whether its messages can be read as a type.
    ///
    /// # Errors
    /// When it has another type, none, or another encoding than that of ROS 2.
    pub fn check(&self, expected: &'static str) -> Result<(), BagError> {
        if self.encoding != CDR {
            return Err(BagError::WrongEncoding {
                topic: self.name.clone(),
                found: self.encoding.clone(),
            });
        }
        if self.ros_type != expected {
            return Err(BagError::WrongType {
                topic: self.name.clone(),
                found: self.ros_type.clone(),
                expected,
            });
        }
        Ok(())
    }

    /// Whether the name matches: an absolute name exactly, a relative one in any namespace.
    pub fn is(&self, name: &str) -> bool {
        match name.strip_prefix('/') {
            Some(_) => self.name == name,
            None => self
                .name
                .strip_suffix(name)
                .is_some_and(|before| before.is_empty() || before.ends_with('/')),
        }
    }

    /// The topic's namespace, if the relative name matches: `/rig_7` for `/rig_7/twin/status`, `/` for
    /// `/twin/status`.
    pub fn namespace(&self, relative_name: &str) -> Option<&str> {
        let before = self.name.strip_suffix(relative_name)?.strip_suffix('/')?;
        Some(if before.is_empty() { "/" } else { before })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::topics;

    #[test]
    fn names_match_in_any_namespace_but_in_whole_words() {
        let topic = |name: &str| Topic::new(name, &topics::STATUS.kind, topics::STATUS.qos);
        assert!(topic("/rig_7/twin/status").is("twin/status"));
        assert!(topic("/twin/status").is("twin/status"));
        assert!(topic("/twin/status").is("/twin/status"));
        assert!(!topic("/rig_7/twin/status").is("/twin/status"));
        assert!(!topic("/other_twin/status").is("twin/status"));
        assert_eq!(topic("/a/rig_7/twin/status").namespace("twin/status"), Some("/a/rig_7"));
        assert_eq!(topic("/twin/status").namespace("twin/status"), Some("/"));
        assert_eq!(topic("/my_twin/status").namespace("twin/status"), None);
    }
}
