//! Unpacking the records of one chunk.

use std::io::Read;

use super::records::ChunkHead;

/// Largest chunk that is unpacked (bytes): more than writers make, which begin a new one at some megabytes, and less than
/// memory.
const LARGEST: u64 = 256 << 20;
/// Bytes that a chunk may unpack to whatever its size: a single large message of equal values compresses a thousand times.
const FREE: u64 = 16 << 20;
/// Times its compressed size that a larger chunk may unpack to: an assumption, ten times what messages of numbers that
/// change reach. What compresses better was made to fill memory.
const MOST_RATIO: u64 = 200;

/// Bytes that so many compressed ones may unpack to.
pub(super) fn most_unpacked(compressed: u64) -> u64 {
    FREE.saturating_add(MOST_RATIO.saturating_mul(compressed)).min(LARGEST)
}

/// Bytes that all chunks of a file of so many bytes may unpack to.
pub(super) fn most_in_file(length: u64) -> u64 {
    LARGEST.saturating_add(MOST_RATIO.saturating_mul(length))
}

/// Records of a chunk, and what is wrong with it if something is. Of a chunk that is cut (`whole` false), everything up
/// to the cut; of a whole one with a wrong checksum, nothing.
pub(super) fn unpack(body: &[u8], whole: bool) -> (Vec<u8>, Option<String>) {
    let Some((head, rest)) = ChunkHead::parse(body) else {
        // Of a cut chunk, not even the head may be there.
        return (Vec::new(), whole.then(|| "the chunk's head is damaged".to_owned()));
    };
    let compressed = match usize::try_from(head.compressed_size) {
        Ok(size) if size <= rest.len() => &rest[..size],
        _ if !whole => rest,
        _ => return (Vec::new(), Some("the chunk is longer than its record".to_owned())),
    };
    // A chunk that was still open when its writer died has no size.
    let most = most_unpacked(compressed.len() as u64);
    let limit = if whole || head.uncompressed_size != 0 {
        head.uncompressed_size.min(most)
    } else {
        most
    };
    if whole && head.uncompressed_size > most {
        return (
            Vec::new(),
            Some(format!(
                "the chunk of {} bytes says that it unpacks to {} bytes, and at most {most} are unpacked: no recording \
                 compresses so well",
                compressed.len(),
                head.uncompressed_size
            )),
        );
    }
    let mut records = Vec::new();
    let read = match head.compression.as_str() {
        "" => compressed.take(limit).read_to_end(&mut records),
        "zstd" => zstd::stream::read::Decoder::with_buffer(compressed)
            .and_then(|decoder| decoder.take(limit).read_to_end(&mut records)),
        "lz4" => lz4::Decoder::new(compressed).and_then(|decoder| decoder.take(limit).read_to_end(&mut records)),
        other => {
            return (
                Vec::new(),
                Some(format!(
                    "chunk compression {other:?} is not known (zstd, lz4 and none are)"
                )),
            );
        }
    };
    if !whole {
        return (records, None);
    }
    let problem = match read {
        Err(error) => Some(format!("the chunk cannot be unpacked: {error}")),
        Ok(_) if records.len() as u64 != head.uncompressed_size => Some(format!(
            "the chunk unpacks to {} bytes instead of {}",
            records.len(),
            head.uncompressed_size
        )),
        // A checksum of zero means that there is none.
        Ok(_) if head.crc != 0 && crc32fast::hash(&records) != head.crc => {
            Some("the chunk's checksum does not fit its content".to_owned())
        }
        Ok(_) => None,
    };
    if problem.is_some() {
        records.clear();
    }
    (records, problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The body of a chunk record: zeros, compressed.
    fn bomb(unpacked: usize, said: u64) -> Vec<u8> {
        let compressed = zstd::bulk::compress(&vec![0; unpacked], 19).unwrap();
        [
            &[0; 16][..],
            &said.to_le_bytes(),
            &[0; 4],
            &4_u32.to_le_bytes(),
            b"zstd",
            &(compressed.len() as u64).to_le_bytes(),
            &compressed,
        ]
        .concat()
    }

    #[test]
    fn a_chunk_that_would_fill_memory_is_refused_in_words_before_it_is_unpacked() {
        const UNPACKED: usize = 64 << 20;
        let body = bomb(UNPACKED, UNPACKED as u64);
        let allowed = most_unpacked(body.len() as u64);
        // Little beyond what a chunk of any size may unpack to.
        assert!(allowed < UNPACKED as u64 / 3, "{allowed}");
        let (records, problem) = unpack(&body, true);
        let problem = problem.unwrap();
        assert!(records.is_empty() && records.capacity() == 0);
        assert!(
            problem.contains(&UNPACKED.to_string()) && problem.contains("no recording compresses so well"),
            "{problem}"
        );
        // One that lies about its size, and one that was cut and has none, give what is allowed.
        let (records, _) = unpack(&bomb(UNPACKED, 1000), true);
        assert!(records.len() <= 1000, "{}", records.len());
        let (records, _) = unpack(&bomb(UNPACKED, 0), false);
        assert!(records.len() as u64 <= allowed, "{}", records.len());
    }

    #[test]
    fn a_small_chunk_of_equal_messages_is_unpacked() {
        let (records, problem) = unpack(&bomb(1 << 20, 1 << 20), true);
        assert_eq!((records.len(), problem), (1 << 20, None));
    }
}
