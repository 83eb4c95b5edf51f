//! Tables (CSV) of directions by measured depth: a plan, or surveys.

use std::ops::RangeInclusive;

use csv::StringRecord;

/// Columns that every table has.
pub const COLUMNS: [&str; 3] = ["measured_depth_m", "inclination_deg", "azimuth_deg"];
/// Most rows: one per metre of the deepest well are less.
const MOST_ROWS: usize = 20_000;

/// What a table holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    /// In words, such as "the plan".
    pub what: &'static str,
    /// Fewest rows.
    pub least: usize,
    /// What to give, where there are too few or too many rows.
    pub give: &'static str,
}

/// Why a table is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The header lacks a column.
    #[error(
        "{file}:1: no column {column}: must have the columns measured_depth_m, inclination_deg and azimuth_deg; name them \
         in the first line"
    )]
    Column {
        /// The table.
        file: String,
        /// What is missing.
        column: &'static str,
    },
    /// A value that is none, or out of its bounds.
    #[error("{file}:{line}: {column} = {value}: must be {bound}; correct the line or remove it")]
    Value {
        /// The table.
        file: String,
        /// Line, from 1.
        line: u64,
        /// Column.
        column: &'static str,
        /// As in the file.
        value: String,
        /// What is allowed.
        bound: String,
    },
    /// It is no table.
    #[error("{file}: {reason}: must be a table with a header, separated by commas; export {} as CSV", kind.what)]
    Table {
        /// The file.
        file: String,
        /// What the reader says.
        reason: String,
        /// What it holds.
        kind: Kind,
    },
    /// Too few or too many rows.
    #[error("{file}: {rows} rows: must be {} to {MOST_ROWS}: give {}", kind.least, kind.give)]
    Rows {
        /// The table.
        file: String,
        /// Rows found.
        rows: usize,
        /// What it holds.
        kind: Kind,
    },
}

/// A row that is read.
pub struct Cells<'a> {
    file: &'a str,
    header: &'a StringRecord,
    record: &'a StringRecord,
}

/// The position of a column.
fn position(header: &StringRecord, column: &str) -> Option<usize> {
    // Some programs begin a file with a mark of its encoding.
    let mut names = header.iter().map(|name| name.trim_start_matches('\u{feff}'));
    names.position(|name| name == column)
}

impl Cells<'_> {
    /// The text of a column; empty where there is no such column.
    pub fn text(&self, column: &str) -> &str {
        let at = position(self.header, column);
        at.and_then(|at| self.record.get(at)).unwrap_or_default()
    }

    /// A number within a range, which is `bound` in words.
    ///
    /// # Errors
    /// [`TableError::Value`] for any other text.
    pub fn number(
        &self,
        column: &'static str,
        range: RangeInclusive<f64>,
        bound: impl Into<String>,
    ) -> Result<f64, TableError> {
        let text = self.text(column);
        match text.parse::<f64>() {
            // No range contains NaN.
            Ok(value) if range.contains(&value) => Ok(value),
            _ => Err(TableError::Value {
                file: self.file.to_owned(),
                line: self.record.position().map_or(0, csv::Position::line),
                column,
                value: text.to_owned(),
                bound: bound.into(),
            }),
        }
    }

    /// An inclination (deg).
    ///
    /// # Errors
    /// As [`Cells::number`].
    pub fn inclination_deg(&self) -> Result<f64, TableError> {
        self.number(COLUMNS[1], 0.0..=180.0, "0 to 180 deg")
    }
}

/// The rows of a table, each read by `row` with the one before.
///
/// # Errors
/// [`TableError`] with file, line, column, value and bound.
pub fn read<T>(
    file: &str,
    text: &str,
    kind: Kind,
    mut row: impl FnMut(&Cells<'_>, Option<&T>) -> Result<T, TableError>,
) -> Result<Vec<T>, TableError> {
    let table = |error: csv::Error| TableError::Table {
        file: file.to_owned(),
        reason: error.to_string(),
        kind,
    };
    // Programs export columns in any order, with more of them, and with comments.
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(table)?.clone();
    if let Some(column) = COLUMNS.into_iter().find(|column| position(&header, column).is_none()) {
        return Err(TableError::Column {
            file: file.to_owned(),
            column,
        });
    }
    let mut rows: Vec<T> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(table)?;
        let cells = Cells {
            file,
            header: &header,
            record: &record,
        };
        let next = row(&cells, rows.last())?;
        rows.push(next);
        // Reading ends one row beyond the limit, which is then refused.
        if rows.len() > MOST_ROWS {
            break;
        }
    }
    if (kind.least..=MOST_ROWS).contains(&rows.len()) {
        return Ok(rows);
    }
    Err(TableError::Rows {
        file: file.to_owned(),
        rows: rows.len(),
        kind,
    })
}
