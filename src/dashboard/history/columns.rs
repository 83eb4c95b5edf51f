//! What a frame holds: columns with their units, the way of each through a second, and their places for a tool.

use super::CAPACITY;

/// Most bytes of frames, however long the tool and whatever is sent; the hour of a longer one is shorter.
pub(super) const MOST_BYTES: usize = 64 << 20;

/// How the values of one second become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum How {
    Last,
    /// The last, in the seconds after it too: it is sent when it changes.
    Held,
    Most,
    Least,
    Mean,
}

/// How many values a column has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Many {
    One,
    Joints,
    Stations,
    Watched,
}

macro_rules! columns {
    ($($column:ident $name:literal $unit:literal $how:ident $many:ident)*) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(in crate::dashboard::history) enum Column { $($column),* }
        /// Name, unit, way and size of each column, in their order.
        pub(in crate::dashboard::history) const COLUMNS: &[(&str, &str, How, Many)] = &[$(($name, $unit, How::$how, Many::$many)),*];
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

/// Sizes of a tool, and where its columns begin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layout {
    pub joints: usize,
    pub stations: usize,
    watched: usize,
    /// Of each column.
    pub offsets: Vec<usize>,
    /// Values of a frame.
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
        for (.., many) in COLUMNS {
            layout.offsets.push(layout.stride);
            layout.stride += layout.length(*many);
        }
        layout
    }

    /// Frames that are kept of this tool.
    pub fn capacity(&self) -> usize {
        CAPACITY.min(MOST_BYTES / (4 * self.stride.max(1))).max(1)
    }

    pub fn length(&self, many: Many) -> usize {
        match many {
            Many::One => 1,
            Many::Joints => self.joints,
            Many::Stations => self.stations,
            Many::Watched => self.watched,
        }
    }
}
