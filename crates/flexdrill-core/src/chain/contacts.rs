//! Contacts at all stations: found eight stations of a span at a time, evaluated by the law of the gap eight contacts at a
//! time, and applied to the ends of the spans.

use nalgebra::Vector2;

use super::columns::{EndColumn, EndForces, Ends, at_ends, load, plus_column, product, store};
use super::slaving::LinkMatrices;
use super::{Chain, NODE};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::interactions::Interactions;
use crate::dynamics::state::{Deflection, State};
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

impl Chain {
    /// Finds the contacts at `state`, evaluates them, and applies them to the ends of the spans.
    pub(super) fn contact_forces(
        &mut self,
        interactions: &mut Interactions,
        model: &Model,
        state: &State,
        conditions: &Conditions,
    ) {
        for (any, moved) in self.has_inside.iter_mut().zip(&self.active.spans) {
            *any &= !moved;
        }
        let instructions = self.model.instructions;
        instructions.run(ContactSearch {
            chain: self,
            interactions,
            model,
            state,
            conditions,
            arms: model.guide_radii.map(|r| Aligned([1.0, 1.0, 1.0, r, r, r, 0.0, 0.0])),
        });
    }

    /// Local motions of pipe and guide at station `i` of span `l`, by end unknowns `x`.
    #[inline(always)]
    fn local<V: Vector>(&self, x: &[f64], l: usize, i: usize, body: usize) -> V {
        let columns = &self.model.kinds[self.model.links[l].kind].motion[i][body];
        let [top, bottom] = at_ends(x.as_chunks().0, l, body);
        let (mut above, mut below) = (V::splat(0.0), V::splat(0.0));
        if i < self.model.nodes.elements(l) {
            for j in 0..6 {
                above = above.plus_product(V::load(&columns[j]), V::splat(top[j]));
            }
        }
        if i > 0 {
            for j in 0..6 {
                below = below.plus_product(V::load(&columns[6 + j]), V::splat(bottom[j]));
            }
        }
        above.plus(below)
    }

    /// How far a pipe (0) or guide (1) has moved locally at station `i` of span `l` since the displacements `start`.
    #[inline(always)]
    fn travel<V: Vector>(&self, state: &State, start: &[f64], l: usize, i: usize, body: usize) -> V {
        let now = self.local::<V>(&state.q, l, i, body);
        now.minus(self.local::<V>(start, l, i, body))
    }
}

/// One in the lane along the axis.
static ALONG: [f64; 8] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

struct ContactSearch<'a> {
    chain: &'a mut Chain,
    interactions: &'a mut Interactions,
    model: &'a Model,
    state: &'a State,
    conditions: &'a Conditions,
    /// Per layer, what the guide's motions count with in the gap: those of the rotations with its radius.
    arms: [Aligned<[f64; 8]>; 2],
}

/// Lateral positions of a span's stations, a station per lane: as the ends move them, and deflected between the ends.
#[inline(always)]
fn position<V: Vector>(lateral: &[EndColumn; 12], ends: &Ends, deflection: &EndColumn) -> [V; 2] {
    let (slaved, deflection): ([V; 2], [V; 2]) = (product(lateral, ends), load(deflection));
    [slaved[0].plus(deflection[0]), slaved[1].plus(deflection[1])]
}

/// How the stations of a span move, the first left out, one per lane: along y and z, the pipe in the guide and the guide in the
/// hole.
pub(crate) struct SpanMotion<V> {
    /// Positions (m).
    pub d: [[V; 2]; 2],
    /// Velocities (m/s).
    pub v: [[V; 2]; 2],
    /// Accelerations (m/s2).
    pub a: [[V; 2]; 2],
}

impl Chain {
    /// How the stations of span `l` move at `state`.
    #[inline(always)]
    pub(crate) fn span_motion<V: Vector>(&self, state: &State, l: usize) -> SpanMotion<V> {
        let kind = self.model.kind(l);
        let (nodes, _) = state.q.as_chunks::<NODE>();
        SpanMotion {
            d: self.positions::<V>(nodes, &state.deflection[l], l),
            v: relative::<V>(kind, &state.v, l),
            a: relative::<V>(kind, &state.a, l),
        }
    }

    /// Lateral positions of the pipe in the guide and of the guide in the hole.
    #[inline(always)]
    fn positions<V: Vector>(&self, nodes: &[[f64; NODE]], deflection: &Deflection, l: usize) -> [[V; 2]; 2] {
        let (link, kind) = (&self.model.links[l], self.model.kind(l));
        let pipe = position::<V>(&kind.lateral[0], &at_ends(nodes, l, 0), &deflection[0]);
        let guide = position::<V>(&kind.lateral[1], &at_ends(nodes, l, 1), &deflection[1]);
        let y = V::load(&link.offset[0]).plus(pipe[0].minus(guide[0]));
        let z = V::load(&link.offset[1]).plus(pipe[1].minus(guide[1]));
        [[y, z], guide]
    }
}

/// How the stations of span `l` move by end unknowns `x`, as [`SpanMotion`].
#[inline(always)]
fn relative<V: Vector>(kind: &LinkMatrices, x: &[f64], l: usize) -> [[V; 2]; 2] {
    let (nodes, _) = x.as_chunks::<NODE>();
    let pipe: [V; 2] = product(&kind.lateral[0], &at_ends(nodes, l, 0));
    let guide: [V; 2] = product(&kind.lateral[1], &at_ends(nodes, l, 1));
    [[pipe[0].minus(guide[0]), pipe[1].minus(guide[1])], guide]
}

/// A local force's lanes with those of the rotations times a radius.
#[inline(always)]
pub(super) fn at_radius(force: &[f64; 6], radius: f64) -> [f64; 6] {
    [
        force[0],
        force[1],
        force[2],
        radius * force[3],
        radius * force[4],
        radius * force[5],
    ]
}

/// `sum` plus the forces on both ends of a span by the components `x` of a local force.
#[inline(always)]
pub(super) fn plus_rows<V: Vector>(sum: [V; 2], rows: &[EndColumn; 6], x: &[f64; 6]) -> [V; 2] {
    let (mut even, mut odd) = (sum, [V::splat(0.0); 2]);
    for k in 0..3 {
        even = plus_column(even, &rows[2 * k], V::splat(x[2 * k]));
        odd = plus_column(odd, &rows[2 * k + 1], V::splat(x[2 * k + 1]));
    }
    [even[0].plus(odd[0]), even[1].plus(odd[1])]
}

impl ContactSearch<'_> {
    /// Hands station `i` of span `l` to the layers whose gap is closed there, with its lateral positions and velocities.
    #[inline(always)]
    fn push<V: Vector>(&mut self, l: usize, i: usize, lateral: [[f64; 2]; 2], is_closed: [bool; 2]) {
        let Self {
            chain,
            interactions,
            model,
            state,
            conditions,
            arms,
        } = self;
        // The radii and levers are in the columns of the interactions;
        // positions and velocities are local to the station.
        let station = chain.model.nodes.first(l) + i;
        let advance = conditions.rate_of_penetration;
        let guide = chain.local::<V>(&state.v, l, i, 1);
        // The residual adds forces inside marked spans only.
        chain.has_inside[l] = true;
        if is_closed[0] {
            let pipe = chain.local::<V>(&state.v, l, i, 0);
            let velocity = pipe.minus_product(guide, V::load(&arms[0]));
            let clearance = model.stations[station].inner_clearance;
            // Bristles compare positions and not velocities: they need the travel since the start of the step.
            if conditions.inner.has_bristles() {
                let pipe = chain.travel::<V>(state, &interactions.start, l, i, 0);
                let guide = chain.travel::<V>(state, &interactions.start, l, i, 1);
                interactions
                    .inner
                    .set_travel(pipe.minus_product(guide, V::load(&arms[0])));
                // The travel is handed over before the contact, which queues until eight lanes are full.
            }
            let layer = &mut interactions.inner;
            layer.push::<V>(&conditions.inner, station, lateral[0], clearance, velocity);
        }
        if is_closed[1] {
            // The hole moves past the guide by the advance. Only the velocity along it has that part.
            let mut velocity = guide.times(V::load(&arms[1]));
            if advance != 0.0 {
                velocity = velocity.plus_product(V::load(&ALONG), V::splat(advance));
            }
            if conditions.outer.has_bristles() {
                let guide = chain.travel::<V>(state, &interactions.start, l, i, 1);
                let advance = V::splat(advance * interactions.step);
                let travel = guide.times(V::load(&arms[1])).plus_product(V::load(&ALONG), advance);
                interactions.outer.set_travel(travel);
            }
            let layer = &mut interactions.outer;
            layer.push::<V>(&conditions.outer, station, lateral[1], model.outer_clearance, velocity);
        }
    }

    /// Applies all contacts to the ends of their spans.
    #[inline(always)]
    fn apply<V: Vector>(&mut self) {
        let Self {
            chain,
            interactions,
            model,
            ..
        } = self;
        let [inner_radius, outer_radius] = model.guide_radii;
        // Only spans that moved are cleared and summed again; the forces of the others are unchanged to the bit.
        let spans = chain.has_inside.iter().zip(&chain.active.spans);
        for (inside, (any, moved)) in chain.inside.iter_mut().zip(spans) {
            if *any && *moved {
                **inside = [[0.0; 16]; 2];
            }
        }
        let moved = |station: usize| chain.active.spans[chain.model.nodes.stations[station].0];
        for (station, touch) in interactions.inner.among(moved) {
            let (l, i) = chain.model.nodes.stations[station];
            let [on_pipe, on_guide] = &chain.model.kinds[chain.model.links[l].kind].force[i].0;
            let force = touch.force();
            let [pipe, guide] = &mut chain.inside[l].0;
            // The residual subtracts what acts: the force of the contact from the pipe, its opposite at the inner radius from
            // the guide.
            let mut opposite = force;
            opposite.iter_mut().for_each(|x| *x = -*x);
            store(plus_rows::<V>(load(pipe), on_pipe, &opposite), pipe);
            store(
                plus_rows::<V>(load(guide), on_guide, &at_radius(&force, inner_radius)),
                guide,
            );
        }
        // Wall contacts follow each other from the top down, so that those of a span are summed once and stored once.
        let mut sum = OnSpan::<V>::new();
        for (station, touch) in interactions.outer.among(moved) {
            let (l, i) = chain.model.nodes.stations[station];
            if l != sum.span {
                sum.take_from(&mut chain.inside, l);
            }
            let rows = &chain.model.kinds[chain.model.links[l].kind].force[i][1];
            sum.add(rows, &at_radius(&touch.force(), outer_radius));
        }
        // Taking the first span again writes the sum of the last one.
        sum.take_from(&mut chain.inside, 0);
    }
}

/// The force of wall contacts on the ends of a span: summed over its stations, for one span after the other.
pub(super) struct OnSpan<V> {
    pub span: usize,
    even: [V; 2],
    odd: [V; 2],
}

impl<V: Vector> OnSpan<V> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let zero = [V::splat(0.0); 2];
        Self {
            span: 0,
            even: zero,
            odd: zero,
        }
    }

    /// Adds a local force.
    #[inline(always)]
    pub(super) fn add(&mut self, rows: &[EndColumn; 6], force: &[f64; 6]) {
        for k in 0..3 {
            self.even = plus_column(self.even, &rows[2 * k], V::splat(force[2 * k]));
            self.odd = plus_column(self.odd, &rows[2 * k + 1], V::splat(force[2 * k + 1]));
        }
    }

    /// Gives the sum, and begins that of another span.
    #[inline(always)]
    pub(super) fn next(&mut self, span: usize) -> [V; 2] {
        let sum = [self.even[0].plus(self.odd[0]), self.even[1].plus(self.odd[1])];
        *self = Self { span, ..Self::new() };
        sum
    }

    /// Subtracts the sum from the guide's forces, and begins that of another span.
    #[inline(always)]
    fn take_from(&mut self, forces: &mut [Aligned<EndForces>], span: usize) {
        let guide = &mut forces[self.span][1];
        let (before, sum) = (load::<V>(guide), self.next(span));
        store([before[0].minus(sum[0]), before[1].minus(sum[1])], guide);
    }
}

impl Kernel for ContactSearch<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        self.open_gaps();
        self.search::<V>();
        self.evaluate::<V>();
        self.apply::<V>();
    }
}

impl ContactSearch<'_> {
    /// Opens the gaps that are searched again. Contacts of spans that the correction did not move keep their forces.
    #[inline(always)]
    fn open_gaps(&mut self) {
        let Interactions { inner, outer, .. } = &mut *self.interactions;
        if self.chain.active.whole {
            inner.clear();
            outer.clear();
            return;
        }
        let nodes = &self.chain.model.nodes;
        let moved = self.chain.active.spans.iter().enumerate().filter(|(_, moved)| **moved);
        for (l, _) in moved {
            let stations = nodes.first(l) + usize::from(l > 0)..nodes.first(l + 1) + 1;
            inner.open(stations.clone());
            outer.open(stations);
        }
    }

    /// Hands every closed gap to its layer: the lateral positions of eight stations of a span at a time against the
    /// clearances, then the velocity of those that touch only.
    #[inline(always)]
    fn search<V: Vector>(&mut self) {
        // Squares are compared, because the root of each distance would cost more than the search.
        let outer_squared = self.model.outer_clearance * self.model.outer_clearance;
        self.search_top::<V>(outer_squared);
        let (nodes, _) = self.state.q.as_chunks();
        let state = self.state;
        // The first station has no span above and was searched alone.
        for l in 0..self.chain.model.links.len() {
            if !self.chain.active.spans[l] {
                continue;
            }
            let link = &self.chain.model.links[l];

            // Lateral position of the pipe in the guide and of the guide in the bore.
            let [[y, z], guide] = self.chain.positions::<V>(nodes, &state.deflection[l], l);

            // A gap is closed beyond its clearance, Eq. 21. Lanes without a station are masked: an out-of-range state must
            // not close a gap there.
            let square = |y: V, z: V| y.times(y).plus_product(z, z);
            let stations = (1 << self.chain.model.nodes.elements(l)) - 1;
            let inner = square(y, z).above(V::load(&link.clearance_squared)) & stations;
            let outer = square(guide[0], guide[1]).above(V::splat(outer_squared)) & stations;
            let mut closed = inner | outer;
            // A span without a closed gap ends here: its velocities are not needed.
            if closed == 0 {
                continue;
            }

            // A bit per lane: the lowest one first, so that contacts are listed from the top down.
            let mut lanes = Aligned([[0.0; 8]; 4]);
            for (to, from) in lanes.iter_mut().zip([y, z, guide[0], guide[1]]) {
                from.store(to);
            }
            while closed != 0 {
                let lane = closed.trailing_zeros() as usize;
                closed &= closed - 1;
                let lateral = [[lanes[0][lane], lanes[1][lane]], [lanes[2][lane], lanes[3][lane]]];
                let is_closed = [inner >> lane & 1 == 1, outer >> lane & 1 == 1];
                self.push::<V>(l, lane + 1, lateral, is_closed);
            }
        }
    }

    /// The first station of the tool, which is in no span's lanes; the undeflected pipe lies on the bore's axis there.
    #[inline(always)]
    fn search_top<V: Vector>(&mut self, outer_squared: f64) {
        if !self.chain.active.spans[0] {
            return;
        }
        let top = &self.model.stations[0];
        let mut motions = [[0.0; 8]; 2];
        for (body, motion) in motions.iter_mut().enumerate() {
            self.chain.local::<V>(&self.state.q, 0, 0, body).store(motion);
        }
        let guide = Vector2::new(motions[1][1], motions[1][2]);
        let inner = top.offset + Vector2::new(motions[0][1], motions[0][2]) - guide;
        let is_closed = [
            inner.norm_squared() > top.inner_clearance * top.inner_clearance,
            guide.norm_squared() > outer_squared,
        ];
        if is_closed[0] | is_closed[1] {
            self.push::<V>(0, 0, [inner.into(), guide.into()], is_closed);
        }
    }

    /// Evaluates the law of the gap for the contacts that are left over from groups of eight.
    #[inline(always)]
    fn evaluate<V: Vector>(&mut self) {
        let Self {
            interactions,
            conditions,
            ..
        } = self;
        interactions.inner.finish::<V>(&conditions.inner);
        interactions.outer.finish::<V>(&conditions.outer);
    }
}
