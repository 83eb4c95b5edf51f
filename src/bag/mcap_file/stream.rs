//! Messages of one MCAP file in time order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::records::op;

use super::channels::Channels;
use super::records::{MESSAGE_HEAD, message_header, records};
use super::scan::{self, Kind, Segment};
use crate::bag::raw::RawMessage;
use crate::bag::{BagError, Cut, Topic};

/// Bytes of messages beyond which no further chunk is unpacked while they wait (bytes): chunks of one recording overlap in
/// time by some megabytes.
const MOST_WAITING: usize = 256 << 20;

/// What is wrong with a record of a message.
#[derive(Debug, thiserror::Error)]
enum RecordProblem {
    #[error("a message record is damaged")]
    Message,
    #[error("a message is on channel {0}, which is not described")]
    UnknownChannel(u16),
}

/// An open MCAP file. Chunks are unpacked when their time comes; messages wait until no chunk can bring an earlier one.
pub(in crate::bag) struct McapStream {
    path: PathBuf,
    file: File,
    channels: Channels,
    /// Sorted by start, then by place.
    segments: Vec<Segment>,
    next_segment: usize,
    waiting: BinaryHeap<Reverse<RawMessage>>,
    /// Bytes of these messages.
    waiting_bytes: usize,
    /// Problem of the segment unpacked last, to be reported before its messages.
    problem: Option<BagError>,
    /// Messages unpacked so far, which keeps those of equal time in the file's order.
    order: u64,
    wanted: Vec<bool>,
    /// Messages before this log time are left out.
    begin: i64,
    messages: Option<u64>,
    cut: Option<Cut>,
}

impl McapStream {
    /// Opens it and finds its topics.
    ///
    /// # Errors
    /// When it cannot be read or is not MCAP.
    pub fn open(path: &Path) -> Result<Self, BagError> {
        let file = File::open(path).map_err(BagError::io("open", path))?;
        let mut scan = scan::scan(path, &file)?;
        scan.segments.sort_by_key(|segment| (segment.start, segment.offset));
        Ok(Self {
            path: path.to_owned(),
            file,
            wanted: vec![true; scan.channels.topics.len()],
            channels: scan.channels,
            segments: scan.segments,
            next_segment: 0,
            waiting: BinaryHeap::new(),
            waiting_bytes: 0,
            problem: None,
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

    /// First and last log time; chunks without messages have zero for both and do not count.
    pub fn bounds(&self) -> Option<(u64, u64)> {
        let filled = || self.segments.iter().filter(|segment| segment.end != 0);
        let start = filled().map(|segment| segment.start).min()?;
        let end = filled().map(|segment| segment.end).max()?;
        Some((start, end))
    }

    /// Goes to the first message of `time` or later (ns since the epoch).
    pub fn seek(&mut self, time: i64) {
        self.waiting.clear();
        self.waiting_bytes = 0;
        self.problem = None;
        self.next_segment = 0;
        self.begin = time;
    }

    /// The next message, or what is wrong with a part of the file; after that, the parts that follow.
    pub fn next(&mut self) -> Option<Result<RawMessage, BagError>> {
        loop {
            if let Some(problem) = self.problem.take() {
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
            // A chunk without messages has zero for its end, and nothing to unpack.
            if i64::try_from(segment.end).is_ok_and(|end| end < self.begin) {
                continue;
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

    /// A chunk that is left out, since too many messages wait already for one that may come before them.
    fn crowded(&self, segment: &Segment) -> BagError {
        BagError::Damaged {
            path: self.path.clone(),
            offset: segment.offset,
            problem: format!(
                "{} bytes of messages of other chunks wait to be put in order with this one, and at most {MOST_WAITING} \
                 may: the chunk is left out",
                self.waiting_bytes
            ),
        }
    }

    fn unpack(&mut self, segment: &Segment) -> Result<(), BagError> {
        let (content, mut problem) = scan::load(&self.path, &self.file, segment)?;
        for record in records(&content) {
            let Some((opcode, body)) = record else {
                // The last record of a cut chunk is cut too.
                if segment.kind != Kind::CutChunk {
                    problem.get_or_insert("the chunk ends within a record".to_owned());
                }
                break;
            };
            match opcode {
                op::SCHEMA | op::CHANNEL => {
                    if !self.channels.add(opcode, body) {
                        problem.get_or_insert("a schema or channel record is damaged".to_owned());
                    }
                    self.wanted.resize(self.channels.topics.len(), true);
                }
                op::MESSAGE => {
                    if let Err(wrong) = self.queue(body) {
                        problem.get_or_insert_with(|| wrong.to_string());
                    }
                }
                _ => {}
            }
        }
        self.problem = problem.map(|problem| BagError::Damaged {
            path: self.path.clone(),
            offset: segment.offset,
            problem,
        });
        Ok(())
    }

    fn queue(&mut self, body: &[u8]) -> Result<(), RecordProblem> {
        let message = message_header(body).ok_or(RecordProblem::Message)?;
        let topic = self
            .channels
            .topic(message.channel_id)
            .ok_or(RecordProblem::UnknownChannel(message.channel_id))?;
        let log_time = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        if self.wanted.get(topic) == Some(&true) && log_time >= self.begin {
            self.waiting_bytes += body.len() - MESSAGE_HEAD;
            self.waiting.push(Reverse(RawMessage {
                log_time,
                order: self.order,
                publish_time: i64::try_from(message.publish_time).unwrap_or(i64::MAX),
                topic,
                sequence: Some(message.sequence),
                data: body[MESSAGE_HEAD..].to_vec(),
            }));
            self.order += 1;
        }
        Ok(())
    }
}
