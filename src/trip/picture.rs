//! The results as a picture: hook load and torque over the depth of the bit.

use flexdrill_core::units::n_to_kn;
use flexdrill_plot::{Figure as Drawn, Legend, Line, Panel};

use super::{Figure, Row};

/// Places in the palette: orange out of the hole, blue into it, dark grey without friction.
const OUT: usize = 1;
const IN: usize = 0;
const WEIGHT: usize = 6;

/// Hook load without rotation and with it, and torque with rotation.
pub fn figure(rows: &[Row]) -> Drawn {
    let x = "depth of the bit below the kick-off (m)";
    // Out and in with their bands, around the weight that both would have without friction.
    let hook = |title: &str, figures: [(Figure, &str, usize); 2]| {
        let panel = Panel::new(title, x, "hook load without block (kN)").legend(Legend::Stacked);
        let panel = figures.into_iter().fold(panel, |panel, of| curve(panel, rows, of));
        let weight: Vec<(f64, f64)> = rows
            .iter()
            .filter(|row| row.weight.is_finite())
            .map(|row| (row.depth, n_to_kn(row.weight)))
            .collect();
        panel.line(
            Line::new("weight in mud, without friction", weight)
                .thin()
                .color(WEIGHT),
        )
    };
    // A tool that does not turn has no torque.
    let torque = [
        (Figure::OutTorque, "pulling out", OUT),
        (Figure::InTorque, "running in", IN),
    ];
    let torque = torque.into_iter().fold(
        Panel::new("Torque with rotation, off bottom", x, "N m")
            .from_zero()
            .legend(Legend::Stacked)
            .span(2),
        |panel, of| curve(panel, rows, of),
    );
    let mut panels = vec![
        hook(
            "Without rotation",
            [(Figure::Out, "pulling out", OUT), (Figure::In, "running in", IN)],
        ),
        hook(
            "With rotation",
            [
                (Figure::OutTurning, "pulling out", OUT),
                (Figure::InTurning, "running in", IN),
            ],
        ),
        torque,
    ];
    // A trip without results has no curves.
    panels.retain(|panel| !panel.lines.is_empty());
    Drawn {
        name: "trip",
        title: "Trip loads".to_owned(),
        caption: "Hook load and torque over the depth of the bit, with 90 % of the plausible tools".to_owned(),
        columns: 2,
        height: 420,
        panels,
    }
}

/// The band of the plausible tools and the curve of the tool as configured.
fn curve(mut panel: Panel, rows: &[Row], (figure, name, color): (Figure, &str, usize)) -> Panel {
    let shown = |value: f64| match figure.is_torque() {
        true => value,
        false => n_to_kn(value),
    };
    let ends = || rows.iter().filter_map(|row| Some((row.depth, row.band(figure)?)));
    let low: Vec<(f64, f64)> = ends().map(|(depth, band)| (depth, shown(band.low))).collect();
    if low.len() > 1 {
        let high = ends().map(|(depth, band)| (depth, shown(band.high)));
        let around = high.chain(low.into_iter().rev()).collect();
        panel = panel.line(Line::new("", around).area().color(color));
    }
    let points: Vec<(f64, f64)> = rows
        .iter()
        .filter_map(|row| Some((row.depth, shown(row.figure(figure)?))))
        .collect();
    if points.is_empty() {
        return panel;
    }
    panel.line(Line::new(name, points).color(color))
}
