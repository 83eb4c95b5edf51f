//! What a look-ahead is asked and answers, as messages of the action `~/what_if`.

use crate::ahead::{AlarmChance as Seen, Answer, Candidate, CandidateAnswer, Ends, Figure, Goal, Progress};
use crate::alarms::priority_code;
use flexdrill_messages::unique_identifier_msgs::UUID;
use flexdrill_messages::{
    AlarmChance, FigureBand, WhatIfAnswer, WhatIfCandidate, WhatIfFeedback, WhatIfFeedbackMessage, WhatIfGoal,
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

/// What was found, per candidate in the order of the goal.
pub(super) fn sentence(answer: &Answer, stopped_by: &str) -> String {
    let each = answer.candidates.iter().map(|of| {
        let (rpm, kn) = (of.candidate.rotary_speed, of.candidate.weight_on_bit);
        let found = match (of.any_alarm.of, of.any_alarm.seen) {
            (0, _) if of.failure.is_empty() => "no member ended".to_owned(),
            (0, _) => format!("unknown: {}", of.failure),
            (members, 0) => format!("no alarm in {}", counted(members.into(), "look-ahead")),
            (members, seen) => format!("alarms in {seen} of {}", counted(members.into(), "look-ahead")),
        };
        format!("{} r/min and {} kN: {found}", six_digits(rpm), six_digits(kn))
    });
    let each = each.collect::<Vec<_>>().join("; ");
    if answer.stopped {
        format!("{stopped_by}; until then: {each}")
    } else {
        each
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
        alarms: of.alarms.iter().map(of_alarm).collect(),
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
    }
}

/// How likely an alarm is.
pub(super) fn of_alarm(of: &Seen) -> AlarmChance {
    AlarmChance {
        id: of.id.id().to_owned(),
        name: of.id.name().to_owned(),
        priority: priority_code(Some(of.priority)),
        seen: of.chance.seen,
        members: of.chance.of,
        probability: of.chance.probability,
        lower: of.chance.interval[0],
        upper: of.chance.interval[1],
        time_to_first: of.first,
    }
}
