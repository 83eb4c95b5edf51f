//! The columns of the published figures: a row of their table is a column.

use super::{Column, Read};
use flexdrill_outputs::figures::Figure;

/// A column for each figure of a message, in the order of the table.
pub(super) fn of<M>(table: &'static [Figure<M>]) -> impl Iterator<Item = Column> {
    // A name lives as long as the program, as those of the other columns do; it is made once.
    table
        .iter()
        .map(|figure| Column::new(figure.column().leak(), Read::Number(figure.source)))
}
