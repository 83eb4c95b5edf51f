//! The results in words, a sentence each.

use flexdrill_config::{Config, FreeBend};
use flexdrill_core::units::{n_to_kn, rad_to_deg};
use flexdrill_hole::PlaneModel;
use flexdrill_text::{counted, fixed};

use super::advice::{Tried, allowed, last_station};
use super::learnt::{Learnt, NINETY};
use super::tool::wear_flats;
use super::{Advice, Answer, Band, Plan, Question, SPACING, Track, build};
use crate::drilling::words::{STRAIGHT, any_bit, in_a_long_arc, needed, radii, radius};

/// Metres ahead that the words name.
const NAMED: [f64; 3] = [1.0, 3.0, 5.0];
/// Sine of the inclination below which an azimuth says nothing: 6 deg from the vertical.
const STEEP: f64 = 0.1;
/// Difference of the inclination at the bit from the configured one (deg) from which on the configuration is wrong: a hole
/// that is 3 deg off over 2 m has another curvature by 8 % of a 3.2 m arc's.
const FAR_OFF: f64 = 3.0;
/// Most causes of unknown members that are named.
const CAUSES: usize = 3;

/// A plan with what is asked of it.
#[derive(Debug, Clone, Copy)]
pub struct Goal<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Distance from it that counts as on plan (m).
    pub target: f64,
    /// What can be done.
    pub advice: Advice,
}

/// Stations at the named metres, within what was computed.
fn named(stations: usize) -> Vec<usize> {
    let mut named: Vec<usize> = NAMED.iter().map(|metres| (metres / SPACING) as usize).collect();
    named.push(stations);
    named.retain(|station| (1..=stations).contains(station));
    named.sort_unstable();
    named.dedup();
    named
}

/// "1", "2.25".
fn metres(station: usize) -> String {
    format!("{}", station as f64 * SPACING)
}

/// A build rate (rad/m) over a length in words: "builds 17.3 deg/m, a radius of 3.31 m".
fn rate(build: f64) -> String {
    let degrees = rad_to_deg(build.abs());
    match build {
        build if build.abs() < STRAIGHT => "remains straight".to_owned(),
        build if build > 0.0 => format!("builds {degrees:.1} deg/m, a radius of {}", radius(build)),
        _ => format!("drops {degrees:.1} deg/m"),
    }
}

/// The sentences.
pub fn words(config: &Config, question: &Question, answer: &Answer, goal: Option<&Goal<'_>>) -> Vec<String> {
    let mut lines = vec![beginning(question, answer)];
    lines.extend(answer.learnt.as_ref().map_or_else(Vec::new, surveyed));
    lines.push(first_metre(answer));
    lines.extend(ahead(answer));
    // The closed form knows no survey: next to a corrected forecast its radius would seem to contradict.
    let corrected = answer.learnt.as_ref().is_some_and(Learnt::corrects_curvature);
    let uncorrected = if corrected { ", without the correction" } else { "" };
    lines.push(in_a_long_arc(answer.long.as_ref(), uncorrected));
    lines.push(any_bit(answer.bounds.as_ref(), question.largest_weight));
    if let Some(goal) = goal {
        lines.extend(to_plan(config, question, answer, goal));
    }
    lines.extend(notes(config, answer));
    lines.extend(unknown(answer));
    lines
}

fn beginning(question: &Question, answer: &Answer) -> String {
    let known = answer.members.iter().flatten().count();
    let tools = if known == answer.members.len() {
        counted(known as u64, "plausible tool")
    } else {
        format!("{known} known of {} plausible tools", answer.members.len())
    };
    let measured = answer.learnt.as_ref().filter(|learnt| learnt.corrects_curvature());
    let ranges = if let Some(learnt) = measured {
        format!(
            "in brackets 90 % by {}",
            counted(learnt.used().count() as u64, "survey")
        )
    } else if known < Band::LEAST {
        format!("no ranges, which need {} plausible tools: {tools}", Band::LEAST)
    } else {
        format!("in brackets 90 % of {tools}")
    };
    format!(
        "At {:.2} kN on the bit, from a measured depth of {:.2} m, inclination {:.1} deg; {ranges}:",
        n_to_kn(question.weight),
        answer.depth,
        answer.nominal.first().map_or(f64::NAN, |at| rad_to_deg(at.inclination))
    )
}

/// What surveys correct.
fn surveyed(learnt: &Learnt) -> Vec<String> {
    let used = learnt.used().count();
    let above = learnt.surveys.len() - used;
    let mut lines = Vec::new();
    let at = learnt.filter.at_bit();
    // The direction first: each survey of this hole corrects it. The curvature has a line only where one was measured.
    if used > 0 {
        let depths: Vec<f64> = learnt.used().map(|survey| survey.depth).collect();
        let depths = match depths[..] {
            [one] => format!("at {one:.2} m"),
            _ => format!("from {:.2} to {:.2} m", depths[0], depths[used - 1]),
        };
        lines.push(format!(
            "{} {depths}, in the hole drilled since {:.2} m: inclination at the bit {:.1} deg (+- {:.1}), as configured {:.1} \
             deg.",
            counted(used as u64, "survey"),
            learnt.since,
            rad_to_deg(at.build.angle),
            rad_to_deg(NINETY * at.build.angle_deviation()),
            rad_to_deg(learnt.configured)
        ));
        lines.push(if learnt.corrects_curvature() {
            let more = rad_to_deg(at.build.correction);
            format!(
                "The tool builds {:.1} deg/m (+- {:.1}) {} than as configured; the forecast has this correction.",
                more.abs(),
                rad_to_deg(NINETY * at.build.correction_deviation()),
                if more < 0.0 { "less" } else { "more" }
            )
        } else {
            format!(
                "They correct the direction at the bit alone: a curvature needs a survey {} m or more below the start of the \
                 run.",
                PlaneModel::BUILD.settling
            )
        });
    }
    // Surveys that count for nothing are named, so that the reader does not take them for used.
    if above > 0 {
        lines.push(format!(
            "{} above {:.2} m, in the hole of another tool: not used.",
            counted(above as u64, "survey"),
            learnt.since
        ));
    }
    // Far off, the guide lies in another hole than the statics have: the forecast is that of a wrong hole.
    let away = rad_to_deg(at.build.angle - learnt.configured);
    if away.abs() > FAR_OFF {
        lines.push(format!(
            "The hole at the bit is {:.1} deg {} than well.sections has it: correct well.sections, because the guide is taken \
             to lie in that hole.",
            away.abs(),
            if away < 0.0 { "steeper" } else { "flatter" }
        ));
    }
    lines
}

/// Curvature of the first metre with its range.
fn first_metre(answer: &Answer) -> String {
    let stations = ((1.0 / SPACING) as usize).min(answer.nominal.len() - 1);
    let nominal = build(&answer.nominal, stations);
    let known = answer.members.iter().flatten();
    let band = Band::of(known.map(|track: &Track| build(track, stations)).collect());
    let range = band.map_or_else(String::new, |band| {
        let [low, high] = [band.low, band.high].map(rad_to_deg);
        format!(" ({low:.1} to {high:.1} deg/m, {})", radii(band.low, band.high))
    });
    let length = stations as f64 * SPACING;
    let of = if stations as f64 * SPACING == 1.0 {
        "metre".to_owned()
    } else {
        format!("{length} m")
    };
    format!("Over the next {of} the hole {}{range}.", rate(nominal))
}

/// Inclination and azimuth at the named metres.
fn ahead(answer: &Answer) -> Vec<String> {
    let line = |station: usize| {
        let at = answer.nominal.get(station)?;
        let Some(spread) = answer.spread.get(station) else {
            return Some(format!(
                "After {} m: inclination {:.1} deg, azimuth {} deg.",
                metres(station),
                rad_to_deg(at.inclination),
                fixed(rad_to_deg(at.azimuth), 1)
            ));
        };
        let angle = |value: f64, band: Band| {
            let [value, low, high] = [value, band.low, band.high].map(|angle| fixed(rad_to_deg(angle), 1));
            format!("{value} deg ({low} to {high})")
        };
        // Near the vertical a millimetre turns the azimuth by degrees.
        let azimuth = if libm::sin(at.inclination) < STEEP {
            "azimuth undefined near the vertical".to_owned()
        } else {
            format!("azimuth {}", angle(at.azimuth, spread.azimuth))
        };
        Some(format!(
            "After {} m: inclination {}, {azimuth}; 90 % are within {:.2} m up or down and {:.2} m sideways of the middle.",
            metres(station),
            angle(at.inclination, spread.inclination),
            spread.high.half(),
            spread.right.half()
        ))
    };
    named(answer.nominal.len() - 1).into_iter().filter_map(line).collect()
}

/// Distance to the plan, the chance to stay near it, and what can be done.
fn to_plan(config: &Config, question: &Question, answer: &Answer, goal: &Goal<'_>) -> Vec<String> {
    let Goal { plan, target, advice } = *goal;
    let last = last_station(plan);
    let mut lines = vec![format!(
        "The plan needs {} over the next {} m{}.",
        needed(plan.curvature()),
        metres(last),
        if last + 1 < answer.nominal.len() {
            ", where it ends"
        } else {
            ""
        }
    )];
    for station in named(last) {
        let known: Vec<&Track> = answer.members.iter().flatten().collect();
        let distances = known.iter().map(|track| plan.distance(&track[station]).whole).collect();
        let range =
            Band::of(distances).map_or_else(String::new, |band| format!(" ({:.2} to {:.2})", band.low, band.high));
        let kept = known.iter().filter(|track| plan.keeps(track, station, target)).count();
        let distance = answer.nominal.get(station).map(|bit| plan.distance(bit));
        let Some(distance) = distance else { continue };
        lines.push(format!(
            "After {} m the bit is {:.2} m{range} from the plan, {}; {kept} of {} stay within {target} m up to there.",
            metres(station),
            distance.whole,
            side(distance.high, distance.right),
            counted(known.len() as u64, known_as(answer))
        ));
    }
    lines.push(what_to_do(config, question, target, advice, last));
    lines
}

/// What is counted.
fn known_as(answer: &Answer) -> &'static str {
    match &answer.learnt {
        Some(learnt) if learnt.corrects_curvature() => "plausible hole",
        _ => "known tool",
    }
}

/// Where the bit is against the plan.
fn side(high: f64, right: f64) -> String {
    let vertical = if high >= 0.0 { "above" } else { "below" };
    let across = if right >= 0.0 { "right" } else { "left" };
    format!(
        "{:.2} m {vertical} and {:.2} m to the {across} of it",
        high.abs(),
        right.abs()
    )
}

fn what_to_do(config: &Config, question: &Question, target: f64, advice: Advice, last: usize) -> String {
    let now = n_to_kn(question.weight);
    let Tried { low, high } = allowed(config, now);
    match advice {
        Advice::ChangeGuide => {
            "This guide cannot drill the plan at any weight: the plan's radius is outside the range above. Change the guide."
                .to_owned()
        }
        Advice::Nothing => format!("At {now:.1} kN the bit stays within {target} m of the plan: keep the weight."),
        Advice::Weight { weight, distance } if distance <= target => format!(
            "{weight:.1} kN instead of {now:.1} kN bring the bit to {distance:.2} m from the plan after {} m. This is the hole \
             alone: look at whirl and stick-slip at that weight with ~/what_if or `flexdrill map` before you set it.",
            metres(last)
        ),
        Advice::Weight { weight, distance } => format!(
            "No weight from {low:.1} to {high:.1} kN brings the bit within {target} m of the plan after {} m; {weight:.1} kN \
             comes nearest, with {distance:.2} m. Another guide or another bit changes more.",
            metres(last)
        ),
        Advice::Unknown => format!("No weight from {low:.1} to {high:.1} kN has a known result."),
    }
}

/// What the figures leave out of this tool.
fn notes(config: &Config, answer: &Answer) -> Vec<String> {
    let mut notes = Vec::new();
    if matches!(config.tool.guide.free_curvature, FreeBend::Path(_)) {
        notes.push(format!(
            "tool.guide.free_curvature is as_built: the guide is taken as made with the curvature of the hole at the bit ({}). \
             Give the curvature that it was made with: 1 % of it is 0.9 deg after 5 m.",
            match super::tool::curvature_at_bit(config) {
                0.0 => "straight, which builds nothing".to_owned(),
                curvature => radius(curvature),
            }
        ));
    }
    // The closed form is that of a long arc.
    let arc = arc_above_bit(config);
    if let Some(long) = answer.long
        && arc < 2.0 * long.free_length
    {
        notes.push(format!(
            "Only {arc:.2} m of arc are above the bit, less than two free lengths: the straight hole above bends the guide, so \
             that the next metres differ from a long arc."
        ));
    }
    let (guide, weight) = (&answer.drilling.guide, answer.drilling.law.weight);
    // What the weight bends, and what slots leave of it.
    if let Some(spine) = guide.spine {
        let bend = spine.bend(weight, guide.bending_stiffness);
        let is_shut = spine.most.is_some_and(|most| bend >= most);
        notes.push(format!(
            "{:.2} kN of weight bend the guide by {bend:.3} 1/m in addition to its shape as made (tool.guide.spine_offset){}.",
            n_to_kn(weight),
            if is_shut {
                "; its slots are shut, and more weight bends it no further"
            } else {
                ""
            }
        ));
    }
    if config.tool.guide.closes_slots() {
        notes.push(if config.tool.guide.has_spine_off_axis() {
            "Slots that close (tool.guide.slots_close_at) limit the curvature that the weight adds; against the hole the guide \
             bends as with open ones."
                .to_owned()
        } else {
            "Slots that close (tool.guide.slots_close_at) are left out: the guide bends as with open ones.".to_owned()
        });
    }
    // What acts on the bit and is not in the statics.
    if config.environment.pressure.is_some() {
        notes.push("Pump pressure (environment.pressure) is left out.".to_owned());
    }
    if wear_flats(config) > 0.0 {
        notes.push(format!(
            "{:.2} kN of the weight are on wear flats and do not cut (rock.depth_of_cut.wear_flat_force).",
            n_to_kn(wear_flats(config))
        ));
    }
    notes
}

/// Length of the arcs that end at the bit (m).
fn arc_above_bit(config: &Config) -> f64 {
    let arcs = config.well.sections.iter().rev();
    arcs.take_while(|section| section.curvature() != 0.0)
        .map(flexdrill_config::Section::length)
        .sum()
}

/// Members without a result, with the causes.
fn unknown(answer: &Answer) -> Vec<String> {
    let mut causes: Vec<(&str, u64)> = Vec::new();
    for cause in answer.members.iter().filter_map(|member| member.as_ref().err()) {
        match causes.iter_mut().find(|known| known.0 == cause.as_str()) {
            Some(known) => known.1 += 1,
            None => causes.push((cause, 1)),
        }
    }
    let failed: u64 = causes.iter().map(|(_, count)| count).sum();
    let named = causes.len().min(CAUSES);
    let mut lines: Vec<String> = causes[..named]
        .iter()
        .map(|(cause, count)| format!("Unknown for {}: {cause}", counted(*count, "plausible tool")))
        .collect();
    let rest = failed - causes[..named].iter().map(|(_, count)| count).sum::<u64>();
    if rest > 0 {
        lines.push(format!(
            "Unknown for {} more, each with another cause.",
            counted(rest, "plausible tool")
        ));
    }
    lines
}
