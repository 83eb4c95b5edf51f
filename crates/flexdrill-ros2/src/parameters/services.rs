//! The six parameter services of a ROS 2 node, with descriptors, and `/parameter_events`.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use ros2_client::parameters::raw;
use ros2_client::rcl_interfaces::{
    DescribeParametersRequest, DescribeParametersResponse, GetParameterTypesRequest, GetParameterTypesResponse,
    GetParametersRequest, GetParametersResponse, ListParametersRequest, ListParametersResponse,
    SetParametersAtomicallyResponse, SetParametersRequest, SetParametersResponse,
};
use ros2_client::{Parameter, ParameterValue};

use super::refusal::Refusal;
use super::store::ParameterStore;
use crate::args::value::show;
use crate::dds::frames::Peer;
use crate::dds::plan::{Offer, dds_type_name};
use crate::dds::port::{PortBuilder, TopicPublisher};
use crate::service::{self, ServiceMapping, ServiceServer, Task, at_once};
use flexdrill_messages::to_cdr_body;
use flexdrill_text::log_ending;

/// Applies a set of values as a whole, or refuses it. The arguments are the store with the new values, the changed
/// parameters, and the requester.
pub type Apply = dyn Fn(&mut ParameterStore, &[Parameter], &str) -> Result<(), Refusal> + Send + Sync;

/// Names the client of a request, for the log and the recording.
pub type NameClient = fn(Peer) -> String;

/// Is called with every change, after it acts.
pub type Observer = dyn Fn(&[Parameter]) + Send + Sync;

/// The parameters of a node: their store, the rules for a change, and `/parameter_events`.
pub struct Parameters {
    store: Mutex<ParameterStore>,
    apply: Box<Apply>,
    name_client: NameClient,
    events: TopicPublisher,
    node_name: String,
    observer: OnceLock<Box<Observer>>,
}

impl Parameters {
    /// Parameters with the values of `store`. The store is locked while `apply` runs, so that sets act one after another.
    /// `/parameter_events` carries all parameters now, and every change later.
    pub fn new(
        port: &mut PortBuilder,
        node_name: String,
        store: ParameterStore,
        apply: Box<Apply>,
        name_client: NameClient,
    ) -> Arc<Self> {
        let offer = Offer {
            depth: 1000,
            ..Offer::usual(10.0)
        };
        let events = port.publisher(
            "/parameter_events",
            &dds_type_name("rcl_interfaces/msg/ParameterEvent"),
            offer,
        );
        let parameters = Self {
            store: Mutex::new(store),
            apply,
            name_client,
            events,
            node_name,
            observer: OnceLock::new(),
        };
        let all = parameters.with(ParameterStore::all);
        parameters.publish(all, Vec::new());
        Arc::new(parameters)
    }

    /// Reads the values.
    pub fn with<T>(&self, read: impl FnOnce(&ParameterStore) -> T) -> T {
        read(&self.store.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Calls `observer` with every change from now on. Only the first observer counts.
    pub fn observe(&self, observer: Box<Observer>) {
        let _ = self.observer.set(observer);
    }

    /// Sets one parameter for `requester`, as the services do.
    ///
    /// # Errors
    /// When the value is refused.
    pub fn set_one(&self, change: Parameter, requester: &str) -> Result<(), Refusal> {
        self.set(&[change], requester)
    }

    /// Sets all of `changes` or none for `requester`, if the parameters of `from` have the values given there. Returns
    /// whether they have.
    ///
    /// # Errors
    /// When a value is refused; then nothing has changed.
    pub fn set_from(&self, from: &[Parameter], changes: &[Parameter], requester: &str) -> Result<bool, Refusal> {
        let result = self.apply(from, changes, requester);
        if let Err(reason) = &result
            && let Some(more) = log_ending("parameter refused")
        {
            tracing::warn!("a parameter change was refused: {reason}; asked for by {requester}{more}");
        }
        result
    }

    /// Sets all of `changes` or none, publishes the event, and logs the change or the refusal with its requester.
    fn set(&self, changes: &[Parameter], requester: &str) -> Result<(), Refusal> {
        self.set_from(&[], changes, requester).map(drop)
    }

    fn apply(&self, from: &[Parameter], changes: &[Parameter], requester: &str) -> Result<bool, Refusal> {
        let (before, changed) = {
            let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
            if from.iter().any(|from| store.get(&from.name) != Some(&from.value)) {
                return Ok(false);
            }
            let before: Vec<Option<ParameterValue>> = changes.iter().map(|c| store.get(&c.name).cloned()).collect();
            (
                before,
                store.set_atomically(changes, |candidate, changed| {
                    (self.apply)(candidate, changed, requester)
                })?,
            )
        };
        for (Parameter { name, value }, before) in changed.iter().zip(before) {
            let before = before.map_or_else(String::new, |before| format!(", was {}", show(&before)));
            if let Some(more) = log_ending(format!("parameter {name}")) {
                tracing::info!(
                    "parameter {name} is {}{before}: asked for by {requester}{more}",
                    show(value)
                );
            }
        }
        if let Some(observer) = self.observer.get() {
            observer(&changed);
        }
        self.publish(Vec::new(), changed);
        Ok(true)
    }

    fn publish(&self, new: Vec<Parameter>, changed: Vec<Parameter>) {
        let event = raw::ParameterEvent {
            stamp: ros2_client::builtin_interfaces::Time::now(),
            node: self.node_name.clone(),
            new_parameters: new.into_iter().map(Into::into).collect(),
            changed_parameters: changed.into_iter().map(Into::into).collect(),
            deleted_parameters: Vec::new(),
        };
        if let Ok(body) = to_cdr_body(&event) {
            self.events.publish(body);
        }
    }

    fn answer_set(&self, changes: Vec<raw::Parameter>, requester: &str) -> raw::SetParametersResult {
        let changes: Vec<Parameter> = changes.into_iter().map(Into::into).collect();
        let result = self.set(&changes, requester);
        result.map_err(|refusal| refusal.to_string()).into()
    }

    /// The requester of the request that is being answered: the service, and its client where the middleware names it.
    fn requester(&self, service: &str) -> String {
        match service::client() {
            Some(client) => format!("service {service}, client {}", (self.name_client)(client)),
            None => format!("service {service}"),
        }
    }
}

/// Creates the six servers of a node; each is a task to run.
pub fn serve(port: &mut PortBuilder, mapping: ServiceMapping, parameters: &Arc<Parameters>) -> Vec<Task> {
    let node_name = parameters.node_name.clone();
    // The names are fixed by ROS 2: tools look for exactly these six.
    let mut server = |name: &str, kind: &str| {
        let service = format!("{node_name}/{name}");
        ServiceServer::new(port, &service, &format!("rcl_interfaces/srv/{kind}"), mapping)
    };
    let shared = || Arc::clone(parameters);
    // Each closure lives as long as its server and needs the store for itself.
    let (get, types, set, atomic, list, describe) = (shared(), shared(), shared(), shared(), shared(), shared());
    vec![
        Box::pin(
            server("get_parameters", "GetParameters").serve(at_once(move |request: GetParametersRequest| {
                get.with(|store| GetParametersResponse {
                    values: request
                        .names
                        .iter()
                        // An unknown name is answered with "not set", as rclcpp does, and is no error.
                        .map(|name| store.get(name).cloned().unwrap_or(ParameterValue::NotSet).into())
                        .collect(),
                })
            })),
        ),
        Box::pin(server("get_parameter_types", "GetParameterTypes").serve(at_once(
            move |request: GetParameterTypesRequest| {
                types.with(|store| GetParameterTypesResponse {
                    values: request
                        .names
                        .iter()
                        .map(|name| store.get(name).map_or(0, ParameterValue::to_parameter_type_raw))
                        .collect(),
                })
            },
        ))),
        Box::pin(
            server("set_parameters", "SetParameters").serve(at_once(move |request: SetParametersRequest| {
                // The requester stands in the log next to the change.
                let requester = set.requester("set_parameters");
                SetParametersResponse {
                    results: request
                        .parameter
                        .into_iter()
                        // One by one: each parameter has its own result, and a refused one leaves the others in force.
                        .map(|parameter| set.answer_set(vec![parameter], &requester))
                        .collect(),
                }
            })),
        ),
        Box::pin(
            server("set_parameters_atomically", "SetParametersAtomically").serve(at_once(
                move |request: SetParametersRequest| SetParametersAtomicallyResponse {
                    // All or none, with one result.
                    result: atomic.answer_set(request.parameter, &atomic.requester("set_parameters_atomically")),
                },
            )),
        ),
        Box::pin(
            server("list_parameters", "ListParameters").serve(at_once(move |request: ListParametersRequest| {
                list.with(|store| ListParametersResponse {
                    result: store.list(&request.prefixes, request.depth),
                })
            })),
        ),
        Box::pin(server("describe_parameters", "DescribeParameters").serve(at_once(
            move |request: DescribeParametersRequest| {
                describe.with(|store| DescribeParametersResponse {
                    values: request.names.iter().map(|name| store.describe(name)).collect(),
                })
            },
        ))),
    ]
}
