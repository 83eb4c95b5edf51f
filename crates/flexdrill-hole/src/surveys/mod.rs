//! What surveys say of the hole and of the tool: a filter in depth.
//!
//! In each of two planes, that of the build and the one across it, the hole has an angle theta and turns by the curvature of
//! a model plus a correction b, which wanders:
//!
//! ```text
//! theta' = k(s) + b + q_t white,   b' = q_b white
//! over ds:  F = [1 ds; 0 1],   Q = [q_t2 ds + q_b2 ds3/3, q_b2 ds2/2; q_b2 ds2/2, q_b2 ds]
//! survey:   z = theta + noise,   K = P H'/(P_11 + r)  with H = [1 0]
//! ```
//!
//! b has what inclinations cannot separate: lateral resistance of the bit, shape and stiffness of the guide, hole
//! size, dip of the rock. Two rules are for the beginning of a run, in which the hole turns from the curvature of the last tool
//! to that of this one: surveys of the first [`PlaneModel::settling`] metres correct the angle only, and b wanders
//! [`PlaneModel::beginning_factor`] times as much over the first [`PlaneModel::beginning`] metres.
//!
//! Angles: that of the build is the inclination. That across it is the angle between the hole and the vertical plane in which
//! the run began, to the right above 0: sin(angle) = sin(inclination) sin(azimuth - azimuth of the plane). Its rate is the
//! curvature to the right, at any inclination.

mod plane;

use flexdrill_base::validation::{Bound, ValidationError};

pub use plane::{PlaneModel, PlaneState};

/// Metres behind the bit over which surveys may come late.
pub const KEPT: f64 = 20.0;

/// Depth below the window of the casing (m) down to which the casing disturbs a magnetic tool. An assumption.
const NEAR_CASING: f64 = 10.0;

/// Standard deviation of an inclination where none is given (rad): 0.2 deg.
pub const USUAL_INCLINATION_DEVIATION: f64 = 0.2 * std::f64::consts::PI / 180.0;

/// Standard deviation of the azimuth of a magnetic tool where none is given (rad), at a depth below the window (m): 5 deg down
/// to 10 m, where the casing disturbs it, and 1 deg below. A gyro has 0.5 deg.
pub fn usual_azimuth_deviation(depth: f64) -> f64 {
    if depth < NEAR_CASING {
        5.0_f64.to_radians()
    } else {
        1.0_f64.to_radians()
    }
}

/// One value for the plane of the build, and one across it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planes<T> {
    /// In the plane of the build, towards the high side.
    pub build: T,
    /// Across it, to the right.
    pub right: T,
}

/// A survey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// Measured depth (m).
    pub depth: f64,
    /// Inclination (rad).
    pub inclination: f64,
    /// Its standard deviation (rad).
    pub inclination_deviation: f64,
    /// Azimuth with its standard deviation (rad); none of a tool that measures inclinations alone.
    pub azimuth: Option<[f64; 2]>,
}

/// Where a run of one tool begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunStart {
    /// Measured depth (m).
    pub depth: f64,
    /// Inclination of the hole (rad).
    pub inclination: f64,
    /// Azimuth of the plane in which the tool builds (rad).
    pub azimuth: f64,
    /// Standard deviation of both directions of the hole (rad).
    pub deviation: f64,
}

/// A piece of the run with the curvature of the model.
#[derive(Debug, Clone, Copy)]
struct Piece {
    /// Measured depth of its end (m).
    end: f64,
    curvature: Planes<f64>,
}

/// Both planes at a depth.
#[derive(Debug, Clone, Copy)]
struct Snapshot {
    depth: f64,
    planes: Planes<PlaneState>,
}

/// The filter of a run.
#[derive(Debug, Clone)]
pub struct SurveyFilter {
    models: Planes<PlaneModel>,
    start: RunStart,
    /// The state that late surveys are filtered from.
    base: Snapshot,
    now: Snapshot,
    /// Pieces below the base, from above.
    pieces: Vec<Piece>,
    /// Surveys at and below the base, by depth.
    surveys: Vec<Survey>,
    /// Surveys so far.
    used: usize,
    /// Those of them that corrected the curvature.
    learnt: usize,
}

impl SurveyFilter {
    /// A filter where a run begins.
    ///
    /// # Errors
    /// [`ValidationError`] with the first number out of bounds.
    pub fn begin(models: Planes<PlaneModel>, start: RunStart) -> Result<Self, ValidationError> {
        models.build.check()?;
        models.right.check()?;
        Bound::Finite.check("run.depth", start.depth, "m")?;
        Bound::Within(0.0, std::f64::consts::PI).check("run.inclination", start.inclination, "rad")?;
        Bound::Finite.check("run.azimuth", start.azimuth, "rad")?;
        Bound::Positive.check("run.deviation", start.deviation, "rad")?;
        let plane = |model: &PlaneModel, angle: f64| PlaneState {
            angle,
            correction: 0.0,
            covariance: [start.deviation.powi(2), 0.0, model.correction.powi(2)],
        };
        let begin = Snapshot {
            depth: start.depth,
            planes: Planes {
                build: plane(&models.build, start.inclination),
                right: plane(&models.right, 0.0),
            },
        };
        Ok(Self {
            models,
            start,
            base: begin,
            now: begin,
            pieces: Vec::new(),
            surveys: Vec::new(),
            used: 0,
            learnt: 0,
        })
    }

    /// The bit has drilled to a measured depth (m), over which the model has a curvature (1/m).
    ///
    /// # Errors
    /// [`ValidationError`] for a depth that is not below the last one, or a curvature that is not finite.
    pub fn drilled_to(&mut self, depth: f64, curvature: Planes<f64>) -> Result<(), ValidationError> {
        Bound::Over(self.now.depth).check("drilled.depth", depth, "m")?;
        Bound::Finite.check_all(
            "drilled.curvature",
            &[("build", curvature.build), ("right", curvature.right)],
            "1/m",
        )?;
        let piece = Piece { end: depth, curvature };
        self.now = self.moved(self.now, depth, piece.curvature);
        self.pieces.push(piece);
        // The base takes in what is too far above the bit for late surveys.
        let settled = self.pieces.partition_point(|piece| piece.end <= depth - KEPT);
        if let Some(last) = settled.checked_sub(1) {
            let end = self.pieces[last].end;
            let known = self.surveys.partition_point(|survey| survey.depth < end);
            self.base = self.filtered(self.base, &self.pieces[..settled], &self.surveys[..known]);
            self.pieces.drain(..settled);
            self.surveys.drain(..known);
        }
        Ok(())
    }

    /// A survey at or above the bit, late by at most [`KEPT`].
    ///
    /// # Errors
    /// [`ValidationError`] for a depth above the run or below the bit or above what is kept, an inclination outside 0 to pi, an
    /// azimuth that is not finite, or a standard deviation that is not above 0. The state is then as before.
    pub fn survey(&mut self, survey: Survey) -> Result<(), ValidationError> {
        Bound::Within(self.base.depth, self.now.depth).check("survey.depth", survey.depth, "m")?;
        Bound::Within(0.0, std::f64::consts::PI).check("survey.inclination", survey.inclination, "rad")?;
        Bound::Positive.check("survey.inclination_deviation", survey.inclination_deviation, "rad")?;
        if let Some([azimuth, deviation]) = survey.azimuth {
            Bound::Finite.check("survey.azimuth", azimuth, "rad")?;
            Bound::Positive.check("survey.azimuth_deviation", deviation, "rad")?;
        }
        let place = self.surveys.partition_point(|known| known.depth <= survey.depth);
        self.surveys.insert(place, survey);
        self.used += 1;
        self.learnt += usize::from(survey.depth - self.start.depth >= self.models.build.settling);
        self.now = self.filtered(self.base, &self.pieces, &self.surveys);
        Ok(())
    }

    /// A state through pieces with the surveys above and at their end.
    fn filtered(&self, mut at: Snapshot, pieces: &[Piece], mut surveys: &[Survey]) -> Snapshot {
        for piece in pieces {
            let above = surveys.partition_point(|survey| survey.depth < piece.end);
            for survey in &surveys[..above] {
                at = self.corrected(self.moved(at, survey.depth, piece.curvature), survey);
            }
            surveys = &surveys[above..];
            at = self.moved(at, piece.end, piece.curvature);
        }
        surveys.iter().fold(at, |at, survey| self.corrected(at, survey))
    }

    /// A state at another depth (m) below it, over which the model has a curvature.
    fn moved(&self, at: Snapshot, depth: f64, curvature: Planes<f64>) -> Snapshot {
        let (drilled, length) = (at.depth - self.start.depth, depth - at.depth);
        let of = |model: &PlaneModel, state, curvature: f64| model.drilled(state, drilled, length, curvature * length);
        Snapshot {
            depth,
            planes: Planes {
                build: of(&self.models.build, at.planes.build, curvature.build),
                right: of(&self.models.right, at.planes.right, curvature.right),
            },
        }
    }

    /// A state after a survey at its depth.
    fn corrected(&self, mut at: Snapshot, survey: &Survey) -> Snapshot {
        let drilled = survey.depth - self.start.depth;
        let measured = self.angles(survey);
        let [angle, variance] = measured.build;
        at.planes.build = at
            .planes
            .build
            .measured(angle, variance, drilled >= self.models.build.settling);
        if let Some([angle, variance]) = measured.right {
            at.planes.right = at
                .planes
                .right
                .measured(angle, variance, drilled >= self.models.right.settling);
        }
        at
    }

    /// The angles of a survey with their variances.
    fn angles(&self, survey: &Survey) -> Measured {
        let sine = survey.inclination.sin();
        let own = survey.inclination_deviation.powi(2);
        Measured {
            build: [survey.inclination, own],
            // Near the vertical an azimuth says little of where the hole points, but never more than the inclination does.
            right: survey.azimuth.map(|[azimuth, deviation]| {
                [
                    (sine * (azimuth - self.start.azimuth).sin()).asin(),
                    (sine * deviation).powi(2) + own,
                ]
            }),
        }
    }

    /// Measured depth of the bit (m).
    pub const fn depth(&self) -> f64 {
        self.now.depth
    }

    /// Both planes at the bit.
    pub const fn at_bit(&self) -> Planes<PlaneState> {
        self.now.planes
    }

    /// Surveys used.
    pub const fn used(&self) -> usize {
        self.used
    }

    /// Those of them that corrected the curvature too.
    pub const fn learnt(&self) -> usize {
        self.learnt
    }

    /// Both planes below the bit, after each step of a length (m) over which the model has a curvature (1/m).
    ///
    /// # Errors
    /// [`ValidationError`] for a length that is not above 0, or a curvature that is not finite.
    pub fn forecast(&self, step: f64, curvatures: &[Planes<f64>]) -> Result<Vec<Planes<PlaneState>>, ValidationError> {
        Bound::Positive.check("forecast.step", step, "m")?;
        let mut at = self.now;
        let mut states = Vec::with_capacity(curvatures.len());
        for curvature in curvatures {
            Bound::Finite.check_all(
                "forecast.curvature",
                &[("build", curvature.build), ("right", curvature.right)],
                "1/m",
            )?;
            at = self.moved(at, at.depth + step, *curvature);
            states.push(at.planes);
        }
        Ok(states)
    }

    /// Angles of a hole that is as likely as the filter says (rad): at the bit, and after each of some steps of a length (m)
    /// over which the model does not turn it. `normal` gives independent standard normal numbers.
    ///
    /// # Errors
    /// [`ValidationError`] for a length that is not above 0.
    pub fn plausible(
        &self,
        step: f64,
        steps: usize,
        mut normal: impl FnMut() -> f64,
    ) -> Result<Vec<Planes<f64>>, ValidationError> {
        Bound::Positive.check("plausible.step", step, "m")?;
        let mut drawn = |at: Planes<PlaneState>| Planes {
            build: at.build.drawn([normal(), normal()]),
            right: at.right.drawn([normal(), normal()]),
        };
        let straight = Planes { build: 0.0, right: 0.0 };
        let mut at = self.now;
        let mut angles = Vec::with_capacity(steps + 1);
        for index in 0..=steps {
            if index > 0 {
                at = self.moved(at, at.depth + step, straight);
            }
            at.planes = drawn(at.planes);
            angles.push(Planes {
                build: at.planes.build.angle,
                right: at.planes.right.angle,
            });
        }
        Ok(angles)
    }
}

/// Angle (rad) and variance (rad2) of a survey in both planes.
struct Measured {
    build: [f64; 2],
    right: Option<[f64; 2]>,
}
