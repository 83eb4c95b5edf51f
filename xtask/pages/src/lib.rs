//! The reference pages of the manual (Markdown), made from the table of topics, from the schema of the configuration, and
//! from the cases of verification and validation; and the rig page's rows and the columns of the Python package, made from
//! the table of figures.

mod columns;
mod configuration;
mod figures;
mod laws;
mod topics;
mod validation;

pub use columns::{FILE as COLUMNS_FILE, page as columns};
pub use configuration::page as configuration;
pub use figures::{FILE as FIGURES_FILE, page as figures};
pub use topics::page as topics;
pub use validation::{names as validation_names, page as validation};

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace('|', "\\|")
}
