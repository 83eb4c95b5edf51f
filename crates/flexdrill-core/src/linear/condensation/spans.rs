//! The first step of an iteration: spans without contact between pipe and guide take the right-hand sides inside them
//! to their ends, and guides that touch the wall are eliminated anew.

use super::forward::{CondensedElimination, Mode};
use super::span::{End, gather};
use super::system::CondensedSystem;
use crate::linear::Singular;
use crate::linear::increment::{TangentIncrement, Touching};
use crate::simd::vector::Vector;

impl CondensedElimination {
    /// Finds the mode of every span and takes the right-hand sides inside pipes and untouched guides to the ends.
    #[inline(always)]
    pub(super) fn condense_spans<V: Vector>(
        &mut self,
        system: &CondensedSystem,
        increment: &TangentIncrement,
        rhs: &mut [f64],
    ) {
        let layout = system.layout();
        for (k, span) in system.spans.iter().enumerate() {
            let mut mode = Mode::Free;
            for touching in &increment.touching[span.first..span.first + span.inner] {
                match touching {
                    Touching::Both => mode = Mode::PipeContact,
                    Touching::Guide if mode == Mode::Free => mode = Mode::GuideContact,
                    _ => {}
                }
            }
            self.modes[k] = mode;
            if mode == Mode::PipeContact || span.inner == 0 {
                continue;
            }
            let ends = End::of(system, k);
            let forces = &mut self.forces;
            gather(forces, layout.offset(span.first), span.inner, rhs);
            let clamped = &mut self.pipes[k * self.room..(k + 1) * self.room];
            let onto = system.pipes[span.pipe].condense::<V>(forces, clamped);
            for i in 0..6 {
                rhs[ends.pipe[0] + i] += onto[i];
                rhs[ends.pipe[1] + i] += onto[6 + i];
            }
            if mode == Mode::Free {
                gather(forces, layout.offset(span.first) + 6, span.inner, rhs);
                let clamped = &mut self.guides[k * self.room..(k + 1) * self.room];
                let onto = system.guides[span.guide].substructure.condense::<V>(forces, clamped);
                for i in 0..6 {
                    rhs[ends.guide[0] + i] += onto[i];
                    rhs[ends.guide[1] + i] += onto[6 + i];
                }
            }
        }
    }

    /// Eliminates the guides that touch the wall.
    #[inline(always)]
    pub(super) fn condense_guides<V: Vector>(
        &mut self,
        system: &CondensedSystem,
        increment: &TangentIncrement,
        rhs: &mut [f64],
    ) -> Result<(), Singular> {
        let layout = system.layout();
        for (k, span) in system.spans.iter().enumerate() {
            if self.modes[k] != Mode::GuideContact {
                continue;
            }
            let inner = span.first..span.first + span.inner;
            gather(&mut self.forces, layout.offset(span.first) + 6, span.inner, rhs);
            self.condensed[k] = system.guides[span.guide]
                .chain
                .condense::<V>(
                    &increment.touching[inner.clone()],
                    &increment.contact[inner.clone()],
                    &self.forces,
                    &mut self.solved[inner],
                )
                .map_err(|(node, pivot)| Singular {
                    station: span.first + node,
                    pivot,
                })?;
            let ends = End::of(system, k);
            let right = &self.condensed[k].right;
            for i in 0..6 {
                rhs[ends.guide[0] + i] += right[0][i];
                rhs[ends.guide[1] + i] += right[1][i];
            }
        }
        Ok(())
    }
}
