//! Decompresses the records of one chunk.
//!
//! A file of a few bytes can claim to hold gigabytes. The bounds below keep memory and time in proportion to the size
//! of the file.

use std::io::Read;

use super::records::ChunkHead;

/// Largest decompressed chunk (bytes): far above the few megabytes that writers use, far below the memory of a machine.
const LARGEST: u64 = 256 << 20;
/// Decompressed size that any chunk may have (bytes): one large message of equal values compresses a thousandfold.
const FREE: u64 = 16 << 20;
/// Largest compression ratio of a chunk beyond that size: an assumption, ten times the ratio of messages with changing
/// numbers. A higher ratio indicates a file made to exhaust memory.
const MOST_RATIO: u64 = 200;

/// Largest decompressed size of a chunk with `compressed` bytes.
pub(super) fn largest_unpacked(compressed: u64) -> u64 {
    FREE.saturating_add(MOST_RATIO.saturating_mul(compressed)).min(LARGEST)
}

/// Largest sum of decompressed sizes in a file of `length` bytes.
pub(super) fn most_in_file(length: u64) -> u64 {
    LARGEST.saturating_add(MOST_RATIO.saturating_mul(length))
}

/// The records of a chunk, and its defect if it has one. A truncated chunk (`whole` is false) gives everything up to
/// the cut; a whole one with a wrong checksum gives nothing.
pub(super) fn unpack(body: &[u8], whole: bool) -> (Vec<u8>, Option<String>) {
    let Some((head, rest)) = ChunkHead::parse(body) else {
        // A truncated chunk may lack even its head.
        return (Vec::new(), whole.then(|| "the chunk's head is damaged".to_owned()));
    };
    // The claimed size counts only as far as the file has bytes. A truncated chunk gives what is there.
    let compressed = match usize::try_from(head.compressed_size) {
        Ok(size) if size <= rest.len() => &rest[..size],
        _ if !whole => rest,
        _ => {
            return (
                Vec::new(),
                Some("the chunk claims more bytes than its record has".to_owned()),
            );
        }
    };
    // A chunk that was open when its writer died has the size 0.
    let most = largest_unpacked(compressed.len() as u64);
    let limit = if whole || head.uncompressed_size != 0 {
        head.uncompressed_size.min(most)
    } else {
        most
    };
    // Refused before decompressing, with both sizes in the text: a claim like this is an attack or damage.
    if whole && head.uncompressed_size > most {
        return (
            Vec::new(),
            Some(format!(
                "the chunk of {} bytes claims to decompress to {} bytes, at most {most} are accepted: no recording \
                 compresses so well",
                compressed.len(),
                head.uncompressed_size
            )),
        );
    }
    let mut records = Vec::new();
    // Each decoder is cut at the limit, so that false sizes cost no memory either.
    let read = match head.compression.as_str() {
        "" => compressed.take(limit).read_to_end(&mut records),
        "zstd" => zstd::stream::read::Decoder::with_buffer(compressed)
            .and_then(|decoder| decoder.take(limit).read_to_end(&mut records)),
        "lz4" => lz4::Decoder::new(compressed).and_then(|decoder| decoder.take(limit).read_to_end(&mut records)),
        other => {
            return (
                Vec::new(),
                Some(format!(
                    "the chunk compression {other:?} is not supported (zstd, lz4 and none are)"
                )),
            );
        }
    };
    // At a cut the decoder's error and a wrong checksum are expected, and the records before it are good.
    if !whole {
        return (records, None);
    }
    let problem = match read {
        Err(error) => Some(format!("the chunk cannot be decompressed: {error}")),
        // Length before checksum: it names the defect more exactly.
        Ok(_) if records.len() as u64 != head.uncompressed_size => Some(format!(
            "the chunk decompresses to {} bytes instead of {}",
            records.len(),
            head.uncompressed_size
        )),
        // A checksum of zero means that there is none.
        Ok(_) if head.crc != 0 && crc32fast::hash(&records) != head.crc => {
            Some("the chunk's checksum does not match its content".to_owned())
        }
        Ok(_) => None,
    };
    // A wrong checksum does not say which record is damaged, so none is used.
    if problem.is_some() {
        records.clear();
    }
    (records, problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The body of a chunk record: compressed zeros, with the size that the head claims.
    fn bomb(unpacked: usize, claimed: u64) -> Vec<u8> {
        let compressed = zstd::bulk::compress(&vec![0; unpacked], 19).unwrap();
        [
            &[0; 16][..],
            &claimed.to_le_bytes(),
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
        let allowed = largest_unpacked(body.len() as u64);
        // The bound is little above the size that any chunk may have.
        assert!(allowed < UNPACKED as u64 / 3, "{allowed}");
        let (records, problem) = unpack(&body, true);
        let problem = problem.unwrap();
        assert!(records.is_empty() && records.capacity() == 0);
        assert!(
            problem.contains(&UNPACKED.to_string()) && problem.contains("no recording compresses so well"),
            "{problem}"
        );
        // A chunk with a false size, and a truncated one without a size, give no more than the bound.
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
