//! The topics of one MCAP file, as its schema and channel records describe them.
//!
//! MCAP gives a channel id one meaning in a file. A file that gives it two is read up to the second one: whoever reads
//! on could take a weight for a speed.

use std::collections::HashMap;
use std::sync::Arc;

use mcap::parse_record;
use mcap::records::{Record, SchemaHeader};

use super::records::texts_fit;
use crate::{Topic, qos};

/// Place of a record in a file: offset of its segment (bytes), number of the record in the segment.
pub(super) type Place = (u64, usize);

/// A type and its definition.
struct Schema {
    header: SchemaHeader,
    text: String,
}

/// What is known of a channel id.
struct Channel {
    /// Index of its topic.
    topic: usize,
    /// The first record in the file that describes it.
    at: Place,
    /// The first record after it that gives it another topic.
    other: Option<Place>,
}

/// Result of adding a record.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Added {
    /// The record agrees with those before.
    Agrees,
    /// It cannot be parsed.
    Damaged,
    /// It shows that a channel id has two topics: the sentence that names both.
    Contradicts(String),
}

/// Why a message has no topic.
#[derive(Debug, thiserror::Error)]
pub(super) enum NoTopic {
    #[error("messages on channel {0}, which the file does not describe")]
    Unknown(u16),
    #[error("messages on channel {0}, which has two topics in this file")]
    TwoTopics(u16),
}

/// The topics found so far.
#[derive(Default)]
pub(super) struct Channels {
    schemas: HashMap<u16, Schema>,
    of: HashMap<u16, Channel>,
    pub topics: Vec<Arc<Topic>>,
}

impl Channels {
    /// Adds a schema or channel record. Records may come in any order: their places decide.
    pub fn add(&mut self, opcode: u8, body: &[u8], at: Place) -> Added {
        if !texts_fit(opcode, body) {
            return Added::Damaged;
        }
        match parse_record(opcode, body) {
            Ok(Record::Schema { header, data }) => {
                let text = String::from_utf8_lossy(&data).into_owned();
                // The newest counts for the channels after it. Those before keep theirs.
                self.schemas.insert(header.id, Schema { header, text });
                Added::Agrees
            }
            Ok(Record::Channel(channel)) => self.add_channel(channel, at),
            _ => Added::Damaged,
        }
    }

    fn add_channel(&mut self, channel: mcap::records::Channel, at: Place) -> Added {
        let id = channel.id;
        let topic = self.described(channel);
        let Some(known) = self.of.get(&id) else {
            let topic = self.index(topic);
            let other = None;
            self.of.insert(id, Channel { topic, at, other });
            return Added::Agrees;
        };
        let before = known.other;
        let Some(first) = self.topics.get(known.topic).map(Arc::clone) else {
            return Added::Damaged;
        };
        // Definition and qualities of service may be written in several ways; these three decide how bytes are read.
        let same = |a: &Topic, b: &Topic| (&a.name, &a.ros_type, &a.encoding) == (&b.name, &b.ros_type, &b.encoding);
        let (begins, changes) = (at.min(known.at), at.max(known.at));
        let (read_as, left_out) = if same(&first, &topic) {
            if let Some(known) = self.of.get_mut(&id) {
                known.at = begins;
            }
            return Added::Agrees;
        } else if at < known.at {
            (topic, Topic::clone(&first))
        } else {
            (Topic::clone(&first), topic)
        };
        let text = format!(
            "channel {id} is {} and, from byte {} on, {}: MCAP gives a channel one topic in a file, so its messages from \
             there on are left out; have the program that wrote the file write it again",
            read_as.in_words(),
            changes.0,
            left_out.in_words()
        );
        let topic = self.index(read_as);
        if let Some(known) = self.of.get_mut(&id) {
            let other = Some(before.map_or(changes, |before| before.min(changes)));
            *known = Channel {
                topic,
                at: begins,
                other,
            };
        }
        // A file with thousands of such records is named once for each channel.
        match before {
            None => Added::Contradicts(text),
            Some(_) => Added::Agrees,
        }
    }

    fn described(&self, channel: mcap::records::Channel) -> Topic {
        let schema = self.schemas.get(&channel.schema_id);
        let text = |get: fn(&Schema) -> &String| schema.map(|schema| get(schema).clone()).unwrap_or_default();
        let metadata = |key: &str| channel.metadata.get(key).cloned().unwrap_or_default();
        Topic {
            ros_type: text(|schema| &schema.header.name),
            schema: text(|schema| &schema.text),
            schema_encoding: text(|schema| &schema.header.encoding),
            type_hash: metadata("topic_type_hash"),
            qos: qos::from_yaml(&metadata("offered_qos_profiles")),
            name: channel.topic,
            encoding: channel.message_encoding,
        }
    }

    fn index(&mut self, topic: Topic) -> usize {
        match self.topics.iter().position(|known| **known == topic) {
            Some(index) => index,
            None => {
                self.topics.push(Arc::new(topic));
                self.topics.len() - 1
            }
        }
    }

    /// Number of channels.
    pub fn count(&self) -> usize {
        self.of.len()
    }

    /// Index of the topic of a message at `at`.
    ///
    /// # Errors
    /// When its channel is not described, or not in one way.
    pub fn topic(&self, channel: u16, at: Place) -> Result<usize, NoTopic> {
        let known = self.of.get(&channel).ok_or(NoTopic::Unknown(channel))?;
        // Before the first record too, nothing says which of the two topics holds.
        match known.other {
            Some(other) if at > other || at < known.at => Err(NoTopic::TwoTopics(channel)),
            _ => Ok(known.topic),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mcap::records::op;

    fn text(text: &str) -> Vec<u8> {
        [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn channel(id: u16, topic: &str) -> Vec<u8> {
        [&id.to_le_bytes()[..], &[0; 2], &text(topic), &text("cdr"), &[0; 4]].concat()
    }

    #[test]
    fn the_places_in_the_file_decide_and_not_the_order_of_reading() {
        let (speed, weight) = (channel(7, "/rpm"), channel(7, "/weight"));
        let records = [(&speed, (100, 0)), (&weight, (300, 2)), (&weight, (900, 0))];
        for order in [[0, 1, 2], [2, 1, 0], [1, 0, 2], [2, 0, 1]] {
            let mut channels = Channels::default();
            let added = order.map(|index| channels.add(op::CHANNEL, records[index].0, records[index].1));
            let named = added.iter().filter(|added| matches!(added, Added::Contradicts(_)));
            assert_eq!(named.count(), 1, "{added:?}");
            let read = |at| {
                channels
                    .topic(7, at)
                    .ok()
                    .map(|index| channels.topics[index].name.clone())
            };
            assert_eq!(read((100, 1)).as_deref(), Some("/rpm"));
            assert_eq!(read((300, 1)).as_deref(), Some("/rpm"));
            assert_eq!([read((50, 0)), read((300, 3)), read((800, 0))], [None, None, None]);
        }
    }
}
