//! The reference pages of the manual (Markdown), made from the table of topics and from the schema of the configuration.

mod configuration;
mod topics;

pub use configuration::page as configuration;
pub use topics::page as topics;

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace('|', "\\|")
}
