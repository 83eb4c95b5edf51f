//! The gaps that are closed, found eight stations of a span at a time, evaluated by their law eight contacts at a time, and
//! applied to the ends of the spans.

use nalgebra::Vector2;

use super::law::GapLaw;
use super::{Contact, Layers, laws};
use crate::chain::columns::{EndColumn, EndForces, at_radius, load, plus_column, plus_rows, store};
use crate::chain::{Chain, Inside, Under};
use crate::dynamics::state::State;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

impl Contact {
    /// Finds the contacts at `state`, evaluates them, and applies them to the ends of the spans.
    pub(super) fn search(&mut self, chain: &mut Chain, state: &State, under: &Under<'_>) {
        let instructions = chain.model.instructions;
        instructions.run(Search {
            chain,
            layers: &mut self.layers,
            clearance_squared: &self.clearance_squared,
            model: under.model,
            state,
            laws: laws(&under.model.description, under.conditions),
            advance: under.conditions.rate_of_penetration,
            arms: self.radii.map(|r| Aligned([1.0, 1.0, 1.0, r, r, r, 0.0, 0.0])),
        });
    }
}

/// One in the lane along the axis.
static ALONG: [f64; 8] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

struct Search<'a> {
    chain: &'a mut Chain,
    layers: &'a mut Layers,
    /// See [`Contact`].
    clearance_squared: &'a [Aligned<[f64; 8]>],
    model: &'a Model,
    state: &'a State,
    /// Of both layers.
    laws: [GapLaw; 2],
    /// Rate at which the wall moves up past the guide (m/s).
    advance: f64,
    /// Per layer, what the guide's motions count with in the gap: those of the rotations with its radius.
    arms: [Aligned<[f64; 8]>; 2],
}

/// Local velocity of the pipe (0) or the guide (1) at a station, and its travel since the start of the step: bristles compare
/// positions and not velocities.
#[inline(always)]
fn motion<V: Vector>(chain: &Chain, layers: &Layers, state: &State, (l, i): (usize, usize), body: usize) -> [V; 2] {
    if layers.has_bristles {
        return chain.local([&state.v, &layers.travel], l, i, body);
    }
    let [velocity] = chain.local([&state.v], l, i, body);
    [velocity, V::splat(0.0)]
}

impl Search<'_> {
    /// Hands station `i` of span `l` to the layers whose gap is closed there, with its lateral positions and velocities.
    #[inline(always)]
    fn push<V: Vector>(&mut self, l: usize, i: usize, lateral: [[f64; 2]; 2], is_closed: [bool; 2]) {
        let Self {
            chain,
            layers,
            model,
            state,
            laws,
            advance,
            arms,
            ..
        } = self;
        // The radii and levers are in the columns of the motion;
        // positions and velocities are local to the station.
        let station = chain.station(l, i);
        let advance = *advance;
        let guide = motion::<V>(chain, layers, state, (l, i), 1);
        // The residual adds forces inside marked spans only, which are zero where nothing has marked them yet.
        chain.inside(l);
        if is_closed[0] {
            let pipe = motion::<V>(chain, layers, state, (l, i), 0);
            let arm = V::load(&arms[0]);
            let clearance = model.stations[station].inner_clearance;
            let layer = &mut layers.inner;
            // The travel is handed over before the contact, which queues until eight lanes are full.
            layer.set_travel(pipe[1].minus_product(guide[1], arm));
            let velocity = pipe[0].minus_product(guide[0], arm);
            layer.push::<V>(&laws[0], station, lateral[0], clearance, velocity);
        }
        if is_closed[1] {
            // The hole moves past the guide by the advance. Only the motion along it has that part.
            let (arm, along) = (V::load(&arms[1]), V::load(&ALONG));
            let mut velocity = guide[0].times(arm);
            if advance != 0.0 {
                velocity = velocity.plus_product(along, V::splat(advance));
            }
            let travel = guide[1].times(arm).plus_product(along, V::splat(advance * layers.step));
            let layer = &mut layers.outer;
            layer.set_travel(travel);
            layer.push::<V>(&laws[1], station, lateral[1], model.outer_clearance, velocity);
        }
    }

    /// Applies all contacts to the ends of their spans.
    #[inline(always)]
    fn apply<V: Vector>(&mut self) {
        let Self {
            chain, layers, model, ..
        } = self;
        let [inner_radius, outer_radius] = model.guide_radii;
        // Only spans that moved are summed again; the forces of the others are unchanged to the bit.
        let Inside {
            model: chain,
            forces,
            moved,
        } = chain.forces_inside();
        let moved = |station: usize| moved[chain.span_of(station).0];
        for (station, touch) in layers.inner.among(moved) {
            let (l, i) = chain.span_of(station);
            let [on_pipe, on_guide] = &chain.kind(l).force[i].0;
            let force = touch.force();
            let [pipe, guide] = &mut forces[l].0;
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
        for (station, touch) in layers.outer.among(moved) {
            let (l, i) = chain.span_of(station);
            if l != sum.span {
                sum.take_from(forces, l);
            }
            let rows = &chain.kind(l).force[i][1];
            sum.add(rows, &at_radius(&touch.force(), outer_radius));
        }
        // Taking the first span again writes the sum of the last one.
        sum.take_from(forces, 0);
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

impl Kernel for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        self.open_gaps();
        self.layers.move_to(&self.state.q);
        self.search::<V>();
        self.evaluate::<V>();
        self.apply::<V>();
    }
}

impl Search<'_> {
    /// Opens the gaps that are searched again. Contacts of spans that the correction did not move keep their forces.
    #[inline(always)]
    fn open_gaps(&mut self) {
        let Layers { inner, outer, .. } = &mut *self.layers;
        if self.chain.is_whole() {
            inner.clear();
            outer.clear();
            return;
        }
        for l in (0..self.chain.spans()).filter(|&l| self.chain.is_active(l)) {
            let below = self.chain.stations_below(l);
            let stations = below.start - usize::from(l == 0)..below.end;
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
        for l in 0..self.chain.spans() {
            if !self.chain.is_active(l) {
                continue;
            }

            // Lateral position of the pipe in the guide and of the guide in the bore.
            let [[y, z], guide] = self.chain.positions::<V>(nodes, &state.deflection[l], l);

            // A gap is closed beyond its clearance, Eq. 21. Lanes without a station are masked: an out-of-range state must
            // not close a gap there.
            let square = |y: V, z: V| y.times(y).plus_product(z, z);
            let stations = (1 << self.chain.stations_below(l).len()) - 1;
            let inner = square(y, z).above(V::load(&self.clearance_squared[l])) & stations;
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
        if !self.chain.is_active(0) {
            return;
        }
        let top = &self.model.stations[0];
        let mut motions = [[0.0; 8]; 2];
        for (body, motion) in motions.iter_mut().enumerate() {
            let [at] = self.chain.local::<V, 1>([&self.state.q], 0, 0, body);
            at.store(motion);
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
        let Self { layers, laws, .. } = self;
        layers.inner.finish::<V>(&laws[0]);
        layers.outer.finish::<V>(&laws[1]);
    }
}
