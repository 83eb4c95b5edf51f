//! Writing the results of a run into a folder.

use std::path::Path;

use super::PaperError;
use super::figures::{Figure, csv, svg};
use super::findings::Finding;

fn write(path: &Path, bytes: &[u8]) -> Result<(), PaperError> {
    std::fs::write(path, bytes).map_err(|reason| PaperError::Write {
        path: path.to_path_buf(),
        reason: reason.to_string(),
    })
}

/// Draws figures and writes each as SVG and CSV; returns them with their drawings.
///
/// # Errors
/// When a figure cannot be drawn or a file cannot be written.
pub fn write_figures(folder: &Path, figures: Vec<Figure>) -> Result<Vec<(Figure, String)>, PaperError> {
    let mut drawn = Vec::with_capacity(figures.len());
    for figure in figures {
        let path = |extension: &str| folder.join(format!("{}.{extension}", figure.name));
        let drawing = svg(&figure)?;
        write(&path("svg"), drawing.as_bytes())?;
        write(&path("csv"), csv(&figure).as_bytes())?;
        drawn.push((figure, drawing));
    }
    Ok(drawn)
}

/// Writes a text.
///
/// # Errors
/// When the file cannot be written.
pub fn write_text(folder: &Path, name: &str, text: &str) -> Result<(), PaperError> {
    write(&folder.join(name), text.as_bytes())
}

/// Findings, a line each.
pub fn findings_csv(findings: &[Finding]) -> String {
    let mut out = String::from("key,figure,paper,ours,value,verdict,why,closeness\n");
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    for finding in findings {
        let cells = [
            finding.key.to_owned(),
            quoted(finding.figure),
            quoted(finding.paper),
            quoted(&finding.ours),
            format!("{:.7e}", finding.value),
            finding.verdict.word().to_owned(),
            quoted(&finding.why),
            format!("{:.4}", finding.closeness),
        ];
        out.push_str(&cells.join(","));
        out.push('\n');
    }
    out
}
