//! Stick-slip index of the bit: (max - min) / (2 mean) of the bit's speed over a window, and its level.
//!
//! The drive may oscillate too: a speed measured downhole includes the torsional oscillation of the string above. Such
//! an oscillation counts, whereas a change of the set speed does not. The two differ in repetition: an oscillation
//! rises and falls again and again, a change of the set speed happens once. After a change only the speeds since then
//! count.

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::Severity;
use super::hazards::Hold;
use super::hysteresis::{Alarm, AlarmThresholds};
use flexdrill_base::units::rpm_to_rad_per_s;

/// Blocks per window. The window moves block by block, so that its extremes need no queue.
const BLOCKS: usize = 100;

/// Blocks that are kept. Two windows hold two whole swings whose period is that of the window.
const KEPT: usize = 2 * BLOCKS;

/// Fewest blocks for an index: 1.5 s of a window of 10 s contain a turn at 40 r/min, and two periods of the joints'
/// ripple.
const FEWEST: usize = 15;

/// Blocks for which the bit must stand to count as stuck: 1 s of a window of 10 s, longer than its rest between two
/// ripples of the joints.
const STUCK_BLOCKS: usize = 10;

/// Part of the drive's speed below which the bit's mean speed counts as stuck.
const STUCK: f64 = 0.1;

/// Swings from which the drive oscillates: up, down, up and down. A driller who slows down and speeds up again makes
/// two.
const SWINGS: u32 = 4;

/// Size of such swings relative to the range of the drive's speed. Below, most of the range is a change of the set
/// speed with superposed noise.
const SWINGING: f64 = 0.4;

/// Relative difference to the present speed of the drive within which an earlier speed has the same set point.
const SAME_SPEED: f64 = 0.1;

/// Bisections in the search for the size of the swings: to a thousandth of the range.
const SEARCH: u32 = 10;

/// How the stick-slip index is formed and judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StickSlipSettings {
    /// Length of the window (s). A string that is held at its top swings at c / 4 L with c = 3177 m/s: at 0.8 Hz with
    /// 1000 m, at 0.2 Hz with 4000 m, of which the window holds two periods. Swings of up to its own length are judged.
    pub window: f64,
    /// Mean speed of the drive below which the index is 0 (rad/s): near standstill the quotient means nothing. At 10
    /// r/min and 10 kN the joints alone make the bit's speed swing by 0.64 of its mean.
    pub gate_speed: f64,
    /// Index of the levels: 1 is a bit that just stops once per period, half of it and four fifths are on the way
    /// there.
    pub thresholds: AlarmThresholds,
}

impl Default for StickSlipSettings {
    fn default() -> Self {
        Self {
            window: 10.0,
            gate_speed: rpm_to_rad_per_s(11.0),
            thresholds: AlarmThresholds {
                levels: [0.5, 0.8, 1.0],
                hysteresis: 0.15,
                hold_off: 5.0,
            },
        }
    }
}

/// Watches the bit's speed. The index is 0 for a steady bit, 1 for one that just stops once per period, above 1 for one
/// that sticks.
///
/// A bit that stands while the drive turns has an index of 1 at least: its own speed would yield zero over zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StickSlip {
    settings: StickSlipSettings,
    /// A ring: `current` is being filled, the next one is the oldest.
    blocks: Vec<Block>,
    current: usize,
    /// Full blocks before the current one.
    filled: usize,
    index: f64,
    /// The last valid index, and the time since then without one (s).
    last: f64,
    unknown_for: f64,
    /// Least speed of the bit over the drive's mean in the window of `last`, and in that of the alarm's worst index.
    least: f64,
    worst_least: f64,
    alarm: Alarm,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Block {
    /// Of the bit's speed (rad/s).
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

    /// The union of both blocks.
    fn with(self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            bit_angle: self.bit_angle + other.bit_angle,
            drive_angle: self.drive_angle + other.drive_angle,
            duration: self.duration + other.duration,
        }
    }

    /// Mean speed of the drive (rad/s).
    fn drive(&self) -> f64 {
        self.drive_angle / self.duration
    }

    /// Mean speed of the bit in the drive's sense (rad/s).
    fn bit(&self) -> f64 {
        self.bit_angle * self.drive_angle.signum() / self.duration
    }
}

impl StickSlip {
    /// A watch with an empty window.
    pub fn new(settings: StickSlipSettings) -> Self {
        Self {
            settings,
            blocks: vec![Block::EMPTY; KEPT + 1],
            current: 0,
            filled: 0,
            index: 0.0,
            last: 0.0,
            unknown_for: 0.0,
            least: 0.0,
            worst_least: 0.0,
            alarm: Alarm::default(),
        }
    }

    /// Takes the speeds of bit and drive (rad/s) over a step of `dt` (s) until model time `time` (s). While the drive
    /// stands or is run up (`judged` is false), the bit lags and springs forward without stick-slip: the window
    /// restarts.
    pub fn push(&mut self, time: f64, dt: f64, bit: f64, drive: f64, judged: bool) {
        if !judged {
            self.alarm.update(time, dt, 0.0, &self.settings.thresholds);
            if self.filled > 0 || self.blocks[self.current].duration > 0.0 {
                self.empty();
            }
            return;
        }
        let block = &mut self.blocks[self.current];
        block.min = block.min.min(bit);
        block.max = block.max.max(bit);
        block.bit_angle += bit * dt;
        block.drive_angle += drive * dt;
        block.duration += dt;
        // Half a step of slack, so that rounding in the sum does not make blocks of different lengths.
        let length = block.duration;
        if length + 0.5 * dt < self.settings.window / BLOCKS as f64 {
            return;
        }
        self.current = (self.current + 1) % self.blocks.len();
        self.blocks[self.current] = Block::EMPTY;
        self.filled = (self.filled + 1).min(KEPT);
        // After a change of the set speed the last index holds the level, for the length of a window at most.
        let judged = self.judge();
        if let Some((index, least)) = judged {
            (self.last, self.unknown_for, self.least) = (index, 0.0, least);
        } else {
            self.unknown_for += length;
            if self.unknown_for > self.settings.window {
                self.last = 0.0;
            }
        }
        self.index = judged.map_or(0.0, |(index, _)| index);
        self.alarm.update(time, length, self.last, &self.settings.thresholds);
        if self.alarm.worst_at() == time {
            self.worst_least = self.least;
        }
    }

    /// The index at the end of the last block; 0 while the window has too few blocks at the present set speed, or the
    /// drive is below the gate speed.
    pub fn index(&self) -> f64 {
        self.index
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

    /// Least speed of the bit over the mean speed of the drive, in the drive's sense, in the window of the largest index:
    /// below 0 the bit spun back. 0 before an index.
    pub fn least_speed(&self) -> f64 {
        self.worst_least
    }

    /// What holds the level at model time `now` (s).
    pub fn hold(&self, now: f64) -> Hold {
        self.alarm.hold(now)
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
        (self.current, self.filled, self.index) = (0, 0, 0.0);
        (self.last, self.unknown_for) = (0.0, 0.0);
    }

    /// Full blocks, the newest first.
    fn newest(&self) -> impl Iterator<Item = &Block> + Clone {
        let (length, current) = (self.blocks.len(), self.current);
        (1..=self.filled).map(move |back| &self.blocks[(current + length - back) % length])
    }

    /// The index, and the least speed of the bit over the mean speed of the drive; none while the window has too few
    /// blocks at the present set speed.
    fn judge(&self) -> Option<(f64, f64)> {
        let counted = if self.drive_swings() {
            BLOCKS
        } else {
            self.same_set_speed()
        };
        if counted.min(self.filled) < FEWEST {
            return None;
        }
        let sum = |blocks: usize| self.newest().take(blocks).fold(Block::EMPTY, Block::with);
        let (total, last) = (sum(counted), sum(STUCK_BLOCKS));
        let drive = total.drive().abs();
        let turns = |speed: f64| speed >= self.settings.gate_speed && speed > 0.0;
        if !turns(drive) {
            return Some((0.0, 0.0));
        }
        let index = (total.max - total.min) / (2.0 * total.bit().max(STUCK * drive));
        let now = last.drive().abs();
        let stuck = turns(now) && last.bit() < STUCK * now;
        let least = if total.drive() < 0.0 { -total.max } else { total.min };
        Some((if stuck { index.max(1.0) } else { index }, least / drive))
    }

    /// Newest blocks of the window in which the drive has had its present speed.
    fn same_set_speed(&self) -> usize {
        let mut newest = self.newest().take(BLOCKS).map(Block::drive);
        let Some(now) = newest.next() else { return 0 };
        1 + newest
            .take_while(|speed| (speed - now).abs() <= SAME_SPEED * now.abs())
            .count()
    }

    /// Whether the drive's speed oscillates.
    fn drive_swings(&self) -> bool {
        let speeds = self.newest().map(Block::drive);
        let extremes = |(low, high): (f64, f64), speed: f64| (low.min(speed), high.max(speed));
        let (low, high) = speeds.clone().fold((f64::MAX, f64::MIN), extremes);
        let range = high - low;
        // Bisection for the largest size of swing that occurs often enough.
        let (mut reached, mut missed) = (0.0, range);
        for _ in 0..SEARCH {
            let size = 0.5 * (reached + missed);
            if swings(speeds.clone(), size) >= SWINGS {
                reached = size;
            } else {
                missed = size;
            }
        }
        reached >= SWINGING * range
    }
}

/// Number of swings of `speeds` of at least `size`; up and down count as one each.
fn swings(speeds: impl Iterator<Item = f64>, size: f64) -> u32 {
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    let (mut rising, mut count) = (None, 0);
    for speed in speeds {
        (low, high) = (low.min(speed), high.max(speed));
        if rising != Some(true) && speed - low >= size {
            (rising, high) = (Some(true), speed);
            count += 1;
        } else if rising != Some(false) && high - speed >= size {
            (rising, low) = (Some(false), speed);
            count += 1;
        }
    }
    count
}
