//! A file of a bag and its messages, before the files are merged.

use std::cmp::Ordering;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use crate::{BagError, Topic};

/// A message of one file; `topic` is the index in that file. Messages are ordered by log time, then by `order`.
#[derive(Debug, PartialEq, Eq)]
pub struct RawMessage {
    /// ns since the clock's epoch.
    pub log_time: i64,
    /// Position in the file, which orders messages of equal time.
    pub order: u64,
    /// ns since the clock's epoch.
    pub publish_time: i64,
    /// Index of its topic in the file.
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

/// A file of a bag, of any storage: its messages in time order.
pub trait BagFile: Send {
    /// The topics that are known so far; others follow behind them.
    fn topics(&self) -> &[Arc<Topic>];

    /// Limits the messages to these topics, in the order of [`BagFile::topics`].
    fn set_wanted(&mut self, wanted: Vec<bool>);

    /// The next message; `None` at the end.
    fn next(&mut self) -> Option<Result<RawMessage, BagError>>;

    /// Continues with the first message at or after `time` (ns since the clock's epoch).
    fn seek(&mut self, time: i64);

    /// Number of messages, if the file states it.
    fn messages(&self) -> Option<u64>;

    /// First and last log time (ns since the clock's epoch), if the file states them.
    fn bounds(&self) -> Option<(i64, i64)>;
}

/// Opens an SQLite file of rosbag2.
pub type OpenSqlite = fn(&Path) -> Result<Box<dyn BagFile>, BagError>;

/// How SQLite files are opened in this program.
static SQLITE: OnceLock<OpenSqlite> = OnceLock::new();

/// From now on SQLite files are opened by `open`; the crate `flexdrill-sqlite` has one. Of several calls the first counts.
/// A feature of this crate would have everything that uses it compiled once more for programs with SQLite.
pub fn read_sqlite_with(open: OpenSqlite) {
    let _ = SQLITE.set(open);
}

/// Opens an SQLite file.
///
/// # Errors
/// [`BagError::NoSqlite`] without [`read_sqlite_with`]; else those of its function.
pub(crate) fn open_sqlite(path: &Path) -> Result<Box<dyn BagFile>, BagError> {
    match SQLITE.get() {
        Some(open) => open(path),
        None => Err(BagError::NoSqlite { path: path.to_owned() }),
    }
}
