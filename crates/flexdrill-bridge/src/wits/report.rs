//! What became of a frame: used, or why not, and which of its lines and items could not be used.

use std::fmt;

use super::item::ItemCode;

/// Why a complete frame gave no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NotUsed {
    /// It has no item: some sources ask or show life with such frames.
    Empty,
    /// All its records came before.
    Repeated,
    /// All its records are older than what came before.
    Late,
    /// Its sequence numbers are too far ahead of those before.
    Jumped,
    /// It has no item that the mapping names.
    NothingMapped,
    /// All its values are missing, unreadable or outside their range.
    NoGoodValue,
}

impl NotUsed {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Empty,
        Self::Repeated,
        Self::Late,
        Self::Jumped,
        Self::NothingMapped,
        Self::NoGoodValue,
    ];

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Repeated => "repeated",
            Self::Late => "late",
            Self::Jumped => "sequence jumped",
            Self::NothingMapped => "no mapped item",
            Self::NoGoodValue => "no good value",
        }
    }
}

/// What became of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameUse {
    /// It gave values.
    Used {
        /// How many.
        values: u32,
    },
    /// It gave none.
    NotUsed(NotUsed),
}

/// Kinds of lines and items that could not be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ItemFaultKind {
    /// The line does not begin with an item's four digits.
    NoItem,
    /// The line is too long, or the frame has more faults than are described.
    LongLine,
    /// The value of a mapped item is no number.
    NoNumber,
    /// The value is outside its range.
    OutOfRange,
    /// The item is in the frame twice.
    Twice,
    /// An item of the header cannot be read.
    Header,
}

impl ItemFaultKind {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::NoItem,
        Self::LongLine,
        Self::NoNumber,
        Self::OutOfRange,
        Self::Twice,
        Self::Header,
    ];

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoItem => "line without an item",
            Self::LongLine => "line too long",
            Self::NoNumber => "no number",
            Self::OutOfRange => "out of range",
            Self::Twice => "item twice in a frame",
            Self::Header => "unreadable header item",
        }
    }
}

/// A line or item that could not be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ItemFault {
    /// What is wrong.
    pub kind: ItemFaultKind,
    /// The item, if the line has one.
    pub code: Option<ItemCode>,
    /// The text, escaped and cut.
    pub text: String,
    /// What was expected.
    pub wanted: String,
}

impl fmt::Display for ItemFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(code) = self.code {
            write!(f, "item {code}: ")?;
        }
        write!(f, "{}: \"{}\"", self.kind.name(), self.text)?;
        if !self.wanted.is_empty() {
            write!(f, "; {}", self.wanted)?;
        }
        Ok(())
    }
}
