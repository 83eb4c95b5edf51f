//! Tests of single laws: their comments, and the figures that they print.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use flexdrill_verify::Row;

/// Beginning of the names of tests against figures from outside.
pub const VAL: &str = "val_";
/// Beginning of the names of tests against closed forms.
pub const ANALYTIC: &str = "analytic_";

/// Figures by the name of their test.
pub type Figures = BTreeMap<String, Vec<Row>>;

/// A test of a law alone.
#[derive(Debug)]
pub struct Law {
    /// Name of the test.
    pub name: String,
    /// Package of the test.
    pub package: String,
    /// `--lib` with the name of the test, or `--test` with the name of a file in `tests/`.
    pub target: String,
    /// The test's own comment.
    pub comment: String,
}

/// The tests whose names begin with `prefix`, in the sources of the crates and in their files `tests/val_*.rs`, by file
/// and line.
pub fn named(prefix: &str) -> Vec<Law> {
    let mut found = Vec::new();
    for package in sorted(&root().join("crates")) {
        let mut folders = vec![package.join("src")];
        while let Some(folder) = folders.pop() {
            for path in sorted(&folder) {
                if path.is_dir() {
                    folders.push(path);
                } else if is_rust(&path) {
                    tests_in(prefix, &path, &package, None, &mut found);
                }
            }
        }
        for path in sorted(&package.join("tests")) {
            let file = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            if let Some(file) = file.filter(|file| file.starts_with(VAL) && is_rust(&path)) {
                tests_in(prefix, &path, &package, Some(&file), &mut found);
            }
        }
    }
    found
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn is_rust(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "rs")
}

/// The tests in a source of `package`, `alone` in a binary of that name or in the library's.
fn tests_in(prefix: &str, file: &Path, package: &Path, alone: Option<&str>, found: &mut Vec<Law>) {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let mut comment: Vec<&str> = Vec::new();
    for line in text.lines().map(str::trim) {
        let test = line.strip_prefix("fn ").and_then(|rest| rest.split_once("()"));
        if let Some(said) = line.strip_prefix("///") {
            comment.push(said.trim());
        } else if let Some((name, _)) = test.filter(|(name, _)| name.starts_with(prefix)) {
            found.push(Law {
                name: name.to_owned(),
                package: package
                    .file_name()
                    .map(|name| name.to_string_lossy().into_owned())
                    .unwrap_or_default(),
                target: alone.map_or_else(|| format!("--lib {name}"), |file| format!("--test {file}")),
                comment: comment.join("\n"),
            });
        } else if !line.starts_with("#[") {
            comment.clear();
        }
    }
}

fn sorted(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// Runs the tests and reads the figures that they print (`crates/flexdrill-core/tests/support/figures.rs`).
///
/// # Errors
/// When a test fails, or prints no figure.
pub fn figures<'a>(laws: impl Iterator<Item = &'a Law>) -> std::io::Result<Figures> {
    let laws: Vec<&Law> = laws.collect();
    let mut found = Figures::new();
    let mut binaries: Vec<(&str, &str)> = laws
        .iter()
        .map(|law| {
            let target = law.target.strip_suffix(&law.name).unwrap_or(&law.target);
            (law.package.as_str(), target.trim_end())
        })
        .collect();
    binaries.sort_unstable();
    binaries.dedup();
    for (package, target) in binaries {
        let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .current_dir(root())
            .args(["test", "--release", "--locked", "--package", package])
            .args(target.split(' '))
            // More than one thread, so that each test runs in a thread of its name.
            .args(["--", "--nocapture", "--test-threads", "2", VAL, ANALYTIC])
            .output()?;
        let printed = String::from_utf8_lossy(&output.stdout);
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            let why = format!("cargo test --package {package} {target} failed:\n{printed}{said}");
            return Err(std::io::Error::other(why));
        }
        for (test, row) in printed.lines().filter_map(figure) {
            found.entry(test).or_default().push(row);
        }
    }
    match laws.iter().find(|law| !found.contains_key(&law.name)) {
        None => Ok(found),
        Some(law) => Err(std::io::Error::other(format!("{} prints no figure", law.name))),
    }
}

/// A line that a test prints: its name, the quantity, what it should be, what it is, scale and tolerance.
fn figure(line: &str) -> Option<(String, Row)> {
    let (_, fields) = line.split_once("figure\t")?;
    let [test, quantity, numbers @ ..] = &fields.split('\t').collect::<Vec<_>>()[..] else {
        return None;
    };
    let numbers: Vec<f64> = numbers.iter().filter_map(|number| number.parse().ok()).collect();
    let [expected, got, scale, limit] = numbers[..] else {
        return None;
    };
    Some((
        (*test).to_owned(),
        Row::scaled("", *quantity, expected, got, scale, limit),
    ))
}
