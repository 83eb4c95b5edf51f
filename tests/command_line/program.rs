//! The program, run to its end, and what it says.

use std::collections::BTreeMap;
use std::process::{Command, Output};

pub(crate) fn flexdrill(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap()
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// With one blank between words, wherever lines end.
pub(crate) fn unwrapped(bytes: &[u8]) -> String {
    let words: Vec<&str> = std::str::from_utf8(bytes).unwrap().split_whitespace().collect();
    words.join(" ")
}

/// A number of a row of a table.
pub(crate) fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column}: {}", row[column]))
}
