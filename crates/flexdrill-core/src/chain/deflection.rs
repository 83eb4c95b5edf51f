//! How spans deflect between their ends: the static deflection of inner stations under weight and what effects push
//! inside, the ends held, w = K_ii^-1 f_i.
//!
//! The slaving moves inner stations with the ends, and transfers their forces to the ends. The rest of the static
//! solution is this deflection, which opens and closes gaps: with a soft guide by enough to change the force on the wall
//! by 1 %. A step counts with the deflection that the forces at its start make. That is as good as solving for it, since
//! a span inside is far stiffer than what pushes there. The lag leaves out the ratio of the two stiffnesses times the change of
//! the force.

use super::Chain;
use super::columns::{EndColumn, at_ends};
use super::effect::Effect;
use crate::dynamics::state::{Deflection, State, translation};
use crate::model::Model;

impl Chain {
    /// How the spans are deflected in `full`, whose ends are those of `to`.
    pub(super) fn take_deflections(&self, model: &Model, full: &State, to: &mut State) {
        let (nodes, _) = to.q.as_chunks();
        for (l, (deflection, link)) in to.deflection.iter_mut().zip(&self.model.links).enumerate() {
            for (body, deflection) in deflection.iter_mut().enumerate() {
                *deflection = [0.0; 16];
                let [top, bottom] = at_ends(nodes, l, body);
                for i in 1..self.model.nodes.elements(l) {
                    let station = &model.stations[self.model.nodes.first(l) + i];
                    let at = if body == 0 {
                        station.pipe_to_station * translation(&full.q, station.pipe_above)
                    } else {
                        translation(&full.q, station.guide)
                    };
                    for (lane, at) in [(i - 1, at.y), (8 + i - 1, at.z)] {
                        let columns = self.model.kinds[link.kind].lateral[body].iter();
                        let slaved = columns
                            .zip(top.iter().chain(&bottom))
                            .map(|(column, x)| column[lane] * x);
                        deflection[lane] = at - slaved.sum::<f64>();
                    }
                }
            }
        }
    }

    /// How the spans deflect under what effects push inside them as the last residual found it, and under their weight, into
    /// `to`.
    pub(super) fn deflect_spans(&self, effects: &impl Effect, to: &mut [Deflection]) {
        to.iter_mut()
            .zip(&self.model.links)
            .for_each(|(to, link)| *to = *link.by_weight);
        effects.deflect(self, to);
    }

    /// Deflections by local forces at station `i` of span `l`, of pipe and guide; `None` at a span's end.
    #[inline(always)]
    pub(crate) fn deflection(&self, l: usize, i: usize) -> Option<&[[EndColumn; 6]; 2]> {
        let deflection = &self.model.kinds[self.model.links[l].kind].deflection;
        deflection.get(i.checked_sub(1)?).map(|deflection| &**deflection)
    }
}
