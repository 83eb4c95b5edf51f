//! Draws the figure of the README: how much faster than real time each case runs, by version, from `benches/speed.csv`.
//!
//!     cargo xtask figure speed docs/images/speed.svg
//!
//! The rows of one processor are drawn, the last one named in the file. Each is a factor that `flexdrill bench --cases
//! real-time` of that commit printed.

use std::path::Path;

use anyhow::{Context as _, ensure};
use flexdrill_plot::{Figure, Line, Panel, svg};

/// A measured factor.
#[derive(serde::Deserialize)]
struct Row {
    version: String,
    processor: String,
    case: String,
    factor: f64,
}

/// # Errors
/// When the table cannot be read or the file not be written.
pub(crate) fn draw(to: &Path) -> anyhow::Result<()> {
    let from = "benches/speed.csv";
    let mut rows: Vec<Row> = csv::Reader::from_path(from)?
        .deserialize()
        .collect::<Result<_, _>>()
        .with_context(|| format!("{from}: a row that cannot be read"))?;
    // Factors of different machines cannot be compared, so the newest row decides on one.
    let processor = rows.last().context("no rows")?.processor.clone();
    rows.retain(|row| row.processor == processor);
    // In the order of the table, which is that of time.
    let (mut versions, mut cases) = (Vec::<&str>::new(), Vec::<&str>::new());
    for row in &rows {
        for (list, name) in [(&mut versions, &row.version), (&mut cases, &row.case)] {
            if !list.contains(&name.as_str()) {
                list.push(name);
            }
        }
    }
    // A missing case would draw a bar of nothing, which reads as a factor of zero.
    ensure!(
        rows.len() == versions.len() * cases.len(),
        "{from}: not every version has every case on {processor}"
    );
    let mut panel = Panel::new(
        format!("Times faster than real time, one core of {processor}, step 0.5 ms"),
        "",
        "real-time factor",
    )
    .named(cases.iter().map(|case| (*case).to_owned()).collect())
    .from_zero();
    for version in &versions {
        let points = rows.iter().filter(|row| row.version == *version).filter_map(|row| {
            let case = cases.iter().position(|case| *case == row.case)? as f64;
            Some((case, row.factor))
        });
        panel = panel.line(Line::new(*version, points.collect()).bars());
    }
    let figure = Figure {
        name: "speed",
        title: String::new(),
        caption: String::new(),
        height: 330,
        columns: 1,
        panels: vec![panel],
    };
    std::fs::write(to, svg(&figure)?).with_context(|| format!("{}: cannot be written", to.display()))
}
