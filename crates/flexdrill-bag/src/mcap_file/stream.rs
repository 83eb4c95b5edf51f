//! The messages of one MCAP file in time order.
//!
//! Chunks may overlap in time. They are decompressed in the order of their earliest messages, into a heap. The heap's
//! first message is due as soon as the next chunk begins after it, so that memory holds only the overlapping chunks.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::records::op;

use super::channels::{Added, Channels, NoTopic, Place};
use super::records::{MESSAGE_HEAD, message_header, records};
use super::scan::{self, Kind, Segment};
use crate::raw::RawMessage;
use crate::{BagError, Cut, Topic};

/// Largest size of the heap at which another chunk is decompressed (bytes); the chunks of one recording overlap by a
/// few megabytes.
const MOST_WAITING: usize = 256 << 20;

/// Why a message record is left out.
#[derive(Debug, thiserror::Error)]
enum LeftOut {
    #[error("damaged message records")]
    Damaged,
    #[error(transparent)]
    NoTopic(#[from] NoTopic),
    #[error(
        "messages of {topic} with log times beyond {} ns, the first {log_time} ns: no recorder writes times after the \
         year 2262; correct the recorder's clock or its writer",
        i64::MAX
    )]
    Time { topic: String, log_time: u64 },
}

/// An open MCAP file.
pub(crate) struct McapStream {
    path: PathBuf,
    file: File,
    channels: Channels,
    /// Sorted by start, then by offset.
    segments: Vec<Segment>,
    next_segment: usize,
    /// Messages of the chunks read so far.
    waiting: BinaryHeap<Reverse<RawMessage>>,
    /// Size of these messages (bytes).
    waiting_bytes: usize,
    /// Defects of the file and of the last segments read, which are reported before their messages.
    problems: VecDeque<BagError>,
    /// The segments in the order of the file.
    in_file: Vec<Segment>,
    /// Number of these whose topics are known.
    described: usize,
    /// No channel id of the file has two topics, so that segments may be skipped unseen.
    ours: bool,
    /// Number of messages read so far, which keeps messages of equal time in the file's order.
    order: u64,
    wanted: Vec<bool>,
    /// Messages before this log time are skipped.
    begin: i64,
    messages: Option<u64>,
    cut: Option<Cut>,
}

impl McapStream {
    /// Opens the file and finds its topics.
    ///
    /// # Errors
    /// When the file cannot be read or is not MCAP.
    pub fn open(path: &Path) -> Result<Self, BagError> {
        Self::read(path, File::open(path).map_err(BagError::io("open", path))?)
    }

    /// Reads `file`; errors name it `path`.
    ///
    /// # Errors
    /// As [`McapStream::open`].
    pub fn read(path: &Path, file: File) -> Result<Self, BagError> {
        let mut scan = scan::scan(path, &file)?;
        let in_file = scan.segments.clone();
        scan.segments.sort_by_key(|segment| (segment.start, segment.offset));
        let damaged = |(offset, problem)| BagError::Damaged {
            path: path.to_owned(),
            offset,
            problem,
        };
        Ok(Self {
            path: path.to_owned(),
            file,
            wanted: vec![true; scan.channels.topics.len()],
            channels: scan.channels,
            segments: scan.segments,
            next_segment: 0,
            waiting: BinaryHeap::new(),
            waiting_bytes: 0,
            problems: scan.problems.into_iter().map(damaged).collect(),
            described: if scan.described { in_file.len() } else { 0 },
            in_file,
            ours: scan.ours,
            order: 0,
            begin: i64::MIN,
            messages: scan.messages,
            cut: scan.cut.map(|(offset, reason)| Cut {
                path: path.to_owned(),
                offset,
                reason,
            }),
        })
    }

    pub fn topics(&self) -> &[Arc<Topic>] {
        &self.channels.topics
    }

    pub fn set_wanted(&mut self, wanted: Vec<bool>) {
        self.wanted = wanted;
    }

    pub fn messages(&self) -> Option<u64> {
        self.messages
    }

    pub fn cut(&self) -> Option<&Cut> {
        self.cut.as_ref()
    }

    /// First and last log time (ns). Chunks without messages have 0 for both and are ignored, as are times that no
    /// message can have.
    pub fn bounds(&self) -> Option<(i64, i64)> {
        let filled = self.segments.iter().filter(|segment| segment.end != 0);
        let possible = filled.filter_map(|segment| {
            let start = i64::try_from(segment.start).ok()?;
            Some((start, i64::try_from(segment.end).unwrap_or(start)))
        });
        possible.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// Learns the topics of all chunks, which it decompresses for that.
    pub fn describe(&mut self) {
        self.learn_before(u64::MAX);
    }

    /// Learns the topics of the segments before an offset (bytes) that were not read yet: a channel id may have got
    /// another topic there.
    fn learn_before(&mut self, offset: u64) {
        while let Some(segment) = self
            .in_file
            .get(self.described)
            .filter(|segment| segment.offset < offset)
        {
            let segment = *segment;
            self.described += 1;
            // The first pass has seen the records outside chunks. Defects are reported when the messages are read.
            let content = match segment.kind {
                Kind::Loose => continue,
                Kind::Chunk | Kind::CutChunk => scan::load(&self.path, &self.file, &segment),
            };
            let content = content.map(|(content, _)| content).unwrap_or_default();
            for (number, (opcode, body)) in records(&content).flatten().enumerate() {
                if matches!(opcode, op::SCHEMA | op::CHANNEL) {
                    self.learn(opcode, body, (segment.offset, number));
                }
            }
        }
    }

    /// Adds a schema or channel record; returns false if it is damaged.
    fn learn(&mut self, opcode: u8, body: &[u8], at: Place) -> bool {
        let added = self.channels.add(opcode, body, at);
        self.wanted.resize(self.channels.topics.len(), true);
        let is_damaged = added == Added::Damaged;
        if let Added::Contradicts(text) = added {
            self.report(at.0, text);
        }
        !is_damaged
    }

    fn report(&mut self, offset: u64, problem: String) {
        self.problems.push_back(BagError::Damaged {
            path: self.path.clone(),
            offset,
            problem,
        });
    }

    /// Continues with the first message at or after `time` (ns since the epoch).
    pub fn seek(&mut self, time: i64) {
        self.waiting.clear();
        self.waiting_bytes = 0;
        self.problems.clear();
        self.next_segment = 0;
        self.begin = time;
    }

    /// The next message or the defect of a part; after a defect, the next part follows.
    pub fn next(&mut self) -> Option<Result<RawMessage, BagError>> {
        loop {
            if let Some(problem) = self.problems.pop_front() {
                return Some(Err(problem));
            }
            let Some(segment) = self.segments.get(self.next_segment).copied() else {
                return self.pop().map(Ok);
            };
            let first = self.waiting.peek().map(|Reverse(message)| message.log_time as u64);
            if first.is_some_and(|time| time < segment.start) {
                return self.pop().map(Ok);
            }
            self.next_segment += 1;
            if self.waiting_bytes > MOST_WAITING {
                return Some(Err(self.crowded(&segment)));
            }
            // A chunk without messages has 0 for its end, and nothing to decompress.
            if i64::try_from(segment.end).is_ok_and(|end| end < self.begin) {
                continue;
            }
            if !self.ours {
                self.learn_before(segment.offset);
            }
            if let Err(error) = self.unpack(&segment) {
                return Some(Err(error));
            }
        }
    }

    fn pop(&mut self) -> Option<RawMessage> {
        let Reverse(message) = self.waiting.pop()?;
        self.waiting_bytes = self.waiting_bytes.saturating_sub(message.data.len());
        Some(message)
    }

    /// The error for a chunk that is skipped because the heap is full.
    fn crowded(&self, segment: &Segment) -> BagError {
        BagError::Damaged {
            path: self.path.clone(),
            offset: segment.offset,
            problem: format!(
                "{} bytes of messages of overlapping chunks are in memory, at most {MOST_WAITING} are accepted: the chunk is \
                 skipped",
                self.waiting_bytes
            ),
        }
    }

    fn unpack(&mut self, segment: &Segment) -> Result<(), BagError> {
        let (content, mut problem) = scan::load(&self.path, &self.file, segment)?;
        // In the file's order this is the next segment, and its topics are learnt here.
        if self.in_file.get(self.described).map(|next| next.offset) == Some(segment.offset) {
            self.described += 1;
        }
        let mut left_out: Option<(LeftOut, u64)> = None;
        for (number, record) in records(&content).enumerate() {
            let Some((opcode, body)) = record else {
                // A truncated chunk ends within a record.
                if segment.kind != Kind::CutChunk {
                    problem.get_or_insert("the chunk ends within a record".to_owned());
                }
                break;
            };
            let at = (segment.offset, number);
            match opcode {
                op::SCHEMA | op::CHANNEL => {
                    let is_whole = self.learn(opcode, body, at);
                    if !is_whole {
                        problem.get_or_insert("a schema or channel record is damaged".to_owned());
                    }
                }
                op::MESSAGE => {
                    if let Err(why) = self.queue(body, at) {
                        left_out.get_or_insert((why, 0)).1 += 1;
                    }
                }
                _ => {}
            }
        }
        if let Some((why, count)) = left_out {
            // The first cause names the segment; others in it are mostly the same.
            self.report(segment.offset, format!("left out here, {count} in number: {why}"));
        }
        if let Some(problem) = problem {
            self.report(segment.offset, problem);
        }
        Ok(())
    }

    fn queue(&mut self, body: &[u8], at: Place) -> Result<(), LeftOut> {
        let message = message_header(body).ok_or(LeftOut::Damaged)?;
        let topic = self.channels.topic(message.channel_id, at)?;
        if self.wanted.get(topic) != Some(&true) {
            return Ok(());
        }
        // A time that does not fit is no time: the nearest one that fits would put all such messages at one instant.
        let Ok(log_time) = i64::try_from(message.log_time) else {
            return Err(LeftOut::Time {
                topic: self
                    .channels
                    .topics
                    .get(topic)
                    .map(|topic| topic.name.clone())
                    .unwrap_or_default(),
                log_time: message.log_time,
            });
        };
        if log_time >= self.begin {
            self.waiting_bytes += body.len() - MESSAGE_HEAD;
            self.waiting.push(Reverse(RawMessage {
                log_time,
                order: self.order,
                publish_time: i64::try_from(message.publish_time).unwrap_or(log_time),
                topic,
                sequence: Some(message.sequence),
                data: body[MESSAGE_HEAD..].to_vec(),
            }));
            self.order += 1;
        }
        Ok(())
    }
}
