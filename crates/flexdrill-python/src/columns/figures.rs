//! The columns of the published figures: a row of their table is a column.

use super::{Column, Read};
use flexdrill_outputs::figures::Figure;

/// A column for each figure of a message that a snapshot has, in the order of the table.
pub(super) fn of<M>(table: &'static [Figure<M>]) -> impl Iterator<Item = Column> {
    // A name lives as long as the program, as those of the other columns do; it is made once.
    table
        .iter()
        .filter_map(|figure| Some(Column::new(figure.column().leak(), Read::Number(figure.source?))))
}
