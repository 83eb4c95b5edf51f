//! Steering by a viewer with the token: parameters, services and inputs. This module translates between the protocol
//! and the node, which applies the same checks as to any other client.

use std::collections::{BTreeSet, HashMap};
use std::fmt;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use foxglove::websocket::{Parameter, ParameterType, ParameterValue};
use foxglove::ws_protocol::client::ServiceCallRequest;
use foxglove::ws_protocol::schema::Schema;
use foxglove::ws_protocol::server::advertise_services::Service;
use foxglove::ws_protocol::server::{
    AdvertiseServices, ParameterValues, ServiceCallFailure, ServiceCallResponse, Status,
};
use futures::future::BoxFuture;
use tokio::sync::Semaphore;
use tokio_tungstenite::tungstenite::Message;

use crate::backlog::Backlog;
use crate::session::MOST_BYTES;

/// Encoding of requests, replies and inputs.
pub(crate) const ENCODING: &str = "cdr";
/// Encoding of their definitions.
const SCHEMA_ENCODING: &str = "ros2msg";
/// First bytes of plain little-endian CDR.
const LITTLE_ENDIAN: [u8; 2] = [0, 1];
/// Length of CDR's header (bytes); its last two bytes are options without a meaning here.
const HEADER: usize = 4;
/// Largest number of pending service calls of one viewer.
const MOST_CALLS: usize = 32;
/// Largest number of parameters that one viewer follows.
const MOST_FOLLOWED: usize = 1000;

/// A viewer that steers. `Display` gives `foxglove client at ADDRESS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Viewer {
    /// Number of the connection, unique in this process.
    pub number: u32,
    /// Address of the client.
    pub address: SocketAddr,
}

impl fmt::Display for Viewer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "foxglove client at {}", self.address)
    }
}

/// A parameter's value.
#[derive(Debug, Clone, PartialEq)]
pub enum Setting {
    /// Yes or no.
    Flag(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// Several values of one kind.
    List(Vec<Setting>),
}

/// A topic that viewers may publish on.
#[derive(Debug, Clone)]
pub struct InputTopic {
    /// Absolute name.
    pub name: String,
    /// Type, such as `std_msgs/msg/Float64`.
    pub ros_type: &'static str,
}

/// A service that viewers may call.
#[derive(Debug, Clone)]
pub struct OfferedService {
    /// Absolute name.
    pub name: String,
    /// Type, such as `std_srvs/srv/Trigger`.
    pub ros_type: String,
    /// Complete definitions of request and response.
    pub schemas: [&'static str; 2],
}

/// The node as viewers steer it. No method blocks; [`Steered::call`] returns a future.
pub trait Steered: Send + Sync + 'static {
    /// Values of these parameters, or of all if `names` is empty. Unknown names are ignored.
    fn parameters(&self, names: &[String]) -> Vec<(String, Setting)>;
    /// Changes one parameter.
    ///
    /// # Errors
    /// The reason of the refusal.
    fn set_parameter(&self, viewer: Viewer, name: &str, value: Setting) -> Result<(), String>;
    /// Topics that a viewer may publish on; [`Steered::sample`] takes their index.
    fn inputs(&self) -> Vec<InputTopic>;
    /// Passes on a sample of an input, as the CDR body that DDS would deliver.
    fn sample(&self, viewer: Viewer, input: usize, body: Vec<u8>);
    /// Services that a viewer may call; [`Steered::call`] takes their index.
    fn services(&self) -> Vec<OfferedService>;
    /// Calls a service with a CDR body; the future gives the body of its reply.
    fn call(&self, viewer: Viewer, service: usize, body: Vec<u8>) -> BoxFuture<'static, Result<Vec<u8>, String>>;
}

/// A topic that a viewer publishes on, as it advertised it.
#[derive(Debug, Clone)]
pub(crate) struct ClientChannel {
    pub topic: String,
    pub encoding: String,
    pub schema_name: String,
}

/// A viewer that follows parameters.
struct Follower {
    names: BTreeSet<String>,
    backlog: Arc<Backlog>,
}

/// The node's parameters, services and inputs, for all viewers that steer.
pub struct Steering {
    node: Arc<dyn Steered>,
    inputs: Vec<InputTopic>,
    services: Message,
    /// Number of offered services. A service's id in the protocol is its index plus one.
    service_count: usize,
    /// Followers by the number of their connection.
    followers: Mutex<HashMap<u32, Follower>>,
}

impl Steering {
    /// The steering of a node.
    pub fn new(node: Arc<dyn Steered>) -> Arc<Self> {
        let offered = node.services();
        let services = offered.iter().zip(1..).map(|(service, id)| advertised(id, service));
        let services = AdvertiseServices::new(services.collect::<Vec<_>>());
        Arc::new(Self {
            inputs: node.inputs(),
            services: Message::from(&services),
            service_count: offered.len(),
            node,
            followers: Mutex::default(),
        })
    }

    /// Sends the values to the viewers that follow these parameters.
    pub fn send_parameters(&self, values: Vec<(String, Setting)>) {
        let values: Vec<Parameter> = values.into_iter().map(parameter).collect();
        for follower in self.followers().values() {
            let followed = values.iter().filter(|value| follower.names.contains(&value.name));
            let message = ParameterValues::new(followed.cloned());
            if !message.parameters.is_empty() {
                follower.backlog.answer(&message);
            }
        }
    }

    fn followers(&self) -> MutexGuard<'_, HashMap<u32, Follower>> {
        self.followers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn advertised(id: u32, offered: &OfferedService) -> Service<'_> {
    let schema = |part: &str, text: &'static str| {
        Schema::new(format!("{}_{part}", offered.ros_type), SCHEMA_ENCODING, text.as_bytes())
    };
    let [request, response] = offered.schemas;
    let service = Service::new(id, &offered.name, &offered.ros_type);
    let with_request = service.clone().with_request(ENCODING, schema("Request", request));
    let complete = with_request.and_then(|service| service.with_response(ENCODING, schema("Response", response)));
    // The protocol accepts any text as a definition, so this does not fail.
    complete.unwrap_or(service)
}

/// One viewer that may steer.
pub(crate) struct Pilot {
    steering: Arc<Steering>,
    viewer: Viewer,
    backlog: Arc<Backlog>,
    calls: Arc<Semaphore>,
}

impl Pilot {
    pub fn new(steering: &Arc<Steering>, viewer: Viewer, backlog: &Arc<Backlog>) -> Self {
        Self {
            steering: Arc::clone(steering),
            viewer,
            backlog: Arc::clone(backlog),
            calls: Arc::new(Semaphore::new(MOST_CALLS)),
        }
    }

    /// The advertisement of the services.
    pub fn services(&self) -> Message {
        self.steering.services.clone()
    }

    /// The index of the input that a viewer publishes on.
    ///
    /// # Errors
    /// When the topic is no input, or the type or encoding is wrong.
    pub fn input(&self, channel: &ClientChannel) -> Result<usize, String> {
        let inputs = &self.steering.inputs;
        let found = inputs.iter().position(|input| input.name == channel.topic);
        let Some(number) = found else {
            let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
            return Err(format!(
                "{} is no input of the twin, so samples on it have no effect. The inputs are {}",
                channel.topic,
                names.join(", ")
            ));
        };
        let kind = inputs[number].ros_type;
        // Viewers also use ROS 1's form of type names.
        let is_kind = channel.schema_name == kind || channel.schema_name == kind.replace("/msg/", "/");
        if !is_kind || channel.encoding != ENCODING {
            return Err(format!(
                "{} has the type {kind} in {ENCODING}, not {} in {}; samples on this channel have no effect",
                channel.topic, channel.schema_name, channel.encoding
            ));
        }
        Ok(number)
    }

    /// Passes a sample to the node.
    ///
    /// # Errors
    /// When the channel is no input, or the sample is not CDR.
    pub fn publish(&self, channel: &ClientChannel, payload: &[u8]) -> Result<(), String> {
        let input = self.input(channel)?;
        let body = body(payload).map_err(|why| format!("{}: {why}", channel.topic))?;
        self.steering.node.sample(self.viewer, input, body.to_vec());
        Ok(())
    }

    /// Answers with the values of these parameters, or of all if `names` is empty.
    pub fn get_parameters(&self, names: &[String], request: Option<String>) {
        let values = self.steering.node.parameters(names);
        let mut message = ParameterValues::new(values.into_iter().map(parameter));
        message.id = request;
        self.backlog.answer(&message);
    }

    /// Sets parameters, and answers with their values in any case.
    pub fn set_parameters(&self, parameters: Vec<Parameter>, request: Option<String>) {
        let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        for Parameter { name, value, .. } in parameters {
            let set = match value.and_then(setting) {
                Some(value) => self.steering.node.set_parameter(self.viewer, &name, value),
                None => Err(format!(
                    "'{name}' is not set: the value must be a flag, a number, a text or a list of these"
                )),
            };
            if let Err(why) = set {
                self.backlog.answer(&Status::error(why));
            }
        }
        self.get_parameters(&names, request);
    }

    /// Makes the viewer follow these parameters: it gets their values when they change.
    pub fn follow(&self, names: Vec<String>) {
        let mut followers = self.steering.followers();
        let follower = followers.entry(self.viewer.number).or_insert_with(|| Follower {
            names: BTreeSet::new(),
            backlog: Arc::clone(&self.backlog),
        });
        let room = MOST_FOLLOWED.saturating_sub(follower.names.len());
        follower.names.extend(names.into_iter().take(room));
    }

    /// Makes the viewer stop following these parameters.
    pub fn unfollow(&self, names: &[String]) {
        if let Some(follower) = self.steering.followers().get_mut(&self.viewer.number) {
            follower.names.retain(|name| !names.contains(name));
        }
    }

    /// Calls a service, and sends the answer when it arrives.
    pub fn call(&self, request: &ServiceCallRequest<'_>) {
        let (service, call) = (request.service_id, request.call_id);
        if let Err(why) = self.try_call(request) {
            self.backlog.answer(&ServiceCallFailure::new(service, call, why));
        }
    }

    fn try_call(&self, request: &ServiceCallRequest<'_>) -> Result<(), String> {
        let (service, call) = (request.service_id, request.call_id);
        let number = (service as usize).wrapping_sub(1);
        if number >= self.steering.service_count {
            return Err("Unknown service".to_owned());
        }
        if request.encoding != ENCODING {
            return Err("Unsupported encoding".to_owned());
        }
        let body = body(&request.payload)?.to_vec();
        let Ok(permit) = Arc::clone(&self.calls).try_acquire_owned() else {
            return Err(format!(
                "{MOST_CALLS} calls of this viewer are pending, the largest number allowed"
            ));
        };
        let answer = self.steering.node.call(self.viewer, number, body);
        let backlog = Arc::clone(&self.backlog);
        tokio::spawn(async move {
            match answer.await {
                Ok(body) => {
                    let mut payload = [LITTLE_ENDIAN.as_slice(), &[0, 0]].concat();
                    payload.extend(body);
                    backlog.answer(&ServiceCallResponse {
                        service_id: service,
                        call_id: call,
                        encoding: ENCODING.into(),
                        payload: payload.into(),
                    });
                }
                Err(why) => backlog.answer(&ServiceCallFailure::new(service, call, why)),
            }
            drop(permit);
        });
        Ok(())
    }
}

impl Drop for Pilot {
    fn drop(&mut self) {
        self.steering.followers().remove(&self.viewer.number);
    }
}

/// The CDR body of a viewer's message.
fn body(payload: &[u8]) -> Result<&[u8], String> {
    if payload.len() > MOST_BYTES {
        return Err(format!(
            "the message has {} bytes, more than {MOST_BYTES}",
            payload.len()
        ));
    }
    match payload.split_at_checked(HEADER) {
        Some((head, body)) if head.starts_with(&LITTLE_ENDIAN) => Ok(body),
        _ => Err("not little-endian CDR, which begins with the bytes 00 01 00 00".to_owned()),
    }
}

fn parameter((name, value): (String, Setting)) -> Parameter {
    let r#type = match &value {
        Setting::Number(_) => Some(ParameterType::Float64),
        Setting::List(list) if matches!(list.first(), Some(Setting::Number(_))) => Some(ParameterType::Float64Array),
        _ => None,
    };
    Parameter {
        name,
        r#type,
        value: Some(parameter_value(value)),
    }
}

fn parameter_value(value: Setting) -> ParameterValue {
    match value {
        Setting::Flag(flag) => ParameterValue::Bool(flag),
        Setting::Whole(whole) => ParameterValue::Integer(whole),
        Setting::Number(number) => ParameterValue::Float64(number),
        Setting::Text(text) => ParameterValue::String(text),
        Setting::List(list) => ParameterValue::Array(list.into_iter().map(parameter_value).collect()),
    }
}

/// The setting that a viewer sent; `None` for a kind of value that no parameter has.
fn setting(value: ParameterValue) -> Option<Setting> {
    Some(match value {
        ParameterValue::Bool(flag) => Setting::Flag(flag),
        ParameterValue::Integer(whole) => Setting::Whole(whole),
        ParameterValue::Float64(number) => Setting::Number(number),
        ParameterValue::String(text) => Setting::Text(text),
        ParameterValue::Array(list) => Setting::List(list.into_iter().map(setting).collect::<Option<_>>()?),
        ParameterValue::Dict(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn only_little_endian_cdr_is_accepted() {
        assert_eq!(body(&[0, 1, 0, 0, 7]), Ok([7].as_slice()));
        for wrong in [&[0, 0, 0, 0, 7][..], &[0, 1, 0], &[], b"{\"data\": 1}"] {
            assert!(body(wrong).unwrap_err().contains("little-endian CDR"), "{wrong:?}");
        }
        let long = [&[0, 1, 0, 0][..], &vec![0; MOST_BYTES]].concat();
        assert!(body(&long).unwrap_err().contains("more than 65536"));
    }

    #[test]
    fn values_keep_their_kind_on_the_way_to_a_viewer_and_back() {
        let list = Setting::List(vec![Setting::Number(1.0), Setting::Number(2.5)]);
        for value in [
            Setting::Flag(true),
            Setting::Whole(5),
            Setting::Number(5.0),
            Setting::Text("first".into()),
            list,
        ] {
            let shown = parameter(("name".into(), value.clone()));
            let wire = serde_json::to_string(&shown).unwrap();
            let read: Parameter = serde_json::from_str(&wire).unwrap();
            assert_eq!(read.value.and_then(setting), Some(value), "{wire}");
        }
        assert_eq!(setting(ParameterValue::Dict(BTreeMap::new())), None);
    }
}
