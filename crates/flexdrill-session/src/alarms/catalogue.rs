//! The catalogue of alarms: ids, names, categories and definitions.

use crate::messages::Alarm;
use flexdrill_alarms::{Definition, Delays, Priority};
use flexdrill_config::{Alarms, NodeAlarm, ToolAlarm};
use flexdrill_core::inputs::InputKind;
use flexdrill_motion::HazardKind;

/// A condition that requires a response of an operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum AlarmId {
    /// The bit is stuck, and the top drive stalls: the torque in the string decides what may be done first.
    BitStuck,
    /// Whirl of the pipe or the guide against the rotation.
    BackwardWhirl,
    /// Whirl in the direction of the rotation.
    ForwardWhirl,
    /// Lateral collisions.
    Shock,
    /// The bit stops, or nearly, and accelerates again.
    StickSlip,
    /// The stop of a joint carries more than its rated moment.
    JointLoad,
    /// Irregular lateral motion of the pipe.
    ChaoticWhirl,
    /// Most of the weight at the surface does not arrive at the bit.
    WeightTransfer,
    /// Most of the torque at the surface does not arrive at the bit.
    TorqueTransfer,
    /// The guide is bent beyond its rating.
    GuidePreload,
    /// Pressure compresses the pipe beyond its rating.
    PressureFolding,
    /// Numerical errors are too large for the computed motion to be reliable.
    ModelQuality,
    /// Speed and weight are outside the part of the map in which no alarm must be expected.
    KnownWindow,
    /// What the rig measures is beyond the band that the twin expects.
    RigDisagrees,
    /// The plan of the hole is outside the range in which plausible tools drill.
    HoleLeavesPlan,
    /// Friction rises towards where the largest pull no longer reaches the bit.
    FrictionNearStuck,
    /// A client has changed values that alarms depend on.
    ChangedParameters,
    /// Rotary speed not received, refused or stale.
    RotarySpeedInput,
    /// Weight on bit not received, refused or stale.
    WeightOnBitInput,
    /// Rate of penetration refused or stale, once it was sent.
    RateOfPenetrationInput,
    /// Standpipe pressure refused or stale, once it was sent.
    StandpipePressureInput,
    /// Several publishers send the same input at the same time.
    TwoDrivers,
    /// The model is slower than real time.
    RealTime,
    /// A step failed and the model stopped.
    Solver,
    /// The recording stopped or lost messages.
    Recording,
    /// DDS restarted, or another node has the name of this one.
    Network,
}

impl AlarmId {
    /// All alarms. The order decides between alarms of equal priority.
    pub const ALL: [AlarmId; 26] = [
        AlarmId::BitStuck,
        AlarmId::BackwardWhirl,
        AlarmId::ForwardWhirl,
        AlarmId::Shock,
        AlarmId::StickSlip,
        AlarmId::JointLoad,
        AlarmId::ChaoticWhirl,
        AlarmId::WeightTransfer,
        AlarmId::TorqueTransfer,
        AlarmId::GuidePreload,
        AlarmId::PressureFolding,
        AlarmId::ModelQuality,
        AlarmId::KnownWindow,
        AlarmId::RigDisagrees,
        AlarmId::HoleLeavesPlan,
        AlarmId::FrictionNearStuck,
        AlarmId::ChangedParameters,
        AlarmId::RotarySpeedInput,
        AlarmId::WeightOnBitInput,
        AlarmId::RateOfPenetrationInput,
        AlarmId::StandpipePressureInput,
        AlarmId::TwoDrivers,
        AlarmId::RealTime,
        AlarmId::Solver,
        AlarmId::Recording,
        AlarmId::Network,
    ];

    /// The identifier for programs, as in the configuration.
    pub const fn id(self) -> &'static str {
        match self {
            AlarmId::BackwardWhirl => "backward_whirl",
            AlarmId::ForwardWhirl => "forward_whirl",
            AlarmId::Shock => "shock",
            AlarmId::StickSlip => "stick_slip",
            AlarmId::JointLoad => "joint_load",
            AlarmId::ChaoticWhirl => "chaotic_whirl",
            AlarmId::WeightTransfer => "weight_transfer",
            AlarmId::TorqueTransfer => "torque_transfer",
            AlarmId::GuidePreload => "guide_preload",
            AlarmId::PressureFolding => "pressure_folding",
            AlarmId::BitStuck => "bit_stuck",
            AlarmId::ModelQuality => "model_quality",
            AlarmId::KnownWindow => "known_window",
            AlarmId::RigDisagrees => "rig_disagrees",
            AlarmId::HoleLeavesPlan => "hole_leaves_plan",
            AlarmId::FrictionNearStuck => "friction_near_stuck",
            AlarmId::ChangedParameters => "changed_parameters",
            AlarmId::RotarySpeedInput => "rotary_speed_input",
            AlarmId::WeightOnBitInput => "weight_on_bit_input",
            AlarmId::RateOfPenetrationInput => "rate_of_penetration_input",
            AlarmId::StandpipePressureInput => "standpipe_pressure_input",
            AlarmId::TwoDrivers => "two_drivers",
            AlarmId::RealTime => "real_time",
            AlarmId::Solver => "solver",
            AlarmId::Recording => "recording",
            AlarmId::Network => "network",
        }
    }

    /// The name for people, in lower case.
    pub const fn name(self) -> &'static str {
        match self {
            AlarmId::BackwardWhirl => "backward whirl",
            AlarmId::ForwardWhirl => "forward whirl",
            AlarmId::Shock => "lateral shock",
            AlarmId::StickSlip => "stick-slip",
            AlarmId::JointLoad => "joint overload",
            AlarmId::ChaoticWhirl => "chaotic whirl",
            AlarmId::WeightTransfer => "weight not arriving",
            AlarmId::TorqueTransfer => "torque not arriving",
            AlarmId::GuidePreload => "guide overbent",
            AlarmId::PressureFolding => "folding under pressure",
            AlarmId::BitStuck => "bit stuck",
            AlarmId::ModelQuality => "model unreliable",
            AlarmId::KnownWindow => "outside the known window",
            AlarmId::RigDisagrees => "twin and rig disagree",
            AlarmId::HoleLeavesPlan => "hole leaves its plan",
            AlarmId::FrictionNearStuck => "friction near stuck",
            AlarmId::ChangedParameters => "changed parameters",
            AlarmId::RotarySpeedInput => "no valid rotary speed",
            AlarmId::WeightOnBitInput => "no valid weight on bit",
            AlarmId::RateOfPenetrationInput => "no valid rate of penetration",
            AlarmId::StandpipePressureInput => "no valid standpipe pressure",
            AlarmId::TwoDrivers => "conflicting rig data",
            AlarmId::RealTime => "not in real time",
            AlarmId::Solver => "model stopped",
            AlarmId::Recording => "recording fault",
            AlarmId::Network => "network fault",
        }
    }

    /// A constant of [`Alarm`]: `SYSTEM` for a matter of the twin's computer, its disk or its network, which must not
    /// fill the driller's banner; `DRILLING` for all else, including a model that no longer follows the tool.
    pub const fn category(self) -> u8 {
        match self {
            AlarmId::RealTime | AlarmId::Recording | AlarmId::Network => Alarm::SYSTEM,
            _ => Alarm::DRILLING,
        }
    }

    /// The lowest priority at which the condition is an alarm; below it the condition is a displayed state. Forward
    /// whirl requires no action before it wears the pipe: the tool turns this way at moderate speed and load. Nor does
    /// friction that takes a usual share of weight and torque, a load below its rating, or a bit that sticks for a moment.
    pub const fn lowest(self) -> Priority {
        match self {
            AlarmId::ForwardWhirl
            | AlarmId::WeightTransfer
            | AlarmId::TorqueTransfer
            | AlarmId::GuidePreload
            | AlarmId::PressureFolding
            | AlarmId::BitStuck => Priority::Medium,
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
            HazardKind::WeightTransfer => AlarmId::WeightTransfer,
            HazardKind::TorqueTransfer => AlarmId::TorqueTransfer,
            HazardKind::GuidePreload => AlarmId::GuidePreload,
            HazardKind::PressureFolding => AlarmId::PressureFolding,
            HazardKind::BitStuck => AlarmId::BitStuck,
        }
    }

    /// The alarm of an input.
    pub const fn of_input(kind: InputKind) -> Self {
        match kind {
            InputKind::RotarySpeed => AlarmId::RotarySpeedInput,
            InputKind::WeightOnBit => AlarmId::WeightOnBitInput,
            InputKind::RateOfPenetration => AlarmId::RateOfPenetrationInput,
            InputKind::StandpipePressure => AlarmId::StandpipePressureInput,
        }
    }

    /// The definition of the alarm in a configuration.
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
            AlarmId::WeightTransfer => tool(&alarms.weight_transfer),
            AlarmId::TorqueTransfer => tool(&alarms.torque_transfer),
            AlarmId::GuidePreload => tool(&alarms.guide_preload),
            AlarmId::PressureFolding => tool(&alarms.pressure_folding),
            AlarmId::BitStuck => tool(&alarms.bit_stuck),
            AlarmId::ModelQuality => tool(&alarms.model_quality),
            AlarmId::KnownWindow => tool(&alarms.known_window),
            AlarmId::RigDisagrees => tool(&alarms.rig_disagrees),
            AlarmId::HoleLeavesPlan => tool(&alarms.hole_leaves_plan),
            AlarmId::FrictionNearStuck => tool(&alarms.friction_near_stuck),
            AlarmId::ChangedParameters => tool(&alarms.changed_parameters),
            AlarmId::RotarySpeedInput => node(&alarms.rotary_speed_input),
            AlarmId::WeightOnBitInput => node(&alarms.weight_on_bit_input),
            AlarmId::RateOfPenetrationInput => node(&alarms.rate_of_penetration_input),
            AlarmId::StandpipePressureInput => node(&alarms.standpipe_pressure_input),
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
