//! Prints a reference page; `cargo xtask reference` starts this program.

use std::io::Write as _;

use clap::{Parser, ValueEnum};

/// Prints a reference page of the manual (Markdown).
#[derive(Debug, Parser)]
#[command(name = "flexdrill-pages")]
struct Arguments {
    /// Which page.
    page: Page,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Page {
    /// Topics, message types, fields with their units.
    Topics,
    /// Keys with type, default, bounds and meaning.
    Configuration,
    /// Figures from outside and closed forms, with what the twin computes.
    Validation,
    /// Rows of the rig page (TypeScript).
    Figures,
    /// Columns of the figures in the Python package (Python).
    Columns,
}

fn main() -> std::io::Result<()> {
    let page = match Arguments::parse().page {
        Page::Topics => flexdrill_pages::topics(),
        Page::Configuration => flexdrill_pages::configuration(),
        Page::Validation => flexdrill_pages::validation().map_err(std::io::Error::other)?,
        Page::Figures => flexdrill_pages::figures(),
        Page::Columns => flexdrill_pages::columns(),
    };
    std::io::stdout().write_all(page.as_bytes())
}
