//! Python source of the columns that the figures have in a recording, from the table of figures.

use std::fmt::Write as _;

use flexdrill_messages::Message;
use flexdrill_outputs::figures::{BIT_STATE, Figure, TRANSFER};

/// The file in the Python package.
pub const FILE: &str = "crates/flexdrill-python/python/flexdrill/_figures.py";
/// Longest line of Python sources.
const WIDTH: usize = 120;
/// Before a field of a class, and before its text.
const INDENT: &str = "    ";

/// A class for each group, with a field for each figure: name and text.
pub fn page() -> String {
    let mut out = String::from(concat!(
        "\"\"\"Written by `cargo xtask reference columns` from the table of figures. Do not edit.\"\"\"\n\n",
        "from __future__ import annotations\n\n",
        "from dataclasses import dataclass\n",
        "from typing import Generic, TypeVar\n\n",
        "F = TypeVar(\"F\")\n",
        "\"\"\"A number of one instant, or an array of numbers over time.\"\"\"\n",
    ));
    class(
        &mut out,
        "BitFigures",
        "Figures of `twin/bit_state`. The publishing interval is the time since the sample before.",
        BIT_STATE,
    );
    class(
        &mut out,
        "TransferFigures",
        "Figures of `twin/transfer`: means over the sliding window `transfer.window`, in which every step counts. NaN \
         where the tool has no such figure.",
        TRANSFER,
    );
    out
}

fn class<M: Message>(out: &mut String, name: &str, text: &str, table: &[Figure<M>]) {
    // Writing to a string does not fail.
    let _ = write!(
        out,
        "\n\n@dataclass(frozen=True)\nclass {name}(Generic[F]):\n{}\n",
        quoted(text)
    );
    // In the order of the message, because a sentence may refer to the field before.
    let lines: Vec<&str> = M::INFO.source().lines().collect();
    let place = |figure: &&Figure<M>| {
        lines
            .iter()
            .position(|line| line.split(' ').nth(1) == Some(figure.field))
    };
    let mut figures: Vec<&Figure<M>> = table.iter().collect();
    figures.sort_by_key(place);
    for figure in figures {
        let _ = write!(out, "{INDENT}{}: F\n{}", figure.column(), quoted(&figure.text()));
    }
}

/// A documenting string in lines of at most [`WIDTH`] characters.
fn quoted(text: &str) -> String {
    let quoted = format!("\"\"\"{text}\"\"\"");
    let mut out = String::new();
    let mut column = 0;
    for word in quoted.split_whitespace() {
        let length = word.chars().count();
        if column == 0 || column + 1 + length > WIDTH {
            if column > 0 {
                out.push('\n');
            }
            out.push_str(INDENT);
            column = INDENT.len() + length;
        } else {
            out.push(' ');
            column += 1 + length;
        }
        out.push_str(word);
    }
    out.push('\n');
    out
}
