//! What a viewer that has shown the token may do: parameters, services, inputs. The node carries it out and refuses it as
//! it does for anybody; here the protocol is told.

use std::collections::HashMap;
use std::fmt;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};

use foxglove::websocket::service::{Request, Responder, Service, ServiceSchema};
use foxglove::websocket::{
    AnyClient, ChannelView, Client, ClientChannel, ClientId, GetParametersResponder, Parameter, ParameterHandler,
    ParameterType, ParameterValue, ServerListener, SetParametersResponder, Status,
};
use foxglove::{Schema, WebSocketServerHandle};
use futures::future::BoxFuture;

use super::hub::Hub;
use super::{LiveError, Token};

/// Encoding of requests, replies and inputs.
pub(super) const ENCODING: &str = "cdr";
/// Encoding of their definitions.
const SCHEMA_ENCODING: &str = "ros2msg";
/// First bytes of plain little-endian CDR; two more are not used.
const LITTLE_ENDIAN: [u8; 2] = [0, 1];
const HEADER: usize = 4;
/// Longest request or sample: far above all that the node takes.
const MOST_BYTES: usize = 64 << 10;
/// The door's own channel of a viewer; a viewer that advertises the same number is told that it is in use.
const INTRODUCTION: u32 = u32::MAX;

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

/// Takes what viewers ask for.
pub struct Steering {
    node: Arc<dyn Steered>,
    hub: Arc<Hub>,
    inputs: Vec<InputTopic>,
    viewers: Mutex<HashMap<ClientId, Viewer>>,
    protocol: OnceLock<Weak<WebSocketServerHandle>>,
    /// Begins the name of the door's own channel, and nobody else knows it.
    secret: Token,
}

impl Steering {
    /// Of a node that is looked at through `hub`.
    ///
    /// # Errors
    /// When the system has no random numbers.
    pub fn new(node: Arc<dyn Steered>, hub: &Arc<Hub>) -> Result<Arc<Self>, LiveError> {
        Ok(Arc::new(Self {
            inputs: node.inputs(),
            node,
            hub: Arc::clone(hub),
            viewers: Mutex::default(),
            protocol: OnceLock::new(),
            secret: Token::random().map_err(|error| LiveError::Random(error.to_string()))?,
        }))
    }

    /// Tells viewers that follow these parameters what they are.
    pub fn tell_parameters(&self, values: Vec<(String, Setting)>) {
        if let Some(protocol) = self.protocol.get().and_then(Weak::upgrade) {
            protocol.publish_parameter_values(values.into_iter().map(parameter).collect());
        }
    }

    /// Where values are told.
    pub(super) fn set_protocol(&self, protocol: &Arc<WebSocketServerHandle>) {
        // It is set once, by who made both.
        let _ = self.protocol.set(Arc::downgrade(protocol));
    }

    /// What the door says to the protocol's server in front of all that a viewer says: whose connection it is.
    pub(super) fn introduce(&self, address: SocketAddr) -> String {
        serde_json::json!({
            "op": "advertise",
            "channels": [{
                "id": INTRODUCTION,
                "topic": format!("{}{address}", self.secret.text()),
                "encoding": ENCODING,
                "schemaName": "",
            }],
        })
        .to_string()
    }

    /// The protocol's services.
    pub(super) fn services(self: &Arc<Self>) -> Vec<Service> {
        let offered = self.node.services().into_iter().enumerate();
        let service = |(number, offered): (usize, OfferedService)| {
            let [request, response] = ["Request", "Response"].map(|part| format!("{}_{part}", offered.ros_type));
            let schema = |name: String, text: &'static str| Schema::new(name, SCHEMA_ENCODING, text.as_bytes());
            let [request, response] = [
                schema(request, offered.schemas[0]),
                schema(response, offered.schemas[1]),
            ];
            let kind = ServiceSchema::new(offered.ros_type)
                .with_request(ENCODING, request)
                .with_response(ENCODING, response);
            let steering = Arc::clone(self);
            Service::builder(offered.name, kind).handler(Call { steering, number })
        };
        offered.map(service).collect()
    }

    fn viewer(&self, client: ClientId) -> Result<Viewer, String> {
        let viewer = self.viewers().get(&client).copied();
        viewer.ok_or_else(|| "this connection has taken its name back; open it anew".to_owned())
    }

    fn viewers(&self) -> MutexGuard<'_, HashMap<ClientId, Viewer>> {
        self.viewers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The number of an input, and whether a viewer's channel is as it must be.
    fn input(&self, channel: &ClientChannel) -> Result<usize, String> {
        let found = self.inputs.iter().position(|input| input.name == channel.topic);
        let Some(number) = found else {
            let names: Vec<&str> = self.inputs.iter().map(|input| input.name.as_str()).collect();
            return Err(format!(
                "{} is no input of the twin, and nothing that is published there acts; its inputs are {}",
                channel.topic,
                names.join(", ")
            ));
        };
        let kind = self.inputs[number].ros_type;
        // The form of ROS 1 is used by viewers too.
        let is_kind = channel.schema_name == kind || channel.schema_name == kind.replace("/msg/", "/");
        if !is_kind || channel.encoding != ENCODING {
            return Err(format!(
                "{} takes {kind} as {ENCODING}, not {} as {}; nothing that is published on this channel acts",
                channel.topic, channel.schema_name, channel.encoding
            ));
        }
        Ok(number)
    }

    fn take(&self, client: &Client, channel: &ClientChannel, payload: &[u8]) -> Result<(), String> {
        let viewer = self.viewer(client.id())?;
        let input = self.input(channel)?;
        let body = body(payload).map_err(|why| format!("{}: {why}", channel.topic))?;
        self.node.sample(viewer, input, body.to_vec());
        Ok(())
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

/// A service, called.
struct Call {
    steering: Arc<Steering>,
    number: usize,
}

impl foxglove::websocket::service::Handler for Call {
    fn call(&self, request: Request, responder: Responder) {
        let asked = self
            .steering
            .viewer(request.client_id())
            .and_then(|viewer| Ok((viewer, body(request.payload())?.to_vec())));
        let (viewer, body) = match asked {
            Ok(asked) => asked,
            Err(why) => return responder.respond_err(format!("{}: {why}", request.service_name())),
        };
        let answer = self.steering.node.call(viewer, self.number, body);
        tokio::spawn(async move {
            match answer.await {
                Ok(body) => {
                    let mut reply = [LITTLE_ENDIAN.as_slice(), &[0, 0]].concat();
                    reply.extend(body);
                    responder.respond_ok(reply);
                }
                Err(why) => responder.respond_err(format!("{}: {why}", request.service_name())),
            }
        });
    }
}

impl ParameterHandler for Steering {
    fn get(&self, _: AnyClient, names: Vec<String>, _: Option<String>, responder: GetParametersResponder) {
        let values = self.node.parameters(&names);
        responder.respond(values.into_iter().map(parameter).collect());
    }

    fn set(&self, client: AnyClient, parameters: Vec<Parameter>, _: Option<String>, responder: SetParametersResponder) {
        let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        for Parameter { name, value, .. } in parameters {
            let done = self.viewer(client.id()).and_then(|viewer| {
                let value = value.and_then(setting).ok_or_else(|| {
                    format!("'{name}' is not set: a parameter is a flag, a number, a text or a list of them")
                })?;
                self.node.set_parameter(viewer, &name, value)
            });
            if let Err(why) = done {
                client.send_error(why);
            }
        }
        // What they are, whether they were set or not.
        let values = self.node.parameters(&names);
        responder.respond(values.into_iter().map(parameter).collect());
    }
}

impl ServerListener for Steering {
    fn on_subscribe(&self, client: Client, channel: ChannelView) {
        self.hub.on_subscribe(client, channel);
    }

    fn on_client_connect(&self) {
        self.hub.on_client_connect();
    }

    fn on_client_disconnect(&self) {
        self.hub.on_client_disconnect();
    }

    fn on_client_advertise(&self, client: Client, channel: &ClientChannel) {
        let introduced = channel.topic.strip_prefix(self.secret.text());
        if let Some(address) = introduced.and_then(|address| address.parse().ok()) {
            let number = client.id().into();
            self.viewers().insert(client.id(), Viewer { number, address });
        } else if let Err(why) = self.input(channel) {
            client.send_status(Status::error(why));
        }
    }

    fn on_client_unadvertise(&self, client: Client, channel: &ClientChannel) {
        if channel.topic.starts_with(self.secret.text()) {
            self.viewers().remove(&client.id());
        }
    }

    fn on_message_data(&self, client: Client, channel: &ClientChannel, payload: &[u8]) {
        if let Err(why) = self.take(&client, channel, payload) {
            client.send_status(Status::error(why));
        }
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
