//! JSON documents by topic: of each the newest is kept, and sent once per connection and change.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

use serde_json::{Value, json};

use super::{Message, Source, is_level};

/// The document that says whether bridge and twin are there. It is sent first.
pub const BRIDGE: &str = "bridge";
/// Longest prefix of topics (bytes).
const LONGEST_PREFIX: usize = 256;

/// A prefix that topics cannot have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{prefix:?} is no prefix of topics: words separated by /, without + and #, not beginning with $ or spBv1.0, at most \
     {LONGEST_PREFIX} bytes, such as rigs/rig_7"
)]
pub struct PrefixError {
    /// The prefix.
    pub prefix: String,
}

/// The newest documents.
#[derive(Debug)]
pub struct Documents {
    prefix: String,
    client_id: String,
    kept: BTreeMap<&'static str, Vec<u8>>,
    due: BTreeSet<&'static str>,
    replaced: u64,
}

impl Documents {
    /// No document yet. Without a name of the client the prefix gives one.
    ///
    /// # Errors
    /// When the prefix cannot be the beginning of a topic.
    pub fn new(prefix: &str, client_id: Option<&str>) -> Result<Self, PrefixError> {
        let is_good = prefix.len() <= LONGEST_PREFIX
            && prefix.split('/').all(is_level)
            && !prefix.starts_with('$')
            && prefix.split('/').next() != Some("spBv1.0");
        if !is_good {
            return Err(PrefixError {
                prefix: prefix.to_owned(),
            });
        }
        let client_id = client_id.map_or_else(|| prefix.replace('/', "-"), str::to_owned);
        let mut documents = Self {
            prefix: prefix.to_owned(),
            client_id,
            kept: BTreeMap::new(),
            due: BTreeSet::new(),
            replaced: 0,
        };
        documents.put(BRIDGE, &json!({"state": "online"}));
        Ok(documents)
    }

    /// The prefix of the topics.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// A new document of a topic. One that was not sent yet is replaced, and counted.
    pub fn put(&mut self, topic: &'static str, document: &Value) {
        self.kept.insert(topic, document.to_string().into_bytes());
        if !self.due.insert(topic) {
            self.replaced += 1;
        }
    }

    /// Documents that were replaced by a newer one before they were sent.
    pub fn replaced(&self) -> u64 {
        self.replaced
    }

    fn message(&self, topic: &str, payload: Vec<u8>) -> Message {
        Message {
            topic: format!("{}/{topic}", self.prefix),
            payload,
            acknowledged: true,
            retained: true,
        }
    }

    fn gone(&self, why: &str) -> Message {
        let document = json!({"state": "offline", "reason": why});
        self.message(BRIDGE, document.to_string().into_bytes())
    }
}

impl Source for Documents {
    fn client_id(&self) -> String {
        self.client_id.clone()
    }

    fn will(&mut self) -> Message {
        self.gone("the connection of the bridge was lost; the other documents are old")
    }

    fn subscriptions(&self) -> Vec<String> {
        Vec::new()
    }

    fn connected(&mut self, _now: Instant) {
        // A broker that was restarted may have lost what it kept.
        self.due = self.kept.keys().copied().collect();
    }

    fn disconnected(&mut self) {}

    fn next(&mut self, _now: Instant) -> Option<Message> {
        let topic = match self.due.take(BRIDGE) {
            Some(first) => first,
            None => self.due.pop_first()?,
        };
        let payload = self.kept.get(topic)?.clone();
        Some(self.message(topic, payload))
    }

    fn received(&mut self, topic: &str, _payload: &[u8]) -> String {
        format!("a message on {topic:?} was not asked for; it is ignored")
    }

    fn farewell(&mut self) -> Message {
        self.gone("the bridge was stopped; the other documents are old")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_document_of_a_topic_is_sent_once_per_change_and_connection() {
        let now = Instant::now();
        let mut documents = Documents::new("rigs/7", None).unwrap();
        let sent = |documents: &mut Documents| {
            std::iter::from_fn(|| documents.next(now))
                .map(|message| (message.topic, String::from_utf8(message.payload).unwrap()))
                .collect::<Vec<_>>()
        };
        documents.put("alarms", &json!({"n": 1}));
        documents.put("alarms", &json!({"n": 2}));
        assert_eq!(documents.replaced(), 1);
        let all = vec![
            ("rigs/7/bridge".to_owned(), r#"{"state":"online"}"#.to_owned()),
            ("rigs/7/alarms".to_owned(), r#"{"n":2}"#.to_owned()),
        ];
        assert_eq!(sent(&mut documents), all);
        assert!(sent(&mut documents).is_empty());
        documents.connected(now);
        assert_eq!(sent(&mut documents), all);
        assert_eq!(documents.replaced(), 1);
        assert_eq!(documents.client_id(), "rigs-7");
        assert!(documents.will().retained && documents.farewell().retained);
        for wrong in [
            "",
            "/a",
            "a/",
            "a//b",
            "a/+",
            "#",
            "$SYS/a",
            "spBv1.0/a",
            "a\nb",
            &"a".repeat(300),
        ] {
            assert!(Documents::new(wrong, None).is_err(), "{wrong:?}");
        }
    }
}
