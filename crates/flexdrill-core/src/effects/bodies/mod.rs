//! Rigid bodies on nodes: point masses, and what the tool ends in. Their [law] is [`PointBody`]; their diagonal masses are data of
//! the nodes, and what couples the directions of a node (unbalance, gyroscopic moments, the turning weight) acts here.

mod law;

use nalgebra::{Matrix3, Vector3};

use crate::chain::{Additions, Chain, Effect, Precision, Under};
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::tool::{Body, PointMass};

use law::{NodeMotion, PointBody};

/// A body, where its node is in a numbering.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnNode {
    pub body: PointBody,
    /// Gravity along the node's axes (m/s2).
    pub gravity: [f64; 3],
    /// Unknowns of the node, (u, v, w, psi, phi_y, phi_z).
    pub places: [usize; 6],
}

/// All bodies of a tool.
#[derive(Debug, Clone)]
pub(crate) struct Bodies {
    list: Vec<OnNode>,
    /// Their weight, along the world axes (N).
    weight: Vector3<f64>,
}

/// A described body, where its node is in the numbering of the model.
struct Described {
    mass: PointMass,
    /// Unknown of the node's u.
    unknown: usize,
    /// Gravity along the node's axes (m/s2).
    gravity: Vector3<f64>,
    /// The node's axes, columns in the world.
    frame: Matrix3<f64>,
}

/// The bodies of the description.
fn described(model: &Model) -> Vec<Described> {
    let d = &model.description;
    let mut found = Vec::new();
    for mass in d.bodies() {
        let nodes = model.nodes("masses", mass.location, mass.body, false);
        // `ToolDescription::check_at_nodes` refuses such a mass with its field before a model is built of it.
        debug_assert!(nodes.is_ok(), "{nodes:?}");
        for unknown in nodes.into_iter().flatten() {
            let station = &model.stations[model.layout.station_of(unknown)];
            // Gravity in the frame of the body's node, where its eccentricity is given.
            let frame = match mass.body {
                Body::Guide => station.frame,
                Body::Pipe => station.frame * station.pipe_to_station,
            };
            found.push(Described {
                mass,
                unknown,
                gravity: frame.transpose() * (Vector3::z() * d.gravity),
                frame: model.node_of(unknown).2,
            });
        }
    }
    found
}

/// The masses (kg, kg m2) that bodies add to the six directions of nodes, with the node's first unknown in the model.
pub(crate) fn at_nodes(model: &Model) -> impl Iterator<Item = (usize, [f64; 6])> + use<> {
    described(model)
        .into_iter()
        .map(|at| (at.unknown, PointBody::of(&at.mass).diagonal()))
}

impl PointBody {
    /// That of the description.
    fn of(mass: &PointMass) -> Self {
        Self {
            mass: mass.mass,
            axial_inertia: mass.axial_inertia,
            transverse_inertia: mass.transverse_inertia,
            eccentricity: mass.eccentricity,
            phase: mass.eccentricity_phase,
        }
    }
}

/// Displacements, velocities and accelerations of a node.
struct Motion {
    q: [f64; 6],
    v: [f64; 6],
    a: [f64; 6],
}

impl Motion {
    fn as_node(&self) -> NodeMotion<'_> {
        NodeMotion {
            q: &self.q,
            v: &self.v,
            a: &self.a,
        }
    }
}

impl OnNode {
    fn motion(&self, state: &State) -> Motion {
        Motion {
            q: self.places.map(|unknown| state.q[unknown]),
            v: self.places.map(|unknown| state.v[unknown]),
            a: self.places.map(|unknown| state.a[unknown]),
        }
    }

    /// Derivative of the forces that couple the node's directions, by columns, with `alpha` (1/s) of Eq. 7 and the factors
    /// of stiffness, damping and mass.
    pub(crate) fn coupled_tangent(&self, state: &State, alpha: f64, factors: [f64; 3]) -> [[f64; 6]; 6] {
        let moving = self.motion(state);
        self.body
            .coupled_tangent(moving.as_node(), alpha, self.gravity, factors)
    }
}

impl Bodies {
    /// Those of `model`; `None` for a tool without any.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        Self::at(model, |unknown| chain.place(unknown))
    }

    /// The same in another numbering, by the `place` of the model's unknowns in it.
    pub(crate) fn at(model: &Model, place: impl Fn(usize) -> Option<usize>) -> Option<Self> {
        let described = described(model);
        let on_node = |at: &Described| {
            let mut places = [0; 6];
            for (k, to) in places.iter_mut().enumerate() {
                *to = place(at.unknown + k)?;
            }
            Some(OnNode {
                body: PointBody::of(&at.mass),
                gravity: at.gravity.into(),
                places,
            })
        };
        let list: Vec<OnNode> = described.iter().filter_map(on_node).collect();
        // The chain has a node at every station that has a body (`at_nodes`), and no unknown of such a node follows from others:
        // a body that is left out here would count in the weight without acting.
        debug_assert_eq!(list.len(), described.len(), "bodies without a node");
        let weights = described.iter().map(|at| at.frame * at.gravity * at.mass.mass);
        (!list.is_empty()).then_some(Self {
            weight: weights.sum(),
            list,
        })
    }

    /// Those with forces beyond the diagonal masses.
    pub(crate) fn coupled(&self) -> impl Iterator<Item = &OnNode> {
        self.list.iter().filter(|at| at.body.is_coupled())
    }

    /// Adds inertia, damping with `alpha` (1/s), and weight to `residual`, on nodes whose first unknown is `wanted`.
    pub(crate) fn add_forces(&self, residual: &mut [f64], state: &State, alpha: f64, wanted: impl Fn(usize) -> bool) {
        for at in self.list.iter().filter(|at| wanted(at.places[0])) {
            for (k, inertia) in at.body.diagonal().into_iter().enumerate() {
                let u = at.places[k];
                let gravity = if k < 3 { at.gravity[k] } else { 0.0 };
                residual[u] += inertia * (state.a[u] + alpha * state.v[u] - gravity);
            }
            if at.body.is_coupled() {
                let moving = at.motion(state);
                let forces = at.body.coupled_forces(moving.as_node(), alpha, at.gravity);
                at.places
                    .iter()
                    .zip(forces)
                    .for_each(|(&u, force)| residual[u] += force);
            }
        }
    }

    /// Adds kinetic energy, inertia, damping with `alpha` (1/s), and what their weight has worked so far to `point`.
    pub(crate) fn add_to(&self, point: &mut LedgerPoint, state: &State, alpha: f64) {
        for at in &self.list {
            let moving = at.motion(state);
            let moving = moving.as_node();
            point.sums.kinetic += at.body.kinetic_energy(moving);
            let inertia = at.body.coupled_forces(moving, 0.0, [0.0; 3]);
            let damped = at.body.coupled_forces(moving, alpha, [0.0; 3]);
            let [damping, inertial] = point.at_nodes();
            for (k, mass) in at.body.diagonal().into_iter().enumerate() {
                let u = at.places[k];
                inertial[u] += mass * state.a[u] + inertia[k];
                damping[u] += alpha * mass * state.v[u] + (damped[k] - inertia[k]);
            }
            // An eccentric mass falls with its node and by its turning.
            let offset = at.body.offset(moving.q);
            let down = (0..3).map(|k| at.gravity[k] * (moving.q[k] + offset[k]));
            point.sums.fallen += at.body.mass * down.sum::<f64>();
        }
    }
}

impl Effect for Bodies {
    fn weight(&self) -> Vector3<f64> {
        self.weight
    }

    fn at_nodes(&self, residual: &mut [f64], state: &State, under: &Under<'_>, wanted: &impl Fn(usize) -> bool) {
        self.add_forces(residual, state, under.conditions.rayleigh.alpha, wanted);
    }

    fn tangent<S: Precision>(&self, to: &mut Additions<S>, _chain: &Chain, state: &State, at: &Iteration<'_>) {
        let Iteration {
            conditions, factors, ..
        } = *at;
        for body in self.coupled() {
            let factors = [factors.stiffness, factors.damping, factors.mass];
            let tangent = body.coupled_tangent(state, conditions.rayleigh.alpha, factors);
            to.add_at_node(&body.places, &tangent);
        }
    }

    fn energy(&self, _chain: &Chain, point: &mut LedgerPoint, state: &State, under: &Under<'_>) -> f64 {
        self.add_to(point, state, under.conditions.rayleigh.alpha);
        0.0
    }
}
