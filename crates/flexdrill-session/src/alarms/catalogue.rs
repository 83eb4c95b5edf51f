//! The catalogue of alarms: ids, names, categories and definitions.

use crate::messages::Alarm;
use flexdrill_alarms::{Definition, Delays, Priority};
use flexdrill_config::{Alarms, NodeAlarm, ToolAlarm};
use flexdrill_core::inputs::InputKind;
use flexdrill_motion::HazardKind;

flexdrill_base::listed! {
    /// A condition that requires a response of an operator. The order decides between alarms of equal priority.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[repr(usize)]
    pub enum AlarmId: 2 {
        /// The bit is stuck, and the top drive stalls: the torque in the string decides what may be done first.
        BitStuck: "bit_stuck", "bit stuck";
        /// Whirl of the pipe or the guide against the rotation.
        BackwardWhirl: "backward_whirl", "backward whirl";
        /// Whirl in the direction of the rotation.
        ForwardWhirl: "forward_whirl", "forward whirl";
        /// Lateral collisions.
        Shock: "shock", "lateral shock";
        /// The bit stops, or nearly, and accelerates again.
        StickSlip: "stick_slip", "stick-slip";
        /// The stop of a joint carries more than its rated moment.
        JointLoad: "joint_load", "joint overload";
        /// Irregular lateral motion of the pipe.
        ChaoticWhirl: "chaotic_whirl", "chaotic whirl";
        /// Most of the weight at the surface does not arrive at the bit.
        WeightTransfer: "weight_transfer", "weight not arriving";
        /// Most of the torque at the surface does not arrive at the bit.
        TorqueTransfer: "torque_transfer", "torque not arriving";
        /// The guide is bent beyond its rating.
        GuidePreload: "guide_preload", "guide overbent";
        /// Pressure compresses the pipe beyond its rating.
        PressureFolding: "pressure_folding", "folding under pressure";
        /// Numerical errors are too large for the computed motion to be reliable.
        ModelQuality: "model_quality", "model unreliable";
        /// Speed and weight are outside the part of the map in which no alarm must be expected.
        KnownWindow: "known_window", "outside the known window";
        /// What the rig measures is beyond the band that the twin expects.
        RigDisagrees: "rig_disagrees", "twin and rig disagree";
        /// The plan of the hole is outside the range in which plausible tools drill.
        HoleLeavesPlan: "hole_leaves_plan", "hole leaves its plan";
        /// Friction rises towards where the largest pull no longer reaches the bit.
        FrictionNearStuck: "friction_near_stuck", "friction near stuck";
        /// A client has changed values that alarms depend on.
        ChangedParameters: "changed_parameters", "changed parameters";
        /// Rotary speed not received, refused or stale.
        RotarySpeedInput: "rotary_speed_input", "no valid rotary speed";
        /// Weight on bit not received, refused or stale.
        WeightOnBitInput: "weight_on_bit_input", "no valid weight on bit";
        /// Rate of penetration refused or stale, once it was sent.
        RateOfPenetrationInput: "rate_of_penetration_input", "no valid rate of penetration";
        /// Standpipe pressure refused or stale, once it was sent.
        StandpipePressureInput: "standpipe_pressure_input", "no valid standpipe pressure";
        /// Several publishers send the same input at the same time.
        TwoDrivers: "two_drivers", "conflicting rig data";
        /// The model is slower than real time.
        RealTime: "real_time", "not in real time";
        /// A step failed and the model stopped.
        Solver: "solver", "model stopped";
        /// The recording stopped or lost messages.
        Recording: "recording", "recording fault";
        /// DDS restarted, or another node has the name of this one.
        Network: "network", "network fault";
    }
}

impl AlarmId {
    /// The identifier for programs, as in the configuration.
    pub const fn id(self) -> &'static str {
        self.row()[0]
    }

    /// The name for people, in lower case.
    pub const fn name(self) -> &'static str {
        self.row()[1]
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
