//! The six parameter services of a ROS 2 node, with descriptors, and `/parameter_events`.

use std::fmt;
use std::future::Future;
use std::pin::Pin;
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
use crate::dds::plan::{Offer, dds_type_name};
use crate::dds::port::{PortBuilder, TopicPublisher};
use crate::messages::to_cdr_body;
use crate::rig_inputs::{Driver, DriverId};
use crate::ros::args::value::show;
use crate::ros::service::{self, ServiceMapping, ServiceServer, at_once};

/// A server's work, to be run as a task.
pub type Task = Pin<Box<dyn Future<Output = ()> + Send>>;

/// Lets a set of values act as a whole, or refuses it. It is given the store as it would become, what changed, and who
/// asked for it.
pub type Act = dyn Fn(&mut ParameterStore, &[Parameter], &str) -> Result<(), Refusal> + Send + Sync;

/// Who asks for a change: the service, and its client where the middleware tells.
#[derive(Debug, Clone)]
struct Origin {
    service: &'static str,
    client: Option<Driver>,
}

impl Origin {
    /// Of the request that is being answered.
    fn of(service: &'static str) -> Self {
        Self {
            service,
            client: service::client().map(|peer| Driver {
                id: DriverId(peer.id),
                node: peer.node,
                host: peer.address,
            }),
        }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "service {}", self.service)?;
        match &self.client {
            Some(client) => write!(f, ", client {client}"),
            None => Ok(()),
        }
    }
}

/// Values, rules, and what follows from a change.
pub struct Parameters {
    store: Mutex<ParameterStore>,
    act: Box<Act>,
    events: TopicPublisher,
    node_name: String,
    /// Hears of every change beside `/parameter_events`.
    told: OnceLock<Box<Told>>,
}

/// Hears of what has changed.
pub type Told = dyn Fn(&[Parameter]) + Send + Sync;

impl Parameters {
    /// Takes over a store. `act` is called with each set of values while no other change can come between.
    /// `/parameter_events` carries all parameters now, and every change later.
    pub fn new(port: &mut PortBuilder, node_name: String, store: ParameterStore, act: Box<Act>) -> Arc<Self> {
        let offer = Offer {
            reliable: true,
            latched: false,
            depth: 1000,
            rate: 10.0,
            lifespan: None,
        };
        let events = port.publisher(
            "/parameter_events",
            &dds_type_name("rcl_interfaces/msg/ParameterEvent"),
            offer,
        );
        let parameters = Self {
            store: Mutex::new(store),
            act,
            events,
            node_name,
            told: OnceLock::new(),
        };
        let all = parameters.with(ParameterStore::all);
        parameters.publish(all, Vec::new());
        Arc::new(parameters)
    }

    /// Reads the values.
    pub fn with<T>(&self, read: impl FnOnce(&ParameterStore) -> T) -> T {
        read(&self.store.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Has `told` hear of every change from now on; one only.
    pub fn tell(&self, told: Box<Told>) {
        // The first stays.
        let _ = self.told.set(told);
    }

    /// Sets one, for `origin`, as a service does.
    ///
    /// # Errors
    /// When it is refused.
    pub fn set_one(&self, change: Parameter, origin: &str) -> Result<(), Refusal> {
        let result = self.set(&[change], origin);
        if let Err(reason) = &result {
            tracing::warn!("a parameter change was refused: {reason}; asked for by {origin}");
        }
        result
    }

    /// Sets all of `changes` or none, lets them act, publishes the event and logs who asked.
    fn set(&self, changes: &[Parameter], origin: &str) -> Result<(), Refusal> {
        let (before, changed) = {
            let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
            let before: Vec<Option<ParameterValue>> = changes.iter().map(|c| store.get(&c.name).cloned()).collect();
            (
                before,
                store.set_atomically(changes, |candidate, changed| (self.act)(candidate, changed, origin))?,
            )
        };
        for (Parameter { name, value }, before) in changed.iter().zip(before) {
            let before = before.map_or_else(String::new, |before| format!(", was {}", show(&before)));
            tracing::info!("parameter {name} is {}{before}: asked for by {origin}", show(value));
        }
        if let Some(told) = self.told.get() {
            told(&changed);
        }
        self.publish(Vec::new(), changed);
        Ok(())
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

    fn answer_set(&self, changes: Vec<raw::Parameter>, origin: &Origin) -> raw::SetParametersResult {
        let changes: Vec<Parameter> = changes.into_iter().map(Into::into).collect();
        let origin = origin.to_string();
        let result = self.set(&changes, &origin);
        if let Err(reason) = &result {
            tracing::warn!("a parameter change was refused: {reason}; asked for by {origin}");
        }
        result.map_err(|refusal| refusal.to_string()).into()
    }
}

/// Creates the six servers of a node; each is a task to run.
pub fn serve(port: &mut PortBuilder, mapping: ServiceMapping, parameters: &Arc<Parameters>) -> Vec<Task> {
    let node_name = parameters.node_name.clone();
    let mut server = |name: &str, kind: &str| {
        let service = format!("{node_name}/{name}");
        ServiceServer::new(port, &service, &format!("rcl_interfaces/srv/{kind}"), mapping)
    };
    let shared = || Arc::clone(parameters);
    let (get, types, set, atomic, list, describe) = (shared(), shared(), shared(), shared(), shared(), shared());
    vec![
        Box::pin(
            server("get_parameters", "GetParameters").serve(at_once(move |request: GetParametersRequest| {
                get.with(|store| GetParametersResponse {
                    values: request
                        .names
                        .iter()
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
                let origin = Origin::of("set_parameters");
                SetParametersResponse {
                    results: request
                        .parameter
                        .into_iter()
                        .map(|parameter| set.answer_set(vec![parameter], &origin))
                        .collect(),
                }
            })),
        ),
        Box::pin(
            server("set_parameters_atomically", "SetParametersAtomically").serve(at_once(
                move |request: SetParametersRequest| SetParametersAtomicallyResponse {
                    result: atomic.answer_set(request.parameter, &Origin::of("set_parameters_atomically")),
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
