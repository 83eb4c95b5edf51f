//! The part of an iteration's tangent that contacts and joints add. It is separate from the step-constant part, which
//! stays as long as the step size does.

use super::system::BlockSystem;
use crate::chain::Touching;
use crate::model::layout::Layout;

/// The contacts' part of a station's block over (pipe end above, guide), by columns.
pub type ContactBlock = [[f64; 12]; 12];

/// A joint's part over the rotations of (end above, start below).
#[derive(Debug, Clone, Copy)]
pub struct JointIncrement {
    /// Stop, and curvature of the rotational rows, by columns.
    pub rotations: [[f64; 6]; 6],
    /// Gradients of the rotational rows.
    pub rows: [[f64; 6]; 2],
}

/// The additions of one iteration.
#[derive(Debug, Clone)]
pub struct TangentIncrement {
    /// The closed gaps of each station.
    pub touching: Vec<Touching>,
    /// The contacts' additions to the block of each station.
    pub contact: Vec<ContactBlock>,
    /// The joints' additions, top to bottom.
    pub joints: Vec<JointIncrement>,
    /// Rotational rows per joint.
    pub rows: usize,
    /// Held unknowns as (station, index in its block): their equations stay x = 0.
    held: Vec<(usize, usize)>,
}

impl TangentIncrement {
    /// An increment without additions, for `joints` joints of `rows` rotational rows. `held` lists the held unknowns.
    pub fn new(layout: &Layout, joints: usize, rows: usize, held: impl Iterator<Item = usize>) -> Self {
        let stations = layout.stations();
        Self {
            touching: vec![Touching::Nothing; stations],
            contact: vec![[[0.0; 12]; 12]; stations],
            joints: vec![
                JointIncrement {
                    rotations: [[0.0; 6]; 6],
                    rows: [[0.0; 6]; 2],
                };
                joints
            ],
            rows,
            held: held
                .map(|unknown| {
                    let station = layout.station_of(unknown);
                    (station, unknown - layout.offset(station))
                })
                .collect(),
        }
    }

    /// Clears the rows and columns of held unknowns in the contact blocks.
    pub fn drop_held(&mut self) {
        for &(station, local) in &self.held {
            if local < 12 && self.touching[station] != Touching::Nothing {
                let block = &mut self.contact[station];
                block[local].fill(0.0);
                block.iter_mut().for_each(|column| column[local] = 0.0);
            }
        }
    }

    /// Adds the increment to `system`. The caller holds the held rotations of joints again afterwards.
    pub fn add_to(&self, system: &mut BlockSystem) {
        let mut joint = 0;
        for station in 0..self.touching.len() {
            if self.touching[station] != Touching::Nothing {
                system.add_scaled(station, 0, &self.contact[station], 1.0);
            }
            if joint < self.joints.len() && system.layout().is_large(station) {
                let change = &self.joints[joint];
                // In the block of 24 the rotations of the end above are at 3 to 5, those of the start below at 15 to
                // 17.
                let index = |k: usize| if k < 3 { 3 + k } else { 12 + k };
                for (j, column) in change.rotations.iter().enumerate() {
                    for (i, &x) in column.iter().enumerate() {
                        system.add(station, index(i), index(j), x);
                    }
                }
                for (r, row) in change.rows.iter().enumerate().take(self.rows) {
                    for (k, &x) in row.iter().enumerate() {
                        system.add(station, 21 + r, index(k), x);
                        system.add(station, index(k), 21 + r, x);
                    }
                }
                joint += 1;
            }
        }
    }
}
