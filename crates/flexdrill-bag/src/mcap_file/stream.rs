//! The messages of one MCAP file in time order.
//!
//! Chunks may overlap in time. They are decompressed in the order of their earliest messages, into a heap. The heap's
//! first message is due as soon as the next chunk begins after it, so that memory holds only the overlapping chunks.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mcap::records::op;

use super::channels::Channels;
use super::records::{MESSAGE_HEAD, message_header, records};
use super::scan::{self, Kind, Segment};
use crate::raw::RawMessage;
use crate::{BagError, Cut, Topic};

/// Largest size of the heap at which another chunk is decompressed (bytes); the chunks of one recording overlap by a
/// few megabytes.
const MOST_WAITING: usize = 256 << 20;

/// Defects of a message record.
#[derive(Debug, thiserror::Error)]
enum RecordProblem {
    #[error("a message record is damaged")]
    Message,
    #[error("a message is on channel {0}, which the file does not describe")]
    UnknownChannel(u16),
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
    /// Defect of the last segment read, which is reported before its messages.
    problem: Option<BagError>,
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

    /// First and last log time. Chunks without messages have 0 for both and are ignored.
    pub fn bounds(&self) -> Option<(u64, u64)> {
        let filled = || self.segments.iter().filter(|segment| segment.end != 0);
        let start = filled().map(|segment| segment.start).min()?;
        let end = filled().map(|segment| segment.end).max()?;
        Some((start, end))
    }

    /// Continues with the first message at or after `time` (ns since the epoch).
    pub fn seek(&mut self, time: i64) {
        self.waiting.clear();
        self.waiting_bytes = 0;
        self.problem = None;
        self.next_segment = 0;
        self.begin = time;
    }

    /// The next message or the defect of a part; after a defect, the next part follows.
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
            // A chunk without messages has 0 for its end, and nothing to decompress.
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
        for record in records(&content) {
            let Some((opcode, body)) = record else {
                // A truncated chunk ends within a record.
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
