//! The alarm "hole leaves its plan": the plan is outside the range in which plausible tools drill.
//!
//! `twin/hole_ahead` has all that is judged here, so that a recording says why the alarm stood.

use super::advice::Unknown;
use super::catalogue::AlarmId;
use super::finding::Finding;
use super::sentence::number;
use crate::messages::HoleAhead;
use flexdrill_alarms::{Priority, Time};
use flexdrill_core::units::{n_to_kn, rad_to_deg};
use flexdrill_drilling::to_plan::BACK;

/// Time without a known hole for which a standing alarm remains (ns): after a change of the weight the next answer takes 10 s.
pub(super) const OUTLASTS: Time = 15_000_000_000;
/// That above which a hole leaves its plan, and above which a standing alarm remains.
const LEAVES: [f64; 2] = [1.0, BACK];
/// Metres ahead at which the words compare.
const NAMED: f64 = 3.0;
/// Curvature (1/m) below which a hole counts as straight: 0.06 deg/m.
const STRAIGHT: f64 = 1e-3;

/// A radius of a build rate (rad/m) in words.
fn radius(build: f64) -> Option<String> {
    if build.abs() < STRAIGHT {
        return Some("a straight hole".to_owned());
    }
    let radius = number(1.0 / build.abs(), 2)?;
    let sense = if build < 0.0 { "a drop with " } else { "" };
    Some(format!("{sense}a radius of {radius} m"))
}

/// A weight (N) in words.
fn kilonewton(weight: f64) -> Option<String> {
    Some(format!("{} kN", number(n_to_kn(weight), 1)?))
}

/// The station at most so many metres ahead that the plan reaches, with its distance (m).
fn station(hole: &HoleAhead, metres: f64) -> Option<(usize, f64)> {
    let bit = hole.measured_depths.first()?;
    let depths = hole.measured_depths.iter().enumerate();
    // Depths are quarters of a metre from the bit, up to rounding.
    let mut near = depths.filter(|(index, depth)| {
        **depth - bit < metres + 0.01 && hole.plan_inclination.get(*index).is_some_and(|off| off.is_finite())
    });
    near.next_back().map(|(index, depth)| (index, depth - bit))
}

/// What the hole does, and what the plan needs.
fn evidence(hole: &HoleAhead) -> String {
    let drills = radius(hole.build_rate).map_or(String::new(), |radius| {
        format!(": it drills {radius} over the next metre")
    });
    let needs = radius(hole.plan_build_rate).map_or(String::new(), |radius| format!(", the plan needs {radius}"));
    let behind = station(hole, NAMED).and_then(|(index, metres)| {
        let off = rad_to_deg(*hole.plan_inclination.get(index)?);
        let side = if off < 0.0 { "behind" } else { "ahead of" };
        Some(format!(
            "; {} deg {side} the plan after {} m",
            number(off.abs(), 1)?,
            number(metres, if metres.fract() == 0.0 { 0 } else { 2 })?
        ))
    });
    format!("The hole leaves its plan{drills}{needs}{}.", behind.unwrap_or_default())
}

/// Where the bit will be, and whether a weight helps.
fn consequence(hole: &HoleAhead) -> String {
    let at_the_end = station(hole, f64::INFINITY).and_then(|(index, metres)| {
        let (high, right) = (*hole.plan_high.get(index)?, *hole.plan_right.get(index)?);
        let across = if right.abs() < 0.01 {
            String::new()
        } else {
            let side = if right < 0.0 { "left" } else { "right" };
            format!(" and {} m to the {side} of it", number(right.abs(), 2)?)
        };
        Some(format!(
            "After {} m the bit is {} m {} the plan{across}; {} % of the plausible tools stay within {} m of it.",
            number(metres, 1)?,
            number(high.abs(), 2)?,
            if high < 0.0 { "below" } else { "above" },
            number(100.0 * hole.plan_within.get(index)?, 0)?,
            number(hole.plan_target, 2)?
        ))
    });
    let remedy = match kilonewton(hole.plan_weight) {
        Some(weight) => format!("{weight} at the bit would bring it back."),
        None if hole.plan_no_guide => "No weight does: this guide cannot drill the plan.".to_owned(),
        None => "No weight that may be set now brings it back.".to_owned(),
    };
    format!("{} {remedy}", at_the_end.unwrap_or_default()).trim().to_owned()
}

fn what_to_do(hole: &HoleAhead, lead: Option<AlarmId>, unknown: Unknown) -> String {
    // Another weight may be what ends or what raises the alarm that leads.
    if let Some(lead) = lead {
        return format!("First do what the alarm \"{}\" asks for.", lead.name());
    }
    if unknown.any() {
        return "The rig's speed and weight on bit are unknown to the twin: change nothing for the hole until they return."
            .to_owned();
    }
    if hole.plan_no_guide {
        return "This guide cannot drill the plan at any weight. Drill no further on this plan, and call the engineer: change \
                the guide."
            .to_owned();
    }
    let now = kilonewton(hole.weight_on_bit).map_or(String::new(), |now| format!(" ({now} now)"));
    if let Some(weight) = kilonewton(hole.plan_weight) {
        let verb = if hole.plan_weight > hole.weight_on_bit {
            "Raise"
        } else {
            "Lower"
        };
        return format!(
            "{verb} the weight at the bit to {weight}{now} and keep the rotary speed. Set the present weight again if another \
             alarm comes."
        );
    }
    let range = kilonewton(hole.plan_weight_low).zip(kilonewton(hole.plan_weight_high));
    let none = range.map_or_else(
        || "No weight brings the hole back.".to_owned(),
        |(low, high)| format!("No weight from {low} to {high} brings the hole back{now}."),
    );
    let nearest = kilonewton(hole.plan_nearest_weight)
        .map_or(String::new(), |weight| format!(" {weight} at the bit comes nearest."));
    format!("{none}{nearest} Call the engineer: change the guide or the bit.")
}

/// The finding on where the tool drills; none while that is not known or not compared with a plan. `stands` says whether the
/// alarm stands already, `lead` which alarm of the motion leads.
pub(super) fn finding(hole: &HoleAhead, stands: bool, lead: Option<AlarmId>, unknown: Unknown) -> Option<Finding> {
    // What is not known is not on plan either: the caller decides how long a standing alarm outlasts it.
    if !hole.known || !hole.plan_off.is_finite() {
        return None;
    }
    // A range that wavers with the weight must not toggle the alarm.
    let limit = LEAVES[usize::from(stands)];
    if hole.plan_off <= limit {
        return Some(Finding::default());
    }
    let helps = hole.plan_weight.is_finite();
    let builds = if hole.plan_build_rate > hole.build_rate {
        "less"
    } else {
        "more"
    };
    Some(Finding {
        // What no weight corrects becomes worse with every metre until the tool is changed.
        priority: Some(if helps { Priority::Low } else { Priority::Medium }),
        value: hole.plan_off,
        threshold: limit,
        unit: "half widths of the range",
        evidence: evidence(hole),
        cause: if hole.plan_no_guide {
            "The radius of the plan is outside what this guide drills with any bit, in any rock, at any allowed weight."
                .to_owned()
        } else {
            format!("At the present weight this guide and this bit build {builds} than the plan.")
        },
        consequence: consequence(hole),
        what_to_do: what_to_do(hole, lead, unknown),
        follows: lead,
        what_the_engineer_can_do: "Compare the plan with flexdrill ahead, which also says what other weights drill. Measure \
                                   the inclination at two points 1.5 m apart in the hole that this guide has drilled. Check \
                                   tool.guide.free_curvature on a template, and tool.bit.lateral_resistance. If the guide is \
                                   right, lay the plan from the present hole on."
            .to_owned(),
        ..Finding::default()
    })
}
