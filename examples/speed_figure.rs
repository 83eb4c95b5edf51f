//! Draws the README's figure of speed from `benches/speed.csv`, whose lines are the "real-time factor" column of
//! `flexdrill bench --cases real-time --duration 60` on a quiet machine.
//!
//!     cargo run --release --example speed_figure -- docs/images/speed.svg

use anyhow::{Context as _, ensure};
use flexdrill_plot::{Figure, Legend, Line, Panel, svg};

/// Columns of the factors, and what they are called.
const CASES: [(&str, &str); 4] = [
    ("default", "default tool, 10 kN"),
    ("shared_30_kn", "shared weight, 30 kN"),
    ("contact_3e7_5e7", "contact 3e7 / 5e7 N/m"),
    ("soft_guide", "soft guide, 20 kN"),
];

fn main() -> anyhow::Result<()> {
    let path = std::env::args().nth(1).context("name the file to write")?;
    let source = "benches/speed.csv";
    let mut reader = csv::Reader::from_path(source).with_context(|| source.to_owned())?;
    let heads = reader.headers()?.clone();
    let place = |name: &str| {
        let found = heads.iter().position(|head| head == name);
        found.with_context(|| format!("{source}: no column {name}"))
    };
    let rows = reader.records().collect::<Result<Vec<_>, _>>()?;
    ensure!(!rows.is_empty(), "{source}: no rows");
    let version = place("version")?;
    let names: Vec<String> = rows
        .iter()
        .enumerate()
        .map(|(n, row)| format!("{} {}", n + 1, &row[version]))
        .collect();
    let axis = format!("version: {}", names.join(", "));
    let mut panel = Panel::new("Speed on one core", &axis, "times real time")
        .from_zero()
        .legend(Legend::Row);
    for (color, (column, name)) in CASES.iter().enumerate() {
        let column = place(column)?;
        let points = rows
            .iter()
            .enumerate()
            .map(|(n, row)| anyhow::Ok(((n + 1) as f64, row[column].parse()?)))
            .collect::<Result<Vec<(f64, f64)>, _>>()
            .with_context(|| format!("{source}: {name}"))?;
        panel = panel
            .line(Line::new(*name, points.clone()).color(color))
            .line(Line::new("", points).dots().color(color));
    }
    let figure = Figure {
        name: "speed",
        title: "Speed".to_owned(),
        caption: String::new(),
        columns: 1,
        height: 360,
        panels: vec![panel],
    };
    std::fs::write(&path, svg(&figure)?).with_context(|| path.clone())
}
