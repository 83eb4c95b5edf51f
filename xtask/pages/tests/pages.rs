//! The checked-in reference pages are those of this version.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::path::Path;

fn check(name: &str, page: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../docs/{name}.md"));
    let checked_in = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        checked_in == page,
        "docs/{name}.md is old: run cargo xtask reference {name} > docs/{name}.md"
    );
}

#[test]
fn the_page_of_the_topics_is_that_of_this_version() {
    check("topics", &flexdrill_pages::topics());
}

#[test]
fn the_page_of_the_configuration_is_that_of_this_version() {
    check("configuration", &flexdrill_pages::configuration());
}

/// Compares a source that is written from the table of figures.
fn check_source(file: &str, name: &str, source: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
    let checked_in = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        checked_in == source,
        "{file} is old: run cargo xtask reference {name} > {file}"
    );
}

#[test]
fn the_rows_of_the_rig_page_are_those_of_the_table() {
    check_source(flexdrill_pages::FIGURES_FILE, "figures", &flexdrill_pages::figures());
}

#[test]
fn the_columns_of_the_python_package_are_those_of_the_table() {
    check_source(flexdrill_pages::COLUMNS_FILE, "columns", &flexdrill_pages::columns());
}

/// Names of all tests that begin with `prefix`, in every source of the workspace.
fn tests_named(prefix: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut folders: Vec<_> = ["src", "tests", "crates", "xtask", "benches"]
        .map(|name| root.join(name))
        .into();
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let names = text.lines().filter_map(|line| line.trim().strip_prefix("fn "));
                let names = names.filter_map(|line| line.split_once("()").map(|(name, _)| name));
                found.extend(names.filter(|name| name.starts_with(prefix)).map(str::to_owned));
            }
        }
    }
    found.sort();
    found
}

/// Wherever a test against a figure from outside or of a law against a closed form stands, the page has it with at least
/// one figure, and the page has no other.
#[test]
fn every_test_against_an_outside_figure_is_on_the_page() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation.md");
    let page = std::fs::read_to_string(path).unwrap();
    let entries: Vec<&str> = page.split("\n### ").skip(1).collect();
    for prefix in ["val_", "analytic_"] {
        let of_prefix = entries.iter().filter(|entry| entry.starts_with(prefix));
        let mut listed: Vec<&str> = of_prefix.clone().filter_map(|entry| entry.lines().next()).collect();
        listed.sort_unstable();
        let tests = tests_named(prefix);
        assert!(!tests.is_empty());
        assert_eq!(
            listed, tests,
            "run cargo xtask reference validation > docs/validation.md"
        );
        for entry in of_prefix {
            let table = entry.split("|---|---|---|---|---|\n").nth(1).unwrap_or_default();
            assert!(table.starts_with("| "), "{entry}");
        }
    }
    // Figures of our own are not on it.
    let own = tests_named("regress_");
    assert!(!own.is_empty() && own.iter().all(|name| !page.contains(&format!("### {name}"))));
}

/// Its figures take a minute to compute, and are rounded; the cases that it lists are compared.
#[test]
fn the_page_of_the_validation_lists_the_cases_of_this_version() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    let listed: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("### ")).collect();
    assert!(
        listed == flexdrill_pages::validation_names(),
        "docs/validation.md is old: run cargo xtask reference validation > docs/validation.md"
    );
}
