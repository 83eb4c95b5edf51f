//! A map drawn: what every cell is, the boundary, how sure it is, and the runs that were made.

use flexdrill_plot::{Figure, Legend, Line, Panel};
use flexdrill_sweep::map::{Cell, Map, Start, State, Verdict};

/// Places in the palette, which differ for colour-blind readers and in grey: sky blue, vermilion, orange, dark grey.
const CLEAR: usize = 5;
const ALARM: usize = 1;
const DEPENDS: usize = 4;
const UNKNOWN: usize = 6;
/// Confidence below which a cell is drawn pale: what a 95 % interval is.
const SURE: f64 = 0.95;

/// Above the panels of single starts: all starts together.
pub fn figure(map: &Map) -> Figure {
    let mut panels = vec![together(map).span(map.starts.len().max(1))];
    for (number, start) in map.starts.iter().enumerate() {
        panels.push(of_start(map, number, *start));
    }
    Figure {
        name: "map",
        title: "Safe window".to_owned(),
        caption: format!(
            "Alarms of at least {} priority over {} and {}, {} s, {} members at most",
            map.priority.name(),
            map.x.name,
            map.y.name,
            map.horizon,
            map.members
        ),
        columns: map.starts.len().max(1),
        height: 480,
        panels,
    }
}

fn named(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} ({unit})")
    }
}

fn panel(map: &Map, title: &str) -> Panel {
    let [low, high] = map.x.range().unwrap_or([0.0, 1.0]);
    Panel::new(
        title,
        &named(&map.x.name, &map.x.unit),
        &named(&map.y.name, &map.y.unit),
    )
    .over(low, high)
    .legend(Legend::Row)
}

/// Half the width and half the height of a cell; of unequal ones the smallest, so that none covers another.
fn half(map: &Map) -> [f64; 2] {
    [&map.x.values, &map.y.values].map(|values| {
        let widths = values.windows(2).map(|pair| 0.5 * (pair[1] - pair[0]));
        widths.fold(f64::MAX, f64::min)
    })
}

/// Cells of one kind: those that are sure, and pale those that are not.
fn cells(mut panel: Panel, map: &Map, name: &str, color: usize, of: impl Fn(&Cell) -> Option<bool>) -> Panel {
    let points = |sure: bool| -> Vec<(f64, f64)> {
        let cells = map.cells.iter().filter(|cell| of(cell) == Some(sure));
        cells.map(|cell| (cell.x, cell.y)).collect()
    };
    let (sure, pale) = (points(true), points(false));
    let name = if sure.is_empty() && pale.is_empty() { "" } else { name };
    if sure.is_empty() {
        return panel.line(Line::new(name, pale).pale_cells(half(map)).color(color));
    }
    panel = panel.line(Line::new(name, sure).cells(half(map)).color(color));
    if pale.is_empty() {
        panel
    } else {
        panel.line(Line::new("", pale).pale_cells(half(map)).color(color))
    }
}

fn together(map: &Map) -> Panel {
    let title = match map.starts[..] {
        [_] => "Alarms to be expected",
        _ => "From all starts (pale: not sure at 95 %)",
    };
    let mut panel = panel(map, title);
    for (verdict, name, color) in [
        (Verdict::Clear, "clear", CLEAR),
        (Verdict::Alarm, "alarm", ALARM),
        (Verdict::DependsOnStart, "depends on the start", DEPENDS),
        (Verdict::Unknown, "unknown", UNKNOWN),
    ] {
        panel = cells(panel, map, name, color, |cell| {
            let sure = cell.starts.iter().map(|start| start.confidence).product::<f64>() >= SURE;
            (cell.verdict == verdict).then_some(sure || verdict == Verdict::Unknown)
        });
    }
    panel = boundary(panel, map, |cell| cell.verdict == Verdict::Clear);
    let ran = |cell: &&Cell| cell.starts.iter().all(|start| start.state != State::Inferred);
    runs(panel, map, "run from all", ran)
}

fn of_start(map: &Map, number: usize, start: Start) -> Panel {
    let title = match start {
        Start::Rest => "From rest",
        Start::Running => "From running",
    };
    let mut panel = panel(map, title);
    for (expected, name, color) in [(false, "clear", CLEAR), (true, "alarm", ALARM)] {
        panel = cells(panel, map, name, color, |cell| {
            let of = cell.starts.get(number)?;
            (of.expected == expected && (expected || !of.is_unknown())).then_some(of.confidence >= SURE)
        });
    }
    panel = cells(panel, map, "unknown", UNKNOWN, |cell| {
        let of = cell.starts.get(number)?;
        (of.is_unknown() && !of.expected).then_some(true)
    });
    panel = boundary(panel, map, |cell| {
        cell.starts
            .get(number)
            .is_some_and(|of| !of.expected && !of.is_unknown())
    });
    let ran = |cell: &&Cell| cell.starts.get(number).is_some_and(|of| of.state != State::Inferred);
    runs(panel, map, "run", ran)
}

fn runs(panel: Panel, map: &Map, name: &str, ran: impl Fn(&&Cell) -> bool) -> Panel {
    let points: Vec<(f64, f64)> = map.cells.iter().filter(ran).map(|cell| (cell.x, cell.y)).collect();
    panel.line(Line::new(name, points).dots().color(UNKNOWN))
}

/// The edges between clear cells and others.
fn boundary(mut panel: Panel, map: &Map, clear: impl Fn(&Cell) -> bool) -> Panel {
    let [across, up] = half(map);
    let (columns, rows) = (map.x.values.len(), map.y.values.len());
    let at = |column: usize, row: usize| map.cell(column, row).is_some_and(&clear);
    let mut edge = |from: (f64, f64), to: (f64, f64)| {
        panel.lines.push(Line::new("", vec![from, to]).color(UNKNOWN));
    };
    for row in 0..rows {
        for column in 0..columns {
            let (x, y) = (map.x.values[column], map.y.values[row]);
            if column + 1 < columns && at(column, row) != at(column + 1, row) {
                edge((x + across, y - up), (x + across, y + up));
            }
            if row + 1 < rows && at(column, row) != at(column, row + 1) {
                edge((x - across, y + up), (x + across, y + up));
            }
        }
    }
    panel
}
