//! What a plan needs of the guide, and under which weight the bit comes nearest to it.
//!
//! Only the weight is varied: with the bit's axis held by the guide, the rotary speed acts on the hole through the weight that
//! arrives alone.

use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, n_to_kn};

use super::tool::Drilling;
use super::{Answer, Plan, Question, SPACING, drill};
use crate::drilling::weights::best;

pub use crate::drilling::weights::{Tried, allowed};

/// Weights that are tried over the whole range.
const COARSE: usize = 20;

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
    let distance = |weight: f64| {
        let drilling = Drilling::of(config, kn_to_n(weight), question.azimuth).ok()?;
        let mut track = drill(&drilling, last).ok()?;
        // What was measured under the present weight is taken to hold under others.
        if let Some(learnt) = &answer.learnt {
            track = learnt.corrected(&track);
        }
        Some(plan.distance(track.last()?).whole)
    };
    let tried = allowed(config, n_to_kn(question.weight));
    best(tried, COARSE, distance, |distance| *distance).map_or(Advice::Unknown, |(weight, distance)| Advice::Weight {
        weight,
        distance,
    })
}

/// The last station at which a plan is compared.
pub fn last_station(plan: &Plan) -> usize {
    (plan.ahead() / SPACING + 1e-9).floor() as usize
}
