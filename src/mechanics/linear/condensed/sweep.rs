//! One iteration's solution: spans condensed, joints eliminated from the top down, everything recovered from the bottom up.

use nalgebra::Matrix6;

use super::super::changes::{Changes, JointChange, Touching};
use super::super::instructions::Instructions;
use super::super::reduction::{PLACES, active};
#[cfg(target_arch = "x86_64")]
use super::super::vector::{Avx2, Avx512};
use super::super::vector::{Portable, Vector};
use super::super::{Layout, Singular};
use super::guide_span::{Condensed, Solved, expand, six};
use super::operator::{Edge, Matrices, Operator, place, spread};
use super::pivots::{self, halves_mut, load};
use super::{BELOW, Block, COLUMNS, Columns, GUIDE, MULTIPLIER, SIZE, Six, U};

/// How a span takes part in this iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    /// No contact inside: condensed as made.
    Still,
    /// The guide touches the wall inside: its nodes eliminated anew.
    Guide,
    /// The pipe touches the guide inside: its stations are in the sweep.
    Open,
}

/// A station as it was swept.
#[derive(Debug, Clone, Copy)]
struct Swept {
    station: usize,
    /// Its node, unless it lies inside an open span.
    node: Option<usize>,
}

/// The elimination and its room; nothing is allocated after construction.
pub struct CondensedElimination {
    instructions: Instructions,
    modes: Vec<Mode>,
    /// Right-hand sides and displacements inside the spans while their ends do not move: pipe, guide. `room` values each.
    pipes: Vec<f64>,
    guides: Vec<f64>,
    room: usize,
    /// Right-hand sides inside a span.
    forces: Vec<f64>,
    /// Guides eliminated anew, by station.
    solved: Vec<Solved>,
    /// What the guides of the spans put on their ends in this iteration, where eliminated anew.
    condensed: Vec<Condensed>,
    swept: Vec<Swept>,
    /// S^-1 (U, r) per swept station.
    columns: Vec<Columns>,
    /// What of a joint's rows is left for the coupling below: c of u_b = P u_a + c, per node.
    offsets: Vec<[f64; 3]>,
}

/// What one swept station puts on the next.
struct Carry {
    columns: Columns,
}

/// Where a swept station's coupling to the next one comes from.
struct Coupling<'a> {
    pipe: &'a Edge,
    guide_upper: &'a Six,
    guide_lower: &'a Six,
}

impl CondensedElimination {
    /// Room for systems of this layout, with the best instructions of this machine.
    pub fn new(layout: &Layout, joints: &[usize]) -> Self {
        Self::with(layout, joints, Instructions::of_this_machine())
    }

    /// Every path that this machine can take, named. They are held against each other.
    pub fn all_paths(layout: &Layout, joints: &[usize]) -> Vec<(String, Self)> {
        Instructions::all()
            .filter(Instructions::available)
            .map(|instructions| (format!("{instructions:?}"), Self::with(layout, joints, instructions)))
            .collect()
    }

    fn with(layout: &Layout, joints: &[usize], instructions: Instructions) -> Self {
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
        let nothing = Condensed {
            top: [[0.0; 8]; 6],
            bottom: [[0.0; 8]; 6],
            upper: [[0.0; 8]; 6],
            lower: [[0.0; 8]; 6],
            right: [[0.0; 8]; 2],
        };
        Self {
            instructions,
            modes: vec![Mode::Still; spans],
            pipes: vec![0.0; room * spans],
            guides: vec![0.0; room * spans],
            room,
            forces: vec![0.0; room],
            solved: vec![[[0.0; 8]; COLUMNS]; stations],
            condensed: vec![nothing; spans],
            swept: Vec::with_capacity(stations),
            columns: vec![[[0.0; SIZE]; COLUMNS]; stations],
            offsets: vec![[0.0; 3]; joints.len() + 2],
        }
    }

    /// Spans of the last solution as (without contact inside, with the guide eliminated anew, open).
    pub fn span_counts(&self) -> [usize; 3] {
        [Mode::Still, Mode::Guide, Mode::Open].map(|mode| self.modes.iter().filter(|&&m| m == mode).count())
    }

    /// Solves (lasting + changes) x = rhs; `rhs` becomes x.
    ///
    /// # Errors
    /// When a block cannot be factorised.
    pub fn solve(&mut self, operator: &Operator, changes: &Changes, rhs: &mut [f64]) -> Result<(), Singular> {
        match self.instructions {
            Instructions::Portable => self.run::<Portable>(operator, changes, rhs),
            // SAFETY: chosen only where the processor was found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => unsafe { self.run_avx2(operator, changes, rhs) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => unsafe { self.run_avx512(operator, changes, rhs) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn run_avx2(&mut self, operator: &Operator, changes: &Changes, rhs: &mut [f64]) -> Result<(), Singular> {
        self.run::<Avx2>(operator, changes, rhs)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn run_avx512(&mut self, operator: &Operator, changes: &Changes, rhs: &mut [f64]) -> Result<(), Singular> {
        self.run::<Avx512>(operator, changes, rhs)
    }

    #[inline(always)]
    fn run<V: Vector>(&mut self, operator: &Operator, changes: &Changes, rhs: &mut [f64]) -> Result<(), Singular> {
        self.condense_spans::<V>(operator, changes, rhs)?;
        self.sweep::<V>(operator, changes, rhs)?;
        self.recover::<V>(operator, rhs);
        self.recover_spans::<V>(operator, rhs);
        Ok(())
    }

    /// Takes the inner stations' right-hand sides to the ends of their spans.
    #[inline(always)]
    fn condense_spans<V: Vector>(
        &mut self,
        operator: &Operator,
        changes: &Changes,
        rhs: &mut [f64],
    ) -> Result<(), Singular> {
        let layout = operator.layout();
        for (k, span) in operator.spans.iter().enumerate() {
            let inner = span.first..span.first + span.inner;
            let mut mode = Mode::Still;
            for touching in &changes.touching[inner.clone()] {
                match touching {
                    Touching::Both => mode = Mode::Open,
                    Touching::Guide if mode == Mode::Still => mode = Mode::Guide,
                    _ => {}
                }
            }
            self.modes[k] = mode;
            if mode == Mode::Open || span.inner == 0 {
                continue;
            }
            let ends = End::of(operator, k);
            let forces = &mut self.forces;
            gather(forces, layout.offset(span.first), span.inner, rhs);
            let still = &mut self.pipes[k * self.room..(k + 1) * self.room];
            let onto = operator.pipes[span.pipe].condense::<V>(forces, still);
            for i in 0..6 {
                rhs[ends.pipe[0] + i] += onto[i];
                rhs[ends.pipe[1] + i] += onto[6 + i];
            }
            gather(forces, layout.offset(span.first) + 6, span.inner, rhs);
            let guide = &operator.guides[span.guide];
            if mode == Mode::Still {
                let still = &mut self.guides[k * self.room..(k + 1) * self.room];
                let onto = guide.body.condense::<V>(forces, still);
                for i in 0..6 {
                    rhs[ends.guide[0] + i] += onto[i];
                    rhs[ends.guide[1] + i] += onto[6 + i];
                }
            } else {
                let condensed = guide
                    .chain
                    .condense::<V>(
                        &changes.touching[inner.clone()],
                        &changes.contact[inner.clone()],
                        forces,
                        &mut self.solved[inner],
                    )
                    .map_err(|(node, pivot)| Singular {
                        station: span.first + node,
                        pivot,
                    })?;
                for i in 0..6 {
                    rhs[ends.guide[0] + i] += condensed.right[0][i];
                    rhs[ends.guide[1] + i] += condensed.right[1][i];
                }
                self.condensed[k] = condensed;
            }
        }
        Ok(())
    }

    /// From the top down.
    #[inline(always)]
    fn sweep<V: Vector>(&mut self, operator: &Operator, changes: &Changes, rhs: &[f64]) -> Result<(), Singular> {
        let layout = operator.layout();
        self.swept.clear();
        let mut carry = Carry {
            columns: [[0.0; SIZE]; COLUMNS],
        };
        for (k, node) in operator.nodes.iter().enumerate() {
            let matrices = &operator.matrices[node.matrices];
            let above = k.checked_sub(1).map(|above| self.modes[above]);
            let below = self.modes.get(k).copied().filter(|_| k < operator.spans.len());
            let open = |mode: Option<Mode>| mode == Some(Mode::Open);
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
                add_guide(&mut block, &self.guide_of(operator, span).bottom);
            }
            if below.is_some() && !open(below) {
                add_guide(&mut block, &self.guide_of(operator, k).top);
            }
            add_contact(&mut block, changes, node.station);
            if let Some(joint) = node.joint {
                add_joint(&mut block, &changes.joints[joint]);
            }
            let mut right = self.right_hand_side(matrices, k, layout.offset(node.station), rhs, open(below));
            take(&mut block, &mut right, &carry);
            let out = if node.joint.is_some() { U } else { 0 };
            let swept = Swept {
                station: node.station,
                node: Some(k),
            };
            let Some(span) = operator.spans.get(k) else {
                self.last::<V>(&mut block, &right, swept)?;
                break;
            };
            if !open(below) {
                let guide = self.guide_of(operator, k);
                let (guide_upper, guide_lower) = (guide.upper, guide.lower);
                let coupling = Coupling {
                    pipe: &operator.edges[span.edge],
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
                    &operator.lasting.upper[station - 1],
                    &operator.lasting.lower[station - 1],
                );
                let edge = Edge::of(&upper.pipe, &lower.pipe, reduction);
                let (guide_upper, guide_lower): (Six, Six) = (six(&upper.guide), six(&lower.guide));
                let coupling = Coupling {
                    pipe: &edge,
                    guide_upper: &guide_upper,
                    guide_lower: &guide_lower,
                };
                self.step::<V>(&mut block, &right, swept, out, from, &coupling, &mut carry)?;
                if station == span.first + span.inner {
                    break;
                }
                let own = &operator.lasting.diagonal.plain[layout.slot(station)];
                block = spread(|i, j| own[(i, j)]);
                add_contact(&mut block, changes, station);
                right = plain_right_hand_side(layout.offset(station), rhs);
                take(&mut block, &mut right, &carry);
                swept = Swept { station, node: None };
                (out, reduction, from) = (0, None, None);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn guide_of<'a>(&'a self, operator: &'a Operator, span: usize) -> &'a Condensed {
        if self.modes[span] == Mode::Guide {
            &self.condensed[span]
        } else {
            &operator.guides[operator.spans[span].guide].still
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
        carry: &mut Carry,
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
        for (carry, column) in carry.columns.iter_mut().zip(columns.iter()) {
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
                for (r, x) in carry.columns[12].iter_mut().zip(&column[..6]) {
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

    /// From the bottom up: every swept station's unknowns.
    #[inline(always)]
    fn recover<V: Vector>(&mut self, operator: &Operator, rhs: &mut [f64]) {
        let layout = operator.layout();
        // Rotations, displacement, guide of the station below.
        let mut below = [0.0; 12];
        for (swept, columns) in self.swept.iter().zip(&self.columns).rev() {
            let offset = layout.offset(swept.station);
            // Two sums in each half: half as long a chain.
            let (mut even, mut odd): ([V; 2], [V; 2]) = (load(&columns[12]), [V::splat(0.0); 2]);
            for j in 0..6 {
                let (first, second): ([V; 2], [V; 2]) = (load(&columns[2 * j]), load(&columns[2 * j + 1]));
                for half in 0..2 {
                    even[half] = even[half].minus_product(first[half], V::splat(below[2 * j]));
                    odd[half] = odd[half].minus_product(second[half], V::splat(below[2 * j + 1]));
                }
            }
            let mut x = [0.0; SIZE];
            for (half, place) in halves_mut(&mut x).iter_mut().enumerate() {
                even[half].plus(odd[half]).store(place);
            }
            let matrices = swept.node.map(|node| &operator.matrices[operator.nodes[node].matrices]);
            match (swept.node, matrices) {
                (Some(node), Some(matrices)) if matrices.reduction.is_some() => {
                    let open = self.modes[node] == Mode::Open;
                    let edge;
                    let edge = if open {
                        let coupling = &operator.lasting.upper[swept.station].pipe;
                        edge = Edge::of(coupling, &Matrix6::zeros(), None);
                        &edge
                    } else {
                        &operator.edges[operator.spans[node].edge]
                    };
                    let start = if open {
                        &matrices.own_start.rows
                    } else {
                        &matrices.start.rows
                    };
                    let rhs = &mut rhs[offset..offset + 24];
                    recover_joint(
                        matrices,
                        start,
                        &edge.multiplier_rows,
                        self.offsets[node],
                        &x,
                        &below,
                        rhs,
                    );
                }
                _ => {
                    for k in 0..12 {
                        rhs[offset + k] = x[place(k)];
                    }
                    if layout.is_large(swept.station) {
                        rhs[offset + 18] = x[MULTIPLIER];
                    }
                }
            }
            below[..6].copy_from_slice(&x[..6]);
            below[6..].copy_from_slice(&x[GUIDE..GUIDE + 6]);
        }
    }

    /// Inner stations of the spans that were condensed.
    #[inline(always)]
    fn recover_spans<V: Vector>(&mut self, operator: &Operator, rhs: &mut [f64]) {
        let layout = operator.layout();
        for (k, span) in operator.spans.iter().enumerate() {
            if self.modes[k] == Mode::Open || span.inner == 0 {
                continue;
            }
            let ends = End::of(operator, k);
            let room = k * self.room..(k + 1) * self.room;
            let first = layout.offset(span.first);
            let still = &mut self.pipes[room.clone()];
            operator.pipes[span.pipe].expand::<V>(&ends.values(&ends.pipe, rhs), still);
            scatter(still, first, span.inner, rhs);
            if self.modes[k] == Mode::Still {
                let still = &mut self.guides[room];
                operator.guides[span.guide]
                    .body
                    .expand::<V>(&ends.values(&ends.guide, rhs), still);
                scatter(still, first + 6, span.inner, rhs);
            } else {
                let values = ends.values(&ends.guide, rhs);
                let (mut top, mut bottom) = ([0.0; 6], [0.0; 6]);
                top.copy_from_slice(&values[..6]);
                bottom.copy_from_slice(&values[6..]);
                let solved = &self.solved[span.first..span.first + span.inner];
                expand::<V>(solved, &top, &bottom, |node, x| {
                    let at = first + 12 * node + 6;
                    rhs[at..at + 6].copy_from_slice(&x[..6]);
                });
            }
        }
    }
}

/// First unknowns of the nodes at both ends of a span.
struct End {
    pipe: [usize; 2],
    guide: [usize; 2],
}

impl End {
    #[inline(always)]
    fn of(operator: &Operator, span: usize) -> Self {
        let layout = operator.layout();
        let (top, bottom) = (operator.nodes[span], operator.nodes[span + 1]);
        let (above, below) = (layout.offset(top.station), layout.offset(bottom.station));
        let start = if top.joint.is_some() { 12 } else { 0 };
        Self {
            pipe: [above + start, below],
            guide: [above + 6, below + 6],
        }
    }

    #[inline(always)]
    fn values(&self, first: &[usize; 2], x: &[f64]) -> [f64; 12] {
        let mut out = [0.0; 12];
        out[..6].copy_from_slice(&x[first[0]..first[0] + 6]);
        out[6..].copy_from_slice(&x[first[1]..first[1] + 6]);
        out
    }
}

/// Collects a body's values of `nodes` plain stations, twelve apart from `first`; the rest of `to` is zero.
#[inline(always)]
fn gather(to: &mut [f64], first: usize, nodes: usize, from: &[f64]) {
    for (k, to) in to.chunks_exact_mut(6).enumerate().take(nodes) {
        to.copy_from_slice(&from[first + 12 * k..first + 12 * k + 6]);
    }
}

/// The way back.
#[inline(always)]
fn scatter(from: &[f64], first: usize, nodes: usize, to: &mut [f64]) {
    for (k, from) in from.chunks_exact(6).enumerate().take(nodes) {
        to[first + 12 * k..first + 12 * k + 6].copy_from_slice(from);
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

#[inline(always)]
fn add_block(block: &mut Block, part: &Block) {
    for (to, from) in block.iter_mut().zip(part) {
        for (x, y) in to.iter_mut().zip(from) {
            *x += y;
        }
    }
}

#[inline(always)]
fn add_guide(block: &mut Block, part: &Six) {
    for (to, from) in block[GUIDE..MULTIPLIER].iter_mut().zip(part) {
        for (x, y) in to[GUIDE..MULTIPLIER].iter_mut().zip(from) {
            *x += y;
        }
    }
}

/// Contact at the station.
#[inline(always)]
fn add_contact(block: &mut Block, changes: &Changes, station: usize) {
    let contact = &changes.contact[station];
    match changes.touching[station] {
        Touching::Nothing => {}
        Touching::Guide => {
            for (to, from) in block[GUIDE..MULTIPLIER].iter_mut().zip(&contact[6..]) {
                to[GUIDE..MULTIPLIER]
                    .iter_mut()
                    .zip(&from[6..])
                    .for_each(|(x, y)| *x += y);
            }
        }
        Touching::Both => {
            for (j, from) in contact.iter().enumerate() {
                let to = &mut block[place(j)];
                for i in 0..3 {
                    to[U + i] += from[i];
                    to[i] += from[3 + i];
                }
                for i in 0..6 {
                    to[GUIDE + i] += from[6 + i];
                }
            }
        }
    }
}

/// The joint's rotations and its rotational row.
#[inline(always)]
fn add_joint(block: &mut Block, change: &JointChange) {
    let row = &change.rows[0];
    for k in 0..3 {
        let (above, below) = (&change.rotations[k], &change.rotations[3 + k]);
        for i in 0..3 {
            block[k][i] += above[i];
            block[k][BELOW + i] += above[3 + i];
            block[BELOW + k][i] += below[i];
            block[BELOW + k][BELOW + i] += below[3 + i];
        }
        block[k][MULTIPLIER] += row[k];
        block[BELOW + k][MULTIPLIER] += row[3 + k];
        block[MULTIPLIER][k] += row[k];
        block[MULTIPLIER][BELOW + k] += row[3 + k];
    }
}

/// Takes what the station above adds from a block and its right-hand side.
#[inline(always)]
fn take(block: &mut Block, right: &mut [f64; SIZE], carry: &Carry) {
    for j in 0..6 {
        for (x, c) in block[j].iter_mut().zip(&carry.columns[j]) {
            *x -= c;
        }
        for (x, c) in block[GUIDE + j].iter_mut().zip(&carry.columns[6 + j]) {
            *x -= c;
        }
    }
    for (x, c) in right.iter_mut().zip(&carry.columns[12]) {
        *x -= c;
    }
}

/// All 24 unknowns of a joint station from its 16, `x`; `rhs` holds its right-hand side. `start` and `next` are the rows of the start
/// below's displacement over its own six unknowns and over the six of the pipe's next node, `below`.
#[inline(always)]
fn recover_joint(
    matrices: &Matrices,
    start: &[[f64; 3]; 6],
    next: &[[f64; 3]; 6],
    c: [f64; 3],
    x: &[f64; SIZE],
    below: &[f64; 12],
    rhs: &mut [f64],
) {
    let Some(reduction) = &matrices.reduction else { return };
    let mut rest = [rhs[12], rhs[13], rhs[14]];
    for (place, &x) in PLACES.into_iter().zip(x) {
        rhs[place] = x;
    }
    let turned = reduction.turned([x[U], x[U + 1], x[U + 2]]);
    for k in 0..3 {
        rhs[12 + k] = turned[k] + c[k];
    }
    // The rows of that displacement: what the other unknowns leave is the multipliers' part.
    for k in 0..6 {
        for i in 0..3 {
            rest[i] -= start[k][i] * rhs[12 + k] + next[k][i] * below[k];
        }
    }
    for i in 0..3 {
        rhs[18 + i] =
            reduction.recover[0][i] * rest[0] + reduction.recover[1][i] * rest[1] + reduction.recover[2][i] * rest[2];
    }
}
