//! What became of a frame: used, or why not, and which of its lines and items could not be used.

use std::fmt;

use super::item::ItemCode;

flexdrill_base::listed! {
    /// Why a complete frame gave no value.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum NotUsed: 1 {
        /// It has no item: some sources ask or show life with such frames.
        Empty: "empty";
        /// All its records came before.
        Repeated: "repeated";
        /// All its records are older than what came before.
        Late: "late";
        /// Its sequence numbers are too far ahead of those before.
        Jumped: "sequence jumped";
        /// It has no item that the mapping names.
        NothingMapped: "no mapped item";
        /// All its values are missing, unreadable or outside their range.
        NoGoodValue: "no good value";
    }
}

impl NotUsed {
    /// In words.
    pub const fn name(self) -> &'static str {
        self.row()[0]
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

flexdrill_base::listed! {
    /// Kinds of lines and items that could not be used.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum ItemFaultKind: 1 {
        /// The line does not begin with an item's four digits.
        NoItem: "line without an item";
        /// The line is too long, or the frame has more faults than are described.
        LongLine: "line too long";
        /// The value of a mapped item is no number.
        NoNumber: "no number";
        /// The value is outside its range.
        OutOfRange: "out of range";
        /// The item is in the frame twice.
        Twice: "item twice in a frame";
        /// An item of the header cannot be read.
        Header: "unreadable header item";
    }
}

impl ItemFaultKind {
    /// In words.
    pub const fn name(self) -> &'static str {
        self.row()[0]
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
