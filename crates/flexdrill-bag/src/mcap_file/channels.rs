//! The topics of one MCAP file, as its schema and channel records describe them.

use std::collections::HashMap;
use std::sync::Arc;

use mcap::parse_record;
use mcap::records::{Record, SchemaHeader};

use super::records::texts_fit;
use crate::{Topic, qos};

/// A type and its definition.
struct Schema {
    header: SchemaHeader,
    text: String,
}

/// The topics found so far.
#[derive(Default)]
pub(super) struct Channels {
    schemas: HashMap<u16, Schema>,
    /// Index of the topic by channel id.
    topic_of: HashMap<u16, usize>,
    pub topics: Vec<Arc<Topic>>,
}

impl Channels {
    /// Adds a schema or channel record; returns false if it is damaged. The first description of an id is used.
    pub fn add(&mut self, opcode: u8, body: &[u8]) -> bool {
        if !texts_fit(opcode, body) {
            return false;
        }
        match parse_record(opcode, body) {
            Ok(Record::Schema { header, data }) => {
                let text = String::from_utf8_lossy(&data).into_owned();
                self.schemas.entry(header.id).or_insert(Schema { header, text });
            }
            Ok(Record::Channel(channel)) => {
                if !self.topic_of.contains_key(&channel.id) {
                    self.add_channel(channel);
                }
            }
            _ => return false,
        }
        true
    }

    fn add_channel(&mut self, channel: mcap::records::Channel) {
        let schema = self.schemas.get(&channel.schema_id);
        let text = |get: fn(&Schema) -> &String| schema.map(|schema| get(schema).clone()).unwrap_or_default();
        let metadata = |key: &str| channel.metadata.get(key).cloned().unwrap_or_default();
        let topic = Topic {
            ros_type: text(|schema| &schema.header.name),
            schema: text(|schema| &schema.text),
            schema_encoding: text(|schema| &schema.header.encoding),
            type_hash: metadata("topic_type_hash"),
            qos: qos::from_yaml(&metadata("offered_qos_profiles")),
            name: channel.topic,
            encoding: channel.message_encoding,
        };
        let index = match self.topics.iter().position(|known| **known == topic) {
            Some(index) => index,
            None => {
                self.topics.push(Arc::new(topic));
                self.topics.len() - 1
            }
        };
        self.topic_of.insert(channel.id, index);
    }

    /// Number of channels.
    pub fn count(&self) -> usize {
        self.topic_of.len()
    }

    /// Index of a channel's topic.
    pub fn topic(&self, channel: u16) -> Option<usize> {
        self.topic_of.get(&channel).copied()
    }
}
