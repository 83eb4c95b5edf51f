//! Orbits with known answers: the motion of a pipe in its gap as formulas, with noise, and what it should be called.

mod labelled;

use std::f64::consts::TAU;

use flexdrill_base::Body;
use flexdrill_motion::{StationSample, WatchedStation, WhirlAnalysis, WhirlKind, WhirlReport, WhirlSettings};

pub use labelled::Labelled;

use crate::random::Random;

/// m: that of the default configuration's pipe in its guide.
pub const CLEARANCE: f64 = 8.5e-3;

/// s.
pub const SAMPLE_INTERVAL: f64 = 4e-3;

/// One rotating or standing line of the motion: an ellipse traced at a signed rate.
#[derive(Debug, Clone, Copy)]
pub struct Ellipse {
    /// Semi-axes (m).
    pub major: f64,
    pub minor: f64,
    /// Angle of the major axis (rad).
    pub tilt: f64,
    /// rad/s, positive from y towards z.
    pub rate: f64,
    /// rad.
    pub phase: f64,
}

impl Ellipse {
    pub fn at(&self, time: f64) -> [f64; 2] {
        let (sin, cos) = (self.rate * time + self.phase).sin_cos();
        let (tilt_sin, tilt_cos) = self.tilt.sin_cos();
        let (along, across) = (self.major * cos, self.minor * sin);
        [
            tilt_cos * along - tilt_sin * across,
            tilt_sin * along + tilt_cos * across,
        ]
    }

    /// Mean square distance from the centre (m2).
    pub fn power(&self) -> f64 {
        0.5 * (self.major * self.major + self.minor * self.minor)
    }
}

/// An analysis of one station, fed sample by sample.
pub struct Bench {
    pub analysis: WhirlAnalysis,
    pub report: WhirlReport,
    pub time: f64,
    step: u64,
    friction_power: f64,
}

/// m of tool that the watched station stands for.
const LENGTH: f64 = 0.0305;

impl Bench {
    pub fn new() -> Self {
        Self::with(&WhirlSettings::default())
    }

    pub fn with(settings: &WhirlSettings) -> Self {
        let watched = WatchedStation {
            station: 5,
            body: Body::Pipe,
            measured_depth: 0.76,
            inclination: 0.237,
            clearance: CLEARANCE,
            body_diameter: 63e-3,
            length: LENGTH,
        };
        let mut bench = Self {
            analysis: WhirlAnalysis::new(settings, SAMPLE_INTERVAL, vec![watched]),
            report: WhirlReport::default(),
            time: 0.0,
            step: 0,
            friction_power: 0.0,
        };
        bench.analysis.report(&mut bench.report);
        bench
    }

    /// Pushes one sample at the next instant and returns the kind that stands.
    pub fn push(&mut self, rotary_speed: f64, [y, z]: [f64; 2], normal_force: f64) -> WhirlKind {
        self.step += 1;
        self.time = self.step as f64 * SAMPLE_INTERVAL;
        let contact_share = if normal_force > 0.0 { 1.0 } else { 0.0 };
        let sample = StationSample {
            y,
            z,
            normal_force,
            contact_share,
            impulse: normal_force * SAMPLE_INTERVAL,
            friction_work: self.friction_power * LENGTH * SAMPLE_INTERVAL,
        };
        self.analysis.push(self.time, rotary_speed, &[sample]);
        self.analysis.report(&mut self.report);
        self.kind()
    }

    /// From the next sample on the friction takes that power per metre (W/m).
    pub fn rub(&mut self, friction_power: f64) {
        self.friction_power = friction_power;
    }

    /// Lets time pass without samples.
    pub fn skip(&mut self, seconds: f64) {
        self.step += (seconds / SAMPLE_INTERVAL).round() as u64;
    }

    /// Pushes `motion(time since now)` for `seconds`.
    pub fn run(&mut self, rotary_speed: f64, seconds: f64, mut motion: impl FnMut(f64) -> [f64; 2]) -> WhirlKind {
        for step in 0..(seconds / SAMPLE_INTERVAL) as usize {
            self.push(rotary_speed, motion(step as f64 * SAMPLE_INTERVAL), 0.0);
        }
        self.kind()
    }

    pub fn kind(&self) -> WhirlKind {
        self.report.kind[0]
    }

    pub fn ratio(&self) -> f64 {
        self.report.whirl_ratio[0]
    }
}

/// A circle with a random phase.
pub fn circle(radius: f64, rate: f64, random: &mut Random) -> Ellipse {
    Ellipse {
        major: radius,
        minor: radius,
        tilt: random.within(0.0, TAU),
        rate,
        phase: random.within(0.0, TAU),
    }
}
