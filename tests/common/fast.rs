//! The DDS program on Fast DDS, compiled where its headers are.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use super::root;
use super::skip::{skipped, unavailable};

/// A header of the package libfastrtps-dev.
const HEADER: &str = "/usr/include/fastdds/dds/domain/DomainParticipant.hpp";

/// The compiled program; `None`, with a line that says so, without Fast DDS. In CI that fails where the package could be
/// installed.
pub(super) fn program() -> Option<&'static Path> {
    static PROGRAM: OnceLock<Option<PathBuf>> = OnceLock::new();
    PROGRAM.get_or_init(compile).as_deref()
}

fn compile() -> Option<PathBuf> {
    if !Path::new(HEADER).exists() {
        let why = "Fast DDS is not there (package libfastrtps-dev)";
        let known = Command::new("apt-cache").args(["show", "libfastrtps-dev"]).output();
        if known.is_ok_and(|known| known.status.success()) {
            return skipped(why);
        }
        return unavailable(&format!("{why}, and this system does not offer it"));
    }
    let made = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fast_peer_{}", std::process::id()));
    let output = Command::new("c++")
        .args(["-O1", "-std=c++17", "-Wall", "-Werror", "-o"])
        .arg(&made)
        .arg(root().join("tests/cpp/fast_peer.cpp"))
        .args(["-lfastrtps", "-lfastcdr"])
        .output();
    let output = match output {
        Ok(output) => output,
        Err(error) => return skipped(&format!("c++: {error}")),
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(made)
}
