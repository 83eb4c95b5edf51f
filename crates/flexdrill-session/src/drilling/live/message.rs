//! `HoleAhead` from means and an answer.

use super::Draft;
use super::answer::{Ahead, Ranged};
use super::surveyed::Surveyed;
use crate::drilling::SPACING;
use crate::drilling::to_plan::{At, ToPlan};
use flexdrill_core::units::kn_to_n;
use flexdrill_hole::Survey;
use flexdrill_messages::HoleAhead;

/// What stands where nothing is known.
const RATES: Ranged = Ranged {
    value: f64::NAN,
    low: f64::NAN,
    high: f64::NAN,
};

/// The radius of a curvature (m), infinite where there is none or the hole bends the other way.
fn radius(curvature: f64) -> f64 {
    if curvature > 0.0 {
        1.0 / curvature
    } else {
        f64::INFINITY
    }
}

/// What stands where no survey is used.
const NOT_SURVEYED: Surveyed = Surveyed {
    used: [0; 2],
    last: f64::NAN,
    drilled_from: f64::NAN,
    plane: None,
    inclination: [f64::NAN; 2],
    azimuth: [f64::NAN; 2],
    build: [f64::NAN; 2],
};

/// The message without header and instant of the answer.
pub fn message(draft: &Draft, ahead: Result<&Ahead, &str>) -> HoleAhead {
    let mut out = means(draft);
    let because = match ahead {
        Err(because) => Some(because.to_owned()),
        Ok(ahead) => {
            out.side_force_low_at_rest = ahead.side_force_low;
            [out.members, out.failed] = ahead.members;
            match &ahead.surveyed {
                Some(Ok(surveyed)) => {
                    out.surveys_because = surveyed.far_off(draft.inclination).unwrap_or_default();
                    surveys(surveyed, &mut out);
                }
                Some(Err(why)) => out.surveys_because.clone_from(why),
                None => {}
            }
            let side_force = [out.side_force_low, out.side_force_low_error];
            ahead.doubt(out.weight_on_bit, side_force)
        }
    };
    match (because, ahead) {
        (None, Ok(ahead)) => fill(ahead, &mut out),
        (because, _) => out.because = because.unwrap_or_default(),
    }
    out
}

/// What is known without an answer. All that says where the tool drills is NaN or empty.
fn means(draft: &Draft) -> HoleAhead {
    let Draft {
        ref means,
        weight_that_cuts,
        turn: [turn_right, turn_low],
        measured_depth,
        inclination,
        surveys: ref known,
        ..
    } = *draft;
    // A 0 where nothing is known would be read as a number.
    let unknown = f64::NAN;
    let mut out = HoleAhead {
        measured_depth,
        inclination,
        // The hole lies in one plane.
        azimuth: 0.0,
        turn_low,
        turn_right,
        weight_that_cuts,
        side_force_low_at_rest: unknown,
        steering_number: unknown,
        free_length: unknown,
        radius_any_bit_low: unknown,
        radius_any_bit_high: unknown,
        plan_target: unknown,
        plan_build_rate: unknown,
        plan_off: unknown,
        plan_weight_low: unknown,
        plan_weight_high: unknown,
        plan_nearest_weight: unknown,
        plan_nearest_off: unknown,
        plan_nearest_radius: unknown,
        plan_weight: unknown,
        window: means.window,
        turns: means.turns,
        side_force_low: means.side_force[1],
        side_force_right: means.side_force[0],
        side_force_low_error: means.side_force_error[1],
        side_force_right_error: means.side_force_error[0],
        tilt_low: means.tilt[1],
        tilt_right: means.tilt[0],
        weight_on_bit: means.weight,
        torque: means.torque,
        survey_depths: known.iter().map(|survey| survey.depth).collect(),
        survey_inclinations: known.iter().map(|survey| survey.inclination).collect(),
        survey_inclination_deviations: known.iter().map(|survey| survey.inclination_deviation).collect(),
        survey_azimuths: known.iter().map(|survey| azimuth(survey)[0]).collect(),
        survey_azimuth_deviations: known.iter().map(|survey| azimuth(survey)[1]).collect(),
        ..HoleAhead::default()
    };
    rates(&mut out, [RATES; 3]);
    surveys(&NOT_SURVEYED, &mut out);
    out
}

/// Azimuth and standard deviation of a survey (rad); NaN without one.
fn azimuth(survey: &Survey) -> [f64; 2] {
    survey.azimuth.unwrap_or([f64::NAN; 2])
}

/// The surveys that a message has.
pub fn surveys_of(message: &HoleAhead) -> Vec<Survey> {
    let of = |index: usize| {
        // Lists of a message that is no message of this program may differ in length.
        let at = |list: &[f64]| list.get(index).copied();
        let azimuth = at(&message.survey_azimuths)?;
        Some(Survey {
            depth: at(&message.survey_depths)?,
            inclination: at(&message.survey_inclinations)?,
            inclination_deviation: at(&message.survey_inclination_deviations)?,
            azimuth: if azimuth.is_nan() {
                None
            } else {
                Some([azimuth, at(&message.survey_azimuth_deviations)?])
            },
        })
    };
    (0..message.survey_depths.len()).filter_map(of).collect()
}

/// What surveys say.
fn surveys(surveyed: &Surveyed, out: &mut HoleAhead) {
    [out.surveys_used, out.surveys_learnt] = surveyed.used;
    out.since_survey = out.measured_depth - surveyed.last;
    [out.surveyed_inclination, out.surveyed_inclination_deviation] = surveyed.inclination;
    [out.surveyed_azimuth, out.surveyed_azimuth_deviation] = surveyed.azimuth;
    [out.surveyed_build, out.surveyed_build_deviation] = surveyed.build;
    out.plane_azimuth = surveyed.plane.unwrap_or(f64::NAN);
    out.drilled_from = surveyed.drilled_from;
}

/// Build rate, walk rate and curvature.
fn rates(out: &mut HoleAhead, [build, walk, curvature]: [Ranged; 3]) {
    (out.build_rate, out.build_rate_low, out.build_rate_high) = (build.value, build.low, build.high);
    (out.walk_rate, out.walk_rate_low, out.walk_rate_high) = (walk.value, walk.low, walk.high);
    let of = |curvature: f64| {
        if curvature.is_nan() {
            f64::NAN
        } else {
            radius(curvature)
        }
    };
    // The larger curvature is the smaller radius.
    (out.radius, out.radius_low, out.radius_high) = (of(curvature.value), of(curvature.high), of(curvature.low));
}

/// Where the tool drills.
fn fill(ahead: &Ahead, out: &mut HoleAhead) {
    out.known = true;
    rates(out, ahead.rates.unwrap_or([RATES; 3]));
    out.steering_number = ahead.long.steering_number;
    out.free_length = ahead.long.free_length;
    out.ripples = ahead.long.ripples();
    let [low, high] = ahead.any_bit;
    (out.radius_any_bit_low, out.radius_any_bit_high) = (radius(high), radius(low));
    let depth = |station: usize| out.measured_depth + station as f64 * SPACING;
    out.measured_depths = (0..ahead.track.len()).map(depth).collect();
    out.inclinations = ahead.track.iter().map(|at| at.inclination).collect();
    out.azimuths = ahead.track.iter().map(|at| at.azimuth).collect();
    let position = |axis: usize| ahead.track.iter().map(|at| at.position[axis]).collect();
    (out.position_x, out.position_y, out.position_z) = (position(0), position(1), position(2));
    let of = |number: fn(&crate::drilling::Spread) -> f64| ahead.spread.iter().map(number).collect();
    out.inclinations_low = of(|at| at.inclination.low);
    out.inclinations_high = of(|at| at.inclination.high);
    out.azimuths_low = of(|at| at.azimuth.low);
    out.azimuths_high = of(|at| at.azimuth.high);
    out.half_width_high = of(|at| at.high.half());
    out.half_width_right = of(|at| at.right.half());
    match &ahead.plan {
        Some(Ok(plan)) => to_plan(plan, out),
        Some(Err(why)) => out.plan_because.clone_from(why),
        None => {}
    }
}

/// The plan against it.
fn to_plan(plan: &ToPlan, out: &mut HoleAhead) {
    out.plan_target = plan.target;
    out.plan_build_rate = plan.build;
    // Beyond the end of the plan there is no distance to it.
    let stations = out.measured_depths.len();
    let of = |number: fn(&At) -> f64| {
        let known = plan.stations.iter().map(number);
        known.chain(std::iter::repeat(f64::NAN)).take(stations).collect()
    };
    out.plan_high = of(|at| at.high);
    out.plan_right = of(|at| at.right);
    out.plan_inclination = of(|at| at.inclination);
    out.plan_azimuth = of(|at| at.azimuth);
    out.plan_within = of(|at| at.within);
    out.plan_off = plan.off;
    if let Some(tried) = plan.tried {
        (out.plan_weight_low, out.plan_weight_high) = (kn_to_n(tried.low), kn_to_n(tried.high));
    }
    if let Some(nearest) = plan.nearest {
        out.plan_nearest_weight = nearest.weight;
        out.plan_nearest_off = nearest.off;
        out.plan_nearest_radius = radius(nearest.curvature);
    }
    out.plan_weight = plan.weight().unwrap_or(f64::NAN);
    out.plan_no_weight = plan.no_weight();
    out.plan_no_guide = plan.no_guide;
}
