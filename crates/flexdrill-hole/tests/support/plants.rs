//! Wells that other laws drill than the one that is judged: no statics, first-order lags in depth, and hidden numbers that
//! drift.
//!
//! Angles are counted from an arc of the guide's nominal curvature, and from 1.5 rad: 20 m of a radius of 3.2 m turn more than
//! once, and a survey has an inclination of 0 to 180 deg. The filter is linear in the angle, so that this changes nothing.

use fastrand::Rng;

use crate::support::{ARC, SOFT, TUBE, guide};

/// Step of the wells (m).
const STEP: f64 = 0.05;
/// Length of the wells (m).
pub const LENGTH: f64 = 20.0;
/// Angle where a well begins (rad).
pub const BEGIN: f64 = 1.5;

/// The law of a well.
#[derive(Debug, Clone, Copy)]
pub enum Plant {
    /// Two lags, 0.3 and 0.7 m, from the nominal arc on.
    TwoLags,
    /// One lag of 1.2 m, from an arc that is 15 % too straight on, with a side force of 500 N below which nothing is cut.
    DeadZone,
}

/// A standard normal number.
pub fn normal(rng: &mut Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.f64()).cos()
}

/// A number that wanders about 0 with a standard deviation of 1 and a length of correlation of 2 m.
struct Wandering(f64);

impl Wandering {
    fn new(rng: &mut Rng) -> Self {
        Self(normal(rng))
    }

    fn next(&mut self, rng: &mut Rng) -> f64 {
        let kept = (-STEP / 2.0_f64).exp();
        self.0 = kept * self.0 + (1.0 - kept * kept).sqrt() * normal(rng);
        self.0
    }
}

/// Angles of a well every [`STEP`].
pub struct Well(Vec<f64>);

impl Well {
    /// Drills a well.
    pub fn drill(plant: Plant, rng: &mut Rng) -> Self {
        let free = ARC * (1.0 + 0.03 * normal(rng));
        let stiffness = TUBE * SOFT * (0.25 * normal(rng)).exp();
        let log_eta = 20.0_f64.ln() + 0.9 * normal(rng);
        let wider = 1.5e-3 * rng.f64();
        let (flats, growth) = (4e3 * rng.f64(), 150.0 * rng.f64());
        let dip = 0.004 * normal(rng);
        let [mut eta_drift, mut gap_drift, mut weight_drift] = std::array::from_fn(|_| Wandering::new(rng));
        let mut at = match plant {
            Plant::TwoLags => [ARC; 2],
            Plant::DeadZone => [0.85 * ARC; 2],
        };
        let mut angle = BEGIN;
        let mut angles = vec![angle];
        for index in 0..(LENGTH / STEP) as usize {
            let depth = index as f64 * STEP;
            let weight = 10e3 * (1.0 + 0.12 * weight_drift.next(rng)).max(0.3);
            // Some of the weight cuts in any case, or nothing would be drilled.
            let active = (weight - flats - growth * depth).max(500.0);
            let resistance = (log_eta + 0.4 * eta_drift.next(rng)).exp() * active;
            let gap = (guide(SOFT).gap + wider + 0.8e-3 * gap_drift.next(rng)).max(4e-3);
            let load = weight * at[1] + guide(SOFT).weight_per_metre;
            let x = resistance / (1.2247 * (stiffness * load / gap).sqrt());
            let mut target = free + (2.0 * load * gap / stiffness).sqrt() * (x - 1.0) / (x + 1.0);
            match plant {
                Plant::TwoLags => {
                    at[0] += STEP / 0.3 * (target - at[0]);
                    at[1] += STEP / 0.7 * (at[0] - at[1]);
                }
                Plant::DeadZone => {
                    target += (1.9 * 500.0 / resistance).min(0.02);
                    at[1] += STEP / 1.2 * (target - at[1]);
                }
            }
            let true_angle = angle - BEGIN + ARC * depth;
            let curvature = at[1] + dip * (2.0 * true_angle - 1.0).cos();
            angle += STEP * (curvature - ARC) + 2e-3 * STEP.sqrt() * normal(rng);
            angles.push(angle);
        }
        Self(angles)
    }

    /// Angle at a depth (m), a whole number of steps.
    pub fn angle(&self, depth: f64) -> f64 {
        self.0[(depth / STEP).round() as usize]
    }
}
