//! The linear system over the chain, in double precision: blocks of 16 eliminated from the top down.

use super::columns::{load, plus_column, store};
use super::dependents::{Dependents, FIRST_ROW, MOMENTS, ROTATIONS, SECOND_ROW};
use super::double::sixteen;
use super::nodes::{Node, pass};
use super::operator::{Block, Operator};
use super::precision::Double;
use super::single::SingleElimination;
use super::tangent::{Additions, Touching};
use super::{BOTTOM, Chain, GUIDE, Link, NODE, TIE, TOP};
use crate::dynamics::newton::Singular;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// Columns per node: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;

/// Room for an elimination.
#[derive(Clone)]
pub(super) struct Sweep {
    /// S^-1 (U, r) per node.
    columns: Vec<[[f64; NODE]; COLUMNS]>,
    /// What the joint of each node adds, over the rotations above and below, by columns.
    pub(super) joints: Vec<[[f64; 6]; 6]>,
}

impl Sweep {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            columns: vec![[[0.0; NODE]; COLUMNS]; nodes],
            joints: vec![[[0.0; 6]; 6]; nodes],
        }
    }
}

/// One solution.
struct Elimination<'a> {
    sweep: &'a mut Sweep,
    operator: &'a Operator,
    additions: &'a Additions<f64>,
    nodes: &'a [Node],
    dependents: &'a [Dependents],
    /// Rows per joint that are constraints.
    joint_rows: usize,
    links: &'a [Link],
    rows: &'a [Option<[f64; NODE]>],
    /// The right-hand side, which becomes the solution.
    values: &'a mut [f64],
}

impl Elimination<'_> {
    /// A node's block without the carry from above: step-constant part, contacts, bit and masses, joint.
    #[inline(always)]
    fn block<V: Vector>(&self, k: usize) -> Block {
        let mut block = self.operator.blocks[self.operator.block_of[k]];
        let columns = match self.additions.nodes[k] {
            Touching::Nothing => 0..0,
            Touching::Guide => GUIDE..TIE,
            Touching::Both => 0..NODE,
        };
        for (to, from) in block[columns.clone()]
            .iter_mut()
            .zip(&self.additions.blocks[k][columns])
        {
            let (a, b): ([V; 2], [V; 2]) = (load(to), load(from));
            store([a[0].plus(b[0]), a[1].plus(b[1])], to);
        }
        if self.nodes[k].joint.is_some() {
            for (l, column) in self.sweep.joints[k].iter().enumerate() {
                for (x, place) in column.iter().zip(ROTATIONS) {
                    block[ROTATIONS[l]][place] += x;
                }
            }
        }
        block
    }

    /// Coupling of span `l`: (rows of the node above, rows of the node below), and what crosses.
    #[inline(always)]
    fn coupling<V: Vector>(&self, l: usize, upper: &mut [[f64; NODE]], lower: &mut [[f64; NODE]; 12]) -> Touching {
        let base = &self.operator.couplings[self.links[l].kind];
        upper[..12].copy_from_slice(&base.upper);
        *lower = base.lower;
        let touching = self.additions.spans[l];
        if touching != Touching::Nothing {
            let first = if touching == Touching::Guide { 6 } else { 0 };
            let added = &self.additions.couplings[l];
            for c in first..12 {
                for (to, from) in [(&mut upper[c], &added.upper[c]), (&mut lower[c], &added.lower[c])] {
                    let (a, b): ([V; 2], [V; 2]) = (load(to), load(from));
                    store([a[0].plus(b[0]), a[1].plus(b[1])], to);
                }
            }
        }
        // Held unknowns take no part.
        if let Some(rows) = &self.rows[l + 1] {
            lower.iter_mut().for_each(|column| keep(column, rows));
        }
        touching
    }
}

/// Subtracts the carry from above from a block and its right-hand side.
#[inline(always)]
fn subtract_carry<V: Vector>(block: &mut Block, right: &mut [f64; NODE], carry: &[[f64; NODE]; COLUMNS]) {
    let minus = |to: &mut [f64; NODE], from: &[f64; NODE]| {
        let (x, c): ([V; 2], [V; 2]) = (load(to), load(from));
        store([x[0].minus(c[0]), x[1].minus(c[1])], to);
    };
    for (column, place) in carry.iter().zip(BOTTOM) {
        minus(&mut block[place], column);
    }
    minus(right, &carry[12]);
}

/// Keeps the rows that are equations.
#[inline(always)]
fn keep(column: &mut [f64; NODE], rows: &[f64; NODE]) {
    for (x, row) in column.iter_mut().zip(rows) {
        *x *= row;
    }
}

impl Kernel for Elimination<'_> {
    type Output = Result<(), (usize, f64)>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Result<(), (usize, f64)> {
        let nodes = self.rows.len();
        // The carry is what the eliminated part of the tool does to the next
        // node: stiffness, coupling and right-hand side in 13 columns.
        let mut carry = [[0.0; NODE]; COLUMNS];
        let mut lower = [[0.0; NODE]; 12];
        for k in 0..nodes {
            let mut block = self.block::<V>(k);
            let mut right = [0.0; NODE];
            right.copy_from_slice(&self.values[NODE * k..NODE * (k + 1)]);
            let rows = [right[FIRST_ROW], right[SECOND_ROW]];
            if self.nodes[k].joint.is_some() && self.joint_rows > 0 {
                // The values of the joint's rows are no moments.
                keep(&mut right, &MOMENTS);
            }
            if k > 0 {
                subtract_carry::<V>(&mut block, &mut right, &carry);
            }
            // The last node has no node below: one column suffices.
            let last = k + 1 == nodes;
            let mut columns = [[0.0; NODE]; COLUMNS];
            let touching = if last {
                Touching::Nothing
            } else {
                self.coupling::<V>(k, &mut columns, &mut lower)
            };
            let coupling = &mut columns[..12];
            // Folded before the elimination: a dependent rotation's own row then gives its value from the solution.
            let chain = self.dependents[k].eliminate(&mut block, coupling, Double::<V>(load(&right)), rows, true);
            store(chain.0, &mut right);
            // Held unknowns: row and column are cut, and a one on the diagonal keeps the block regular.
            if let Some(rows) = &self.rows[k] {
                for (i, column) in block.iter_mut().enumerate() {
                    keep(column, rows);
                    if rows[i] == 0.0 {
                        *column = [0.0; NODE];
                        column[i] = 1.0;
                    }
                }
                coupling.iter_mut().for_each(|column| keep(column, rows));
                keep(&mut right, rows);
            }
            if last {
                let mut column = [right];
                sixteen::<V, 1>(&mut block, &mut column, |_| 0).map_err(|pivot| (k, pivot))?;
                self.values[NODE * k..].copy_from_slice(&column[0]);
                break;
            }
            columns[12] = right;
            // The pipe's columns have entries from the first row on, the guide's from row 9 on unless contacts cross them.
            let crossed = self.operator.crossed || touching == Touching::Both;
            let active = |row: usize| if row < GUIDE && !crossed { 6 } else { 12 };
            sixteen::<V, COLUMNS>(&mut block, &mut columns, active).map_err(|pivot| (k, pivot))?;
            // The product with the lower coupling forms the carry. Without a
            // contact between the pipes their parts do not mix.
            for (carry, column) in carry.iter_mut().zip(&columns) {
                let (mut pipe, mut guide) = ([V::splat(0.0); 2], [V::splat(0.0); 2]);
                if crossed {
                    for c in 0..6 {
                        pipe = plus_column(pipe, &lower[c], V::splat(column[TOP[c]]));
                        guide = plus_column(guide, &lower[6 + c], V::splat(column[TOP[6 + c]]));
                    }
                } else {
                    // The pipe is in the first eight rows, the guide in the second.
                    for c in 0..6 {
                        let (of_pipe, of_guide): ([V; 2], [V; 2]) = (load(&lower[c]), load(&lower[6 + c]));
                        pipe[0] = pipe[0].plus_product(of_pipe[0], V::splat(column[TOP[c]]));
                        guide[1] = guide[1].plus_product(of_guide[1], V::splat(column[TOP[6 + c]]));
                    }
                }
                store([pipe[0].plus(guide[0]), pipe[1].plus(guide[1])], carry);
            }
            self.sweep.columns[k] = columns;
        }
        // Upwards: each node's solution follows from that of the node below.
        let (values, _) = self.values.as_chunks_mut::<NODE>();
        for k in (0..nodes - 1).rev() {
            let columns = &self.sweep.columns[k];
            let below = values[k + 1];
            // Two sums instead of one halve the chain of dependent products.
            let (mut even, mut odd) = (load::<V>(&columns[12]), [V::splat(0.0); 2]);
            for c in 0..6 {
                even = plus_column(even, &columns[2 * c], V::splat(-below[BOTTOM[2 * c]]));
                odd = plus_column(odd, &columns[2 * c + 1], V::splat(-below[BOTTOM[2 * c + 1]]));
            }
            store([even[0].plus(odd[0]), even[1].plus(odd[1])], &mut values[k]);
        }
        // Rotations below a node without a joint are those above.
        for (values, node) in values.iter_mut().zip(self.nodes) {
            pass(values, *node);
        }
        Ok(())
    }
}

impl Chain {
    /// Solves for the correction in single precision; `false` where its pivots do not do.
    pub(super) fn solve_in_single(&mut self, operator: usize) -> bool {
        if !self.active.whole {
            self.correction.fill(0.0);
        }
        for window in &self.active.windows {
            let unknowns = NODE * window.first..NODE * (window.last + 1);
            let residual = &self.residual[unknowns.clone()];
            let values = self.correction[unknowns].iter_mut().zip(residual);
            values.for_each(|(c, r)| *c = -r);
        }
        let solved = self.model.instructions.run(SingleElimination {
            sweep: &mut self.single_sweep,
            operator: &self.operators[operator],
            additions: &self.single_additions,
            nodes: &self.model.nodes.list,
            dependents: &self.dependents,
            joint_rows: self.model.joint_rows,
            links: &self.model.links,
            rows: &self.model.rows,
            windows: &mut self.active.windows,
            weights: self.limits.weights(self.accuracy),
            values: &mut self.correction,
        });
        self.active.moved();
        solved
    }

    /// Solves for the correction.
    ///
    /// # Errors
    /// When a block cannot be factorised.
    pub(super) fn solve_in_double(&mut self, operator: usize) -> Result<(), Singular> {
        self.correction
            .iter_mut()
            .zip(&self.residual)
            .for_each(|(c, r)| *c = -r);
        self.model
            .instructions
            .run(Elimination {
                sweep: &mut self.sweep,
                operator: &self.operators[operator],
                additions: &self.additions,
                nodes: &self.model.nodes.list,
                dependents: &self.dependents,
                joint_rows: self.model.joint_rows,
                links: &self.model.links,
                rows: &self.model.rows,
                values: &mut self.correction,
            })
            .map_err(|(node, pivot)| Singular {
                station: self.model.nodes.list[node].station,
                pivot,
            })
    }
}
