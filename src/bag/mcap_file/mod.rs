//! Reading one MCAP file, whole, cut short or damaged.
//!
//! The records are parsed here rather than by the `mcap` crate because a cut or damaged file must give everything that
//! is whole, in time order, with the place of what is not, and must never panic.
//!
//! [`scan`] finds the chunks, topics and the end of what can be read; [`chunk`] unpacks one chunk; [`stream`] gives the
//! messages in time order.

mod chunk;
mod fields;
mod scan;
mod stream;

pub(super) use stream::McapStream;

/// First bytes of an MCAP file.
pub(super) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";

/// Opcode and length before each record.
const RECORD_HEAD: u64 = 9;

/// Kinds of record that are looked at.
mod op {
    pub const FOOTER: u8 = 0x02;
    pub const SCHEMA: u8 = 0x03;
    pub const CHANNEL: u8 = 0x04;
    pub const MESSAGE: u8 = 0x05;
    pub const CHUNK: u8 = 0x06;
    pub const STATISTICS: u8 = 0x0B;
}
