//! What surveys correct in a forecast: the direction of the hole at the bit, and the curvature that the tool drills.
//!
//! The filter's model of the hole that the tool has drilled is the closed form for its curvature at the inclination of the
//! configuration. What it learns from the difference is added to the statics ahead: one tool, the one as configured, with the
//! curvature that was measured. The plausible tools of a forecast without surveys do not count any more then, because the
//! correction has lateral resistance, shape and stiffness together: a spread of each would count them twice.

use fastrand::Rng;
use flexdrill_config::{Config, Distribution};
use flexdrill_core::units::deg_to_rad;
use flexdrill_hole::{HoleError, PlaneModel, Planes, RunStart, Survey, SurveyFilter, steady};
use flexdrill_uncertainty::Law;

use super::{Drilling, SPACING, Station, Track, across};

/// Standard deviation of the direction where the run begins (rad), which the configuration has from a former survey. An
/// assumption.
const START: f64 = 1.0 * std::f64::consts::PI / 180.0;
/// Longest piece of the filter (m): the weight across the hole changes little over it.
const PIECE: f64 = 0.25;
/// 90 % of a normal distribution are within so many standard deviations.
pub const NINETY: f64 = 1.644_853_626_951;

/// What surveys say of a run.
#[derive(Debug, Clone)]
pub struct Learnt {
    /// The surveys, from above.
    pub surveys: Vec<Survey>,
    /// Measured depth from which on this tool has drilled (m).
    pub since: f64,
    /// The filter at the bit.
    pub filter: SurveyFilter,
    /// Inclination at the bit as configured (rad).
    pub configured: f64,
    /// Standard deviation of the azimuth of the plane of the build (rad): 0 where a plan has it.
    plane_deviation: f64,
}

/// Inclination of the hole as configured at a measured depth (rad).
fn inclination(config: &Config, depth: f64) -> f64 {
    let mut at = deg_to_rad(config.well.start_inclination_deg);
    let mut rest = depth;
    for section in &config.well.sections {
        let length = section.length().min(rest);
        at += section.turn(length);
        rest -= length;
    }
    at
}

/// Measured depth at which the arcs that end at the bit begin (m).
pub fn arc_begins(config: &Config) -> f64 {
    let sections = config.well.sections.iter().rev();
    let arcs: f64 = sections
        .take_while(|section| section.curvature() != 0.0)
        .map(flexdrill_config::Section::length)
        .sum();
    (config.well.length() - arcs).max(0.0)
}

/// Measured depth from which on this tool has drilled (m): as configured, or else where the arcs that end at the bit begin.
pub fn drilled_from(config: &Config) -> f64 {
    config.well.drilled_from.unwrap_or_else(|| arc_begins(config))
}

impl Learnt {
    /// What surveys say of a tool that has drilled from a measured depth (m) to the bit. Surveys above that depth are in
    /// another tool's hole and are not used. `plane` is the azimuth of the plane of the build with its standard deviation
    /// (rad).
    ///
    /// # Errors
    /// [`HoleError`] for a start that is not above the bit, surveys that cannot be, and a tool without a steady curvature.
    pub fn of(
        config: &Config,
        drilling: &Drilling,
        mut surveys: Vec<Survey>,
        since: f64,
        [azimuth, plane_deviation]: [f64; 2],
    ) -> Result<Self, HoleError> {
        let bit = config.well.length();
        surveys.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        let models = Planes {
            build: PlaneModel::BUILD,
            right: PlaneModel::RIGHT,
        };
        let start = RunStart {
            depth: since,
            inclination: inclination(config, since),
            azimuth,
            deviation: START,
        };
        let mut filter = SurveyFilter::begin(models, start)?;
        let count = ((bit - since) / PIECE).ceil().max(1.0);
        let length = (bit - since) / count;
        let mut used = surveys.iter().filter(|survey| survey.depth >= since).peekable();
        for index in 1..=count as usize {
            // The last piece ends at the bit, with no rounding between them.
            let end = if index as f64 == count {
                bit
            } else {
                since + index as f64 * length
            };
            let sine = libm::sin(inclination(config, end - 0.5 * length));
            let build = steady(&drilling.guide, &drilling.law, sine)?.curvature;
            filter.drilled_to(end, Planes { build, right: 0.0 })?;
            // A survey is late by less than a piece, so that a long run keeps all of them.
            while let Some(survey) = used.next_if(|survey| survey.depth <= end) {
                filter.survey(*survey)?;
            }
        }
        Ok(Self {
            configured: inclination(config, bit),
            since,
            filter,
            surveys,
            plane_deviation,
        })
    }

    /// Whether surveys correct the curvature, not the direction alone.
    pub const fn corrects_curvature(&self) -> bool {
        self.filter.learnt() > 0
    }

    /// Surveys of the hole that this tool has drilled, from above.
    pub fn used(&self) -> impl Iterator<Item = &Survey> {
        self.surveys.iter().filter(|survey| survey.depth >= self.since)
    }

    /// Standard deviation of the azimuth of the plane of the build (rad): 0 where a plan has it.
    pub const fn plane_deviation(&self) -> f64 {
        self.plane_deviation
    }

    /// What a survey corrects.
    pub fn corrects(&self, survey: &Survey) -> &'static str {
        match survey.depth - self.since {
            drilled if drilled < 0.0 => "nothing",
            drilled if drilled < PlaneModel::BUILD.settling => "direction",
            _ => "direction and curvature",
        }
    }

    /// How far the hole is turned at some stations against the configured one with the model's curvature (rad).
    fn offset(&self, angles: Planes<f64>) -> Planes<f64> {
        Planes {
            build: angles.build - self.configured,
            right: angles.right,
        }
    }

    /// A track with the mean correction.
    pub fn corrected(&self, track: &[Station]) -> Track {
        let at = self.filter.at_bit();
        let ahead = |index: usize, state: flexdrill_hole::PlaneState| {
            let correction = if self.corrects_curvature() {
                state.correction
            } else {
                0.0
            };
            state.angle + correction * index as f64 * SPACING
        };
        turned_by(track, 0.0, |index| {
            self.offset(Planes {
                build: ahead(index, at.build),
                right: ahead(index, at.right),
            })
        })
    }

    /// The plausible holes ahead: so many `holes` drawn from the filter around the tool as configured, or, where surveys correct
    /// the direction alone, the plausible tools from the surveyed direction on.
    ///
    /// # Errors
    /// [`HoleError`] never, with stations at a distance.
    pub fn plausible(
        &self,
        nominal: &[Station],
        tools: &[Result<Track, String>],
        holes: usize,
        seed: u64,
    ) -> Result<Vec<Result<Track, String>>, HoleError> {
        let unit = Distribution::Normal {
            low: -NINETY,
            high: NINETY,
        };
        let law = Law::new(&unit, [-10.0, 10.0]);
        let mut rng = Rng::with_seed(seed);
        // The limits hold the distribution, so that there is a law.
        let mut normal = || {
            law.as_ref()
                .map_or(0.0, |law| law.quantile(rng.f64().clamp(1e-12, 1.0 - 1e-12)))
        };
        let mut drawn = |track: &[Station], steps: usize| -> Result<Track, HoleError> {
            let plane = self.plane_deviation * normal();
            let angles = self.filter.plausible(SPACING, steps, &mut normal)?;
            // With one step the direction at the bit is that of all stations.
            Ok(turned_by(track, plane, |index| self.offset(angles[index.min(steps)])))
        };
        if self.corrects_curvature() {
            let steps = nominal.len().saturating_sub(1);
            return (0..holes).map(|_| drawn(nominal, steps).map(Ok)).collect();
        }
        let from_surveyed = |tool: &Result<Track, String>| match tool {
            Ok(track) => drawn(track, 0).map(Ok),
            Err(cause) => Ok(Err(cause.clone())),
        };
        tools.iter().map(from_surveyed).collect()
    }
}

/// A track whose plane is turned by an azimuth (rad), and its directions by angles (rad) in and across the plane at each
/// station, with its positions from the same bit on.
fn turned_by(track: &[Station], plane: f64, by: impl Fn(usize) -> Planes<f64>) -> Track {
    let mut turned: Track = Vec::with_capacity(track.len());
    let mut before: Option<[f64; 3]> = None;
    for (index, station) in track.iter().enumerate() {
        let Planes { build, right } = by(index);
        let station = Station {
            azimuth: station.azimuth + plane,
            ..*station
        };
        let in_plane = station.inclination + build;
        let ((sine, cosine), (east, north)) = (libm::sincos(in_plane), libm::sincos(station.azimuth));
        let [_, side] = across(&station);
        let (across, along) = libm::sincos(right);
        let tangent: [f64; 3] =
            std::array::from_fn(|axis| along * [sine * north, sine * east, cosine][axis] + across * side[axis]);
        let position = match (turned.last(), before) {
            (Some(last), Some(above)) => {
                // An arc between both directions: the chord is along their mean.
                let dot: f64 = (0..3).map(|axis| above[axis] * tangent[axis]).sum();
                let half = 0.5 * libm::acos(dot.clamp(-1.0, 1.0));
                let factor = if half < 1e-6 { 1.0 } else { libm::tan(half) / half };
                std::array::from_fn(|axis| last.position[axis] + 0.5 * SPACING * factor * (above[axis] + tangent[axis]))
            }
            _ => station.position,
        };
        turned.push(Station {
            inclination: libm::atan2(libm::hypot(tangent[0], tangent[1]), tangent[2]),
            azimuth: libm::atan2(tangent[1], tangent[0]),
            position,
        });
        before = Some(tangent);
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_that_is_not_turned_is_the_track() {
        // An arc of 3.2 m from the vertical, in a plane at 0.4 rad.
        let station = |index: u32| {
            let angle = f64::from(index) * SPACING / 3.2 + 0.1;
            let out = 3.2 * (libm::cos(0.1) - libm::cos(angle));
            Station {
                inclination: angle,
                azimuth: 0.4,
                position: [
                    out * libm::cos(0.4),
                    out * libm::sin(0.4),
                    3.2 * (libm::sin(angle) - libm::sin(0.1)),
                ],
            }
        };
        let track: Track = (0..=20).map(station).collect();
        let same = turned_by(&track, 0.0, |_| Planes { build: 0.0, right: 0.0 });
        for (a, b) in track.iter().zip(&same) {
            assert!((a.inclination - b.inclination).abs() < 1e-12 && (a.azimuth - b.azimuth).abs() < 1e-12);
            let apart: f64 = (0..3).map(|axis| (a.position[axis] - b.position[axis]).abs()).sum();
            // Minimum curvature is exact on a circle.
            assert!(apart < 1e-12, "{apart}");
        }
        let right = turned_by(&track, 0.0, |_| Planes { build: 0.0, right: 0.1 });
        // In a hole of inclination i an angle a to the right is an azimuth of atan(tan a / sin i).
        let last = right[20];
        let expected = 0.4 + libm::atan(libm::tan(0.1) / libm::sin(track[20].inclination));
        assert!((last.azimuth - expected).abs() < 1e-12, "{last:?}");
        let other = turned_by(&track, 0.3, |_| Planes { build: 0.0, right: 0.0 });
        assert!(
            (other[20].azimuth - 0.7).abs() < 1e-12 && (other[20].inclination - track[20].inclination).abs() < 1e-12
        );
    }
}
