//! Documents keep to their width, and the files, links and functions that they name are there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Most characters of a line; tables, links and what a command writes may be longer.
const WIDTH: usize = 120;
/// Sections that a command writes are between such lines.
const WRITTEN: &str = "<!-- flexdrill bench";
/// Folders that are not the repository's own.
const FOREIGN: [&str; 5] = ["target", ".git", ".venv", ".venv-peers", "node_modules"];
/// First folders of a path that is meant from the repository's root.
const ROOTS: [&str; 11] = [
    ".ci",
    "benches",
    "config",
    "crates",
    "docs",
    "examples",
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

#[test]
fn files_that_are_named_exist() {
    let mut missing = Vec::new();
    for file in files(&[".md"]) {
        // What was is named there as it was.
        if file.ends_with("CHANGELOG.md") {
            continue;
        }
        let text = read(&file);
        for path in code(&text) {
            let named = path.split(' ').next().unwrap_or_default().trim_start_matches("./");
            let first = named.split('/').next().unwrap_or_default();
            let plain = named.chars().all(|c| c.is_alphanumeric() || "/._-".contains(c));
            if named.contains('/') && plain && ROOTS.contains(&first) && !root().join(named).exists() {
                missing.push(format!("{}: {path}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

#[test]
fn functions_and_types_that_are_named_exist() {
    let sources: Vec<String> = files(&[".rs"]).iter().map(|file| read(file)).collect();
    let words: BTreeSet<&str> = sources
        .iter()
        .flat_map(|source| source.split(|c: char| !c.is_alphanumeric() && c != '_'))
        .collect();
    let mut missing = Vec::new();
    for file in files(&[".md"]) {
        let text = read(&file);
        let glossary = file.ends_with("docs/glossary.md");
        for item in code(&text) {
            let path = item.contains("::") && item.chars().all(|c| c.is_alphanumeric() || "_:".contains(c));
            let carries = glossary && item.starts_with(char::is_uppercase) && item.chars().any(char::is_lowercase);
            if (path || carries) && !item.split("::").all(|word| words.contains(word)) {
                missing.push(format!("{}: {item}", name(&file)));
            }
        }
    }
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}
