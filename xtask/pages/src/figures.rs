//! TypeScript source of the rows that the rig page shows, from the table of figures.

use std::fmt::Write as _;

use flexdrill_outputs::figures::TRANSFER;

/// The file in the page's sources.
pub const FILE: &str = "crates/flexdrill-dashboard/web/src/figures.ts";

/// Rows of `twin/transfer` with group, label, field and kind of unit, in the order of the page.
pub fn page() -> String {
    let mut out = String::from(concat!(
        "// Written by `cargo xtask reference figures` from the table of figures. Do not edit.\n\n",
        "/** Figures of `twin/transfer` that tables show. Figures of two groups with one label share a row. */\n",
        "export const TRANSFER = [\n",
    ));
    for figure in TRANSFER {
        let Some(shown) = figure.shown else { continue };
        let [group, kind] =
            [format!("{:?}", shown.group), format!("{:?}", figure.kind)].map(|name| name.to_lowercase());
        let (label, field) = (capital(shown.short), figure.field);
        let _ = writeln!(
            out,
            "  {{ group: {group:?}, label: {label:?}, field: {field:?}, kind: {kind:?} }},"
        );
    }
    out.push_str("] as const;\n");
    out
}

/// A label begins its row with a capital letter.
fn capital(label: &str) -> String {
    let mut letters = label.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
