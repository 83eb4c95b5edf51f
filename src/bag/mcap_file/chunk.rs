//! Unpacking the records of one chunk.

use std::io::Read;

use super::records::ChunkHead;

/// Largest chunk that is unpacked (bytes): far more than any writer makes, far less than memory.
const LARGEST: u64 = 1 << 30;

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
    let limit = if whole || head.uncompressed_size != 0 {
        head.uncompressed_size.min(LARGEST)
    } else {
        LARGEST
    };
    if whole && head.uncompressed_size > LARGEST {
        return (Vec::new(), Some("the chunk unpacks to more than 1 GiB".to_owned()));
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
