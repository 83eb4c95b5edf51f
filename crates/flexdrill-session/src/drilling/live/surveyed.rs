//! What the surveys of a live twin say of its hole.

use flexdrill_config::Config;
use flexdrill_hole::Survey;

use crate::drilling::learnt::{Learnt, drilled_from};
use crate::drilling::plan::{Row, azimuth};
use crate::drilling::{Drilling, STEEP, surveys};
use flexdrill_core::units::rad_to_deg;

/// Difference of the inclination at the bit from the configured one (deg) from which on the configuration is wrong: a hole
/// that is 3 deg off over 2 m has another curvature by 8 % of a 3.2 m arc's.
const FAR_OFF: f64 = 3.0;

/// What surveys say at the bit. Each pair is a value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surveyed {
    /// Surveys that are used, and those of them that correct the curvature too.
    pub used: [u32; 2],
    /// Measured depth of the last of them (m).
    pub last: f64,
    /// Measured depth from which on this tool has drilled (m).
    pub drilled_from: f64,
    /// Azimuth of the plane of the configured hole (rad), from north.
    pub plane: Option<f64>,
    /// Inclination of the hole (rad).
    pub inclination: [f64; 2],
    /// Azimuth of the hole (rad), from the plane of the configured hole; NaN near the vertical.
    pub azimuth: [f64; 2],
    /// How much more the tool builds than as configured (1/m); NaN where no survey corrects the curvature.
    pub build: [f64; 2],
}

/// Azimuth of the plane of the configured hole from north, with its standard deviation (rad): that of the plan at the bit, or
/// else of the surveys. None where neither has one.
fn plane(config: &Config, surveys: &[Survey]) -> Option<[f64; 2]> {
    let stations = config.well.plan.iter().flat_map(|plan| &plan.stations);
    let rows: Vec<Row> = stations.map(Row::from).collect();
    // A plan has at least two stations, or none here.
    if rows.len() > 1 {
        return Some([azimuth(&rows, config.well.length()), 0.0]);
    }
    surveys::plane(surveys)
}

/// What surveys correct in the forecast of a tool, with the azimuth of the plane of the configured hole; or why none of them
/// is used. None without surveys.
pub fn learn(
    config: &Config,
    drilling: &Drilling,
    surveys: &[Survey],
) -> Option<Result<(Learnt, Option<f64>), String>> {
    if surveys.is_empty() {
        return None;
    }
    let (since, bit) = (drilled_from(config), config.well.length());
    if since >= bit {
        return Some(Err(
            "the hole has no arc above the bit: set well.drilled_from, the depth at which this tool began to drill"
                .to_owned(),
        ));
    }
    // Another tool drilled the hole above. In the order of depth the answer is the same whichever came first.
    let mut used: Vec<Survey> = surveys.iter().copied().filter(|survey| survey.depth >= since).collect();
    // A survey at the bit may lie below it by the rounding of depths.
    used.iter_mut().for_each(|survey| survey.depth = survey.depth.min(bit));
    used.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    if used.is_empty() {
        return Some(Err(format!(
            "no survey lies below {since:.2} m, where this tool began to drill (well.drilled_from)"
        )));
    }
    let plane = plane(config, &used);
    let learnt = Learnt::of(config, drilling, used, since, plane.unwrap_or_default());
    Some(match learnt {
        Ok(learnt) => Ok((learnt, plane.map(|[azimuth, _]| azimuth))),
        Err(error) => Err(format!("the surveys cannot be used: {error}")),
    })
}

impl Surveyed {
    /// From the filter, and the azimuth of the plane from north (rad).
    pub fn of(learnt: &Learnt, plane: Option<f64>) -> Self {
        let at = learnt.filter.at_bit();
        let [build, right] = [at.build, at.right].map(|plane| plane.covariance.map(|entry| entry.max(0.0)));
        let inclination = at.build.angle;
        let sine = libm::sin(inclination);
        // The angle to the right of the plane is that of the direction, not of its azimuth.
        let azimuth = if sine < STEEP {
            [f64::NAN; 2]
        } else {
            let across = libm::sqrt(right[0]) / sine;
            [
                libm::atan2(libm::tan(at.right.angle), sine),
                libm::hypot(across, learnt.plane_deviation()),
            ]
        };
        let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        Self {
            used: [learnt.filter.used(), learnt.filter.learnt()].map(count),
            last: learnt.used().map(|survey| survey.depth).fold(f64::NAN, f64::max),
            drilled_from: learnt.since,
            plane,
            inclination: [inclination, libm::sqrt(build[0])],
            azimuth,
            build: if learnt.corrects_curvature() {
                [at.build.correction, libm::sqrt(build[2])]
            } else {
                [f64::NAN; 2]
            },
        }
    }

    /// Why the configured hole is doubtful where surveys put the bit elsewhere (rad from its inclination); none within 3 deg.
    pub fn far_off(&self, configured: f64) -> Option<String> {
        let [surveyed, configured] = [self.inclination[0], configured].map(rad_to_deg);
        ((surveyed - configured).abs() > FAR_OFF).then(|| {
            format!(
                "the surveys have {surveyed:.1} deg of inclination at the bit and the configuration {configured:.1} deg: correct \
                 well.sections, because the guide is taken to lie in that hole"
            )
        })
    }
}
