//! The columns of a frame: name, unit, reduction over a second, and offset for a tool.

use super::CAPACITY;

/// Largest size of all frames (bytes). For a tool with larger frames, the history is shorter than an hour.
pub(super) const MOST_BYTES: usize = 64 << 20;

/// Reduction of the values of one second to one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reduction {
    Last,
    /// The last, also in the seconds after it, because it is published on change.
    Held,
    Most,
    Least,
    Mean,
}

/// Number of values of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Count {
    One,
    Joints,
    Stations,
    Watched,
}

macro_rules! columns {
    ($($column:ident $name:literal $unit:literal $reduction:ident $count:ident)*) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(in crate::history) enum Column { $($column),* }
        /// Name, unit, reduction and number of values of each column, in their order.
        pub(in crate::history) const COLUMNS: &[(&str, &str, Reduction, Count)] = &[$(($name, $unit, Reduction::$reduction, Count::$count)),*];
    };
}

columns! {
    Time "time" "s" Last One
    State "state" "" Last One
    RealTimeFactor "real_time_factor" "" Last One
    ModelQuality "model_quality" "" Most One
    SpeedState "rotary_speed_state" "" Last One
    WeightState "weight_on_bit_state" "" Last One
    SpeedReceived "rotary_speed_received" "rad/s" Last One
    SpeedApplied "rotary_speed_applied" "rad/s" Last One
    WeightReceived "weight_on_bit_received" "N" Last One
    WeightApplied "weight_on_bit_applied" "N" Last One
    BitSpeedMin "bit_speed_min" "rad/s" Least One
    BitSpeedMean "bit_speed_mean" "rad/s" Mean One
    BitSpeedMax "bit_speed_max" "rad/s" Most One
    BitTorqueMean "bit_torque_mean" "N m" Mean One
    BitTorqueMax "bit_torque_max" "N m" Most One
    StickSlip "stick_slip_index" "" Most One
    StickSlipSeverity "stick_slip_severity" "" Most One
    BitAcceleration "bit_lateral_acceleration_peak" "m/s2" Most One
    WarningSeverity "warning_severity" "" Held One
    WarningKind "warning_kind" "" Held One
    WarningBody "warning_body" "" Held One
    WarningDepth "warning_measured_depth" "m" Held One
    PipeGuideForce "max_pipe_guide_force" "N" Most One
    GuideWallForce "max_guide_wall_force" "N" Most One
    ShockSeverity "shock_severity" "" Most One
    BendAngle "max_bend_angle" "rad" Most One
    JointsAtLimit "joints_at_limit" "" Most One
    Unacknowledged "unacknowledged_alarms" "" Last One
    WorstAlarm "worst_alarm_priority" "" Last One
    JointBend "joint_bend_angle" "rad" Most Joints
    JointStop "joint_stop_moment" "N m" Most Joints
    JointY "joint_lateral_y" "m" Last Joints
    JointZ "joint_lateral_z" "m" Last Joints
    PipeGuidePeak "pipe_guide_normal_peak" "N" Most Stations
    GuideWallPeak "guide_wall_normal_peak" "N" Most Stations
    ContactState "contact_state" "" Last Stations
    WhirlKind "whirl_kind" "" Last Watched
    WhirlSeverity "whirl_severity" "" Last Watched
    WhirlRatio "whirl_ratio" "" Last Watched
    Clearance "clearance_ratio" "" Last Watched
    ContactDuty "contact_duty" "" Last Watched
    PipeY "pipe_y" "m" Last Stations
    PipeZ "pipe_z" "m" Last Stations
    GuideY "guide_y" "m" Last Stations
    GuideZ "guide_z" "m" Last Stations
}

/// Sizes of a tool, and offsets of its columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layout {
    pub joints: usize,
    pub stations: usize,
    watched: usize,
    /// Offset of each column.
    pub offsets: Vec<usize>,
    /// Number of values of a frame.
    pub stride: usize,
}

impl Layout {
    pub fn new(joints: usize, stations: usize, watched: usize) -> Self {
        let mut layout = Self {
            joints,
            stations,
            watched,
            offsets: Vec::new(),
            stride: 0,
        };
        for (.., count) in COLUMNS {
            layout.offsets.push(layout.stride);
            layout.stride += layout.length(*count);
        }
        layout
    }

    /// Number of frames kept for this tool.
    pub fn capacity(&self) -> usize {
        CAPACITY.min(MOST_BYTES / (4 * self.stride.max(1))).max(1)
    }

    pub fn length(&self, count: Count) -> usize {
        match count {
            Count::One => 1,
            Count::Joints => self.joints,
            Count::Stations => self.stations,
            Count::Watched => self.watched,
        }
    }
}
