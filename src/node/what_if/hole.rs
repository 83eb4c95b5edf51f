//! Where the tool drills under the weights of a goal.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::ahead::Candidate;
use crate::drilling::SPACING;
use crate::drilling::live::{Ahead, Question, compute, refusal, seed};
use flexdrill_config::Config;
use flexdrill_core::units::kn_to_n;
use flexdrill_hole::Survey;
use flexdrill_messages::WhatIfAnswer;

/// The hole under a weight, or why it is not known.
pub(super) type Hole = Result<Ahead, String>;

/// The hole under the weight of each candidate, with the surveys that are known: one answer per weight, in the order of the
/// candidates. The same goal in the same configuration with the same surveys has the same answer, which is that of
/// `twin/hole_ahead` at that weight.
pub(super) fn holes(config: &Config, candidates: &[Candidate], surveys: &[Survey], stop: &AtomicBool) -> Vec<Hole> {
    let mut known: Vec<(f64, Hole)> = Vec::new();
    let mut of = |candidate: &Candidate| {
        let weight = candidate.weight_on_bit;
        if let Some((_, hole)) = known.iter().find(|(of, _)| *of == weight) {
            return hole.clone();
        }
        let hole = under(config, kn_to_n(weight), surveys, stop);
        known.push((weight, hole.clone()));
        hole
    };
    candidates.iter().map(&mut of).collect()
}

fn under(config: &Config, weight: f64, surveys: &[Survey], stop: &AtomicBool) -> Hole {
    if let Some(why) = refusal(config) {
        return Err(why);
    }
    if weight <= 0.0 {
        return Err("the bit is off bottom".to_owned());
    }
    let question = Question {
        weight,
        seed: seed(config),
        searches: false,
        surveys,
    };
    let hole = compute(config, question, stop);
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
    let end = plan.and_then(|plan| plan.stations.iter().enumerate().next_back());
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

    /// The paper's tool with a guide of 0.05 of a tube's stiffness, made with a radius of 3.2 m, after 70 degrees of its arc.
    const TOOL: &str = include_str!("../../../tests/data/hole_ahead.yaml");

    /// A plan that continues its hole with 3.9 m.
    const PLAN: &str = "  plan:
    stations:
      - {measured_depth: 0, inclination_deg: 0, azimuth_deg: 0}
      - {measured_depth: 1.117010, inclination_deg: 0, azimuth_deg: 0}
      - {measured_depth: 5.026548, inclination_deg: 70, azimuth_deg: 0}
      - {measured_depth: 11.026548, inclination_deg: 158.1474, azimuth_deg: 0}
  hole_diameter";

    fn config(change: [&str; 2]) -> Config {
        let [from, to] = change;
        let tool = TOOL.replace("  hole_diameter", PLAN);
        assert!(tool.contains(from), "{from}");
        Config::from_text("tool.yaml", &tool.replace(from, to)).unwrap()
    }

    /// Nothing is changed.
    const AS_IT_IS: [&str; 2] = ["links: 33", "links: 33"];

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
        let stopped = holes(&config(AS_IT_IS), &candidates, &[], &AtomicBool::new(true));
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
        let found = holes(&config(AS_IT_IS), &[candidate(0.0)], &[], &AtomicBool::new(false));
        assert!(found[0].as_ref().is_err_and(|why| why.contains("off bottom")));
    }

    /// By the closed form the radius is 3.23 m at 5 kN, 3.145 m at 10 kN and 3.08 m at 15 kN in a long arc, and whatever the bit
    /// 2.81 to 3.65 m at 10 kN.
    #[test]
    fn each_weight_has_its_radius_and_its_distance_to_the_plan() {
        let candidates = [5.0, 10.0, 15.0, 10.0].map(candidate);
        let found = holes(&config(AS_IT_IS), &candidates, &[], &AtomicBool::new(false));
        let answers: Vec<WhatIfAnswer> = found
            .iter()
            .map(|hole| with_hole(WhatIfAnswer::default(), hole))
            .collect();
        assert!(
            answers
                .iter()
                .all(|answer| answer.hole_known && answer.hole_because.is_empty()),
            "{answers:?}"
        );
        let [light, usual, heavy, again] = &answers[..] else {
            panic!()
        };
        assert!(
            light.hole_radius > usual.hole_radius && usual.hole_radius > heavy.hole_radius,
            "{answers:?}"
        );
        assert!((2.81..3.65).contains(&usual.hole_radius), "{usual:?}");
        assert!(
            (usual.hole_radius_low..usual.hole_radius_high).contains(&usual.hole_radius),
            "{usual:?}"
        );
        assert_eq!(usual, again, "the same weight");
        // Two circles with one tangent: the bit on that of 3.145 m is 0.68 m inside that of 3.9 m after 5 m. 1.3 % of the
        // curvature and the hole as found, with 3.2 m, are 0.006 1/m, 0.08 m after 5 m.
        assert_eq!(usual.hole_plan_ahead, 5.0);
        assert!((usual.hole_plan_distance - 0.68).abs() < 0.08, "{usual:?}");
        assert!(light.hole_plan_distance < usual.hole_plan_distance, "{answers:?}");
    }

    #[test]
    fn what_nothing_is_known_of_says_why() {
        let cases = [
            (
                ["free_curvature: 0.3125", "free_curvature: as_built"],
                "shape of the guide is not given",
            ),
            (
                [
                    "straight: {length: 1.117010}}, {arc: {radius: 3.2, build_angle_deg: 70",
                    "straight: {length: 3.909537}}, {arc: {radius: 3.2, build_angle_deg: 20",
                ],
                "arc above the bit is 1.12 m long",
            ),
        ];
        for (change, words) in cases {
            let found = holes(&config(change), &[candidate(10.0)], &[], &AtomicBool::new(false));
            let answer = with_hole(WhatIfAnswer::default(), &found[0]);
            assert!(
                !answer.hole_known && answer.hole_because.contains(words),
                "{}",
                answer.hole_because
            );
        }
    }
}
