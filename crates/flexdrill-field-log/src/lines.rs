//! Lines of a text, and the fields of a line.

use crate::mapping::plain_blanks;

/// Non-blank lines with the numbers that an editor shows; a line ends with CR, LF or both.
#[derive(Debug, Clone)]
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    number: u64,
    /// The first character of lines that are left out as comments.
    comment: Option<u8>,
}

impl<'a> Lines<'a> {
    pub(crate) fn of(content: &'a [u8]) -> Self {
        Self {
            rest: content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content),
            number: 0,
            comment: None,
        }
    }

    /// Leaves out lines that begin with this character from here on.
    pub(crate) fn without_comments(self, comment: u8) -> Self {
        Self {
            comment: Some(comment),
            ..self
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (u64, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        while !self.rest.is_empty() {
            self.number += 1;
            let end = self.rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let end = end.unwrap_or(self.rest.len());
            let (line, after) = self.rest.split_at(end);
            let ending = if after.starts_with(b"\r\n") { 2 } else { 1 };
            self.rest = after.get(ending..).unwrap_or_default();
            let text = line.trim_ascii();
            if text.first().is_some_and(|first| Some(*first) != self.comment) {
                return Some((self.number, line));
            }
        }
        None
    }
}

/// Initial size of the line buffer (bytes).
const LINE: usize = 1024;
/// Initial number of fields.
const FIELDS: usize = 64;

/// Parses single lines. Building a parser takes as long as parsing hundreds of lines, so all lines share one.
pub(crate) struct LineReader {
    /// None where any blanks separate the fields.
    parser: Option<csv_core::Reader>,
    fields: Vec<u8>,
    ends: Vec<usize>,
}

impl LineReader {
    /// A blank as separator stands for any blanks and tabs.
    pub(crate) fn new(separator: char) -> Self {
        let delimiter = u8::try_from(separator).unwrap_or(b',');
        Self {
            parser: (delimiter != b' ').then(|| csv_core::ReaderBuilder::new().delimiter(delimiter).build()),
            fields: vec![0; LINE],
            ends: vec![0; FIELDS],
        }
    }

    pub(crate) fn read(&mut self, line: &[u8]) -> csv::ByteRecord {
        let Some(parser) = &mut self.parser else {
            return between_blanks(line);
        };
        let line = &*plain_blanks(line);
        parser.reset();
        // Neither buffer needs more entries than the line has bytes, plus one for its end.
        if self.fields.len() <= line.len() {
            self.fields.resize(2 * line.len(), 0);
        }
        if self.ends.len() <= line.len() {
            self.ends.resize(2 * line.len(), 0);
        }
        let (mut input, mut written, mut ended) = (line, 0, 0);
        loop {
            let (result, read, more, ends) =
                parser.read_record(input, &mut self.fields[written..], &mut self.ends[ended..]);
            input = &input[read..];
            (written, ended) = (written + more, ended + ends);
            // An empty input marks the end of the line for the parser.
            if result != csv_core::ReadRecordResult::InputEmpty {
                break;
            }
        }
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        let mut record: csv::ByteRecord = begins
            .zip(&self.ends[..ended])
            .map(|(begin, end)| &self.fields[begin..*end])
            .collect();
        record.trim();
        record
    }
}

/// The fields between blanks and tabs; quotes keep the blanks of a field.
fn between_blanks(line: &[u8]) -> csv::ByteRecord {
    let mut record = csv::ByteRecord::new();
    let mut rest = line.trim_ascii_start();
    while let Some(first) = rest.first() {
        let (field, after) = if *first == b'"' {
            let inside = &rest[1..];
            let end = inside.iter().position(|byte| *byte == b'"').unwrap_or(inside.len());
            (&inside[..end], inside.get(end + 1..).unwrap_or_default())
        } else {
            let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
            rest.split_at(end)
        };
        record.push_field(field);
        rest = after.trim_ascii_start();
    }
    record
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_between_blanks() {
        let fields = |line: &[u8]| -> Vec<String> {
            let record = LineReader::new(' ').read(line);
            record
                .iter()
                .map(|field| String::from_utf8_lossy(field).into_owned())
                .collect()
        };
        assert_eq!(fields(b"  1.5\t 40   2 "), ["1.5", "40", "2"]);
        assert_eq!(fields(b"t \"hook load\" x"), ["t", "hook load", "x"]);
        assert_eq!(fields(b"1 \"open"), ["1", "open"]);
        assert!(fields(b"  ").is_empty());
    }
}
