//! The charts: the bit over time, the whirling stations, the forces along the tool.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Block, Borders, Cell, Chart, Dataset, GraphType, Row, Sparkline, Table};

use super::{BAD, DOUBTFUL, GOOD};
use crate::cli::watch::board::{Board, HISTORY};
use crate::cli::watch::profile::binned;
use crate::cli::watch::texts;
use crate::messages::WhirlState;
use flexdrill_core::units::{rad_per_s_to_rpm, rad_to_deg};
use flexdrill_outputs::words;

pub(super) fn draw_bit(frame: &mut Frame, board: &Board, area: Rect) {
    let title = board.bit().map_or_else(
        || " bit ".to_owned(),
        |bit| {
            format!(
                " bit {:.1} r/min {:.0} N m ",
                rad_per_s_to_rpm(bit.rotary_speed),
                bit.torque
            )
        },
    );
    let history = board.history();
    // Time ends at the newest point and not at now: a twin that stands still keeps its picture.
    let end = history.back().map_or(0.0, |point| point.time);
    let speed: Vec<(f64, f64)> = history
        .iter()
        .map(|point| (point.time - end, point.speed_rpm))
        .collect();
    let (low, high) = axis_range(history.iter().map(|point| point.speed_rpm));
    // The torque has its own scale: the share of its range, drawn into the speed's.
    let (torque_low, torque_high) = axis_range(history.iter().map(|point| point.torque));
    let scale = (high - low) / (torque_high - torque_low);
    let torque: Vec<(f64, f64)> = history
        .iter()
        .map(|point| (point.time - end, low + (point.torque - torque_low) * scale))
        .collect();
    let line = |name: String, data, color| {
        Dataset::default()
            .name(name)
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .style(color)
            .data(data)
    };
    let chart = Chart::new(vec![
        line(
            format!("N m {torque_low:.0}..{torque_high:.0}"),
            &torque,
            Color::Magenta,
        ),
        line("r/min".to_owned(), &speed, Color::Cyan),
    ])
    .block(Block::bordered().title(title))
    // The legend may cover most of a small chart, because without it the two scales cannot be read.
    .hidden_legend_constraints((Constraint::Percentage(80), Constraint::Percentage(50)))
    .x_axis(
        Axis::default()
            .bounds([-HISTORY, 0.0])
            .labels([format!("-{HISTORY:.0} s"), "now".to_owned()]),
    )
    .y_axis(
        Axis::default()
            .bounds([low, high])
            .labels([format!("{low:.0}"), format!("{high:.0}")]),
    );
    frame.render_widget(chart, area);
}

/// A little more than the values' range, on whole numbers.
fn axis_range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::MAX, f64::MIN), |(low, high), value| {
            (low.min(value), high.max(value))
        });
    if low > high {
        (0.0, 1.0)
    } else {
        ((low - 0.5).floor(), (high + 0.5).ceil())
    }
}

pub(super) fn draw_whirl(frame: &mut Frame, board: &Board, area: Rect) {
    let title = board.whirl().map_or_else(
        || " whirl ".to_owned(),
        |whirl| format!(" {} ", texts::whirl_counts(whirl)),
    );
    let rows = board
        .whirl()
        .map(texts::whirl_rows)
        .unwrap_or_default()
        .into_iter()
        .map(|row| {
            let color = match row.kind {
                WhirlState::FORWARD => DOUBTFUL,
                WhirlState::BACKWARD | WhirlState::CHAOTIC => BAD,
                _ => GOOD,
            };
            Row::new([
                Cell::from(row.location),
                Cell::from(Span::styled(row.word, color)),
                Cell::from(ratio(row.ratio)),
                Cell::from(format!("{:4.2}", row.clearance_ratio)),
                Cell::from(format!("{:3.0}%", 100.0 * row.contact_duty)),
                Cell::from(format!("{:4.2}", row.confidence)),
            ])
        });
    let widths = [9, 8, 6, 4, 4, 4].map(Constraint::Length);
    let header = Row::new(["deg body", "whirl", " ratio", " gap", "cont", "conf"]).style(Modifier::DIM);
    let table = Table::new(rows, widths)
        .column_spacing(1)
        .header(header)
        .block(Block::bordered().title(title));
    frame.render_widget(table, area);
}

pub(super) fn draw_forces(frame: &mut Frame, board: &Board, area: Rect) {
    let inclination = board
        .contacts()
        .map(|contacts| contacts.inclination.as_slice())
        .unwrap_or_default();
    let ends = match (inclination.first(), inclination.last()) {
        (Some(first), Some(last)) => format!(
            " peak contact force of the last turns, from {:.0} deg (left) to {:.0} deg ",
            rad_to_deg(*first),
            rad_to_deg(*last)
        ),
        _ => " contact forces ".to_owned(),
    };
    let block = Block::new().borders(Borders::TOP).title(ends);
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let rows = Layout::vertical([
        Constraint::Length(1),
        Constraint::Fill(1),
        Constraint::Length(1),
        Constraint::Fill(1),
    ])
    .split(inner);
    let depth = board
        .contacts()
        .map(|contacts| contacts.measured_depth.as_slice())
        .unwrap_or_default();
    // Each layer has its own scale. A common one would flatten the weaker, and the largest force is written above.
    for (layer, color) in [Color::Cyan, Color::Magenta].into_iter().enumerate() {
        let text = format!("{}: largest {}", words::layer(layer), texts::largest(board, layer));
        frame.render_widget(Line::styled(text, color), rows[2 * layer]);
        let bars = binned(depth, board.peaks()[layer].forces(), usize::from(inner.width));
        // At least 1 N as the full height: noise of a tool without contact must not fill the chart.
        let largest = bars.iter().copied().fold(1.0, f64::max);
        let data: Vec<u64> = bars
            .iter()
            .map(|force| (1000.0 * force / largest).round() as u64)
            .collect();
        frame.render_widget(
            Sparkline::default().data(data).max(1000).style(color),
            rows[2 * layer + 1],
        );
    }
}

/// The whirl ratio, where there is one.
fn ratio(ratio: f64) -> String {
    if ratio.is_nan() {
        format!("{:>6}", "-")
    } else {
        format!("{ratio:6.2}")
    }
}
