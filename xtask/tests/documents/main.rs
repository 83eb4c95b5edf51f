//! Documents keep to their width, words and figures, and the files, links and functions that they name exist.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod agreement;
mod vocabulary;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Most characters of a line; tables, links and what a command writes may be longer.
const WIDTH: usize = 120;
/// Sections that a command writes are between such lines.
const WRITTEN: &str = "<!-- flexdrill bench";
/// Folders that are not the repository's own.
const FOREIGN: [&str; 5] = ["target", ".git", ".venv", ".venv-peers", "node_modules"];
/// First folders of a path that is meant from the repository's root.
const ROOTS: [&str; 10] = [
    ".ci",
    "benches",
    "config",
    "crates",
    "docs",
    "launch_scripts",
    "msg",
    "src",
    "tests",
    "xtask",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn files(extensions: &[&str]) -> Vec<PathBuf> {
    fn add(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !FOREIGN.contains(&name.as_str()) {
                add(&path, extensions, found);
            } else if extensions.iter().any(|extension| name.ends_with(extension)) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    add(&root(), extensions, &mut found);
    assert!(!found.is_empty());
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn name(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}

/// The line with addresses and the targets of links taken out.
fn without_links(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((text, target)) = rest.split_once("](") {
        out.push_str(text);
        rest = target.split_once(')').map_or("", |(_, rest)| rest);
    }
    out.push_str(rest);
    out.split(' ')
        .filter(|word| !word.contains("://"))
        .collect::<Vec<_>>()
        .join(" ")
}

/// What stands between backticks, outside of code blocks.
fn code(text: &str) -> Vec<&str> {
    let mut fenced = false;
    text.lines()
        .filter(|line| {
            fenced ^= line.trim_start().starts_with("```");
            !fenced && !line.trim_start().starts_with("```")
        })
        .flat_map(|line| line.split('`').skip(1).step_by(2))
        .collect()
}

#[test]
fn lines_are_no_wider_than_a_page() {
    let mut wide = Vec::new();
    for file in files(&[".md", ".cff"]) {
        let (mut written, mut fenced) = (false, false);
        for (number, line) in read(&file).lines().enumerate() {
            if line.starts_with(WRITTEN) {
                written = !line.contains(": end");
            }
            fenced ^= line.trim_start().starts_with("```");
            let free = written || fenced || line.trim_start().starts_with('|');
            if !free && without_links(line).chars().count() > WIDTH {
                wide.push(format!("{}:{}", name(&file), number + 1));
            }
        }
    }
    assert!(wide.is_empty(), "wider than {WIDTH} characters:\n{}", wide.join("\n"));
}

#[test]
fn links_lead_somewhere() {
    let mut broken = Vec::new();
    for file in files(&[".md"]) {
        let text = read(&file);
        for link in text
            .split("](")
            .skip(1)
            .filter_map(|rest| Some(rest.split_once(')')?.0))
        {
            let (path, heading) = link.split_once('#').unwrap_or((link, ""));
            if path.contains("://") {
                continue;
            }
            let target = if path.is_empty() {
                file.clone()
            } else {
                file.parent().unwrap_or(Path::new("")).join(path)
            };
            let there = target.exists() && (heading.is_empty() || headings(&read(&target)).contains(heading));
            if !there {
                broken.push(format!("{}: {link}", name(&file)));
            }
        }
    }
    assert!(broken.is_empty(), "links to nowhere:\n{}", broken.join("\n"));
}

/// Anchors of a document's headings.
fn headings(text: &str) -> BTreeSet<String> {
    text.lines()
        .filter_map(|line| line.strip_prefix('#'))
        .map(|line| {
            let title = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            title
                .chars()
                .filter(|c| c.is_alphanumeric() || "-_".contains(*c))
                .collect()
        })
        .collect()
}

/// Documents that speak of the present, and not of what was (changelog, history) or of other projects' files.
fn present_documents() -> Vec<PathBuf> {
    let past = |path: &PathBuf| path.ends_with("CHANGELOG.md") || name(path).starts_with("docs/history/");
    let foreign = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "upstream");
    let all = files(&[".md"]).into_iter();
    all.filter(|path| !past(path) && !foreign(path)).collect()
}

/// Endings of the repository's own files.
const ENDINGS: [&str; 10] = [
    ".rs", ".yaml", ".md", ".py", ".sh", ".msg", ".toml", ".ts", ".csv", ".json",
];
/// Files that the program writes for a user.
const WRITTEN_FILES: [&str; 23] = [
    // by `flexdrill ahead`
    "surveys.csv",
    "metadata.yaml",
    "report.md",
    "findings.csv",
    "reach.csv",
    "reach_plausible.csv",
    "sweep.json",
    "points.csv",
    "map.csv",
    "map.json",
    "envelope_x.csv",
    "envelope_y.csv",
    // by `flexdrill calibrate`
    "overlay.yaml",
    "posterior.csv",
    "calibrated.yaml",
    "calibration.json",
    "sensitivity.csv",
    "sensitivity.json",
    "ahead.csv",
    // by `flexdrill trip`
    "trip.csv",
    "stuck.csv",
    "reached.csv",
    // by `flexdrill bridge wits --look`
    "site.yaml",
];

#[test]
fn files_that_are_named_exist() {
    let there: Vec<String> = files(&ENDINGS).iter().map(|file| name(file)).collect();
    let mut missing = Vec::new();
    for file in present_documents() {
        let text = read(&file);
        for path in code(&text) {
            let named = path.split(' ').next().unwrap_or_default().trim_start_matches("./");
            let first = named.split('/').next().unwrap_or_default();
            let plain = named.chars().all(|c| c.is_alphanumeric() || "/._-".contains(c));
            let from_root = named.contains('/') && plain && ROOTS.contains(&first);
            // A file may be named without its folders, but then it is one of the repository's.
            let ending = ENDINGS
                .iter()
                .any(|ending| named.len() > ending.len() && named.ends_with(ending));
            let short = plain && ending && !named.starts_with('/') && !WRITTEN_FILES.contains(&named);
            let known = || {
                there
                    .iter()
                    .any(|path| path == named || path.ends_with(&format!("/{named}")))
            };
            if (from_root && !root().join(named).exists()) || (short && !from_root && !known()) {
                missing.push(format!("{}: {path}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// The source without its comments: what only a comment names is not there.
fn without_comments(source: &str) -> String {
    source
        .lines()
        .map(|line| line.split_once("//").map_or(line, |(code, _)| code))
        .collect::<Vec<_>>()
        .join("\n")
}

fn words(source: &str) -> impl Iterator<Item = &str> {
    source
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
}

/// Names that the sources define after one of these keywords.
fn defined(sources: &[String], keywords: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for source in sources {
        let mut before = "";
        for word in words(source) {
            if keywords.contains(&before) {
                found.insert(word.to_owned());
            }
            before = word;
        }
    }
    found
}

fn sources() -> Vec<String> {
    files(&[".rs"])
        .iter()
        .map(|file| without_comments(&read(file)))
        .collect()
}

#[test]
fn functions_and_types_that_are_named_exist() {
    let sources = sources();
    let words: BTreeSet<&str> = sources.iter().flat_map(|source| words(source)).collect();
    let types = defined(&sources, &["struct", "enum", "trait", "type"]);
    let mut missing = Vec::new();
    // Reports to other projects name what is theirs.
    let own = files(&[".md"])
        .into_iter()
        .filter(|file| !name(file).starts_with("docs/upstream/"));
    for file in own {
        let text = read(&file);
        let glossary = file.ends_with("docs/glossary.md");
        for item in code(&text) {
            let path = item.contains("::") && item.chars().all(|c| c.is_alphanumeric() || "_:".contains(c));
            let carries = glossary
                && item.starts_with(char::is_uppercase)
                && item.chars().any(char::is_lowercase)
                && item.chars().all(|c| c.is_alphanumeric() || c == '_');
            let known = !path || item.split("::").all(|word| words.contains(word));
            if !known || (carries && !types.contains(item)) {
                missing.push(format!("{}: {item}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// Beginnings of the names of test files.
const TESTS: [&str; 9] = [
    "analytic_",
    "mechanics_",
    "paper_",
    "replay_",
    "property_",
    "interop_",
    "crash_",
    "network_",
    "no_alloc",
];
/// A name of so many words is a sentence, as tests have them.
const SENTENCE: usize = 6;

#[test]
fn tests_that_are_named_exist() {
    let functions = defined(&sources(), &["fn"]);
    let stems: BTreeSet<String> = files(&[".rs"])
        .iter()
        .flat_map(|file| [file.file_stem(), file.parent().and_then(Path::file_name)])
        .flatten()
        .map(|stem| stem.to_string_lossy().into_owned())
        .collect();
    let mut missing = Vec::new();
    for file in present_documents() {
        let text = read(&file);
        for item in code(&text) {
            let plain = item.contains('_')
                && item
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
            let test = TESTS.iter().any(|begin| item.starts_with(begin)) || item.split('_').count() >= SENTENCE;
            // A key with a compound unit has as many words: `slew_m_per_h_per_s`.
            let key = item.contains("_per_");
            if plain && test && !key && !item.ends_with('_') && !functions.contains(item) && !stems.contains(item) {
                missing.push(format!("{}: {item}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// Rows that the page of a rig's inputs has at least.
const SHAPES: usize = 40;

#[test]
fn every_shape_of_a_rigs_inputs_has_a_source_and_a_test() {
    let functions = defined(&sources(), &["fn"]);
    let page = read(&root().join("docs/rig_inputs.md"));
    let mut shapes = 0;
    for line in page.lines().filter(|line| line.starts_with("| ")) {
        // Code between backticks may have the mark of a column: no row of this page has it.
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        assert_eq!(
            cells.len(),
            5,
            "shape, who, source, what the program does, test: {line}"
        );
        assert!(cells.iter().all(|cell| !cell.is_empty()), "{line}");
        if cells[0] == "shape" {
            continue;
        }
        let mut named = code(cells[4]).into_iter().filter(|name| functions.contains(*name));
        assert!(cells[4] == "the same" || named.next().is_some(), "no test: {line}");
        shapes += 1;
    }
    assert!(shapes >= SHAPES, "{shapes} shapes");
}

#[test]
fn the_guide_names_every_test_binary_of_the_program() {
    let guide = read(&root().join("CONTRIBUTING.md"));
    let named: BTreeSet<&str> = code(&guide).into_iter().collect();
    let entries = std::fs::read_dir(root().join("tests")).unwrap();
    let missing: Vec<String> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("main.rs").is_file() || path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .filter(|binary| !named.contains(binary.as_str()))
        .collect();
    assert!(missing.is_empty(), "CONTRIBUTING.md does not name {missing:?}");
}
