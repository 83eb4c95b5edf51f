//! The running server, for the side that has the twin's values.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use ::opcua::nodes::{BaseEventType, Event};
use ::opcua::server::ServerHandle;
use ::opcua::server::node_manager::memory::InMemoryNodeManager;
use ::opcua::types::{ByteString, DataValue, LocalizedText, NodeId, ObjectId, ObjectTypeId, StatusCode};
use flexdrill_messages::topics;

use super::alarms::ALARM_VARIABLES;
use super::build::{Nodes, id, reading};
use super::conditions::{Condition, Standing, severity};
use super::date_time;
use super::nodes::TwinNodes;
use super::space::{self, ALARMS, Variable};
use super::state::{Meaning, TwinState};

/// Most alarms that get nodes; the twin has some thirty.
const MOST_ALARMS: usize = 200;

/// The running server, for the side that has the twin's values.
pub struct TwinServer {
    nodes: Arc<InMemoryNodeManager<TwinNodes>>,
    handle: ServerHandle,
    namespace: u16,
    variables: Vec<(NodeId, Variable)>,
    alarms: BTreeMap<String, AlarmNodes>,
    refresh: Arc<AtomicBool>,
    /// Updates until the conditions that stand are sent.
    refresh_in: Option<u8>,
    events: u64,
}

struct AlarmNodes {
    object: NodeId,
    variables: Vec<NodeId>,
    standing: Option<Standing>,
    severity: u16,
    last_severity: u16,
    condition: Option<Condition>,
}

impl TwinServer {
    pub(super) fn new(
        nodes: Arc<InMemoryNodeManager<TwinNodes>>,
        handle: ServerHandle,
        namespace: u16,
        refresh: Arc<AtomicBool>,
    ) -> Self {
        Self {
            nodes,
            handle,
            namespace,
            variables: space::variables()
                .into_iter()
                .map(|variable| (id(namespace, &[variable.folder, &variable.name]), variable))
                .collect(),
            alarms: BTreeMap::new(),
            refresh,
            refresh_in: None,
            events: 0,
        }
    }

    /// Brings all nodes up to date at `now` (ns since 1970).
    ///
    /// # Errors
    /// When the crate refuses a value.
    pub fn update(&mut self, twin: &TwinState, now: i64) -> Result<(), StatusCode> {
        self.add_alarms(twin);
        let mut values: Vec<(NodeId, DataValue)> = self
            .variables
            .iter()
            .map(|(node, variable)| {
                let status = twin.quality(variable.topic, variable.meaning, now);
                (
                    node.clone(),
                    reading(variable.value(twin), status, variable.stamp(twin)),
                )
            })
            .collect();
        if let Some(list) = twin.alarms() {
            let status = twin.quality(&topics::ALARMS, Meaning::StatedOnChange, now);
            let stamp = Some(list.header.stamp.to_nanoseconds());
            for alarm in &list.alarms {
                let Some(nodes) = self.alarms.get(&alarm.id) else {
                    continue;
                };
                for (node, (_, _, _, read)) in nodes.variables.iter().zip(ALARM_VARIABLES) {
                    values.push((node.clone(), reading(read(alarm), status, stamp)));
                }
            }
        }
        let subscriptions = self.handle.subscriptions();
        self.nodes.set_values(
            subscriptions,
            values.iter().map(|(node, value)| (node, None, value.clone())),
        )?;
        self.send_conditions(twin, now);
        Ok(())
    }

    /// Makes the nodes of alarms that are new.
    fn add_alarms(&mut self, twin: &TwinState) {
        let Some(list) = twin.alarms() else { return };
        for alarm in &list.alarms {
            let is_name = |id: &str| {
                !id.is_empty() && id.len() <= 64 && id.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
            };
            if self.alarms.contains_key(&alarm.id) || self.alarms.len() >= MOST_ALARMS || !is_name(&alarm.id) {
                continue;
            }
            let mut space = self.nodes.address_space().write();
            let mut nodes = Nodes {
                space: &mut space,
                namespace: self.namespace,
            };
            let variables = ALARM_VARIABLES
                .iter()
                .map(|(name, description, kind, _)| {
                    nodes.variable(ALARMS, &format!("{}/{name}", alarm.id), description, *kind, false)
                })
                .collect();
            let entry = AlarmNodes {
                object: nodes.id(&[ALARMS, &alarm.id]),
                variables,
                standing: None,
                severity: 1,
                last_severity: 1,
                condition: None,
            };
            self.alarms.insert(alarm.id.clone(), entry);
        }
    }

    /// Sends an event for each alarm that changed, and all that stand where a client asked for them.
    fn send_conditions(&mut self, twin: &TwinState, now: i64) {
        let Some(list) = twin.alarms() else { return };
        // A silent twin makes its alarms uncertain; it does not end them.
        let quality = twin.quality(&topics::ALARMS, Meaning::StatedOnChange, now);
        let mut changed: Vec<Condition> = Vec::new();
        for alarm in &list.alarms {
            // An alarm of a newer twin has no node here.
            let Some(nodes) = self.alarms.get_mut(&alarm.id) else {
                continue;
            };
            let standing = Standing::of(alarm);
            // The first state is news only if the alarm is to be retained;
            // otherwise a start would send an event for every alarm at rest.
            let is_news = nodes.standing.map_or(standing.retain(), |before| before != standing);
            nodes.standing = Some(standing);
            if !is_news {
                continue;
            }
            // The number makes the event's id unique, by which a client refers to it.
            self.events += 1;
            let severity = severity(alarm.priority);
            // The last severity is that before the change, as Part 9 defines it, and not that of the last event.
            if severity != nodes.severity {
                nodes.last_severity = std::mem::replace(&mut nodes.severity, severity);
            }
            // A stamp of zero means that it was never raised, and an event needs a time.
            let time = match alarm.since.to_nanoseconds() {
                0 => date_time(now),
                since => date_time(since),
            };
            let condition = Condition::new(
                alarm,
                nodes.object.clone(),
                self.events,
                nodes.last_severity,
                time,
                quality,
            );
            nodes.condition = Some(condition.clone());
            changed.push(condition);
        }
        // Events are notified at the folder, to which clients subscribe for all alarms.
        let folder = id(self.namespace, &[ALARMS]);
        let subscriptions = self.handle.subscriptions();
        subscriptions.notify_events(changed.iter().map(|condition| (condition as &dyn Event, &folder)));
        if self.refresh.swap(false, Ordering::Relaxed) {
            // The crate registers a subscription after it has asked for it.
            self.refresh_in = Some(2);
        }
        self.refresh_in = match self.refresh_in {
            None => return,
            Some(0) => None,
            Some(updates) => Some(updates - 1),
        };
        if self.refresh_in.is_some() {
            return;
        }
        // A refresh is framed by two events, so that the client knows which conditions it may forget.
        self.events += 1;
        let event = |kind: ObjectTypeId, text: &str| {
            let id = ByteString::from([date_time(now).ticks().to_be_bytes(), self.events.to_be_bytes()].concat());
            BaseEventType::new_now(kind, id, LocalizedText::new("en", text)).set_source_node(ObjectId::Server.into())
        };
        let start = event(ObjectTypeId::RefreshStartEventType, "The conditions that stand follow.");
        let end = event(
            ObjectTypeId::RefreshEndEventType,
            "These were the conditions that stand.",
        );
        // The conditions keep the ids of their last event: a refresh repeats, it does not report something new.
        let standing = self.alarms.values().filter_map(|nodes| nodes.condition.as_ref());
        let standing = standing
            .filter(|condition| condition.retain())
            .map(|condition| condition as &dyn Event);
        let all = std::iter::once(&start as &dyn Event)
            .chain(standing)
            .chain(std::iter::once(&end as &dyn Event));
        subscriptions.notify_events(all.map(|event| (event, &folder)));
    }
}
