//! The hole that a live twin drills: `twin/hole_drilled`, a message per point.
//!
//! The bit's advance is the model's. A point is final once it is sent: its curvatures are those of the newest answer at the
//! point's own distance ahead of the configured hole's end, since that answer has let the hole grow up to there. What is
//! sent follows from the messages of `twin/hole_ahead` and the advance at their ends alone, so that a replay has the same
//! points. The tool stays in the hole of its configuration; `flexdrill rebase` puts it into this one.

use std::sync::{Mutex, PoisonError};

use flexdrill_config::Well;
use flexdrill_core::tool::Course;
use flexdrill_messages::HoleDrilled;

use crate::drilling::{SPACING as STATION, Station, Track};

/// Length of hole of a point (m).
pub const SPACING: f64 = 0.02;
/// A share of a point by which sums of advances may be off.
const ROUNDING: f64 = 1e-9;
/// Length of hole (m) that waits for the first answer of a run. Beyond it the hole is not known.
const WAITS: f64 = STATION;

/// A point: final.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Curvatures (1/m) in axes that are carried along the hole without twist: build, to the right.
    pub curvatures: [f64; 2],
    /// Whether the hole ahead was known when it was drilled.
    pub known: bool,
}

/// The points of a running twin, for a checkpoint: those that were published when it was last updated.
#[derive(Debug, Default)]
pub struct SharedPoints(Mutex<Vec<Point>>);

impl SharedPoints {
    /// Takes over the points of a hole: those that it lacks, or all of a hole that has begun again.
    pub fn update(&self, hole: &DrilledHole) {
        let mut points = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match hole.points.strip_prefix(points.as_slice()) {
            Some(new) => points.extend_from_slice(new),
            None => points.clone_from(&hole.points),
        }
    }

    /// A copy of them.
    pub fn get(&self) -> Vec<Point> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A message without its header, with the ticks of the means that its answer is for.
pub type Appended = (Option<u64>, HoleDrilled);

/// An answer that a message of `twin/hole_ahead` has shown.
#[derive(Debug, Clone)]
struct Shown {
    answered: u64,
    track: Track,
}

/// The hole from the end of the configured one on.
#[derive(Debug, Clone)]
pub struct DrilledHole {
    /// End of the configured hole, and its curvatures there.
    configured: Course,
    at_bit: [f64; 2],
    /// End of the last point.
    end: Course,
    points: Vec<Point>,
    /// Length of hole since the run began (m).
    drilled: f64,
    newest: Option<Shown>,
}

impl DrilledHole {
    /// Nothing is drilled below this hole.
    pub fn new(well: &Well) -> Self {
        let configured = well.course();
        Self {
            configured,
            at_bit: [well.sections.last().map_or(0.0, |section| section.curvature()), 0.0],
            end: configured,
            points: Vec::new(),
            drilled: 0.0,
            newest: None,
        }
    }

    /// Its points.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Continues a hole whose points an earlier run has had. Returns their messages.
    pub fn continue_with(&mut self, points: &[Point]) -> Vec<Appended> {
        let because = |known: bool| {
            if known {
                ""
            } else {
                "it was not known when it was drilled"
            }
        };
        let appended = points
            .iter()
            .map(|&point| self.append(point, None, because(point.known)));
        appended.collect()
    }

    /// Takes a message of `twin/hole_ahead` at whose end a length of hole (m) was drilled since the run began: its answer with
    /// the ticks of its means where the hole ahead is known, or why it is not. Returns the points that are complete.
    pub fn grow(&mut self, drilled: f64, ahead: Result<(u64, &Track), &str>) -> Vec<Appended> {
        // The motion has begun again, and the tool is at the end of its configured hole.
        if drilled < self.drilled {
            (self.end, self.newest) = (self.configured, None);
            self.points.clear();
        }
        self.drilled = drilled;
        if let Ok((answered, track)) = ahead
            && self.newest.as_ref().is_none_or(|newest| newest.answered != answered)
        {
            self.newest = Some(Shown {
                answered,
                track: track.clone(),
            });
        }
        let mut appended = Vec::new();
        while (self.points.len() as f64 + 1.0 - ROUNDING) * SPACING <= drilled {
            let above = self.points.len() as f64 * SPACING;
            let (answered, curvatures) = match &self.newest {
                Some(newest) => (Some(newest.answered), self.turns(&newest.track, above)),
                None if drilled - above < WAITS => break,
                None => (None, None),
            };
            let because = match (ahead, answered, curvatures) {
                (_, Some(_), None) => {
                    "it is beyond the metres that an answer has: rebase the tool into the hole as drilled"
                }
                (Err(why), ..) => why,
                (Ok(_), ..) => "",
            };
            let point = Point {
                curvatures: curvatures.unwrap_or_else(|| self.last()),
                known: because.is_empty(),
            };
            appended.push(self.append(point, answered, because));
        }
        appended
    }

    /// Curvatures of the last point, or of the configured hole at the bit.
    fn last(&self) -> [f64; 2] {
        self.points.last().map_or(self.at_bit, |point| point.curvatures)
    }

    /// Mean curvatures (1/m) of a track over a point that begins at a distance ahead (m), in the axes of the end of the hole;
    /// none beyond its end.
    fn turns(&self, track: &[Station], above: f64) -> Option<[f64; 2]> {
        let stretch = (above / STATION + ROUNDING) as usize;
        let first = self.turn(track, stretch)?;
        // A point may lie in two stretches, by this share in the first.
        let share = ((stretch + 1) as f64 * STATION - above) / SPACING;
        if share >= 1.0 - ROUNDING {
            return Some(first);
        }
        let second = self.turn(track, stretch + 1)?;
        Some([0, 1].map(|axis| share * first[axis] + (1.0 - share) * second[axis]))
    }

    /// Curvatures (1/m) of a track over a stretch between two of its stations.
    ///
    /// The bit's direction may be off that of the hole's end, which the hole follows over the first stretch: a corner of
    /// some tenths of a degree within one point would be no curvature of the hole.
    fn turn(&self, track: &[Station], stretch: usize) -> Option<[f64; 2]> {
        let (from, to) = (track.get(stretch)?, track.get(stretch + 1)?.direction());
        let from = if stretch == 0 {
            self.configured.frame.column(0).into_owned().into()
        } else {
            from.direction()
        };
        // The change of a direction of length 1 is the chord of the angle.
        let change: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let chord = change.iter().map(|part| part * part).sum::<f64>().sqrt();
        let angle = 2.0 * libm::asin(0.5 * chord);
        let column = |axis: usize| self.end.frame.column(axis).into_owned();
        let along = |axis: usize| column(axis).iter().zip(change).map(|(a, b)| a * b).sum::<f64>();
        let (build, right) = (-along(2), along(1));
        let across = build.hypot(right);
        if across == 0.0 {
            return Some([0.0; 2]);
        }
        Some([build, right].map(|part| part / across * angle / STATION))
    }

    fn append(&mut self, point: Point, answered: Option<u64>, because: &str) -> Appended {
        self.end.advance(SPACING, point.curvatures);
        let number = self.points.len();
        self.points.push(point);
        let message = HoleDrilled {
            point: u32::try_from(number).unwrap_or(u32::MAX),
            length: SPACING,
            drilled: (number + 1) as f64 * SPACING,
            measured_depth: self.end.depth,
            inclination: self.end.inclination(),
            azimuth: self.end.azimuth(),
            position: self.end.position.into(),
            build: point.curvatures[0],
            right: point.curvatures[1],
            known: point.known,
            because: because.to_owned(),
            ..HoleDrilled::default()
        };
        (answered, message)
    }
}

#[cfg(test)]
mod tests {
    use flexdrill_config::Config;

    use super::*;

    fn config() -> Config {
        Config::from_text("tool.yaml", include_str!("../../../../../tests/data/ahead.yaml")).unwrap()
    }

    /// An answer in closed form: an arc of a curvature (1/m) from a direction (rad) on.
    fn arc(first: f64, curvature: f64) -> Track {
        let station = |station: u32| Station {
            inclination: first + curvature * STATION * f64::from(station),
            azimuth: 0.0,
            position: [0.0; 3],
        };
        (0..=20).map(station).collect()
    }

    /// The hole follows the answers: its inclination at the end of each stretch of 0.25 m is that of the answer, the bit's
    /// first direction included. Sums of some hundred points round to 1e-13.
    #[test]
    fn the_hole_has_the_inclinations_of_the_answers() {
        let config = config();
        let at_bit = config.well.course().inclination();
        let answer = arc(at_bit - 0.01, 0.3);
        let mut hole = DrilledHole::new(&config.well);
        let mut appended = Vec::new();
        for metre in 1..=200 {
            appended.extend(hole.grow(0.01 * f64::from(metre), Ok((7, &answer))));
        }
        assert_eq!(appended.len(), 100);
        let end = |index: usize| &appended[index].1;
        assert!(
            appended
                .iter()
                .all(|(answered, message)| *answered == Some(7) && message.known)
        );
        // 1.5 m are 75 points; 2 m are 100.
        for (index, metres) in [(74, 1.5), (99, 2.0)] {
            let expected = at_bit - 0.01 + 0.3 * metres;
            assert!((end(index).inclination - expected).abs() < 1e-12, "{:?}", end(index));
            assert!((end(index).measured_depth - config.well.length() - metres).abs() < 1e-12);
        }
        // The first direction is followed over 0.25 m: the points there build less.
        assert!((end(5).build - (0.3 - 0.01 / 0.25)).abs() < 1e-12 && (end(20).build - 0.3).abs() < 1e-12);
        // Positions are those of the same points in a configuration.
        assert_eq!(<[f64; 3]>::from(hole.end.position), end(99).position);
    }

    #[test]
    fn points_never_change_and_wait_for_the_first_answer() {
        let config = config();
        let (soft, stiff) = (arc(0.35, 0.31), arc(0.35, 0.25));
        let mut hole = DrilledHole::new(&config.well);
        assert!(hole.grow(0.05, Err("being computed")).is_empty());
        let first = hole.grow(0.07, Ok((1, &soft)));
        assert_eq!(first.len(), 3);
        let before = hole.points().to_vec();
        // An answer that is not shown for a moment leaves its curvature in force, and the point says so.
        let [(answered, unknown)] = &hole.grow(0.08, Err("the weight has changed"))[..] else {
            panic!()
        };
        assert!(*answered == Some(1) && !unknown.known && unknown.because == "the weight has changed");
        let _ = hole.grow(0.6, Ok((2, &stiff)));
        assert_eq!(hole.points()[..3], before[..]);
        assert!((hole.points()[25].curvatures[0] - 0.25).abs() < 1e-12);
        // A bit that makes no hole makes no point; a motion that begins again begins a hole.
        assert!(hole.grow(0.6, Ok((2, &stiff))).is_empty());
        let again = hole.grow(0.02, Ok((2, &stiff)));
        assert_eq!((again.len(), again[0].1.point, hole.points().len()), (1, 0, 1));
    }

    #[test]
    fn a_hole_without_an_answer_is_the_configured_one_and_says_so() {
        let config = config();
        let mut hole = DrilledHole::new(&config.well);
        let appended = hole.grow(0.3, Err("the bit is held by the last link"));
        assert_eq!(appended.len(), 3, "the last quarter of a metre waits");
        assert!(
            appended
                .iter()
                .all(|(_, message)| !message.known && message.because.starts_with("the bit is"))
        );
        assert!((appended[0].1.build - 0.3125).abs() < 1e-12);
    }

    /// Another run continues the hole with the points of this one.
    #[test]
    fn a_hole_continues_with_its_points() {
        let config = config();
        let answer = arc(0.36, 0.3);
        let mut whole = DrilledHole::new(&config.well);
        let mut all = whole.grow(0.2, Ok((1, &answer)));
        let mut later = DrilledHole::new(&config.well);
        assert_eq!(later.continue_with(whole.points()).len(), 10);
        all.extend(whole.grow(0.4, Ok((1, &answer))));
        assert_eq!(later.grow(0.4, Ok((1, &answer))), all[10..]);
    }
}
