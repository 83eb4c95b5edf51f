//! `flexdrill reference`: pages of the manual that are made from the program itself, and held to it by a test.

mod configuration;
mod topics;

use crate::cli::output::say_text;
use clap::{Args, ValueEnum};

/// Print a reference page of the manual (Markdown): every topic with its fields, or every key of the configuration.
#[derive(Debug, Args)]
pub(super) struct ReferenceArgs {
    /// Which page.
    page: Page,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Page {
    /// Topics, message types, fields with their units.
    Topics,
    /// Keys with type, default, bounds and meaning.
    Configuration,
}

pub(super) fn run(args: &ReferenceArgs) {
    say_text!(
        "{}",
        match args.page {
            Page::Topics => topics::page(),
            Page::Configuration => configuration::page(),
        }
    );
}

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace('|', "\\|")
}
