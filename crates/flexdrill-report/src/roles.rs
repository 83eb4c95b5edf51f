//! The meaning of a bag's topics.

use std::collections::BTreeSet;
use std::path::Path;

use crate::ReportError;
use flexdrill_bag::{Bag, Topic};
use flexdrill_messages::topics::{self, TopicInfo};

/// Outputs of the twin that the report uses.
pub(crate) const OUTPUTS: [&TopicInfo; 11] = [
    &topics::SESSION,
    &topics::APPLIED_INPUTS,
    &topics::BIT_STATE,
    &topics::JOINT_DEFLECTIONS,
    &topics::CONTACT_FORCES,
    &topics::WHIRL,
    &topics::TRANSFER,
    &topics::REACTIONS,
    &topics::ALARMS,
    &topics::ALARM_EVENTS,
    &topics::STATUS,
];
/// Outputs that the report uses where there are any: most runs have none, and nothing is missing without them.
const OPTIONAL: [&TopicInfo; 3] = [&topics::BANDS, &topics::HOLE_AHEAD, &topics::AGEING];
/// Inputs that the report uses, as received.
const INPUTS: [&TopicInfo; 5] = [
    &topics::ROTARY_SPEED_RPM,
    &topics::WEIGHT_ON_BIT_KN,
    &topics::RATE_OF_PENETRATION,
    &topics::STANDPIPE_PRESSURE,
    &topics::RIG_INPUTS,
];

/// The meaning of each topic of a bag.
#[derive(Debug)]
pub(crate) struct Roles {
    /// By the topic's index in the bag; `None` for topics that the report does not use.
    of: Vec<Option<&'static TopicInfo>>,
    /// The twin's namespace, such as `/` or `/rig_7`.
    pub namespace: String,
}

impl Roles {
    /// Finds the only twin of a bag, or the one in the namespace `wanted`.
    pub(crate) fn find(path: &Path, bag: &Bag, wanted: Option<&str>) -> Result<Self, ReportError> {
        // The outputs' own topics show the namespaces of the twins in a bag.
        let namespaces: BTreeSet<String> = bag
            .topics()
            .iter()
            .filter_map(|topic| OUTPUTS.iter().find_map(|known| namespace(topic, known)))
            .collect();
        let listed = || namespaces.iter().cloned().collect::<Vec<_>>().join(", ");
        let namespace = match (wanted, namespaces.len()) {
            (Some(wanted), _) => {
                // With or without slashes, as a user writes it.
                let wanted = format!("/{}", wanted.trim_matches('/'));
                if !namespaces.contains(&wanted) {
                    return Err(ReportError::OtherNamespace {
                        path: path.to_owned(),
                        wanted,
                        namespaces: listed(),
                    });
                }
                wanted
            }
            // Without any namespace found the topics may be remapped, which the types decide below.
            (None, 0 | 1) => namespaces.iter().next().cloned().unwrap_or_else(|| "/".to_owned()),
            (None, _) => {
                return Err(ReportError::SeveralTwins {
                    path: path.to_owned(),
                    namespaces: listed(),
                });
            }
        };
        // By name and type together: a rig's own topic may have a name of ours.
        let mut of: Vec<Option<&'static TopicInfo>> =
            bag.topics()
                .iter()
                .map(|topic| {
                    OUTPUTS.into_iter().chain(OPTIONAL).chain(INPUTS).find(|known| {
                        topic.ros_type == known.kind.ros_type && topic.name == absolute(&namespace, known)
                    })
                })
                .collect();
        // A remapped topic is recognised by its type, if no other topic has that type.
        for known in OUTPUTS.into_iter().chain(OPTIONAL) {
            let mut same = (0..of.len()).filter(|index| bag.topics()[*index].ros_type == known.kind.ros_type);
            if let (Some(only), None) = (same.next(), same.next()) {
                of[only] = Some(known);
            }
        }
        // Checked at the end, because a remapped topic counts too.
        if !of.iter().flatten().any(|known| OUTPUTS.contains(known)) {
            let present: Vec<&str> = bag.topics().iter().map(|topic| topic.name.as_str()).collect();
            return Err(ReportError::NoTwin {
                path: path.to_owned(),
                present: present.join(", "),
            });
        }
        Ok(Self { of, namespace })
    }

    /// The meaning of a topic, by its index in the bag.
    pub(crate) fn of(&self, topic_index: usize) -> Option<&'static TopicInfo> {
        self.of.get(topic_index).copied().flatten()
    }

    /// Whether the bag has this topic.
    pub(crate) fn has(&self, known: &TopicInfo) -> bool {
        self.of.iter().flatten().any(|found| *found == known)
    }
}

fn absolute(namespace: &str, known: &TopicInfo) -> String {
    format!("{}/{}", namespace.trim_end_matches('/'), known.name)
}

/// The namespace of a topic, if it is the known one.
fn namespace(topic: &Topic, known: &TopicInfo) -> Option<String> {
    if topic.ros_type != known.kind.ros_type {
        return None;
    }
    let namespace = topic.name.strip_suffix(known.name)?.strip_suffix('/')?;
    Some(if namespace.is_empty() { "/" } else { namespace }.to_owned())
}
