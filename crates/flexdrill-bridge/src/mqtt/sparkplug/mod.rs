//! A Sparkplug B node (specification 3.0): births with names, aliases and units, data by exception, deaths.
//!
//! Messages are made when the connection takes them, so that their numbers have no gap however slow it is.

pub mod payload;

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;
use std::time::{Duration, Instant};

use prost::Message as _;

use super::{Message, Source, is_level};
use crate::lines;
pub use payload::{DataType, Metric, Payload, PropertySet, PropertyValue, Value};

/// Name of the metric that pairs a death with its birth.
const BIRTH_DEATH: &str = "bdSeq";
/// Name of the command that asks for a birth.
const REBIRTH: &str = "Node Control/Rebirth";
/// Least time between two births of a connection: a host that asks without end gets one a second.
const BIRTH_INTERVAL: Duration = Duration::from_secs(1);
/// Most metrics; a twin has a hundred and fifty.
const MOST_METRICS: usize = 2000;

/// Group and node, the two levels of a node's topics.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeName {
    group: String,
    node: String,
}

/// A text that is no name of a node.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{text:?} is no GROUP/NODE: two words separated by one /, without + and #, such as field_a/rig_7")]
pub struct NameError {
    /// The text.
    pub text: String,
}

impl FromStr for NodeName {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        match text.split_once('/') {
            Some((group, node)) if is_level(group) && is_level(node) => Ok(Self {
                group: group.to_owned(),
                node: node.to_owned(),
            }),
            _ => Err(NameError { text: text.to_owned() }),
        }
    }
}

impl NodeName {
    fn topic(&self, kind: &str) -> String {
        format!("spBv1.0/{}/{kind}/{}", self.group, self.node)
    }
}

/// A metric as it stands.
#[derive(Debug, Clone, PartialEq)]
struct State {
    alias: u64,
    kind: DataType,
    unit: Option<String>,
    /// `None` is "not known".
    value: Option<Value>,
    /// It changed since it was sent.
    is_due: bool,
}

/// Keeps the number of a pair of birth and death for the next start of the program.
#[derive(Default)]
struct Keep {
    by: Option<Box<dyn FnMut(u8) + Send>>,
    /// The newest number that was kept: attempts that fail use the same one.
    newest: Option<u8>,
}

impl Keep {
    fn number(&mut self, number: u8) {
        if self.newest != Some(number)
            && let Some(keep) = &mut self.by
        {
            keep(number);
            self.newest = Some(number);
        }
    }
}

impl fmt::Debug for Keep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Keep")
            .field("newest", &self.newest)
            .finish_non_exhaustive()
    }
}

/// The node and its metrics.
#[derive(Debug)]
pub struct SparkplugNode {
    name: NodeName,
    client_id: String,
    metrics: BTreeMap<String, State>,
    /// The pair of birth and death of the next connection, or of the present one.
    birth_death: u8,
    keep: Keep,
    is_connected: bool,
    is_birth_due: bool,
    born: Option<Instant>,
    seq: u8,
    births: u64,
    /// Messages that asked for a birth, and others.
    commands: [u64; 2],
    refused: u64,
}

impl SparkplugNode {
    /// A node without metrics.
    pub fn new(name: NodeName, client_id: Option<&str>) -> Self {
        let own = || format!("{}-{}-sparkplug", name.group, name.node);
        Self {
            client_id: client_id.map_or_else(own, |id| format!("{id}-sparkplug")),
            name,
            metrics: BTreeMap::new(),
            birth_death: 0,
            keep: Keep::default(),
            is_connected: false,
            is_birth_due: false,
            born: None,
            seq: 0,
            births: 0,
            commands: [0; 2],
            refused: 0,
        }
    }

    /// Continues the numbers of births and deaths of an earlier program whose last one was `last`: a death of its session
    /// that arrives late then ends none of this one. `keep` is called with each number before the first attempt to connect with it.
    #[must_use]
    pub fn continuing(mut self, last: Option<u8>, keep: impl FnMut(u8) + Send + 'static) -> Self {
        self.birth_death = last.map_or(0, |last| last.wrapping_add(1));
        self.keep.by = Some(Box::new(keep));
        self
    }

    /// Sets a number; NaN and infinite ones are "not known".
    pub fn number(&mut self, name: &str, unit: &str, value: f64) {
        let value = value.is_finite().then_some(Value::Double(value));
        self.set(name, DataType::Double, Some(unit), value);
    }

    /// Sets a yes or no; `None` is "not known".
    pub fn flag(&mut self, name: &str, value: Option<bool>) {
        self.set(name, DataType::Boolean, None, value.map(Value::Boolean));
    }

    /// Sets a small whole number.
    pub fn code(&mut self, name: &str, value: Option<u8>) {
        self.set(
            name,
            DataType::Int32,
            None,
            value.map(|value| Value::Int(u32::from(value))),
        );
    }

    /// Sets a text.
    pub fn text(&mut self, name: &str, value: Option<&str>) {
        self.set(
            name,
            DataType::String,
            None,
            value.map(|text| Value::Text(text.to_owned())),
        );
    }

    /// Makes every metric but `kept` "not known".
    pub fn forget(&mut self, kept: &[&str]) {
        for (name, state) in &mut self.metrics {
            if state.value.is_some() && !kept.contains(&name.as_str()) {
                state.value = None;
                state.is_due = true;
            }
        }
    }

    /// Births sent, messages that asked for one, other messages, and metrics left out because there were too many.
    pub fn counts(&self) -> [u64; 4] {
        [self.births, self.commands[0], self.commands[1], self.refused]
    }

    fn set(&mut self, name: &str, kind: DataType, unit: Option<&str>, value: Option<Value>) {
        if let Some(state) = self.metrics.get_mut(name) {
            if state.value != value {
                state.value = value;
                state.is_due = true;
            }
            return;
        }
        if self.metrics.len() >= MOST_METRICS {
            self.refused += 1;
            return;
        }
        let state = State {
            alias: self.metrics.len() as u64 + 1,
            kind,
            unit: unit.map(str::to_owned),
            value,
            is_due: false,
        };
        self.metrics.insert(name.to_owned(), state);
        // Data may only have metrics of the birth.
        self.is_birth_due = true;
    }

    fn birth_death_metric(&self, now: u64) -> Metric {
        Metric {
            name: Some(BIRTH_DEATH.to_owned()),
            timestamp: Some(now),
            datatype: Some(DataType::Int64 as u32),
            value: Some(Value::Long(u64::from(self.birth_death))),
            ..Metric::default()
        }
    }

    fn birth(&mut self, now: u64) -> Message {
        self.seq = 0;
        let rebirth = Metric {
            name: Some(REBIRTH.to_owned()),
            timestamp: Some(now),
            datatype: Some(DataType::Boolean as u32),
            value: Some(Value::Boolean(false)),
            ..Metric::default()
        };
        let mut metrics = vec![self.birth_death_metric(now), rebirth];
        metrics.extend(self.metrics.iter_mut().map(|(name, state)| {
            state.is_due = false;
            Metric {
                name: Some(name.clone()),
                datatype: Some(state.kind as u32),
                properties: state.unit.as_ref().map(|unit| PropertySet {
                    keys: vec!["engUnit".to_owned()],
                    values: vec![PropertyValue {
                        kind: Some(DataType::String as u32),
                        text: Some(unit.clone()),
                    }],
                }),
                ..state.metric(now)
            }
        }));
        self.births += 1;
        self.message("NBIRTH", now, metrics)
    }

    fn data(&mut self, now: u64) -> Option<Message> {
        let changed = self.metrics.values_mut().filter(|state| state.is_due);
        let metrics: Vec<Metric> = changed
            .map(|state| {
                state.is_due = false;
                state.metric(now)
            })
            .collect();
        (!metrics.is_empty()).then(|| self.message("NDATA", now, metrics))
    }

    fn death(&self) -> Message {
        let payload = Payload {
            // The will is written before the connection; a time in it would be that of the connection.
            metrics: vec![Metric {
                timestamp: None,
                ..self.birth_death_metric(0)
            }],
            ..Payload::default()
        };
        Message {
            topic: self.name.topic("NDEATH"),
            payload: payload.encode_to_vec(),
            acknowledged: true,
            retained: false,
        }
    }

    fn message(&mut self, kind: &str, now: u64, metrics: Vec<Metric>) -> Message {
        let payload = Payload {
            timestamp: Some(now),
            metrics,
            seq: Some(u64::from(self.seq)),
        };
        self.seq = self.seq.wrapping_add(1);
        Message {
            topic: self.name.topic(kind),
            payload: payload.encode_to_vec(),
            acknowledged: false,
            retained: false,
        }
    }
}

impl State {
    fn metric(&self, now: u64) -> Metric {
        Metric {
            alias: Some(self.alias),
            timestamp: Some(now),
            is_null: self.value.is_none().then_some(true),
            value: self.value.clone(),
            ..Metric::default()
        }
    }
}

/// Milliseconds since 1970.
fn milliseconds() -> u64 {
    u64::try_from(lines::now() / 1_000_000).unwrap_or_default()
}

impl Source for SparkplugNode {
    fn client_id(&self) -> String {
        self.client_id.clone()
    }

    fn will(&mut self) -> Message {
        self.keep.number(self.birth_death);
        self.death()
    }

    fn subscriptions(&self) -> Vec<String> {
        vec![self.name.topic("NCMD")]
    }

    fn connected(&mut self, _now: Instant) {
        self.is_connected = true;
        self.is_birth_due = true;
        self.born = None;
    }

    fn disconnected(&mut self) {
        // A death without a birth has no number of its own.
        if std::mem::take(&mut self.is_connected) {
            self.birth_death = self.birth_death.wrapping_add(1);
        }
    }

    fn next(&mut self, now: Instant) -> Option<Message> {
        if self.is_birth_due {
            if self.born.is_some_and(|born| now.duration_since(born) < BIRTH_INTERVAL) {
                return None;
            }
            self.is_birth_due = false;
            self.born = Some(now);
            return Some(self.birth(milliseconds()));
        }
        self.data(milliseconds())
    }

    fn received(&mut self, topic: &str, payload: &[u8]) -> String {
        let asks = topic == self.name.topic("NCMD")
            && Payload::decode(payload).is_ok_and(|payload| {
                let mut metrics = payload.metrics.iter();
                metrics
                    .any(|metric| metric.name.as_deref() == Some(REBIRTH) && metric.value == Some(Value::Boolean(true)))
            });
        self.commands[usize::from(!asks)] += 1;
        if asks {
            self.is_birth_due = true;
            "a host asks for a birth".to_owned()
        } else {
            format!("a message on {topic:?} is ignored: the only command is {REBIRTH}")
        }
    }

    fn farewell(&mut self) -> Message {
        self.death()
    }
}

#[cfg(test)]
mod tests;
