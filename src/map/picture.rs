//! A map drawn: what every cell is, the boundary, how sure it is, and the runs that were made.

use flexdrill_plot::{Figure, Legend, Line, Panel};
use flexdrill_sweep::map::{Cell, Map, Start, Verdict};

/// Places in the palette, which differ for colour-blind readers and in grey: sky blue, vermilion, orange, dark grey.
const CLEAR: usize = 5;
const ALARM: usize = 1;
const DEPENDS: usize = 4;
const UNKNOWN: usize = 6;

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
            "Alarms of at least {} priority over {} and {}, {} s. {} {}",
            map.priority.name(),
            map.x.name,
            map.y.name,
            map.horizon,
            map.members_in_words(),
            map.tools_in_words()
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

/// The cells by what they are. Those that are not known are pale and crossed out, so that they differ from clear ones in
/// grey too.
fn cells(mut panel: Panel, map: &Map, of: impl Fn(&Cell) -> Option<Verdict>) -> Panel {
    let points = |verdict: Verdict| -> Vec<(f64, f64)> {
        let cells = map.cells.iter().filter(|cell| of(cell) == Some(verdict));
        cells.map(|cell| (cell.x, cell.y)).collect()
    };
    for (verdict, name, color) in [
        (Verdict::Clear, "clear", CLEAR),
        (Verdict::Alarm, "alarm", ALARM),
        (Verdict::DependsOnStart, "depends on the start", DEPENDS),
        (Verdict::Unknown, "a run failed", UNKNOWN),
    ] {
        let points = points(verdict);
        if !points.is_empty() {
            panel = panel.line(Line::new(name, points).cells(half(map)).color(color));
        }
    }
    let points = points(Verdict::NotKnown);
    if points.is_empty() {
        return panel;
    }
    let [across, up] = half(map);
    for (x, y) in &points {
        let cross = vec![(x - across, y - up), (x + across, y + up)];
        panel.lines.push(Line::new("", cross).color(UNKNOWN));
    }
    panel.line(Line::new("not known", points).pale_cells(half(map)).color(UNKNOWN))
}

fn together(map: &Map) -> Panel {
    let title = match map.starts[..] {
        [_] => "Alarms to be expected",
        _ => "From all starts",
    };
    let mut panel = cells(panel(map, title), map, |cell| Some(cell.verdict));
    panel = boundary(panel, map, |cell| cell.verdict == Verdict::Clear);
    let ran = |cell: &&Cell| cell.starts.iter().all(|start| start.state.was_run());
    runs(panel, map, "run from all", ran)
}

fn of_start(map: &Map, number: usize, start: Start) -> Panel {
    let title = match start {
        Start::Rest => "From rest",
        Start::Running => "From running",
    };
    let verdict = |cell: &Cell| cell.starts.get(number..=number).map(Verdict::of);
    let mut panel = cells(panel(map, title), map, verdict);
    panel = boundary(panel, map, |cell| verdict(cell) == Some(Verdict::Clear));
    let ran = |cell: &&Cell| cell.starts.get(number).is_some_and(|of| of.state.was_run());
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
