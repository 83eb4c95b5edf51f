//! Running a script of `tests/python/` with the Python that `launch_scripts/test.sh` has set up.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Ends of a script that lacks its packages.
const MISSING: i32 = 77;

/// Runs the script with `input` on its standard input and returns what it prints. `None`, with a line that says so,
/// where there is no Python or it lacks the packages.
///
/// # Panics
/// When the script fails.
pub fn run(script: &str, arguments: &[&str], input: &str) -> Option<String> {
    let Some(python) = std::env::var_os("FLEXDRILL_PYTHON") else {
        println!("SKIPPED {script}: FLEXDRILL_PYTHON is not set (launch_scripts/test.sh sets it)");
        return None;
    };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python").join(script);
    let mut child = Command::new(python)
        .arg(path)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("FLEXDRILL_PYTHON names a Python");
    let mut stdin = child.stdin.take().expect("piped");
    // A script without packages ends before it reads.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("the script ends");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.code() == Some(MISSING) {
        println!("SKIPPED {script}: {}", printed.trim());
        return None;
    }
    assert!(
        output.status.success(),
        "{script} {arguments:?}:\n{printed}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(printed)
}
