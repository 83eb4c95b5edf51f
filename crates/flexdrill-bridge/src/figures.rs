//! The twin's figures by name and unit: what is sent back to a rig, to a plant or to an office. Scalars of the messages are
//! rows of [`flexdrill_outputs::figures`]; what is made from codes and lists has its rows here.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use flexdrill_core::inputs::Dimension;
use flexdrill_messages::{
    Alarm, AlarmList, BitState, ContactForces, HoleAhead, JointDeflections, Message, Transfer, TwinStatus,
    WhirlWarning, message_from_cdr_body,
    topics::{self, TopicInfo},
};
use flexdrill_outputs::figures::{self, Figure as Scalar};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A figure of the twin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Figure {
    /// The name in mappings and on other protocols.
    pub name: &'static str,
    /// The topic that it comes from.
    pub topic: &'static TopicInfo,
    /// What it is, in a sentence or two.
    pub description: &'static str,
    /// What it measures; values are in the SI unit of that.
    pub dimension: Dimension,
}

impl Figure {
    /// All of them, in the order of displays.
    pub fn all() -> impl Iterator<Item = Self> {
        ALL.iter().copied()
    }

    /// The figure of that name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::all().find(|figure| figure.name == name)
    }
}

impl Serialize for Figure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}

impl<'de> Deserialize<'de> for Figure {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::of_name(&name).ok_or_else(|| {
            let names: Vec<&str> = Self::all().map(|figure| figure.name).collect();
            D::Error::custom(format!("`{name}` is no figure; the figures are {}", names.join(", ")))
        })
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// A figure with its value in a message.
struct Row<M> {
    figure: Figure,
    read: fn(&M) -> f64,
}

/// The scalars of a message that bridges send.
fn scalars<M: Message>(topic: &'static TopicInfo, table: &'static [Scalar<M>]) -> impl Iterator<Item = Row<M>> {
    table.iter().filter_map(move |scalar| {
        let description = format!("{} {}", scalar.text(), scalar.window.words());
        let figure = Figure {
            name: scalar.bridge?,
            topic,
            // Once per program, as the rows are made once.
            description: description.leak().trim_end(),
            dimension: scalar.kind.dimension()?,
        };
        let read = scalar.read;
        Some(Row { figure, read })
    })
}

/// The newest figures of the twin.
#[derive(Debug, Clone, Default)]
pub struct TwinFigures {
    /// By the figure's name.
    values: BTreeMap<&'static str, f64>,
    /// By the topic's name (ns since 1970).
    stamps: BTreeMap<&'static str, i64>,
    alarms: Option<AlarmList>,
    status: Option<TwinStatus>,
}

/// A message of the twin that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FiguresError {
    /// The topic has no figures.
    #[error("{0} has no figures; the topics that have are TwinFigures::TOPICS")]
    Topic(String),
    /// Its bytes are no message of the topic's type.
    #[error("{topic}: a message could not be read: {why}; twin and bridge should have the same version")]
    Unreadable {
        /// The topic.
        topic: &'static str,
        /// The reason, in words for a log.
        why: String,
    },
}

macro_rules! messages {
    ($(
        $topic:ident: $message:ident $(kept as $kept:ident)? {
            $($name:literal in $dimension:ident: $read:expr, $description:literal;)*
            $(..$scalars:path)?
        }
    )*) => {
        $(static $topic: LazyLock<Vec<Row<$message>>> = LazyLock::new(|| {
            let topic = &topics::$topic;
            let own: Vec<Row<$message>> = vec![$(Row {
                figure: Figure { name: $name, topic, description: $description, dimension: Dimension::$dimension },
                read: $read,
            }),*];
            own.into_iter()$(.chain(scalars(topic, $scalars)))?.collect()
        });)*

        static ALL: LazyLock<Vec<Figure>> = LazyLock::new(|| {
            let mut all = Vec::new();
            $(all.extend($topic.iter().map(|row| row.figure));)*
            all
        });

        impl TwinFigures {
            /// The topics that have figures.
            pub const TOPICS: [&'static TopicInfo; [$(topics::$topic.name),*].len()] = [$(&topics::$topic),*];

            /// Takes the body (CDR without its header) of a message on one of [`Self::TOPICS`].
            ///
            /// # Errors
            /// When the topic has no figures or the bytes are no message of its type.
            pub fn take(&mut self, topic: &str, body: &[u8]) -> Result<(), FiguresError> {
                match topic {
                    $(_ if topic == topics::$topic.name => {
                        let message: $message = read(&topics::$topic, body)?;
                        self.stamps.insert(topics::$topic.name, message.header.stamp.to_nanoseconds());
                        self.values.extend($topic.iter().map(|row| (row.figure.name, (row.read)(&message))));
                        $(self.$kept = Some(message);)?
                    })*
                    _ => return Err(FiguresError::Topic(topic.to_owned())),
                }
                Ok(())
            }
        }
    };
}

messages! {
    WHIRL_WARNINGS: WhirlWarning {
        "whirl_severity" in Number: |whirl| f64::from(whirl.severity),
            "Severity of the whirl warning: 0 ok, 1 watch, 2 warning, 3 critical.";
        "whirl_measured_depth" in Length:
            |whirl| if whirl.severity == WhirlWarning::OK { f64::NAN } else { whirl.measured_depth },
            "Measured depth from the kick-off of the whirl that the warning names.";
    }
    ALARMS: AlarmList kept as alarms {
        "active_alarms" in Number: |list| active(list).count() as f64, "Number of alarms that are active.";
        "unacknowledged_alarms" in Number: |list| f64::from(list.unacknowledged),
            "Number of alarms that are not yet acknowledged.";
        "highest_alarm_priority" in Number:
            |list| f64::from(active(list).map(|alarm| alarm.priority).max().unwrap_or(Alarm::NO_PRIORITY)),
            "Highest priority of the active alarms: 0 none, 1 low, 2 medium, 3 high.";
    }
    BIT_STATE: BitState { ..figures::BIT_STATE }
    JOINT_DEFLECTIONS: JointDeflections { ..figures::JOINT_DEFLECTIONS }
    CONTACT_FORCES: ContactForces { ..figures::CONTACT_FORCES }
    TRANSFER: Transfer { ..figures::TRANSFER }
    HOLE_AHEAD: HoleAhead {
        "hole_radius_low" in Length: |hole| hole.radius_low,
            "Radius of the hole over the next metre: 5 % of the plausible tools drill a smaller one.";
        "hole_radius_high" in Length: |hole| hole.radius_high,
            "Radius of the hole over the next metre: 5 % of the plausible tools drill a larger one.";
        "hole_inclination_ahead" in Angle: |hole| hole.inclinations.last().copied().unwrap_or(f64::NAN),
            "Inclination of the hole 5 m ahead: 0 is straight down.";
        ..figures::HOLE_AHEAD
    }
    STATUS: TwinStatus kept as status {
        "real_time_factor" in Number: |status| status.real_time_factor, "Model time over wall time.";
        "model_quality" in Number: |status| f64::from(status.model_quality),
            "How far the motion can be trusted: 0 good, 1 degraded, 2 poor.";
        "twin_state" in Number: |status| f64::from(status.state),
            "The state of the twin: 0 starting, 1 running, 2 paused, 3 failed.";
        "model_time" in Time: |status| status.model_time, "Model time.";
    }
}

fn active(list: &AlarmList) -> impl Iterator<Item = &Alarm> {
    list.alarms.iter().filter(|alarm| alarm.active)
}

impl TwinFigures {
    /// The newest value of a figure (SI); `None` where the twin has not sent it or does not have it.
    pub fn value(&self, figure: Figure) -> Option<f64> {
        self.values.get(figure.name).copied().filter(|value| value.is_finite())
    }

    /// When the twin computed the newest value (ns since 1970, on the rig's clock).
    pub fn stamp(&self, figure: Figure) -> Option<i64> {
        self.stamps.get(figure.topic.name).copied()
    }

    /// The newest status.
    pub fn status(&self) -> Option<&TwinStatus> {
        self.status.as_ref()
    }

    /// The newest list of alarms.
    pub fn alarms(&self) -> Option<&AlarmList> {
        self.alarms.as_ref()
    }
}

/// A message of a topic.
pub(crate) fn read<M: Message>(topic: &'static TopicInfo, body: &[u8]) -> Result<M, FiguresError> {
    message_from_cdr_body(body).map_err(|error| FiguresError::Unreadable {
        topic: topic.name,
        why: error.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::to_cdr_body;

    #[test]
    fn figures_come_from_the_newest_messages() {
        let mut twin = TwinFigures::default();
        assert!(Figure::all().all(|figure| twin.value(figure).is_none()));
        let value = |twin: &TwinFigures, name| twin.value(Figure::of_name(name).unwrap());
        let bit = BitState {
            torque: 350.0,
            stick_slip_index: f64::NAN,
            ..BitState::default()
        };
        twin.take(topics::BIT_STATE.name, &to_cdr_body(&bit).unwrap()).unwrap();
        assert_eq!(value(&twin, "bit_torque"), Some(350.0));
        assert_eq!(value(&twin, "stick_slip_index"), None);
        let active = Alarm {
            active: true,
            priority: Alarm::MEDIUM,
            ..Alarm::default()
        };
        let hole = HoleAhead {
            known: true,
            radius: 3.2,
            build_rate: 0.3125,
            plan_weight: f64::NAN,
            inclinations: vec![0.3, 1.1, 1.9],
            ..HoleAhead::default()
        };
        twin.take(topics::HOLE_AHEAD.name, &to_cdr_body(&hole).unwrap())
            .unwrap();
        assert_eq!(value(&twin, "hole_known"), Some(1.0));
        assert_eq!(value(&twin, "hole_radius"), Some(3.2));
        assert_eq!(value(&twin, "hole_inclination_ahead"), Some(1.9));
        assert_eq!(value(&twin, "hole_plan_weight"), None);
        let build = Figure::of_name("hole_build_rate").unwrap();
        assert_eq!(
            (twin.value(build), build.dimension.si().name()),
            (Some(0.3125), "rad/m")
        );
        // A hole that is no longer known leaves no value behind.
        let unknown = HoleAhead {
            radius: f64::NAN,
            ..HoleAhead::default()
        };
        twin.take(topics::HOLE_AHEAD.name, &to_cdr_body(&unknown).unwrap())
            .unwrap();
        assert_eq!(value(&twin, "hole_known"), Some(0.0));
        for name in ["hole_radius", "hole_inclination_ahead"] {
            assert_eq!(value(&twin, name), None, "{name}");
        }
        let list = AlarmList {
            alarms: vec![Alarm::default(), active],
            ..AlarmList::default()
        };
        twin.take(topics::ALARMS.name, &to_cdr_body(&list).unwrap()).unwrap();
        assert_eq!(value(&twin, "active_alarms"), Some(1.0));
        assert_eq!(value(&twin, "highest_alarm_priority"), Some(2.0));
        assert!(twin.take(topics::STATUS.name, b"\0").is_err());
        assert!(twin.take("rig/inputs", b"").is_err());
    }

    /// What sites have in their mappings and displays: names stay, in this order, whatever comes between them.
    #[test]
    fn figures_keep_their_names_and_their_order() {
        let expected = "whirl_severity whirl_measured_depth active_alarms unacknowledged_alarms highest_alarm_priority \
                        bit_torque bit_rotary_speed bit_weight stick_slip_index bit_axial_vibration bit_lateral_vibration \
                        bit_lateral_shock max_bend_angle joints_at_limit max_pipe_guide_force max_guide_wall_force \
                        surface_torque kickoff_torque torque_efficiency drive_at_limit hook_load rate_of_penetration \
                        real_time_factor model_quality twin_state model_time";
        let expected: Vec<&str> = expected.split(' ').collect();
        let names = Figure::all().map(|figure| figure.name);
        let kept: Vec<&str> = names.filter(|name| expected.contains(name)).collect();
        assert_eq!(kept, expected);
        assert_eq!(
            Figure::of_name("bit_weight").unwrap().description,
            "Weight on the bit, mean (N): given, or what the rock carries; 0 off bottom. Mean over the publishing interval."
        );
        let unknown = serde_json::from_str::<Figure>("\"bit_wait\"").unwrap_err().to_string();
        assert!(unknown.contains("bit_weight"), "{unknown}");
    }
}
