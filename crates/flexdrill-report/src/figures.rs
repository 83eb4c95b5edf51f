//! The figures of a message over time, as their table lists them. A figure that the table gains appears by itself.

use crate::history::{History, Range};
use flexdrill_messages::Message;
use flexdrill_outputs::figures::{Figure, Group, Shown, Window};

/// A figure that tables show, with its history (SI).
#[derive(Debug)]
pub(crate) struct FigureHistory<M: 'static> {
    pub figure: &'static Figure<M>,
    pub shown: Shown,
    pub history: History,
    /// Squares of a root mean square; empty for other figures.
    squares: History,
}

impl<M> FigureHistory<M> {
    fn push(&mut self, time: f64, message: &M) {
        let value = (self.figure.read)(message);
        self.history.push(time, value);
        if matches!(self.figure.window, Window::Rms | Window::LongRms) {
            self.squares.push(time, value * value);
        }
    }

    /// Least, mean and largest value over the recording (SI); the mean of a root mean square is the root mean square
    /// over the recording. `None` without values.
    pub(crate) fn range(&self) -> Option<Range> {
        let range = self.history.range()?;
        let mean = self.squares.range().map_or(range.mean, |squares| squares.mean.sqrt());
        Some(Range { mean, ..range })
    }
}

/// All figures of a message that tables show, in the order of the tables.
#[derive(Debug)]
pub(crate) struct FigureHistories<M: 'static> {
    pub all: Vec<FigureHistory<M>>,
}

impl<M: Message> FigureHistories<M> {
    pub(crate) fn of(table: &'static [Figure<M>]) -> Self {
        let history = |figure: &'static Figure<M>| {
            Some(FigureHistory {
                figure,
                shown: figure.shown?,
                history: History::default(),
                squares: History::default(),
            })
        };
        Self {
            all: table.iter().filter_map(history).collect(),
        }
    }

    /// Takes a message of an instant (s from the beginning).
    pub(crate) fn push(&mut self, time: f64, message: &M) {
        // A figure that the tool does not have is not a number; the history leaves it out.
        for figure in &mut self.all {
            figure.push(time, message);
        }
    }

    /// The figures of a group, in their order.
    pub(crate) fn group(&self, group: Group) -> impl Iterator<Item = &FigureHistory<M>> + Clone {
        self.all.iter().filter(move |figure| figure.shown.group == group)
    }

    /// The figure of a field; `None` where no table shows it.
    pub(crate) fn field(&self, field: &str) -> Option<&FigureHistory<M>> {
        self.all.iter().find(|figure| figure.figure.field == field)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::BitState;
    use flexdrill_outputs::figures::BIT_STATE;

    #[test]
    fn means_over_the_recording_are_those_of_their_kind() {
        let mut figures = FigureHistories::of(BIT_STATE);
        // Two values that each hold for a second, and one that ends the recording.
        for (time, torque, acceleration) in [(0.0, 3.0, 3.0), (1.0, 5.0, 4.0), (2.0, 5.0, 4.0)] {
            let message = BitState {
                torque,
                axial_acceleration: acceleration,
                stick_slip_index: f64::NAN,
                ..BitState::default()
            };
            figures.push(time, &message);
        }
        let range = |field: &str| figures.field(field).unwrap().range();
        // Rounding of the sum over parts of a second.
        assert!((range("torque").unwrap().mean - 4.0).abs() < 1e-12);
        let acceleration = range("axial_acceleration").unwrap();
        // Rounding of a root.
        assert!((acceleration.mean - 12.5_f64.sqrt()).abs() < 1e-12, "{acceleration:?}");
        assert_eq!((acceleration.min, acceleration.max), (3.0, 4.0));
        assert_eq!(range("stick_slip_index"), None);
    }
}
