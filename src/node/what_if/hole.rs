//! Where the tool drills under the weights of a goal.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::ahead::Candidate;
use crate::drilling::SPACING;
use crate::drilling::live::{Ahead, compute, refusal, seed};
use flexdrill_config::Config;
use flexdrill_core::units::kn_to_n;
use flexdrill_messages::WhatIfAnswer;

/// The hole under a weight, or why it is not known.
pub(super) type Hole = Result<Ahead, String>;

/// The hole under the weight of each candidate: one answer per weight, in the order of the candidates. The same goal in the same
/// configuration has the same answer, which is that of `twin/hole_ahead` at that weight.
pub(super) fn holes(config: &Config, candidates: &[Candidate], stop: &AtomicBool) -> Vec<Hole> {
    let mut known: Vec<(f64, Hole)> = Vec::new();
    let mut of = |candidate: &Candidate| {
        let weight = candidate.weight_on_bit;
        if let Some((_, hole)) = known.iter().find(|(of, _)| *of == weight) {
            return hole.clone();
        }
        let hole = under(config, kn_to_n(weight), stop);
        known.push((weight, hole.clone()));
        hole
    };
    candidates.iter().map(&mut of).collect()
}

fn under(config: &Config, weight: f64, stop: &AtomicBool) -> Hole {
    if let Some(why) = refusal(config) {
        return Err(why);
    }
    if weight <= 0.0 {
        return Err("the bit is off bottom".to_owned());
    }
    let hole = compute(config, weight, seed(config), false, stop);
    // What was cut short is not the hole's fault.
    if stop.load(Ordering::Relaxed) {
        return Err("cancelled".to_owned());
    }
    let ahead = hole?;
    match ahead.short_of() {
        Some(why) => Err(why),
        None => Ok(ahead),
    }
}

/// The answer on a candidate with the hole under its weight.
pub(super) fn with_hole(answer: WhatIfAnswer, hole: &Hole) -> WhatIfAnswer {
    let ahead = match hole {
        Ok(ahead) => ahead,
        Err(why) => {
            return WhatIfAnswer {
                hole_because: why.clone(),
                ..answer
            };
        }
    };
    let [radius, low, high] = ahead.radius();
    let plan = ahead.plan.as_ref().and_then(|plan| plan.as_ref().ok());
    let end = plan.and_then(|plan| plan.stations.iter().enumerate().last());
    WhatIfAnswer {
        hole_known: true,
        hole_because: String::new(),
        hole_radius: radius,
        hole_radius_low: low,
        hole_radius_high: high,
        hole_plan_distance: end.map_or(f64::NAN, |(_, at)| at.high.hypot(at.right)),
        hole_plan_ahead: end.map_or(f64::NAN, |(station, _)| station as f64 * SPACING),
        ..answer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(weight_kn: &str) -> Config {
        let text = include_str!("../../../tests/data/ahead.yaml");
        Config::from_text("tool.yaml", &format!("{text}{weight_kn}")).unwrap()
    }

    fn candidate(weight_on_bit: f64) -> Candidate {
        Candidate {
            rotary_speed: 60.0,
            weight_on_bit,
            speed_ramp: 0.0,
            weight_ramp: 0.0,
        }
    }

    #[test]
    fn a_goal_that_is_cancelled_has_no_hole() {
        let candidates = [10.0, 12.0, 10.0].map(candidate);
        let stopped = holes(&config(""), &candidates, &AtomicBool::new(true));
        assert_eq!(stopped.len(), 3);
        assert!(
            stopped
                .iter()
                .all(|hole| hole.as_ref().is_err_and(|why| why == "cancelled"))
        );
        let answer = with_hole(WhatIfAnswer::default(), &stopped[0]);
        assert!(!answer.hole_known && answer.hole_because == "cancelled");
    }

    #[test]
    fn off_bottom_the_hole_is_not_known() {
        let found = holes(&config(""), &[candidate(0.0)], &AtomicBool::new(false));
        assert!(found[0].as_ref().is_err_and(|why| why.contains("off bottom")));
    }
}
