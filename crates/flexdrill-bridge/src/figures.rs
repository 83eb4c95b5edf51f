//! The twin's figures by name and unit: what is sent back to a rig, to a plant or to an office.

use std::fmt;

use flexdrill_core::inputs::Dimension;
use flexdrill_messages::{
    Alarm, AlarmList, BitState, ContactForces, JointDeflections, Message, Transfer, TwinStatus, WhirlWarning,
    message_from_cdr_body,
    topics::{self, TopicInfo},
};
use serde::{Deserialize, Serialize};

macro_rules! figures {
    ($($(#[doc = $doc:literal])* $figure:ident $name:literal in $dimension:ident from $field:ident: $value:expr;)*) => {
        /// A figure of the twin.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum Figure {
            $($(#[doc = $doc])* #[serde(rename = $name)] $figure,)*
        }

        impl Figure {
            /// All of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$figure),*];

            /// The name in mappings and on other protocols.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$figure => $name,)* }
            }

            /// The topic that it comes from.
            pub fn topic(self) -> &'static TopicInfo {
                match self { $(Self::$figure => sources::$field(),)* }
            }

            /// What it is, in a sentence.
            pub const fn description(self) -> &'static str {
                match self { $(Self::$figure => concat!($($doc),*),)* }
            }

            /// What it measures; values are in the SI unit of that.
            pub const fn dimension(self) -> Dimension {
                match self { $(Self::$figure => Dimension::$dimension,)* }
            }
        }

        impl TwinFigures {
            /// The newest value of a figure (SI); `None` where the twin has not sent it or does not have it.
            pub fn value(&self, figure: Figure) -> Option<f64> {
                let value: f64 = match figure {
                    $(Figure::$figure => {
                        let read: fn(&_) -> f64 = $value;
                        read(self.$field.as_ref()?)
                    })*
                };
                value.is_finite().then_some(value)
            }

            /// When the twin computed the newest value (ns since 1970, on the rig's clock).
            pub fn stamp(&self, figure: Figure) -> Option<i64> {
                Some(match figure {
                    $(Figure::$figure => self.$field.as_ref()?.header.stamp.to_nanoseconds(),)*
                })
            }
        }
    };
}

/// The topics by the names of the fields of [`TwinFigures`].
mod sources {
    use super::{TopicInfo, topics};

    pub(super) const fn whirl() -> &'static TopicInfo {
        &topics::WHIRL_WARNINGS
    }
    pub(super) const fn alarms() -> &'static TopicInfo {
        &topics::ALARMS
    }
    pub(super) const fn bit() -> &'static TopicInfo {
        &topics::BIT_STATE
    }
    pub(super) const fn joints() -> &'static TopicInfo {
        &topics::JOINT_DEFLECTIONS
    }
    pub(super) const fn contacts() -> &'static TopicInfo {
        &topics::CONTACT_FORCES
    }
    pub(super) const fn transfer() -> &'static TopicInfo {
        &topics::TRANSFER
    }
    pub(super) const fn status() -> &'static TopicInfo {
        &topics::STATUS
    }
}

figures! {
    /// Severity of the whirl warning: 0 ok, 1 watch, 2 warning, 3 critical.
    WhirlSeverity "whirl_severity" in Number from whirl: |whirl: &WhirlWarning| f64::from(whirl.severity);
    /// Measured depth from the kick-off of the whirl that the warning names.
    WhirlDepth "whirl_measured_depth" in Length from whirl: |whirl: &WhirlWarning| {
        if whirl.severity == WhirlWarning::OK { f64::NAN } else { whirl.measured_depth }
    };
    /// Number of alarms that are active.
    ActiveAlarms "active_alarms" in Number from alarms: |list: &AlarmList| {
        list.alarms.iter().filter(|alarm| alarm.active).count() as f64
    };
    /// Number of alarms that are not yet acknowledged.
    UnacknowledgedAlarms "unacknowledged_alarms" in Number from alarms: |list: &AlarmList| f64::from(list.unacknowledged);
    /// Highest priority of the active alarms: 0 none, 1 low, 2 medium, 3 high.
    HighestPriority "highest_alarm_priority" in Number from alarms: |list: &AlarmList| {
        let active = list.alarms.iter().filter(|alarm| alarm.active).map(|alarm| alarm.priority);
        f64::from(active.max().unwrap_or(Alarm::NO_PRIORITY))
    };
    /// Torque of the rock against the bit, mean since the message before.
    BitTorque "bit_torque" in Torque from bit: |bit: &BitState| bit.torque;
    /// Rotary speed of the bit, mean since the message before.
    BitSpeed "bit_rotary_speed" in RotarySpeed from bit: |bit: &BitState| bit.rotary_speed;
    /// Weight on the bit, mean since the message before.
    BitWeight "bit_weight" in Force from bit: |bit: &BitState| bit.weight_on_bit;
    /// Largest minus smallest speed of the bit over twice its mean.
    StickSlip "stick_slip_index" in Number from bit: |bit: &BitState| bit.stick_slip_index;
    /// Axial acceleration of the bit, root mean square.
    AxialVibration "bit_axial_vibration" in Acceleration from bit: |bit: &BitState| bit.axial_acceleration;
    /// Lateral acceleration of the bit, root mean square.
    LateralVibration "bit_lateral_vibration" in Acceleration from bit: |bit: &BitState| bit.lateral_acceleration;
    /// Largest lateral acceleration of the bit.
    LateralShock "bit_lateral_shock" in Acceleration from bit: |bit: &BitState| bit.lateral_acceleration_peak;
    /// Largest bend angle of all joints.
    BendAngle "max_bend_angle" in Angle from joints: |joints: &JointDeflections| joints.max_bend_angle;
    /// Number of joints at their limit.
    JointsAtLimit "joints_at_limit" in Number from joints: |joints: &JointDeflections| f64::from(joints.joints_at_limit);
    /// Largest force between pipe and guide pipe.
    PipeGuideForce "max_pipe_guide_force" in Force from contacts: |contacts: &ContactForces| contacts.max_pipe_guide_force;
    /// Largest force between guide pipe and wall.
    GuideWallForce "max_guide_wall_force" in Force from contacts: |contacts: &ContactForces| contacts.max_guide_wall_force;
    /// Torque of the top drive that the twin computes; only with a string above.
    SurfaceTorque "surface_torque" in Torque from transfer: |transfer: &Transfer| transfer.surface_torque;
    /// Torque on the top of the tool.
    KickoffTorque "kickoff_torque" in Torque from transfer: |transfer: &Transfer| transfer.kickoff_torque;
    /// Torque at the bit over that at the surface; not while the tool does not turn.
    TorqueEfficiency "torque_efficiency" in Number from transfer: |transfer: &Transfer| transfer.torque_efficiency;
    /// Share of the time in which the torque of the top drive was at its limit; only with a string above.
    DriveAtLimit "drive_at_limit" in Number from transfer: |transfer: &Transfer| transfer.drive_at_limit;
    /// Load on the hook that the twin computes; only with a string above.
    HookLoad "hook_load" in Force from transfer: |transfer: &Transfer| transfer.hook_load;
    /// Rate at which the hole deepens, as the twin computes it; 0 off bottom.
    RateOfPenetration "rate_of_penetration" in Speed from transfer: |transfer: &Transfer| transfer.rate_of_penetration;
    /// Model time over wall time.
    RealTimeFactor "real_time_factor" in Number from status: |status: &TwinStatus| status.real_time_factor;
    /// How far the motion can be trusted: 0 good, 1 degraded, 2 poor.
    ModelQuality "model_quality" in Number from status: |status: &TwinStatus| f64::from(status.model_quality);
    /// The state of the twin: 0 starting, 1 running, 2 paused, 3 failed.
    TwinState "twin_state" in Number from status: |status: &TwinStatus| f64::from(status.state);
    /// Model time.
    ModelTime "model_time" in Time from status: |status: &TwinStatus| status.model_time;
}

impl Figure {
    /// The figure of that name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|figure| figure.name() == name)
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The newest messages of the twin that have figures.
#[derive(Debug, Clone, Default)]
pub struct TwinFigures {
    whirl: Option<WhirlWarning>,
    alarms: Option<AlarmList>,
    bit: Option<BitState>,
    joints: Option<JointDeflections>,
    contacts: Option<ContactForces>,
    transfer: Option<Transfer>,
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

impl TwinFigures {
    /// The topics that have figures.
    pub const TOPICS: [&'static TopicInfo; 7] = [
        &topics::WHIRL_WARNINGS,
        &topics::ALARMS,
        &topics::BIT_STATE,
        &topics::JOINT_DEFLECTIONS,
        &topics::CONTACT_FORCES,
        &topics::TRANSFER,
        &topics::STATUS,
    ];

    /// Takes the body (CDR without its header) of a message on one of [`Self::TOPICS`].
    ///
    /// # Errors
    /// When the topic has no figures or the bytes are no message of its type.
    pub fn take(&mut self, topic: &str, body: &[u8]) -> Result<(), FiguresError> {
        match topic {
            _ if topic == topics::WHIRL_WARNINGS.name => self.whirl = Some(read(&topics::WHIRL_WARNINGS, body)?),
            _ if topic == topics::ALARMS.name => self.alarms = Some(read(&topics::ALARMS, body)?),
            _ if topic == topics::BIT_STATE.name => self.bit = Some(read(&topics::BIT_STATE, body)?),
            _ if topic == topics::JOINT_DEFLECTIONS.name => self.joints = Some(read(&topics::JOINT_DEFLECTIONS, body)?),
            _ if topic == topics::CONTACT_FORCES.name => self.contacts = Some(read(&topics::CONTACT_FORCES, body)?),
            _ if topic == topics::TRANSFER.name => self.transfer = Some(read(&topics::TRANSFER, body)?),
            _ if topic == topics::STATUS.name => self.status = Some(read(&topics::STATUS, body)?),
            _ => return Err(FiguresError::Topic(topic.to_owned())),
        }
        Ok(())
    }

    /// The newest status.
    pub fn status(&self) -> Option<&TwinStatus> {
        self.status.as_ref()
    }

    /// The newest list of alarms.
    pub fn alarms(&self) -> Option<&AlarmList> {
        self.alarms.as_ref()
    }

    /// The newest whirl warning.
    pub fn whirl(&self) -> Option<&WhirlWarning> {
        self.whirl.as_ref()
    }
}

fn read<M: Message>(topic: &'static TopicInfo, body: &[u8]) -> Result<M, FiguresError> {
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
        assert!(Figure::ALL.into_iter().all(|figure| twin.value(figure).is_none()));
        let bit = BitState {
            torque: 350.0,
            stick_slip_index: f64::NAN,
            ..BitState::default()
        };
        twin.take(topics::BIT_STATE.name, &to_cdr_body(&bit).unwrap()).unwrap();
        assert_eq!(twin.value(Figure::BitTorque), Some(350.0));
        assert_eq!(twin.value(Figure::StickSlip), None);
        let active = Alarm {
            active: true,
            priority: Alarm::MEDIUM,
            ..Alarm::default()
        };
        let list = AlarmList {
            alarms: vec![Alarm::default(), active],
            ..AlarmList::default()
        };
        twin.take(topics::ALARMS.name, &to_cdr_body(&list).unwrap()).unwrap();
        assert_eq!(twin.value(Figure::ActiveAlarms), Some(1.0));
        assert_eq!(twin.value(Figure::HighestPriority), Some(2.0));
        assert!(twin.take(topics::STATUS.name, b"\0").is_err());
        assert!(twin.take("rig/inputs", b"").is_err());
        for figure in Figure::ALL {
            assert_eq!(Figure::of_name(figure.name()), Some(figure));
        }
    }
}
