//! What a step changes: displacements, velocities, accelerations, multipliers.

use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::elements::joint::Rotations;
use crate::model::{Model, Station};

/// How far a span deflects, see [`State::deflection`].
pub type Deflection = [[f64; 16]; 2];

/// Friction that is held at a station, see [`State::held_friction`].
pub type HeldFriction = [[f64; 2]; 2];

/// State at one instant, in the model's numbering: q_rd of Eq. 19 station by station, with the multipliers. Multiplier
/// slots of `q` hold scaled multipliers; their velocity and acceleration are zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Displacements, spins, tilts, multipliers: q_rd of Eq. 19 and lambda of Eq. 18, station by station.
    pub q: Vec<f64>,
    /// Velocities (m/s, rad/s) in the same numbering.
    pub v: Vec<f64>,
    /// Accelerations (m/s2, rad/s2) in the same numbering.
    pub a: Vec<f64>,
    /// Accelerations that the time scheme lets lag behind `a`, see [`Scheme`](crate::dynamics::scheme::Scheme).
    pub lagged: Vec<f64>,
    /// Step size (s) that `lagged` is for; 0 before the first step.
    pub scheme_step: f64,
    /// Axial force of each pipe element (N) that its geometric stiffness has, under pressure the effective tension, partly
    /// foreseen: see
    /// [`Scheme`](crate::dynamics::scheme::Scheme).
    pub pipe_axial: Vec<f64>,
    /// The same for the guide.
    pub guide_axial: Vec<f64>,
    /// How far each span of a chain deflects between its ends under what acts inside it: lateral deflection
    /// (m) of each station but the first in its station's frame, y in 0..8 and z in 8..16, of pipe and guide.
    pub deflection: Vec<Deflection>,
    /// Moment with which slipping pins of each joint resist about either axis of its cross (N m), by the forces at the
    /// start of the last step.
    pub pin_moments: Vec<f64>,
    /// Friction that each station holds by an elastic slip, of pipe and guide and of guide and wall, around and along (N);
    /// zero where nothing touches. Empty where no friction holds.
    pub held_friction: Vec<HeldFriction>,
    /// Model time (s).
    pub time: f64,
    /// Angle of the drive (rad) as prescribed at this time.
    pub drive_angle: f64,
}

impl State {
    /// At rest and undeflected.
    pub(crate) fn at_rest(model: &Model) -> Self {
        let n = model.unknowns();
        Self {
            q: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            lagged: vec![0.0; n],
            scheme_step: 0.0,
            pipe_axial: vec![0.0; model.pipe.len()],
            guide_axial: vec![0.0; model.guide.len()],
            deflection: Vec::new(),
            pin_moments: vec![0.0; model.joints.len()],
            held_friction: held_friction(model),
            time: 0.0,
            drive_angle: 0.0,
        }
    }

    /// Takes another state's values without allocating.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.q.copy_from_slice(&other.q);
        self.v.copy_from_slice(&other.v);
        self.a.copy_from_slice(&other.a);
        self.lagged.copy_from_slice(&other.lagged);
        self.scheme_step = other.scheme_step;
        self.pipe_axial.copy_from_slice(&other.pipe_axial);
        self.guide_axial.copy_from_slice(&other.guide_axial);
        self.deflection.copy_from_slice(&other.deflection);
        self.pin_moments.copy_from_slice(&other.pin_moments);
        self.held_friction.copy_from_slice(&other.held_friction);
        self.time = other.time;
        self.drive_angle = other.drive_angle;
    }
}

/// Stations that hold no friction yet; none where no friction holds.
pub(crate) fn held_friction(model: &Model) -> Vec<HeldFriction> {
    let stations = if model.description.holds_friction() {
        model.stations.len()
    } else {
        0
    };
    vec![[[0.0; 2]; 2]; stations]
}

/// Eq. 20: lateral position (y, z) of the pipe relative to the guide, offset included (m).
#[inline]
pub fn inner_lateral(station: &Station, state: &State) -> Vector2<f64> {
    let pipe = station.pipe_to_station * translation(&state.q, station.pipe_above);
    station.offset + Vector2::new(pipe.y - state.q[station.guide + 1], pipe.z - state.q[station.guide + 2])
}

/// Gap (m, negative is penetration) at the lateral displacement (y, z) within `clearance`, Eq. 27 and 31.
pub fn gap(lateral: Vector2<f64>, clearance: f64) -> f64 {
    clearance - lateral.norm()
}

/// Displacement of a node.
#[inline]
pub fn translation(values: &[f64], first: usize) -> Vector3<f64> {
    Vector3::new(values[first], values[first + 1], values[first + 2])
}

/// The six rotational values of joint `joint`.
#[inline]
pub fn joint_rotations(model: &Model, joint: usize, values: &[f64]) -> Rotations {
    let station = &model.stations[model.joint_stations[joint]];
    let (a, b) = (station.pipe_above, station.pipe_below);
    [
        values[a + 3],
        values[a + 4],
        values[a + 5],
        values[b + 3],
        values[b + 4],
        values[b + 5],
    ]
}
