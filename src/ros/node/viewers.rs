//! Viewers that steer: what they ask for goes the way of what comes over DDS, through the same checks.

use std::sync::Arc;

use futures::FutureExt as _;
use futures::future::BoxFuture;
use ros2_client::{Parameter, ParameterValue};

use super::rig::RigInputs;
use crate::dds::frames::Peer;
use crate::dds::plan::Guid;
use crate::dds::port::{Inbox, PortBuilder, Request, Sample};
use crate::live::{InputTopic, OfferedService, Setting, Steered, Steering, Viewer};
use crate::messages::find_type;
use crate::messages::topics::TopicInfo;
use crate::rig_inputs::{Driver, DriverId};
use crate::ros::parameters::Parameters;

/// What stands where a DDS program has the name of its node: no node has a name without `/`.
const NAME: &str = "foxglove client";
/// Begins the id of a viewer: as a vendor of DDS, zero is nobody.
const ID_PREFIX: [u8; 8] = *b"\0\0viewer";

/// An input: what it is, and where its samples are put.
pub type Input = (InputTopic, Arc<Inbox<Sample>>);

/// The input on a topic of that absolute name, whose samples are put to `samples`.
pub fn input(topic: &TopicInfo, name: String, samples: &Arc<Inbox<Sample>>) -> Input {
    let ros_type = topic.kind.ros_type;
    (InputTopic { name, ros_type }, Arc::clone(samples))
}

/// The node, as viewers that steer have it.
pub struct Viewers {
    parameters: Arc<Parameters>,
    rig: RigInputs,
    inputs: Vec<Input>,
    services: Vec<(OfferedService, Arc<Inbox<Request>>)>,
}

impl Viewers {
    /// With all services that have been named to `port`.
    pub fn new(port: &PortBuilder, parameters: &Arc<Parameters>, rig: &RigInputs, inputs: Vec<Input>) -> Arc<Self> {
        let services = port.services().filter_map(|(name, ros_type, inbox)| {
            // The definitions of all of them are part of the program; a test holds that.
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
            rig: rig.clone(),
            inputs,
        })
    }

    /// Has viewers told of every change of a parameter, whoever made it.
    pub fn tell_changes(&self, steering: &Arc<Steering>) {
        let steering = Arc::downgrade(steering);
        self.parameters.tell(Box::new(move |changed| {
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
        let Peer { id, node, address } = peer(viewer);
        self.rig.describe(Driver {
            id: DriverId(id),
            node,
            host: address,
        });
        inbox.put(Sample::Body { writer: id, body });
    }

    fn services(&self) -> Vec<OfferedService> {
        self.services.iter().map(|(service, _)| service.clone()).collect()
    }

    fn call(&self, viewer: Viewer, service: usize, body: Vec<u8>) -> BoxFuture<'static, Result<Vec<u8>, String>> {
        let (request, answer) = Request::of_this_process(peer(viewer), body);
        if let Some((_, inbox)) = self.services.get(service) {
            inbox.put(request);
        }
        async { answer.await.map_err(|_| NOT_ANSWERED.to_owned()) }.boxed()
    }
}

/// What a viewer hears where the service could not read its request, or had no time for it.
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

/// Parameters as viewers take them.
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

/// A viewer's value, in the type that the parameter has where JSON leaves it open: whole numbers and empty lists. What does
/// not fit is refused by the parameter.
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

/// Whether a number stands for itself as an integer: up to 2^53 all of them do.
fn is_whole(number: f64) -> bool {
    number.fract() == 0.0 && number.abs() <= (1_u64 << f64::MANTISSA_DIGITS) as f64
}

/// A list of one kind; a mixed one is no value at all.
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
    fn a_viewer_is_no_node_and_no_two_are_one() {
        let viewer = |number| Viewer {
            number,
            address: ([127, 0, 0, 1], 4000).into(),
        };
        let (one, two) = (peer(viewer(1)), peer(viewer(2)));
        assert!(!DriverId(one.id).same_process(&DriverId(two.id)));
        let driver = Driver {
            id: DriverId(one.id),
            node: one.node.clone(),
            host: one.address.clone(),
        };
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
        // The store takes a whole number for a real one; a broken one for a whole one it refuses.
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
