//! The dashboard as a full screen. Made for 80 x 24; what is larger gets more chart, what is smaller loses the lower
//! blocks first.

use std::time::{Duration, Instant};

use ratatui::Frame;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Block, Borders, Cell, Chart, Dataset, GraphType, Paragraph, Row, Sparkline, Table, Wrap};

use super::board::{Board, HISTORY};
use super::profile::binned;
use super::texts;
use crate::messages::{TwinStatus, WhirlState, WhirlWarning, words};
use flexdrill_core::units::{rad_per_s_to_rpm, rad_to_deg};
use flexdrill_realtime::KEEPS_UP;

const GOOD: Color = Color::Green;
const DOUBTFUL: Color = Color::Yellow;
const BAD: Color = Color::Red;

/// Waits up to `patience` for a key and says whether it means to quit. A resize is an event too: the next picture has
/// the new size by itself.
pub(super) fn quit_pressed(patience: Duration) -> std::io::Result<bool> {
    if !event::poll(patience)? {
        return Ok(false);
    }
    let Event::Key(key) = event::read()? else {
        return Ok(false);
    };
    let control_c = key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
    let quit = control_c || matches!(key.code, KeyCode::Char('q' | 'Q') | KeyCode::Esc);
    Ok(key.kind != KeyEventKind::Release && quit)
}

pub(super) fn draw(frame: &mut Frame, board: &Board, now: Instant) {
    let [title, warning, levels, top, middle, bottom] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(2),
        Constraint::Length(1),
        Constraint::Length(6),
        Constraint::Min(7),
        Constraint::Length(7),
    ])
    .areas(frame.area());
    frame.render_widget(title_line(board, now), title);
    frame.render_widget(warning_lines(board.warning()), warning);
    frame.render_widget(levels_line(board), levels);
    let [left, right] = Layout::horizontal([Constraint::Percentage(50); 2]).areas(top);
    frame.render_widget(inputs(board), left);
    frame.render_widget(pace(board), right);
    let [left, right] = Layout::horizontal([Constraint::Percentage(46), Constraint::Percentage(54)]).areas(middle);
    draw_bit(frame, board, left);
    draw_whirl(frame, board, right);
    draw_forces(frame, board, bottom);
}

fn title_line(board: &Board, now: Instant) -> Line<'static> {
    if let Some(text) = texts::heartbeat(board, now) {
        let style = Style::new().fg(Color::White).bg(BAD).add_modifier(Modifier::BOLD);
        return Line::styled(format!(" {text}   q quits "), style);
    }
    let Some(status) = board.status() else {
        return Line::default();
    };
    let recording = match status.recording_state {
        TwinStatus::RECORDING_ON => Span::styled("  recording", GOOD),
        TwinStatus::RECORDING_FAILED => Span::styled("  RECORDING FAILED", BAD),
        _ => Span::default(),
    };
    let color = match status.state {
        TwinStatus::RUNNING => GOOD,
        TwinStatus::FAILED => BAD,
        _ => DOUBTFUL,
    };
    Line::from(vec![
        Span::styled(" flexdrill ", Modifier::BOLD),
        Span::styled(texts::state(status.state), color),
        Span::raw(format!("  model time {:.1} s", status.model_time)),
        recording,
        Span::raw("   q quits"),
    ])
}

fn warning_lines(warning: Option<&WhirlWarning>) -> Paragraph<'static> {
    Paragraph::new(texts::warning(warning))
        .style(severity_style(
            warning.map_or(WhirlWarning::OK, |warning| warning.severity),
        ))
        .wrap(Wrap { trim: true })
}

fn severity_style(severity: u8) -> Style {
    match severity {
        WhirlWarning::OK => Style::new().fg(GOOD),
        WhirlWarning::WATCH => Style::new().fg(DOUBTFUL),
        WhirlWarning::WARNING => Style::new().fg(Color::Black).bg(DOUBTFUL),
        _ => Style::new().fg(Color::White).bg(BAD).add_modifier(Modifier::BOLD),
    }
}

/// The levels beside whirl's.
fn levels_line(board: &Board) -> Line<'static> {
    let levels = [
        ("stick-slip ", board.bit().map(texts::stick_slip)),
        ("   shock ", board.contacts().map(texts::shock)),
    ];
    let spans = levels.into_iter().filter_map(|(name, level)| {
        let (text, severity) = level?;
        Some([Span::raw(name), Span::styled(text, severity_style(severity))])
    });
    Line::from(spans.flatten().collect::<Vec<_>>())
}

fn inputs(board: &Board) -> Paragraph<'static> {
    let mut lines = Vec::new();
    if let Some(status) = board.status() {
        for (text, state) in texts::inputs(status) {
            let color = match state {
                TwinStatus::INPUT_OK => GOOD,
                TwinStatus::INPUT_STALE | TwinStatus::INPUT_REJECTED => BAD,
                _ => DOUBTFUL,
            };
            lines.push(Line::styled(text, color));
        }
    }
    lines.push(Line::raw(texts::joints(board)));
    if board.unreadable() > 0 {
        lines.push(Line::styled(
            format!("{} unreadable messages: other version?", board.unreadable()),
            BAD,
        ));
    }
    Paragraph::new(lines)
        .wrap(Wrap { trim: true })
        .block(Block::bordered().title(" inputs as applied, joints "))
}

fn pace(board: &Board) -> Paragraph<'static> {
    let mut lines = Vec::new();
    if let Some(status) = board.status() {
        let color = if status.real_time_factor >= KEEPS_UP { GOOD } else { BAD };
        lines.push(Line::from(vec![
            Span::styled(format!("x{:.3} real time", status.real_time_factor), color),
            Span::raw(format!(", late {}", texts::short_time(status.lateness))),
        ]));
        lines.push(Line::raw(format!(
            "missed {} skipped {} steps",
            status.deadline_misses, status.steps_skipped
        )));
        lines.push(Line::raw(format!(
            "step {} p99 {} max {}",
            texts::short_time(status.step_time_p50),
            texts::short_time(status.step_time_p99),
            texts::short_time(status.step_time_max)
        )));
        lines.push(Line::raw(format!(
            "newton {:.1} halved {} energy {:.2} %",
            status.newton_iterations_mean,
            status.halved_steps,
            100.0 * status.energy_error_ratio
        )));
    }
    Paragraph::new(lines).block(Block::bordered().title(" pace and solver "))
}

fn draw_bit(frame: &mut Frame, board: &Board, area: Rect) {
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

fn draw_whirl(frame: &mut Frame, board: &Board, area: Rect) {
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
                Cell::from(row.place),
                Cell::from(Span::styled(row.word, color)),
                Cell::from(format!("{:6.2}", row.ratio)),
                Cell::from(format!("{:4.2}", row.clearance_ratio)),
                Cell::from(format!("{:3.0}%", 100.0 * row.contact_duty)),
                Cell::from(format!("{:4.2}", row.confidence)),
            ])
        });
    let widths = [9, 8, 6, 4, 4, 4].map(Constraint::Length);
    let header = Row::new(["deg of", "whirl", " ratio", " gap", " hit", "sure"]).style(Modifier::DIM);
    let table = Table::new(rows, widths)
        .column_spacing(1)
        .header(header)
        .block(Block::bordered().title(title));
    frame.render_widget(table, area);
}

fn draw_forces(frame: &mut Frame, board: &Board, area: Rect) {
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
    for (layer, color) in [Color::Cyan, Color::Magenta].into_iter().enumerate() {
        let text = format!("{}: largest {}", words::layer(layer), texts::largest(board, layer));
        frame.render_widget(Line::styled(text, color), rows[2 * layer]);
        let bars = binned(depth, board.peaks()[layer].forces(), usize::from(inner.width));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{BitState, ContactForces, JointDeflections};
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    fn full_board(now: Instant) -> Board {
        let mut board = Board::new(now);
        board.update_status(
            TwinStatus {
                state: TwinStatus::RUNNING,
                model_time: 12.5,
                real_time_factor: 0.91,
                input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
                input_state: vec![TwinStatus::INPUT_OK; 2],
                input_age: vec![0.1; 2],
                input_received: vec![4.2, 10e3],
                input_applied: vec![4.2, 10e3],
                input_rejected: vec![0; 2],
                ..TwinStatus::default()
            },
            now,
        );
        board.update_bit(BitState {
            rotary_speed: 4.2,
            torque: 92.0,
            stick_slip_index: 0.2,
            ..BitState::default()
        });
        board.update_joints(JointDeflections {
            joints_at_limit: 3,
            ..JointDeflections::default()
        });
        board.update_contacts(ContactForces {
            measured_depth: vec![0.0, 2.5, 5.0],
            inclination: vec![0.0, 0.785, 1.571],
            pipe_guide_normal_peak: vec![0.0, 1500.0, 10.0],
            guide_wall_normal_peak: vec![0.0, 0.0, 0.0],
            shock_severity: ContactForces::SHOCK_WARNING,
            shock_impulse: 16.3,
            shock_station: 1,
            shock_layer: ContactForces::INNER,
            ..ContactForces::default()
        });
        board.update_whirl(WhirlState {
            measured_depth: vec![2.5, 5.0],
            inclination: vec![0.785, 1.571],
            body: vec![WhirlState::PIPE, WhirlState::GUIDE],
            kind: vec![WhirlState::BACKWARD, WhirlState::NONE],
            whirl_ratio: vec![-3.7, 0.0],
            orbit_radius: vec![5e-3, 0.0],
            clearance_ratio: vec![1.0, 0.1],
            contact_duty: vec![0.4, 0.0],
            confidence: vec![0.9, 0.9],
            whirl_rate: vec![-15.0, 0.0],
            rolling_share: vec![0.6, 0.0],
            ..WhirlState::default()
        });
        board.update_warning(WhirlWarning {
            severity: WhirlWarning::WARNING,
            message: "Warning: backward whirl at 45 deg".into(),
            ..WhirlWarning::default()
        });
        board
    }

    fn picture(board: &Board, now: Instant, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw(frame, board, now)).unwrap();
        terminal.backend().to_string()
    }

    #[test]
    fn everything_is_on_80_by_24() {
        let now = Instant::now();
        let text = picture(&full_board(now), now, 80, 24);
        for part in [
            "RUNNING",
            "Warning: backward whirl at 45 deg",
            "RPM 40.1 r/min",
            "x0.910 real time",
            "3 at limit",
            "bit 40.1 r/min 92 N m",
            "stick-slip OK 0.20   shock WARNING 16.3 N s pipe-guide at 45 deg, 2.50 m",
            " 45 pipe  backward  -3.70",
            "forward 0 backward 1 chaotic 0 none 1",
            "pipe-guide: largest 1.50 kN at 45 deg, 2.50 m",
            "guide-wall: largest no contact",
            "from 0 deg (left) to 90 deg",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
    }

    #[test]
    fn any_size_and_an_empty_board_can_be_drawn() {
        let now = Instant::now();
        for (width, height) in [(1, 1), (10, 3), (40, 12), (80, 24), (250, 80)] {
            picture(&full_board(now), now, width, height);
            picture(&Board::new(now), now, width, height);
        }
    }

    #[test]
    fn a_lost_heartbeat_is_the_first_thing_seen() {
        let now = Instant::now();
        let text = picture(&full_board(now), now + Duration::from_secs(9), 80, 24);
        assert!(
            text.lines()
                .next()
                .is_some_and(|line| line.contains("HEARTBEAT LOST: last heard 9 s ago")),
            "{text}"
        );
    }
}
