//! `docs/equations.md` has every numbered equation of the paper and both tables once, and every file and item it names
//! is there.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Numbered equations of the paper.
const EQUATIONS: usize = 45;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn page() -> String {
    std::fs::read_to_string(repository().join("docs/equations.md")).unwrap()
}

/// Cells of each row: number, what it says, where, remark.
fn rows(page: &str) -> Vec<[&str; 4]> {
    page.lines()
        .filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |"))
        .map(|line| line.split(" | ").collect::<Vec<_>>())
        .filter(|cells| cells[0].parse::<usize>().is_ok() || cells[0].starts_with("Table "))
        .map(|cells| <[&str; 4]>::try_from(cells).unwrap_or_else(|cells| panic!("{cells:?} has not four cells")))
        .collect()
}

/// Files of a cell, from the repository's root, each with the items named behind it.
fn named(cell: &str) -> Vec<(String, Vec<&str>)> {
    let link = |part: &str| {
        part.split_once("](")
            .and_then(|(_, rest)| Some(rest.split_once(')')?.0.to_owned()))
    };
    cell.split("; ")
        .filter_map(|part| {
            let file = link(part)?.strip_prefix("../")?.to_owned();
            let items = part.split('`').skip(1).step_by(2).collect();
            Some((file, items))
        })
        .collect()
}

/// Whether `source` defines `name` after one of `keywords`, as a whole word.
fn defines(source: &str, keywords: &[&str], name: &str) -> bool {
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    keywords.iter().any(|keyword| {
        let declared = format!("{keyword} {name}");
        source.match_indices(&declared).any(|(at, _)| {
            let begins = source[..at]
                .chars()
                .next_back()
                .is_none_or(|c| c.is_whitespace() || c == '(');
            begins && ends(&source[at + declared.len()..])
        })
    })
}

/// Whether `source` implements something for `name`, or for a reference or generic of it.
fn implements(source: &str, name: &str) -> bool {
    source.lines().any(|line| {
        line.starts_with("impl")
            && line
                .split(|c: char| !c.is_alphanumeric() && c != '_')
                .any(|word| word == name)
    })
}

/// `function`, `Type`, `Type::function` or `Type.field`.
fn has_item(source: &str, item: &str) -> bool {
    const TYPES: [&str; 4] = ["struct", "enum", "trait", "type"];
    let is_type = |name: &str| defines(source, &TYPES, name) || implements(source, name);
    if let Some((owner, function)) = item.split_once("::") {
        return is_type(owner) && defines(source, &["fn", "const"], function);
    }
    if let Some((owner, field)) = item.split_once('.') {
        return defines(source, &["struct"], owner)
            && source.lines().any(|line| {
                let line = line.trim_start();
                let name = line.trim_start_matches("pub(crate) ").trim_start_matches("pub ");
                name.starts_with(&format!("{field}: "))
            });
    }
    defines(source, &TYPES, item) || defines(source, &["fn", "const", "static"], item)
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Source files of the workspace's crates that have `item`, to tell where it went.
fn elsewhere(item: &str) -> Vec<String> {
    let mut files = Vec::new();
    for member in std::fs::read_dir(repository().join("crates")).unwrap() {
        sources(&member.unwrap().path().join("src"), &mut files);
    }
    files
        .into_iter()
        .filter(|file| has_item(&std::fs::read_to_string(file).unwrap(), item))
        .map(|file| file.strip_prefix(repository()).unwrap_or(&file).display().to_string())
        .collect()
}

#[test]
fn every_equation_and_both_tables_stand_there_once() {
    let page = page();
    let mut count = BTreeMap::new();
    for [number, ..] in rows(&page) {
        *count.entry(number.to_owned()).or_insert(0) += 1;
    }
    let wanted = (1..=EQUATIONS)
        .map(|number| number.to_string())
        .chain(["Table 1".into(), "Table 2".into()]);
    assert_eq!(count, wanted.map(|number| (number, 1)).collect());
}

#[test]
fn each_has_its_place_or_the_reason_why_not() {
    let page = page();
    for [number, what, place, remark] in rows(&page) {
        assert!(!what.trim().is_empty(), "Eq. {number} does not say what it is");
        let files = named(place);
        assert!(
            files.iter().all(|(_, items)| !items.is_empty()),
            "Eq. {number} names a file and nothing in it"
        );
        let explained = remark.starts_with("not used") && remark.len() > "not used: ".len();
        assert!(
            files.is_empty() == explained,
            "Eq. {number} must name a file and what in it, or say `not used` and why"
        );
    }
}

#[test]
fn every_file_and_item_named_exists() {
    let page = page();
    let mut missing = Vec::new();
    for [number, _, place, _] in rows(&page) {
        for (file, items) in named(place) {
            let source = std::fs::read_to_string(repository().join(&file)).unwrap_or_default();
            for item in items {
                if !has_item(&source, item) {
                    missing.push(format!(
                        "Eq. {number}: {item} is not in {file} but in {:?}",
                        elsewhere(item)
                    ));
                }
            }
        }
    }
    assert!(missing.is_empty(), "docs/equations.md:\n{}", missing.join("\n"));
}

#[test]
fn items_are_told_apart() {
    let source =
        "pub struct Beam {\n    pub length: f64,\n}\nimpl Beam {\n    pub fn mass(&self) {}\n}\nfn masses() {}\n";
    for there in ["Beam", "Beam::mass", "Beam.length", "masses"] {
        assert!(has_item(source, there), "{there}");
    }
    for absent in ["Bea", "Beam::masse", "Beam.mass", "mas", "Joint::mass"] {
        assert!(!has_item(source, absent), "{absent}");
    }
}
