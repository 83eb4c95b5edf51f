//! What contacts and joints add to the tangent of an iteration, kept apart from what lasts as long as the step size
//! does.

use super::system::{BlockSystem, Layout};

/// What touches at a station, and with it which unknowns its contact couples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Touching {
    /// Nothing: the station's contact block counts as zero, whatever it holds.
    Nothing,
    /// Guide on wall: rows and columns of the guide only.
    Guide,
    /// Pipe on guide, and perhaps guide on wall.
    Both,
}

/// Contact's part of a station's block over (pipe end above, guide), by columns.
pub type ContactBlock = [[f64; 12]; 12];

/// A joint's part over the rotations of (end above, start below).
#[derive(Debug, Clone, Copy)]
pub struct JointIncrement {
    /// Stop, and curvature of the rotational rows, by columns.
    pub rotations: [[f64; 6]; 6],
    /// Gradients of the rotational rows.
    pub rows: [[f64; 6]; 2],
}

/// Additions of one iteration.
#[derive(Debug, Clone)]
pub struct TangentIncrement {
    /// What touches at each station.
    pub touching: Vec<Touching>,
    /// What contacts add to the block of each station, (pipe end above, guide) by columns.
    pub contact: Vec<ContactBlock>,
    /// Per joint station, in order.
    pub joints: Vec<JointIncrement>,
    /// Rotational rows per joint.
    pub rows: usize,
    /// Held unknowns with their stations: their equations take no additions.
    held: Vec<(usize, usize)>,
}

impl TangentIncrement {
    /// No additions, for `joints` joints of `rows` rotational rows. `held` are unknowns without an equation.
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

    /// Takes the rows and columns of held unknowns out of the contact blocks.
    pub fn drop_held(&mut self) {
        for &(station, local) in &self.held {
            if local < 12 && self.touching[station] != Touching::Nothing {
                let block = &mut self.contact[station];
                block[local].fill(0.0);
                block.iter_mut().for_each(|column| column[local] = 0.0);
            }
        }
    }

    /// Adds everything to `system`; held rotations of joints are to be held again by the caller.
    pub fn add_to(&self, system: &mut BlockSystem) {
        let mut joint = 0;
        for station in 0..self.touching.len() {
            if self.touching[station] != Touching::Nothing {
                system.add_scaled(station, 0, &self.contact[station], 1.0);
            }
            if joint < self.joints.len() && system.layout().is_large(station) {
                let change = &self.joints[joint];
                let place = |k: usize| if k < 3 { 3 + k } else { 12 + k };
                for (j, column) in change.rotations.iter().enumerate() {
                    for (i, &x) in column.iter().enumerate() {
                        system.add(station, place(i), place(j), x);
                    }
                }
                for (r, row) in change.rows.iter().enumerate().take(self.rows) {
                    for (k, &x) in row.iter().enumerate() {
                        system.add(station, 21 + r, place(k), x);
                        system.add(station, place(k), 21 + r, x);
                    }
                }
                joint += 1;
            }
        }
    }
}
