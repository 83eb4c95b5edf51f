//! `~/get_type_description`: the definition of a message or service type of this node, for tools without its package.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::service::{ServiceMapping, ServiceServer, Task, at_once};
use crate::dds::port::PortBuilder;
use flexdrill_messages::type_description_interfaces::{
    Field, FieldType, GetTypeDescriptionRequest, GetTypeDescriptionResponse, IndividualTypeDescription, KeyValue,
    TypeDescription, TypeSource,
};
use flexdrill_messages::{find_action, find_service, find_type, generated};
use flexdrill_text::printable;

/// Why a type is not described.
#[derive(Debug, thiserror::Error)]
enum NoDescription {
    #[error(
        "this node knows no type '{0}'; it describes the types of its topics, services and actions (`ros2 node info`), \
         and their parts"
    )]
    Unknown(String),
    #[error("{name} has the hash {here} here, not '{asked}': the request is for another definition")]
    Hash {
        name: &'static str,
        here: &'static str,
        asked: String,
    },
    #[error("the description of {name} cannot be read: {source}")]
    Unreadable {
        name: &'static str,
        source: serde_json::Error,
    },
}

/// [`TypeInfo::description`](flexdrill_messages::TypeInfo::description).
#[derive(Deserialize)]
struct Alone {
    type_name: String,
    fields: Vec<AloneField>,
}

#[derive(Deserialize)]
struct AloneField {
    name: String,
    #[serde(rename = "type")]
    kind: AloneKind,
    #[serde(default)]
    default_value: String,
}

#[derive(Deserialize)]
struct AloneKind {
    type_id: u8,
    capacity: u64,
    string_capacity: u64,
    nested_type_name: String,
}

impl From<Alone> for IndividualTypeDescription {
    fn from(alone: Alone) -> Self {
        let fields = alone.fields.into_iter().map(|field| Field {
            name: field.name,
            type_: FieldType {
                type_id: field.kind.type_id,
                capacity: field.kind.capacity,
                string_capacity: field.kind.string_capacity,
                nested_type_name: field.kind.nested_type_name,
            },
            default_value: field.default_value,
        });
        Self {
            type_name: alone.type_name,
            fields: fields.collect(),
        }
    }
}

/// What is published of a type in addition to what it is made of.
#[derive(Clone, Copy)]
struct Known {
    name: &'static str,
    /// As [`TypeInfo::description`](flexdrill_messages::TypeInfo::description).
    description: &'static str,
    /// `msg`, `srv`, or `implicit` for the parts of a service, which have no text of their own.
    encoding: &'static str,
    text: &'static str,
}

impl Known {
    /// A message, a service, or a part of a service.
    fn find(name: &str) -> Option<Self> {
        if let Some(info) = find_type(name) {
            let is_message = info.ros_type.contains("/msg/");
            return Some(Self {
                name: info.ros_type,
                description: info.description,
                encoding: if is_message { "msg" } else { "implicit" },
                text: if is_message { info.source() } else { "" },
            });
        }
        if let Some(info) = find_service(name) {
            return Some(Self {
                name: info.ros_type,
                description: info.description,
                encoding: if info.source.is_empty() { "implicit" } else { "srv" },
                text: info.source,
            });
        }
        if let Some(info) = find_action(name) {
            return Some(Self {
                name: info.ros_type,
                description: info.description,
                encoding: "action",
                text: info.source,
            });
        }
        let event = generated::SERVICES.iter().find(|info| info.event_type == name)?;
        Some(Self {
            name: event.event_type,
            description: event.event_description,
            encoding: "implicit",
            text: "",
        })
    }

    fn alone(&self) -> Result<IndividualTypeDescription, NoDescription> {
        let read: Alone = serde_json::from_str(self.description).map_err(|source| NoDescription::Unreadable {
            name: self.name,
            source,
        })?;
        Ok(read.into())
    }

    fn source(&self) -> TypeSource {
        TypeSource {
            type_name: self.name.to_owned(),
            encoding: self.encoding.to_owned(),
            raw_file_contents: self.text.to_owned(),
        }
    }
}

/// Adds what a type is made of, directly or not, by name.
fn collect(
    of: &IndividualTypeDescription,
    found: &mut BTreeMap<String, (IndividualTypeDescription, Known)>,
) -> Result<(), NoDescription> {
    for field in &of.fields {
        let name = &field.type_.nested_type_name;
        if name.is_empty() || found.contains_key(name) {
            continue;
        }
        let known = Known::find(name).ok_or_else(|| NoDescription::Unknown(name.clone()))?;
        let nested = known.alone()?;
        found.insert(name.clone(), (nested.clone(), known));
        collect(&nested, found)?;
    }
    Ok(())
}

/// The hash of a type that a topic, a service or an action has; the parts of services are none.
fn hash_of(name: &str) -> Option<&'static str> {
    let message = find_type(name).filter(|info| info.ros_type.contains("/msg/"));
    message
        .map(|info| info.rihs01)
        .or_else(|| find_service(name).map(|info| info.rihs01))
        .or_else(|| find_action(name).map(|info| info.rihs01))
}

/// Describes the type that is asked for, if its hash is the one here. An empty hash asks for the one here.
fn describe(request: &GetTypeDescriptionRequest) -> Result<GetTypeDescriptionResponse, NoDescription> {
    let (known, hash) = Known::find(&request.type_name)
        .zip(hash_of(&request.type_name))
        .ok_or_else(|| NoDescription::Unknown(printable(&request.type_name).into_owned()))?;
    if !request.type_hash.is_empty() && request.type_hash != hash {
        return Err(NoDescription::Hash {
            name: known.name,
            here: hash,
            asked: printable(&request.type_hash).into_owned(),
        });
    }
    let type_description = known.alone()?;
    let mut referenced = BTreeMap::new();
    collect(&type_description, &mut referenced)?;
    let type_sources = if request.include_type_sources {
        let nested = referenced.values().map(|(_, known)| known.source());
        std::iter::once(known.source()).chain(nested).collect()
    } else {
        Vec::new()
    };
    Ok(GetTypeDescriptionResponse {
        successful: true,
        failure_reason: String::new(),
        type_description: TypeDescription {
            type_description,
            referenced_type_descriptions: referenced.into_values().map(|(described, _)| described).collect(),
        },
        type_sources,
        extra_information: vec![KeyValue {
            key: "type_hash".to_owned(),
            value: hash.to_owned(),
        }],
    })
}

/// Creates the server; `node` is the node's full name.
pub fn serve(port: &mut PortBuilder, mapping: ServiceMapping, node: &str) -> Task {
    let kind = "type_description_interfaces/srv/GetTypeDescription";
    let server = ServiceServer::new(port, &format!("{node}/get_type_description"), kind, mapping);
    Box::pin(server.serve(at_once(|request: GetTypeDescriptionRequest| {
        describe(&request).unwrap_or_else(|why| GetTypeDescriptionResponse {
            successful: false,
            failure_reason: why.to_string(),
            ..GetTypeDescriptionResponse::default()
        })
    })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::topics;

    fn request(type_name: &str, type_hash: &str) -> GetTypeDescriptionRequest {
        GetTypeDescriptionRequest {
            type_name: type_name.into(),
            type_hash: type_hash.into(),
            include_type_sources: true,
        }
    }

    #[test]
    fn every_type_of_a_topic_is_described_with_all_that_it_is_made_of() {
        for topic in topics::ALL {
            let described = describe(&request(topic.kind.ros_type, topic.kind.rihs01)).unwrap();
            let parts = 1 + described.type_description.referenced_type_descriptions.len();
            assert_eq!(described.type_sources.len(), parts, "{}", topic.name);
            let joined: usize = described
                .type_sources
                .iter()
                .map(|source| source.raw_file_contents.len())
                .sum();
            assert!(joined <= topic.kind.schema.len() && joined > 0, "{}", topic.name);
        }
    }

    #[test]
    fn the_action_is_described_with_all_that_it_is_made_of() {
        let action = find_action("flexdrill/action/WhatIf").unwrap();
        let described = describe(&request(action.ros_type, action.rihs01)).unwrap();
        let parts = described.type_description.referenced_type_descriptions;
        let named = |name: &str| parts.iter().any(|part| part.type_name == name);
        for name in [
            "flexdrill/action/WhatIf_Goal",
            "flexdrill/action/WhatIf_SendGoal",
            "flexdrill/action/WhatIf_FeedbackMessage",
            "flexdrill/msg/WhatIfCandidate",
            "builtin_interfaces/msg/Time",
        ] {
            assert!(named(name), "{name} is missing");
        }
    }

    #[test]
    fn the_descriptions_in_the_table_can_all_be_read() {
        for info in generated::TYPES {
            assert_eq!(
                Known::find(info.ros_type).unwrap().alone().unwrap().type_name,
                info.ros_type
            );
        }
        let asked = Known::find("type_description_interfaces/srv/GetTypeDescription_Request").unwrap();
        assert_eq!(asked.alone().unwrap().fields[2].default_value, "True");
    }

    #[test]
    fn every_service_is_described_with_its_parts() {
        for info in generated::SERVICES {
            let described = describe(&request(info.ros_type, info.rihs01)).unwrap();
            let own = &described.type_description.type_description;
            let parts: Vec<_> = own
                .fields
                .iter()
                .map(|field| field.type_.nested_type_name.as_str())
                .collect();
            let name = info.ros_type;
            let expected = ["Request", "Response", "Event"].map(|part| format!("{name}_{part}"));
            assert_eq!(parts, expected, "{name}");
            let sources = &described.type_sources;
            let own = (
                sources[0].encoding.as_str(),
                sources[0].raw_file_contents.contains("---"),
            );
            // ROS 2 makes the services of an action from the action's definition.
            let of_action = name.contains("/action/");
            assert_eq!(
                own,
                if of_action { ("implicit", false) } else { ("srv", true) },
                "{name}"
            );
            for part in parts {
                let source = sources.iter().find(|source| source.type_name == part).unwrap();
                assert_eq!(
                    (source.encoding.as_str(), source.raw_file_contents.as_str()),
                    ("implicit", ""),
                    "{part}"
                );
                assert!(describe(&request(part, "")).is_err(), "{part} has no hash of its own");
            }
        }
    }

    #[test]
    fn another_definition_and_an_unknown_type_are_refused_in_words() {
        let refused = |name: &str, hash: &str| describe(&request(name, hash)).unwrap_err().to_string();
        let hash = format!("RIHS01_{}", "0".repeat(64));
        assert!(refused("std_msgs/msg/Float64", &hash).contains("has the hash RIHS01_705b"));
        assert!(refused("std_msgs/msg/Nothing\n", "").contains("no type 'std_msgs/msg/Nothing\\n'"));
        assert!(refused("std_srvs/srv/Trigger_Request", "").contains("no type"));
        assert!(refused("std_srvs/srv/Trigger", &hash).contains("has the hash RIHS01_eeff2cd6"));
    }
}
