//! The motion of a member by itself: at which points an alarm is judged at all, and what the motion is there.
//!
//! Near standstill and at little weight the analysis judges nothing: its ratios mean nothing there
//! (`stick_slip.gate_speed_rpm`, `whirl.gate_speed_rpm`, `transfer.least_weight`). An alarm that does not stand at such
//! a point has not ended. So that a change is not called a cure because it silences the alarm, the figures that the
//! alarms are judged by are formed here again without gates, delays and hold-offs.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use crate::alarms::{AlarmId, called_at};
use flexdrill_config::Config;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{SimulationSettings, Snapshot};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{
    AlarmThresholds, BIT, DriveState, ENDED_AFTER, HazardKind, SURFACE, Severity, ShockSettings, WhirlKind,
    WhirlSettings,
};

/// Part by which speed and weight must be above a gate: those of a rig fluctuate by some percent, and an alarm that is
/// judged now and then ends between.
const MARGIN: f64 = 0.05;
/// Least part of the drive's speed that the swing of the bit's speed is divided by, as in the analysis: a bit that
/// stands would yield zero over zero.
const STUCK: f64 = 0.1;
/// Speed (rad/s) that a whirl rate is divided by at least, so that a whirl of a tool that stands counts as many cycles.
const SLOWEST: f64 = 1e-3;

/// The hazard of an alarm of the tool's motion.
pub(super) fn hazard(id: AlarmId) -> Option<HazardKind> {
    HazardKind::ALL.into_iter().find(|kind| AlarmId::of_hazard(*kind) == id)
}

/// Whether an alarm is judged at a speed (r/min) and weight (kN) that are held there.
pub(super) fn is_judged_at(id: AlarmId, [rpm, kn]: [f64; 2], settings: &SimulationSettings) -> bool {
    let above = |value: f64, gate: f64| value >= (1.0 + MARGIN) * gate;
    let speed = rpm_to_rad_per_s(rpm.abs());
    let gates = match hazard(id) {
        None => return true,
        Some(HazardKind::StickSlip) => above(speed, settings.stick_slip.gate_speed),
        Some(HazardKind::WeightTransfer | HazardKind::TorqueTransfer) => {
            above(kn_to_n(kn), settings.transfer.least_weight)
        }
        Some(
            HazardKind::BackwardWhirl
            | HazardKind::ForwardWhirl
            | HazardKind::Shock
            | HazardKind::JointLoad
            | HazardKind::ChaoticWhirl
            | HazardKind::GuidePreload
            | HazardKind::PressureFolding
            | HazardKind::BitStuck,
        ) => true,
    };
    // Below the gate of whirl the drive counts as standing, and no alarm of the motion is judged.
    gates && speed > 0.0 && above(speed, settings.whirl.min_rotary_speed)
}

/// Time (s) for which an alarm remains at least after a look at which its condition counts as met. Only that of
/// stick-slip is long.
pub(super) fn least_hold(id: AlarmId, settings: &SimulationSettings) -> f64 {
    match hazard(id) {
        Some(HazardKind::StickSlip) => (settings.stick_slip.thresholds.hold_off - ENDED_AFTER).max(0.0),
        _ => 0.0,
    }
}

/// Sums of a figure.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    fn value(&self) -> f64 {
        self.sum / self.count
    }
}

/// Speeds of the bit between two looks (rad/s): joints and torsional waves ripple faster than ten looks a second can
/// show.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Speeds {
    least: f64,
    most: f64,
    mean: Mean,
}

impl Speeds {
    const NONE: Self = Self {
        least: f64::MAX,
        most: f64::MIN,
        mean: Mean { sum: 0.0, count: 0.0 },
    };

    fn add(&mut self, speed: f64) {
        (self.least, self.most) = (self.least.min(speed), self.most.max(speed));
        self.mean.add(speed);
    }
}

/// How long a station has whirled, by level, in turns of the tool: backward and forward.
type Turns = [[f64; 3]; 2];

/// The motion over the time in which every alarm must have ended.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    settings: SimulationSettings,
    /// Speed (r/min) and weight (kN) that are held.
    at: [f64; 2],
    /// Time between two looks (s).
    interval: f64,
    /// Whether the drive turned at all looks.
    turns: bool,
    /// Levels that the motion has reached, by [`HazardKind::ALL`].
    reached: [Severity; HazardKind::ALL.len()],
    /// Speeds of the bit since the last look, and of the looks of a window, the newest last.
    now: Speeds,
    bit: VecDeque<Speeds>,
    /// Per watched station.
    whirling: Vec<Turns>,
    /// Looks with their largest impulse over the span in which impulses are counted (N s).
    impulses: VecDeque<f64>,
    /// Energy that collisions took between looks, times the chaotic share (J), over a window.
    collisions: VecDeque<f64>,
    /// Energy that collisions have taken since the start (J), at the last look.
    taken: Option<f64>,
    /// Weights and torques at surface and bit.
    weight: [Mean; 2],
    torque: [Mean; 2],
}

impl Measured {
    /// Nothing yet, at a speed (r/min) and weight (kN) that are held, with looks `interval` (s) apart. A string of more
    /// than 4000 m has a longer window of stick-slip than its settings; its slower swing is seen in a part of it.
    pub(super) fn new(settings: SimulationSettings, at: [f64; 2], interval: f64) -> Self {
        Self {
            settings,
            at,
            interval,
            turns: true,
            reached: [Severity::Ok; HazardKind::ALL.len()],
            now: Speeds::NONE,
            bit: VecDeque::new(),
            whirling: Vec::new(),
            impulses: VecDeque::new(),
            collisions: VecDeque::new(),
            taken: None,
            weight: Default::default(),
            torque: Default::default(),
        }
    }

    /// Takes the speed of the bit (rad/s) after a step.
    pub(super) fn step(&mut self, bit_speed: f64) {
        self.now.add(bit_speed);
    }

    /// Forgets the steps before, which do not count.
    pub(super) fn skip(&mut self) {
        self.now = Speeds::NONE;
    }

    /// Looks at the motion after the steps since the last look.
    pub(super) fn look(&mut self, snapshot: &Snapshot) {
        // One look at standstill makes the silence of the alarms
        // meaningless: `is_judged` needs a drive that always turned.
        self.turns &= snapshot.hazards.drive == DriveState::Turning;
        // The kinds with gates in the analysis are formed here from the motion itself; the hazards of the snapshot
        // would be silent below the gate.
        let swing = self.swing(snapshot);
        self.reach(
            HazardKind::StickSlip,
            of_thresholds(&self.settings.stick_slip.thresholds, swing),
        );
        let [backward, forward] = self.whirl(snapshot);
        self.reach(HazardKind::BackwardWhirl, backward);
        self.reach(HazardKind::ForwardWhirl, forward);
        let shock = self.shock(snapshot);
        self.reach(HazardKind::Shock, shock);
        let power = self.collision_power(snapshot);
        self.reach(
            HazardKind::ChaoticWhirl,
            of_thresholds(&self.settings.chaotic_whirl.thresholds, power),
        );
        // The snapshot has the figures of these kinds also while they are not judged.
        let load = |settings: Option<&AlarmThresholds>, kind: HazardKind| {
            let hazard = snapshot.hazards.of(kind);
            // At a level the figure is that of its worst moment; before one it is that of now, judged or not.
            match (hazard.severity, settings) {
                (Severity::Ok, Some(thresholds)) => of_thresholds(thresholds, hazard.value),
                (severity, _) => severity,
            }
        };
        // A load that the configuration does not rate has no thresholds
        // and keeps the level of the snapshot, which is Ok.
        let SimulationSettings {
            joint_load,
            guide_preload,
            pressure_folding,
            ..
        } = &self.settings;
        let loads = [
            (HazardKind::JointLoad, Some(&joint_load.thresholds)),
            (
                HazardKind::GuidePreload,
                guide_preload.as_ref().map(|load| &load.thresholds),
            ),
            (
                HazardKind::PressureFolding,
                pressure_folding.as_ref().map(|load| &load.thresholds),
            ),
            (HazardKind::BitStuck, Some(&self.settings.transfer.stall)),
        ]
        .map(|(kind, thresholds)| (kind, load(thresholds, kind)));
        for (kind, severity) in loads {
            self.reach(kind, severity);
        }
        // Means over the half, because weight and torque at the bit swing with
        // each turn; whether transfer is judged depends on them.
        let transfer = &snapshot.transfer;
        for (means, along) in [
            (&mut self.weight, &transfer.weight),
            (&mut self.torque, &transfer.torque),
        ] {
            for (mean, place) in means.iter_mut().zip([SURFACE, BIT]) {
                mean.add(along.mean[place]);
            }
        }
    }

    fn reach(&mut self, kind: HazardKind, severity: Severity) {
        let reached = &mut self.reached[kind as usize];
        *reached = (*reached).max(severity);
    }

    /// Whether an alarm was judged all the time, so that its silence says something.
    pub(super) fn is_judged(&self, id: AlarmId) -> bool {
        let put_in = |weight: f64| weight >= self.settings.transfer.least_weight;
        let [top, bit] = self.weight.map(|mean| mean.value());
        self.turns
            && is_judged_at(id, self.at, &self.settings)
            && match hazard(id) {
                Some(HazardKind::WeightTransfer) => put_in(top),
                // Torque is the rock's answer to weight: without weight at the bit there is none to arrive.
                Some(HazardKind::TorqueTransfer) => put_in(top) && put_in(bit),
                _ => true,
            }
    }

    /// Whether the motion itself calls for an alarm, by the levels from which that alarm stands at this speed and
    /// weight.
    pub(super) fn calls(&self, id: AlarmId, config: &Config) -> bool {
        let Some(kind) = hazard(id) else { return false };
        let lost = |means: &[Mean; 2], thresholds: &AlarmThresholds| {
            let [top, bit] = means.map(|mean| mean.value());
            of_thresholds(thresholds, 1.0 - bit / top)
        };
        let severity = match kind {
            HazardKind::WeightTransfer => lost(&self.weight, &self.settings.transfer.weight),
            HazardKind::TorqueTransfer => lost(&self.torque, &self.settings.transfer.torque),
            _ => self.reached[kind as usize],
        };
        called_at(kind, severity, self.at, config).is_some()
    }

    /// The swing of the bit's speed about its mean, over a full window.
    fn swing(&mut self, snapshot: &Snapshot) -> f64 {
        let looks = looks(self.settings.stick_slip.window, self.interval);
        keep(&mut self.bit, std::mem::replace(&mut self.now, Speeds::NONE), looks);
        if self.bit.len() < looks {
            return 0.0;
        }
        let (mut least, mut most, mut mean) = (f64::MAX, f64::MIN, Mean::default());
        for speeds in &self.bit {
            (least, most) = (least.min(speeds.least), most.max(speeds.most));
            mean.add(speeds.mean.value());
        }
        let drive = snapshot.applied.rotary_speed;
        let mean = mean.value() * drive.signum();
        let slowest = (STUCK * drive.abs()).max(SLOWEST);
        let swing = (most - least) / (2.0 * mean.max(slowest));
        // A bit that stands does not swing, and is stuck.
        if mean < slowest { swing.max(1.0) } else { swing }
    }

    /// The levels of backward and of forward whirl: those that some station has had for long enough.
    fn whirl(&mut self, snapshot: &Snapshot) -> [Severity; 2] {
        let (report, settings) = (&snapshot.whirl, &self.settings.whirl);
        let speed = snapshot.applied.rotary_speed.abs();
        let turns = speed * self.interval / TAU;
        self.whirling.resize(report.kind.len(), Turns::default());
        let mut reached = [Severity::Ok; 2];
        for (entry, whirling) in self.whirling.iter_mut().enumerate() {
            let is_sure = report.confidence[entry] >= settings.min_confidence;
            let met = match report.kind[entry] {
                WhirlKind::Backward if is_sure => {
                    let own = match report.body[entry] {
                        Body::Pipe => 1.0,
                        Body::Guide => 0.0,
                    };
                    let cycles = (own - report.whirl_rate[entry] / speed.max(SLOWEST)).abs();
                    let rolls = report.rolling[entry];
                    [
                        settings.backward_cycles.map(|least| rolls || cycles >= least),
                        [false; 3],
                    ]
                }
                WhirlKind::Forward if is_sure => [[false; 3], forward(report.friction_power[entry], settings)],
                _ => [[false; 3]; 2],
            };
            for ((whirling, met), reached) in whirling.iter_mut().zip(met).zip(&mut reached) {
                let levels = whirling.iter_mut().zip(met).zip(settings.lasting_turns);
                for (((so_far, met), lasting), level) in levels.zip(Severity::RAISED) {
                    *so_far = if met {
                        (*so_far + turns).min(lasting)
                    } else {
                        (*so_far - turns).max(0.0)
                    };
                    if met && *so_far >= lasting {
                        *reached = (*reached).max(level);
                    }
                }
            }
        }
        reached
    }

    /// The level of the impulses of collisions, by their number in a span. Of those between two looks the largest
    /// counts, so that there may be more.
    fn shock(&mut self, snapshot: &Snapshot) -> Severity {
        let ShockSettings {
            thresholds,
            repeats,
            span,
            ..
        } = &self.settings.shock;
        let contacts = &snapshot.contacts;
        let all = contacts.pipe_guide.shock.iter().chain(&contacts.guide_wall.shock);
        let largest = all.copied().fold(0.0, f64::max);
        keep(&mut self.impulses, largest, looks(*span, self.interval));
        let levels = thresholds.levels.into_iter().zip(repeats).zip(Severity::RAISED);
        levels
            .filter(|((least, repeats), _)| {
                self.impulses.iter().filter(|impulse| *impulse >= least).count() >= **repeats as usize
            })
            .map(|(_, level)| level)
            .max()
            .unwrap_or_default()
    }

    /// The power that collisions take per metre of the tool, times the share of the pipe that moves chaotically (W/m).
    fn collision_power(&mut self, snapshot: &Snapshot) -> f64 {
        let report = &snapshot.whirl;
        let pipe = report
            .body
            .iter()
            .zip(&report.kind)
            .filter(|(body, _)| **body == Body::Pipe);
        let (all, chaotic) = pipe.fold((0.0, 0.0), |(all, chaotic), (_, kind)| {
            (all + 1.0, chaotic + f64::from(u8::from(*kind == WhirlKind::Chaotic)))
        });
        let taken = snapshot.energy.contact_damping;
        let since = taken - self.taken.replace(taken).unwrap_or(taken);
        let window = self.settings.chaotic_whirl.window;
        let share = if all > 0.0 { chaotic / all } else { 0.0 };
        keep(&mut self.collisions, since * share, looks(window, self.interval));
        let length = snapshot.contacts.measured_depth.last().copied().unwrap_or(f64::NAN);
        self.collisions.iter().sum::<f64>() / (window * length)
    }
}

fn forward(power: f64, settings: &WhirlSettings) -> [bool; 3] {
    let [watch, warning] = settings.forward_power.map(|least| power >= least);
    [watch, warning, false]
}

/// Looks in a window (s).
fn looks(window: f64, interval: f64) -> usize {
    ((window / interval).round() as usize).max(1)
}

/// Keeps the newest `most` values.
fn keep<T>(values: &mut VecDeque<T>, value: T, most: usize) {
    values.push_back(value);
    while values.len() > most {
        values.pop_front();
    }
}

/// The level that a value reaches; OK where it is no number.
fn of_thresholds(thresholds: &AlarmThresholds, value: f64) -> Severity {
    let levels = Severity::RAISED.into_iter().zip(thresholds.levels);
    levels
        .filter(|(_, least)| value >= *least)
        .map(|(level, _)| level)
        .max()
        .unwrap_or_default()
}

#[cfg(test)]
mod tests;
