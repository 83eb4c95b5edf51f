//! The columns of the published figures: a row of their table is a column.

use super::{Column, Read};
use flexdrill_outputs::figures::Figure;

/// A column for each figure of a message, in the order of the table.
pub(super) fn of<M>(table: &'static [Figure<M>]) -> impl Iterator<Item = Column> {
    let column = |figure: &Figure<M>| Column {
        name: figure.column().into(),
        fixed: false,
        read: Read::Number(figure.source),
    };
    table.iter().map(column)
}
