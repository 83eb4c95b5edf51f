//! The last hour, one frame a second, for a page that is opened late: bounded memory, whatever is sent.

mod columns;
mod second;
mod wire;

use std::collections::VecDeque;

use self::columns::{Column, Layout};
use self::second::{Open, Put};
use super::session::Session;
use crate::messages::visualization_msgs::MarkerArray;
use crate::messages::{
    Alarm, AlarmList, BitState, ContactForces, JointDeflections, TwinStatus, WhirlState, WhirlWarning,
};

/// Frames kept: an hour at one a second. Of the default tool a frame has 6.4 kB, all of them 23 MB.
pub(super) const CAPACITY: usize = 3600;
/// Times further back than this are another run, not messages out of order (ns).
const ANOTHER_RUN: i64 = 2_000_000_000;
const SECOND: i64 = 1_000_000_000;

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
    /// Body and measured depth (m) of each watched place, so that a page can draw a tool of which nothing comes any
    /// more.
    watched: (Vec<u8>, Vec<f64>),
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
            watched: (Vec::new(), Vec::new()),
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
        let open = self.open.get_or_insert_with(|| Open::new(period, layout));
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
}

#[cfg(test)]
mod tests;
