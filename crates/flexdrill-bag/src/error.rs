//! Errors of reading and writing bags.

use std::io;
use std::path::{Path, PathBuf};

use flexdrill_messages::CdrError;

/// Why a bag could not be written or read. Every message names the file.
#[derive(Debug, thiserror::Error)]
pub enum BagError {
    /// The file system refused an operation.
    #[error("cannot {action} {path}: {source}{hint}", path = path.display(), hint = hint(source))]
    Io {
        /// The operation, such as `write`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// A recording would overwrite a file.
    #[error("{path} exists already: a recording never overwrites a file; choose another name or remove the file", path = path.display())]
    Exists {
        /// The file or folder.
        path: PathBuf,
    },
    /// The folder has the metadata.yaml of another bag.
    #[error(
        "{path} belongs to another bag, and a folder can hold the metadata of one bag only: \
         record into an empty folder (a path that does not end in .mcap creates one)",
        path = path.display()
    )]
    OtherMetadata {
        /// The other bag's metadata.
        path: PathBuf,
    },
    /// An earlier error has stopped the recording.
    #[error("an earlier error has stopped the recording {path}; the messages written before it are kept", path = path.display())]
    Stopped {
        /// The file or folder.
        path: PathBuf,
    },
    /// The disk refused data that the kernel had accepted.
    #[error(
        "cannot sync {path} to the disk: {source}; its last {messages} messages may be lost",
        path = path.display()
    )]
    NotSafe {
        /// The file or folder.
        path: PathBuf,
        /// Messages written since the last successful sync.
        messages: u64,
        /// The underlying error.
        source: io::Error,
    },
    /// The file was removed, moved or replaced.
    #[error(
        "{path} is gone: the file or its folder was removed, moved or replaced; \
         its {messages} messages are no longer part of this recording",
        path = path.display()
    )]
    Gone {
        /// The file or folder.
        path: PathBuf,
        /// Messages in the file.
        messages: u64,
    },
    /// The folder of a recording is on another disk than before.
    #[error(
        "{path} is on another disk than when the recording began, so nothing is written there; \
         mount the first disk again, or restart the recording",
        path = path.display()
    )]
    OtherDisk {
        /// The folder.
        path: PathBuf,
    },
    /// The disk did not respond while the recording was created.
    #[error(
        "the recording {path} could not be created within {seconds} s: the disk does not respond",
        path = path.display()
    )]
    NotBegun {
        /// The file or folder.
        path: PathBuf,
        /// Time waited (s).
        seconds: u64,
    },
    /// The disk did not respond while the recording ended.
    #[error(
        "the recording {path} did not end within {seconds} s: the disk does not respond; \
         {messages} messages may not be on it",
        path = path.display()
    )]
    Hung {
        /// The file or folder.
        path: PathBuf,
        /// Time waited (s).
        seconds: u64,
        /// Messages that may be lost.
        messages: u64,
    },
    /// A recording ended while the disk refused writes, or its end could not be written.
    #[error(
        "the recording {path} is not complete: {problem}; it holds {messages} messages, {lost} are lost",
        path = path.display()
    )]
    Incomplete {
        /// The file or folder.
        path: PathBuf,
        /// Messages in the files.
        messages: u64,
        /// Messages lost.
        lost: u64,
        /// The cause.
        problem: Box<BagError>,
    },
    /// The MCAP writer refused.
    #[error("cannot write {path}: {source}", path = path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The underlying error.
        source: mcap::McapError,
    },
    /// A topic index beyond the topics that the recording was created with.
    #[error("{path}: topic index {index} is out of range; the recording has {count} topics", path = path.display())]
    NoSuchIndex {
        /// The recording.
        path: PathBuf,
        /// The index.
        index: usize,
        /// Number of topics.
        count: usize,
    },
    /// Neither MCAP nor SQLite nor a folder with either.
    #[error("{path} is not a bag: {problem}", path = path.display())]
    NotABag {
        /// The file or folder.
        path: PathBuf,
        /// Why it is none.
        problem: String,
    },
    /// rosbag2's compression of single messages, which this crate does not read.
    #[error("{path} is compressed as {compression:?}, which is not supported: {remedy}", path = path.display())]
    Compression {
        /// The file or folder.
        path: PathBuf,
        /// The compression.
        compression: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A compressed file unpacks to more than is accepted.
    #[error(
        "{path} has {packed} bytes and unpacks to more than {most} bytes, which are accepted at most: no recording \
         compresses so well; if it is one, unpack it with `unzstd` and read the result",
        path = path.display()
    )]
    TooLarge {
        /// The compressed file.
        path: PathBuf,
        /// Its size (bytes).
        packed: u64,
        /// Largest size that is accepted (bytes).
        most: u64,
    },
    /// A bag of ROS 1.
    #[error(
        "{path} is a bag of ROS 1, and flexdrill reads those of ROS 2: convert it, for example with `rosbags-convert` of the \
         Python package rosbags",
        path = path.display()
    )]
    Ros1 {
        /// The file.
        path: PathBuf,
    },
    /// A metadata.yaml cannot be parsed.
    #[error("{path}: {problem}", path = path.display())]
    Metadata {
        /// The file or folder.
        path: PathBuf,
        /// The defect.
        problem: String,
    },
    /// A part of a file is damaged; later parts may be whole.
    #[error("{path}, byte {offset}: {problem}", path = path.display())]
    Damaged {
        /// The file or folder.
        path: PathBuf,
        /// Offset of the damaged part (bytes).
        offset: u64,
        /// The defect.
        problem: String,
    },
    /// SQLite cannot read the file.
    #[error("cannot read {path}: {source}", path = path.display())]
    Sqlite {
        /// The file or folder.
        path: PathBuf,
        /// The underlying error.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The file is an SQLite bag, and the program was built without SQLite.
    #[error(
        "{path} is an SQLite bag, and this build reads no SQLite bags: build flexdrill with --features sqlite, or convert \
         the bag to MCAP with `ros2 bag convert`",
        path = path.display()
    )]
    NoSqlite {
        /// The file or folder.
        path: PathBuf,
    },
    /// The bag has no such topic.
    #[error("no topic {name} in the bag, which has: {present}")]
    NoTopic {
        /// The requested name, relative or absolute.
        name: String,
        /// The bag's topics.
        present: String,
    },
    /// Several topics of the bag end in that name.
    #[error("{name} is ambiguous in this bag, which has: {present}; give the full name")]
    AmbiguousTopic {
        /// The requested relative name.
        name: String,
        /// The topics that match.
        present: String,
    },
    /// A topic has another type than expected, or none.
    #[error("{topic} has {}, expected {expected}: {}", in_words(found), type_remedy(found))]
    WrongType {
        /// Absolute name of the topic.
        topic: String,
        /// The type in the bag.
        found: String,
        /// The expected type.
        expected: &'static str,
    },
    /// A topic has another encoding than that of ROS 2.
    #[error(
        "{topic} is encoded as {found:?}, expected \"cdr\" as ROS 2 has it: {}",
        encoding_remedy(found)
    )]
    WrongEncoding {
        /// Absolute name of the topic.
        topic: String,
        /// The encoding in the bag.
        found: String,
    },
    /// A message's bytes do not match its type.
    #[error("{topic} at {log_time} ns: {source}")]
    Decode {
        /// Absolute name of the topic.
        topic: String,
        /// Log time of the message.
        log_time: i64,
        /// The underlying error.
        source: CdrError,
    },
}

impl BagError {
    /// Why a recording stopped, as a sentence for the operator.
    pub fn cause(&self) -> &'static str {
        use io::ErrorKind;
        match self {
            Self::Gone { .. } => "The recording's file or its folder was removed, moved or replaced.",
            Self::OtherDisk { .. } => "The recording's disk was removed.",
            Self::NotSafe { source, .. } if cannot_sync(source) => {
                "The recording's file system does not support that files are synced to the disk."
            }
            Self::NotSafe { .. } => "The disk failed to store data that it had accepted.",
            Self::Hung { .. } | Self::NotBegun { .. } => "The disk does not respond.",
            Self::Incomplete { problem, .. } => problem.cause(),
            Self::Io { source, .. } => match source.kind() {
                ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "The disk is full.",
                ErrorKind::FileTooLarge => "The file has reached the largest size allowed.",
                ErrorKind::NotFound => "The recording's folder was removed.",
                ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => "The folder is write-protected.",
                _ => "The disk refused an operation.",
            },
            _ => "The recording failed for a reason other than the disk.",
        }
    }

    /// What the person who runs the computer can do when a recording stops, as a sentence.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::NotSafe { source, .. } if cannot_sync(source) => {
                "Restart the node with --record on a file system that can sync, such as ext4 or xfs. Free space does not help."
            }
            Self::NotSafe { .. } => {
                "Check the disk: it failed to store data, which a full or a defective disk does. The recording continues in \
                 another file as soon as it can; otherwise restart the node with --record on another disk."
            }
            Self::Incomplete { problem, .. } => problem.remedy(),
            Self::Io { source, .. }
                if matches!(
                    source.kind(),
                    io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem
                ) =>
            {
                "Allow the node to write to the folder, or restart it with --record in another folder."
            }
            _ => {
                "Free disk space: the recording then continues in another file. Otherwise restart the node with --record \
                 on another disk."
            }
        }
    }

    /// For `map_err` on operations on a path.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }
}

fn in_words(ros_type: &str) -> String {
    match ros_type {
        "" => "no type, because the file has no schema for it".to_owned(),
        other => format!("the type {other}"),
    }
}

fn type_remedy(found: &str) -> &'static str {
    match found {
        "" => "record it with a program that writes the message definitions, such as ros2 bag record",
        _ => "have it published with the expected type, or convert the bag",
    }
}

fn encoding_remedy(found: &str) -> &'static str {
    match found {
        "ros1" => "convert the bag to ROS 2, for example with rosbags-convert of the Python package rosbags",
        _ => "record the topic of ROS 2 with ros2 bag record",
    }
}

/// Whether a file system refuses to sync as such: EINVAL, ENOSYS, EOPNOTSUPP or EPERM. A disk that fails returns others.
fn cannot_sync(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported | io::ErrorKind::PermissionDenied
    )
}

/// The remedy for the commonest errors.
fn hint(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "; free space; the messages written before are kept"
        }
        io::ErrorKind::FileTooLarge => {
            "; the file has reached the largest size allowed (ulimit -f, or the file system); the messages written before are kept"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "; choose a folder that you can write to"
        }
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_sync_is_named_as_what_it_is() {
        let text = |code: i32| {
            let error = BagError::NotSafe {
                path: "run.mcap".into(),
                messages: 3,
                source: io::Error::from_raw_os_error(code),
            };
            format!("{} {}", error.cause(), error.remedy())
        };
        // EINVAL, ENOSYS, EPERM, EOPNOTSUPP.
        for code in [22, 38, 1, 95] {
            assert!(
                text(code).contains("does not support") && text(code).contains("ext4"),
                "{}",
                text(code)
            );
        }
        // EIO.
        assert!(
            text(5).contains("failed to store data") && text(5).contains("defective"),
            "{}",
            text(5)
        );
    }
}
