//! The summary of a replay.

use std::collections::BTreeMap;

use super::alarms::AlarmTally;
use super::log::LogPlace;
use crate::cli::output::say;
use crate::messages::Residuals;
use flexdrill_core::dynamics::phases::{Phase, PhaseTimes};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ModelQuality, QualityLevel, Snapshot};
use flexdrill_core::units::rad_to_deg;
use flexdrill_motion::{Ageing, Episode, EpisodeLog, Observation, ToolLocation};
use flexdrill_outputs::words;

/// The largest value of a quantity, with its depth and time.
#[derive(Debug, Clone, Copy, Default)]
struct Peak {
    value: f64,
    depth: f64,
    time: f64,
}

impl Peak {
    fn raise(&mut self, values: &[f64], depths: &[f64], time: f64) {
        for (value, depth) in values.iter().zip(depths) {
            if *value > self.value {
                *self = Self {
                    value: *value,
                    depth: *depth,
                    time,
                };
            }
        }
    }
}

/// Counts and extremes over a replay.
#[derive(Debug, Default)]
pub(super) struct Tally {
    /// Number of resets.
    pub resets: u64,
    /// Alarms and their figures.
    pub alarms: AlarmTally,
    /// What the rig measured against what the twin computed.
    pub rig: RigTally,
    steps: u64,
    iterations: u64,
    halvings: BTreeMap<u32, u64>,
    bend: Peak,
    stop: Peak,
    pipe_guide: Peak,
    guide_wall: Peak,
    joints_at_limit: usize,
    last: Option<Last>,
    wear: WearTally,
    quality: QualityTally,
    episodes: EpisodeLog,
    phases: PhaseTimes,
    /// Encoding and writing messages (ns).
    publish: u64,
}

/// Quality of the model over the replay.
#[derive(Debug, Default)]
struct QualityTally {
    /// Number of judged snapshots by level.
    judged: [u64; 3],
    /// The first of the worst level.
    worst: ModelQuality,
}

impl QualityTally {
    fn observe(&mut self, quality: &ModelQuality) {
        if quality.judged {
            self.judged[quality.level as usize] += 1;
        }
        if quality.level > self.worst.level || !self.worst.judged {
            self.worst = *quality;
        }
    }

    fn text(&self) -> String {
        let all: u64 = self.judged.iter().sum();
        let level = self.worst.level;
        if all == 0 || level == QualityLevel::Good {
            let cause = if all == 0 {
                format!(": {}", self.worst)
            } else {
                String::new()
            };
            return format!("{level}{cause}");
        }
        let share = 100.0 * self.judged[level as usize] as f64 / all as f64;
        format!("{level} for {share:.0} % of the time: {}", self.worst)
    }
}

/// The comparison of rig and twin over the replay.
#[derive(Debug, Default)]
pub(super) struct RigTally {
    comparisons: u64,
    judged: u64,
    /// Judged comparisons with a residual beyond its band.
    beyond: u64,
    newest: Option<Residuals>,
}

impl RigTally {
    /// Counts a comparison.
    pub(super) fn observe(&mut self, message: &Residuals) {
        let ratios = message.residuals.iter().map(|of| of.ratio.abs());
        let worst = ratios.filter(|ratio| ratio.is_finite()).max_by(f64::total_cmp);
        self.comparisons += 1;
        self.judged += u64::from(worst.is_some());
        self.beyond += u64::from(worst.is_some_and(|worst| worst > 1.0));
        self.newest = Some(message.clone());
    }

    /// What was judged, and what has followed the rig; none where the rig measured nothing.
    fn text(&self) -> Option<(String, Option<String>)> {
        let newest = self.newest.as_ref()?;
        let judged = format!(
            "{} comparisons, {} judged, {} of them beyond a band",
            self.comparisons, self.judged, self.beyond
        );
        let held = match newest.following_held.as_str() {
            "" => String::new(),
            held => format!("; {held}"),
        };
        let followed = newest.following.then(|| {
            format!(
                "friction factor {:.3} (configured {}), torque tare {:.1} N m (configured {}){held}",
                newest.applied_friction_factor,
                newest.configured_friction_factor,
                newest.applied_torque_tare,
                newest.configured_torque_tare
            )
        });
        Some((judged, followed))
    }
}

/// Ageing by location.
#[derive(Debug, Default)]
struct WearTally {
    ageing: Ageing,
    joint_depth: Vec<f64>,
    station_depth: Vec<f64>,
}

/// Number of joints that the summary names.
const JOINTS_NAMED: usize = 3;

impl WearTally {
    fn observe(&mut self, snapshot: &Snapshot) {
        self.ageing.clone_from(&snapshot.ageing);
        self.joint_depth.clone_from(&snapshot.joints.measured_depth);
        self.station_depth.clone_from(&snapshot.contacts.measured_depth);
    }

    /// The joints that age fastest, each relative to the fastest.
    fn joints(&self) -> String {
        let mut order: Vec<(usize, f64)> = self.ageing.relative_damage().enumerate().collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        let name = |&(joint, share): &(usize, f64)| {
            let part = if self.ageing.stop_damage[joint] >= self.ageing.bending_damage[joint] {
                "stop"
            } else {
                "link below"
            };
            format!(
                "joint {} at {:.2} m ({part}, {:.0} %)",
                joint + 1,
                self.joint_depth[joint],
                100.0 * share
            )
        };
        let named: Vec<String> = order
            .iter()
            .filter(|(_, share)| *share > 0.0)
            .take(JOINTS_NAMED)
            .map(name)
            .collect();
        if named.is_empty() {
            "none: no load cycle was large enough to count".to_owned()
        } else {
            named.join(", ")
        }
    }

    /// The work of friction, and its largest share, by layer.
    fn friction(&self) -> String {
        let most = |layer: usize| {
            let work = &self.ageing.friction_work[layer];
            let all: f64 = work.iter().sum();
            let station = (0..work.len())
                .max_by(|&a, &b| work[a].total_cmp(&work[b]))
                .unwrap_or_default();
            let (depth, here) = (self.station_depth.get(station), work.get(station));
            format!(
                "{} {:.0} J, most at {:.2} m ({:.1} J)",
                words::layer(layer),
                all,
                depth.copied().unwrap_or_default(),
                here.copied().unwrap_or_default()
            )
        };
        format!("{}; {}", most(0), most(1))
    }
}

#[derive(Debug)]
struct Last {
    energy_error: f64,
    drive: f64,
    rejected: u64,
    warnings: u64,
}

impl Tally {
    /// An empty one of a run that this log drives.
    pub(super) fn of_log(log: LogPlace) -> Self {
        Self {
            alarms: AlarmTally::of_log(log),
            ..Self::default()
        }
    }

    pub(super) fn step(&mut self, iterations: u32, halvings: u32) {
        self.steps += 1;
        self.iterations += u64::from(iterations);
        if halvings > 0 {
            *self.halvings.entry(halvings).or_default() += 1;
        }
    }

    /// Adds time spent on messages (ns).
    pub(super) fn publishing(&mut self, time: u64) {
        self.publish += time;
    }

    /// Sets the computing time by phase.
    pub(super) fn phases(&mut self, times: PhaseTimes) {
        self.phases = times;
    }

    /// Keeps the extremes of a snapshot.
    pub(super) fn observe(&mut self, snapshot: &Snapshot) {
        let (joints, contacts, time) = (&snapshot.joints, &snapshot.contacts, snapshot.time);
        self.bend.raise(&joints.bend_angle, &joints.measured_depth, time);
        self.stop.raise(&joints.stop_moment, &joints.measured_depth, time);
        self.pipe_guide
            .raise(&contacts.pipe_guide.normal_peak, &contacts.measured_depth, time);
        self.guide_wall
            .raise(&contacts.guide_wall.normal_peak, &contacts.measured_depth, time);
        let at_limit = joints
            .bend_angle
            .iter()
            .zip(&joints.limit_angle)
            .filter(|(angle, limit)| angle >= limit)
            .count();
        self.joints_at_limit = self.joints_at_limit.max(at_limit);
        self.episodes.push(&Observation {
            time,
            whirl: &snapshot.whirl,
            stick_slip: (snapshot.bit.stick_slip, snapshot.bit.stick_slip_index),
            bit: bit_location(snapshot),
            shock: snapshot.shock,
            shock_place: shock_location(snapshot),
        });
        self.quality.observe(&snapshot.quality);
        self.wear.observe(snapshot);
        self.last = Some(Last {
            energy_error: snapshot.energy.error,
            drive: snapshot.energy.drive,
            rejected: snapshot.solver.rejected,
            warnings: snapshot.warning.sequence,
        });
    }

    /// The episodes of the motion, in the order of their begin.
    pub(super) fn episodes(&mut self) -> Vec<Episode> {
        std::mem::take(&mut self.episodes).finish()
    }

    /// Prints the summary. `wall` is the wall time of the replay (s), `time_step` the model's step (s).
    pub(super) fn print(&self, wall: f64, time_step: f64) {
        let row = |name: &str, value: String| say!("  {name:<22} {value}");
        // Time by steps, not by stamps: skipped steps were not computed.
        let model = self.steps as f64 * time_step;
        row(
            "model time",
            format!(
                "{model:.2} s in {wall:.1} s, {:.2} x real time",
                if wall > 0.0 { model / wall } else { 0.0 }
            ),
        );
        if let Some(log) = self.alarms.log.text() {
            row("log", log);
        }
        row(
            "steps",
            format!("{} of {} ms, {} resets", self.steps, time_step * 1e3, self.resets),
        );
        if self.steps > 0 {
            row(
                "Newton iterations",
                format!("{:.2} per step", self.iterations as f64 / self.steps as f64),
            );
        }
        if self.steps > 0 {
            row("time per step", self.time_per_step());
        }
        // Keys are depths of halving in ascending order, so the last is the deepest.
        let split: u64 = self.halvings.values().sum();
        let deepest = self.halvings.keys().next_back().copied().unwrap_or_default();
        row(
            "halved steps",
            if split == 0 {
                "none".into()
            } else {
                format!("{split}, deepest 1/{}", 1_u64 << deepest.min(63))
            },
        );
        let at = |peak: &Peak| format!("at {:.2} m, model time {:.2} s", peak.depth, peak.time);
        row(
            "largest pipe-guide force",
            format!("{:.0} N {}", self.pipe_guide.value, at(&self.pipe_guide)),
        );
        row(
            "largest guide-wall force",
            format!("{:.0} N {}", self.guide_wall.value, at(&self.guide_wall)),
        );
        row(
            "largest bend",
            format!("{:.2} deg {}", rad_to_deg(self.bend.value), at(&self.bend)),
        );
        // The row says "never" instead of being absent, because an engineer looks for it first.
        if self.joints_at_limit > 0 {
            row(
                "joints at their limit",
                format!(
                    "up to {}, stop moment up to {:.0} N m {}",
                    self.joints_at_limit,
                    self.stop.value,
                    at(&self.stop)
                ),
            );
        } else {
            row("joints at their limit", "never".into());
        }
        // Sums since the start are in the last status; without one the run ended before its first second.
        if let Some(last) = &self.last {
            let share = share_of_drive(last.energy_error, last.drive);
            row("model quality", self.quality.text());
            row("energy error", format!("{:.3} J{share}", last.energy_error));
            row("fastest ageing", self.wear.joints());
            row("work of friction", self.wear.friction());
            row("rejected sub-steps", last.rejected.to_string());
            if let Some((judged, followed)) = self.rig.text() {
                row("rig against twin", judged);
                if let Some(followed) = followed {
                    row("follows the rig", followed);
                }
            }
            row("whirl warnings", format!("{} changes of level", last.warnings));
        }
    }

    /// Mean computing time per step, by phase.
    fn time_per_step(&self) -> String {
        let micros = |time: u64| time as f64 * 1e-3 / self.steps as f64;
        let phases = Phase::ALL.map(|phase| (phase.name(), self.phases.of(phase)));
        let parts: Vec<String> = phases
            .into_iter()
            .chain([("publish", self.publish)])
            .map(|(name, time)| format!("{name} {:.1}", micros(time)))
            .collect();
        format!(
            "{:.1} us: {}",
            micros(self.phases.total() + self.publish),
            parts.join(", ")
        )
    }
}

/// The location of the bit: the last station.
fn bit_location(snapshot: &Snapshot) -> ToolLocation {
    location(
        snapshot,
        snapshot.contacts.measured_depth.len().saturating_sub(1),
        Body::Pipe,
    )
}

fn shock_location(snapshot: &Snapshot) -> ToolLocation {
    let body = if snapshot.shock.layer == 0 {
        Body::Pipe
    } else {
        Body::Guide
    };
    location(snapshot, snapshot.shock.station, body)
}

fn location(snapshot: &Snapshot, station: usize, body: Body) -> ToolLocation {
    let at = |values: &[f64]| values.get(station).copied().unwrap_or_default();
    ToolLocation {
        station,
        body,
        measured_depth: at(&snapshot.contacts.measured_depth),
        inclination: at(&snapshot.contacts.inclination),
    }
}

/// An energy (J) next to the work of the drive (J), in words. A drive that has hardly turned has done next to no work:
/// a share of that says nothing.
fn share_of_drive(energy: f64, drive: f64) -> String {
    let share = (energy / drive).abs();
    match share {
        _ if !share.is_finite() => String::new(),
        share if share > 1.0 => format!(", more than the drive's work of {:.3} J", drive.abs()),
        share => format!(", {:.2} % of the drive's work", 100.0 * share),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_energy_is_no_share_of_next_to_nothing() {
        assert_eq!(share_of_drive(1.0, 200.0), ", 0.50 % of the drive's work");
        assert_eq!(share_of_drive(-1.0, 200.0), ", 0.50 % of the drive's work");
        assert_eq!(share_of_drive(10.2, 2.2e-16), ", more than the drive's work of 0.000 J");
        assert_eq!(share_of_drive(1.0, 0.0), "");
        assert_eq!(share_of_drive(0.0, 0.0), "");
    }
}
