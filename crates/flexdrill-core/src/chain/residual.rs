//! The residual over the chain: spans, effects, joints, ends.
//!
//! A step's first residual is evaluated whole. After that only the correction's share is added: what is linear changes by
//! the step-constant tangent times the correction, and what geometric stiffness multiplies its axial force by likewise;
//! effects, stops and joint rows are evaluated again.

use super::columns::{EndColumn, Ends, TENSION, around, at_ends, ends, load, plus_column, product, store};
use super::effect::{Effect, Under};
use super::operator::Operator;
use super::{Chain, GUIDE, NODE, U};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

impl Chain {
    /// Sets the axial forces that are foreseen from `from` for `h` (s) on, of which `part` counts.
    pub(super) fn foresee(&mut self, from: &State, h: f64, part: f64) {
        self.foreseen_part = part;
        self.model.instructions.run(Foresee { chain: self, from, h });
    }

    /// Evaluates the linear and geometric forces of the spans at `to`.
    pub(super) fn span_forces(&mut self, evaluation: Evaluation, to: &mut State, conditions: &Conditions) {
        if !matches!(evaluation, Evaluation::Correction { .. }) {
            self.active.set_whole();
        }
        let instructions = self.model.instructions;
        instructions.run(Spans {
            chain: self,
            to,
            conditions,
            evaluation,
        });
    }

    /// Sums up the forces of spans, of what acts inside them, and of weight on each node.
    pub(super) fn gather(&mut self, state: &State) {
        self.model.instructions.run(Gather { chain: self, state });
    }

    /// Adds what acts at nodes: effects, tie, hanger, loads.
    pub(super) fn attached_forces(&mut self, effects: &impl Effect, state: &State, under: &Under<'_>) {
        let numbered = self.model.numbered(under.model);
        let affected = |unknown: usize| self.active.affected[unknown / NODE];
        effects.at_nodes(&mut self.residual, state, under, &affected);
        numbered.add_ties(&mut self.residual, state, affected);
        effects.applied(&mut self.residual, &affected);
        numbered.add_loads(&mut self.residual, under.conditions, affected);
    }
}

/// How the spans' forces are found.
#[derive(Debug, Clone, Copy)]
pub(super) enum Evaluation {
    /// From the state, with the axial forces of its displacements.
    Whole,
    /// From the state, with the axial forces that it holds.
    WholeWithAxial,
    /// From those before the last correction, which was solved for with this operator.
    Correction {
        /// Its place in the chain's list.
        operator: usize,
    },
}

struct Foresee<'a> {
    chain: &'a mut Chain,
    from: &'a State,
    h: f64,
}

impl Kernel for Foresee<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { chain, from, h } = self;
        let h = V::splat(h);
        for (l, (out, link)) in chain.foreseen.iter_mut().zip(&chain.model.links).enumerate() {
            for (body, out) in out.iter_mut().enumerate() {
                let (q, v) = (around::<V>(&from.q, ends(l, body)), around::<V>(&from.v, ends(l, body)));
                let tension: [V; 2] = load(&chain.model.kinds[link.kind].tension[body]);
                let top = q[0].plus_product(v[0], h).times(tension[0]);
                let bottom = q[1].plus_product(v[1], h);
                let mut lanes = Aligned([0.0; 8]);
                top.plus_product(bottom, tension[1]).store(&mut lanes);
                *out = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + (lanes[4] + lanes[5]);
            }
        }
    }
}

/// The residual of constant forces, spans and effects.
struct Gather<'a> {
    chain: &'a mut Chain,
    state: &'a State,
}

impl Kernel for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { chain, state } = self;
        let (residual, _) = chain.residual.as_chunks_mut::<NODE>();
        let (constant, _) = chain.model.constant.as_chunks::<NODE>();
        let (nodes, affected) = (residual.len(), &chain.active.affected);
        // The forces of the spans below and above on the nodes of a group, and on the first node of the next group.
        let mut from_below = [NodeForces::default(); GROUP];
        let mut from_above = [NodeForces::default(); GROUP + 1];
        for start in (0..nodes).step_by(GROUP) {
            from_above[0] = from_above[GROUP];

            // First the spans, each onto both its ends.
            for l in start..(start + GROUP).min(nodes) {
                if l + 1 == nodes {
                    from_below[l - start] = NodeForces::default();
                    break;
                }
                // A node needs both its spans; a span is summed if either of its nodes changes.
                if !(affected[l] || affected[l + 1]) {
                    continue;
                }
                let (linear, geometric) = (&chain.linear[l], &chain.geometric_forces[l]);
                let inside = chain.has_inside[l].then_some(&chain.inside[l]);
                let [on_pipe, on_guide] = [0, 1].map(|body| inside.map(|inside| &inside[body]));
                let pipe: [V; 2] = force_of_span(&linear[0], &geometric[0], state.pipe_axial[l], on_pipe);
                let guide: [V; 2] = force_of_span(&linear[1], &geometric[1], state.guide_axial[l], on_guide);
                // Upper ends act on the node above, lower ends on the node below.
                from_below[l - start].set(pipe[0], U, guide[0]);
                from_above[l - start + 1].set(pipe[1], 0, guide[1]);
            }

            // Then the nodes.
            let forces = from_below.iter().zip(&from_above);
            for (l, (below, above)) in (start..nodes).zip(forces) {
                if affected[l] {
                    let (constant, below, above): ([V; 2], [V; 2], [V; 2]) =
                        (load(&constant[l]), load(below.node()), load(above.node()));
                    store(
                        [
                            below[0].plus(above[0]).minus(constant[0]),
                            below[1].plus(above[1]).minus(constant[1]),
                        ],
                        &mut residual[l],
                    );
                }
            }
        }
    }
}

/// Force of a span on its ends: linear, geometric by its axial force, and that of what acts inside it.
#[inline(always)]
fn force_of_span<V: Vector>(
    linear: &EndColumn,
    geometric: &EndColumn,
    axial: f64,
    inside: Option<&EndColumn>,
) -> [V; 2] {
    let force = plus_column(load(linear), geometric, V::splat(axial));
    match inside {
        Some(inside) => {
            let inside: [V; 2] = load(inside);
            [force[0].plus(inside[0]), force[1].plus(inside[1])]
        }
        None => force,
    }
}

/// Nodes whose forces are gathered before they are summed. The processor waits for memory where numbers that were written
/// as one vector are read as another one straight away; a group in between takes longer than that.
const GROUP: usize = 8;

/// Forces on a node, in the order of its unknowns, and room for the two lanes by which a vector of the guide's six reaches
/// beyond them.
#[derive(Clone, Copy, Default)]
struct NodeForces(Aligned<[f64; 24]>);

impl NodeForces {
    /// Stores the forces on the pipe from place `first` on, then those on the guide. Six lanes of each vector hold forces.
    /// The pipe's other two reach beyond its places: the guide's forces overwrite them, or the span has none there.
    #[inline(always)]
    fn set<V: Vector>(&mut self, pipe: V, first: usize, guide: V) {
        for (forces, place) in [(pipe, first), (guide, GUIDE)] {
            if let Some(to) = self.0[place..].first_chunk_mut() {
                forces.store(to);
            }
        }
    }

    /// Those of the node itself.
    #[inline(always)]
    fn node(&self) -> &[f64; NODE] {
        // Never empty: 24 are more than 16.
        self.0.first_chunk().unwrap_or(&[0.0; NODE])
    }
}

/// Linear and geometric forces of the spans.
struct Spans<'a> {
    chain: &'a mut Chain,
    to: &'a mut State,
    conditions: &'a Conditions,
    evaluation: Evaluation,
}

impl Kernel for Spans<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        match self.evaluation {
            Evaluation::Whole | Evaluation::WholeWithAxial => self.whole::<V>(),
            Evaluation::Correction { operator } => self.increment::<V>(operator),
        }
        if !matches!(self.evaluation, Evaluation::WholeWithAxial) {
            let part = self.chain.foreseen_part;
            let axial = self.to.pipe_axial.iter_mut().zip(&mut self.to.guide_axial);
            for ((pipe, guide), (geometric_forces, foreseen)) in
                axial.zip(self.chain.geometric_forces.iter().zip(&self.chain.foreseen))
            {
                let now = [geometric_forces[0][TENSION], geometric_forces[1][TENSION]];
                *pipe = now[0] + part * (foreseen[0] - now[0]);
                *guide = now[1] + part * (foreseen[1] - now[1]);
            }
        }
    }
}

impl Spans<'_> {
    /// From the state.
    #[inline(always)]
    fn whole<V: Vector>(&mut self) {
        let Self {
            chain, to, conditions, ..
        } = self;
        let rayleigh = [conditions.rayleigh.alpha, conditions.rayleigh.beta];
        let ((q, _), (v, _), (a, _)) = (to.q.as_chunks(), to.v.as_chunks(), to.a.as_chunks());
        let forces = chain.linear.iter_mut().zip(&mut chain.geometric_forces);
        for (l, (link, (linear, geometric_forces))) in chain.model.links.iter().zip(forces).enumerate() {
            // The sums are the same products as in the step-constant tangent, so that corrections can be added to them.
            let kind = &chain.model.kinds[link.kind];
            for body in 0..2 {
                let (at, rate) = (at_ends(q, l, body), at_ends(v, l, body));
                // Rayleigh damping by the combined arguments: K (q + beta v) and M (a + alpha v) are one product each.
                let (mut strained, mut pushed) = (at, at_ends(a, l, body));
                for end in 0..2 {
                    for j in 0..6 {
                        strained[end][j] += rayleigh[1] * rate[end][j];
                        pushed[end][j] += rayleigh[0] * rate[end][j];
                    }
                }
                let mut stiff = product::<V>(&kind.stiffness[body], &strained);
                if let Some(undamped) = kind.undamped.as_ref().filter(|_| body == 1) {
                    // What turns with the guide stores energy but does not damp.
                    let turned = product::<V>(undamped, &at);
                    stiff = [stiff[0].plus(turned[0]), stiff[1].plus(turned[1])];
                }
                let inert = product::<V>(&kind.mass[body], &pushed);
                let mut force = [stiff[0].plus(inert[0]), stiff[1].plus(inert[1])];
                if let Some(coupled) = &kind.coupled {
                    // What the other pipe's motion pushes, and viscous damping.
                    let (mut pushed, rate_there) = (at_ends(a, l, 1 - body), at_ends(v, l, 1 - body));
                    for (pushed, rate) in pushed.as_flattened_mut().iter_mut().zip(rate_there.as_flattened()) {
                        *pushed += rayleigh[0] * rate;
                    }
                    for part in [
                        product::<V>(&coupled.mass_across[body], &pushed),
                        product::<V>(&coupled.damping[body], &rate),
                        product::<V>(&coupled.damping_across[body], &rate_there),
                    ] {
                        force = [force[0].plus(part[0]), force[1].plus(part[1])];
                    }
                }
                // Forces per axial force are kept: the axial force changes with every correction, these by a product.
                store(force, &mut linear[body]);
                store(product::<V>(&kind.geometric[body], &at), &mut geometric_forces[body]);
            }
        }
    }

    /// From the last correction.
    #[inline(always)]
    fn increment<V: Vector>(&mut self, operator: usize) {
        let chain = &mut *self.chain;
        let Operator {
            spans: operator,
            across,
            ..
        } = &*chain.operators[operator];
        let (corrections, _) = chain.correction.as_chunks();
        let forces = chain.linear.iter_mut().zip(&mut chain.geometric_forces);
        let nodes = corrections.windows(2).zip(&chain.active.spans);
        for ((link, (nodes, moved)), (linear, geometric_forces)) in chain.model.links.iter().zip(nodes).zip(forces) {
            if !moved {
                continue;
            }
            let (columns, geometric) = (&operator[link.kind], &chain.model.kinds[link.kind].geometric);
            for body in 0..2 {
                let sums = [load(&linear[body]), load(&geometric_forces[body])];
                let dq = at_ends(nodes, 0, body);
                let (mut sum, other) = products::<V>([&columns[body], &geometric[body]], &dq, sums);
                if let Some(across) = &across[link.kind] {
                    let from_there = product::<V>(&across[body], &at_ends(nodes, 0, 1 - body));
                    sum = [sum[0].plus(from_there[0]), sum[1].plus(from_there[1])];
                }
                store(sum, &mut linear[body]);
                store(other, &mut geometric_forces[body]);
            }
        }
    }
}

/// Two matrices over both ends times what the ends are, added to `sums`.
#[inline(always)]
fn products<V: Vector>(
    [first, second]: [&[EndColumn; 12]; 2],
    [top, bottom]: &Ends,
    sums: [[V; 2]; 2],
) -> ([V; 2], [V; 2]) {
    let zero = [V::splat(0.0); 2];
    let [mut above, mut other_above] = sums;
    let (mut below, mut other_below) = (zero, zero);
    for j in 0..6 {
        let (x, y) = (V::splat(top[j]), V::splat(bottom[j]));
        above = plus_column(above, &first[j], x);
        other_above = plus_column(other_above, &second[j], x);
        below = plus_column(below, &first[6 + j], y);
        other_below = plus_column(other_below, &second[6 + j], y);
    }
    (
        [above[0].plus(below[0]), above[1].plus(below[1])],
        [other_above[0].plus(other_below[0]), other_above[1].plus(other_below[1])],
    )
}
