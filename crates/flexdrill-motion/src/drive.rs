//! State of the drive: standing, running up or turning. Levels do not rise during a run-up, whose motion is transient.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// Turns at a steady speed after which a run-up is over.
const SETTLED_TURNS: f64 = 2.0;

/// Relative rise of the speed by which a run-up continues.
const RISING: f64 = 0.1;

/// Longest run-up (s). A drive that never becomes steady counts as turning after it.
const LONGEST_RUN_UP: f64 = 30.0;

/// Part of the gate speed below which a turning drive counts as standing again.
const LEAVE_GATE: f64 = 0.8;

/// State of the drive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum DriveState {
    /// The speed has been below the gate speed for the standstill time.
    #[default]
    Standing = 0,
    /// From standstill until the speed has not risen by a tenth for two turns, half a minute at most.
    RunningUp = 1,
    /// The drive turns, or has been below the gate speed for less than the standstill time: in stick-slip a bit stands
    /// for seconds, which is not a new start.
    Turning = 2,
}

/// Follows the speed of the drive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct DriveWatch {
    pub(super) state: DriveState,
    /// Speed from which the steady turns count (rad/s).
    reference: f64,
    steady_turns: f64,
    running_up_for: f64,
    /// Time for which the speed has been below the gate (s).
    below_gate_for: f64,
}

impl DriveWatch {
    /// Takes the speed of the drive (rad/s) over `elapsed` (s). The drive stands after `standstill_time` (s) below
    /// `gate` (rad/s).
    pub(super) fn update(&mut self, elapsed: f64, rotary_speed: f64, gate: f64, standstill_time: f64) {
        let speed = rotary_speed.abs();
        let standing = self.state == DriveState::Standing;
        let gate = if standing { gate } else { LEAVE_GATE * gate };
        if speed < gate || speed == 0.0 {
            self.below_gate_for += elapsed;
            if standing || self.below_gate_for >= standstill_time {
                *self = Self::default();
                return;
            }
        } else {
            self.below_gate_for = 0.0;
        }
        if self.state == DriveState::Turning {
            return;
        }
        self.state = DriveState::RunningUp;
        self.running_up_for += elapsed;
        if speed > (1.0 + RISING) * self.reference {
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
    const STANDSTILL: f64 = 5.0;

    fn states(speed: impl Fn(f64) -> f64, seconds: f64) -> Vec<DriveState> {
        let mut watch = DriveWatch::default();
        (0..(seconds * 100.0) as u32)
            .map(|step| {
                watch.update(0.01, speed(f64::from(step) * 0.01), GATE, STANDSTILL);
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
        // Below 0.8 of the gate from 9 s on.
        let stopping = states(|time| 4.0 * (1.0 - time / 10.0).max(0.0), 16.0);
        assert_eq!(
            (stopping[1390], stopping[1410]),
            (DriveState::Turning, DriveState::Standing)
        );
    }

    #[test]
    fn a_swing_through_standstill_is_no_run_up() {
        // 4 rad/s with a swing of 95 % at 0.2 Hz, and one that stands for 4 s of every 6.
        let swinging = |time: f64| 4.0 * (1.0 + 0.95 * (0.2 * TAU * time).sin());
        let sticking = |time: f64| if time % 6.0 < 2.0 { 12.0 } else { 0.0 };
        for states in [states(swinging, 60.0), states(sticking, 60.0)] {
            let turning = states.iter().position(|&state| state == DriveState::Turning).unwrap();
            assert!(turning < 1000, "{turning}");
            assert!(states[turning..].iter().all(|&state| state == DriveState::Turning));
        }
    }
}
