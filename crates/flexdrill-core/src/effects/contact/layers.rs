//! Both layers of contacts at the last residual, whoever has evaluated it: the chain or the plain station equations.

use super::law::{GapLaw, LayerContacts};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::tool::{Body, WellPath};

/// The contacts of both layers.
#[derive(Clone)]
pub(crate) struct Layers {
    /// Closed gaps between pipe and guide.
    pub inner: LayerContacts,
    /// Closed gaps between guide and wall.
    pub outer: LayerContacts,
    /// Whether a layer's friction has bristles.
    pub has_bristles: bool,
    /// Displacements at the start of the step, in the numbering that it is taken in; for bristles only.
    pub start: Vec<f64>,
    /// How far the tool has moved since then, in the same numbering.
    pub travel: Vec<f64>,
    /// Size of the step (s); 0 at rest.
    pub step: f64,
}

impl Layers {
    /// Room for those of `model`.
    pub fn new(model: &Model) -> Self {
        let has_bristles = model.description.holds_friction();
        // A station has at most 24 unknowns in the numbering of the model, and at most a node of 16 in the chain's.
        let most = if has_bristles { 24 * model.stations.len() } else { 0 };
        Self {
            inner: LayerContacts::new(model.stations.len()),
            outer: LayerContacts::with_friction_factors(wall_friction_factors(model)),
            has_bristles,
            start: Vec::with_capacity(most),
            travel: Vec::with_capacity(most),
            step: 0.0,
        }
    }

    /// The layer around a body.
    #[inline(always)]
    pub fn of(&self, body: Body) -> &LayerContacts {
        match body {
            Body::Pipe => &self.inner,
            Body::Guide => &self.outer,
        }
    }

    /// Begins the corrections of a step of size `step` (s) from the state `from`, or with a `step` of 0 of a state at rest,
    /// in which bristles keep their forces. The laws forget what they learned of friction in the corrections of the step
    /// before.
    pub fn begin(&mut self, from: &State, step: f64) {
        self.step = step;
        self.inner
            .begin(from.held_friction.iter().map(|station| station[0]), step);
        self.outer
            .begin(from.held_friction.iter().map(|station| station[1]), step);
        if self.has_bristles {
            self.start.clear();
            self.start.extend_from_slice(&from.q);
            self.travel.resize(from.q.len(), 0.0);
        }
    }

    /// Sets how far a tool with bristles has moved to the displacements `q`.
    #[inline(always)]
    pub fn move_to(&mut self, q: &[f64]) {
        for (travel, (now, start)) in self.travel.iter_mut().zip(q.iter().zip(&self.start)) {
            *travel = now - start;
        }
    }

    /// Leaves the friction of the bristles at the end of a step in `to`.
    pub fn leave(&self, to: &mut State) {
        if self.has_bristles {
            to.held_friction.fill([[0.0; 2]; 2]);
            for (layer, contacts) in [&self.inner, &self.outer].into_iter().enumerate() {
                for (station, touch) in contacts.iter() {
                    to.held_friction[station][layer] = [touch.tangential, touch.axial];
                }
            }
        }
    }

    /// Writes to `point` what the bristles hold, and the power of the wall's motion past the guide.
    pub fn hold(&self, laws: &[GapLaw; 2], conditions: &Conditions, point: &mut LedgerPoint) {
        // Bristles are springs: what they hold is stored, not lost.
        point.sums.held = self.inner.bristle_energy(&laws[0]) + self.outer.bristle_energy(&laws[1]);
        // The wall moves past the guide by the advance. Without one the
        // sum must be exactly zero, and not a rounding of it.
        point.sums.feed = if conditions.rate_of_penetration == 0.0 {
            0.0
        } else {
            let along = self.outer.iter().map(|(_, touch)| touch.axial);
            -conditions.rate_of_penetration * along.sum::<f64>()
        };
    }
}

/// Factor on the friction of the wall at each station: the mean over the half elements on both sides of it.
fn wall_friction_factors(model: &Model) -> Vec<f64> {
    let (d, path) = (&model.description, WellPath::new(&model.description.well));
    let spacing = path.length() / (d.links * d.elements_per_link) as f64;
    let stations = model.stations.iter().map(|station| {
        let carried = [-0.5, 0.5].map(|side| (station.depth + side * spacing).clamp(0.0, path.length()));
        path.mean(carried, |interval| d.wall_friction_factors.of(interval))
    });
    stations.collect()
}
