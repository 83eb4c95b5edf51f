//! Reads bags of every supported format, all files merged in time order.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use tempfile::NamedTempFile;

use crate::mcap_file::McapStream;
use crate::packed::{self, Format};
use crate::parts::{self, Parts};
use crate::raw::{BagFile, RawMessage, open_sqlite};
use crate::{BagError, PartFault, Topic};
use flexdrill_messages::{Message, from_cdr};

/// One message of a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BagMessage {
    /// Its topic.
    pub topic: Arc<Topic>,
    /// Index of the topic in [`Bag::topics`].
    pub topic_index: usize,
    /// When it was recorded (ns since the clock's epoch).
    pub log_time: i64,
    /// When it was published (ns since the clock's epoch); in SQLite bags, which do not store it, the log time.
    pub publish_time: i64,
    /// CDR with its header.
    pub data: Vec<u8>,
    /// Sequence number in its topic; in flexdrill's recordings, a missing number is a lost message. SQLite bags have
    /// none.
    pub sequence: Option<u32>,
}

impl BagMessage {
    /// Decodes the message.
    ///
    /// # Errors
    /// When the topic has another type or encoding, or the bytes do not match the type.
    pub fn decode<M: Message>(&self) -> Result<M, BagError> {
        self.topic.check(M::ROS_TYPE)?;
        from_cdr(&self.data).map_err(|source| BagError::Decode {
            topic: self.topic.name.clone(),
            log_time: self.log_time,
            source,
        })
    }
}

/// A file that ends without its end record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cut {
    /// The file.
    pub path: PathBuf,
    /// End of the last whole record (bytes).
    pub offset: u64,
    /// The cause, as text for the operator.
    pub reason: String,
}

/// The temporary file of a compressed one, which is removed when this is dropped.
type Unpacked = Option<NamedTempFile>;

enum Stream {
    Mcap(Box<McapStream>),
    Sqlite(Box<dyn BagFile>),
}

impl Stream {
    /// Opens a file, with the fault of a compressed one that is damaged.
    fn open(path: &Path) -> Result<(Self, Unpacked, Option<PartFault>), BagError> {
        let (format, is_packed) = packed::format(path)?;
        let (unpacked, fault) = if is_packed {
            let (file, fault) = packed::unpack(path)?;
            (Some(file), fault)
        } else {
            (None, None)
        };
        let stream = match (format, &unpacked) {
            (Format::Mcap, None) => Self::Mcap(Box::new(McapStream::open(path)?)),
            (Format::Mcap, Some(file)) => {
                let content = file.reopen().map_err(BagError::io("read the unpacked", path))?;
                Self::Mcap(Box::new(McapStream::read(path, content)?))
            }
            (Format::Sqlite, unpacked) => {
                Self::Sqlite(open_sqlite(unpacked.as_ref().map_or(path, |file| file.path()))?)
            }
        };
        Ok((stream, unpacked, fault))
    }

    fn topics(&self) -> &[Arc<Topic>] {
        match self {
            Self::Mcap(stream) => stream.topics(),
            Self::Sqlite(stream) => stream.topics(),
        }
    }

    fn next(&mut self) -> Option<Result<RawMessage, BagError>> {
        match self {
            Self::Mcap(stream) => stream.next(),
            Self::Sqlite(stream) => stream.next(),
        }
    }

    fn seek(&mut self, time: i64) {
        match self {
            Self::Mcap(stream) => stream.seek(time),
            Self::Sqlite(stream) => stream.seek(time),
        }
    }

    fn messages(&self) -> Option<u64> {
        match self {
            Self::Mcap(stream) => stream.messages(),
            Self::Sqlite(stream) => stream.messages(),
        }
    }

    fn bounds(&self) -> Option<(i64, i64)> {
        match self {
            Self::Mcap(stream) => stream.bounds(),
            Self::Sqlite(stream) => stream.bounds(),
        }
    }
}

/// One file of the bag.
struct Source {
    stream: Stream,
    /// Its next message, if already read.
    ahead: Option<RawMessage>,
    /// The file has no more messages.
    ended: bool,
    /// Index of a topic in the bag, by its index in the file.
    topic_of: Vec<usize>,
    _unpacked: Unpacked,
}

/// An open bag: an iterator over its messages in time order.
///
/// A damaged part yields an error where its messages would be; iteration continues with the part after it. A truncated
/// file yields everything up to the cut, and [`Bag::cuts`] reports it.
pub struct Bag {
    sources: Vec<Source>,
    topics: Vec<Arc<Topic>>,
    faults: Vec<PartFault>,
}

/// Opens an MCAP file, an SQLite file of rosbag2, or a folder with either. Files that are compressed with Zstandard are
/// unpacked into the temporary folder (`TMPDIR`) while the bag is open.
///
/// Of several files those that can be read are; [`Bag::faults`] has the others.
///
/// # Errors
/// When the path is none of these, or cannot be read; [`BagError::NoSqlite`] for an SQLite file without
/// [`read_sqlite_with`](crate::read_sqlite_with).
pub fn open(path: &Path) -> Result<Bag, BagError> {
    let Parts { files, faults } = parts::find(path)?;
    let mut bag = Bag {
        sources: Vec::new(),
        topics: Vec::new(),
        faults,
    };
    let mut unreadable: Vec<(PathBuf, BagError)> = Vec::new();
    for file in files {
        match Stream::open(&file) {
            Ok((stream, unpacked, fault)) => {
                bag.faults.extend(fault);
                bag.sources.push(Source {
                    stream,
                    ahead: None,
                    ended: false,
                    topic_of: Vec::new(),
                    _unpacked: unpacked,
                });
            }
            Err(error) => unreadable.push((file, error)),
        }
    }
    for (path, error) in unreadable {
        // The first error is that of a bag without any readable file.
        if bag.sources.is_empty() {
            return Err(error);
        }
        let why = error.to_string();
        bag.faults.push(PartFault::Unreadable { path, why });
    }
    for index in 0..bag.sources.len() {
        bag.learn_topics(index);
    }
    Ok(bag)
}

/// Whether a path is a bag, by its first bytes; a folder with files of a bag is one too.
///
/// # Errors
/// When it cannot be read, or is a bag that is not supported.
pub fn is_bag(path: &Path) -> Result<bool, BagError> {
    if path.is_dir() {
        return parts::find(path).map(|_| true);
    }
    match packed::format(path) {
        Err(BagError::NotABag { .. }) => Ok(false),
        format => format.map(|_| true),
    }
}

impl Bag {
    /// The topics of all files.
    pub fn topics(&self) -> &[Arc<Topic>] {
        &self.topics
    }

    /// The topic with this name: an absolute name matches exactly, a relative one in any namespace.
    ///
    /// # Errors
    /// When no topic or several topics match.
    pub fn topic(&self, name: &str) -> Result<&Arc<Topic>, BagError> {
        let names = |topics: &[&Arc<Topic>]| {
            let names: Vec<&str> = topics.iter().map(|topic| topic.name.as_str()).collect();
            names.join(", ")
        };
        let found: Vec<_> = self.topics.iter().filter(|topic| topic.is(name)).collect();
        match found[..] {
            [topic] => Ok(topic),
            [] => Err(BagError::NoTopic {
                name: name.to_owned(),
                present: names(&self.topics.iter().collect::<Vec<_>>()),
            }),
            _ => Err(BagError::AmbiguousTopic {
                name: name.to_owned(),
                present: names(&found),
            }),
        }
    }

    /// The topic with this name, as [`Bag::topic`] finds it, among those whose messages can be read as a type. Another
    /// program may use the name for another type too.
    ///
    /// # Errors
    /// When no topic or several topics match, or the one that does has another type or encoding.
    pub fn topic_of_type(&self, name: &str, expected: &'static str) -> Result<&Arc<Topic>, BagError> {
        let named = || self.topics.iter().filter(|topic| topic.is(name));
        let mut fitting = named().filter(|topic| topic.check(expected).is_ok());
        let Some(first) = fitting.next() else {
            return match named().next() {
                Some(other) => other.check(expected).and_then(|()| self.topic(name)),
                None => self.topic(name),
            };
        };
        // Parts may describe one topic differently, such as with other qualities of service.
        if fitting.all(|other| other.name == first.name) {
            Ok(first)
        } else {
            self.topic(name)
        }
    }

    /// Limits the messages to the topics that `wanted` selects. The caller does this before it reads the first message.
    pub fn select(&mut self, wanted: impl Fn(&Topic) -> bool) {
        for source in &mut self.sources {
            let flags: Vec<bool> = source.stream.topics().iter().map(|topic| wanted(topic)).collect();
            match &mut source.stream {
                Stream::Mcap(stream) => stream.set_wanted(flags),
                Stream::Sqlite(stream) => stream.set_wanted(flags),
            }
        }
    }

    /// Continues with the first message at or after `time` (ns since the clock's epoch), forward or back. This
    /// decompresses only the chunks that hold it.
    pub fn seek(&mut self, time: i64) {
        for source in &mut self.sources {
            source.stream.seek(time);
            source.ahead = None;
            source.ended = false;
        }
    }

    /// Number of messages of all topics, if every file states it; for progress bars.
    pub fn message_count(&self) -> Option<u64> {
        self.sources.iter().map(|source| source.stream.messages()).sum()
    }

    /// First and last log time (ns), as the files state them.
    pub fn bounds(&self) -> Option<(i64, i64)> {
        self.sources
            .iter()
            .filter_map(|source| source.stream.bounds())
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// Truncated files, with offset and cause.
    pub fn cuts(&self) -> impl Iterator<Item = &Cut> {
        self.sources.iter().filter_map(|source| match &source.stream {
            Stream::Mcap(stream) => stream.cut(),
            Stream::Sqlite(_) => None,
        })
    }

    /// Differences between the files of the bag and its metadata.yaml.
    pub fn faults(&self) -> &[PartFault] {
        &self.faults
    }

    /// Learns the topics of all files to the end, which decompresses every chunk: a file may describe more than it lists.
    pub(crate) fn describe(&mut self) {
        for index in 0..self.sources.len() {
            if let Some(Source {
                stream: Stream::Mcap(stream),
                ..
            }) = self.sources.get_mut(index)
            {
                stream.describe();
            }
            self.learn_topics(index);
        }
    }

    /// Adds the topics of a file to the bag's topics, unless they are known.
    fn learn_topics(&mut self, index: usize) {
        let Some(source) = self.sources.get_mut(index) else {
            return;
        };
        for topic in &source.stream.topics()[source.topic_of.len()..] {
            let number = match self.topics.iter().position(|known| known == topic) {
                Some(number) => number,
                None => {
                    self.topics.push(Arc::clone(topic));
                    self.topics.len() - 1
                }
            };
            source.topic_of.push(number);
        }
    }
}

impl Iterator for Bag {
    type Item = Result<BagMessage, BagError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut earliest: Option<(i64, usize)> = None;
        for (index, source) in self.sources.iter_mut().enumerate() {
            if source.ahead.is_none() && !source.ended {
                match source.stream.next() {
                    Some(Ok(message)) => source.ahead = Some(message),
                    Some(Err(error)) => return Some(Err(error)),
                    None => source.ended = true,
                }
            }
            if let Some(message) = &source.ahead
                && earliest.is_none_or(|(time, _)| message.log_time < time)
            {
                earliest = Some((message.log_time, index));
            }
        }
        let (_, index) = earliest?;
        self.learn_topics(index);
        let source = self.sources.get_mut(index)?;
        let message = source.ahead.take()?;
        let topic_index = *source.topic_of.get(message.topic)?;
        Some(Ok(BagMessage {
            topic: Arc::clone(self.topics.get(topic_index)?),
            topic_index,
            log_time: message.log_time,
            publish_time: message.publish_time,
            data: message.data,
            sequence: message.sequence,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_its_feature_an_sqlite_bag_is_refused_with_the_remedy() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(&file, b"SQLite format 3\0").unwrap();
        let error = open(file.path()).err().unwrap();
        assert!(matches!(error, BagError::NoSqlite { .. }), "{error:?}");
        let text = error.to_string();
        assert!(
            text.contains("--features sqlite") && text.contains("ros2 bag convert"),
            "{text}"
        );
    }
}
