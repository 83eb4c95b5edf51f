//! How the server's nodes behave when clients read, write, subscribe and call.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use ::opcua::server::CreateMonitoredItem;
use ::opcua::server::address_space::{AddressSpace, NodeType};
use ::opcua::server::diagnostics::NamespaceMetadata;
use ::opcua::server::node_manager::memory::{
    CoreNodeManagerBuilder, CoreNodeManagerImpl, InMemoryNodeManagerImpl, InMemoryNodeManagerImplBuilder,
};
use ::opcua::server::node_manager::{
    MethodCall, MonitoredItemRef, MonitoredItemUpdateRef, ParsedReadValueId, RequestContext, ServerContext, WriteNode,
};
use ::opcua::sync::RwLock;
use ::opcua::types::{
    AttributeId, DataValue, MethodId, MonitoringMode, NodeId, NumericRange, StatusCode, TimestampsToReturn, Variant,
};
use async_trait::async_trait;
use tokio::sync::mpsc;

use super::event::ServerEvent;
use crate::Quantity;
use flexdrill_core::inputs::Unit;

/// A target that a user may write.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) quantity: Quantity,
    pub(super) unit: Unit,
}

pub(super) struct TwinNodes {
    pub(super) namespaces: Vec<NamespaceMetadata>,
    pub(super) targets: HashMap<NodeId, Target>,
    pub(super) events: mpsc::Sender<ServerEvent>,
    /// A client has subscribed to events: the conditions that stand are sent to it.
    pub(super) refresh: Arc<AtomicBool>,
}

impl TwinNodes {
    /// Sends a written target on. The address space has checked its type and the user's right.
    fn write_target(&self, context: &RequestContext, write: &WriteNode) -> Result<(), StatusCode> {
        let written = write.value();
        let target = self.targets.get(&written.node_id).ok_or(StatusCode::BadNotWritable)?;
        if written.attribute_id != AttributeId::Value || written.index_range != NumericRange::None {
            return Err(StatusCode::BadWriteNotSupported);
        }
        if written.value.status.is_some_and(|status| !status.is_good()) {
            return Err(StatusCode::BadWriteNotSupported);
        }
        let Some(Variant::Double(value)) = written.value.value else {
            return Err(StatusCode::BadTypeMismatch);
        };
        let value = target.unit.to_si(value);
        let [least, most] = target.quantity.plausible();
        if !(least..=most).contains(&value) {
            return Err(StatusCode::BadOutOfRange);
        }
        let event = ServerEvent::Written {
            quantity: target.quantity,
            value,
            user: context.user_token().0.clone(),
        };
        self.events
            .try_send(event)
            .map_err(|_| StatusCode::BadTooManyOperations)
    }
}

#[async_trait]
impl InMemoryNodeManagerImpl for TwinNodes {
    async fn init(&self, _space: &mut AddressSpace, _context: ServerContext) {}

    fn name(&self) -> &str {
        "twin"
    }

    fn namespaces(&self) -> Vec<NamespaceMetadata> {
        self.namespaces.clone()
    }

    async fn create_event_monitored_items(
        &self,
        _context: &RequestContext,
        _space: &RwLock<AddressSpace>,
        _items: &mut [&mut &mut CreateMonitoredItem],
    ) {
        self.refresh.store(true, Ordering::Relaxed);
    }

    async fn write(
        &self,
        context: &RequestContext,
        space: &RwLock<AddressSpace>,
        nodes: &mut [&mut WriteNode],
    ) -> Result<(), StatusCode> {
        let mut space = space.write();
        let type_tree = context.type_tree().read();
        for write in nodes {
            let allowed = space
                .validate_node_write(context, write.value(), &*type_tree)
                .map(|_| ());
            let written = allowed.and_then(|()| self.write_target(context, write));
            write.set_status(written.err().unwrap_or(StatusCode::Good));
            if written.is_err() {
                continue;
            }
            let value = DataValue::new_now(write.value().value.value.clone().unwrap_or_default());
            if let Some(NodeType::Variable(variable)) = space.find_mut(&write.value().node_id) {
                variable.set_data_value(value.clone());
            }
            context.subscriptions().notify_data_change(std::iter::once((
                value,
                &write.value().node_id,
                AttributeId::Value,
            )));
        }
        Ok(())
    }

    async fn call(
        &self,
        _context: &RequestContext,
        _space: &RwLock<AddressSpace>,
        calls: &mut [&mut &mut MethodCall],
    ) -> Result<(), StatusCode> {
        for call in calls {
            call.set_status(StatusCode::BadNotSupported);
        }
        Ok(())
    }
}

/// The nodes of the standard, with `ConditionRefresh`, which the crate's own lack.
pub(super) struct CoreNodes {
    inner: CoreNodeManagerImpl,
    refresh: Arc<AtomicBool>,
}

impl CoreNodes {
    pub(super) fn new(context: ServerContext, space: &mut AddressSpace, refresh: Arc<AtomicBool>) -> Self {
        Self {
            inner: CoreNodeManagerBuilder.build(context, space),
            refresh,
        }
    }
}

#[async_trait]
impl InMemoryNodeManagerImpl for CoreNodes {
    async fn init(&self, space: &mut AddressSpace, context: ServerContext) {
        self.inner.init(space, context).await;
    }

    fn name(&self) -> &str {
        self.inner.name()
    }

    fn namespaces(&self) -> Vec<NamespaceMetadata> {
        self.inner.namespaces()
    }

    async fn read_values(
        &self,
        context: &RequestContext,
        space: &RwLock<AddressSpace>,
        nodes: &[&ParsedReadValueId],
        max_age: f64,
        timestamps: TimestampsToReturn,
    ) -> Vec<DataValue> {
        self.inner.read_values(context, space, nodes, max_age, timestamps).await
    }

    async fn create_value_monitored_items(
        &self,
        context: &RequestContext,
        space: &RwLock<AddressSpace>,
        items: &mut [&mut &mut CreateMonitoredItem],
    ) {
        self.inner.create_value_monitored_items(context, space, items).await;
    }

    async fn create_event_monitored_items(
        &self,
        _context: &RequestContext,
        _space: &RwLock<AddressSpace>,
        _items: &mut [&mut &mut CreateMonitoredItem],
    ) {
        // The server object sends the twin's events too.
        self.refresh.store(true, Ordering::Relaxed);
    }

    async fn set_monitoring_mode(&self, context: &RequestContext, mode: MonitoringMode, items: &[&MonitoredItemRef]) {
        self.inner.set_monitoring_mode(context, mode, items).await;
    }

    async fn modify_monitored_items(&self, context: &RequestContext, items: &[&MonitoredItemUpdateRef]) {
        self.inner.modify_monitored_items(context, items).await;
    }

    async fn delete_monitored_items(&self, context: &RequestContext, items: &[&MonitoredItemRef]) {
        self.inner.delete_monitored_items(context, items).await;
    }

    async fn call(
        &self,
        context: &RequestContext,
        space: &RwLock<AddressSpace>,
        calls: &mut [&mut &mut MethodCall],
    ) -> Result<(), StatusCode> {
        let refresh = [
            MethodId::ConditionType_ConditionRefresh,
            MethodId::ConditionType_ConditionRefresh2,
        ];
        let refresh = refresh.map(NodeId::from);
        for call in calls.iter_mut() {
            if refresh.contains(call.method_id()) {
                self.refresh.store(true, Ordering::Relaxed);
                call.set_status(StatusCode::Good);
            }
        }
        let mut others: Vec<&mut &mut MethodCall> = calls
            .iter_mut()
            .map(|call| &mut **call)
            .filter(|call| !refresh.contains(call.method_id()))
            .collect();
        if others.is_empty() {
            return Ok(());
        }
        self.inner.call(context, space, &mut others).await
    }
}
