//! Which alarms there are.

use crate::messages::Alarm;
use flexdrill_alarms::{Definition, Delays, Priority};
use flexdrill_config::{Alarms, NodeAlarm, ToolAlarm};
use flexdrill_core::inputs::InputKind;
use flexdrill_core::motion::HazardKind;

/// One thing that an operator can do something about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum AlarmId {
    /// The pipe or the guide goes round against the rotation.
    BackwardWhirl,
    /// It goes round with the rotation.
    ForwardWhirl,
    /// Collisions.
    Shock,
    /// The bit stops and springs forward.
    StickSlip,
    /// Joints beyond their rating.
    JointLoad,
    /// The pipe is thrown about without direction.
    ChaoticWhirl,
    /// The model contradicts itself.
    ModelQuality,
    /// Rotary speed not received, refused or stale.
    RotarySpeedInput,
    /// Weight on bit not received, refused or stale.
    WeightOnBitInput,
    /// More than one publisher drives an input.
    TwoDrivers,
    /// The model is slower than time.
    RealTime,
    /// A step failed.
    Solver,
    /// The recording stopped or loses messages.
    Recording,
    /// DDS had to be started again.
    Network,
}

impl AlarmId {
    /// All of them; where they are equally bad, the first goes first.
    pub const ALL: [AlarmId; 14] = [
        AlarmId::BackwardWhirl,
        AlarmId::ForwardWhirl,
        AlarmId::Shock,
        AlarmId::StickSlip,
        AlarmId::JointLoad,
        AlarmId::ChaoticWhirl,
        AlarmId::ModelQuality,
        AlarmId::RotarySpeedInput,
        AlarmId::WeightOnBitInput,
        AlarmId::TwoDrivers,
        AlarmId::RealTime,
        AlarmId::Solver,
        AlarmId::Recording,
        AlarmId::Network,
    ];

    /// For programs: as in the configuration.
    pub const fn id(self) -> &'static str {
        match self {
            AlarmId::BackwardWhirl => "backward_whirl",
            AlarmId::ForwardWhirl => "forward_whirl",
            AlarmId::Shock => "shock",
            AlarmId::StickSlip => "stick_slip",
            AlarmId::JointLoad => "joint_load",
            AlarmId::ChaoticWhirl => "chaotic_whirl",
            AlarmId::ModelQuality => "model_quality",
            AlarmId::RotarySpeedInput => "rotary_speed_input",
            AlarmId::WeightOnBitInput => "weight_on_bit_input",
            AlarmId::TwoDrivers => "two_drivers",
            AlarmId::RealTime => "real_time",
            AlarmId::Solver => "solver",
            AlarmId::Recording => "recording",
            AlarmId::Network => "network",
        }
    }

    /// For people.
    pub const fn name(self) -> &'static str {
        match self {
            AlarmId::BackwardWhirl => "backward whirl",
            AlarmId::ForwardWhirl => "forward whirl",
            AlarmId::Shock => "lateral shock",
            AlarmId::StickSlip => "stick-slip",
            AlarmId::JointLoad => "joints beyond their rating",
            AlarmId::ChaoticWhirl => "chaotic whirl",
            AlarmId::ModelQuality => "model not to be relied on",
            AlarmId::RotarySpeedInput => "rotary speed not known",
            AlarmId::WeightOnBitInput => "weight on bit not known",
            AlarmId::TwoDrivers => "two drivers",
            AlarmId::RealTime => "not in real time",
            AlarmId::Solver => "model stands still",
            AlarmId::Recording => "recording",
            AlarmId::Network => "network started again",
        }
    }

    /// Whom it is for: a constant of [`Alarm`]. What only the computer, its disk or its network is about must not fill
    /// the driller's banner; what means that the model no longer follows the tool belongs there.
    pub const fn category(self) -> u8 {
        match self {
            AlarmId::RealTime | AlarmId::Recording | AlarmId::Network => Alarm::SYSTEM,
            _ => Alarm::DRILLING,
        }
    }

    /// The lowest priority with which it is an alarm; what is less stays a displayed state. Nothing is to be done about
    /// forward whirl before it wears the pipe: it is how the tool turns at moderate speed and load.
    pub const fn lowest(self) -> Priority {
        match self {
            AlarmId::ForwardWhirl => Priority::Medium,
            _ => Priority::Low,
        }
    }

    /// The alarm of a hazard.
    pub const fn of_hazard(kind: HazardKind) -> Self {
        match kind {
            HazardKind::BackwardWhirl => AlarmId::BackwardWhirl,
            HazardKind::ForwardWhirl => AlarmId::ForwardWhirl,
            HazardKind::Shock => AlarmId::Shock,
            HazardKind::StickSlip => AlarmId::StickSlip,
            HazardKind::JointLoad => AlarmId::JointLoad,
            HazardKind::ChaoticWhirl => AlarmId::ChaoticWhirl,
        }
    }

    /// The alarm of an input.
    pub const fn of_input(kind: InputKind) -> Self {
        match kind {
            InputKind::RotarySpeed => AlarmId::RotarySpeedInput,
            InputKind::WeightOnBit => AlarmId::WeightOnBitInput,
        }
    }

    /// Its definition in a configuration.
    pub fn define(self, alarms: &Alarms) -> Definition {
        let tool = |alarm: &ToolAlarm| (alarm.in_service, alarm.on_delay, alarm.off_delay);
        let node = |alarm: &NodeAlarm| (alarm.in_service, alarm.on_delay, alarm.off_delay);
        let (in_service, on, off) = match self {
            AlarmId::BackwardWhirl => tool(&alarms.backward_whirl),
            AlarmId::ForwardWhirl => tool(&alarms.forward_whirl),
            AlarmId::Shock => tool(&alarms.shock),
            AlarmId::StickSlip => tool(&alarms.stick_slip),
            AlarmId::JointLoad => tool(&alarms.joint_load),
            AlarmId::ChaoticWhirl => tool(&alarms.chaotic_whirl),
            AlarmId::ModelQuality => tool(&alarms.model_quality),
            AlarmId::RotarySpeedInput => node(&alarms.rotary_speed_input),
            AlarmId::WeightOnBitInput => node(&alarms.weight_on_bit_input),
            AlarmId::TwoDrivers => node(&alarms.two_drivers),
            AlarmId::RealTime => node(&alarms.real_time),
            AlarmId::Solver => node(&alarms.solver),
            AlarmId::Recording => node(&alarms.recording),
            AlarmId::Network => node(&alarms.network),
        };
        Definition {
            id: self.id(),
            delays: Delays { on, off },
            in_service,
        }
    }
}
