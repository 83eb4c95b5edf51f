//! The checked-in reference pages are those of this version.

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
