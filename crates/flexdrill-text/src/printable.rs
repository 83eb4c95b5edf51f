//! Foreign text made safe for a terminal.
//!
//! Names, reasons and topics come from the network, from bags and from logs. A terminal executes control characters in
//! them: they can rewrite earlier lines, hide an alarm or reverse the text. These functions print them as escapes.

use std::borrow::Cow;
use std::fmt::Write as _;

/// A text on one line, with every character that a terminal would execute as an escape such as `\u{1b}`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, false)
}

/// As [`printable`], for a text of several lines: its line breaks remain.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, true)
}

/// A foreign text as a cell of a table: as [`printable_lines`], and with an apostrophe before what a spreadsheet would
/// compute, such as `=HYPERLINK(...)`. Numbers are no foreign text.
pub fn table_cell(text: &str) -> Cow<'_, str> {
    if text.starts_with(['=', '+', '-', '@']) {
        return Cow::Owned(format!("'{}", printable_lines(text)));
    }
    printable_lines(text)
}

/// Bytes as hexadecimal digits, two each.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn escaped(text: &str, lines: bool) -> Cow<'_, str> {
    let is_harmless = |c: char| (lines && c == '\n') || !is_executed(c);
    if text.chars().all(is_harmless) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_harmless(c) {
            out.push(c);
        } else {
            // Writing to a string does not fail.
            let _ = write!(out, "{}", c.escape_default());
        }
    }
    Cow::Owned(out)
}

/// Whether a terminal acts on the character instead of printing it.
fn is_executed(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            // Direction marks, embeddings, overrides and isolates; line and paragraph separators; zero-width characters.
            '\u{061c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_text_is_unchanged() {
        for text in ["", "rig_7/weight_on_bit", "Bohrgestänge 40 r/min ± 2 °, 钻柱"] {
            assert!(matches!(printable(text), Cow::Borrowed(same) if same == text));
        }
    }

    #[test]
    fn a_cell_of_a_table_is_text_for_a_spreadsheet() {
        assert_eq!(table_cell("=HYPERLINK(\"http://x\")"), "'=HYPERLINK(\"http://x\")");
        assert_eq!(table_cell("@a\x1b[2J\nb"), "'@a\\u{1b}[2J\nb");
        // A tab or a return before the sign would hide it.
        assert_eq!(table_cell("\t=1"), "\\t=1");
        assert_eq!(table_cell("shock"), "shock");
    }

    #[test]
    fn control_characters_become_escapes() {
        // Clears the screen, sets the title, hides a line, C1 control sequence, right-to-left override.
        assert_eq!(printable("a\x1b[2Jb"), "a\\u{1b}[2Jb");
        assert_eq!(printable("\x1b]0;owned\x07"), "\\u{1b}]0;owned\\u{7}");
        assert_eq!(printable("ok\r\nalarms none"), "ok\\r\\nalarms none");
        assert_eq!(printable("\u{9b}31m"), "\\u{9b}31m");
        assert_eq!(printable("\u{202e}gnp.exe"), "\\u{202e}gnp.exe");
        assert_eq!(printable("a\u{7f}\t"), "a\\u{7f}\\t");
        assert_eq!(printable_lines("one\ntwo\x1b[0m"), "one\ntwo\\u{1b}[0m");
    }
}
