//! Block elimination along the stations from the top down, with pivoting inside each station's block.

use nalgebra::SMatrix;

use super::block_lu::BlockLu;
use super::system::{BlockSystem, Layout};
use super::{LinearSolver, Singular};

/// The default solver: cost linear in the number of stations, nothing allocated after construction.
pub struct StationElimination {
    plain: Vec<BlockLu<12>>,
    joint: Vec<BlockLu<24>>,
    /// S^-1 U per station: 12 columns of the block's size, by slot.
    plain_gain: Vec<SMatrix<f64, 12, 12>>,
    joint_gain: Vec<SMatrix<f64, 24, 12>>,
}

impl StationElimination {
    /// Room for systems of this layout.
    pub fn new(layout: &Layout) -> Self {
        let joint = (0..layout.stations()).filter(|&s| layout.is_large(s)).count();
        let plain = layout.stations() - joint;
        Self {
            plain: vec![BlockLu::new(); plain],
            joint: vec![BlockLu::new(); joint],
            plain_gain: vec![SMatrix::zeros(); plain],
            joint_gain: vec![SMatrix::zeros(); joint],
        }
    }
}

impl LinearSolver for StationElimination {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let layout = system.layout();
        let last = layout.stations() - 1;
        let mut carry = SMatrix::<f64, 12, 12>::zeros();
        let mut carried = [0.0; 12];
        for station in 0..=last {
            let slot = layout.slot(station);
            let offset = layout.offset(station);
            // The 12 outgoing rows of S^-1 U and of S^-1 r feed the next station.
            let mut gain = SMatrix::<f64, 12, 12>::zeros();
            let mut flow = [0.0; 12];
            if layout.is_large(station) {
                let mut block = system.joint[slot];
                let mut corner = block.fixed_view_mut::<12, 12>(0, 0);
                corner -= carry;
                self.joint[slot]
                    .factor(&block)
                    .map_err(|pivot| Singular { station, pivot })?;
                let mut local = [0.0; 24];
                local.copy_from_slice(&rhs[offset..offset + 24]);
                (0..12).for_each(|k| local[k] -= carried[k]);
                self.joint[slot].solve(&mut local);
                rhs[offset..offset + 24].copy_from_slice(&local);
                if station < last {
                    for c in 0..12 {
                        let column = &mut self.joint_gain[slot].data.0[c];
                        column.fill(0.0);
                        column[12..18].copy_from_slice(&system.upper[station].data.0[c][..6]);
                        column[6..12].copy_from_slice(&system.upper[station].data.0[c][6..]);
                        self.joint[slot].solve(column);
                        gain.data.0[c][..6].copy_from_slice(&column[12..18]);
                        gain.data.0[c][6..].copy_from_slice(&column[6..12]);
                    }
                    flow[..6].copy_from_slice(&local[12..18]);
                    flow[6..].copy_from_slice(&local[6..12]);
                }
            } else {
                let block = system.plain[slot] - carry;
                self.plain[slot]
                    .factor(&block)
                    .map_err(|pivot| Singular { station, pivot })?;
                let mut local = [0.0; 12];
                local.copy_from_slice(&rhs[offset..offset + 12]);
                (0..12).for_each(|k| local[k] -= carried[k]);
                self.plain[slot].solve(&mut local);
                rhs[offset..offset + 12].copy_from_slice(&local);
                if station < last {
                    gain = system.upper[station];
                    gain.data.0.iter_mut().for_each(|column| self.plain[slot].solve(column));
                    self.plain_gain[slot] = gain;
                    flow = local;
                }
            }
            if station < last {
                let lower = &system.lower[station];
                carry = lower * gain;
                carried = (lower * nalgebra::SVector::<f64, 12>::from(flow)).into();
            }
        }
        for station in (0..last).rev() {
            let slot = layout.slot(station);
            let offset = layout.offset(station);
            let (here, next) = rhs.split_at_mut(layout.offset(station + 1));
            let here = &mut here[offset..];
            for c in 0..12 {
                let scale = next[c];
                let column: &[f64] = if layout.is_large(station) {
                    &self.joint_gain[slot].data.0[c]
                } else {
                    &self.plain_gain[slot].data.0[c]
                };
                here.iter_mut().zip(column).for_each(|(x, g)| *x -= g * scale);
            }
        }
        Ok(())
    }
}
