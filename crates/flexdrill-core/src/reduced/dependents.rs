//! Rotations that are no unknowns of their own: those below a node that follow from the others of the node.
//!
//! Where the pipe passes a node in one piece, the rotations below are those above. Through a joint the constraint rows of
//! Eq. 13 say how they follow: linearised, Phi + G_s x_s + G_f x_f = 0 gives x_s = -G_s^-1 (Phi + G_f x_f). The spin below
//! is always one of them; a revolute joint, which has two rows, makes one tilt below another. The multipliers of the rows
//! follow from the balance of the moments on the dependent rotations, R_s + G_s^T lambda = 0, so that they are no unknowns
//! either: what they put on the other rotations is the same coefficients times R_s.

use super::precision::{Lanes, Precision};
use super::{GUIDE, NODE, Reduced};
use crate::dynamics::assembly::Assembler;

/// Place in a node of the residual of a joint's first row: that of the spin below, which has no residual of its own.
pub(super) const FIRST_ROW: usize = 6;
/// Place in a node of the residual of its second row.
pub(super) const SECOND_ROW: usize = 15;
/// Places in a node of the rotations of a joint's rows: of the end above, of the start below.
pub(super) const ROTATIONS: [usize; 6] = [0, 1, 2, 6, 7, 8];

/// A rotation that follows from the others of its node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dependent {
    /// Its place in the node.
    pub slot: usize,
    /// How it changes with each of the others; -1 at its own place, 0 at those of other dependent ones.
    pub by: [f64; NODE],
    /// How it changes with what stands on the right of the joint's rows.
    pub by_rows: [f64; 2],
}

/// The dependent rotations of a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dependents {
    list: [Dependent; 3],
    count: usize,
}

impl Dependents {
    /// Those of a node that the pipe passes in one piece.
    pub(super) fn welded() -> Self {
        let list = std::array::from_fn(|k| {
            let mut by = [0.0; NODE];
            (by[k], by[6 + k]) = (1.0, -1.0);
            Dependent {
                slot: 6 + k,
                by,
                by_rows: [0.0; 2],
            }
        });
        Self { list, count: 3 }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Dependent> {
        self.list[..self.count].iter()
    }

    /// Of a joint by the gradients of its rows, which stand in the equations times `scale`. `held` says which places of
    /// the node are held.
    fn of_joint(&mut self, rows: &[[f64; 6]], scale: f64, held: Option<&[f64; NODE]>) {
        let mut by = [[0.0; NODE]; 2];
        let mut by_rows = [[0.0; 2]; 2];
        let [first, second] = match rows {
            [first, second] => [first, second],
            [first] => [first, first],
            _ => return,
        };
        // The tilt below that the second row depends on most.
        let minor = |k: usize| first[3] * second[k] - first[k] * second[3];
        let is_free = |slot: usize| held.is_none_or(|rows| rows[slot] != 0.0);
        let tilts = [4, 5].into_iter().filter(|&k| is_free(ROTATIONS[k]));
        let tilt = tilts.max_by(|&i, &j| minor(i).abs().total_cmp(&minor(j).abs()));
        match tilt.filter(|_| rows.len() == 2) {
            None => {
                let inverse = 1.0 / first[3];
                for (k, &place) in ROTATIONS.iter().enumerate() {
                    by[0][place] = -inverse * first[k];
                }
                by_rows[0][0] = inverse / scale;
                self.count = 1;
            }
            Some(tilt) => {
                let inverse = 1.0 / minor(tilt);
                // The rows solved for the spin and the tilt: [first[3], first[tilt]; second[3], second[tilt]]^-1.
                let solved = [
                    [second[tilt] * inverse, -first[tilt] * inverse],
                    [-second[3] * inverse, first[3] * inverse],
                ];
                for (r, of_rows) in solved.iter().enumerate() {
                    for (k, &place) in ROTATIONS.iter().enumerate() {
                        by[r][place] = -(of_rows[0] * first[k] + of_rows[1] * second[k]);
                    }
                    by_rows[r] = of_rows.map(|x| x / scale);
                }
                let slots = [ROTATIONS[3], ROTATIONS[tilt]];
                for (r, slot) in slots.into_iter().enumerate() {
                    by[r][slots[1 - r]] = 0.0;
                    by[r][slot] = -1.0;
                }
                self.list[1] = Dependent {
                    slot: slots[1],
                    by: by[1],
                    by_rows: by_rows[1],
                };
                self.count = 2;
            }
        }
        by[0][ROTATIONS[3]] = -1.0;
        self.list[0] = Dependent {
            slot: ROTATIONS[3],
            by: by[0],
            by_rows: by_rows[0],
        };
    }

    /// Adds what the moments on the dependent rotations put on the others, and takes them away.
    #[inline(always)]
    fn project(&self, residual: &mut [f64; NODE]) {
        for dependent in self.iter() {
            let moment = residual[dependent.slot];
            // -1 at its own place leaves nothing there.
            for (r, by) in residual.iter_mut().zip(&dependent.by) {
                *r += by * moment;
            }
        }
    }
}

impl Dependents {
    /// Writes the dependent rotations by the others in a node's block `a` and in the columns that couple it to the node
    /// below. Their own rows then say how they follow, so that the solution holds them. `rows` is what stands on the right
    /// of the joint's rows; `crossed` whether the guide's columns have entries in the pipe's rows.
    #[inline(always)]
    pub(super) fn eliminate<S: Precision, L: Lanes<S>>(
        &self,
        a: &mut [[S; NODE]; NODE],
        coupling: &mut [[S; NODE]],
        right: &mut [S; NODE],
        rows: [f64; 2],
        crossed: bool,
    ) {
        for dependent in self.iter() {
            let slot = dependent.slot;
            let offset = dependent.by_rows[0] * rows[0] + dependent.by_rows[1] * rows[1];
            // Its column goes to the columns of what it follows.
            let column = L::load(&a[slot]);
            let others = ROTATIONS.into_iter().filter(|&k| k != slot && dependent.by[k] != 0.0);
            for k in others.clone() {
                let by = L::splat(S::of(dependent.by[k]));
                L::load(&a[k]).plus_product(column, by).store(&mut a[k]);
            }
            L::load(right)
                .plus_product(column, L::splat(S::of(-offset)))
                .store(right);
            // Its row goes to their rows; -1 at its own place leaves nothing there.
            let mut by = [S::ZERO; NODE];
            by.iter_mut()
                .zip(&dependent.by)
                .for_each(|(to, from)| *to = S::of(*from));
            let by = L::load(&by);
            let move_row = |column: &mut [S; NODE]| {
                let moment = L::splat(column[slot]);
                L::load(column).plus_product(by, moment).store(column);
            };
            a[..if crossed { NODE } else { GUIDE }].iter_mut().for_each(move_row);
            coupling.iter_mut().for_each(move_row);
            move_row(right);
            // x_slot - by x = offset.
            a[slot] = [S::ZERO; NODE];
            a[slot][slot] = S::of(1.0);
            for k in others {
                a[k][slot] = S::of(-dependent.by[k]);
            }
            right[slot] = S::of(offset);
        }
    }
}

impl Reduced {
    /// Linearises the rotations that follow from others, and takes the moments on them over to those: with the
    /// multipliers of the joints' rows they are in balance. Their places are taken by the rows themselves, times `scale`.
    pub(super) fn balance_dependents(&mut self, assembler: &Assembler, scale: f64) {
        let (residual, _) = self.residual.as_chunks_mut::<NODE>();
        for (k, (node, residual)) in self.nodes.list.iter().zip(residual).enumerate() {
            if !self.reach.felt[k] {
                continue;
            }
            let dependents = &mut self.dependents[k];
            let Some(joint) = node.joint else {
                dependents.project(residual);
                continue;
            };
            let count = assembler.row_values(joint).len();
            let gradients = [0, count - 1].map(|row| assembler.row_gradient(joint, row));
            dependents.of_joint(&gradients[..count], scale, self.rows[k].as_ref());
            let lambda = &mut self.multipliers[joint];
            *lambda = [0.0; 2];
            for dependent in dependents.iter() {
                for (lambda, by) in lambda.iter_mut().zip(dependent.by_rows) {
                    *lambda -= scale * by * residual[dependent.slot];
                }
            }
            dependents.project(residual);
            for (place, value) in [FIRST_ROW, SECOND_ROW].into_iter().zip(assembler.row_values(joint)) {
                residual[place] = scale * value;
            }
        }
    }
}
