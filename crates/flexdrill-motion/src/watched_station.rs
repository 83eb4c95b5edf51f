//! One watched station: its geometry, its samples, and its state between evaluations.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::classify::Verdict;
use super::orbit_window::OrbitWindow;
use super::settings::WhirlSettings;
use super::severity::{Elapsed, Evaluation, Evidence, StationSeverity};
use super::{Severity, WhirlKind};
use flexdrill_base::Body;

/// Weight with which time that does not appear chaotic reduces the chaotic time.
const CHAOS_FADES: f64 = 1.5;

/// A station and pipe whose orbit is watched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WatchedStation {
    /// Station index from the top.
    pub station: usize,
    /// Which pipe moves: the flexible pipe in the guide, or the guide in the hole.
    pub body: Body,
    /// Along the path from the kick-off (m).
    pub measured_depth: f64,
    /// From straight down (rad).
    pub inclination: f64,
    /// Half the difference of the diameters (m), Eq. 27 or 31.
    pub clearance: f64,
    /// Outer diameter of the moving body at its contact (m), for the rate of rolling without slip.
    pub body_diameter: f64,
    /// Length of the tool that the station represents (m): half of the distances to both neighbours.
    pub length: f64,
}

impl WatchedStation {
    /// Whirl rate over rotary speed of rolling without slip, `-d / (D - d)`. The guide is not driven, so its rate is
    /// not tied to the rotary speed.
    pub fn rolling_ratio(&self) -> Option<f64> {
        (self.body == Body::Pipe && self.clearance > 0.0).then(|| -self.body_diameter / (2.0 * self.clearance))
    }
}

/// One sample of one watched station.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StationSample {
    /// Horizontal displacement of the body from the gap's centre (m).
    pub y: f64,
    /// Displacement towards the low side (m).
    pub z: f64,
    /// Largest normal force since the last sample (N).
    pub normal_force: f64,
    /// Share of the time in contact since the last sample, 0 to 1; 0 or 1 where only the instant is known.
    pub contact_share: f64,
    /// Impulse of the normal force since the last sample (N s).
    pub impulse: f64,
    /// Work of the friction since the last sample (J, >= 0).
    pub friction_work: f64,
}

impl StationSample {
    /// The interpolation between this sample and `next` at `part`, 0 to 1.
    pub(super) fn between(&self, next: &Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * part;
        Self {
            y: mix(self.y, next.y),
            z: mix(self.z, next.z),
            normal_force: mix(self.normal_force, next.normal_force),
            contact_share: mix(self.contact_share, next.contact_share),
            impulse: mix(self.impulse, next.impulse),
            friction_work: mix(self.friction_work, next.friction_work),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct StationWatch {
    pub(super) station: WatchedStation,
    pub(super) window: OrbitWindow,
    pub(super) last: StationSample,
    pub(super) kind: WhirlKind,
    candidate: WhirlKind,
    agreeing: u32,
    /// Time for which the motion has appeared chaotic (s), minus weighted time for which it has not.
    chaotic_for: f64,
    pub(super) whirl_rate: f64,
    /// Over the rotary speed; none where the motion is no whirl of one rate or the tool stands.
    pub(super) whirl_ratio: Option<f64>,
    pub(super) orbit_radius: f64,
    /// Turns about the gap's centre per turn of the tool, in the sense of the rotation; none while it stands.
    pub(super) gap_turns: Option<f64>,
    pub(super) used_window: f64,
    pub(super) evidence: Evidence,
    /// Levels of backward and of forward whirl.
    backward: StationSeverity,
    forward: StationSeverity,
    /// Model time of the newest evaluation (s).
    pub(super) evaluated: f64,
}

/// Conditions of an evaluation, apart from the motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circumstances {
    /// Magnitude of the mean rotary speed over the window (rad/s); none while the tool stands.
    pub(super) rotary_speed: Option<f64>,
    /// +1 or -1, the sign of the rotation.
    pub(super) sense: f64,
    /// Time for which motion must appear chaotic to be classified so (s).
    pub(super) chaos_time: f64,
    /// Time between two evaluations (s).
    pub(super) evaluation_interval: f64,
}

impl StationWatch {
    /// Severity measure of whirl of this kind, for comparing stations; 0 where the motion is of another kind.
    pub(super) fn strength(&self, kind: WhirlKind) -> f64 {
        if self.kind != kind {
            return 0.0;
        }
        match kind {
            WhirlKind::Backward => self.evidence.cycles * self.orbit_radius / self.station.clearance,
            WhirlKind::Forward => self.evidence.friction_power,
            _ => 0.0,
        }
    }

    pub(super) fn new(station: WatchedStation, window: OrbitWindow) -> Self {
        Self {
            station,
            window,
            last: StationSample::default(),
            kind: WhirlKind::None,
            candidate: WhirlKind::None,
            agreeing: 0,
            chaotic_for: 0.0,
            whirl_rate: 0.0,
            whirl_ratio: None,
            orbit_radius: 0.0,
            gap_turns: None,
            used_window: 0.0,
            evidence: Evidence::default(),
            backward: StationSeverity::default(),
            forward: StationSeverity::default(),
            evaluated: 0.0,
        }
    }

    /// Resets the motion; the level stays.
    pub(super) fn restart(&mut self) {
        self.window.clear();
        self.kind = WhirlKind::None;
        self.candidate = WhirlKind::None;
        self.agreeing = 0;
        self.chaotic_for = 0.0;
        self.whirl_rate = 0.0;
        self.whirl_ratio = None;
        self.orbit_radius = 0.0;
        self.gap_turns = None;
        self.evidence = Evidence::default();
    }

    /// Resets motion and level.
    pub(super) fn reset(&mut self) {
        self.restart();
        (self.backward, self.forward) = Default::default();
        self.used_window = 0.0;
        self.evaluated = 0.0;
    }

    /// Adopts a verdict; its kind only after enough consecutive evaluations agree.
    pub(super) fn accept(
        &mut self,
        verdict: &Verdict,
        evidence: Evidence,
        circumstances: &Circumstances,
        settings: &WhirlSettings,
    ) {
        // Evaluations in a row: one that differs begins the count again.
        if verdict.kind == self.candidate {
            self.agreeing = self.agreeing.saturating_add(1);
        } else {
            self.candidate = verdict.kind;
            self.agreeing = 1;
        }
        let interval = circumstances.evaluation_interval;
        // A slow whirl needs longer to be confirmed: the time is counted in its turns.
        let confirmed_for = match verdict.kind {
            WhirlKind::None | WhirlKind::Chaotic => 0.0,
            WhirlKind::Forward | WhirlKind::Backward | WhirlKind::JointVibration => {
                settings.confirmation_turns * TAU / verdict.rate.abs()
            }
        };
        let needed = ((confirmed_for / interval).ceil() as u32).max(settings.confirmations);
        // Chaotic motion resembles another kind now and then by chance, so its time is accumulated, not counted in a
        // row.
        self.chaotic_for = if verdict.kind == WhirlKind::Chaotic {
            // Bounded above, so that a long chaotic motion is left in the same time as a short one.
            (self.chaotic_for + interval).min(circumstances.chaos_time)
        } else {
            (self.chaotic_for - CHAOS_FADES * interval).max(0.0)
        };
        let confirmed = match verdict.kind {
            WhirlKind::Chaotic => self.chaotic_for >= circumstances.chaos_time,
            _ => self.agreeing >= needed,
        };
        // Until then the kind before stands, which keeps a verdict from flickering.
        if confirmed {
            self.kind = verdict.kind;
        }
        // The rate belongs to the adopted kind. That of another verdict would give a whirl the rate of something else.
        if self.kind == verdict.kind {
            self.whirl_rate = verdict.rate * circumstances.sense;
        }
        // Without rotation there is no speed that the rate could be related to.
        self.whirl_ratio = match (self.kind, circumstances.rotary_speed) {
            (WhirlKind::Forward | WhirlKind::Backward, Some(speed)) => Some(self.whirl_rate / speed),
            _ => None,
        };
        self.orbit_radius = verdict.radius;
        self.used_window = verdict.window;
        // Half the confidence while the newest verdict differs from the adopted kind.
        let confidence = evidence.confidence * if self.kind == verdict.kind { 1.0 } else { 0.5 };
        self.evidence = Evidence {
            kind: self.kind,
            confidence,
            rolling: self.rolls(settings),
            cycles: self.cycles(),
            ..evidence
        };
    }

    /// Bending cycles per turn of the tool: the orbit's turns as the body sees them that is bent. The pipe turns with
    /// the tool, the guide does not.
    fn cycles(&self) -> f64 {
        let own = match self.station.body {
            Body::Pipe => 1.0,
            Body::Guide => 0.0,
        };
        self.whirl_ratio.map_or(0.0, |ratio| (own - ratio).abs())
    }

    /// Updates the levels with the newest evaluation, see [`StationSeverity::update`].
    pub(super) fn grade(&mut self, elapsed: Elapsed, trust: f64, settings: &WhirlSettings) {
        for kind in [WhirlKind::Backward, WhirlKind::Forward] {
            let evaluation = self.evaluation(kind);
            let level = match kind {
                WhirlKind::Backward => &mut self.backward,
                _ => &mut self.forward,
            };
            level.update(kind, elapsed, &evaluation, trust, settings);
        }
    }

    /// The newest evaluation, with its severity measure as whirl of this kind.
    pub(super) fn evaluation(&self, kind: WhirlKind) -> Evaluation {
        Evaluation {
            time: self.evaluated,
            evidence: self.evidence,
            whirl_ratio: self.whirl_ratio,
            rolling_share: self.rolling_share(),
            orbit_speed: self.orbit_radius * self.whirl_rate.abs(),
            window: self.used_window,
            strength: self.strength(kind),
        }
    }

    /// While a level of this kind of whirl stands, the worst evaluation since it was reached; otherwise the newest.
    pub(super) fn reported_evaluation(&self, kind: WhirlKind) -> Evaluation {
        match (kind, self.level_of(kind)) {
            (_, Severity::Ok) => self.evaluation(kind),
            (WhirlKind::Backward, _) => *self.backward.worst(),
            (_, _) => *self.forward.worst(),
        }
    }

    /// Model time at which the conditions of WATCH, WARNING and CRITICAL of this kind of whirl were met last (s).
    pub(super) fn met(&self, kind: WhirlKind) -> [f64; 3] {
        match kind {
            WhirlKind::Backward => self.backward.met(),
            _ => self.forward.met(),
        }
    }

    pub(super) fn level_of(&self, kind: WhirlKind) -> Severity {
        match kind {
            WhirlKind::Backward => self.backward.level(),
            WhirlKind::Forward => self.forward.level(),
            _ => Severity::Ok,
        }
    }

    /// Level of the station: the worse of both.
    pub(super) fn level(&self) -> Severity {
        self.backward.level().max(self.forward.level())
    }

    /// The kind of the level, also during the hold-off.
    pub(super) fn level_kind(&self) -> WhirlKind {
        match self.level() {
            Severity::Ok => WhirlKind::None,
            level if self.backward.level() == level => WhirlKind::Backward,
            _ => WhirlKind::Forward,
        }
    }

    /// Whirl rate over that of rolling without slip, for backward whirl of the driven pipe: 1 rolls, less slides, 0 is
    /// no such whirl. The sliding speed at the contact is spin x radius x (1 - this).
    pub(super) fn rolling_share(&self) -> f64 {
        match (self.kind, self.whirl_ratio, self.station.rolling_ratio()) {
            (WhirlKind::Backward, Some(ratio), Some(rolling)) => ratio / rolling,
            _ => 0.0,
        }
    }

    fn rolls(&self, settings: &WhirlSettings) -> bool {
        let wider = if self.evidence.rolling {
            1.0 + settings.hysteresis
        } else {
            1.0
        };
        let share = self.rolling_share();
        share > 0.0 && (share - 1.0).abs() <= settings.rolling_tolerance * wider
    }
}
