//! The lines above the charts: title, warning, levels, inputs, pace.

use std::time::Instant;

use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};

use super::{BAD, DOUBTFUL, GOOD};
use crate::cli::watch::board::Board;
use crate::cli::watch::{alarms, texts};
use crate::messages::{Alarm, AlarmList, TwinStatus, WhirlWarning};

pub(super) fn title_line(board: &Board, now: Instant) -> Line<'static> {
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

pub(super) fn warning_lines(warning: Option<&WhirlWarning>) -> Paragraph<'static> {
    Paragraph::new(texts::warning(warning))
        .style(severity_style(
            warning.map_or(WhirlWarning::OK, |warning| warning.severity),
        ))
        .wrap(Wrap { trim: true })
}

/// The summary, then the alarms that require a response, the worst first.
pub(super) fn alarm_lines(list: &AlarmList) -> Paragraph<'static> {
    let mut lines = vec![Line::raw(format!("alarms: {}", alarms::summary(list)))];
    for alarm in alarms::standing(list) {
        lines.push(Line::styled(alarms::headline(alarm), alarm_style(alarm)));
        lines.push(Line::raw(alarms::sentences(alarm)));
    }
    Paragraph::new(lines).wrap(Wrap { trim: true })
}

fn alarm_style(alarm: &Alarm) -> Style {
    let unacknowledged = alarm.state == Alarm::ACTIVE_UNACKNOWLEDGED;
    match (alarm.priority, unacknowledged) {
        (Alarm::HIGH, true) => Style::new().fg(Color::White).bg(BAD).add_modifier(Modifier::BOLD),
        (Alarm::HIGH, false) => Style::new().fg(BAD),
        (Alarm::MEDIUM, true) => Style::new().fg(Color::Black).bg(DOUBTFUL),
        _ => Style::new().fg(DOUBTFUL),
    }
}

pub(super) fn severity_style(severity: u8) -> Style {
    match severity {
        WhirlWarning::OK => Style::new().fg(GOOD),
        WhirlWarning::WATCH => Style::new().fg(DOUBTFUL),
        WhirlWarning::WARNING => Style::new().fg(Color::Black).bg(DOUBTFUL),
        _ => Style::new().fg(Color::White).bg(BAD).add_modifier(Modifier::BOLD),
    }
}

/// The levels of stick-slip and shock.
pub(super) fn levels_line(board: &Board) -> Line<'static> {
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

/// What drilling comes to.
pub(super) fn drilling_line(board: &Board) -> Line<'static> {
    board
        .transfer()
        .map(texts::drilling)
        .map_or_else(Line::default, |text| Line::styled(text, Modifier::BOLD))
}

pub(super) fn inputs(board: &Board) -> Paragraph<'static> {
    let mut lines = Vec::new();
    for (text, state) in texts::inputs(board) {
        let color = match state {
            TwinStatus::INPUT_OK => GOOD,
            TwinStatus::INPUT_STALE | TwinStatus::INPUT_REJECTED => BAD,
            _ => DOUBTFUL,
        };
        lines.push(Line::styled(text, color));
    }
    lines.push(Line::raw(texts::joints(board)));
    if board.unreadable() > 0 {
        lines.push(Line::styled(
            format!("{} unreadable messages: another version?", board.unreadable()),
            BAD,
        ));
    }
    Paragraph::new(lines)
        .wrap(Wrap { trim: true })
        .block(Block::bordered().title(" inputs as applied, joints "))
}

pub(super) fn pace(board: &Board) -> Paragraph<'static> {
    let mut lines = Vec::new();
    if let Some(status) = board.status() {
        let color = if status.pace >= TwinStatus::PACE_LATE {
            BAD
        } else {
            GOOD
        };
        lines.push(Line::from(vec![
            Span::styled(texts::pace(status), color),
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
        let color = match status.model_quality {
            TwinStatus::QUALITY_GOOD => GOOD,
            TwinStatus::QUALITY_DEGRADED => DOUBTFUL,
            _ => BAD,
        };
        lines.push(Line::from(vec![
            Span::raw(format!(
                "newton {:.1} at {} ms halved {} model ",
                status.newton_iterations_mean,
                1e3 * status.step_in_force,
                status.halved_steps
            )),
            Span::styled(texts::quality(status), color),
        ]));
    }
    Paragraph::new(lines).block(Block::bordered().title(" pace and solver "))
}
