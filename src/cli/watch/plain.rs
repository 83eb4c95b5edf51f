//! The dashboard as a block of lines, for logs, pipes and CI.

use std::fmt::Write as _;
use std::time::Instant;

use super::board::Board;
use super::{alarms, texts};
use crate::cli::output::say_text;
use flexdrill_core::units::rad_per_s_to_rpm;

pub(super) fn print(board: &Board, now: Instant) {
    say_text!("{}", block(board, now));
}

fn block(board: &Board, now: Instant) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, board, now);
    text
}

fn write(text: &mut String, board: &Board, now: Instant) -> std::fmt::Result {
    // The heartbeat comes first: when it is missing, everything below is old.
    if let Some(line) = texts::heartbeat(board, now) {
        writeln!(text, "{line}")?;
    }
    // A part that has not been received has no lines, so that the block never shows values that nothing sent.
    if let Some(status) = board.status() {
        writeln!(
            text,
            "twin       {} at {:.1} s, heartbeat {}",
            texts::state(status.state),
            status.model_time,
            status.sequence
        )?;
        writeln!(
            text,
            "pace       {}, late {}, steps missed {} skipped {}, step p50 {} p99 {} max {}",
            texts::pace(status),
            texts::short_time(status.lateness),
            status.deadline_misses,
            status.steps_skipped,
            texts::short_time(status.step_time_p50),
            texts::short_time(status.step_time_p99),
            texts::short_time(status.step_time_max)
        )?;
        writeln!(
            text,
            "solver     {:.1} iterations per step, halved {} failed {}, quality {}",
            status.newton_iterations_mean,
            status.halved_steps,
            status.failed_steps,
            texts::quality_with_cause(status)
        )?;
        for (line, _) in texts::inputs(board) {
            writeln!(text, "input      {line}")?;
        }
    }
    if let Some(transfer) = board.transfer() {
        writeln!(text, "drilling   {}", texts::drilling(transfer))?;
    }
    if let Some(bit) = board.bit() {
        writeln!(
            text,
            "bit        {:.2} r/min, {:.1} N m",
            rad_per_s_to_rpm(bit.rotary_speed),
            bit.torque
        )?;
        writeln!(text, "stick-slip {}", texts::stick_slip(bit).0)?;
    }
    if let Some(contacts) = board.contacts() {
        writeln!(text, "pipe-guide {}", texts::largest(board, 0))?;
        writeln!(text, "guide-wall {}", texts::largest(board, 1))?;
        writeln!(text, "shock      {}", texts::shock(contacts).0)?;
    }
    if board.joints().is_some() {
        writeln!(text, "joints     {}", texts::joints(board))?;
    }
    if let Some(whirl) = board.whirl() {
        writeln!(text, "whirl      {}", texts::whirl_counts(whirl))?;
    }
    // Unlike the parts above, the warning always has a line: its absence would be read as "no warning".
    writeln!(text, "warning    {}", texts::warning(board.warning()))?;
    if let Some(list) = board.alarms() {
        writeln!(text, "alarms     {}", alarms::summary(list))?;
        for alarm in alarms::standing(list) {
            writeln!(text, "alarm      {}", alarms::headline(alarm))?;
            writeln!(text, "           {}", alarms::sentences(alarm))?;
        }
    }
    // Last, because it puts everything above in question.
    if board.unreadable() > 0 {
        writeln!(
            text,
            "note       {} messages could not be read: the versions of twin and dashboard differ",
            board.unreadable()
        )?;
    }
    writeln!(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{BitState, ContactForces, TwinStatus};

    #[test]
    fn an_empty_board_waits_for_a_twin() {
        let now = Instant::now();
        let text = block(&Board::new(now), now);
        assert!(text.starts_with("waiting for a twin for 0 s\n"), "{text}");
    }

    #[test]
    fn values_carry_their_units() {
        let now = Instant::now();
        let mut board = Board::new(now);
        board.update_status(
            TwinStatus {
                state: TwinStatus::RUNNING,
                real_time_factor: 1.0,
                lateness: 3.2e-4,
                model_quality: TwinStatus::QUALITY_DEGRADED,
                model_quality_cause: "collisions".into(),
                energy_error_share: 0.44,
                input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
                input_state: vec![TwinStatus::INPUT_OK, TwinStatus::INPUT_STALE],
                input_age: vec![0.31, 12.0],
                input_received: vec![4.18879, f64::NAN],
                input_applied: vec![4.18879, 10e3],
                input_rejected: vec![0, 2],
                ..TwinStatus::default()
            },
            now,
        );
        board.update_bit(BitState {
            rotary_speed: 4.18879,
            torque: 92.4,
            stick_slip_index: 0.85,
            stick_slip_severity: BitState::WARNING,
            ..BitState::default()
        });
        board.update_contacts(ContactForces {
            measured_depth: vec![0.0, 2.5],
            inclination: vec![0.0, 0.785],
            shock_severity: ContactForces::SHOCK_WATCH,
            shock_impulse: 7.25,
            shock_station: 1,
            shock_layer: ContactForces::OUTER,
            ..ContactForces::default()
        });
        let text = block(&board, now);
        for part in [
            "RUNNING",
            "quality DEGRADED, energy error 44 %: collisions\n",
            "x1.000 real time, late 320 us",
            "RPM 40.0 r/min rx 40.0 ok 0.3 s",
            "WOB 10.0 kN rx - STALE 12.0 s (2 refused)",
            "40.00 r/min, 92.4 N m\n",
            "stick-slip WARNING 0.85\n",
            "shock      WATCH 7.2 N s guide-wall at 45 deg, 2.50 m\n",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
    }
}
