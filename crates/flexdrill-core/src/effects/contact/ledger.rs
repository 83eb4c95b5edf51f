//! What contacts store, take and deflect at the end of a step.

use super::Contact;
use super::force::OnSpan;
use crate::chain::columns::{EndColumn, at_radius, load, plus_rows, store};
use crate::chain::{Chain, add_to_ends};
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::state::Deflection;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Contact {
    /// Adds the friction on the ends of the spans and the power of the damping to `point`. Gives the energy in the springs (J).
    pub(super) fn rub(&self, chain: &Chain, point: &mut LedgerPoint) -> f64 {
        chain.model.instructions.run(Friction {
            chain,
            point,
            contact: self,
        })
    }

    /// Adds how the spans deflect between their ends under the contacts.
    pub(super) fn deflect_spans(&self, chain: &Chain, to: &mut [Deflection]) {
        chain.model.instructions.run(Deflections {
            chain,
            to,
            contact: self,
        });
    }
}

/// Friction of all contacts into `point`, with the power of their damping. Gives the energy in their springs (J).
struct Friction<'a> {
    chain: &'a Chain,
    point: &'a mut LedgerPoint,
    contact: &'a Contact,
}

impl Kernel for Friction<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let Self { chain, point, contact } = self;
        let (layers, radii) = (&contact.layers, contact.radii);
        let mut stored = 0.0;
        for (station, touch) in layers.inner.iter() {
            let (l, i) = chain.span_of(station);
            let [on_pipe, on_guide] = &chain.model.kind(l).force[i].0;
            let force = touch.friction_force();
            let mut on = on_ends::<V>(on_pipe, &force);
            add_to_ends(&mut point.friction, l, 0, &on);
            on = on_ends::<V>(on_guide, &at_radius(&force, radii[0]));
            on.iter_mut().for_each(|x| *x = -*x);
            add_to_ends(&mut point.friction, l, 1, &on);
            stored += touch.energy;
            point.sums.touch_dissipation += touch.dissipation;
        }
        let mut sum = OnSpan::<V>::new();
        let mut on = [0.0; 16];
        for (station, touch) in layers.outer.iter() {
            let (l, i) = chain.span_of(station);
            if l != sum.span {
                let span = sum.span;
                store(sum.next(l), &mut on);
                add_to_ends(&mut point.friction, span, 1, &on);
            }
            let rows = &chain.model.kind(l).force[i][1];
            sum.add(rows, &at_radius(&touch.friction_force(), radii[1]));
            stored += touch.energy;
            point.sums.touch_dissipation += touch.dissipation;
        }
        let span = sum.span;
        store(sum.next(span), &mut on);
        add_to_ends(&mut point.friction, span, 1, &on);
        stored
    }
}

/// Forces on both ends of a span by a local force `x`.
#[inline(always)]
fn on_ends<V: Vector>(rows: &[EndColumn; 6], x: &[f64; 6]) -> EndColumn {
    let mut out = [0.0; 16];
    store(plus_rows([V::splat(0.0); 2], rows, x), &mut out);
    out
}

struct Deflections<'a> {
    chain: &'a Chain,
    to: &'a mut [Deflection],
    contact: &'a Contact,
}

impl Kernel for Deflections<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { chain, to, contact } = self;
        let (layers, [inner_radius, outer_radius]) = (&contact.layers, contact.radii);
        for (station, touch) in layers.inner.iter() {
            let (l, i) = chain.span_of(station);
            if let Some([by_pipe, by_guide]) = chain.deflection(l, i) {
                let on_pipe = touch.force();
                let mut on_guide = at_radius(&on_pipe, inner_radius);
                on_guide.iter_mut().for_each(|x| *x = -*x);
                let [pipe, guide] = &mut to[l];
                store(plus_rows::<V>(load(pipe), by_pipe, &on_pipe), pipe);
                store(plus_rows::<V>(load(guide), by_guide, &on_guide), guide);
            }
        }
        for (station, touch) in layers.outer.iter() {
            let (l, i) = chain.span_of(station);
            if let Some([_, by_guide]) = chain.deflection(l, i) {
                let on_guide = at_radius(&touch.force(), outer_radius);
                let guide = &mut to[l][1];
                store(plus_rows::<V>(load(guide), by_guide, &on_guide), guide);
            }
        }
    }
}
