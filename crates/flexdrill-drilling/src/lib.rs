//! Where the tool of a configuration drills in the next metres, and how far that is known: one tool, and plausible ones.
//!
//! # Layout
//! - [`tool`]: guide, bit and hole of a configuration; [`loads`]: its loads.
//! - [`unknowns`]: what is not known, and plausible tools drawn from it.
//! - [`plan`]: a planned hole and the distance to it.
//! - [`surveys`]: surveys of the hole; [`learnt`]: what they correct. [`table`]: tables of both.
//! - [`to_plan`]: the next metres against a plan, and the weight that brings the hole back; [`weights`]: those to choose from.
//! - [`range`]: what the guide drills in a long arc, and what with no bit; [`words`]: the same in words.

pub mod learnt;
pub mod loads;
pub mod plan;
pub mod range;
pub mod surveyed_hole;
pub mod surveys;
pub mod table;
pub mod to_plan;
pub mod tool;
pub mod unknowns;
pub mod weights;
pub mod words;

use flexdrill_hole::{HoleError, Propagation, RIPPLE_THRESHOLD, Steady};

pub use flexdrill_base::Band;
pub use learnt::Learnt;
pub use plan::Plan;
pub use tool::{Drilling, Refusal, SPACING};

/// Weight at the bit where none is given (N).
pub const USUAL_WEIGHT: f64 = 10e3;
/// Length ahead where none is given (m).
pub const USUAL_LENGTH: f64 = 5.0;

/// Stations of the next metre.
pub const NEXT_METRE: usize = (1.0 / SPACING) as usize;
/// Sine of the inclination below which an azimuth says nothing: 3 deg from the vertical.
pub const STEEP: f64 = 0.052;

/// The bit at a depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Inclination of the hole (rad).
    pub inclination: f64,
    /// Azimuth of the hole (rad).
    pub azimuth: f64,
    /// Position from the kick-off (m): along azimuth 0, to the right of it, down.
    pub position: [f64; 3],
}

impl Station {
    /// Direction of the hole (of length 1): along azimuth 0, to the right of it, down.
    pub fn direction(&self) -> [f64; 3] {
        plan::tangent(self.inclination, self.azimuth)
    }
}

/// The stations of a tool, from the bit on.
pub type Track = Vec<Station>;

/// Where the members are at a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Inclination (rad).
    pub inclination: Band,
    /// Azimuth (rad), continuous at that of the nominal tool.
    pub azimuth: Band,
    /// Distance from the nominal position towards the high side (m).
    pub high: Band,
    /// The same to the right (m).
    pub right: Band,
}

/// What a guide drills to in a long arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Long {
    /// Curvature (1/m).
    pub curvature: f64,
    /// Length between bit and wall (m).
    pub free_length: f64,
    /// P: lateral resistance of the bit against that of the guide.
    pub steering_number: f64,
}

impl Long {
    /// Whether the hole ripples.
    pub fn ripples(&self) -> bool {
        self.steering_number < RIPPLE_THRESHOLD
    }
}

impl From<Steady> for Long {
    fn from(steady: Steady) -> Self {
        Self {
            curvature: steady.curvature,
            free_length: steady.free_length,
            steering_number: steady.steering_number,
        }
    }
}

/// Drills to some stations ahead; the first is the bit.
///
/// # Errors
/// When the statics of the guide have no solution.
pub fn drill(drilling: &Drilling, stations: usize) -> Result<Track, HoleError> {
    let (guide, law, hole) = (drilling.guide, drilling.law, drilling.hole.clone());
    let (mut propagation, start) = Propagation::begin(guide, law, hole, drilling.chord())?;
    let station = |at: flexdrill_hole::Advance| Station {
        inclination: at.inclination,
        azimuth: at.azimuth,
        position: [at.position.x, at.position.y, at.position.z],
    };
    let mut track = vec![station(start)];
    for _ in 0..stations {
        let mut last = None;
        for _ in 0..drilling.chords {
            last = Some(propagation.advance()?);
        }
        track.extend(last.map(station));
    }
    Ok(track)
}

/// The angle nearest to 0 that is the same direction (rad).
pub fn turned(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}

/// Unit vectors across the hole at a station: to the high side and to the right.
pub fn across(at: &Station) -> [[f64; 3]; 2] {
    let (sine, cosine) = libm::sincos(at.inclination);
    let (east, north) = libm::sincos(at.azimuth);
    [[cosine * north, cosine * east, -sine], [-east, north, 0.0]]
}

/// Component of the way from one position to another along a unit vector (m).
pub fn along(from: [f64; 3], to: [f64; 3], unit: [f64; 3]) -> f64 {
    (0..3).map(|axis| (to[axis] - from[axis]) * unit[axis]).sum()
}

/// Inclination half of the way ahead (rad).
pub fn middle_inclination(track: &[Station]) -> f64 {
    track.get(track.len() / 2).map_or(0.0, |at| at.inclination)
}

/// Where the members are at each station of the nominal tool.
pub fn spread(nominal: &[Station], members: &[Result<Track, String>]) -> Vec<Spread> {
    let known: Vec<&Track> = members.iter().flatten().collect();
    let at_station = |(index, nominal): (usize, &Station)| {
        let band = |of: &dyn Fn(&Station) -> f64| Band::of(known.iter().map(|track| of(&track[index])).collect());
        let [high, right] = across(nominal);
        Some(Spread {
            inclination: band(&|at: &Station| at.inclination)?,
            azimuth: band(&|at: &Station| nominal.azimuth + turned(at.azimuth - nominal.azimuth))?,
            high: band(&|at: &Station| along(nominal.position, at.position, high))?,
            right: band(&|at: &Station| along(nominal.position, at.position, right))?,
        })
    };
    nominal.iter().enumerate().filter_map(at_station).collect()
}

/// Turn of the hole per metre over some stations from the bit on (rad/m): the change of its inclination.
pub fn build(track: &[Station], stations: usize) -> f64 {
    let last = stations.min(track.len().saturating_sub(1)).max(1);
    match (track.first(), track.get(last)) {
        (Some(first), Some(last_station)) => (last_station.inclination - first.inclination) / (last as f64 * SPACING),
        _ => f64::NAN,
    }
}

/// Angle between the directions at both ends of the next metre, per metre (1/m).
pub fn curvature(track: &[Station]) -> f64 {
    let ends = (track.first(), track.get(NEXT_METRE));
    let (Some(from), Some(to)) = ends else { return f64::NAN };
    // Components of the later direction across the earlier one, and along it.
    let dot = |a: [f64; 3], b: [f64; 3]| a.into_iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let [high, right] = across(from).map(|unit| dot(unit, to.direction()));
    libm::atan2(high.hypot(right), dot(from.direction(), to.direction())) / (NEXT_METRE as f64 * SPACING)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_near_north_are_near_each_other() {
        assert!((turned(-6.2) - (std::f64::consts::TAU - 6.2)).abs() < 1e-12);
        assert_eq!(turned(0.5), 0.5);
    }
}
