//! Contact of pipe and guide and of guide and wall: the [`law`] of a gap at all stations, on the ends of the spans.
//!
//! A station inside a span moves with both ends of it, and what touches there acts on both. A closed gap couples the unknowns
//! of pipe and guide, or those of the guide alone: by the columns that it asks of [`Additions`] the elimination knows which.

mod force;
pub(crate) mod law;
mod layers;
mod ledger;
mod tangent;

use std::sync::Arc;

use crate::chain::{Additions, Chain, Effect, Precision, Touched, Under};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::{Deflection, State};
use crate::model::Model;
use crate::simd::aligned::Aligned;
use crate::tool::{Body, ToolDescription};

use law::{GapLaw, Touch};

pub(crate) use layers::Layers;

/// Friction along the hole that no wall holds (N): what it resists with is at its limit then.
const BEYOND_ANY_LIMIT: f64 = 1e12;

/// Stiffness of the layers of pipe and guide and of guide and wall (N/m).
pub(crate) fn stiffness(model: &Model) -> [f64; 2] {
    [&model.description.inner, &model.description.outer].map(|layer| layer.stiffness)
}

/// The laws of both layers under `conditions`: as described, with the friction in force. While the tool comes to rest there is
/// none, as it would slow the approach and change nothing of the end; but for that of the wall on a guide that has been slid in.
pub(crate) fn laws(description: &ToolDescription, conditions: &Conditions) -> [GapLaw; 2] {
    let ToolDescription {
        inner, outer, slid_in, ..
    } = *description;
    let live = &conditions.live;
    [
        (inner, live.inner_friction, false),
        (outer, live.outer_friction, slid_in),
    ]
    .map(|(mut surface, friction, held)| {
        let counts = held || !conditions.comes_to_rest;
        [surface.friction_tangential, surface.friction_axial] = if counts { friction } else { [0.0; 2] };
        GapLaw {
            surface,
            slip_speed: surface.slip_speed.unwrap_or(description.slip_speed),
            bristle_stiffness: GapLaw::bristle_stiffness(surface.stiffness, description.material.poisson_ratio),
        }
    })
}

/// The contacts of both layers at all stations of a chain.
#[derive(Clone)]
pub(crate) struct Contact {
    /// What touches, as the last residual found it.
    layers: Layers,
    /// Per span, squares of the inner clearance at its stations but the first (m2); in lanes without a station the largest
    /// number.
    clearance_squared: Arc<[Aligned<[f64; 8]>]>,
    /// Inner and outer radius of the guide (m).
    radii: [f64; 2],
    /// Whether the guide has been slid in.
    slid_in: bool,
}

impl Contact {
    /// Of any tool: its pipe is in a guide, and that in the hole.
    #[expect(clippy::unnecessary_wraps, reason = "as of every effect")]
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        let clearance_squared = (0..chain.spans()).map(|l| {
            let mut lanes = Aligned([f64::MAX; 8]);
            for (lane, station) in lanes.iter_mut().zip(chain.stations_below(l)) {
                let clearance = model.stations[station].inner_clearance;
                *lane = clearance * clearance;
            }
            lanes
        });
        Some(Self {
            layers: Layers::new(model),
            clearance_squared: clearance_squared.collect(),
            radii: model.guide_radii,
            slid_in: model.description.slid_in,
        })
    }

    /// What touches, as the last residual found it.
    #[cfg(test)]
    pub(crate) fn layers(&self) -> &Layers {
        &self.layers
    }
}

/// What a touch is to whoever reads figures of it.
fn touched(touch: &Touch) -> Touched {
    Touched {
        normal: touch.normal,
        tangential: touch.tangential,
        axial: touch.axial,
        dissipation: touch.dissipation,
        friction_power: touch.friction_power,
        force: touch.force(),
    }
}

impl Effect for Contact {
    fn settle(&self, state: &mut State) {
        // Along the guide, against the advance.
        if self.slid_in {
            let walls = state.held_friction.iter_mut().map(|[_, wall]| wall);
            walls.for_each(|wall| *wall = [0.0, -BEYOND_ANY_LIMIT]);
        }
    }

    fn begin(&mut self, from: &State, step: f64) {
        self.layers.begin(from, step);
    }

    fn force(&mut self, chain: &mut Chain, state: &mut State, under: &Under<'_>) {
        self.search(chain, state, under);
    }

    fn at_stations<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, at: &Iteration<'_>) {
        self.tangents(to, chain, at.factors);
    }

    fn friction(&self, chain: &Chain, point: &mut LedgerPoint, under: &Under<'_>) -> f64 {
        let stored = self.rub(chain, point);
        let laws = laws(&under.model.description, under.conditions);
        self.layers.hold(&laws, under.conditions, point);
        stored
    }

    fn deflect(&self, chain: &Chain, to: &mut [Deflection]) {
        self.deflect_spans(chain, to);
    }

    fn leave(&self, to: &mut State) {
        self.layers.leave(to);
    }

    fn touched(&self, body: Body, station: usize) -> Option<Touched> {
        self.layers.of(body).get(station).map(|touch| touched(&touch))
    }

    fn each_touched(&self, body: Body, visit: &mut impl FnMut(usize, &Touched)) {
        for (station, touch) in self.layers.of(body).iter() {
            visit(station, &touched(&touch));
        }
    }
}
