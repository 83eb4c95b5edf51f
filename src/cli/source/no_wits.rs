//! Captures of a WITS line in a build without bridges: they are recognized and refused.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::super::absent;
use super::Samples;

/// First bytes of a capture, as the crate `flexdrill-bridge` writes them, without the number of the format.
const BEGIN: &[u8] = b"flexdrill wits capture ";

/// Whether a file is a capture that `flexdrill bridge wits --capture` wrote.
pub(super) fn is_capture(path: &Path) -> bool {
    let mut begin = [0; BEGIN.len()];
    path.is_file() && File::open(path).is_ok_and(|mut file| file.read_exact(&mut begin).is_ok() && begin == BEGIN)
}

/// # Errors
/// Always: this build has no bridges.
pub(super) fn read(_path: &Path, _mapping: Option<&Path>) -> anyhow::Result<Samples> {
    Err(absent::refusal("captures of WITS", "bridge"))
}
