//! The Python that `launch_scripts/test.sh` sets up, and the scripts of `tests/python/`.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use super::root;
use super::skip::skipped;

/// Exit code of a script that lacks its packages.
const MISSING: i32 = 77;

/// The Python that has this package: FLEXDRILL_PYTHON, or the one that test.sh makes. `None`, with a line that says so,
/// where there is none.
pub fn with(package: &str) -> Option<PathBuf> {
    let found = candidates().find(|python| {
        let import = format!("import {package}");
        let imported = Command::new(python)
            .args(["-c", &import])
            .stderr(Stdio::null())
            .status();
        imported.is_ok_and(|status| status.success())
    });
    found.or_else(|| {
        skipped(&format!(
            "no Python with {package}; run launch_scripts/test.sh or set FLEXDRILL_PYTHON"
        ))
    })
}

fn candidates() -> impl Iterator<Item = PathBuf> {
    let given = std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from);
    given.into_iter().chain([root().join(".venv/bin/python")])
}

/// Runs a script with `input` on its standard input and returns what it prints. `None`, with a line that says so, where
/// there is no Python or it lacks the packages.
///
/// # Panics
/// When the script fails.
pub fn run(script: &str, arguments: &[&str], input: &str) -> Option<String> {
    run_with_codes(script, arguments, input, &[0])
}

/// As [`run`], of a script that also says something by ending with another of `codes`.
///
/// # Panics
/// When the script ends with none of them.
pub fn run_with_codes(script: &str, arguments: &[&str], input: &str, codes: &[i32]) -> Option<String> {
    let Some(python) = candidates().find(|python| python.exists()) else {
        return skipped(&format!(
            "{script}: no Python; run launch_scripts/test.sh or set FLEXDRILL_PYTHON"
        ));
    };
    let mut child = Command::new(python)
        .arg(root().join("tests/python").join(script))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A script without packages ends before it reads.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let output = child.wait_with_output().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.code() == Some(MISSING) {
        return skipped(&format!("{script}: {}", printed.trim()));
    }
    assert!(
        output.status.code().is_some_and(|code| codes.contains(&code)),
        "{script} {arguments:?}:\n{printed}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(printed)
}
