//! Sections of a document that a measurement writes, between their markers.

use std::path::Path;

use anyhow::{Context as _, bail};

/// The lines that enclose a section which a measurement writes.
fn markers(name: &str) -> (String, String) {
    (
        format!("<!-- flexdrill bench {name}: begin -->"),
        format!("<!-- flexdrill bench {name}: end -->"),
    )
}

/// `document` with `text` between the markers of `name`; `None` if it has no such markers.
fn replaced(document: &str, name: &str, text: &str) -> Option<String> {
    let (begin, end) = markers(name);
    let from = document.find(&begin)? + begin.len();
    let to = from + document[from..].find(&end)?;
    Some(format!(
        "{}\n{}\n{}",
        &document[..from],
        text.trim_end(),
        &document[to..]
    ))
}

/// Whether `path` can be written to: known before a run of minutes, not after it.
///
/// # Errors
/// When the file cannot be read or has no markers for `name`.
pub(crate) fn check(path: &Path, name: &str) -> anyhow::Result<()> {
    let document = std::fs::read_to_string(path).with_context(|| format!("{} cannot be read", path.display()))?;
    if replaced(&document, name, "").is_none() {
        let (begin, end) = markers(name);
        bail!(
            "{} has no place for these figures: add the lines `{begin}` and `{end}` where they are to stand",
            path.display()
        );
    }
    Ok(())
}

/// Writes `text` between the markers of `name`.
///
/// # Errors
/// As [`check`], and when the file cannot be written.
pub(crate) fn write(path: &Path, name: &str, text: &str) -> anyhow::Result<()> {
    check(path, name)?;
    let document = std::fs::read_to_string(path)?;
    let document = replaced(&document, name, text).unwrap_or(document);
    std::fs::write(path, document).with_context(|| format!("{} cannot be written", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_markers_changes() {
        let (begin, end) = markers("speed");
        let document = format!("before\n{begin}\nold\n{end}\nafter\n");
        let new = replaced(&document, "speed", "new\n").unwrap();
        assert_eq!(new, format!("before\n{begin}\nnew\n{end}\nafter\n"));
        assert_eq!(replaced(&new, "speed", "old").unwrap(), document);
        assert_eq!(replaced(&document, "memory", "x"), None);
    }
}
