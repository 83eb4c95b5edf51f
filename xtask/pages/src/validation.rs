//! Every published figure and every closed form that the twin is held against, as computed now.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use flexdrill_verify::{CASES, Row, VALIDATIONS, VerifyError, head};

use crate::cell;

/// A test of a law alone against a published figure: its name, package and target, and what its comment says.
struct OfLaw {
    name: String,
    package: String,
    /// `--lib` with the name of the test, or `--test` with the name of a file in `tests/`.
    target: String,
    comment: String,
}

/// Names of all entries in the order of the page.
pub fn names() -> Vec<String> {
    let whole = VALIDATIONS.iter().map(|validation| validation.name.to_owned());
    let laws = of_laws().into_iter().map(|law| law.name);
    whole
        .chain(laws)
        .chain(CASES.iter().map(|case| case.name.to_owned()))
        .collect()
}

/// The page, for which all cases run.
///
/// # Errors
/// When a case cannot be run.
pub fn page() -> Result<String, VerifyError> {
    let mut out = String::from(
        "# Validation\n\n\
         Written by `cargo xtask reference validation`, which runs every case. Figures are rounded to three digits, so that\n\
         they are the same on every machine; the difference is that of the unrounded ones, over the figure unless a table\n\
         says otherwise, and the tests hold it within the tolerance.\n\n\
         No bench figure of torque or weight through a flexible drill pipe is publicly readable. What the twin has of the\n\
         paper's own figures is in [the paper](paper.md).\n\n\
         `flexdrill verify --record DIR` runs the closed forms and the published figures, and leaves a bag of every run in\n\
         DIR, for comparison with another program. Two tables (CSV) have the figures in full, and steps and time of\n\
         each bag. A bag holds its configuration and its inputs; where `residual_factor` is 1, `flexdrill replay` repeats\n\
         it to the bit. Tests of single laws have no run, and therefore no bag.\n\n\
         Tests against figures from outside are named `val_*`, tests against our own earlier figures `regress_*`.\n\n\
         ## Published figures\n",
    );
    for validation in VALIDATIONS {
        let _ = write!(
            out,
            "\n### {}\n{}.\n\n{}{}- Command: `{}`\n\n",
            validation.name,
            capital(validation.shows),
            item("Source", validation.source),
            item("Tolerance", validation.reason),
            validation.command
        );
        table(&mut out, "published", &(validation.run)()?);
    }
    out.push_str("\n## Published figures of single laws\nTests of a law alone. Source, figure and tolerance are in their comments.\n");
    for law in of_laws() {
        let _ = write!(
            out,
            "\n### {}\n{}\n\nCommand: `cargo test --release -p {} {}`\n",
            law.name, law.comment, law.package, law.target
        );
    }
    out.push_str(
        "\n## Closed forms\nThe cases of `flexdrill verify`. The text of each is the head of its configuration.\n",
    );
    for case in CASES {
        let _ = write!(
            out,
            "\n### {}\n```text\n{}\n```\n\n{}- Command: `flexdrill verify --only {}`\n\n",
            case.name,
            head(case.name).unwrap_or_default(),
            item("Tolerance", case.reason),
            case.name
        );
        table(&mut out, "closed form", &(case.run)()?);
    }
    Ok(out)
}

fn table(out: &mut String, of: &str, rows: &[Row]) {
    let _ = writeln!(
        out,
        "| quantity | {of} | ours | difference | tolerance |\n|---|---|---|---|---|"
    );
    for row in rows {
        let difference = if row.error() < 0.01 * row.limit {
            format!("below {:.0e}", 0.01 * row.limit)
        } else {
            format!("{:.0e}", row.error())
        };
        // What should be zero is rounding, whose digits are the machine's.
        let ours = if row.expected == 0.0 && row.error() < 0.01 * row.limit {
            format!("below {:.0e}", 0.01 * row.limit * row.scale)
        } else {
            three_digits(row.got)
        };
        let _ = writeln!(
            out,
            "| {} | {} | {ours} | {difference} | {:.0e} |",
            cell(&row.quantity),
            three_digits(row.expected),
            row.limit
        );
    }
}

/// An item of a list in lines of 120 columns.
fn item(title: &str, text: &str) -> String {
    let mut lines = vec![format!("- {title}:")];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= 120 => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(format!("  {word}")),
        }
    }
    lines.join("\n") + "\n"
}

fn three_digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
        let decimals = (2 - rounded.abs().log10().floor() as i32).max(0) as usize;
        format!("{rounded:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().chain(letters).collect())
        .unwrap_or_default()
}

/// The tests `val_*` in the sources of the crates and in their files `tests/val_*.rs`, by file and line.
fn of_laws() -> Vec<OfLaw> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../crates");
    let mut found = Vec::new();
    for package in sorted(&crates) {
        let mut folders = vec![package.join("src")];
        while let Some(folder) = folders.pop() {
            for path in sorted(&folder) {
                if path.is_dir() {
                    folders.push(path);
                } else if is_rust(&path) {
                    tests_in(&path, &package, None, &mut found);
                }
            }
        }
        for path in sorted(&package.join("tests")) {
            let file = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            if let Some(file) = file.filter(|file| file.starts_with("val_") && is_rust(&path)) {
                tests_in(&path, &package, Some(&file), &mut found);
            }
        }
    }
    found
}

fn is_rust(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "rs")
}

/// The tests in a source of `package`, `alone` in a binary of that name or in the library's.
fn tests_in(file: &Path, package: &Path, alone: Option<&str>, found: &mut Vec<OfLaw>) {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let mut comment: Vec<&str> = Vec::new();
    for line in text.lines().map(str::trim) {
        if let Some(said) = line.strip_prefix("///") {
            comment.push(said.trim());
        } else if let Some((name, _)) = line.strip_prefix("fn val_").and_then(|rest| rest.split_once("()")) {
            found.push(OfLaw {
                name: format!("val_{name}"),
                package: package
                    .file_name()
                    .map(|name| name.to_string_lossy().into_owned())
                    .unwrap_or_default(),
                target: alone.map_or_else(|| format!("--lib val_{name}"), |file| format!("--test {file}")),
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
