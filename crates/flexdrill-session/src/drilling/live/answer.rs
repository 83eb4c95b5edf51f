//! The next metres at a weight: the tool as configured and plausible ones, as `flexdrill ahead` lets them drill.

use std::sync::atomic::{AtomicBool, Ordering};

use flexdrill_config::{BitAxis, Config, FreeBend, Section};
use flexdrill_core::units::{deg_to_rad, n_to_kn, rad_to_deg};
use flexdrill_hole::{Survey, at_rest, bounds, steady};

use super::surveyed::{Surveyed, learn};
use crate::drilling::to_plan::{Ranges, ToPlan, compare};
use crate::drilling::unknowns;
use crate::drilling::{
    Band, Drilling, Long, NEXT_METRE, SPACING, STEEP, Spread, Station, Track, build, curvature, drill, spread, turned,
};

/// Metres ahead.
pub const METRES: f64 = 5.0;
/// Plausible tools: a range needs 19, and some may have no result.
pub const MEMBERS: usize = 24;

/// Holes that are drawn from what surveys say: the ends of a band scatter by 7 % of its half.
const HOLES: usize = 300;

/// A number with 5 and 95 % of the plausible tools.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranged {
    /// Of the tool as configured.
    pub value: f64,
    /// 5 % of the plausible tools are below.
    pub low: f64,
    /// 5 % of the plausible tools are above.
    pub high: f64,
}

/// Where the tool drills at a weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Ahead {
    /// Side force to the low side of the guide at rest in the hole (N).
    pub side_force_low: f64,
    /// What the tool drills to in a long arc.
    pub long: Long,
    /// Arc above the bit (m).
    pub arc: f64,
    /// Curvatures (1/m) between which the guide drills in a long arc at this weight, whatever the bit.
    pub any_bit: [f64; 2],
    /// The stations of the tool as configured.
    pub track: Track,
    /// Where the plausible tools are at each of them; empty with fewer than a range needs.
    pub spread: Vec<Spread>,
    /// Build rate, walk rate and curvature over the next metre (rad/m); none with fewer tools than a range needs.
    pub rates: Option<[Ranged; 3]>,
    /// Plausible tools with a result, and without.
    pub members: [u32; 2],
    /// The plan of the configuration against it, or why it is not compared; none without a plan.
    pub plan: Option<Result<ToPlan, String>>,
    /// What surveys say, or why none is used; none without surveys.
    pub surveyed: Option<Result<Surveyed, String>>,
}

/// Why nothing can be said for a configuration, whatever the load; none where something can.
pub fn refusal(config: &Config) -> Option<String> {
    let why = if config.tool.bit.axis() == BitAxis::Link {
        "the bit is screwed to the last link (tool.bit.axis: link) and points where that link lies, which depends on whirl"
    } else if config.tool.guide.fixed {
        "the guide is held at every node (tool.guide.fixed), and such a guide does not drill"
    } else if config.well.is_straight() {
        "the hole is straight, and where a curved guide drills depends on the arc that it lies in"
    } else if matches!(config.tool.guide.free_curvature, FreeBend::Path(_)) {
        "the shape of the guide is not given (tool.guide.free_curvature: as_built): measure it on a template and set the \
         curvature as a number"
    } else {
        return None;
    };
    Some(why.to_owned())
}

/// Length of the arc above the bit (m).
fn arc_above_the_bit(config: &Config) -> f64 {
    let sections = config.well.sections.iter().rev();
    let arc = sections.take_while(|section| section.curvature() != 0.0);
    arc.map(Section::length).sum()
}

/// Turn to the right per metre over the next metre (rad/m); NaN near the vertical.
fn walk(track: &[Station]) -> f64 {
    let ends = (track.first(), track.get(NEXT_METRE));
    let (Some(from), Some(to)) = ends else { return f64::NAN };
    if [from, to].into_iter().any(|at| libm::sin(at.inclination) < STEEP) {
        return f64::NAN;
    }
    turned(to.azimuth - from.azimuth) / (NEXT_METRE as f64 * SPACING)
}

/// A rate of the tool as configured, with its range.
fn ranged(nominal: &[Station], members: &[Result<Track, String>], of: impl Fn(&[Station]) -> f64) -> Option<Ranged> {
    let band = Band::of(members.iter().flatten().map(|track| of(track)).collect())?;
    Some(Ranged {
        value: of(nominal),
        low: band.low,
        high: band.high,
    })
}

/// What is asked of the next metres.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Weight at the bit (N).
    pub weight: f64,
    /// Seed of the draws.
    pub seed: u64,
    /// Whether a hole that leaves its plan has the weight that brings it back.
    pub searches: bool,
    /// Surveys of the hole above the bit.
    pub surveys: &'a [Survey],
}

/// Computes the next metres, with what surveys correct. The same arguments give the same bits.
///
/// # Errors
/// Why there is no answer, in words; also where `stop` was set. Surveys that cannot be used leave the answer as it is without
/// them.
pub fn compute(config: &Config, question: Question<'_>, stop: &AtomicBool) -> Result<Ahead, String> {
    let Question {
        weight,
        seed,
        searches,
        surveys,
    } = question;
    let in_words = |error: &dyn std::fmt::Display| format!("the next metres cannot be computed: {error}");
    let drilling = Drilling::of(config, weight, 0.0).map_err(|error| in_words(&error))?;
    let rest = at_rest(&drilling.guide, weight, &drilling.hole).map_err(|error| in_words(&error))?;
    let inclination = deg_to_rad(config.well.end_inclination_deg());
    let sine = libm::sin(inclination);
    // The closed forms are for the hole at the bit.
    let long = steady(&drilling.guide, &drilling.law, sine).map_err(|error| in_words(&error))?;
    let any_bit = bounds(&drilling.guide, weight, sine).map_err(|error| in_words(&error))?;
    let stations = (METRES / SPACING) as usize;
    let mut track = drill(&drilling, stations).map_err(|error| in_words(&error))?;
    let surveyed = learn(config, &drilling, surveys);
    let learnt = surveyed.as_ref().and_then(|surveyed| surveyed.as_ref().ok());
    // Where the curvature was measured, plausible tools say nothing more of it.
    let tools = if learnt.is_some_and(|(learnt, _)| learnt.corrects_curvature()) {
        Vec::new()
    } else {
        unknowns::members(config, weight, 0.0, MEMBERS, seed).map_err(|error| in_words(&error))?
    };
    let mut members = Vec::with_capacity(MEMBERS);
    for tool in tools {
        // A node that ends does not wait for tools that are of no use any more.
        if stop.load(Ordering::Relaxed) {
            return Err("the run has ended".to_owned());
        }
        members.push(tool.and_then(|tool| drill(&tool, stations).map_err(|error| error.to_string())));
    }
    if let Some((learnt, _)) = learnt {
        members = learnt
            .plausible(&track, &members, HOLES, seed)
            .map_err(|error| in_words(&error))?;
        track = learnt.corrected(&track);
    }
    // Under another weight the tool is taken to differ by as much from the one as configured.
    let corrected = |track: Track| match learnt {
        Some((learnt, _)) => learnt.corrected(&track),
        None => track,
    };
    // The ranges are of the next metre, as a driller asks for it.
    let rates = [
        ranged(&track, &members, |track| build(track, NEXT_METRE)),
        ranged(&track, &members, walk),
        ranged(&track, &members, curvature),
    ];
    let known = members.iter().flatten().count();
    let spread = spread(&track, &members);
    let ranged_hole = Ranges {
        nominal: &track,
        members: &members,
        spread: &spread,
        corrected: &corrected,
    };
    let plan = compare(config, &drilling, &ranged_hole, searches.then_some(weight), stop);
    let surveyed = surveyed.map(|surveyed| surveyed.map(|(learnt, plane)| Surveyed::of(&learnt, plane)));
    let rates = match rates {
        [Some(build), Some(walk), Some(curvature)] => Some([build, walk, curvature]),
        _ => None,
    };
    Ok(Ahead {
        side_force_low: rest.side_force.y,
        long: Long::from(long),
        arc: arc_above_the_bit(config),
        any_bit: [any_bit.low, any_bit.high],
        spread,
        track,
        plan,
        surveyed,
        rates,
        members: [known, members.len() - known].map(|count| u32::try_from(count).unwrap_or(u32::MAX)),
    })
}

impl Ahead {
    /// Why this is not to be believed under a weight (N) and a side force to the low side with its standard error (N), where
    /// it is not.
    ///
    /// A guide feels the straight hole above an arc that is shorter than twice its free length.
    pub fn doubt(&self, weight: f64, [side_force, error]: [f64; 2]) -> Option<String> {
        if let Some(why) = self.short_of() {
            return Some(why);
        }
        side_force_doubt(self.side_force_low, weight, [side_force, error])
    }

    /// Radius of the next metre (m) with 5 and 95 % of the plausible tools, infinite where it is straight; NaN with fewer tools
    /// than a range needs.
    pub fn radius(&self) -> [f64; 3] {
        let of = |curvature: f64| {
            if curvature > 0.0 {
                1.0 / curvature
            } else {
                f64::INFINITY
            }
        };
        // The larger curvature is the smaller radius.
        self.rates.map_or([f64::NAN; 3], |[_, _, curvature]| {
            [curvature.value, curvature.high, curvature.low].map(of)
        })
    }

    /// What it lacks to be believed, whatever the twin's side force is.
    pub fn short_of(&self) -> Option<String> {
        let [known, failed] = self.members;
        if self.rates.is_none() {
            return Some(format!(
                "only {known} of {} plausible tools have a result, and a range needs {}",
                known + failed,
                Band::LEAST
            ));
        }
        let needed = 2.0 * self.long.free_length;
        if self.arc < needed {
            return Some(format!(
                "the arc above the bit is {:.2} m long, and this guide needs {needed:.2} m, twice its free length: above a \
                 shorter arc it feels the straight hole",
                self.arc
            ));
        }
        None
    }
}

/// Why a forecast is not to be believed whose guide at rest has a side force to the low side of `at_rest` (N), under a weight (N)
/// and the side force of the twin with its standard error (N), where it is not.
///
/// The statics hold the guide as its shape and its weight say; where the twin's side force is another one, something else acts
/// on the guide, and the hole is grown for a tool that there is not. 0.5 % of the weight is what two programs for the same guide
/// differ by.
pub fn side_force_doubt(at_rest: f64, weight: f64, [side_force, error]: [f64; 2]) -> Option<String> {
    let errors = if error.is_finite() { 3.0 * error } else { 0.0 };
    let tolerance = errors + (0.05 * at_rest.abs()).max(0.005 * weight);
    let off = (side_force - at_rest).abs();
    if off.is_nan() || off > tolerance {
        return Some(format!(
            "the bit pushes {side_force:.0} N to the low side, and the guide at rest {at_rest:.0} N (tolerance {tolerance:.0} N): \
             something acts on the guide that this forecast leaves out, such as pressure, shut slots or hinges"
        ));
    }
    None
}

/// Why nothing is known under these means, where that is so; `flats` is the force of the wear flats (N).
pub fn standing(means: &super::Means, flats: f64) -> Option<String> {
    if means.weight <= 0.0 {
        return Some("the bit is off bottom".to_owned());
    }
    // 1 r/min: slower than any drive drills.
    if means.rotary_speed < std::f64::consts::TAU / 60.0 {
        let reverse = means.rotary_speed < -std::f64::consts::TAU / 60.0;
        return Some(
            if reverse {
                "the bit turns in reverse"
            } else {
                "the bit stands"
            }
            .to_owned(),
        );
    }
    if means.weight <= flats {
        return Some(format!(
            "all of the weight, {:.2} kN, is on the wear flats of the bit, which carry {:.2} kN: it cuts nothing",
            n_to_kn(means.weight),
            n_to_kn(flats)
        ));
    }
    if means.turns == 0 {
        return Some(format!(
            "the bit has turned by {:.0} deg in {:.1} s, and means need a whole turn",
            rad_to_deg(means.rotary_speed * means.window),
            means.window
        ));
    }
    None
}
