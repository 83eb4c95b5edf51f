//! Reads one MCAP file: whole, truncated or damaged.
//!
//! The `mcap` crate parses single records; walking the file is done here, because a truncated or damaged file must
//! yield every whole message in time order and the offset of every defect, and must never panic.
//!
//! An MCAP file is a row of records: opcode (1 byte), length (8 bytes), body. Messages lie in compressed chunks, and
//! schemas and channels describe their topics. [`records`] splits bytes into records. [`scan`] passes over the file
//! once and finds chunks, topics and the end of the readable part. [`channels`] holds the topics, [`chunk`]
//! decompresses one chunk, [`stream`] merges the chunks into one sequence of messages. [`early_end`] writes the end of
//! a file whose writer could not continue.

mod channels;
mod chunk;
pub(super) mod early_end;
mod records;
mod scan;
mod search;
mod stream;

pub(super) use stream::McapStream;

/// Bytes of a record before its body: opcode and length.
const RECORD_HEAD: u64 = 9;
