//! The spans one by one: which matrices they share, where the pipe lies in them, what their weight does.

use nalgebra::DVector;

use super::columns::ends;
use super::linear::{Acting, Segment};
use super::nodes::Nodes;
use super::slaving::{LinkMatrices, local_lateral};
use crate::dynamics::state::Deflection;
use crate::model::Model;
use crate::simd::aligned::Aligned;

/// A span.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    /// Its matrices.
    pub kind: usize,
    /// Where the undeflected pipe lies at each station but the first: y, z (m).
    pub offset: Aligned<[[f64; 8]; 2]>,
    /// Force of the pipe's weight on its top end (N), along the axes of the link above.
    pub weight_on_top: [f64; 3],
    /// Lateral deflection of the inner stations under the weight of pipe and guide and constant forces (m), as
    /// [`LinkMatrices::lateral`].
    pub by_weight: Aligned<Deflection>,
}

/// The spans between `nodes`, whose matrices were `made` with them: like ones share theirs.
pub(super) fn links(model: &Model, nodes: &Nodes, made: Vec<LinkMatrices>) -> (Vec<LinkMatrices>, Vec<Link>) {
    let (mut kinds, mut links) = (Vec::<LinkMatrices>::new(), Vec::new());
    for (l, made) in made.into_iter().enumerate() {
        let (first, per) = (nodes.first(l), nodes.elements(l));
        let kind = match kinds.iter().position(|kind| kind.is_close(&made)) {
            Some(kind) => kind,
            None => {
                kinds.push(made);
                kinds.len() - 1
            }
        };
        let mut link = Link {
            kind,
            offset: Aligned([[0.0; 8]; 2]),
            weight_on_top: [0.0; 3],
            by_weight: Aligned([[0.0; 16]; 2]),
        };
        for i in 0..per {
            let station = &model.stations[first + i + 1];
            (link.offset[0][i], link.offset[1][i]) = (station.offset.x, station.offset.y);
        }
        links.push(link);
    }
    (kinds, links)
}

/// Constant forces on the unknowns of the chain.
pub(super) struct ConstantForces {
    /// Consistent forces of gravity (N, N m).
    pub weight: Vec<f64>,
    /// Constant forces of effects, which have a potential (N, N m); empty without any.
    pub potential: Vec<f64>,
}

/// Consistent forces of gravity, and constant forces of effects on the guide, in the chain's numbering.
pub(super) fn constant_forces(
    model: &Model,
    acting: &Acting,
    nodes: &Nodes,
    kinds: &[LinkMatrices],
    links: &mut [Link],
    unknowns: usize,
) -> ConstantForces {
    // Without a preload there is no vector, by which later loops skip it.
    let mut out = ConstantForces {
        weight: vec![0.0; unknowns],
        potential: Vec::new(),
    };
    for (l, link) in links.iter_mut().enumerate() {
        let (first, per) = (nodes.first(l), nodes.elements(l));
        let parts = acting.parts(&Segment {
            model,
            first,
            elements: per,
        });
        for body in 0..2 {
            // The forces are summed over the elements of the span first, and then condensed once.
            let mut weight = DVector::<f64>::zeros(6 * (per + 1));
            for e in 0..per {
                let element = if body == 0 {
                    &model.pipe[first + e].weight
                } else {
                    &model.guide[first + e].weight
                };
                let mut part = weight.rows_mut(6 * e, 12);
                part += element;
            }
            // The slaving condenses forces on inner stations to the ends, as it condenses displacements.
            let kind = &kinds[link.kind];
            let on_ends = kind.on_ends(body, &weight);
            let [top, bottom] = ends(l, body);
            if let Some(forces) = parts.forces.as_ref().filter(|_| body == 1) {
                let on_ends = kind.on_ends(body, forces);
                out.potential.resize(unknowns, 0.0);
                for i in 0..6 {
                    out.potential[top + i] += on_ends[i];
                    out.potential[bottom + i] += on_ends[6 + i];
                }
                // The deflection between the ends comes from all forces inside.
                weight += forces;
            }
            let by_weight = &kind.compliance[body] * weight.rows(6, 6 * (per - 1));
            for i in 1..per {
                let at = local_lateral(model, first + i, body) * by_weight.rows(6 * (i - 1), 6);
                (link.by_weight[body][i - 1], link.by_weight[body][8 + i - 1]) = (at[0], at[1]);
            }
            // Kept, because the force of the joint above is found without it.
            if body == 0 {
                link.weight_on_top = [on_ends[0], on_ends[1], on_ends[2]];
            }
            for i in 0..6 {
                out.weight[top + i] += on_ends[i];
                out.weight[bottom + i] += on_ends[6 + i];
            }
        }
    }
    out
}
