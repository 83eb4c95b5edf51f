//! The hole as drilled in the file of a checkpoint: its points behind the state of the model.
//!
//! ```text
//! checkpoint | per point: build, right, f64, known, u8 | SHA-256 of the points, 32 bytes | number of points, u64 | magic "flexdrHD"
//! ```
//!
//! Numbers are little-endian. A file without points is the checkpoint alone.

use sha2::{Digest, Sha256};

use super::Point;

const MAGIC: &[u8; 8] = b"flexdrHD";
const HASH: usize = 32;
const POINT: usize = 2 * size_of::<f64>() + 1;

/// Why the points of a file cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the points of the hole as drilled at its end are damaged, their checksum does not fit; take another copy, or start \
     without it"
)]
pub struct Damaged;

/// The bytes of a file with a checkpoint and the points of a hole.
pub fn with_points(mut checkpoint: Vec<u8>, points: &[Point]) -> Vec<u8> {
    if points.is_empty() {
        return checkpoint;
    }
    let start = checkpoint.len();
    for Point { curvatures, known } in points {
        checkpoint.extend(curvatures.iter().flat_map(|curvature| curvature.to_le_bytes()));
        checkpoint.push(u8::from(*known));
    }
    let hash = Sha256::digest(&checkpoint[start..]);
    checkpoint.extend(hash);
    checkpoint.extend((points.len() as u64).to_le_bytes());
    checkpoint.extend(MAGIC);
    checkpoint
}

/// Checkpoint and points of a file.
///
/// # Errors
/// [`Damaged`].
pub fn split(mut file: Vec<u8>) -> Result<(Vec<u8>, Vec<Point>), Damaged> {
    let Some(rest) = file.strip_suffix(MAGIC) else {
        return Ok((file, Vec::new()));
    };
    let (rest, count) = rest.split_last_chunk::<8>().ok_or(Damaged)?;
    let (rest, hash) = rest.split_last_chunk::<HASH>().ok_or(Damaged)?;
    let count = usize::try_from(u64::from_le_bytes(*count)).map_err(|_| Damaged)?;
    let length = count.checked_mul(POINT).ok_or(Damaged)?;
    let start = rest.len().checked_sub(length).ok_or(Damaged)?;
    let bytes = &rest[start..];
    if Sha256::digest(bytes).as_slice() != hash {
        return Err(Damaged);
    }
    let number = |bytes: &[u8]| bytes.try_into().map(f64::from_le_bytes).map_err(|_| Damaged);
    let read = |point: &[u8]| -> Result<Point, Damaged> {
        Ok(Point {
            curvatures: [number(&point[..8])?, number(&point[8..16])?],
            known: point[16] != 0,
        })
    };
    let points = bytes.chunks_exact(POINT).map(read).collect::<Result<_, _>>()?;
    file.truncate(start);
    Ok((file, points))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> Vec<Point> {
        let point = |index: u32| Point {
            curvatures: [0.3 + 0.001 * f64::from(index), -1e-4],
            known: index != 1,
        };
        (0..3).map(point).collect()
    }

    #[test]
    fn a_file_has_both_back() {
        let (checkpoint, points) = (b"a state".to_vec(), points());
        let file = with_points(checkpoint.clone(), &points);
        assert_eq!(file.len(), 7 + 3 * 17 + 32 + 8 + 8);
        assert_eq!(split(file), Ok((checkpoint.clone(), points)));
        // Without points it is the file of earlier versions.
        assert_eq!(with_points(checkpoint.clone(), &[]), checkpoint);
        assert_eq!(split(checkpoint.clone()), Ok((checkpoint, Vec::new())));
    }

    #[test]
    fn a_damaged_file_is_refused() {
        let file = with_points(b"a state".to_vec(), &points());
        // Every byte behind the checkpoint, up to the magic.
        for at in 7..file.len() - 8 {
            let mut damaged = file.clone();
            damaged[at] ^= 1;
            assert_eq!(split(damaged), Err(Damaged), "byte {at}");
        }
        for length in 0..50 {
            let cut = file[file.len() - 8 - length..].to_vec();
            assert_eq!(split(cut), Err(Damaged), "{length}");
        }
    }
}
