//! First pass over an MCAP file: finds the parts with messages and their times, the topics, and the end of the readable
//! part.
//!
//! The pass reads the heads of chunks and skips their bodies, so that it costs little even in a large file. It does not
//! use the file's own index, because a truncated file has none. Only when the file has no summary, the summary's
//! channels are incomplete, or a part is damaged, a second pass decompresses every chunk.
//!
//! Where no record can be, the pass searches for the next chunk ([`search`](super::search)).

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::os::unix::fs::FileExt as _;
use std::path::Path;

use mcap::records::{Record, op};
use mcap::{MAGIC, parse_record};

use super::channels::{Added, Channels};
use super::records::{ChunkHead, Fields, MESSAGE_HEAD, message_header, records};
use super::search::{CHUNK_HEAD, chunk_summary, is_record, next_chunk};
use super::{RECORD_HEAD, chunk};
use crate::BagError;

/// Largest schema or channel record that is read (bytes).
const LARGEST_RECORD: u64 = 16 << 20;
/// Largest run of messages outside chunks that is read together (bytes).
const LARGEST_RUN: u64 = 1 << 20;
/// Size of the body of an end record (bytes).
const FOOTER_SIZE: u64 = 20;

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
    /// Offset and text of every part that was passed over, and of every contradiction.
    pub problems: Vec<(u64, String)>,
    /// The topics of all chunks are known.
    pub described: bool,
    /// flexdrill wrote the file: no channel id has two topics.
    pub ours: bool,
}

/// How the pass continues after a record.
enum Step {
    /// With the record at this offset.
    Next(u64),
    /// The file is complete.
    End,
    /// No record is where one should be.
    Broken(&'static str),
}

/// The pass over a file.
struct Pass<'a> {
    path: &'a Path,
    file: &'a File,
    reader: BufReader<&'a File>,
    length: u64,
    scan: Scan,
    /// End of the last chunk whose head agrees with its record (bytes): a search for the next chunk begins here.
    trusted: u64,
    /// Sum of the sizes that the chunks so far claim to decompress to.
    unpacked: u64,
    /// Number of channels in the whole file, from its statistics.
    channel_count: usize,
}

/// Walks over the file's records. Behind a damaged part it continues with the next chunk.
///
/// # Errors
/// When the file cannot be read, is not MCAP, or claims to decompress to more than a recording of its size can.
pub(super) fn scan(path: &Path, file: &File) -> Result<Scan, BagError> {
    let read_error = || BagError::io("read", path);
    let length = file.metadata().map_err(read_error())?.len();
    let mut reader = BufReader::with_capacity(1 << 16, file);
    reader.rewind().map_err(read_error())?;
    // The magic is all that distinguishes a bag from any other file; everything after it may be damaged.
    let mut magic = [0; MAGIC.len()];
    let is_mcap = reader.read_exact(&mut magic).is_ok() && magic == *MAGIC;
    if !is_mcap {
        return Err(BagError::NotABag {
            path: path.to_owned(),
            problem: "it does not begin as an MCAP file".to_owned(),
        });
    }
    let scan = Scan {
        segments: Vec::new(),
        channels: Channels::default(),
        messages: None,
        cut: None,
        problems: Vec::new(),
        described: false,
        ours: false,
    };
    let mut pass = Pass {
        path,
        file,
        reader,
        length,
        scan,
        trusted: MAGIC.len() as u64,
        unpacked: 0,
        channel_count: 0,
    };
    let complete = pass.walk()?;
    let (mut scan, count) = (pass.scan, pass.channel_count);
    // A file without its summary, or with a part of it, has the missing topics within its chunks.
    let damaged = !scan.problems.is_empty();
    if !complete || damaged || scan.channels.count() < count || scan.channels.count() == 0 {
        walk_chunks(path, file, &mut scan)?;
    }
    Ok(scan)
}

impl Pass<'_> {
    /// Walks to the end of the readable part; returns whether that is the file's end record.
    fn walk(&mut self) -> Result<bool, BagError> {
        // The position is counted here and not asked of the reader, which reads ahead.
        let mut position = MAGIC.len() as u64;
        loop {
            let why = match self.step(position)? {
                Step::Next(next) => {
                    position = next;
                    continue;
                }
                Step::End => return Ok(true),
                Step::Broken(why) => why,
            };
            // The record before may have a wrong length, so the search begins behind the last one that is certain.
            let Some(found) = next_chunk(self.file, self.trusted, self.length).map_err(self.read_error())? else {
                // A recorder that is killed leaves a file without an end. What is
                // before the cut is a normal recording, so this is no error.
                self.scan.cut = Some((position, why.to_owned()));
                return Ok(false);
            };
            self.forget(found);
            self.note(
                position,
                format!("{why}; reading continues with the chunk at byte {found}"),
            );
            self.reader.seek(SeekFrom::Start(found)).map_err(self.read_error())?;
            position = found;
        }
    }

    fn read_error(&self) -> impl FnOnce(std::io::Error) -> BagError {
        BagError::io("read", self.path)
    }

    fn note(&mut self, offset: u64, text: String) {
        self.scan.problems.push((offset, text));
    }

    /// Removes what was found from an offset on, to which a record with a wrong length led, and a chunk that seemed to be
    /// cut: without its end nothing proves its content.
    fn forget(&mut self, offset: u64) {
        self.scan.segments.pop_if(|last| last.kind == Kind::CutChunk);
        while self.scan.segments.pop_if(|last| last.offset >= offset).is_some() {}
        if let Some(last) = self.scan.segments.last_mut()
            && last.kind == Kind::Loose
        {
            last.length = last.length.min(offset - last.offset);
        }
    }

    /// Reads the record at `position`, where the reader stands.
    fn step(&mut self, position: u64) -> Result<Step, BagError> {
        if position + RECORD_HEAD > self.length {
            return Ok(Step::Broken(if position == self.length {
                "the file has no end record: its writer was stopped"
            } else {
                "the file ends within a record"
            }));
        }
        let mut head = [0; RECORD_HEAD as usize];
        self.reader.read_exact(&mut head).map_err(self.read_error())?;
        let opcode = head[0];
        let size = Fields(&head[1..]).u64().unwrap_or(u64::MAX);
        let body = position + RECORD_HEAD;
        // Opcode 0 is not assigned: zeros are what a file has where the
        // system allocated space and lost power before the data.
        if opcode == 0 {
            return Ok(Step::Broken("no MCAP record begins here: the file is damaged"));
        }
        if opcode == op::CHUNK {
            return self.chunk(position, size);
        }
        if size > self.length - body {
            return Ok(Step::Broken("the file ends within a record"));
        }
        // Bytes of the body that the arms below have read.
        let mut used = 0;
        match opcode {
            op::FOOTER => return self.footer(body, size),
            // Outside of chunks only the time is needed here; the run of messages is read when its turn comes.
            op::MESSAGE => {
                used = size.min(MESSAGE_HEAD as u64);
                let bytes = self.read(used)?;
                if let Some(message) = message_header(&bytes) {
                    add_loose(&mut self.scan.segments, position, RECORD_HEAD + size, message.log_time);
                }
            }
            op::HEADER if size <= LARGEST_RECORD => {
                used = size;
                let bytes = self.read(used)?;
                self.scan.ours = is_ours(&bytes);
            }
            // A larger record of these kinds is no topic of a recording, and would be read into memory.
            op::SCHEMA | op::CHANNEL | op::STATISTICS if size <= LARGEST_RECORD => {
                used = size;
                let bytes = self.read(used)?;
                if opcode != op::STATISTICS {
                    if let Added::Contradicts(text) = self.scan.channels.add(opcode, &bytes, (position, 0)) {
                        self.note(position, text);
                    }
                } else if let Ok(Record::Statistics(statistics)) = parse_record(opcode, &bytes) {
                    // The statistics come at the end, and say how many channels the summary must have.
                    self.scan.messages = Some(statistics.message_count);
                    self.channel_count = statistics.channel_count as usize;
                }
            }
            // All other records, those of later versions among them, are skipped by their length, as the format asks.
            _ => {}
        }
        self.reader
            .seek_relative((size - used) as i64)
            .map_err(self.read_error())?;
        Ok(Step::Next(body + size))
    }

    fn read(&mut self, count: u64) -> Result<Vec<u8>, BagError> {
        let mut bytes = vec![0; count as usize];
        self.reader.read_exact(&mut bytes).map_err(self.read_error())?;
        Ok(bytes)
    }

    /// The chunk record at `position`, whose head says `size`; the reader stands at its body.
    fn chunk(&mut self, position: u64, size: u64) -> Result<Step, BagError> {
        let body = position + RECORD_HEAD;
        let available = self.length - body;
        let head = self.read(available.min(CHUNK_HEAD))?;
        let (start, end, unpacked) = chunk_summary(&head).unwrap_or_default();
        // Both the record and the chunk's head give its length. Where they differ, that one counts behind which a record
        // follows.
        let stated = ChunkHead::parse(&head).map(|(chunk, rest)| {
            let before = (head.len() - rest.len()) as u64;
            before.saturating_add(chunk.compressed_size)
        });
        let follows = |length: u64| length <= available && is_record(self.file, body + length, self.length);
        let length = match stated {
            Some(stated) if stated == size && size <= available => {
                self.trusted = body + size;
                size
            }
            _ if follows(size) => size,
            Some(stated) if follows(stated) => {
                self.trusted = body + stated;
                self.note(
                    position,
                    format!("the record of a chunk says {size} bytes, and the chunk says {stated}, which is right"),
                );
                stated
            }
            _ => {
                // The cut is mostly within a chunk, because chunks are the
                // largest records. Its beginning can be decompressed.
                if size > available {
                    self.scan.segments.push(Segment {
                        offset: body,
                        length: available,
                        start,
                        end,
                        kind: Kind::CutChunk,
                    });
                }
                return Ok(Step::Broken("the file ends within a record"));
            }
        };
        // The sum is bounded too: many chunks, each within its own bound, could otherwise expand without end. A chunk beyond
        // its own bound is damaged, and is never decompressed.
        if unpacked <= chunk::largest_unpacked(length) {
            self.unpacked = self.unpacked.saturating_add(unpacked);
        }
        let most = chunk::most_in_file(self.length);
        if self.unpacked > most {
            return Err(BagError::Damaged {
                path: self.path.to_owned(),
                offset: position,
                problem: format!(
                    "the chunks up to here claim to decompress to {} bytes; at most {most} are accepted in a file of {} bytes: \
                     no recording compresses so well",
                    self.unpacked, self.length
                ),
            });
        }
        self.scan.segments.push(Segment {
            offset: body,
            length,
            start,
            end,
            kind: Kind::Chunk,
        });
        self.reader
            .seek_relative(length as i64 - head.len() as i64)
            .map_err(self.read_error())?;
        Ok(Step::Next(body + length))
    }

    /// The end record, which is the end only where nothing follows.
    fn footer(&mut self, body: u64, size: u64) -> Result<Step, BagError> {
        if size != FOOTER_SIZE {
            return Ok(Step::Broken("the end record is damaged"));
        }
        let end = body + size + MAGIC.len() as u64;
        if end >= self.length {
            return Ok(Step::End);
        }
        let mut magic = [0; MAGIC.len()];
        let again = self.file.read_exact_at(&mut magic, end).is_ok() && magic == *MAGIC;
        let next = if again {
            Some(end + MAGIC.len() as u64)
        } else {
            next_chunk(self.file, end, self.length).map_err(self.read_error())?
        };
        let Some(next) = next else { return Ok(Step::End) };
        self.note(
            end,
            "the file continues behind its end, as after `cat A B > C`; what follows is read too".to_owned(),
        );
        self.trusted = next;
        self.reader.seek(SeekFrom::Start(next)).map_err(self.read_error())?;
        Ok(Step::Next(next))
    }
}

/// Whether the header record of a file names flexdrill as its library. `mcap` would allocate the claimed length of a text
/// before it looks how many bytes the record has.
fn is_ours(header: &[u8]) -> bool {
    let mut fields = Fields(header);
    let _profile = fields.counted();
    fields
        .counted()
        .is_some_and(|library| library.starts_with(b"flexdrill "))
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
        for (number, (opcode, body)) in records(&content).flatten().enumerate() {
            match opcode {
                op::SCHEMA | op::CHANNEL => {
                    if let Added::Contradicts(text) = scan.channels.add(opcode, body, (segment.offset, number)) {
                        scan.problems.push((segment.offset, text));
                    }
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
    scan.described = true;
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
