//! asyncua, as a process.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

/// A Python with asyncua; `None` where there is none, which is a failure in CI.
pub fn python() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let given = std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from);
    let mut pythons = given.into_iter().chain([root.join(".venv/bin/python")]);
    let has_asyncua = |python: &PathBuf| {
        let asked = Command::new(python)
            .args(["-c", "import asyncua"])
            .stderr(Stdio::null())
            .status();
        asked.is_ok_and(|status| status.success())
    };
    let found = pythons.find(has_asyncua);
    if found.is_none() {
        let text = "SKIPPED: no Python with asyncua; run launch_scripts/test.sh or set FLEXDRILL_PYTHON";
        assert!(std::env::var_os("CI").is_none_or(|ci| ci != "true"), "{text}");
        eprintln!("{text}");
    }
    found
}

pub fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/python")
        .join(name)
}

/// What asyncua sees.
pub async fn ask(python: &Path, arguments: &[&str]) -> Value {
    let mut command = Command::new(python);
    command.arg(script("opcua_client.py")).args(arguments);
    // The script ends after a minute at the latest.
    let output = tokio::task::spawn_blocking(move || command.output())
        .await
        .unwrap()
        .unwrap();
    assert!(
        output.status.success(),
        "{arguments:?}: {}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}
