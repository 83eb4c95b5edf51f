//! The residual over the joints: spans, point masses, contacts, joints, ends.
//!
//! A step's first residual is evaluated whole. After that only the correction's share is added: what is linear changes by
//! the step-constant tangent times the correction; geometric stiffness, contacts, stops and joint rows are evaluated anew.

use super::{EndColumn, EndForces, GUIDE, NODE, Reduced, ends};
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::phases::Phase;
use crate::dynamics::residual::mass_forces;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// Two vectors of eight: a span's top and bottom end, or a node.
#[inline(always)]
pub(super) fn load<V: Vector>(column: &[f64; 16]) -> [V; 2] {
    let (halves, _) = column.as_chunks::<8>();
    [V::load(&halves[0]), V::load(&halves[1])]
}

#[inline(always)]
pub(super) fn store<V: Vector>(values: [V; 2], column: &mut [f64; 16]) {
    let (halves, _) = column.as_chunks_mut::<8>();
    values[0].store(&mut halves[0]);
    values[1].store(&mut halves[1]);
}

/// sum + column x.
#[inline(always)]
pub(super) fn plus_column<V: Vector>(sum: [V; 2], column: &[f64; 16], x: V) -> [V; 2] {
    let column = load::<V>(column);
    [sum[0].plus_product(column[0], x), sum[1].plus_product(column[1], x)]
}

impl Reduced {
    /// Axial forces of all spans by `q` + `h` `v`.
    #[inline(always)]
    fn axial(&self, q: &[f64], v: &[f64], h: f64, out: &mut [[f64; 2]]) {
        for (l, (out, link)) in out.iter_mut().zip(&self.links).enumerate() {
            for (body, (out, tension)) in out.iter_mut().zip(&self.kinds[link.kind].tension).enumerate() {
                let [top, bottom] = ends(l, body);
                let (mut above, mut below) = (0.0, 0.0);
                for j in 0..6 {
                    above += tension[j] * (q[top + j] + h * v[top + j]);
                    below += tension[6 + j] * (q[bottom + j] + h * v[bottom + j]);
                }
                *out = above + below;
            }
        }
    }

    /// Sets the axial forces that are foreseen from `from` for `h` (s) on, of which `part` counts.
    pub(super) fn foresee(&mut self, from: &State, h: f64, part: f64) {
        let mut foreseen = std::mem::take(&mut self.foreseen);
        self.axial(&from.q, &from.v, h, &mut foreseen);
        self.foreseen = foreseen;
        self.foreseen_part = part;
    }

    /// Axial forces of the displacements of a state, [pipe, guide] of a span.
    #[inline(always)]
    pub(super) fn tension(&self, q: &[f64], l: usize, body: usize) -> f64 {
        let tension = &self.kinds[self.links[l].kind].tension[body];
        let [top, bottom] = ends(l, body);
        let (mut above, mut below) = (0.0, 0.0);
        for j in 0..6 {
            above += tension[j] * q[top + j];
            below += tension[6 + j] * q[bottom + j];
        }
        above + below
    }

    /// Evaluates the residual at `to`; `operator` is that of the last correction, if there was one since the last whole
    /// evaluation. With `keep_axial` the axial forces are those that `to` holds.
    pub(super) fn evaluate(
        &mut self,
        assembler: &mut Assembler,
        model: &Model,
        to: &mut State,
        conditions: &Conditions,
        (operator, keep_axial): (Option<usize>, bool),
    ) {
        assembler.stopwatch.lap(Phase::Other);
        let instructions = self.instructions;
        instructions.run(Spans {
            by: self,
            to,
            conditions,
            operator,
            keep_axial,
        });
        assembler.stopwatch.lap(Phase::Assembly);
        self.contact_forces(assembler, model, to, conditions);
        self.gather();
        assembler.stopwatch.lap(Phase::Contact);
        let mut residual = std::mem::take(&mut self.residual);
        mass_forces(&mut residual, &self.places, model, to, conditions);
        assembler.rotational_rows(&mut residual, &self.places.joints, model, to);
        assembler.end_forces(&mut residual, &self.places, model, to, conditions);
        self.residual = residual;
    }

    /// The residual of gravity and spans.
    fn gather(&mut self) {
        let (nodes, _) = self.residual.as_chunks_mut::<NODE>();
        let (weights, _) = self.weight.as_chunks::<NODE>();
        for (node, weight) in nodes.iter_mut().zip(weights) {
            for (r, w) in node.iter_mut().zip(weight) {
                *r = -w;
            }
        }
        for l in 0..self.links.len() {
            let sum = |body: usize| -> EndColumn {
                let (linear, geometric) = (&self.linear[l][body], &self.geometric[l][body]);
                let mut sum: EndColumn = std::array::from_fn(|i| linear[i] + geometric[i]);
                if self.any[l] {
                    let touched = &self.touched[l][body];
                    (0..16).for_each(|i| sum[i] += touched[i]);
                }
                sum
            };
            let (pipe, guide) = (sum(0), sum(1));
            for i in 0..6 {
                nodes[l][super::U + i] += pipe[i];
                nodes[l][GUIDE + i] += guide[i];
                nodes[l + 1][i] += pipe[8 + i];
                nodes[l + 1][GUIDE + i] += guide[8 + i];
            }
        }
    }
}

/// Linear and geometric forces of the spans.
struct Spans<'a> {
    by: &'a mut Reduced,
    to: &'a mut State,
    conditions: &'a Conditions,
    operator: Option<usize>,
    keep_axial: bool,
}

impl Kernel for Spans<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            by,
            to,
            conditions,
            operator,
            keep_axial,
        } = self;
        for l in 0..if keep_axial { 0 } else { by.links.len() } {
            for body in 0..2 {
                let now = by.tension(&to.q, l, body);
                let force = now + by.foreseen_part * (by.foreseen[l][body] - now);
                if body == 0 {
                    to.pipe_axial[l] = force;
                } else {
                    to.guide_axial[l] = force;
                }
            }
        }
        let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
        let zero = [V::splat(0.0); 2];
        for (l, link) in by.links.iter().enumerate() {
            let kind = &by.kinds[link.kind];
            for body in 0..2 {
                let [top, bottom] = ends(l, body);
                let at = |j: usize| if j < 6 { top + j } else { bottom + j - 6 };
                let (mut even, mut odd, mut stretched) = (zero, zero, zero);
                match operator {
                    None => {
                        for j in 0..12 {
                            let u = at(j);
                            let (q, v, a) = (to.q[u], to.v[u], to.a[u]);
                            even = plus_column(even, &kind.stiffness[body][j], V::splat(q + beta * v));
                            odd = plus_column(odd, &kind.mass[body][j], V::splat(a + alpha * v));
                            stretched = plus_column(stretched, &kind.geometric[body][j], V::splat(q));
                        }
                    }
                    Some(operator) => {
                        let columns = &by.operators[operator].spans[link.kind][body];
                        let linear = &by.linear[l][body];
                        even = load(linear);
                        for j in 0..6 {
                            even = plus_column(even, &columns[j], V::splat(by.correction[top + j]));
                            odd = plus_column(odd, &columns[6 + j], V::splat(by.correction[bottom + j]));
                        }
                        for j in 0..12 {
                            stretched = plus_column(stretched, &kind.geometric[body][j], V::splat(to.q[at(j)]));
                        }
                    }
                }
                let tension = V::splat(if body == 0 { to.pipe_axial[l] } else { to.guide_axial[l] });
                let linear: &mut EndForces = &mut by.linear[l];
                store([even[0].plus(odd[0]), even[1].plus(odd[1])], &mut linear[body]);
                let geometric = &mut by.geometric[l][body];
                store([stretched[0].times(tension), stretched[1].times(tension)], geometric);
            }
        }
    }
}
