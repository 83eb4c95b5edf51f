//! Where a record can begin in a damaged MCAP file: the fields of a chunk's head determine one another, so that other
//! bytes do not pass for one.

use std::fs::File;
use std::os::unix::fs::FileExt as _;

use mcap::records::op;

use super::RECORD_HEAD;
use super::records::{ChunkHead, Fields};

/// Bytes read at the start of a chunk's body: its head, with any name of a compression.
pub(super) const CHUNK_HEAD: u64 = 256;
/// Bytes that a search for a chunk reads at once.
const SEARCHED: usize = 1 << 20;
/// Size of an empty chunk record (bytes).
const SMALLEST_CHUNK: u64 = RECORD_HEAD + 40;

/// Whether a record can begin at an offset, or the file ends there.
pub(super) fn is_record(file: &File, offset: u64, length: u64) -> bool {
    if offset + RECORD_HEAD > length {
        return offset <= length;
    }
    let mut head = [0; RECORD_HEAD as usize];
    if file.read_exact_at(&mut head, offset).is_err() {
        return false;
    }
    let (size, rest) = (
        Fields(&head[1..]).u64().unwrap_or(u64::MAX),
        length - offset - RECORD_HEAD,
    );
    if head[0] != op::CHUNK || size <= rest {
        return head[0] != 0 && size <= rest;
    }
    // The last chunk of a file that was cut is longer than the file.
    let mut chunk = vec![0; rest.min(CHUNK_HEAD) as usize];
    let read = file.read_exact_at(&mut chunk, offset + RECORD_HEAD);
    read.is_ok() && ChunkHead::parse(&chunk).is_none_or(|(chunk, _)| is_known(&chunk.compression))
}

fn is_known(compression: &str) -> bool {
    ["", "zstd", "lz4"].contains(&compression)
}

/// Offset of the first chunk record at or after `from` whose head agrees with its length in all fields.
pub(super) fn next_chunk(file: &File, from: u64, length: u64) -> std::io::Result<Option<u64>> {
    let mut window = vec![0; SEARCHED];
    let mut begin = from;
    while begin + SMALLEST_CHUNK <= length {
        let count = (length - begin).min(SEARCHED as u64) as usize;
        file.read_exact_at(&mut window[..count], begin)?;
        for (index, _) in window[..count]
            .iter()
            .enumerate()
            .filter(|(_, byte)| **byte == op::CHUNK)
        {
            let offset = begin + index as u64;
            if is_chunk(&window[index..count], length - offset) {
                return Ok(Some(offset));
            }
        }
        if begin + count as u64 == length {
            break;
        }
        // A head that the window's end cuts is seen whole in the next one.
        begin += (count - CHUNK_HEAD as usize) as u64;
    }
    Ok(None)
}

/// Whether a whole chunk record begins with these bytes; `available` bytes follow in the file.
fn is_chunk(bytes: &[u8], available: u64) -> bool {
    let (_, rest) = bytes.split_at(RECORD_HEAD.min(bytes.len() as u64) as usize);
    let (Some(size), Some((start, end, unpacked))) =
        (bytes.get(1..).and_then(|head| Fields(head).u64()), chunk_summary(rest))
    else {
        return false;
    };
    let head = &rest[..rest.len().min(CHUNK_HEAD as usize)];
    ChunkHead::parse(head).is_some_and(|(chunk, data)| {
        let before = (head.len() - data.len()) as u64;
        is_known(&chunk.compression)
            && start <= end
            && before.checked_add(chunk.compressed_size) == Some(size)
            && size.checked_add(RECORD_HEAD).is_some_and(|whole| whole <= available)
            && (!chunk.compression.is_empty() || unpacked == chunk.compressed_size)
    })
}

/// Earliest time, latest time and decompressed size of a chunk, from its head.
pub(super) fn chunk_summary(head: &[u8]) -> Option<(u64, u64, u64)> {
    let mut fields = Fields(head);
    Some((fields.u64()?, fields.u64()?, fields.u64()?))
}
