//! Torque, weight and power from the surface to the bit over time.

use crate::figures::{FigureHistories, FigureHistory};
use flexdrill_messages::Transfer;
use flexdrill_outputs::figures::{Group, TRANSFER};

/// Everything that `twin/transfer` says, over time.
#[derive(Debug)]
pub(crate) struct TransferHistory {
    pub figures: FigureHistories<Transfer>,
    /// Time that a mean covers (s).
    pub window: f64,
}

impl Default for TransferHistory {
    fn default() -> Self {
        Self {
            figures: FigureHistories::of(TRANSFER),
            window: f64::NAN,
        }
    }
}

impl TransferHistory {
    pub(crate) fn push(&mut self, time: f64, message: &Transfer) {
        self.figures.push(time, message);
        self.window = self.window.max(message.duration);
    }

    /// The quantities of a group, from the surface to the bit.
    pub(crate) fn group(&self, group: Group) -> impl Iterator<Item = &FigureHistory<Transfer>> + Clone {
        self.figures.group(group)
    }

    /// Mean torque at the bit over that at the uppermost place that the tool has; `None` without torque. The mean of the
    /// messages' quotients would count a run-up without weight as much as drilling.
    pub(crate) fn torque_efficiency(&self) -> Option<f64> {
        let mut means = self.group(Group::Torque).filter_map(FigureHistory::range);
        let top = means.next()?.mean;
        let bit = means.last()?.mean;
        (top.abs() >= 1.0).then(|| bit / top)
    }

    /// Whether anything is known.
    pub(crate) fn is_known(&self) -> bool {
        self.group(Group::Torque).any(|quantity| quantity.range().is_some())
    }
}
