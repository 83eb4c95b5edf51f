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
