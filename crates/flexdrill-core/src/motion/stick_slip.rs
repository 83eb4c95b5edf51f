//! Stick-slip index of the bit: (max - min) / (2 mean) of its speed over a window, and its level.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::hysteresis::{Alarm, AlarmThresholds};
use crate::units::rpm_to_rad_per_s;

/// The window moves in steps of a block, so that extremes need no queue.
const BLOCKS: usize = 30;

/// Part of the drive's speed below which the bit's mean speed counts as stuck.
const STUCK: f64 = 0.1;

/// How the stick-slip index is formed and judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StickSlipSettings {
    /// s. Two turns at 40 r/min hold four periods of the joints' ripple.
    pub window: f64,
    /// Mean speed of the drive below which the index is 0 (rad/s): near standstill the quotient means nothing. A
    /// quarter of 40 r/min.
    pub gate_speed: f64,
    /// Index of the levels: 1 is a bit that just stops once per period, half of it and four fifths are on the way
    /// there.
    pub thresholds: AlarmThresholds,
}

impl Default for StickSlipSettings {
    fn default() -> Self {
        Self {
            window: 3.0,
            gate_speed: rpm_to_rad_per_s(10.0),
            thresholds: AlarmThresholds {
                levels: [0.5, 0.8, 1.0],
                hysteresis: 0.15,
                hold_off: 5.0,
            },
        }
    }
}

/// Watches the bit's speed. The index is 0 for a steady bit, 1 when it just stops once per period, above 1 when it
/// sticks.
///
/// Extremes are those of the bit's speed less the drive's, so that a change of the set speed is no stick-slip; at a
/// steady drive that is the same. A bit that stands still while the drive turns counts as 1 at least: its own speed
/// would give nothing over nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StickSlip {
    settings: StickSlipSettings,
    blocks: Vec<Block>,
    current: usize,
    filled: usize,
    alarm: Alarm,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Block {
    /// Of the bit's speed less the drive's (rad/s).
    min: f64,
    max: f64,
    bit_angle: f64,
    drive_angle: f64,
    duration: f64,
}

impl Block {
    const EMPTY: Self = Self {
        min: f64::MAX,
        max: f64::MIN,
        bit_angle: 0.0,
        drive_angle: 0.0,
        duration: 0.0,
    };
}

impl StickSlip {
    /// With an empty window.
    pub fn new(settings: StickSlipSettings) -> Self {
        Self {
            settings,
            blocks: vec![Block::EMPTY; BLOCKS],
            current: 0,
            filled: 1,
            alarm: Alarm::default(),
        }
    }

    /// Takes the speeds of bit and drive (rad/s) over a step of `dt` (s) until model time `time` (s). While the drive
    /// stands or is run up (`judged` is false), the bit follows late and springs forward by itself: the window starts
    /// anew.
    pub fn push(&mut self, time: f64, dt: f64, bit: f64, drive: f64, judged: bool) {
        if !judged {
            self.alarm.update(time, dt, 0.0, &self.settings.thresholds);
            if self.filled > 1 || self.blocks[self.current].duration > 0.0 {
                self.empty();
            }
            return;
        }
        let length = self.blocks[self.current].duration;
        // Half a step of slack, so that rounding in the sum does not make blocks of different lengths.
        if length + 0.5 * dt >= self.settings.window / BLOCKS as f64 {
            let index = self.index();
            self.alarm.update(time, length, index, &self.settings.thresholds);
            self.current = (self.current + 1) % BLOCKS;
            self.blocks[self.current] = Block::EMPTY;
            self.filled = (self.filled + 1).min(BLOCKS);
        }
        let block = &mut self.blocks[self.current];
        block.min = block.min.min(bit - drive);
        block.max = block.max.max(bit - drive);
        block.bit_angle += bit * dt;
        block.drive_angle += drive * dt;
        block.duration += dt;
    }

    /// The index over the window so far; 0 while half of the window is still empty or the drive is below the gate.
    pub fn index(&self) -> f64 {
        let mut total = Block::EMPTY;
        for block in &self.blocks {
            total.min = total.min.min(block.min);
            total.max = total.max.max(block.max);
            total.bit_angle += block.bit_angle;
            total.drive_angle += block.drive_angle;
            total.duration += block.duration;
        }
        if total.duration <= 0.0 || self.filled < BLOCKS / 2 {
            return 0.0;
        }
        let drive = total.drive_angle.abs() / total.duration;
        if drive < self.settings.gate_speed || drive == 0.0 {
            return 0.0;
        }
        let mean = total.bit_angle * total.drive_angle.signum() / total.duration;
        let index = (total.max - total.min) / (2.0 * mean.max(STUCK * drive));
        if mean < STUCK * drive { index.max(1.0) } else { index }
    }

    /// The level that the index has reached.
    pub fn severity(&self) -> Severity {
        self.alarm.severity()
    }

    /// Model time at which that level was reached (s).
    pub fn since(&self) -> f64 {
        self.alarm.since()
    }

    /// Largest index since the level was reached and the model time of it (s); the newest while the level is OK.
    pub fn worst(&self) -> (f64, f64) {
        (self.alarm.worst(), self.alarm.worst_at())
    }

    /// Model time at which the level was last held (s).
    pub fn met(&self) -> f64 {
        self.alarm.met()
    }

    /// The settings in use.
    pub fn settings(&self) -> &StickSlipSettings {
        &self.settings
    }

    /// Empties the window and forgets the level.
    pub fn reset(&mut self) {
        self.empty();
        self.alarm = Alarm::default();
    }

    fn empty(&mut self) {
        self.blocks.fill(Block::EMPTY);
        (self.current, self.filled) = (0, 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Speed of the drive in the tests (rad/s), 40 r/min.
    const DRIVE: f64 = 4.19;

    fn watched(drive: impl Fn(f64) -> f64, bit: impl Fn(f64) -> f64, seconds: f64) -> StickSlip {
        let mut watch = StickSlip::new(StickSlipSettings::default());
        let dt = 5e-4;
        for step in 0..(seconds / dt) as usize {
            let time = step as f64 * dt;
            watch.push(time, dt, bit(time), drive(time), true);
        }
        watch
    }

    fn rippled(mean: f64, amplitude: f64, seconds: f64) -> StickSlip {
        watched(|_| mean, |time| mean + amplitude * (TAU * 1.3 * time).sin(), seconds)
    }

    #[test]
    fn sine_ripple_gives_amplitude_over_mean() {
        assert!((rippled(DRIVE, 0.5, 10.0).index() - 0.5 / DRIVE).abs() < 2e-3);
        let stopping = rippled(DRIVE, DRIVE, 10.0);
        assert!((stopping.index() - 1.0).abs() < 1e-2);
        assert!(stopping.severity() >= Severity::Warning);
        assert_eq!(rippled(DRIVE, 0.5, 10.0).severity(), Severity::Ok);
    }

    #[test]
    fn silent_below_the_gate_and_while_the_window_fills() {
        assert_eq!(rippled(0.5, 3.0, 10.0).index(), 0.0);
        assert_eq!(rippled(DRIVE, 4.0, 1.0).index(), 0.0);
        // 40 r/min is four times the gate: half of it, with the bit stopping, is still seen.
        assert!(rippled(0.5 * DRIVE, 0.5 * DRIVE, 10.0).index() > 0.9);
    }

    #[test]
    fn running_up_is_no_stick_slip() {
        let ramp = |time: f64| (0.5 * DRIVE * time).min(DRIVE);
        for seconds in [1.6, 2.0, 3.0, 4.0, 5.0] {
            let watch = watched(ramp, |time| ramp((time - 0.02).max(0.0)), seconds);
            assert!(watch.index() < 0.05, "{} after {seconds} s", watch.index());
        }
    }

    #[test]
    fn nothing_is_judged_before_the_drive_turns_steadily() {
        let mut watch = StickSlip::new(StickSlipSettings::default());
        for step in 0..20_000 {
            let time = f64::from(step) * 5e-4;
            // The bit sticks for 2 s, then springs forward, while the tool is run up.
            let bit = if time < 2.0 { 0.0 } else { 4.0 * DRIVE };
            watch.push(time, 5e-4, bit, DRIVE, time > 4.0);
            assert!(
                time > 5.4 || (watch.index() == 0.0 && watch.severity() == Severity::Ok),
                "{time}"
            );
        }
        assert!(watch.index() == 0.0, "{}", watch.index());
    }

    #[test]
    fn a_stuck_bit_is_seen_although_its_own_speed_is_nothing() {
        let stuck = watched(|_| DRIVE, |time| if time < 5.0 { DRIVE } else { 0.0 }, 12.0);
        assert!(stuck.index() >= 1.0, "{}", stuck.index());
        assert_eq!(stuck.severity(), Severity::Critical);
        // Sticks for 2 s, then slips through what the drive has wound up.
        let slipping = watched(|_| DRIVE, |time| if time % 2.5 < 2.0 { 0.0 } else { 5.0 * DRIVE }, 12.0);
        assert!(slipping.index() > 2.0, "{}", slipping.index());
    }

    #[test]
    fn forgets_what_left_the_window() {
        let mut watch = StickSlip::new(StickSlipSettings::default());
        watch.push(0.0, 1e-3, 100.0, 4.0, true);
        for _ in 0..4000 {
            watch.push(0.0, 1e-3, 4.0, 4.0, true);
        }
        assert_eq!(watch.index(), 0.0);
    }
}
