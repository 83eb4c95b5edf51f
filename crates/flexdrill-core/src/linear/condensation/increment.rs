//! What is added to a station's block in an iteration: spans, contacts, its joint, and the station above.

use super::system::place;
use super::{BELOW, Block, Columns, GUIDE, MULTIPLIER, PaddedColumns, SIZE, U};
use crate::linear::increment::{JointIncrement, TangentIncrement, Touching};

#[inline(always)]
pub fn add_block(block: &mut Block, part: &Block) {
    for (to, from) in block.iter_mut().zip(part) {
        for (x, y) in to.iter_mut().zip(from) {
            *x += y;
        }
    }
}

#[inline(always)]
pub fn add_guide(block: &mut Block, part: &PaddedColumns) {
    for (to, from) in block[GUIDE..MULTIPLIER].iter_mut().zip(part) {
        for (x, y) in to[GUIDE..MULTIPLIER].iter_mut().zip(from) {
            *x += y;
        }
    }
}

/// Contact at the station.
#[inline(always)]
pub fn add_contact(block: &mut Block, increment: &TangentIncrement, station: usize) {
    let contact = &increment.contact[station];
    match increment.touching[station] {
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
pub fn add_joint(block: &mut Block, change: &JointIncrement) {
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
pub fn take(block: &mut Block, right: &mut [f64; SIZE], carry: &Columns) {
    for j in 0..6 {
        for (x, c) in block[j].iter_mut().zip(&carry[j]) {
            *x -= c;
        }
        for (x, c) in block[GUIDE + j].iter_mut().zip(&carry[6 + j]) {
            *x -= c;
        }
    }
    for (x, c) in right.iter_mut().zip(&carry[12]) {
        *x -= c;
    }
}
