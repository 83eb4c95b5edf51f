//! How a log lays out its rows: the separator, the row of the header, and the fields of a row.

use crate::FieldLogError;
use crate::las;
use crate::lines::{LineReader, Lines};
use crate::mapping::Mapping;

/// Longest line that is read (bytes): a thousand columns of a thousand characters. Reading a line takes 18 times its
/// length in memory.
pub(crate) const LONGEST_LINE: usize = 1 << 20;
/// Most rows before a header that the mapping does not place.
const PREAMBLE: usize = 200;
/// Rows by which the number of fields is judged.
const JUDGED: usize = 200;

/// The layout of a log.
pub(crate) struct Layout<'a> {
    pub(crate) reader: LineReader,
    pub(crate) separator: char,
    pub(crate) header: csv::ByteRecord,
    /// The unit of each column as the log gives it, in the order of the header; empty where the log gives none.
    pub(crate) units: Vec<String>,
    /// The lines after the header.
    pub(crate) rows: Lines<'a>,
    /// What the log itself writes for no value.
    pub(crate) missing: Option<f64>,
    /// What was found in the log and not in the mapping, for the report.
    pub(crate) notes: Vec<String>,
    fields: Fields,
}

/// The fields that a row has.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Fields {
    count: usize,
    /// From this field on all are empty.
    empty_from: usize,
}

impl<'a> Layout<'a> {
    /// # Errors
    /// When the first line is too long, the row of the header is not in the file, or a LAS file cannot be read.
    pub(crate) fn of(file: &str, content: &'a [u8], mapping: &Mapping) -> Result<Self, FieldLogError> {
        if las::is_las(content) {
            return Self::of_las(file, content);
        }
        let mut lines = Lines::of(content);
        let mut notes = Vec::new();
        let mut separator = mapping.separator;
        let (first_number, first) = lines.clone().next().unwrap_or((1, b""));
        // A file without line ends would be read into memory as one header.
        if first.len() > LONGEST_LINE {
            return Err(FieldLogError::LongHeader {
                file: file.to_owned(),
                bytes: first.len(),
                most: LONGEST_LINE,
            });
        }
        // Spreadsheets write their separator into the first line.
        if let Some(named) = separator_line(first) {
            lines.next();
            if named != separator {
                notes.push(format!(
                    "row {first_number} says that {named:?} separates the fields, which is used in place of the mapping's \
                     {separator:?}"
                ));
            }
            separator = named;
        }
        let mut reader = LineReader::new(separator);
        let (number, header) = find_header(file, &mut lines, &mut reader, mapping)?;
        if mapping.header_row.is_none() && number > first_number + 1 {
            notes.push(format!("the header is row {number}; the rows above it are not read"));
        }
        let fields = Fields::of(&header, lines.clone(), &mut reader);
        if fields.count > header.len() {
            notes.push(format!(
                "rows have {} empty fields more than the header, which are ignored",
                fields.count - header.len()
            ));
        }
        Ok(Self {
            units: header.iter().map(unit_in_name).collect(),
            reader,
            separator,
            header,
            rows: lines,
            missing: None,
            notes,
            fields,
        })
    }

    fn of_las(file: &str, content: &'a [u8]) -> Result<Self, FieldLogError> {
        let mut lines = Lines::of(content).without_comments(b'#');
        let las = las::before_data(file, &mut lines)?;
        let null = las
            .null
            .map_or_else(String::new, |null| format!("; {null} is no value"));
        Ok(Self {
            reader: LineReader::new(' '),
            separator: ' ',
            notes: vec![format!(
                "the log is LAS: its columns are the curves of section ~C{null}"
            )],
            fields: Fields::exactly(las.curves.len()),
            header: las.curves,
            units: las.units,
            rows: lines,
            missing: las.null,
        })
    }

    /// Whether a row has the fields that the rows of this log have.
    pub(crate) fn fits(&self, record: &csv::ByteRecord) -> bool {
        record.len() == self.fields.count && record.iter().skip(self.fields.empty_from).all(<[u8]>::is_empty)
    }

    /// The number of fields of a row.
    pub(crate) const fn width(&self) -> usize {
        self.fields.count
    }

    /// Index of the one column of that name.
    pub(crate) fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name.as_bytes())
    }
}

impl Fields {
    const fn exactly(count: usize) -> Self {
        Self {
            count,
            empty_from: count,
        }
    }

    /// As most of the first rows have them. Some loggers end each row with a separator, and not the header, or only the
    /// header.
    fn of(header: &csv::ByteRecord, rows: Lines<'_>, reader: &mut LineReader) -> Self {
        let named = header
            .iter()
            .rposition(|name| !name.is_empty())
            .map_or(0, |last| last + 1);
        let header = Self::exactly(header.len());
        let mut counts = std::collections::BTreeMap::<usize, usize>::new();
        for (_, line) in rows.take(JUDGED).filter(|(_, line)| line.len() <= LONGEST_LINE) {
            let record = reader.read(line);
            if record.len() <= header.count || record.iter().skip(header.count).all(<[u8]>::is_empty) {
                *counts.entry(record.len()).or_default() += 1;
            }
        }
        let (as_header, most) = (
            counts.get(&header.count).copied(),
            counts.iter().max_by_key(|(_, rows)| **rows),
        );
        match most {
            Some((count, rows)) if *count >= named && *rows > as_header.unwrap_or(0) => Self {
                count: *count,
                empty_from: header.count.min(*count),
            },
            _ => header,
        }
    }
}

/// The separator that a line such as `sep=;` names.
pub(crate) fn separator_line(line: &[u8]) -> Option<char> {
    let text = std::str::from_utf8(line).ok()?.trim_matches(['\r', '\n', '"']);
    let (key, separator) = text.split_once('=')?;
    let mut characters = separator.chars();
    let only = characters.next().filter(|only| only.is_ascii() && *only != '"')?;
    (key.trim().eq_ignore_ascii_case("sep") && characters.next().is_none()).then_some(only)
}

/// The header with its row; `lines` has the row after it next. Without a row in the mapping it is the first line, or the
/// first of the next ones that has all columns of the mapping.
fn find_header(
    file: &str,
    lines: &mut Lines<'_>,
    reader: &mut LineReader,
    mapping: &Mapping,
) -> Result<(u64, csv::ByteRecord), FieldLogError> {
    if let Some(row) = mapping.header_row {
        let found = lines.find(|(number, _)| *number >= row);
        return match found.filter(|(number, line)| *number == row && line.len() <= LONGEST_LINE) {
            Some((number, line)) => Ok((number, reader.read(line))),
            None => Err(FieldLogError::NoHeader {
                file: file.to_owned(),
                row,
            }),
        };
    }
    let names = mapping.columns.names();
    let mut best: Option<(usize, u64, csv::ByteRecord, Lines<'_>)> = None;
    let mut ahead = lines.clone();
    for _ in 0..PREAMBLE {
        let Some((number, line)) = ahead.next() else { break };
        if line.len() > LONGEST_LINE {
            continue;
        }
        let header = reader.read(line);
        let has = |name: &&&str| header.iter().any(|column| column == name.as_bytes());
        let found = names.iter().filter(has).count();
        // Without a line that has all names, the error quotes the one that has most of them.
        if best.as_ref().is_none_or(|(most, ..)| found > *most) {
            best = Some((found, number, header, ahead.clone()));
        }
        if found == names.len() {
            break;
        }
    }
    let Some((_, number, header, after)) = best else {
        return Ok((1, csv::ByteRecord::new()));
    };
    *lines = after;
    Ok((number, header))
}

/// The unit that a name has in brackets at its end, such as `Hook load (klbf)`; empty without one.
fn unit_in_name(name: &[u8]) -> String {
    let name = String::from_utf8_lossy(name);
    let inside = name.strip_suffix(')').and_then(|name| name.rsplit_once('('));
    let inside = inside.or_else(|| name.strip_suffix(']').and_then(|name| name.rsplit_once('[')));
    inside.map_or_else(String::new, |(_, unit)| unit.trim().to_owned())
}
