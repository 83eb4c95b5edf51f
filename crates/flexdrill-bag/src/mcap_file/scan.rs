//! First pass over an MCAP file: finds the parts with messages and their times, the topics, and the end of the readable
//! part.
//!
//! The pass reads the heads of chunks and skips their bodies, so that it costs little even in a large file. It does not
//! use the file's own index, because a truncated file has none. Only when the file has no summary, or the summary's
//! channels are incomplete, a second pass decompresses every chunk.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use mcap::records::{Record, op};
use mcap::{MAGIC, parse_record};

use super::channels::Channels;
use super::records::{Fields, MESSAGE_HEAD, message_header, records};
use super::{RECORD_HEAD, chunk};
use crate::BagError;

/// Bytes read at the start of a chunk's body: its head, with any name of a compression.
const CHUNK_HEAD: u64 = 256;
/// Largest schema or channel record that is read (bytes).
const LARGEST_RECORD: u64 = 16 << 20;
/// Largest run of messages outside chunks that is read together (bytes).
const LARGEST_RUN: u64 = 1 << 20;

/// A part of the file that holds messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    /// Offset of a chunk's body, or of the first record of loose messages.
    pub offset: u64,
    pub length: u64,
    /// Earliest log time (ns), as the file states it.
    pub start: u64,
    /// Latest log time (ns), as the file states it.
    pub end: u64,
    pub kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A whole chunk.
    Chunk,
    /// A truncated chunk at the file's end.
    CutChunk,
    /// Records outside chunks.
    Loose,
}

/// Result of the first pass.
pub(super) struct Scan {
    pub segments: Vec<Segment>,
    pub channels: Channels,
    /// Number of messages, if the file states it.
    pub messages: Option<u64>,
    /// Offset and cause, if the readable part ends before the file's end record.
    pub cut: Option<(u64, String)>,
}

/// Walks over the file's records.
///
/// # Errors
/// When the file cannot be read, is not MCAP, or claims to decompress to more than a recording of its size can.
pub(super) fn scan(path: &Path, file: &File) -> Result<Scan, BagError> {
    let read_error = || BagError::io("read", path);
    let length = file.metadata().map_err(read_error())?.len();
    let mut reader = BufReader::with_capacity(1 << 16, file);
    // The magic is all that distinguishes a bag from any other file; everything after it may be damaged.
    let mut magic = [0; MAGIC.len()];
    let is_mcap = reader.read_exact(&mut magic).is_ok() && magic == *MAGIC;
    if !is_mcap {
        return Err(BagError::NotABag {
            path: path.to_owned(),
            problem: "it does not begin as an MCAP file".to_owned(),
        });
    }
    let mut scan = Scan {
        segments: Vec::new(),
        channels: Channels::default(),
        messages: None,
        cut: None,
    };
    // The position is counted here and not asked of the reader, which reads ahead.
    let mut position = MAGIC.len() as u64;
    let most_in_file = chunk::most_in_file(length);
    // Sum of the sizes that the chunks so far claim to decompress to.
    let mut unpacked = 0_u64;
    // Number of channels in the whole file, from its statistics.
    let mut channel_count = 0;
    let complete = loop {
        // A recorder that is killed leaves a file without an end. What is
        // before the cut is a normal recording, so this is no error.
        if position + RECORD_HEAD > length {
            let why = if position == length {
                "the file has no end record: its writer was stopped"
            } else {
                "the file ends within a record"
            };
            scan.cut = Some((position, why.to_owned()));
            break false;
        }
        let mut head = [0; RECORD_HEAD as usize];
        reader.read_exact(&mut head).map_err(read_error())?;
        let opcode = head[0];
        let size = Fields(&head[1..]).u64().unwrap_or(u64::MAX);
        let body = position + RECORD_HEAD;
        // Opcode 0 is not assigned: zeros are what a file has where the
        // system allocated space and lost power before the data.
        if opcode == 0 {
            scan.cut = Some((position, "no MCAP record begins here: the file is damaged".to_owned()));
            break false;
        }
        let available = length - body;
        if size > available {
            scan.cut = Some((position, "the file ends within a record".to_owned()));
            // The cut is mostly within a chunk, because chunks are the
            // largest records. Its beginning can be decompressed.
            if opcode == op::CHUNK {
                let head = chunk_summary(&mut reader, available).map_err(read_error())?;
                let (start, end, _) = head.unwrap_or_default();
                scan.segments.push(Segment {
                    offset: body,
                    length: available,
                    start,
                    end,
                    kind: Kind::CutChunk,
                });
            }
            break false;
        }
        // Bytes of the body that the arms below have read.
        let mut used = 0;
        match opcode {
            op::FOOTER => break true,
            op::CHUNK => {
                used = size.min(CHUNK_HEAD);
                let head = chunk_summary(&mut reader, size).map_err(read_error())?;
                let (start, end, size_unpacked) = head.unwrap_or_default();
                // The sum is bounded too: many chunks, each within its own bound, could otherwise expand without end.
                unpacked = unpacked.saturating_add(size_unpacked);
                if unpacked > most_in_file {
                    return Err(BagError::Damaged {
                        path: path.to_owned(),
                        offset: position,
                        problem: format!(
                            "the chunks up to here claim to decompress to {unpacked} bytes; at most {most_in_file} are accepted in \
                             a file of {length} bytes: no recording compresses so well"
                        ),
                    });
                }
                scan.segments.push(Segment {
                    offset: body,
                    length: size,
                    start,
                    end,
                    kind: Kind::Chunk,
                });
            }
            // Outside of chunks only the time is needed here; the run of messages is read when its turn comes.
            op::MESSAGE => {
                used = size.min(MESSAGE_HEAD as u64);
                let mut bytes = vec![0; used as usize];
                reader.read_exact(&mut bytes).map_err(read_error())?;
                if let Some(message) = message_header(&bytes) {
                    add_loose(&mut scan.segments, position, RECORD_HEAD + size, message.log_time);
                }
            }
            // A larger record of these kinds is no topic of a recording, and would be read into memory.
            op::SCHEMA | op::CHANNEL | op::STATISTICS if size <= LARGEST_RECORD => {
                used = size;
                let mut bytes = vec![0; size as usize];
                reader.read_exact(&mut bytes).map_err(read_error())?;
                if opcode == op::STATISTICS {
                    if let Ok(Record::Statistics(statistics)) = parse_record(opcode, &bytes) {
                        // The statistics come at the end, and say how many channels the summary must have.
                        scan.messages = Some(statistics.message_count);
                        channel_count = statistics.channel_count as usize;
                    }
                } else {
                    scan.channels.add(opcode, &bytes);
                }
            }
            // All other records, those of later versions among them, are skipped by their length, as the format asks.
            _ => {}
        }
        reader.seek_relative((size - used) as i64).map_err(read_error())?;
        position = body + size;
    };
    // A file without its summary, or with a part of it, has the missing topics within its chunks.
    if !complete || scan.channels.count() < channel_count || scan.channels.count() == 0 {
        walk_chunks(path, file, &mut scan)?;
    }
    Ok(scan)
}

/// Earliest time, latest time and decompressed size of a chunk, from its head.
fn chunk_summary(reader: &mut impl Read, size: u64) -> std::io::Result<Option<(u64, u64, u64)>> {
    let mut bytes = vec![0; size.min(CHUNK_HEAD) as usize];
    reader.read_exact(&mut bytes)?;
    let mut fields = Fields(&bytes);
    let mut read = || Some((fields.u64()?, fields.u64()?, fields.u64()?));
    Ok(read())
}

/// Adds a message outside chunks to the run before it, or begins a run.
fn add_loose(segments: &mut Vec<Segment>, offset: u64, length: u64, time: u64) {
    if let Some(last) = segments.last_mut() {
        let adjacent = last.kind == Kind::Loose && last.offset + last.length == offset;
        if adjacent && last.length + length <= LARGEST_RUN {
            last.length += length;
            last.start = last.start.min(time);
            last.end = last.end.max(time);
            return;
        }
    }
    segments.push(Segment {
        offset,
        length,
        start: time,
        end: time,
        kind: Kind::Loose,
    });
}

/// Finds the topics and times of a file without a complete summary by decompressing its chunks.
fn walk_chunks(path: &Path, file: &File, scan: &mut Scan) -> Result<(), BagError> {
    let mut messages = 0;
    for segment in &mut scan.segments {
        let (content, _) = load(path, file, segment)?;
        let mut bounds: Option<(u64, u64)> = None;
        for (opcode, body) in records(&content).flatten() {
            match opcode {
                op::SCHEMA | op::CHANNEL => {
                    scan.channels.add(opcode, body);
                }
                op::MESSAGE => {
                    if let Some(message) = message_header(body) {
                        let time = message.log_time;
                        messages += 1;
                        bounds = Some(bounds.map_or((time, time), |(a, b)| (a.min(time), b.max(time))));
                    }
                }
                _ => {}
            }
        }
        // The head of a chunk that its writer had not closed has no times.
        if let Some((start, end)) = bounds {
            (segment.start, segment.end) = (start, end);
        }
    }
    scan.messages = Some(messages);
    Ok(())
}

/// The records of a segment, and its defect if it has one.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn load(path: &Path, mut file: &File, segment: &Segment) -> Result<(Vec<u8>, Option<String>), BagError> {
    let mut bytes = vec![0; usize::try_from(segment.length).unwrap_or(usize::MAX)];
    file.seek(SeekFrom::Start(segment.offset))
        .and_then(|_| file.read_exact(&mut bytes))
        .map_err(BagError::io("read", path))?;
    Ok(match segment.kind {
        Kind::Loose => (bytes, None),
        Kind::Chunk => chunk::unpack(&bytes, true),
        Kind::CutChunk => chunk::unpack(&bytes, false),
    })
}
