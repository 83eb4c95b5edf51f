//! A message as one file of a bag holds it, before the files are merged.

use std::cmp::Ordering;

/// A message within one file; `topic` counts in that file. Ordered by log time, then by `order`.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct RawMessage {
    /// ns since the clock's epoch.
    pub log_time: i64,
    /// Settles which of equal times comes first.
    pub order: u64,
    /// ns since the clock's epoch.
    pub publish_time: i64,
    pub topic: usize,
    /// Number in its topic, where the file numbers them.
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
