//! Figures with both runs.

use super::{Along, Comparison, Pair};
use crate::history::History;
use crate::plots::{Axis, ROW, figure, kn, rpm};
use crate::reading::Summary;
use flexdrill_plot::{Figure, Line, Panel};

/// Places in the palette: blue for A, orange for B.
const A: usize = 0;
const B: usize = 1;
/// Green: the difference.
const DIFFERENCE: usize = 2;

/// A panel's title, unit, factor, and how a summary holds its quantity.
type Over = (&'static str, &'static str, f64, fn(&Summary) -> &History);

fn over_time(comparison: &Comparison<'_>, name: &'static str, panels: &[Over]) -> Option<Figure> {
    let axis = Axis::over(comparison.a.seconds().max(comparison.b.seconds()));
    let drawn = panels.iter().map(|(title, unit, factor, of)| {
        let panel = axis.panel(title, unit);
        let panel = axis.draw(panel, "A", A, of(comparison.a), *factor);
        axis.draw(panel, "B", B, of(comparison.b), *factor)
    });
    figure(name, 2, ROW, drawn.collect())
}

/// Speeds and weights over time.
pub(crate) fn inputs(comparison: &Comparison<'_>) -> Option<Figure> {
    let panels: [Over; 4] = [
        ("Rotary speed, accepted", "r/min", rpm(), |s| {
            &s.drive.accepted.rotary_speed
        }),
        ("Weight on bit, accepted", "kN", kn(), |s| {
            &s.drive.accepted.weight_on_bit
        }),
        ("Rotary speed of the bit", "r/min", rpm(), |s| &s.drive.bit.rotary_speed),
        ("Weight at the bit", "kN", kn(), |s| &s.drive.bit.weight_on_bit),
    ];
    over_time(comparison, "inputs", &panels)
}

/// Torque and motion of the bit over time.
pub(crate) fn torque(comparison: &Comparison<'_>) -> Option<Figure> {
    let panels: [Over; 4] = [
        ("Torque at the uppermost joint", "N m", 1.0, |s| &s.drive.top_torque),
        ("Torque of the rock on the bit", "N m", 1.0, |s| &s.drive.bit_torque),
        ("Stick-slip index of the bit", "-", 1.0, |s| &s.drive.stick_slip),
        ("Lateral acceleration above the bit, largest", "m/s²", 1.0, |s| {
            &s.drive.lateral_acceleration
        }),
    ];
    over_time(comparison, "torque", &panels)
}

/// Quantities along the tool with their difference.
pub(crate) fn along(comparison: &Comparison<'_>) -> Option<Figure> {
    let panels = comparison.along.iter().map(panel).collect();
    figure("envelopes", 2, ROW, panels)
}

fn panel(along: &Along) -> Panel {
    let (unit, factor) = along.unit;
    let scaled = |curve: &[(f64, f64)]| curve.iter().map(|(depth, value)| (*depth, factor * value)).collect();
    let mut title = along.name.to_owned();
    if let Some(first) = title.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    let Pair { a, b } = &along.curves;
    Panel::new(title, "measured depth from the kick-off (m)", unit)
        .line(Line::new("A", scaled(a)).color(A))
        .line(Line::new("B", scaled(b)).color(B))
        .line(
            Line::new("B less A", scaled(&along.difference()))
                .dashed()
                .color(DIFFERENCE),
        )
}
