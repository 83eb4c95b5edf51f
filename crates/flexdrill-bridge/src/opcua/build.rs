//! Makes the nodes of the server.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ::opcua::nodes::{EventNotifier, ObjectBuilder, VariableBuilder};
use ::opcua::server::address_space::{AddressSpace, NodeType};
use ::opcua::server::diagnostics::NamespaceMetadata;
use ::opcua::server::node_manager::ServerContext;
use ::opcua::types::{
    DataTypeId, DataValue, DateTime, ExtensionObject, IdType, LocalizedText, NodeId, ObjectId, ObjectTypeId,
    QualifiedName, StatusCode, VariableTypeId, Variant,
};
use flexdrill_core::inputs::{MeasuredKind, Unit};
use tokio::sync::mpsc;

use super::date_time;
use super::event::ServerEvent;
use super::nodes::{Target, TwinNodes};
use super::space::{self, ALARMS, Kind, ROOT, TARGETS};
use super::units::engineering_units;
use crate::Quantity;

/// The targets that can be written, in the units of the driller.
const WRITABLE: [(Quantity, Unit); 4] = [
    (Quantity::RotarySpeed, Unit::TurnPerMinute),
    (Quantity::WeightOnBit, Unit::Kilonewton),
    (Quantity::Measured(MeasuredKind::RateOfPenetration), Unit::MetrePerHour),
    (Quantity::Measured(MeasuredKind::StandpipePressure), Unit::Megapascal),
];

pub(super) fn id(namespace: u16, path: &[&str]) -> NodeId {
    NodeId::new(namespace, path.join("/"))
}

/// Makes the nodes that do not depend on the twin.
pub(super) fn build(
    context: &ServerContext,
    space: &mut AddressSpace,
    writable: bool,
    events: mpsc::Sender<ServerEvent>,
    refresh: Arc<AtomicBool>,
) -> TwinNodes {
    let namespace = context
        .type_tree
        .write()
        .namespaces_mut()
        .add_namespace(space::NAMESPACE);
    space.add_namespace(space::NAMESPACE, namespace);
    let mut nodes = Nodes { space, namespace };
    nodes.object(&[ROOT], "flexdrill", &ObjectId::ObjectsFolder.into(), false);
    for variable in space::variables() {
        nodes.variable(
            variable.folder,
            &variable.name,
            &variable.description,
            variable.kind,
            false,
        );
    }
    nodes.folder(ALARMS);
    let mut targets = HashMap::new();
    if writable {
        for (quantity, unit) in WRITABLE {
            let description =
                "A sample of the input, as from a publisher of ROS 2: the twin holds it for a short time only";
            let node = nodes.variable(TARGETS, quantity.name(), description, Kind::Number(unit), true);
            targets.insert(node, Target { quantity, unit });
        }
    }
    TwinNodes {
        namespaces: vec![NamespaceMetadata {
            namespace_uri: space::NAMESPACE.to_owned(),
            namespace_index: namespace,
            is_namespace_subset: Some(false),
            static_node_id_types: Some(vec![IdType::String]),
            ..NamespaceMetadata::default()
        }],
        targets,
        events,
        refresh,
    }
}

pub(super) struct Nodes<'a> {
    pub(super) space: &'a mut AddressSpace,
    pub(super) namespace: u16,
}

impl Nodes<'_> {
    pub(super) fn id(&self, path: &[&str]) -> NodeId {
        id(self.namespace, path)
    }

    fn object(&mut self, path: &[&str], name: &str, parent: &NodeId, sends_events: bool) -> NodeId {
        let node = self.id(path);
        if !self.space.node_exists(&node) {
            let notifier = if sends_events {
                EventNotifier::SUBSCRIBE_TO_EVENTS
            } else {
                EventNotifier::empty()
            };
            let object = ObjectBuilder::new(
                &node,
                QualifiedName::new(self.namespace, name),
                LocalizedText::new("en", name),
            )
            .event_notifier(notifier);
            let object = if sends_events || path.len() == 1 {
                object.is_folder()
            } else {
                object.has_type_definition(ObjectTypeId::BaseObjectType)
            };
            object.organized_by(parent.clone()).insert(self.space);
        }
        node
    }

    /// The folder of that name below the root.
    fn folder(&mut self, name: &str) -> NodeId {
        let root = self.id(&[ROOT]);
        self.object(&[name], name, &root, name == ALARMS)
    }

    /// A variable; a slash in its name puts it into an object of its own.
    pub(super) fn variable(
        &mut self,
        folder: &str,
        name: &str,
        description: &str,
        kind: Kind,
        writable: bool,
    ) -> NodeId {
        let mut parent = self.folder(folder);
        let mut last = name;
        if let Some((object, rest)) = name.split_once('/') {
            parent = self.object(&[folder, object], object, &parent, false);
            last = rest;
        }
        let node = self.id(&[folder, name]);
        let qualified = QualifiedName::new(self.namespace, last);
        let mut builder = VariableBuilder::new(&node, qualified, LocalizedText::new("en", last))
            .description(LocalizedText::new("en", description))
            .data_type(kind.data_type())
            .value_rank(if kind.is_array() { 1 } else { -1 })
            .component_of(parent)
            .has_type_definition(match kind.unit() {
                Some(_) => VariableTypeId::AnalogUnitType,
                None => VariableTypeId::BaseDataVariableType,
            });
        if kind.is_array() {
            builder = builder.array_dimensions(&[0]);
        }
        if writable {
            builder = builder.writable();
        }
        builder.insert(self.space);
        if let Some(unit) = kind.unit() {
            let property = NodeId::new(self.namespace, format!("{folder}/{name}/EngineeringUnits"));
            VariableBuilder::new(&property, QualifiedName::new(0, "EngineeringUnits"), "EngineeringUnits")
                .data_type(DataTypeId::EUInformation)
                .value(Variant::from(ExtensionObject::from_message(engineering_units(unit))))
                .has_type_definition(VariableTypeId::PropertyType)
                .property_of(node.clone())
                .insert(self.space);
        }
        if let Some(variable) = self.space.find_mut(&node)
            && let NodeType::Variable(variable) = variable
        {
            variable.set_data_value(reading(None, StatusCode::BadWaitingForInitialData, None));
        }
        node
    }
}

/// A value with its status; without a value the status is bad.
pub(super) fn reading(value: Option<Variant>, status: StatusCode, stamp: Option<i64>) -> DataValue {
    let now = DateTime::now();
    let status = match value {
        // The twin speaks, and has no such value for this tool or at present.
        None if !status.is_bad() => StatusCode::BadNoData,
        _ => status,
    };
    DataValue {
        // Without a value the crate would leave the status out.
        value: Some(value.unwrap_or(Variant::Empty)),
        status: Some(status),
        source_timestamp: Some(stamp.map_or(now, date_time)),
        server_timestamp: Some(now),
        ..DataValue::default()
    }
}
