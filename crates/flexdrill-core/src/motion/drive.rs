//! What the drive does: stands, is being run up, or turns. A tool that is brought to speed is no tool in trouble.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// Turns at a steady speed after which a run-up is over.
const SETTLED_TURNS: f64 = 2.0;

/// Rise of the speed, relative, by which a run-up goes on.
const STILL_RISING: f64 = 0.1;

/// Longest run-up (s). A drive that never becomes steady is judged all the same.
const LONGEST_RUN_UP: f64 = 30.0;

/// Part of the gate below which a turning drive counts as standing again.
const LEAVE_GATE: f64 = 0.8;

/// What the drive does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum DriveState {
    /// Below the gate speed.
    #[default]
    Standing = 0,
    /// From standstill until the speed has not risen by a tenth for two turns, half a minute at most.
    RunningUp = 1,
    /// Turning.
    Turning = 2,
}

/// Follows the speed of the drive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct DriveWatch {
    pub(super) state: DriveState,
    /// Speed since which the turns count (rad/s).
    reference: f64,
    steady_turns: f64,
    running_up_for: f64,
}

impl DriveWatch {
    /// Takes the speed of the drive (rad/s) over `elapsed` (s); below `gate` (rad/s) it stands.
    pub(super) fn update(&mut self, elapsed: f64, rotary_speed: f64, gate: f64) {
        let speed = rotary_speed.abs();
        let gate = if self.state == DriveState::Standing {
            gate
        } else {
            LEAVE_GATE * gate
        };
        if speed < gate || speed == 0.0 {
            *self = Self::default();
            return;
        }
        if self.state == DriveState::Turning {
            return;
        }
        self.state = DriveState::RunningUp;
        self.running_up_for += elapsed;
        if speed > (1.0 + STILL_RISING) * self.reference {
            (self.reference, self.steady_turns) = (speed, 0.0);
        } else {
            self.steady_turns += speed * elapsed / TAU;
        }
        if self.steady_turns >= SETTLED_TURNS || self.running_up_for >= LONGEST_RUN_UP {
            self.state = DriveState::Turning;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GATE: f64 = 0.5;

    fn states(speed: impl Fn(f64) -> f64, seconds: f64) -> Vec<DriveState> {
        let mut watch = DriveWatch::default();
        (0..(seconds * 100.0) as u32)
            .map(|step| {
                watch.update(0.01, speed(f64::from(step) * 0.01), GATE);
                watch.state
            })
            .collect()
    }

    #[test]
    fn a_run_up_ends_two_turns_after_the_speed_is_reached() {
        // 4 rad/s after 2 s; the last rise of a tenth was at 1.8 s or so.
        let states = states(|time| (2.0 * time).min(4.0), 10.0);
        assert_eq!(states[10], DriveState::Standing);
        assert_eq!(states[100], DriveState::RunningUp);
        let turning = states.iter().position(|&state| state == DriveState::Turning).unwrap();
        let expected = 100.0 * (1.9 + 2.0 * TAU / 4.0);
        assert!((turning as f64 - expected).abs() < 25.0, "{turning} for {expected}");
    }

    #[test]
    fn a_change_of_speed_is_no_run_up_and_a_restless_drive_is_judged() {
        let faster = states(|time| if time < 8.0 { 4.0 } else { 8.0 }, 12.0);
        assert!(faster[400..].iter().all(|&state| state == DriveState::Turning));
        let restless = states(|time| 0.6 * 1.02_f64.powf(time), 60.0);
        assert_eq!(
            (restless[2900], restless[3100]),
            (DriveState::RunningUp, DriveState::Turning)
        );
        let stopping = states(|time| 4.0 * (1.0 - time / 10.0).max(0.0), 12.0);
        assert_eq!(
            (stopping[800], stopping[1000]),
            (DriveState::Turning, DriveState::Standing)
        );
    }
}
