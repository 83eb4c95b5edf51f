//! Shortening of the pipe's spans over the chain: what is beyond the linear span, in residual and tangent.
//!
//! The inner stations of a span move along it such that its axial force is the same everywhere, so that the law of
//! [`crate::elements::shortening`] holds for a span of several elements with the condensed geometric matrix.

use super::active::Active;
use super::columns::{TENSION, at_ends, product, store};
use super::precision::Precision;
use super::slaving::row;
use super::tangent::{Additions, Touching};
use super::{BOTTOM, Chain, ChainModel, TOP};
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::state::State;
use crate::elements::shortening::{Stretch, StretchTangent};
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// The twelve numbers of a column over both ends.
#[inline(always)]
fn twelve(column: &[f64; 16]) -> [f64; 12] {
    std::array::from_fn(|k| column[row(k)])
}

#[inline(always)]
fn dot(a: &[f64; 12], b: &[f64; 12]) -> f64 {
    let mut sum = [0.0; 4];
    for k in 0..12 {
        sum[k % 4] += a[k] * b[k];
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3])
}

/// The unknowns of a span's pipe at both ends.
#[inline(always)]
fn ends_of(values: &[f64], l: usize) -> [f64; 12] {
    let (nodes, _) = values.as_chunks();
    let [top, bottom] = at_ends(nodes, l, 0);
    std::array::from_fn(|k| if k < 6 { top[k] } else { bottom[k - 6] })
}

impl Chain {
    /// Evaluates the stretch of the active spans at `state`, whose geometric forces were evaluated last, with Rayleigh's
    /// `beta` (s) and the pressure `at_top` (Pa). `keep_axial` leaves the axial forces of the state.
    pub(super) fn stretch_spans(&mut self, state: &mut State, [beta, at_top]: [f64; 2], keep_axial: bool) {
        for (l, stretch) in self.stretches.iter_mut().enumerate() {
            if !self.active.spans[l] {
                continue;
            }
            let link = &self.model.links[l];
            let kind = &self.model.kinds[link.kind];
            let slopes = &self.geometric_forces[l][0];
            let (p, t) = (twelve(slopes), twelve(&kind.tension[0]));
            let (q, v) = (ends_of(&state.q, l), ends_of(&state.v, l));
            let linear = [slopes[TENSION], dot(&t, &v)];
            let by_pressure = at_top * link.on_strain;
            *stretch = Stretch::of(kind.axial, beta, by_pressure, linear, [dot(&q, &p), dot(&v, &p)]);
            if !keep_axial {
                state.pipe_axial[l] = stretch.tension;
            }
        }
    }
}

/// Adds the derivative of the active spans' forces beyond the linear ones.
pub(super) struct StretchTangents<'a, S> {
    pub to: &'a mut Additions<S>,
    pub chain: &'a ChainModel,
    pub active: &'a Active,
    pub stretches: &'a [Stretch],
    /// Geometric forces per axial force of each span.
    pub slopes: &'a [crate::simd::aligned::Aligned<super::EndForces>],
    pub state: &'a State,
    pub beta: f64,
    pub factors: TangentFactors,
}

impl<S: Precision> Kernel for StretchTangents<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        // Windows evaluate only the spans that moved.
        let (rates, _) = self.state.v.as_chunks();
        for (l, stretch) in self.stretches.iter().enumerate() {
            if !self.active.spans[l] {
                continue;
            }
            let kind = &self.chain.kinds[self.chain.links[l].kind];
            let (p, t) = (twelve(&self.slopes[l][0]), twelve(&kind.tension[0]));
            // The rate of the slope's product enters by the damping of the shortening.
            let mut turning = [0.0; 16];
            store(product::<V>(&kind.geometric[0], &at_ends(rates, l, 0)), &mut turning);
            let r = twelve(&turning);
            let tangent = StretchTangent {
                axial: kind.axial,
                beta: self.beta,
                factors: [self.factors.stiffness, self.factors.damping],
            };
            // The tangent is full over the twelve unknowns of the pipe: tension couples both ends.
            let mut columns = [[0.0; 12]; 12];
            for (j, column) in columns.iter_mut().enumerate() {
                let geometric = twelve(&kind.geometric[0][j]);
                tangent.column(stretch, [&t, &p], [t[j], p[j], r[j]], &geometric, column);
            }
            let add = |to: &mut [S], from: &[f64]| {
                for (to, from) in to.iter_mut().zip(from) {
                    *to += S::of(*from);
                }
            };
            // The columns of each end are added to its node's block, the mixed ones to the coupling of both.
            let (top, bottom) = (TOP[0], BOTTOM[0]);
            let block = self.to.block(l, Touching::Both);
            for j in 0..6 {
                add(&mut block[TOP[j]][top..top + 6], &columns[j][..6]);
            }
            let block = self.to.block(l + 1, Touching::Both);
            for j in 0..6 {
                add(&mut block[BOTTOM[j]][bottom..bottom + 6], &columns[6 + j][6..]);
            }
            let coupling = self.to.coupling(l, Touching::Both);
            for j in 0..6 {
                add(&mut coupling.upper[j][top..top + 6], &columns[6 + j][..6]);
                add(&mut coupling.lower[j][bottom..bottom + 6], &columns[j][6..]);
            }
        }
    }
}
