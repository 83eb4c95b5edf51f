//! Contacts at all stations: found eight stations of a span at a time, evaluated by the law of the gap, and put on the
//! span's ends.

use nalgebra::Vector2;

use super::residual::{load, plus_column, product, store};
use super::{Reduced, at_ends};
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::elements::gap::GapVector;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

impl Reduced {
    /// Finds what touches and what it puts on the spans' ends.
    pub(super) fn contact_forces(
        &mut self,
        assembler: &mut Assembler,
        model: &Model,
        state: &State,
        conditions: &Conditions,
    ) {
        for &station in &self.hits {
            (assembler.inner[station], assembler.outer[station]) = (None, None);
        }
        self.hits.clear();
        self.any.fill(false);
        let instructions = self.instructions;
        instructions.run(Search {
            by: self,
            assembler,
            model,
            state,
            conditions,
        });
    }

    /// Local motions of pipe and guide at station `i` of span `l`, by end unknowns `x`.
    #[inline(always)]
    fn local<V: Vector>(&self, x: &[f64], l: usize, i: usize, body: usize) -> V {
        let columns = &self.kinds[self.links[l].kind].motion[i][body];
        let [top, bottom] = at_ends(x.as_chunks().0, l, body);
        let (mut above, mut below) = (V::splat(0.0), V::splat(0.0));
        if i < self.per {
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
}

struct Search<'a> {
    by: &'a mut Reduced,
    assembler: &'a mut Assembler,
    model: &'a Model,
    state: &'a State,
    conditions: &'a Conditions,
}

/// A local force's lanes with those of the rotations times a radius.
#[inline(always)]
pub(super) fn at_radius(force: &GapVector, radius: f64) -> [f64; 6] {
    [
        force[0],
        force[1],
        force[2],
        radius * force[3],
        radius * force[4],
        radius * force[5],
    ]
}

impl Search<'_> {
    /// Evaluates station `i` of span `l`, where `inner` and `outer` gap are closed as their flags say.
    #[inline(always)]
    fn touch<V: Vector>(&mut self, (l, i): (usize, usize), lateral: [Vector2<f64>; 2], closed: [bool; 2]) {
        let Self {
            by,
            assembler,
            model,
            state,
            conditions,
        } = self;
        let station = l * by.per + i;
        let at = &model.stations[station];
        let [inner_radius, outer_radius] = model.guide_radii;
        let mut lanes = Aligned([0.0; 8]);
        by.local::<V>(&state.v, l, i, 1).store(&mut lanes);
        let guide = GapVector::from_column_slice(&lanes[..6]);
        if !by.any[l] {
            by.any[l] = true;
            by.touched[l] = Aligned([[0.0; 16]; 2]);
        }
        let kind = &by.kinds[by.links[l].kind];
        let mut on_guide = [0.0; 6];
        if closed[0] {
            by.local::<V>(&state.v, l, i, 0).store(&mut lanes);
            let moving = at_radius(&guide, inner_radius);
            let velocity = GapVector::from_fn(|k, _| lanes[k] - moving[k]);
            let touch = conditions.inner.touch(lateral[0], at.inner_clearance, &velocity);
            if let Some(touch) = &touch {
                let force = touch.force();
                let mut sum = load::<V>(&by.touched[l][0]);
                for (row, f) in kind.force[i][0].iter().zip(force.iter()) {
                    sum = plus_column(sum, row, V::splat(-f));
                }
                store(sum, &mut by.touched[l][0]);
                on_guide = at_radius(&force, inner_radius);
            }
            assembler.inner[station] = touch;
        }
        if closed[1] {
            let velocity = GapVector::from_column_slice(&at_radius(&guide, outer_radius));
            let touch = conditions.outer.touch(lateral[1], model.outer_clearance, &velocity);
            if let Some(touch) = &touch {
                let force = at_radius(&touch.force(), outer_radius);
                (0..6).for_each(|k| on_guide[k] -= force[k]);
            }
            assembler.outer[station] = touch;
        }
        let mut sum = load::<V>(&by.touched[l][1]);
        for (row, f) in kind.force[i][1].iter().zip(on_guide) {
            sum = plus_column(sum, row, V::splat(f));
        }
        store(sum, &mut by.touched[l][1]);
        by.hits.push(station);
    }
}

impl Kernel for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        let outer_squared = self.model.outer_clearance * self.model.outer_clearance;
        // The first station belongs to no span's lanes; its pipe lies on the bore's axis.
        let top = &self.model.stations[0];
        let q = &self.state.q;
        let mut first = [[0.0; 8]; 2];
        self.by.local::<V>(q, 0, 0, 0).store(&mut first[0]);
        self.by.local::<V>(q, 0, 0, 1).store(&mut first[1]);
        let guide = Vector2::new(first[1][1], first[1][2]);
        let inner = top.offset + Vector2::new(first[0][1], first[0][2]) - guide;
        let closed = [
            inner.norm_squared() > top.inner_clearance * top.inner_clearance,
            guide.norm_squared() > outer_squared,
        ];
        if closed[0] | closed[1] {
            self.touch::<V>((0, 0), [inner, guide], closed);
        }
        let (nodes, _) = self.state.q.as_chunks();
        for l in 0..self.by.links.len() {
            let link = &self.by.links[l];
            let kind = &self.by.kinds[link.kind];
            let pipe = product::<V>(&kind.lateral[0], &at_ends(nodes, l, 0));
            let guide = product::<V>(&kind.lateral[1], &at_ends(nodes, l, 1));
            let y = V::load(&link.offset[0]).plus(pipe[0].minus(guide[0]));
            let z = V::load(&link.offset[1]).plus(pipe[1].minus(guide[1]));
            let square = |y: V, z: V| y.times(y).plus_product(z, z);
            let inner = square(y, z).above(V::load(&link.clearance_squared));
            let outer = square(guide[0], guide[1]).above(V::splat(outer_squared)) & ((1 << self.by.per) - 1);
            let mut any = inner | outer;
            if any == 0 {
                continue;
            }
            let mut lanes = Aligned([[0.0; 8]; 4]);
            for (to, from) in lanes.iter_mut().zip([y, z, guide[0], guide[1]]) {
                from.store(to);
            }
            while any != 0 {
                let lane = any.trailing_zeros() as usize;
                any &= any - 1;
                let lateral = [
                    Vector2::new(lanes[0][lane], lanes[1][lane]),
                    Vector2::new(lanes[2][lane], lanes[3][lane]),
                ];
                let closed = [inner >> lane & 1 == 1, outer >> lane & 1 == 1];
                self.touch::<V>((l, lane + 1), lateral, closed);
            }
        }
    }
}
