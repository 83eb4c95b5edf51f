//! The last hour, one frame a second, for a page that is opened late: bounded memory, whatever is sent.

use std::collections::VecDeque;

use serde_json::json;

use super::session::Session;
use crate::messages::visualization_msgs::MarkerArray;
use crate::messages::{
    Alarm, AlarmList, BitState, ContactForces, JointDeflections, TwinStatus, WhirlState, WhirlWarning,
};

/// Frames kept: an hour at one a second. Of the default tool a frame has 6.4 kB, all of them 23 MB.
pub(super) const CAPACITY: usize = 3600;
/// Most bytes of frames, however long the tool and whatever is sent; the hour of a longer one is shorter.
const MOST_BYTES: usize = 64 << 20;
/// Times further back than this are another run, not messages out of order (ns).
const ANOTHER_RUN: i64 = 2_000_000_000;
const SECOND: i64 = 1_000_000_000;

/// How the values of one second become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum How {
    Last,
    /// The last, in the seconds after it too: it is sent when it changes.
    Held,
    Most,
    Least,
    Mean,
}

/// How many values a column has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Many {
    One,
    Joints,
    Stations,
    Watched,
}

macro_rules! columns {
    ($($column:ident $name:literal $unit:literal $how:ident $many:ident)*) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        enum Column { $($column),* }
        /// Name, unit, way and size of each column, in their order.
        const COLUMNS: &[(&str, &str, How, Many)] = &[$(($name, $unit, How::$how, Many::$many)),*];
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
struct Layout {
    joints: usize,
    stations: usize,
    watched: usize,
    offsets: Vec<usize>,
    stride: usize,
}

impl Layout {
    fn new(joints: usize, stations: usize, watched: usize) -> Self {
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
    fn capacity(&self) -> usize {
        CAPACITY.min(MOST_BYTES / (4 * self.stride.max(1))).max(1)
    }

    fn length(&self, many: Many) -> usize {
        match many {
            Many::One => 1,
            Many::Joints => self.joints,
            Many::Stations => self.stations,
            Many::Watched => self.watched,
        }
    }
}

/// A second that is being filled.
#[derive(Debug, Clone)]
struct Open {
    /// Number of the period since 1970.
    period: i64,
    values: Vec<f32>,
    /// Values in the means.
    counts: Vec<u32>,
}

/// The last hour.
#[derive(Debug)]
pub(super) struct History {
    /// Model time of a frame (ns).
    period: i64,
    layout: Option<Layout>,
    /// Period and values of each frame.
    frames: VecDeque<(i64, Vec<f32>)>,
    open: Option<Open>,
    exaggeration: f64,
    /// What holds until it changes, known before the tool's sizes too.
    held: Option<(i64, WhirlWarning)>,
    /// Nothing more comes.
    complete: bool,
}

impl History {
    /// One frame for so many seconds.
    pub fn new(seconds: u32) -> Self {
        Self {
            period: i64::from(seconds.max(1)) * SECOND,
            layout: None,
            frames: VecDeque::new(),
            open: None,
            exaggeration: 1.0,
            held: None,
            complete: true,
        }
    }

    /// Whether a bag is still being read into it.
    pub fn set_complete(&mut self, complete: bool) {
        self.complete = complete;
    }

    /// A run begins: its tool may be another one.
    pub fn begin(&mut self, session: &Session) {
        self.exaggeration = session.exaggeration;
        let sizes = (session.joints, session.places.len());
        if self
            .layout
            .as_ref()
            .is_some_and(|layout| (layout.joints, layout.stations) != sizes)
        {
            self.layout = None;
            self.clear();
        }
    }

    /// Displacements are drawn larger by this factor from now on.
    pub fn set_exaggeration(&mut self, factor: f64) {
        if factor > 0.0 {
            self.exaggeration = factor;
        }
    }

    fn clear(&mut self) {
        self.frames.clear();
        self.open = None;
    }

    pub fn status(&mut self, time: i64, message: &TwinStatus) {
        let input = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(f64::NAN);
        let state = |index: usize| message.input_state.get(index).copied().map_or(f64::NAN, f64::from);
        let Some(mut put) = self.at(time) else { return };
        put.one(Column::State, f64::from(message.state));
        put.one(Column::RealTimeFactor, message.real_time_factor);
        put.one(Column::ModelQuality, f64::from(message.model_quality));
        put.one(Column::SpeedState, state(0));
        put.one(Column::WeightState, state(1));
        put.one(Column::SpeedReceived, input(&message.input_received, 0));
        put.one(Column::SpeedApplied, input(&message.input_applied, 0));
        put.one(Column::WeightReceived, input(&message.input_received, 1));
        put.one(Column::WeightApplied, input(&message.input_applied, 1));
    }

    pub fn bit(&mut self, time: i64, message: &BitState) {
        let Some(mut put) = self.at(time) else { return };
        for column in [Column::BitSpeedMin, Column::BitSpeedMean, Column::BitSpeedMax] {
            put.one(column, message.rotary_speed);
        }
        put.one(Column::BitTorqueMean, message.torque);
        put.one(Column::BitTorqueMax, message.torque);
        put.one(Column::StickSlip, message.stick_slip_index);
        put.one(Column::StickSlipSeverity, f64::from(message.stick_slip_severity));
        put.one(Column::BitAcceleration, message.lateral_acceleration_peak);
    }

    pub fn warning(&mut self, time: i64, message: &WhirlWarning) {
        // A latched topic may bring older states after its newest.
        if self
            .held
            .as_ref()
            .is_some_and(|(held, _)| time < *held && time > held - ANOTHER_RUN)
        {
            return;
        }
        self.held = Some((time, message.clone()));
        if let Some(mut put) = self.at(time) {
            put.warning(message);
        }
    }

    pub fn joints(&mut self, time: i64, message: &JointDeflections) {
        let Some(mut put) = self.at(time) else { return };
        put.one(Column::BendAngle, message.max_bend_angle);
        put.one(Column::JointsAtLimit, f64::from(message.joints_at_limit));
        put.all(Column::JointBend, message.bend_angle.iter().copied());
        put.all(Column::JointStop, message.stop_moment.iter().copied());
        put.all(Column::JointY, message.lateral_y.iter().copied());
        put.all(Column::JointZ, message.lateral_z.iter().copied());
    }

    pub fn contacts(&mut self, time: i64, message: &ContactForces) {
        let Some(mut put) = self.at(time) else { return };
        put.one(Column::PipeGuideForce, message.max_pipe_guide_force);
        put.one(Column::GuideWallForce, message.max_guide_wall_force);
        put.one(Column::ShockSeverity, f64::from(message.shock_severity));
        put.all(Column::PipeGuidePeak, message.pipe_guide_normal_peak.iter().copied());
        put.all(Column::GuideWallPeak, message.guide_wall_normal_peak.iter().copied());
        put.all(Column::ContactState, message.state.iter().copied().map(f64::from));
    }

    /// The first message of whirl completes what must be known of the tool's sizes.
    pub fn whirl(&mut self, time: i64, message: &WhirlState, session: &Session) {
        // At most every station of both pipes is watched; more is not of this tool.
        if message.kind.len() > 2 * session.places.len() {
            return;
        }
        let layout = Layout::new(session.joints, session.places.len(), message.kind.len());
        if self.layout.as_ref() != Some(&layout) {
            self.clear();
            self.layout = Some(layout);
        }
        let Some(mut put) = self.at(time) else { return };
        put.all(Column::WhirlKind, message.kind.iter().copied().map(f64::from));
        put.all(Column::WhirlSeverity, message.severity.iter().copied().map(f64::from));
        put.all(Column::WhirlRatio, message.whirl_ratio.iter().copied());
        put.all(Column::Clearance, message.clearance_ratio.iter().copied());
        put.all(Column::ContactDuty, message.contact_duty.iter().copied());
    }

    pub fn alarms(&mut self, time: i64, message: &AlarmList) {
        let Some(mut put) = self.at(time) else { return };
        put.one(Column::Unacknowledged, f64::from(message.unacknowledged));
        let calling = message
            .alarms
            .iter()
            .filter(|alarm| alarm.active && ![Alarm::SHELVED, Alarm::OUT_OF_SERVICE].contains(&alarm.state));
        let worst = calling.map(|alarm| alarm.priority).max().unwrap_or_default();
        put.one(Column::WorstAlarm, f64::from(worst));
    }

    pub fn shape(&mut self, time: i64, message: &MarkerArray, session: &Session) {
        let factor = self.exaggeration;
        let Some(mut put) = self.at(time) else { return };
        for (name, columns) in [
            ("flexible_pipe", [Column::PipeY, Column::PipeZ]),
            ("guide_pipe", [Column::GuideY, Column::GuideZ]),
        ] {
            let Some(marker) = message.markers.iter().find(|marker| marker.ns == name) else {
                continue;
            };
            let displaced = marker.points.iter().zip(&session.places);
            let displaced: Vec<[f64; 2]> = displaced
                .map(|(point, place)| place.displacement([point.x, point.y, point.z]))
                .collect();
            for (axis, column) in columns.into_iter().enumerate() {
                put.all(column, displaced.iter().map(|away| away[axis] / factor));
            }
        }
    }

    /// The frame of an instant (ns since 1970); none while the tool's sizes are not known, or for what comes late.
    fn at(&mut self, time: i64) -> Option<Put<'_>> {
        let layout = self.layout.as_ref()?;
        let period = time.div_euclid(self.period);
        if let Some(open) = &self.open
            && period != open.period
        {
            if period > open.period {
                let done = self.open.take()?;
                while self.frames.len() >= layout.capacity() {
                    self.frames.pop_front();
                }
                self.frames.push_back((done.period, done.values));
            } else if time < open.period * self.period - ANOTHER_RUN {
                self.frames.clear();
                self.open = None;
            } else {
                return None;
            }
        }
        let begins = self.open.is_none();
        let open = self.open.get_or_insert_with(|| Open {
            period,
            values: vec![f32::NAN; layout.stride],
            counts: vec![0; COLUMNS.len()],
        });
        let mut put = Put { layout, open };
        if let Some((_, warning)) = self.held.as_ref().filter(|_| begins) {
            put.warning(warning);
        }
        Some(put)
    }

    /// Closes the frame that is being filled.
    pub fn finish(&mut self) {
        if let Some(done) = self.open.take() {
            self.frames.push_back((done.period, done.values));
        }
        self.complete = true;
    }

    /// All frames, as the page gets them; none while nothing is known.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        let layout = self.layout.as_ref()?;
        let open = self.open.as_ref().map(|open| (open.period, &open.values));
        let frames = || self.frames.iter().map(|(period, values)| (*period, values)).chain(open);
        let (base, _) = frames().next()?;
        let count = frames().count();
        let columns: Vec<_> = COLUMNS
            .iter()
            .zip(&layout.offsets)
            .map(|((name, unit, _, many), offset)| {
                json!({"name": name, "unit": unit, "offset": offset, "length": layout.length(*many)})
            })
            .collect();
        let mut head = json!({
            "base_ns": (base * self.period).to_string(),
            "period_s": self.period / SECOND,
            "capacity": layout.capacity(),
            "count": count,
            "stride": layout.stride,
            "complete": self.complete,
            "columns": columns,
        })
        .to_string();
        // The numbers begin where a typed array of any size may.
        while !(4 + head.len()).is_multiple_of(8) {
            head.push(' ');
        }
        let mut bytes = Vec::with_capacity(4 + head.len() + count * layout.stride * 4);
        bytes.extend((head.len() as u32).to_le_bytes());
        bytes.extend(head.as_bytes());
        for (period, values) in frames() {
            let time = ((period - base) * (self.period / SECOND)) as f32;
            bytes.extend(time.to_le_bytes());
            bytes.extend(
                values
                    .iter()
                    .skip(Column::Time as usize + 1)
                    .flat_map(|value| value.to_le_bytes()),
            );
        }
        Some(bytes)
    }
}

/// Puts values into the frame that is being filled.
struct Put<'a> {
    layout: &'a Layout,
    open: &'a mut Open,
}

impl Put<'_> {
    fn warning(&mut self, message: &WhirlWarning) {
        self.one(Column::WarningSeverity, f64::from(message.severity));
        self.one(Column::WarningKind, f64::from(message.kind));
        self.one(Column::WarningBody, f64::from(message.body));
        self.one(Column::WarningDepth, message.measured_depth);
    }

    fn one(&mut self, column: Column, value: f64) {
        self.all(column, std::iter::once(value));
    }

    fn all(&mut self, column: Column, values: impl Iterator<Item = f64>) {
        let number = column as usize;
        let (Some((_, _, how, many)), Some(&offset), Some(count)) = (
            COLUMNS.get(number),
            self.layout.offsets.get(number),
            self.open.counts.get_mut(number),
        ) else {
            return;
        };
        let length = self.layout.length(*many);
        let Some(kept) = self.open.values.get_mut(offset..offset + length) else {
            return;
        };
        *count += 1;
        for (kept, value) in kept.iter_mut().zip(values) {
            let value = value as f32;
            *kept = match how {
                How::Last | How::Held => value,
                How::Most => kept.max(value),
                How::Least => kept.min(value),
                How::Mean if *count == 1 => value,
                How::Mean => *kept + (value - *kept) / *count as f32,
            };
        }
    }
}

#[cfg(test)]
mod tests;
