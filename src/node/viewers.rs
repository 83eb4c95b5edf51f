//! Viewers that steer. Their samples, parameters and requests pass the same checks as those that come over DDS.

use std::sync::Arc;

use flexdrill_ros2::parameters::{Parameter, ParameterValue, Parameters};
use futures::FutureExt as _;
use futures::future::BoxFuture;

use super::inputs::RigInputs;
use super::receive;
use crate::live::{InputTopic, OfferedService, Setting, Steered, Steering, Viewer};
use crate::rig_inputs::DriverId;
use flexdrill_messages::find_type;
use flexdrill_messages::topics::TopicInfo;
use flexdrill_ros2::dds::frames::Peer;
use flexdrill_ros2::dds::plan::Guid;
use flexdrill_ros2::dds::port::{Inbox, PortBuilder, Request, Sample};

/// Takes the place of a node's name. No node has a name without `/`.
const NAME: &str = "foxglove client";
/// Begins the id of a viewer. No vendor of DDS has the number zero.
const ID_PREFIX: [u8; 8] = *b"\0\0viewer";

/// A topic that viewers may publish on, and the inbox of its samples.
pub type Input = (InputTopic, Arc<Inbox<Sample>>);

/// The input on a topic with the absolute name `name`.
pub fn input(topic: &TopicInfo, name: String, samples: &Arc<Inbox<Sample>>) -> Input {
    let ros_type = topic.kind.ros_type;
    (InputTopic { name, ros_type }, Arc::clone(samples))
}

/// The node's interface for viewers that steer.
pub struct Viewers {
    parameters: Arc<Parameters>,
    rig_inputs: RigInputs,
    inputs: Vec<Input>,
    services: Vec<(OfferedService, Arc<Inbox<Request>>)>,
}

impl Viewers {
    /// The interface with all services that `port` has so far.
    pub fn new(
        port: &PortBuilder,
        parameters: &Arc<Parameters>,
        rig_inputs: &RigInputs,
        inputs: Vec<Input>,
    ) -> Arc<Self> {
        let services = port.services().filter_map(|(name, ros_type, inbox)| {
            // The program contains the definitions of all services, as a test checks.
            let schema = |part: &str| Some(find_type(&format!("{ros_type}_{part}"))?.schema);
            let service = OfferedService {
                name: name.to_owned(),
                ros_type: ros_type.to_owned(),
                schemas: [schema("Request")?, schema("Response")?],
            };
            Some((service, Arc::clone(inbox)))
        });
        Arc::new(Self {
            services: services.collect(),
            parameters: Arc::clone(parameters),
            rig_inputs: rig_inputs.clone(),
            inputs,
        })
    }

    /// Publishes every change of a parameter to the viewers.
    pub fn publish_changes(&self, steering: &Arc<Steering>) {
        let steering = Arc::downgrade(steering);
        self.parameters.observe(Box::new(move |changed| {
            if let Some(steering) = steering.upgrade() {
                steering.send_parameters(settings(changed));
            }
        }));
    }
}

impl Steered for Viewers {
    fn parameters(&self, names: &[String]) -> Vec<(String, Setting)> {
        self.parameters.with(|store| {
            if names.is_empty() {
                return settings(&store.all());
            }
            let named = names.iter().filter_map(|name| {
                Some(Parameter {
                    name: name.clone(),
                    value: store.get(name)?.clone(),
                })
            });
            settings(&named.collect::<Vec<_>>())
        })
    }

    fn set_parameter(&self, viewer: Viewer, name: &str, value: Setting) -> Result<(), String> {
        let own = self.parameters.with(|store| store.get(name).cloned());
        let change = Parameter {
            name: name.to_owned(),
            value: value_of(value, own.as_ref()),
        };
        let set = self.parameters.set_one(change, &viewer.to_string());
        set.map_err(|refusal| refusal.to_string())
    }

    fn inputs(&self) -> Vec<InputTopic> {
        self.inputs.iter().map(|(topic, _)| topic.clone()).collect()
    }

    fn sample(&self, viewer: Viewer, input: usize, body: Vec<u8>) {
        let Some((_, inbox)) = self.inputs.get(input) else {
            return;
        };
        let peer = peer(viewer);
        let id = peer.id;
        // Discovery does not know viewers.
        if !self.rig_inputs.is_described(DriverId(id)) {
            self.rig_inputs.describe(receive::driver(peer));
        }
        inbox.push(Sample::Body { writer: id, body });
    }

    fn services(&self) -> Vec<OfferedService> {
        self.services.iter().map(|(service, _)| service.clone()).collect()
    }

    fn call(&self, viewer: Viewer, service: usize, body: Vec<u8>) -> BoxFuture<'static, Result<Vec<u8>, String>> {
        let (request, answer) = Request::of_this_process(peer(viewer), body);
        if let Some((_, inbox)) = self.services.get(service) {
            inbox.push(request);
        }
        async { answer.await.map_err(|_| NOT_ANSWERED.to_owned()) }.boxed()
    }
}

/// The answer for a viewer where the service could not read its request, or dropped it.
const NOT_ANSWERED: &str = "the request was not answered: it is not of the service's type, or too many came at once; the \
                            node's log says which";

fn peer(viewer: Viewer) -> Peer {
    let mut id = Guid::default();
    id[..ID_PREFIX.len()].copy_from_slice(&ID_PREFIX);
    id[ID_PREFIX.len()..ID_PREFIX.len() + 4].copy_from_slice(&viewer.number.to_be_bytes());
    Peer {
        id,
        node: Some(NAME.to_owned()),
        address: Some(viewer.address.to_string()),
    }
}

/// Parameters in the types of viewers.
fn settings(parameters: &[Parameter]) -> Vec<(String, Setting)> {
    let known = parameters
        .iter()
        .filter_map(|parameter| Some((parameter.name.clone(), setting(&parameter.value)?)));
    known.collect()
}

fn setting(value: &ParameterValue) -> Option<Setting> {
    fn list<T>(items: &[T], item: impl Fn(&T) -> Setting) -> Setting {
        Setting::List(items.iter().map(item).collect())
    }
    Some(match value {
        ParameterValue::NotSet => return None,
        ParameterValue::Boolean(flag) => Setting::Flag(*flag),
        ParameterValue::Integer(whole) => Setting::Whole(*whole),
        ParameterValue::Double(number) => Setting::Number(*number),
        ParameterValue::String(text) => Setting::Text(text.clone()),
        ParameterValue::ByteArray(items) => list(items, |byte| Setting::Whole(i64::from(*byte))),
        ParameterValue::BooleanArray(items) => list(items, |flag| Setting::Flag(*flag)),
        ParameterValue::IntegerArray(items) => list(items, |whole| Setting::Whole(*whole)),
        ParameterValue::DoubleArray(items) => list(items, |number| Setting::Number(*number)),
        ParameterValue::StringArray(items) => list(items, |text| Setting::Text(text.clone())),
    })
}

/// A viewer's value. JSON leaves the type of whole numbers and empty lists open; they get the type of the parameter, which
/// refuses a value of another type.
fn value_of(value: Setting, own: Option<&ParameterValue>) -> ParameterValue {
    match (value, own) {
        (Setting::Number(number), Some(ParameterValue::Integer(_))) if is_whole(number) => {
            ParameterValue::Integer(number as i64)
        }
        (Setting::Flag(flag), _) => ParameterValue::Boolean(flag),
        (Setting::Whole(whole), _) => ParameterValue::Integer(whole),
        (Setting::Number(number), _) => ParameterValue::Double(number),
        (Setting::Text(text), _) => ParameterValue::String(text),
        (Setting::List(list), own) => list_of(&list, own),
    }
}

/// Whether a number is an integer that a float represents exactly: up to 2^53 all of them are.
fn is_whole(number: f64) -> bool {
    number.fract() == 0.0 && number.abs() <= (1_u64 << f64::MANTISSA_DIGITS) as f64
}

/// A list of one type; a mixed list is no value.
fn list_of(list: &[Setting], own: Option<&ParameterValue>) -> ParameterValue {
    fn of<T>(list: &[Setting], item: impl Fn(&Setting) -> Option<T>) -> Option<Vec<T>> {
        list.iter().map(item).collect()
    }
    let number = |item: &Setting| match item {
        Setting::Number(number) => Some(*number),
        Setting::Whole(whole) => Some(*whole as f64),
        _ => None,
    };
    let whole = |item: &Setting| match item {
        Setting::Whole(whole) => Some(*whole),
        _ => None,
    };
    let text = |item: &Setting| match item {
        Setting::Text(text) => Some(text.clone()),
        _ => None,
    };
    let flag = |item: &Setting| match item {
        Setting::Flag(flag) => Some(*flag),
        _ => None,
    };
    let as_own = match own {
        Some(ParameterValue::DoubleArray(_)) => of(list, number).map(ParameterValue::DoubleArray),
        Some(ParameterValue::IntegerArray(_)) => of(list, whole).map(ParameterValue::IntegerArray),
        Some(ParameterValue::StringArray(_)) => of(list, text).map(ParameterValue::StringArray),
        Some(ParameterValue::BooleanArray(_)) => of(list, flag).map(ParameterValue::BooleanArray),
        _ => None,
    };
    as_own
        .or_else(|| of(list, whole).map(ParameterValue::IntegerArray))
        .or_else(|| of(list, number).map(ParameterValue::DoubleArray))
        .or_else(|| of(list, text).map(ParameterValue::StringArray))
        .or_else(|| of(list, flag).map(ParameterValue::BooleanArray))
        .unwrap_or(ParameterValue::NotSet)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_are_no_nodes_and_have_different_ids() {
        let viewer = |number| Viewer {
            number,
            address: ([127, 0, 0, 1], 4000).into(),
        };
        let (one, two) = (peer(viewer(1)), peer(viewer(2)));
        assert!(!DriverId(one.id).same_process(&DriverId(two.id)));
        let driver = receive::driver(one.clone());
        let id = "000076696577657200000001";
        assert_eq!(
            driver.to_string(),
            format!("foxglove client @ 127.0.0.1:4000 ({id}.00000000)")
        );
        assert_eq!(
            one.to_string(),
            format!("foxglove client at 127.0.0.1:4000 (id {id}00000000)")
        );
    }

    #[test]
    fn values_come_in_the_parameters_own_type() {
        let double = ParameterValue::Double(1.0);
        assert_eq!(
            value_of(Setting::Number(5.0), Some(&ParameterValue::Integer(1))),
            ParameterValue::Integer(5)
        );
        // The store accepts a whole number for a float, and refuses a fraction for an integer.
        assert_eq!(value_of(Setting::Whole(5), Some(&double)), ParameterValue::Integer(5));
        assert_eq!(
            value_of(Setting::Number(5.5), Some(&ParameterValue::Integer(1))),
            ParameterValue::Double(5.5)
        );
        let texts = ParameterValue::StringArray(vec!["a".into()]);
        assert_eq!(
            value_of(Setting::List(vec![]), Some(&texts)),
            ParameterValue::StringArray(vec![])
        );
        let mixed = Setting::List(vec![Setting::Whole(1), Setting::Text("x".into())]);
        assert_eq!(value_of(mixed, Some(&texts)), ParameterValue::NotSet);
        for value in [
            double,
            texts,
            ParameterValue::Boolean(true),
            ParameterValue::DoubleArray(vec![1.0, 2.0]),
        ] {
            assert_eq!(value_of(setting(&value).unwrap(), Some(&value)), value);
        }
    }
}
