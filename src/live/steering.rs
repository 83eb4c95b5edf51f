//! What a viewer that has shown the token may do: parameters, services, inputs. The node carries it out and refuses it
//! as it does for anybody; here it is translated to and from the protocol.

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

use super::backlog::Backlog;
use super::session::MOST_BYTES;

/// Encoding of requests, replies and inputs.
pub(super) const ENCODING: &str = "cdr";
/// Encoding of their definitions.
const SCHEMA_ENCODING: &str = "ros2msg";
/// First bytes of plain little-endian CDR; two more are not used.
const LITTLE_ENDIAN: [u8; 2] = [0, 1];
const HEADER: usize = 4;
/// Service calls of one viewer that may wait for their answers.
const MOST_CALLS: usize = 32;
/// Parameters that one viewer may follow.
const MOST_FOLLOWED: usize = 1000;

/// Who acts. `Display` is `foxglove client at ADDRESS`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Viewer {
    /// Of this connection alone.
    pub number: u32,
    /// Its end of the connection.
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
    /// Several of one kind.
    List(Vec<Setting>),
}

/// A topic that viewers may publish on.
#[derive(Debug, Clone)]
pub struct InputTopic {
    /// Absolute name.
    pub name: String,
    /// As `std_msgs/msg/Float64`.
    pub ros_type: &'static str,
}

/// A service that viewers may call.
#[derive(Debug, Clone)]
pub struct OfferedService {
    /// Absolute name.
    pub name: String,
    /// As `std_srvs/srv/Trigger`.
    pub ros_type: String,
    /// Definitions of request and response, complete.
    pub schemas: [&'static str; 2],
}

/// The node, for viewers that steer. Nothing here waits, but for the answer of a service.
pub trait Steered: Send + Sync + 'static {
    /// Values of these parameters, of all where none is named. What is unknown is left out.
    fn parameters(&self, names: &[String]) -> Vec<(String, Setting)>;
    /// Changes one parameter.
    ///
    /// # Errors
    /// Why it is refused.
    fn set_parameter(&self, viewer: Viewer, name: &str, value: Setting) -> Result<(), String>;
    /// Topics that a viewer may publish on, by number.
    fn inputs(&self) -> Vec<InputTopic>;
    /// Takes a sample of an input, as the CDR body that DDS would bring.
    fn sample(&self, viewer: Viewer, input: usize, body: Vec<u8>);
    /// Services that a viewer may call, by number.
    fn services(&self) -> Vec<OfferedService>;
    /// Calls a service with a CDR body; the body of its reply.
    fn call(&self, viewer: Viewer, service: usize, body: Vec<u8>) -> BoxFuture<'static, Result<Vec<u8>, String>>;
}

/// A topic that a viewer publishes on, as it advertised it.
#[derive(Debug, Clone)]
pub(super) struct ClientChannel {
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
    /// Number of services that are offered. A service's id in the protocol is its number plus one.
    service_count: usize,
    /// By the number of the connection.
    followers: Mutex<HashMap<u32, Follower>>,
}

impl Steering {
    /// Of a node.
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

    /// Sends viewers that follow these parameters their values.
    pub fn tell_parameters(&self, values: Vec<(String, Setting)>) {
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
    // Definitions are texts, which the protocol carries as they are.
    complete.unwrap_or(service)
}

/// One viewer that may steer.
pub(super) struct Pilot {
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

    /// The services, as they are advertised.
    pub fn services(&self) -> Message {
        self.steering.services.clone()
    }

    /// The number of the input that a viewer publishes on.
    ///
    /// # Errors
    /// When it is no input, or not of its type.
    pub fn input(&self, channel: &ClientChannel) -> Result<usize, String> {
        let inputs = &self.steering.inputs;
        let found = inputs.iter().position(|input| input.name == channel.topic);
        let Some(number) = found else {
            let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
            return Err(format!(
                "{} is no input of the twin; what is published there has no effect. The inputs are {}",
                channel.topic,
                names.join(", ")
            ));
        };
        let kind = inputs[number].ros_type;
        // Viewers also use the form of ROS 1.
        let is_kind = channel.schema_name == kind || channel.schema_name == kind.replace("/msg/", "/");
        if !is_kind || channel.encoding != ENCODING {
            return Err(format!(
                "{} takes {kind} as {ENCODING}, not {} as {}; what is published on this channel has no effect",
                channel.topic, channel.schema_name, channel.encoding
            ));
        }
        Ok(number)
    }

    /// Hands a sample to the node.
    ///
    /// # Errors
    /// When it is not for an input, or not CDR.
    pub fn publish(&self, channel: &ClientChannel, payload: &[u8]) -> Result<(), String> {
        let input = self.input(channel)?;
        let body = body(payload).map_err(|why| format!("{}: {why}", channel.topic))?;
        self.steering.node.sample(self.viewer, input, body.to_vec());
        Ok(())
    }

    /// Answers with the values of parameters, of all where none is named.
    pub fn get_parameters(&self, names: &[String], request: Option<String>) {
        let values = self.steering.node.parameters(names);
        let mut message = ParameterValues::new(values.into_iter().map(parameter));
        message.id = request;
        self.backlog.answer(&message);
    }

    /// Sets parameters, and answers with their values, whether they were set or not.
    pub fn set_parameters(&self, parameters: Vec<Parameter>, request: Option<String>) {
        let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        for Parameter { name, value, .. } in parameters {
            let set = match value.and_then(setting) {
                Some(value) => self.steering.node.set_parameter(self.viewer, &name, value),
                None => Err(format!(
                    "'{name}' is not set: a parameter is a flag, a number, a text or a list of them"
                )),
            };
            if let Err(why) = set {
                self.backlog.answer(&Status::error(why));
            }
        }
        self.get_parameters(&names, request);
    }

    /// Sends the values of these parameters whenever they change.
    pub fn follow(&self, names: Vec<String>) {
        let mut followers = self.steering.followers();
        let follower = followers.entry(self.viewer.number).or_insert_with(|| Follower {
            names: BTreeSet::new(),
            backlog: Arc::clone(&self.backlog),
        });
        let room = MOST_FOLLOWED.saturating_sub(follower.names.len());
        follower.names.extend(names.into_iter().take(room));
    }

    /// Ends that for these parameters.
    pub fn unfollow(&self, names: &[String]) {
        if let Some(follower) = self.steering.followers().get_mut(&self.viewer.number) {
            follower.names.retain(|name| !names.contains(name));
        }
    }

    /// Calls a service; the answer is sent when it comes.
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
                "{MOST_CALLS} calls of this viewer wait for their answers, which is the most"
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

/// The CDR body of what a viewer sends.
fn body(payload: &[u8]) -> Result<&[u8], String> {
    if payload.len() > MOST_BYTES {
        return Err(format!("{} bytes, more than {MOST_BYTES}", payload.len()));
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
        value: Some(shown(value)),
    }
}

fn shown(value: Setting) -> ParameterValue {
    match value {
        Setting::Flag(flag) => ParameterValue::Bool(flag),
        Setting::Whole(whole) => ParameterValue::Integer(whole),
        Setting::Number(number) => ParameterValue::Float64(number),
        Setting::Text(text) => ParameterValue::String(text),
        Setting::List(list) => ParameterValue::Array(list.into_iter().map(shown).collect()),
    }
}

/// What a viewer means; none where no parameter can be that.
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
    fn what_is_no_little_endian_cdr_is_refused() {
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
