//! The dashboard as a full screen, designed for 80 x 24. A larger screen has larger charts; a smaller one loses the lower
//! blocks first.

mod charts;
mod lines;

use std::time::{Duration, Instant};

use ratatui::Frame;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use ratatui::layout::{Constraint, Layout};
use ratatui::style::Color;

use super::board::Board;
use charts::{draw_bit, draw_forces, draw_whirl};
use lines::{alarm_lines, drilling_line, inputs, levels_line, pace, title_line, warning_lines};

const GOOD: Color = Color::Green;
const DOUBTFUL: Color = Color::Yellow;
const BAD: Color = Color::Red;

/// Waits up to `patience` for a key; whether it is one that quits. A resize ends the wait too, and the next picture has
/// the new size.
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
    // A third of the lines beyond 24 goes to the alarms, at most ten lines.
    let spare = frame.area().height.saturating_sub(24) / 3;
    let [title, warning, levels, drilling, top, middle, bottom] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Length(4 + spare.min(10)),
        Constraint::Length(1),
        Constraint::Length(1),
        Constraint::Length(6),
        Constraint::Min(6),
        Constraint::Length(5),
    ])
    .areas(frame.area());
    frame.render_widget(title_line(board, now), title);
    match board.alarms() {
        Some(list) => frame.render_widget(alarm_lines(list), warning),
        // A twin of an older version.
        None => frame.render_widget(warning_lines(board.warning()), warning),
    }
    frame.render_widget(levels_line(board), levels);
    frame.render_widget(drilling_line(board), drilling);
    let [left, right] = Layout::horizontal([Constraint::Percentage(50); 2]).areas(top);
    frame.render_widget(inputs(board), left);
    frame.render_widget(pace(board), right);
    let [left, right] = Layout::horizontal([Constraint::Percentage(46), Constraint::Percentage(54)]).areas(middle);
    draw_bit(frame, board, left);
    draw_whirl(frame, board, right);
    draw_forces(frame, board, bottom);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{
        Alarm, AlarmList, BitState, ContactForces, JointDeflections, Transfer, TwinStatus, WhirlState, WhirlWarning,
    };
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    fn full_board(now: Instant) -> Board {
        let mut board = Board::new(now);
        board.update_status(
            TwinStatus {
                state: TwinStatus::RUNNING,
                model_time: 12.5,
                real_time_factor: 0.91,
                input_name: vec![
                    "rotary_speed".into(),
                    "weight_on_bit".into(),
                    "rate_of_penetration".into(),
                ],
                input_state: vec![TwinStatus::INPUT_OK, TwinStatus::INPUT_OK, TwinStatus::INPUT_ASSUMED],
                input_age: vec![0.1, 0.1, f64::NAN],
                input_received: vec![4.2, 10e3, f64::NAN],
                input_applied: vec![4.2, 10e3, 0.0],
                input_rejected: vec![0; 3],
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
        board.update_transfer(Transfer {
            surface_weight: 9.9e3,
            bit_weight: 7.83e3,
            surface_torque: 190.0,
            bit_torque: 92.0,
            depth_of_cut: 1.6e-3,
            rate_of_penetration: 3.83 / 3600.0,
            ..Transfer::default()
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
            "drills 3.8 m/h   weight 9.9 kN, bit 7.8 kN   torque 190 N m, bit 92 N m",
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
        // The rock decides the rate; the 0 of an input that nothing sends would be read as a tool that does not drill.
        assert!(!text.contains("ROP"), "{text}");
    }

    #[test]
    fn a_rate_that_is_an_input_is_shown_as_one() {
        let now = Instant::now();
        let mut board = full_board(now);
        board.update_transfer(Transfer {
            surface_weight: f64::NAN,
            kickoff_weight: 10e3,
            depth_of_cut: f64::NAN,
            rate_of_penetration: 2.0 / 3600.0,
            ..Transfer::default()
        });
        let text = picture(&board, now, 80, 24);
        for part in ["advances 2.0 m/h as given   weight 10.0 kN", "ROP 0.0 m/h rx - assumed"] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
    }

    #[test]
    fn alarms_go_before_the_warning() {
        let now = Instant::now();
        let mut board = full_board(now);
        let alarm = |name: &str, state, priority| Alarm {
            name: name.into(),
            state,
            priority,
            body: Alarm::PIPE,
            measured_depth: 2.31,
            inclination: 0.733,
            evidence: "It rolls.".into(),
            what_to_do: "Lower the speed below 40 r/min.".into(),
            ..Alarm::default()
        };
        board.update_alarms(AlarmList {
            sequence: 4,
            alarms: vec![
                alarm("backward whirl", Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::HIGH),
                alarm("lateral shock", Alarm::SHELVED, Alarm::LOW),
                alarm("stick-slip", Alarm::NORMAL, Alarm::NO_PRIORITY),
            ],
            unacknowledged: 1,
            ..AlarmList::default()
        });
        // Older than what is there.
        board.update_alarms(AlarmList {
            sequence: 3,
            ..AlarmList::default()
        });
        let text = picture(&board, now, 80, 24);
        for part in [
            "1 to acknowledge, 1 shelved",
            "HIGH backward whirl, active, unacknowledged, pipe at 2.31 m (42 deg)",
            "It rolls. Lower the speed below 40 r/min.",
            "stick-slip OK 0.20",
            "from 0 deg (left) to 90 deg",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
        assert!(
            !text.contains("stick-slip, normal") && !text.contains("LOW lateral shock"),
            "{text}"
        );
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
                .is_some_and(|line| line.contains("HEARTBEAT LOST: last message 9 s ago")),
            "{text}"
        );
    }
}
