//! The way back: from the bottom up, every unknown of the swept stations, then those inside the condensed spans.

use nalgebra::Matrix6;

use super::forward::{CondensedElimination, Mode};
use super::guide_contact::expand;
use super::joint_reduction::PLACES;
use super::pivots::{halves_mut, load};
use super::span::{End, scatter};
use super::system::{CondensedSystem, InterfaceCoupling, Matrices, place};
use super::{GUIDE, MULTIPLIER, SIZE, U};
use crate::simd::vector::Vector;

impl CondensedElimination {
    /// From the bottom up: every swept station's unknowns.
    #[inline(always)]
    pub(super) fn recover<V: Vector>(&mut self, system: &CondensedSystem, rhs: &mut [f64]) {
        let layout = system.layout();
        // Rotations, displacement, guide of the station below.
        let mut below = [0.0; 12];
        for (swept, columns) in self.swept.iter().zip(&self.columns).rev() {
            let offset = layout.offset(swept.station);
            // Two sums in each half: half as long a chain.
            let (mut even, mut odd): ([V; 2], [V; 2]) = (load(&columns[12]), [V::splat(0.0); 2]);
            for j in 0..6 {
                let (first, second): ([V; 2], [V; 2]) = (load(&columns[2 * j]), load(&columns[2 * j + 1]));
                for half in 0..2 {
                    even[half] = even[half].minus_product(first[half], V::splat(below[2 * j]));
                    odd[half] = odd[half].minus_product(second[half], V::splat(below[2 * j + 1]));
                }
            }
            let mut x = [0.0; SIZE];
            for (half, place) in halves_mut(&mut x).iter_mut().enumerate() {
                even[half].plus(odd[half]).store(place);
            }
            let matrices = swept.node.map(|node| &system.matrices[system.nodes[node].matrices]);
            match (swept.node, matrices) {
                (Some(node), Some(matrices)) if matrices.reduction.is_some() => {
                    let open = self.modes[node] == Mode::PipeContact;
                    let coupling_of_pipe;
                    let coupling_of_pipe = if open {
                        let coupling = &system.step_constant.upper[swept.station].pipe;
                        coupling_of_pipe = InterfaceCoupling::of(coupling, &Matrix6::zeros(), None);
                        &coupling_of_pipe
                    } else {
                        &system.couplings[system.spans[node].coupling_of_pipe]
                    };
                    let start = if open {
                        &matrices.own_start.rows
                    } else {
                        &matrices.start.rows
                    };
                    let rhs = &mut rhs[offset..offset + 24];
                    recover_joint(
                        matrices,
                        start,
                        &coupling_of_pipe.multiplier_rows,
                        self.offsets[node],
                        &x,
                        &below,
                        rhs,
                    );
                }
                _ => {
                    for k in 0..12 {
                        rhs[offset + k] = x[place(k)];
                    }
                    if layout.is_large(swept.station) {
                        rhs[offset + 18] = x[MULTIPLIER];
                    }
                }
            }
            below[..6].copy_from_slice(&x[..6]);
            below[6..].copy_from_slice(&x[GUIDE..GUIDE + 6]);
        }
    }

    /// Inner stations of the spans that were condensed.
    #[inline(always)]
    pub(super) fn recover_spans<V: Vector>(&mut self, system: &CondensedSystem, rhs: &mut [f64]) {
        let layout = system.layout();
        for (k, span) in system.spans.iter().enumerate() {
            if self.modes[k] == Mode::PipeContact || span.inner == 0 {
                continue;
            }
            let ends = End::of(system, k);
            let room = k * self.room..(k + 1) * self.room;
            let first = layout.offset(span.first);
            let clamped = &mut self.pipes[room.clone()];
            system.pipes[span.pipe].expand::<V>(&ends.values(&ends.pipe, rhs), clamped);
            scatter(clamped, first, span.inner, rhs);
            if self.modes[k] == Mode::Free {
                let clamped = &mut self.guides[room];
                system.guides[span.guide]
                    .substructure
                    .expand::<V>(&ends.values(&ends.guide, rhs), clamped);
                scatter(clamped, first + 6, span.inner, rhs);
            } else {
                let values = ends.values(&ends.guide, rhs);
                let (mut top, mut bottom) = ([0.0; 6], [0.0; 6]);
                top.copy_from_slice(&values[..6]);
                bottom.copy_from_slice(&values[6..]);
                let solved = &self.solved[span.first..span.first + span.inner];
                expand::<V>(solved, &top, &bottom, |node, x| {
                    let at = first + 12 * node + 6;
                    rhs[at..at + 6].copy_from_slice(&x[..6]);
                });
            }
        }
    }
}

/// All 24 unknowns of a joint station from its 16, `x`; `rhs` holds its right-hand side. `start` and `next` are the
/// rows of the start below's displacement over its own six unknowns and over the six of the pipe's next node, `below`.
#[inline(always)]
fn recover_joint(
    matrices: &Matrices,
    start: &[[f64; 3]; 6],
    next: &[[f64; 3]; 6],
    c: [f64; 3],
    x: &[f64; SIZE],
    below: &[f64; 12],
    rhs: &mut [f64],
) {
    let Some(reduction) = &matrices.reduction else { return };
    let mut rest = [rhs[12], rhs[13], rhs[14]];
    for (place, &x) in PLACES.into_iter().zip(x) {
        rhs[place] = x;
    }
    let turned = reduction.turned([x[U], x[U + 1], x[U + 2]]);
    for k in 0..3 {
        rhs[12 + k] = turned[k] + c[k];
    }
    // The rows of that displacement: what the other unknowns leave is the multipliers' part.
    for k in 0..6 {
        for i in 0..3 {
            rest[i] -= start[k][i] * rhs[12 + k] + next[k][i] * below[k];
        }
    }
    for i in 0..3 {
        rhs[18 + i] =
            reduction.recover[0][i] * rest[0] + reduction.recover[1][i] * rest[1] + reduction.recover[2][i] * rest[2];
    }
}
