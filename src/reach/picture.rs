//! The results as a picture.

use flexdrill_core::units::n_to_kn;
use flexdrill_drilling::Band;
use flexdrill_plot::{Figure, Legend, Line, Panel};

use super::plausible::Arrives;
use super::table::{middle, rows_of};
use super::{Plan, Row};

/// Places in the palette: blue with rotation, orange without, green at the kick-off, dark grey for the closed form.
const WITH: usize = 0;
const WITHOUT: usize = 1;
const KICK_OFF: usize = 2;
const CLOSED: usize = 6;

/// Weight and torque against length, and the depth from which the tool buckles where it does; with 90 % of the plausible tools,
/// where they were run, as thin lines.
pub fn figure(plan: &Plan, rows: &[Row], plausible: &[Arrives]) -> Figure {
    let x = "length of the hole (m)";
    let mut weight = Panel::new("Weight at the bit", x, "kN")
        .from_zero()
        .legend(Legend::Stacked);
    for (rotates, name, color) in [(true, "with rotation", WITH), (false, "without rotation", WITHOUT)] {
        // A run that failed has no point on the curve; the table names it.
        let known = |row: &Row| Some(n_to_kn(row.found.as_ref().ok()?.weight[1]));
        weight = curve(weight, plan, rows, rotates, (name, color), known);
        let of = plausible.iter().filter(|of| of.rotates == rotates);
        weight = ends(
            weight,
            color,
            of.filter_map(|of| Some((of.length, of.weight?))),
            n_to_kn,
        );
    }
    let soft = |row: &Row| Some(n_to_kn(row.soft.weight_at_bit));
    weight = thin(weight, plan, rows, "soft string", soft);
    let mut torque = Panel::new("Torque with rotation", x, "N m")
        .from_zero()
        // Torque exists only with rotation: a tool that does not turn has none to transfer.
        .legend(Legend::Stacked);
    for (end, name, color) in [(0, "at the kick-off", KICK_OFF), (1, "at the bit", WITH)] {
        let known = move |row: &Row| Some(row.found.as_ref().ok()?.torque[end]);
        torque = curve(torque, plan, rows, true, (name, color), known);
        let of = plausible.iter().filter(|of| of.rotates);
        torque = ends(
            torque,
            color,
            of.filter_map(|of| Some((of.length, of.torque[end]?))),
            |of| of,
        );
    }
    torque = thin(torque, plan, rows, "soft string, both", |row| {
        Some(row.soft.torque_at_top)
    });
    torque = thin(torque, plan, rows, "", |row| Some(row.soft.torque_at_bit));
    let mut onset = Panel::new("Measured depth from which the tool buckles", x, "m")
        .from_zero()
        .legend(Legend::Stacked);
    for (name, color, at) in [
        ("guide, sideways", KICK_OFF, 0),
        ("chain of links, folded by torque", WITHOUT, 1),
    ] {
        let points: Vec<(f64, f64)> = rows
            .iter()
            // One friction, the middle one: with all of them the few points would not be read.
            .filter(|row| row.friction == middle(plan) && row.rotates)
            .filter_map(|row| {
                let found = row.found.as_ref().ok()?;
                Some((row.length, [found.guide_buckles_at, found.chain_folds_at][at]?))
            })
            .collect();
        if !points.is_empty() {
            onset = onset.line(Line::new(name, points).diamond().color(color));
        }
    }
    let mut panels = vec![weight, torque];
    // Without buckling there is no third panel, and two panels fill the width.
    if !onset.lines.is_empty() {
        panels.push(onset.span(2));
    }
    panels.retain(|panel| !panel.lines.is_empty());
    Figure {
        name: "reach",
        title: "Reach".to_owned(),
        caption: "Torque and weight at the bit against the length of the hole".to_owned(),
        columns: 2,
        height: 420,
        panels,
    }
}

/// A band over friction with the curve of the middle coefficient and its points.
fn curve(
    mut panel: Panel,
    plan: &Plan,
    rows: &[Row],
    rotates: bool,
    (name, color): (&str, usize),
    of: impl Fn(&Row) -> Option<f64>,
) -> Panel {
    let (mut low, mut high) = (Vec::new(), Vec::new());
    for &links in &plan.links {
        let known: Vec<(f64, f64)> = rows_of(rows, links, rotates)
            .filter_map(|row| Some((row.length, of(row)?)))
            .collect();
        // A band is drawn only where all coefficients are known.
        if let Some(&(length, _)) = known.first()
            && known.len() == plan.frictions.len()
            && known.len() > 1
        {
            low.push((length, known.iter().map(|point| point.1).fold(f64::MAX, f64::min)));
            high.push((length, known.iter().map(|point| point.1).fold(f64::MIN, f64::max)));
        }
    }
    if low.len() > 1 {
        let around = high.into_iter().chain(low.into_iter().rev()).collect();
        panel = panel.line(Line::new("", around).area().color(color));
    }
    let points = at_middle(plan, rows, rotates, of);
    if points.is_empty() {
        return panel;
    }
    if points.len() > 1 {
        panel = panel.line(Line::new("", points.clone()).color(color));
    }
    let (low, high) = (plan.frictions.first(), plan.frictions.last());
    let name = match (low, high) {
        (Some(low), Some(high)) if low < high => format!("{name}, friction {} ({low} to {high})", middle(plan)),
        _ => format!("{name}, friction {}", middle(plan)),
    };
    panel.line(Line::new(name, points).dots().color(color))
}

/// Ends of the bands of plausible tools.
fn ends(mut panel: Panel, color: usize, of: impl Iterator<Item = (f64, Band)>, unit: fn(f64) -> f64) -> Panel {
    let bands: Vec<(f64, Band)> = of.collect();
    if bands.len() < 2 {
        return panel;
    }
    for end in [|band: &Band| band.low, |band: &Band| band.high] {
        let points = bands.iter().map(|(length, band)| (*length, unit(end(band)))).collect();
        panel = panel.line(Line::new("", points).thin().color(color));
    }
    panel
}

/// The closed form at the middle coefficient.
fn thin(panel: Panel, plan: &Plan, rows: &[Row], name: &str, of: impl Fn(&Row) -> Option<f64>) -> Panel {
    let points = at_middle(plan, rows, true, of);
    if points.len() < 2 {
        return panel;
    }
    panel.line(Line::new(name, points).thin().color(CLOSED))
}

fn at_middle(plan: &Plan, rows: &[Row], rotates: bool, of: impl Fn(&Row) -> Option<f64>) -> Vec<(f64, f64)> {
    rows.iter()
        .filter(|row| row.friction == middle(plan) && row.rotates == rotates)
        .filter_map(|row| Some((row.length, of(row)?)))
        .collect()
}
