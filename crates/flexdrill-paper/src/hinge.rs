//! Fig. 9: deflection of the joint of a hinged beam in a tube under a growing load, numerical against closed forms.

use super::PaperError;
use flexdrill_core::tool::{Body, Direction};
use flexdrill_verify::{CaseTwin, HingedBeam};

/// The case `hinged_beam_in_tube` of `flexdrill verify`, over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Hinge {
    /// The beam.
    pub beam: HingedBeam,
    /// Time (s).
    pub time: Vec<f64>,
    /// Load (N): 1000 N/s, as the paper's.
    pub load: Vec<f64>,
    /// Computed deflection (m).
    pub numerical: Vec<f64>,
}

/// Rate of the load (N/s).
const RATE: f64 = 1000.0;
/// Steps between two points.
const EVERY: u64 = 20;
/// Time before the first error is counted (s): the load starts suddenly, and the deflection that the error is relative
/// to is then as small as the beam's swing.
const FIRST: f64 = 0.02;

impl Hinge {
    /// Runs the case; some seconds.
    ///
    /// # Errors
    /// When it cannot be built or a step fails.
    pub fn run() -> Result<Self, PaperError> {
        let mut twin = CaseTwin::new("hinged_beam_in_tube")?;
        let joint = twin.simulation.joint_stations()[0];
        let end = 0.8;
        let mut out = Self {
            beam: HingedBeam::of(&twin),
            time: Vec::new(),
            load: Vec::new(),
            numerical: Vec::new(),
        };
        while twin.time() < end {
            twin.step()?;
            if twin.simulation.step().is_multiple_of(EVERY) {
                out.time.push(twin.time());
                out.load.push(RATE * twin.time());
                out.numerical.push(twin.displacement(joint, Body::Pipe, Direction::W));
            }
        }
        Ok(out)
    }

    /// Error against the corrected closed form relative to it, per point; from 0.02 s on.
    pub fn errors(&self) -> impl Iterator<Item = (f64, f64)> {
        let points = self.time.iter().zip(&self.load).zip(&self.numerical);
        points
            .filter(|((time, _), _)| **time >= FIRST)
            .map(|((&time, &load), &got)| {
                let expected = self.beam.corrected(load);
                (time, (got - expected) / expected)
            })
    }

    /// Largest error against the corrected form, and largest difference to the printed one, both over the largest
    /// deflection.
    pub fn worst(&self) -> (f64, f64) {
        let over = |form: &dyn Fn(f64) -> f64| {
            let points = self.load.iter().zip(&self.numerical);
            points.fold(0.0_f64, |worst, (&load, &got)| worst.max((got - form(load)).abs())) / self.beam.gap
        };
        (
            over(&|load| self.beam.corrected(load)),
            over(&|load| self.beam.printed(load)),
        )
    }
}
