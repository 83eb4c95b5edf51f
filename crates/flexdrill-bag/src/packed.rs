//! Bags that are compressed as a file with Zstandard: `.mcap.zstd` and `.db3.zstd`, as rosbag2 writes them.
//!
//! A bag is read at any place, which a compressed file does not allow: it is unpacked into a temporary file first. Some
//! kilobytes can unpack to more than a disk holds, so the size is bounded.

use std::fs::File;
use std::io::{BufReader, Read, Write as _};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::{BagError, PartFault};

/// First bytes of a Zstandard frame.
const ZSTD_MAGIC: &[u8] = b"\x28\xb5\x2f\xfd";
/// First bytes of an SQLite database.
const SQLITE_MAGIC: &[u8] = b"SQLite format 3\0";
/// First bytes of a bag of ROS 1.
const ROS_1_MAGIC: &[u8] = b"#ROSBAG V";
/// Unpacked size that any file may have (bytes).
const FREE: u64 = 256 << 20;
/// Largest compression ratio beyond it, as for the chunks of an MCAP file.
const MOST_RATIO: u64 = 200;
/// Largest unpacked size (bytes): a file beyond it is unpacked by its owner, on a disk of choice.
const LARGEST: u64 = 16 << 30;
/// Bytes that are unpacked at once.
const PIECE: usize = 1 << 20;

/// Storage of a bag's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Mcap,
    Sqlite,
}

/// Storage of a file, and whether it is compressed, by its first bytes.
///
/// # Errors
/// When it cannot be read, or is no bag.
pub(crate) fn format(path: &Path) -> Result<(Format, bool), BagError> {
    let not = |problem: &str| BagError::NotABag {
        path: path.to_owned(),
        problem: problem.to_owned(),
    };
    let mut magic = Vec::new();
    File::open(path)
        .and_then(|file| file.take(16).read_to_end(&mut magic))
        .map_err(BagError::io("open", path))?;
    if magic.starts_with(ROS_1_MAGIC) {
        return Err(BagError::Ros1 { path: path.to_owned() });
    }
    if let Some(format) = plain(&magic) {
        return Ok((format, false));
    }
    if !magic.starts_with(ZSTD_MAGIC) {
        return Err(not("its first bytes are those of neither MCAP nor SQLite"));
    }
    let mut content = Vec::new();
    let file = File::open(path).map_err(BagError::io("open", path))?;
    // A content that cannot be unpacked up to there has no first bytes.
    let _ = zstd::stream::read::Decoder::new(file).and_then(|decoder| decoder.take(16).read_to_end(&mut content));
    let format =
        plain(&content).ok_or_else(|| not("it is compressed with Zstandard, and holds neither MCAP nor SQLite"));
    format.map(|format| (format, true))
}

fn plain(magic: &[u8]) -> Option<Format> {
    if magic.starts_with(mcap::MAGIC) {
        Some(Format::Mcap)
    } else {
        magic.starts_with(SQLITE_MAGIC).then_some(Format::Sqlite)
    }
}

/// Largest unpacked size of a file with `packed` bytes.
fn largest(packed: u64) -> u64 {
    FREE.saturating_add(MOST_RATIO.saturating_mul(packed)).min(LARGEST)
}

/// Unpacks a file. A damaged one gives everything before the damage, with the fault.
///
/// # Errors
/// When it cannot be read, the temporary file cannot be written, or the content is too large.
pub(crate) fn unpack(path: &Path) -> Result<(NamedTempFile, Option<PartFault>), BagError> {
    let file = File::open(path).map_err(BagError::io("open", path))?;
    let packed = file.metadata().map_err(BagError::io("read", path))?.len();
    unpack_at_most(path, file, packed, largest(packed))
}

fn unpack_at_most(
    path: &Path,
    file: File,
    packed: u64,
    most: u64,
) -> Result<(NamedTempFile, Option<PartFault>), BagError> {
    let folder = std::env::temp_dir();
    let write = || BagError::io("unpack it to", &folder);
    let mut unpacked = tempfile::Builder::new()
        .prefix("flexdrill_")
        .suffix(".bag")
        .tempfile_in(&folder)
        .map_err(write())?;
    let mut decoder = zstd::stream::read::Decoder::with_buffer(BufReader::with_capacity(PIECE, file))
        .map_err(BagError::io("unpack", path))?;
    // In pieces, so that memory stays small and the bound holds before the disk is full.
    let (mut bytes, mut piece) = (0_u64, vec![0; PIECE]);
    loop {
        let count = match decoder.read(&mut piece) {
            Ok(0) => return Ok((unpacked, None)),
            Ok(count) => count,
            Err(error) => {
                let fault = PartFault::PartlyUnpacked {
                    path: path.to_owned(),
                    bytes,
                    why: error.to_string(),
                };
                return Ok((unpacked, Some(fault)));
            }
        };
        bytes += count as u64;
        if bytes > most {
            return Err(BagError::TooLarge {
                path: path.to_owned(),
                packed,
                most,
            });
        }
        unpacked.write_all(&piece[..count]).map_err(write())?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_would_fill_the_disk_is_refused_at_the_bound() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bomb.mcap.zstd");
        std::fs::write(&path, zstd::bulk::compress(&vec![0; 8 << 20], 19).unwrap()).unwrap();
        let packed = std::fs::metadata(&path).unwrap().len();
        assert!(packed < 2000, "{packed}");
        let open = || File::open(&path).unwrap();
        let error = unpack_at_most(&path, open(), packed, 2 << 20).unwrap_err().to_string();
        for part in ["bomb.mcap.zstd", "2097152 bytes", "unzstd"] {
            assert!(error.contains(part), "'{part}' is not in: {error}");
        }
        let (unpacked, fault) = unpack_at_most(&path, open(), packed, 8 << 20).unwrap();
        assert_eq!((unpacked.as_file().metadata().unwrap().len(), fault), (8 << 20, None));
        // The bounds that the documents state.
        assert_eq!(largest(packed), (256 << 20) + 200 * packed);
        assert_eq!(largest(1 << 40), 16 << 30);
    }
}
