//! WITS level 0: text frames of items, without acknowledgement and without checksum.
//!
//! The way of the bytes: [`FrameReader`] splits them into frames, [`Decoder`] gives a frame's items their meaning after
//! the site's [`Mapping`] and watches each record's sequence number, [`Sources`] lets one connection serve each quantity,
//! [`FrameWriter`] writes frames. A [`capture`] keeps the bytes of a line with their times, so that they can be read again
//! as they came.

pub mod capture;
mod count;
mod decode;
mod frame;
mod header;
mod item;
mod line;
mod look;
mod mapping;
mod may_be;
mod report;
mod sequence;
mod sources;
mod write;

pub use count::Counts;
pub use decode::{ClockOffset, Decoder, Reading, RecordSeen};
pub use frame::{DiscardReason, Discarded, FrameReader, LONGEST_FRAME, LONGEST_LINE, Piece, RawFrame};
pub use header::{Header, LAST_HEADER_ITEM};
pub use item::{ItemCode, NoItemCode};
pub use line::{Line, LineEvent};
pub use look::{Look, LookRow};
pub use mapping::{AskMapping, ItemMapping, Mapping, SequenceUse, StampSource, UnitSystem, WriteItem, WriteMapping};
pub use report::{FrameUse, ItemFault, ItemFaultKind, NotUsed};
pub use sequence::{Classified, Numbered, Sequence, SequenceDefect, SequenceWatch};
pub use sources::{Refused, Sources};
pub use write::{FrameWriter, RigFrames, TwinFrames};

/// Foreign bytes as text for a log or a display: what cannot be shown is escaped.
pub fn shown(bytes: &[u8]) -> String {
    let text: String = bytes
        .iter()
        .flat_map(|byte| std::ascii::escape_default(*byte))
        .map(char::from)
        .collect();
    // Quotes need no escape here.
    text.replace("\\'", "'").replace("\\\"", "\"")
}
