//! Torque, weight and power from the surface to the bit over time.

use crate::history::History;
use flexdrill_messages::Transfer;
use flexdrill_outputs::figures::{Figure, Group, Shown, TRANSFER};

/// A figure of `twin/transfer` that tables show, with its history.
#[derive(Debug)]
pub(crate) struct FigureHistory {
    pub figure: &'static Figure<Transfer>,
    pub shown: Shown,
    pub history: History,
}

/// Everything that `twin/transfer` says, over time.
#[derive(Debug)]
pub(crate) struct TransferHistory {
    /// In the order of the tables.
    pub quantities: Vec<FigureHistory>,
    /// Time that a mean covers (s).
    pub window: f64,
}

impl Default for TransferHistory {
    fn default() -> Self {
        let quantity = |figure: &'static Figure<Transfer>| {
            Some(FigureHistory {
                figure,
                shown: figure.shown?,
                history: History::default(),
            })
        };
        Self {
            quantities: TRANSFER.iter().filter_map(quantity).collect(),
            window: f64::NAN,
        }
    }
}

impl TransferHistory {
    pub(crate) fn push(&mut self, time: f64, message: &Transfer) {
        for quantity in &mut self.quantities {
            // A figure that the tool does not have is not a number; the history leaves it out.
            quantity.history.push(time, (quantity.figure.read)(message));
        }
        self.window = self.window.max(message.duration);
    }

    /// The quantities of a group, from the surface to the bit.
    pub(crate) fn group(&self, group: Group) -> impl Iterator<Item = &FigureHistory> + Clone {
        self.quantities
            .iter()
            .filter(move |quantity| quantity.shown.group == group)
    }

    /// Mean torque at the bit over that at the uppermost place that the tool has; `None` without torque. The mean of the
    /// messages' quotients would count a run-up without weight as much as drilling.
    pub(crate) fn torque_efficiency(&self) -> Option<f64> {
        let mut means = self
            .group(Group::Torque)
            .filter_map(|quantity| quantity.history.range());
        let top = means.next()?.mean;
        let bit = means.last()?.mean;
        (top.abs() >= 1.0).then(|| bit / top)
    }

    /// Whether anything is known.
    pub(crate) fn is_known(&self) -> bool {
        self.group(Group::Torque)
            .any(|quantity| quantity.history.range().is_some())
    }
}
