//! One iteration's solution: spans condensed, joints eliminated from the top down, everything recovered from the bottom
//! up.

use super::guide_contact::{InterfaceMatrices, Solved, six};
use super::increment::{add_block, add_contact, add_guide, add_joint, take};
use super::joint_reduction::active;
use super::pivots::{self, halves_mut};
use super::system::{CondensedSystem, InterfaceCoupling, Matrices, place, spread};
use super::{Block, COLUMNS, Columns, GUIDE, MULTIPLIER, PaddedColumns, SIZE, U};
use crate::linear::increment::TangentIncrement;
use crate::linear::{Layout, Singular};
use crate::simd::vector::Vector;
use crate::simd::{Instructions, Kernel};

/// How a span takes part in this iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    /// No contact inside: condensed once per step size.
    Free,
    /// The guide touches the wall inside: its nodes are eliminated anew.
    GuideContact,
    /// The pipe touches the guide inside: its stations take part in the sweep.
    PipeContact,
}

/// A station as it was swept.
#[derive(Debug, Clone, Copy)]
pub(super) struct Swept {
    pub station: usize,
    /// Its node, unless it lies inside an open span.
    pub node: Option<usize>,
}

/// The elimination and its room; nothing is allocated after construction.
pub struct CondensedElimination {
    instructions: Instructions,
    pub(super) modes: Vec<Mode>,
    /// Right-hand sides and displacements inside the spans while their ends do not move: pipe, guide. `room` values
    /// each.
    pub(super) pipes: Vec<f64>,
    pub(super) guides: Vec<f64>,
    pub(super) room: usize,
    /// Right-hand sides inside a span.
    pub(super) forces: Vec<f64>,
    /// Guides eliminated anew, by station.
    pub(super) solved: Vec<Solved>,
    /// What the guides of the spans put on their ends in this iteration, where eliminated anew.
    pub(super) condensed: Vec<InterfaceMatrices>,
    pub(super) swept: Vec<Swept>,
    /// S^-1 (U, r) per swept station.
    pub(super) columns: Vec<Columns>,
    /// What of a joint's rows is left for the coupling below: c of u_b = P u_a + c, per node.
    pub(super) offsets: Vec<[f64; 3]>,
}

/// Where a swept station's coupling to the next one comes from.
struct Coupling<'a> {
    pipe: &'a InterfaceCoupling,
    guide_upper: &'a PaddedColumns,
    guide_lower: &'a PaddedColumns,
}

/// One solution, for every width of vectors.
struct Elimination<'a> {
    by: &'a mut CondensedElimination,
    system: &'a CondensedSystem,
    increment: &'a TangentIncrement,
    rhs: &'a mut [f64],
}

impl Kernel for Elimination<'_> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Result<(), Singular> {
        let Self {
            by,
            system,
            increment,
            rhs,
        } = self;
        by.condense_spans::<V>(system, increment, rhs);
        by.condense_guides::<V>(system, increment, rhs)?;
        by.sweep::<V>(system, increment, rhs)?;
        by.recover::<V>(system, rhs);
        by.recover_spans::<V>(system, rhs);
        Ok(())
    }
}

impl CondensedElimination {
    /// Room for systems of this layout.
    pub fn new(layout: &Layout, joints: &[usize], instructions: Instructions) -> Self {
        let stations = layout.stations();
        let last = stations - 1;
        let mut longest = 0;
        let mut previous = 0;
        for &station in joints.iter().chain([&last]) {
            longest = longest.max((station - previous).saturating_sub(1));
            previous = station;
        }
        let room = (6 * longest).next_multiple_of(8);
        let spans = joints.len() + 1;
        Self {
            instructions,
            modes: vec![Mode::Free; spans],
            pipes: vec![0.0; room * spans],
            guides: vec![0.0; room * spans],
            room,
            forces: vec![0.0; room],
            solved: vec![[[0.0; 8]; COLUMNS]; stations],
            condensed: vec![InterfaceMatrices::NOTHING; spans],
            swept: Vec::with_capacity(stations),
            columns: vec![[[0.0; SIZE]; COLUMNS]; stations],
            offsets: vec![[0.0; 3]; joints.len() + 2],
        }
    }

    /// Spans of the last solution as (without contact inside, with the guide eliminated anew, open).
    #[cfg(test)]
    pub fn span_counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for mode in &self.modes {
            counts[match mode {
                Mode::Free => 0,
                Mode::GuideContact => 1,
                Mode::PipeContact => 2,
            }] += 1;
        }
        counts
    }

    /// Solves (step_constant + increment) x = rhs; `rhs` becomes x.
    ///
    /// # Errors
    /// When a block cannot be factorised.
    pub fn solve(
        &mut self,
        system: &CondensedSystem,
        increment: &TangentIncrement,
        rhs: &mut [f64],
    ) -> Result<(), Singular> {
        let instructions = self.instructions;
        instructions.run(Elimination {
            by: self,
            system,
            increment,
            rhs,
        })
    }

    /// From the top down.
    #[inline(always)]
    fn sweep<V: Vector>(
        &mut self,
        system: &CondensedSystem,
        increment: &TangentIncrement,
        rhs: &[f64],
    ) -> Result<(), Singular> {
        let layout = system.layout();
        self.swept.clear();
        // What one swept station puts on the next.
        let mut carry = [[0.0; SIZE]; COLUMNS];
        for (k, node) in system.nodes.iter().enumerate() {
            let matrices = &system.matrices[node.matrices];
            let above = k.checked_sub(1).map(|above| self.modes[above]);
            let below = self.modes.get(k).copied().filter(|_| k < system.spans.len());
            let open = |mode: Option<Mode>| mode == Some(Mode::PipeContact);
            let mut block = if open(above) || open(below) {
                let mut block = matrices.own;
                for (condensed, part) in [(!open(above), &matrices.above), (!open(below), &matrices.below)] {
                    if condensed {
                        add_block(&mut block, part);
                    }
                }
                block
            } else {
                matrices.condensed
            };
            if let Some(span) = k.checked_sub(1)
                && !open(above)
            {
                add_guide(&mut block, &self.guide_of(system, span).bottom);
            }
            if below.is_some() && !open(below) {
                add_guide(&mut block, &self.guide_of(system, k).top);
            }
            add_contact(&mut block, increment, node.station);
            if let Some(joint) = node.joint {
                add_joint(&mut block, &increment.joints[joint]);
            }
            let mut right = self.right_hand_side(matrices, k, layout.offset(node.station), rhs, open(below));
            take(&mut block, &mut right, &carry);
            let out = if node.joint.is_some() { U } else { 0 };
            let swept = Swept {
                station: node.station,
                node: Some(k),
            };
            let Some(span) = system.spans.get(k) else {
                self.last::<V>(&mut block, &right, swept)?;
                break;
            };
            if !open(below) {
                let guide = self.guide_of(system, k);
                let (guide_upper, guide_lower) = (guide.upper, guide.lower);
                let coupling = Coupling {
                    pipe: &system.couplings[span.coupling_of_pipe],
                    guide_upper: &guide_upper,
                    guide_lower: &guide_lower,
                };
                self.step::<V>(&mut block, &right, swept, out, Some(k), &coupling, &mut carry)?;
                continue;
            }
            // The span's stations one by one.
            let mut swept = swept;
            let (mut out, mut reduction, mut from) = (out, matrices.reduction.as_ref(), Some(k));
            for station in span.first..=span.first + span.inner {
                let (upper, lower) = (
                    &system.step_constant.upper[station - 1],
                    &system.step_constant.lower[station - 1],
                );
                let coupling_of_pipe = InterfaceCoupling::of(&upper.pipe, &lower.pipe, reduction);
                let (guide_upper, guide_lower): (PaddedColumns, PaddedColumns) = (six(&upper.guide), six(&lower.guide));
                let coupling = Coupling {
                    pipe: &coupling_of_pipe,
                    guide_upper: &guide_upper,
                    guide_lower: &guide_lower,
                };
                self.step::<V>(&mut block, &right, swept, out, from, &coupling, &mut carry)?;
                if station == span.first + span.inner {
                    break;
                }
                let own = &system.step_constant.diagonal.plain[layout.slot(station)];
                block = spread(|i, j| own[(i, j)]);
                add_contact(&mut block, increment, station);
                right = plain_right_hand_side(layout.offset(station), rhs);
                take(&mut block, &mut right, &carry);
                swept = Swept { station, node: None };
                (out, reduction, from) = (0, None, None);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn guide_of<'a>(&'a self, system: &'a CondensedSystem, span: usize) -> &'a InterfaceMatrices {
        if self.modes[span] == Mode::GuideContact {
            &self.condensed[span]
        } else {
            &system.guides[system.spans[span].guide].clamped
        }
    }

    /// A node's right-hand side, with what c of u_b = P u_a + c takes from it.
    #[inline(always)]
    fn right_hand_side(
        &mut self,
        matrices: &Matrices,
        node: usize,
        offset: usize,
        rhs: &[f64],
        open_below: bool,
    ) -> [f64; SIZE] {
        let Some(reduction) = &matrices.reduction else {
            let mut right = plain_right_hand_side(offset, rhs);
            // The tie's multiplier, which only a large block has.
            if matrices.own[MULTIPLIER][MULTIPLIER] == 0.0 {
                right[MULTIPLIER] = rhs[offset + 18];
            }
            self.offsets[node] = [0.0; 3];
            return right;
        };
        let mut values = [0.0; 24];
        values.copy_from_slice(&rhs[offset..offset + 24]);
        let mut right = reduction.rows(&values);
        let start = if open_below {
            &matrices.own_start
        } else {
            &matrices.start
        };
        let c = reduction
            .recover
            .map(|r| r[0] * values[18] + r[1] * values[19] + r[2] * values[20]);
        for (column, c) in start.columns.iter().zip(c) {
            for (r, x) in right.iter_mut().zip(column) {
                *r -= x * c;
            }
        }
        self.offsets[node] = c;
        right
    }

    /// Eliminates a station that another follows.
    #[expect(clippy::too_many_arguments, reason = "one station's data, each used once")]
    #[inline(always)]
    fn step<V: Vector>(
        &mut self,
        block: &mut Block,
        right: &[f64; SIZE],
        swept: Swept,
        out: usize,
        node: Option<usize>,
        coupling: &Coupling<'_>,
        carry: &mut Columns,
    ) -> Result<(), Singular> {
        let columns = &mut self.columns[self.swept.len()];
        for j in 0..6 {
            columns[j] = [0.0; SIZE];
            columns[6 + j] = [0.0; SIZE];
            for i in 0..6 {
                columns[j][out + i] = coupling.pipe.upper[j][i];
                columns[6 + j][GUIDE + i] = coupling.guide_upper[j][i];
            }
        }
        columns[12] = *right;
        self.swept.push(swept);
        let singular = |pivot| Singular {
            station: swept.station,
            pivot,
        };
        if out == U {
            pivots::sixteen::<V, COLUMNS>(block, columns, active).map_err(singular)?;
        } else {
            pivots::sixteen::<V, COLUMNS>(block, columns, |k| if k < GUIDE { 6 } else { 12 }).map_err(singular)?;
        }
        // Two halves of eight rows: the pipe is in the first, the guide in the second from its second row on.
        let mut guide_lower = [[0.0; 8]; 6];
        for (to, from) in guide_lower.iter_mut().zip(coupling.guide_lower) {
            to[1..7].copy_from_slice(&from[..6]);
        }
        for (carry, column) in carry.iter_mut().zip(columns.iter()) {
            let (mut pipe, mut guide) = (V::splat(0.0), V::splat(0.0));
            for j in 0..6 {
                pipe = pipe.plus_product(V::load(&coupling.pipe.lower[j]), V::splat(column[out + j]));
                guide = guide.plus_product(V::load(&guide_lower[j]), V::splat(column[GUIDE + j]));
            }
            let halves = halves_mut(carry);
            pipe.store(&mut halves[0]);
            guide.store(&mut halves[1]);
        }
        if let Some(node) = node {
            for (column, c) in coupling.pipe.lower_offset.iter().zip(self.offsets[node]) {
                for (r, x) in carry[12].iter_mut().zip(&column[..6]) {
                    *r += x * c;
                }
            }
        }
        Ok(())
    }

    /// Eliminates the last station.
    #[inline(always)]
    fn last<V: Vector>(&mut self, block: &mut Block, right: &[f64; SIZE], swept: Swept) -> Result<(), Singular> {
        let mut column = [*right];
        pivots::sixteen::<V, 1>(block, &mut column, |_| 0).map_err(|pivot| Singular {
            station: swept.station,
            pivot,
        })?;
        let columns = &mut self.columns[self.swept.len()];
        columns[..12].fill([0.0; SIZE]);
        columns[12] = column[0];
        self.swept.push(swept);
        Ok(())
    }
}

/// The right-hand side of a station with one pipe node.
#[inline(always)]
fn plain_right_hand_side(offset: usize, rhs: &[f64]) -> [f64; SIZE] {
    let mut right = [0.0; SIZE];
    for k in 0..12 {
        right[place(k)] = rhs[offset + k];
    }
    right
}
