//! What a plan needs of the guide, and under which weight the bit comes nearest to it.
//!
//! Only the weight is varied: with the bit's axis held by the guide, the rotary speed acts on the hole through the weight that
//! arrives alone.

use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, n_to_kn};

use super::tool::{Drilling, wear_flats};
use super::{Answer, Plan, Question, SPACING, drill};

/// Weights that are tried over the whole range, and around the best of them.
const COARSE: usize = 20;
const FINE: [f64; 6] = [-0.75, -0.5, -0.25, 0.25, 0.5, 0.75];

/// What can be done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Advice {
    /// The bit stays within the target radius.
    Nothing,
    /// No bit and no rock makes this guide drill the plan, even at the largest weight.
    ChangeGuide,
    /// Under this weight (kN) the bit is nearest to the plan at the end, at a distance (m).
    Weight {
        /// The weight (kN).
        weight: f64,
        /// Distance at the end (m).
        distance: f64,
    },
    /// No weight was found for which the hole is known.
    Unknown,
}

/// The weights that were tried (kN).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Smallest.
    pub low: f64,
    /// Largest.
    pub high: f64,
}

/// Part of the present weight by which advice may change it. The hole alone is looked at, and a weight far from the present
/// one is another drilling programme: it brings whirl, stick-slip or buckling that nothing here sees.
const MOST_CHANGE: f64 = 0.5;

/// The range of weights that may be advised from the present one (kN): within a half of it and the limits of the
/// inputs, and where the bit cuts.
pub fn allowed(config: &Config, now: f64) -> Tried {
    let weight = &config.inputs.weight_on_bit;
    let flats = n_to_kn(wear_flats(config));
    let high = weight.max_kn.min((1.0 + MOST_CHANGE) * now);
    // Near the force of the wear flats next to nothing cuts, and nothing there is known.
    let low = weight.min_kn.max((1.0 - MOST_CHANGE) * now).max(1.1 * flats);
    Tried {
        low: low.min(high),
        high,
    }
}

/// Whether the bounds of the guide exclude the curvature of a plan (1/m).
pub fn is_excluded(answer: &Answer, plan: &Plan) -> bool {
    let needed = plan.curvature();
    answer
        .bounds
        .is_some_and(|bounds| needed < bounds.low || needed > bounds.high)
}

/// Advice for a plan with a target radius (m).
pub fn advise(config: &Config, question: &Question, answer: &Answer, plan: &Plan, target: f64) -> Advice {
    if is_excluded(answer, plan) {
        return Advice::ChangeGuide;
    }
    let last = last_station(plan);
    if plan.keeps(&answer.nominal, last, target) {
        return Advice::Nothing;
    }
    let Tried { low, high } = allowed(config, n_to_kn(question.weight));
    let distance = |weight: f64| {
        let drilling = Drilling::of(config, kn_to_n(weight), question.azimuth).ok()?;
        let track = drill(&drilling, last).ok()?;
        Some(plan.distance(track.last()?).whole)
    };
    let step = (high - low) / (COARSE - 1) as f64;
    // A tenth of a kilonewton is what a driller can set.
    let rounded = |weight: f64| (10.0 * weight).round() / 10.0;
    let mut best: Option<(f64, f64)> = None;
    let mut consider = |weight: f64| {
        let weight = rounded(weight).clamp(low, high);
        if let Some(distance) = distance(weight)
            && best.is_none_or(|(_, least)| distance < least)
        {
            best = Some((weight, distance));
        }
        best
    };
    let mut around = None;
    for index in 0..COARSE {
        around = consider(low + index as f64 * step);
    }
    if let Some((middle, _)) = around {
        for share in FINE {
            consider(middle + share * step);
        }
    }
    best.map_or(Advice::Unknown, |(weight, distance)| Advice::Weight {
        weight,
        distance,
    })
}

/// The last station at which a plan is compared.
pub fn last_station(plan: &Plan) -> usize {
    (plan.ahead() / SPACING + 1e-9).floor() as usize
}
