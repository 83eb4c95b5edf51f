//! The last hour, one frame per second, for a page that is opened later; its memory is bounded.

mod columns;
mod second;
mod wire;

use std::collections::VecDeque;

use self::columns::{Column, Layout};
use self::second::{FrameWriter, OpenFrame};
use super::session::Session;
use flexdrill_messages::visualization_msgs::MarkerArray;
use flexdrill_messages::{
    Alarm, AlarmList, BitState, ContactForces, JointDeflections, TwinStatus, WhirlState, WhirlWarning,
};

/// Number of frames kept: an hour at one per second. For the default tool a frame has 6.4 kB, all of them 23 MB.
pub(crate) const CAPACITY: usize = 3600;
/// A message further back in time than this belongs to another run, and is not merely out of order (ns).
const ANOTHER_RUN: i64 = 2_000_000_000;
const SECOND: i64 = 1_000_000_000;

/// The last hour.
#[derive(Debug)]
pub(crate) struct History {
    /// Model time of a frame (ns).
    period: i64,
    layout: Option<Layout>,
    /// Period and values of each frame.
    frames: VecDeque<(i64, Vec<f32>)>,
    open: Option<OpenFrame>,
    exaggeration: f64,
    /// The newest whirl warning, which holds until the next one; it may arrive before the tool's sizes are known.
    held: Option<(i64, WhirlWarning)>,
    /// Body and measured depth (m) of each watched station, so that a page can draw a tool that no longer publishes.
    watched: (Vec<u8>, Vec<f64>),
    /// Whether the whole source has been read.
    complete: bool,
}

impl History {
    /// An empty history with one frame per `seconds`.
    pub fn new(seconds: u32) -> Self {
        Self {
            period: i64::from(seconds.max(1)) * SECOND,
            layout: None,
            frames: VecDeque::new(),
            open: None,
            exaggeration: 1.0,
            held: None,
            watched: (Vec::new(), Vec::new()),
            complete: true,
        }
    }

    /// Sets whether the whole source has been read.
    pub fn set_complete(&mut self, complete: bool) {
        self.complete = complete;
    }

    /// Begins a run, whose tool may differ from the last one.
    pub fn begin(&mut self, session: &Session) {
        self.exaggeration = session.exaggeration;
        let sizes = (session.joints, session.stations.len());
        if self
            .layout
            .as_ref()
            .is_some_and(|layout| (layout.joints, layout.stations) != sizes)
        {
            self.layout = None;
            self.clear();
        }
    }

    /// Sets the factor by which later shapes exaggerate displacements.
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
        // DDS may deliver older states of a latched topic after its newest.
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

    /// Adds a message about whirl. The first one completes the tool's sizes.
    pub fn whirl(&mut self, time: i64, message: &WhirlState, session: &Session) {
        // At most every station of both pipes is watched; a longer message is not of this tool.
        if message.kind.len() > 2 * session.stations.len() {
            return;
        }
        let layout = Layout::new(session.joints, session.stations.len(), message.kind.len());
        if self.layout.as_ref() != Some(&layout) {
            self.clear();
            self.layout = Some(layout);
        }
        if (&self.watched.0, &self.watched.1) != (&message.body, &message.measured_depth) {
            self.watched = (message.body.clone(), message.measured_depth.clone());
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
            let displaced = marker.points.iter().zip(&session.stations);
            let displaced: Vec<[f64; 2]> = displaced
                .map(|(point, station)| station.displacement([point.x, point.y, point.z]))
                .collect();
            for (axis, column) in columns.into_iter().enumerate() {
                put.all(column, displaced.iter().map(|away| away[axis] / factor));
            }
        }
    }

    /// The frame of an instant (ns since 1970); `None` while the tool's sizes are not known, and for a late message.
    fn at(&mut self, time: i64) -> Option<FrameWriter<'_>> {
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
        let open = self.open.get_or_insert_with(|| OpenFrame::new(period, layout));
        let mut put = FrameWriter { layout, open };
        if let Some((_, warning)) = self.held.as_ref().filter(|_| begins) {
            put.warning(warning);
        }
        Some(put)
    }

    /// Closes the open frame, and marks the history as complete.
    pub fn finish(&mut self) {
        if let Some(done) = self.open.take() {
            self.frames.push_back((done.period, done.values));
        }
        self.complete = true;
    }
}

#[cfg(test)]
mod tests;
