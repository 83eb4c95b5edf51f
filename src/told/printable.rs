//! Text of others, shown and not run.
//!
//! Names, reasons and topics come from the network, from bags and from logs. A terminal takes control characters in
//! them for commands: they can rewrite what stands above, hide an alarm, or turn the text around. So they are shown as
//! escapes.

use std::borrow::Cow;
use std::fmt::Write as _;

/// A text on one line, with whatever a terminal could act on as an escape such as `\u{1b}`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, false)
}

/// The same of a text of several lines, which stay lines.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, true)
}

fn escaped(text: &str, lines: bool) -> Cow<'_, str> {
    let shown = |c: char| (lines && c == '\n') || !acts(c);
    if text.chars().all(shown) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if shown(c) {
            out.push(c);
        } else {
            // Writing to a string does not fail.
            let _ = write!(out, "{}", c.escape_default());
        }
    }
    Cow::Owned(out)
}

/// Whether a terminal does something else than showing the character.
fn acts(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            // Direction marks, embeddings, overrides and isolates; line and paragraph separators; what takes no room.
            '\u{061c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_text_stays_as_it_is() {
        for text in ["", "rig_7/weight_on_bit", "Bohrgestänge 40 r/min ± 2 °, 钻柱"] {
            assert!(matches!(printable(text), Cow::Borrowed(same) if same == text));
        }
    }

    #[test]
    fn what_a_terminal_would_act_on_is_shown() {
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
