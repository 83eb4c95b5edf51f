//! What a look-ahead is asked and answers, as messages of the action `~/what_if`.

use crate::ahead::{AlarmChance, Answer, Candidate, CandidateAnswer, Ends, Figure, Goal, Progress};
use flexdrill_messages::unique_identifier_msgs::UUID;
use flexdrill_messages::{
    FigureBand, WhatIfAnswer, WhatIfCandidate, WhatIfFeedback, WhatIfFeedbackMessage, WhatIfGoal,
};
use flexdrill_ros2::action::GoalId;
use flexdrill_text::{counted, six_digits};

/// The goal that a client asks.
pub(super) fn goal(asked: &WhatIfGoal) -> Goal {
    Goal {
        candidates: asked.candidates.iter().map(candidate).collect(),
        horizon: asked.horizon,
        members: asked.members,
        run_all: asked.run_all,
        ends: Ends::Horizon,
        seed: asked.seed,
    }
}

fn candidate(asked: &WhatIfCandidate) -> Candidate {
    Candidate {
        rotary_speed: asked.rotary_speed,
        weight_on_bit: asked.weight_on_bit,
        speed_ramp: asked.speed_ramp,
        weight_ramp: asked.weight_ramp,
    }
}

/// What is known so far.
pub(super) fn feedback(id: GoalId, progress: &Progress) -> WhatIfFeedbackMessage {
    WhatIfFeedbackMessage {
        goal_id: UUID { uuid: id },
        feedback: WhatIfFeedback {
            done: progress.done,
            remaining: progress.remaining,
            answers: progress.answer.candidates.iter().map(of_candidate).collect(),
        },
    }
}

/// What was found, per candidate in the order of the goal; `friction` has the candidates with a fifth less and more
/// friction.
pub(super) fn sentence(answer: &Answer, friction: &[&[CandidateAnswer]; 2], stopped_by: &str) -> String {
    let found = |of: &CandidateAnswer| match (of.any_alarm.of, of.any_alarm.seen) {
        (0, _) if of.failure.is_empty() => "no member ended".to_owned(),
        (0, _) => format!("unknown: {}", of.failure),
        (members, 0) => format!("no alarm in {}", runs(members, of)),
        (members, seen) => format!("alarms in {seen} of {}", runs(members, of)),
    };
    let each = answer.candidates.iter().enumerate().map(|(index, of)| {
        let (rpm, kn) = (of.candidate.rotary_speed, of.candidate.weight_on_bit);
        let [lower, higher] = friction.map(|rows| rows.get(index).filter(|row| row.any_alarm.of > 0).map(found));
        let rows = match (lower, higher) {
            (Some(lower), Some(higher)) => {
                format!(" (if friction is a fifth lower, {lower}; if it is a fifth higher, {higher})")
            }
            _ => String::new(),
        };
        format!(
            "{} r/min and {} kN: {}{rows}",
            six_digits(rpm),
            six_digits(kn),
            found(of)
        )
    });
    let each = each.collect::<Vec<_>>().join("; ");
    if answer.stopped {
        format!("{stopped_by}; until then: {each}")
    } else {
        each
    }
}

/// The answer with its rows of other friction, by their factors.
pub(super) fn with_friction<'a>(
    answer: WhatIfAnswer,
    rows: impl Iterator<Item = (&'a f64, &'a CandidateAnswer)>,
) -> WhatIfAnswer {
    let (factors, rows): (Vec<f64>, Vec<&CandidateAnswer>) = rows.unzip();
    let counts = |count: fn(&CandidateAnswer) -> u32| rows.iter().map(|row| count(row)).collect();
    WhatIfAnswer {
        friction_members: counts(|row| row.members),
        friction_failed: counts(|row| row.failed),
        friction_any_alarm: counts(|row| row.any_alarm.seen),
        friction_factors: factors,
        ..answer
    }
}

/// So many members of a candidate, in words.
fn runs(members: u32, of: &CandidateAnswer) -> String {
    match of.tools {
        0 => counted(members.into(), "look-ahead"),
        // One that failed has a tool too, of which nothing is known.
        tools if tools == of.members => match of.failed {
            0 => counted(members.into(), "plausible tool"),
            failed => format!("{} ({failed} more unknown)", counted(members.into(), "plausible tool")),
        },
        tools => format!(
            "{} of {}",
            counted(members.into(), "look-ahead"),
            counted(tools.into(), "plausible tool")
        ),
    }
}

/// The answer on a candidate.
// Taken apart by name: a new field of the candidate then does not compile until it has its place in the message.
pub(super) fn of_candidate(of: &CandidateAnswer) -> WhatIfAnswer {
    let Candidate {
        rotary_speed,
        weight_on_bit,
        speed_ramp,
        weight_ramp,
    } = of.candidate;
    // The members are counted by the quality of their worst moment; the
    // client decides whether an answer from poor ones is of use.
    let [good, degraded, poor] = of.quality;
    WhatIfAnswer {
        candidate: WhatIfCandidate {
            rotary_speed,
            weight_on_bit,
            speed_ramp,
            weight_ramp,
        },
        run_up: of.run_up,
        members: of.members,
        failed: of.failed,
        failure: of.failure.clone(),
        decided: of.decided,
        // The interval comes with the chance: ten members do not distinguish 0 from 10 %.
        any_alarm: of.any_alarm.probability,
        any_alarm_lower: of.any_alarm.interval[0],
        any_alarm_upper: of.any_alarm.interval[1],
        alarms: of.alarms.iter().map(AlarmChance::message).collect(),
        figures: Figure::ALL
            // Name and unit are in every band, so that a client can show figures that it does not know.
            .iter()
            .zip(&of.figures)
            .map(|(figure, band)| {
                let (name, unit) = figure.name_and_unit();
                let [p5, p50, p95] = band.quantiles;
                FigureBand {
                    name: name.to_owned(),
                    unit: unit.to_owned(),
                    p5,
                    p50,
                    p95,
                }
            })
            .collect(),
        quality_good: good,
        quality_degraded: degraded,
        quality_poor: poor,
        hole_known: false,
        hole_because: "the hole comes with the result".to_owned(),
        hole_radius: f64::NAN,
        hole_radius_low: f64::NAN,
        hole_radius_high: f64::NAN,
        hole_plan_distance: f64::NAN,
        hole_plan_ahead: f64::NAN,
        tools: of.tools,
        friction_factors: Vec::new(),
        friction_members: Vec::new(),
        friction_failed: Vec::new(),
        friction_any_alarm: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::{Band, Chance};

    fn of(members: u32, failed: u32, tools: u32, seen: u32) -> CandidateAnswer {
        let any_alarm = Chance::new(seen, members - failed);
        CandidateAnswer {
            candidate: Candidate {
                rotary_speed: 60.0,
                weight_on_bit: 12.0,
                speed_ramp: 0.0,
                weight_ramp: 0.0,
            },
            run_up: 1.0,
            model_time: 61.0,
            members,
            tools,
            failed,
            failure: String::new(),
            decided: true,
            alarms: Vec::new(),
            any_alarm,
            any_by_priority: [seen; 3],
            figures: [Band::of(std::iter::empty()); Figure::ALL.len()],
            quality: [members - failed, 0, 0],
        }
    }

    #[test]
    fn a_sentence_says_of_what_the_runs_are() {
        let said = |of: CandidateAnswer, rows: [&[CandidateAnswer]; 2]| {
            let answer = Answer {
                candidates: vec![of],
                stopped: false,
            };
            sentence(&answer, &rows, "cancelled")
        };
        let none: [&[CandidateAnswer]; 2] = [&[], &[]];
        for (of, words) in [
            (of(16, 0, 16, 3), "alarms in 3 of 16 plausible tools"),
            (of(16, 1, 16, 3), "alarms in 3 of 15 plausible tools (1 more unknown)"),
            (of(16, 0, 9, 0), "no alarm in 16 look-aheads of 9 plausible tools"),
            (of(6, 0, 0, 0), "no alarm in 6 look-aheads"),
        ] {
            assert_eq!(said(of, none), format!("60 r/min and 12 kN: {words}"));
        }
        let (lower, higher) = ([of(2, 0, 0, 0)], [of(2, 0, 0, 2)]);
        let words = said(of(6, 0, 0, 0), [&lower, &higher]);
        assert!(
            words.ends_with(
                "(if friction is a fifth lower, no alarm in 2 look-aheads; if it is a fifth higher, alarms in 2 of 2 \
                 look-aheads)"
            ),
            "{words}"
        );
        let row = with_friction(
            of_candidate(&of(6, 0, 0, 0)),
            [0.8, 1.2].iter().zip([&lower[0], &higher[0]]),
        );
        assert_eq!(
            (
                row.friction_factors,
                row.friction_members,
                row.friction_failed,
                row.friction_any_alarm
            ),
            (vec![0.8, 1.2], vec![2, 2], vec![0, 0], vec![0, 2])
        );
    }
}
