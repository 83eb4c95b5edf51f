//! The first step of an iteration: spans without contact between pipe and guide take the right-hand sides inside them
//! to their ends, and guides that touch the wall are eliminated anew, like ones together.

use super::forward::{CondensedElimination, Mode};
use super::guide_contact_lanes::{Group, LANES};
use super::span::{End, gather};
use super::system::CondensedSystem;
use crate::linear::Singular;
use crate::linear::increment::{TangentIncrement, Touching};
use crate::simd::vector::Vector;

/// Spans from which on they are eliminated together: a group takes as long as three spans alone.
const WORTH: usize = 3;

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
        self.form_groups(system);
        for g in 0..self.groups.len() {
            self.condense_group::<V>(system, increment, g, rhs);
        }
        let layout = system.layout();
        for (k, span) in system.spans.iter().enumerate() {
            if self.modes[k] != Mode::GuideContact {
                continue;
            }
            if !self.grouped[k] {
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
            }
            let ends = End::of(system, k);
            let right = &self.condensed[k].right;
            for i in 0..6 {
                rhs[ends.guide[0] + i] += right[0][i];
                rhs[ends.guide[1] + i] += right[1][i];
            }
        }
        Ok(())
    }

    /// Puts spans with the same guide together, up to eight.
    fn form_groups(&mut self, system: &CondensedSystem) {
        self.groups.clear();
        self.grouped.fill(false);
        self.unfilled.fill(None);
        for (k, span) in system.spans.iter().enumerate() {
            if self.modes[k] != Mode::GuideContact {
                continue;
            }
            let g = match self.unfilled[span.guide] {
                Some(g) => g,
                None => {
                    self.groups.push(Group {
                        guide: span.guide,
                        spans: [k; LANES],
                        count: 0,
                    });
                    self.groups.len() - 1
                }
            };
            let group = &mut self.groups[g];
            // The lanes behind repeat it until another span comes.
            group.spans[group.count..].fill(k);
            group.count += 1;
            self.unfilled[span.guide] = Some(g).filter(|_| group.count < LANES);
        }
        self.groups.retain(|group| group.count >= WORTH);
    }

    /// Eliminates a group's guides; if some pivot will not do, they are left to be eliminated alone.
    #[inline(always)]
    fn condense_group<V: Vector>(
        &mut self,
        system: &CondensedSystem,
        increment: &TangentIncrement,
        g: usize,
        rhs: &[f64],
    ) {
        let group = &mut self.groups[g];
        let nodes = system.guides[group.guide].substructure.nodes();
        let forces = &mut self.lane_values[..nodes];
        for (lane, &k) in group.spans.iter().enumerate() {
            let first = system.layout().offset(system.spans[k].first) + 6;
            for (node, forces) in forces.iter_mut().enumerate() {
                for (to, from) in forces.iter_mut().zip(&rhs[first + 12 * node..first + 12 * node + 6]) {
                    to[lane] = *from;
                }
            }
        }
        let solved = &mut self.solved_lanes[g * self.longest..g * self.longest + nodes];
        let chain = &system.guides[group.guide].chain;
        if chain.condense_lanes::<V>(group, &system.spans, increment, forces, solved, &mut self.condensed) {
            for &k in &group.spans[..group.count] {
                self.grouped[k] = true;
            }
        } else {
            group.count = 0;
        }
    }
}
