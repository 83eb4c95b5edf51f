//! All topics: name, type, rate and quality of service. The node and the bags share this table.

use super::{
    Ageing, AlarmEvent, AlarmList, AppliedInputs, Bands, BitState, ContactForces, Forecast, HoleAhead, HoleDrilled,
    JointDeflections, Message, Reactions, Residuals, RigInputs, RigMeasured, RigSurvey, SafeWindow, SessionInfo,
    Transfer, TwinStatus, TypeInfo, WhirlState, WhirlWarning, diagnostic_msgs, rosgraph_msgs, sensor_msgs, std_msgs,
    tf2_msgs, visualization_msgs,
};

/// Quality of service of a topic, in the terms that DDS matches on. History is always keep-last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Qos {
    /// Reliable, else best effort.
    pub reliable: bool,
    /// Transient local (late joiners get the newest), else volatile.
    pub transient_local: bool,
    /// History depth.
    pub depth: u32,
}

/// Reliable and volatile with that depth.
const fn reliable(depth: u32) -> Qos {
    Qos {
        reliable: true,
        transient_local: false,
        depth,
    }
}

/// Best effort, the newest only.
const BEST_EFFORT: Qos = Qos {
    reliable: false,
    transient_local: false,
    depth: 1,
};

/// The newest is kept for late joiners.
const LATCHED: Qos = Qos {
    reliable: true,
    transient_local: true,
    depth: 1,
};

/// When a topic carries a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cadence {
    /// Sent by us at the rate that stands under this key in the configuration's `outputs.rates`.
    Rate(&'static str),
    /// Sent by us when its content changes.
    OnChange,
    /// Received: others decide.
    Received,
}

/// One topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TopicInfo {
    /// Name; without a leading `/` it is relative to the node's namespace.
    pub name: &'static str,
    /// Type.
    pub kind: TypeInfo,
    /// When it carries a message.
    pub cadence: Cadence,
    /// Quality of service.
    pub qos: Qos,
}

impl TopicInfo {
    const fn new(name: &'static str, kind: TypeInfo, cadence: Cadence, qos: Qos) -> Self {
        Self {
            name,
            kind,
            cadence,
            qos,
        }
    }
}

/// Name of the node of `flexdrill bridge wits`, unless it is remapped. The page calls its service [`CONFIRM_MAPPING`].
pub const WITS_BRIDGE: &str = "flexdrill_bridge_wits";
/// The service of [`WITS_BRIDGE`] that confirms what it makes of a source, of the type `flexdrill/srv/ConfirmMapping`.
pub const CONFIRM_MAPPING: &str = "~/confirm_mapping";
/// Input: speed of the top drive in r/min.
pub const ROTARY_SPEED_RPM: TopicInfo = TopicInfo::new(
    "rig/rotary_speed_rpm",
    std_msgs::Float64::INFO,
    Cadence::Received,
    BEST_EFFORT,
);
/// Input: weight on bit in kN.
pub const WEIGHT_ON_BIT_KN: TopicInfo = TopicInfo::new(
    "rig/weight_on_bit_kn",
    std_msgs::Float64::INFO,
    Cadence::Received,
    BEST_EFFORT,
);
/// Input: advance of the tool along the hole in m/h. Optional.
pub const RATE_OF_PENETRATION: TopicInfo = TopicInfo::new(
    "rig/rate_of_penetration",
    std_msgs::Float64::INFO,
    Cadence::Received,
    BEST_EFFORT,
);
/// Input: pressure inside minus outside at the tool's top in MPa. Optional.
pub const STANDPIPE_PRESSURE: TopicInfo = TopicInfo::new(
    "rig/standpipe_pressure",
    std_msgs::Float64::INFO,
    Cadence::Received,
    BEST_EFFORT,
);
/// Input: all values with stamp, quality and source.
pub const RIG_INPUTS: TopicInfo = TopicInfo::new("rig/inputs", RigInputs::INFO, Cadence::Received, BEST_EFFORT);
/// Received: what the rig measures besides the inputs. It drives nothing.
pub const RIG_MEASURED: TopicInfo = TopicInfo::new("rig/measured", RigMeasured::INFO, Cadence::Received, BEST_EFFORT);
/// Received: surveys of the hole. They correct where the tool drills next, and drive nothing. A lost one does not come again.
pub const RIG_SURVEY: TopicInfo = TopicInfo::new("rig/survey", RigSurvey::INFO, Cadence::Received, reliable(100));
/// Input: the rig's clock, with `use_sim_time` only.
pub const CLOCK: TopicInfo = TopicInfo::new("/clock", rosgraph_msgs::Clock::INFO, Cadence::Received, BEST_EFFORT);
/// Output: per joint.
pub const JOINT_DEFLECTIONS: TopicInfo = TopicInfo::new(
    "twin/joint_deflections",
    JointDeflections::INFO,
    Cadence::Rate("joint_deflections"),
    reliable(10),
);
/// Output: per station.
pub const CONTACT_FORCES: TopicInfo = TopicInfo::new(
    "twin/contact_forces",
    ContactForces::INFO,
    Cadence::Rate("contact_forces"),
    reliable(10),
);
/// Output: per watched place.
pub const WHIRL: TopicInfo = TopicInfo::new("twin/whirl", WhirlState::INFO, Cadence::Rate("whirl"), reliable(10));
/// Output: the warning level.
pub const WHIRL_WARNINGS: TopicInfo =
    TopicInfo::new("twin/whirl_warnings", WhirlWarning::INFO, Cadence::OnChange, LATCHED);
/// Output: all alarms as they stand, on change and every second.
pub const ALARMS: TopicInfo = TopicInfo::new("twin/alarms", AlarmList::INFO, Cadence::OnChange, LATCHED);
/// Output: the alarms' journal.
pub const ALARM_EVENTS: TopicInfo =
    TopicInfo::new("twin/alarm_events", AlarmEvent::INFO, Cadence::OnChange, reliable(100));
/// Output: what ages, joint by joint and station by station.
pub const AGEING: TopicInfo = TopicInfo::new("twin/ageing", Ageing::INFO, Cadence::Rate("ageing"), reliable(10));
/// Output: the bit.
pub const BIT_STATE: TopicInfo = TopicInfo::new(
    "twin/bit_state",
    BitState::INFO,
    Cadence::Rate("bit_state"),
    reliable(10),
);
/// Output: forces from outside.
pub const REACTIONS: TopicInfo = TopicInfo::new(
    "twin/reactions",
    Reactions::INFO,
    Cadence::Rate("reactions"),
    reliable(10),
);
/// Output: torque, weight and power from the surface to the bit.
pub const TRANSFER: TopicInfo =
    TopicInfo::new("twin/transfer", Transfer::INFO, Cadence::Rate("transfer"), reliable(10));
/// Output: the next minute at the present speed and weight.
pub const FORECAST: TopicInfo = TopicInfo::new("twin/forecast", Forecast::INFO, Cadence::OnChange, LATCHED);
/// Output: what plausible tools do under the same inputs.
pub const BANDS: TopicInfo = TopicInfo::new("twin/bands", Bands::INFO, Cadence::OnChange, reliable(10));
/// Output: where the tool drills next.
pub const HOLE_AHEAD: TopicInfo = TopicInfo::new("twin/hole_ahead", HoleAhead::INFO, Cadence::OnChange, reliable(10));
/// Output: the points of the hole that the tool drills.
pub const HOLE_DRILLED: TopicInfo =
    TopicInfo::new("twin/hole_drilled", HoleDrilled::INFO, Cadence::OnChange, reliable(100));
/// Output: the map of speed and weight that is loaded.
pub const SAFE_WINDOW: TopicInfo = TopicInfo::new("twin/safe_window", SafeWindow::INFO, Cadence::OnChange, LATCHED);
/// Output: what the rig measures less what the twin computes.
pub const RESIDUALS: TopicInfo = TopicInfo::new("twin/residuals", Residuals::INFO, Cadence::OnChange, reliable(10));
/// Output: health and heartbeat.
pub const STATUS: TopicInfo = TopicInfo::new("twin/status", TwinStatus::INFO, Cadence::Rate("status"), reliable(10));
/// Output: picture of the tool.
pub const TOOL_SHAPE: TopicInfo = TopicInfo::new(
    "twin/tool_shape",
    visualization_msgs::MarkerArray::INFO,
    Cadence::Rate("tool_shape"),
    BEST_EFFORT,
);
/// Output: what drives the model from which step on, on change and every second.
pub const APPLIED_INPUTS: TopicInfo = TopicInfo::new(
    "twin/applied_inputs",
    AppliedInputs::INFO,
    Cadence::OnChange,
    reliable(100),
);
/// Output: configuration and version of the run.
pub const SESSION: TopicInfo = TopicInfo::new("twin/session", SessionInfo::INFO, Cadence::OnChange, LATCHED);
/// Output: joints for stock tools.
pub const JOINT_STATES: TopicInfo = TopicInfo::new(
    "joint_states",
    sensor_msgs::JointState::INFO,
    Cadence::Rate("joint_states"),
    reliable(10),
);
/// Output: diagnostics, in ROS's own place.
pub const DIAGNOSTICS: TopicInfo = TopicInfo::new(
    "/diagnostics",
    diagnostic_msgs::DiagnosticArray::INFO,
    Cadence::Rate("diagnostics"),
    reliable(10),
);

/// Output: where the frame of all headers lies, in ROS's own place.
pub const TF_STATIC: TopicInfo = TopicInfo::new("/tf_static", tf2_msgs::TFMessage::INFO, Cadence::OnChange, LATCHED);

/// All of them, inputs first.
pub const ALL: [TopicInfo; 31] = [
    ROTARY_SPEED_RPM,
    WEIGHT_ON_BIT_KN,
    RATE_OF_PENETRATION,
    STANDPIPE_PRESSURE,
    RIG_INPUTS,
    RIG_MEASURED,
    RIG_SURVEY,
    CLOCK,
    JOINT_DEFLECTIONS,
    CONTACT_FORCES,
    WHIRL,
    WHIRL_WARNINGS,
    ALARMS,
    ALARM_EVENTS,
    AGEING,
    BIT_STATE,
    REACTIONS,
    TRANSFER,
    FORECAST,
    BANDS,
    HOLE_AHEAD,
    HOLE_DRILLED,
    SAFE_WINDOW,
    RESIDUALS,
    STATUS,
    TOOL_SHAPE,
    APPLIED_INPUTS,
    SESSION,
    JOINT_STATES,
    DIAGNOSTICS,
    TF_STATIC,
];
