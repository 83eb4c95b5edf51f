//! A message of one file, before the files of a bag are merged.

use std::cmp::Ordering;

/// A message of one file; `topic` is the index in that file. Messages are ordered by log time, then by `order`.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct RawMessage {
    /// ns since the clock's epoch.
    pub log_time: i64,
    /// Position in the file, which orders messages of equal time.
    pub order: u64,
    /// ns since the clock's epoch.
    pub publish_time: i64,
    pub topic: usize,
    /// Sequence number in its topic; `None` when the file has none.
    pub sequence: Option<u32>,
    /// CDR with its header.
    pub data: Vec<u8>,
}

impl Ord for RawMessage {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.log_time, self.order).cmp(&(other.log_time, other.order))
    }
}

impl PartialOrd for RawMessage {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
