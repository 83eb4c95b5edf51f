//! What can go wrong with bags.

use std::io;
use std::path::{Path, PathBuf};

use crate::messages::CdrError;

/// Why a bag could not be written or read. Every message names the file.
#[derive(Debug, thiserror::Error)]
pub enum BagError {
    /// The file system refused.
    #[error("cannot {action} {path}: {source}{hint}", path = path.display(), hint = hint(source))]
    Io {
        /// What was tried, such as `write`.
        action: &'static str,
        /// File or folder that it is about.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A recording would overwrite a file.
    #[error("{path} exists already: recordings never overwrite; choose another name or remove it", path = path.display())]
    Exists {
        /// File or folder that it is about.
        path: PathBuf,
    },
    /// Another recording in the same folder has its metadata.yaml there.
    #[error(
        "{path} belongs to another bag, and a folder can hold the metadata of one only: \
         record into a folder of its own (a path without .mcap at its end makes one)",
        path = path.display()
    )]
    OtherMetadata {
        /// The other bag's metadata.
        path: PathBuf,
    },
    /// The recording stopped on an earlier error.
    #[error("the recording {path} has stopped on an earlier error; what was written before is kept", path = path.display())]
    Stopped {
        /// File or folder that it is about.
        path: PathBuf,
    },
    /// The disk refused what the kernel had taken.
    #[error(
        "cannot bring {path} to the disk: {source}; the last {messages} messages in it may be lost",
        path = path.display()
    )]
    NotSafe {
        /// File or folder that it is about.
        path: PathBuf,
        /// Messages written since the last time that it was on the disk for certain.
        messages: u64,
        /// The error behind it.
        source: io::Error,
    },
    /// The file is not at its place any more.
    #[error(
        "{path} is no longer where it was made: the file or its folder was removed, moved or replaced; \
         the {messages} messages in it are not in this recording any more",
        path = path.display()
    )]
    Gone {
        /// File or folder that it is about.
        path: PathBuf,
        /// Messages in the file.
        messages: u64,
    },
    /// The folder of a recording is on another disk than before.
    #[error(
        "{path} is on another disk than when the recording began: nothing is written there; \
         bring the first disk back, or start the recording again",
        path = path.display()
    )]
    OtherDisk {
        /// The folder.
        path: PathBuf,
    },
    /// The disk does not answer when a recording is begun.
    #[error(
        "the recording {path} could not be begun within {seconds} s: the disk does not answer",
        path = path.display()
    )]
    NotBegun {
        /// File or folder that it is about.
        path: PathBuf,
        /// How long it was waited for (s).
        seconds: u64,
    },
    /// The disk does not answer.
    #[error(
        "the recording {path} did not end within {seconds} s: the disk does not answer; \
         {messages} messages are not known to be on it",
        path = path.display()
    )]
    Hung {
        /// File or folder that it is about.
        path: PathBuf,
        /// How long it was waited for (s).
        seconds: u64,
        /// Messages that may be lost.
        messages: u64,
    },
    /// A recording ended while it could not be written, or its end could not.
    #[error(
        "the recording {path} is not complete: {problem}; {messages} messages are in it, {lost} are lost",
        path = path.display()
    )]
    Incomplete {
        /// File or folder that it is about.
        path: PathBuf,
        /// Messages in the files.
        messages: u64,
        /// Messages lost.
        lost: u64,
        /// Why.
        problem: Box<BagError>,
    },
    /// The MCAP writer refused.
    #[error("cannot write {path}: {source}", path = path.display())]
    Write {
        /// File or folder that it is about.
        path: PathBuf,
        /// The error behind it.
        source: mcap::McapError,
    },
    /// A topic index that was not given when the recording was created.
    #[error("{path}: topic number {index} was not announced, there are {count}", path = path.display())]
    NoSuchIndex {
        /// Which recording.
        path: PathBuf,
        /// The index.
        index: usize,
        /// Topics there are.
        count: usize,
    },
    /// Neither MCAP nor SQLite nor a folder with either.
    #[error("{path} is not a bag: {problem}", path = path.display())]
    NotABag {
        /// File or folder that it is about.
        path: PathBuf,
        /// What it is instead.
        problem: String,
    },
    /// rosbag2's own compression of whole files or messages, and chunk compressions that we do not know.
    #[error("{path} is compressed as {compression:?}, which is not supported: {remedy}", path = path.display())]
    Compression {
        /// File or folder that it is about.
        path: PathBuf,
        /// How.
        compression: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A metadata.yaml is not understood.
    #[error("{path}: {problem}", path = path.display())]
    Metadata {
        /// File or folder that it is about.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// Part of a file is damaged; what follows may be whole.
    #[error("{path}, byte {offset}: {problem}", path = path.display())]
    Damaged {
        /// File or folder that it is about.
        path: PathBuf,
        /// Where the damaged part begins.
        offset: u64,
        /// What is wrong.
        problem: String,
    },
    /// SQLite refused.
    #[error("cannot read {path}: {source}", path = path.display())]
    Sqlite {
        /// File or folder that it is about.
        path: PathBuf,
        /// The error behind it.
        source: rusqlite::Error,
    },
    /// The bag has no such topic.
    #[error("no topic {name} in the bag, which has: {present}")]
    NoTopic {
        /// Relative or absolute name asked for.
        name: String,
        /// Names there are.
        present: String,
    },
    /// Several topics of the bag end in that name.
    #[error("{name} is not clear in this bag, it could be: {present}; give the full name")]
    AmbiguousTopic {
        /// Relative name asked for.
        name: String,
        /// Names that match.
        present: String,
    },
    /// A message is of another type than expected.
    #[error("{topic} carries {found}, expected {expected}")]
    WrongType {
        /// Absolute name of the topic.
        topic: String,
        /// Type in the bag.
        found: String,
        /// Type asked for.
        expected: &'static str,
    },
    /// A message's bytes do not fit its type.
    #[error("{topic} at {log_time} ns: {source}")]
    Decode {
        /// Absolute name of the topic.
        topic: String,
        /// Log time of the message.
        log_time: i64,
        /// The error behind it.
        source: CdrError,
    },
}

impl BagError {
    /// Why a recording stopped, in a sentence for a person.
    pub fn cause(&self) -> &'static str {
        use io::ErrorKind;
        match self {
            Self::Gone { .. } => "The recording's file or its folder was removed, moved or replaced.",
            Self::OtherDisk { .. } => "The recording's disk was taken out.",
            Self::NotSafe { .. } => "The disk refused to keep what was written.",
            Self::Hung { .. } | Self::NotBegun { .. } => "The disk does not answer.",
            Self::Incomplete { problem, .. } => problem.cause(),
            Self::Io { source, .. } => match source.kind() {
                ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "The disk is full.",
                ErrorKind::FileTooLarge => "The file may not grow further.",
                ErrorKind::NotFound => "The recording's folder was removed.",
                ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => "The folder may not be written to.",
                _ => "The disk refused an operation.",
            },
            _ => "The recording met an error that is none of the disk.",
        }
    }

    /// For `map_err` on operations on a path.
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }
}

/// What a person can do about the commonest ones.
fn hint(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "; free space, what was written before is kept",
        io::ErrorKind::FileTooLarge => {
            "; a file may not grow further (ulimit -f, or the file system), what was written before is kept"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "; choose a folder that you may write to"
        }
        _ => "",
    }
}
