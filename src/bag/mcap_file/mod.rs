//! Reading one MCAP file, whole, cut short or damaged.
//!
//! The file is walked here rather than by the `mcap` crate, which parses single records only, because a cut or damaged
//! file must give everything that is whole, in time order, with the place of what is not, and must never panic.
//!
//! [`records`] splits bytes into records; [`channels`] holds the topics; [`scan`] finds the chunks, topics and the end
//! of what can be read; [`chunk`] unpacks one chunk; [`stream`] gives the messages in time order. [`early_end`] makes the
//! end of a file whose writer could not go on.

mod channels;
mod chunk;
pub(super) mod early_end;
mod records;
mod scan;
mod stream;

pub(super) use stream::McapStream;

/// Opcode and length before each record.
const RECORD_HEAD: u64 = 9;
