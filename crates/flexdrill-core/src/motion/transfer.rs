//! Transfer: how much of the torque and the weight at the surface arrives at the bit, and where the rest is lost.
//!
//! All figures are means over a sliding window in which every step counts. A torque or a weight at an instant says
//! little: joints ripple twice per turn, and waves travel in the string above. A figure that the tool does not have is
//! NaN: no surface torque without a string above, no weight at the surface without a hoist.
//!
//! Two conditions are judged in steady drilling only: weight that does not arrive and torque that does not arrive, both
//! as the lost share of what is put in at the surface.

mod figures;
#[cfg(test)]
mod tests;

pub use figures::{Along, Powers, Transfer, TransferLevel, TransferSample};
use figures::{TERMS, VALUES, terms};

use serde::{Deserialize, Serialize};

use super::hazards::ended;
use super::hysteresis::{Alarm, AlarmThresholds};
use crate::dynamics::outcome::EnergyAudit;
use crate::units::kn_to_n;

/// Blocks per window: a tenth of a second each in the default window of 5 s.
const BLOCKS: usize = 50;

/// Smallest torque at the top (N m) for which an efficiency is formed: below, the quotient means nothing.
const LEAST_TORQUE: f64 = 1.0;

/// Speed of the tool's top (rad/s) below which it stands: a tenth of a turn per minute.
const LEAST_SPEED: f64 = 0.01;

/// How transfer is averaged and judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TransferSettings {
    /// Length of the window (s): a turn at 12 r/min, and a period of the torsional swing of a string of 4000 m.
    pub window: f64,
    /// Weight on bit (N) from which transfer is judged: below, the tool's own weight in the arc decides.
    pub least_weight: f64,
    /// Largest range of the weight that is put in over a window, relative to its mean, that counts as steady.
    pub steadiness: f64,
    /// Levels of the lost share of the weight, 0 to 1.
    pub weight: AlarmThresholds,
    /// Levels of the lost share of the torque, 0 to 1.
    pub torque: AlarmThresholds,
}

impl Default for TransferSettings {
    fn default() -> Self {
        let thresholds = AlarmThresholds {
            levels: [0.7, 0.8, 0.95],
            hysteresis: 0.1,
            hold_off: 5.0,
        };
        Self {
            window: 5.0,
            least_weight: kn_to_n(3.0),
            steadiness: 0.2,
            weight: thresholds,
            torque: thresholds,
        }
    }
}

/// Places of a torque or a weight from the surface down: [`Along::mean`] and [`Along::rms`] are in this order.
pub const SURFACE: usize = 0;
/// The top of the tool.
pub const KICK_OFF: usize = 1;
/// The bit.
pub const BIT: usize = 2;

/// One condition with its memory.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Condition {
    alarm: Alarm,
    /// The last share that was judged, and the time since then in which none could be judged (s).
    last: f64,
    unknown_for: f64,
}

impl Condition {
    /// Takes the lost share, `None` where it cannot be judged. It then holds for the length of a window at most.
    fn update(&mut self, time: f64, elapsed: f64, lost: Option<f64>, window: f64, thresholds: &AlarmThresholds) {
        if let Some(lost) = lost {
            (self.last, self.unknown_for) = (lost, 0.0);
        } else {
            self.unknown_for += elapsed;
            if self.unknown_for > window {
                self.last = 0.0;
            }
        }
        self.alarm.update(time, elapsed, self.last, thresholds);
    }

    fn level(&self, now: f64) -> TransferLevel {
        let severity = self.alarm.severity();
        TransferLevel {
            severity,
            lost: self.alarm.worst(),
            seen: self.alarm.worst_at(),
            since: self.alarm.since(),
            ended: ended(severity, self.alarm.met(), now),
        }
    }
}

/// Sums over a part of the window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Block {
    duration: f64,
    integrals: [f64; VALUES],
    /// Of the squares of torques and weights.
    squares: [f64; 6],
    energies: [f64; TERMS],
}

impl Block {
    const EMPTY: Self = Self {
        duration: 0.0,
        integrals: [0.0; VALUES],
        squares: [0.0; 6],
        energies: [0.0; TERMS],
    };

    fn add(&mut self, other: &Self) {
        self.duration += other.duration;
        for (to, x) in self.integrals.iter_mut().zip(other.integrals) {
            *to += x;
        }
        for (to, x) in self.squares.iter_mut().zip(other.squares) {
            *to += x;
        }
        for (to, x) in self.energies.iter_mut().zip(other.energies) {
            *to += x;
        }
    }

    fn mean(&self, value: usize) -> f64 {
        self.integrals[value] / self.duration
    }
}

/// Averages and judges transfer. After its construction it does not allocate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TransferWatch {
    settings: TransferSettings,
    /// A ring of full blocks; `next` is the oldest.
    blocks: Vec<Block>,
    next: usize,
    filled: usize,
    current: Block,
    /// The audit at the start of the current block (J).
    before: [f64; TERMS],
    /// Time for which the drive has turned steadily (s).
    judged_for: f64,
    weight: Condition,
    torque: Condition,
    #[serde(skip)]
    summary: Transfer,
}

impl TransferWatch {
    /// A watch with an empty window.
    pub fn new(settings: &TransferSettings) -> Self {
        Self {
            settings: *settings,
            blocks: vec![Block::EMPTY; BLOCKS],
            next: 0,
            filled: 0,
            current: Block::EMPTY,
            before: [0.0; TERMS],
            judged_for: 0.0,
            weight: Condition::default(),
            torque: Condition::default(),
            summary: Transfer::unknown(),
        }
    }

    /// Takes the readings of a step of `dt` (s) that ends at model time `time` (s), with the audit then. While the drive
    /// does not turn steadily (`judged` is false) no level rises.
    pub fn push(&mut self, time: f64, dt: f64, sample: &TransferSample, audit: &EnergyAudit, judged: bool) {
        let values = sample.values();
        let block = &mut self.current;
        block.duration += dt;
        for (integral, value) in block.integrals.iter_mut().zip(values) {
            *integral += value * dt;
        }
        for (square, value) in block.squares.iter_mut().zip(values) {
            *square += value * value * dt;
        }
        self.judged_for = if judged { self.judged_for + dt } else { 0.0 };
        // Half a step of slack, so that rounding in the sum does not make blocks of different lengths.
        let length = block.duration;
        if length + 0.5 * dt < self.settings.window / BLOCKS as f64 {
            return;
        }
        let now = terms(audit);
        for (energy, (now, before)) in block.energies.iter_mut().zip(now.into_iter().zip(self.before)) {
            *energy = now - before;
        }
        self.before = now;
        self.blocks[self.next] = self.current;
        self.current = Block::EMPTY;
        self.next = (self.next + 1) % BLOCKS;
        self.filled = (self.filled + 1).min(BLOCKS);
        self.summarise();
        self.judge(time, length);
    }

    fn full(&self) -> &[Block] {
        &self.blocks[..self.filled]
    }

    fn summarise(&mut self) {
        let mut total = Block::EMPTY;
        for block in self.full() {
            total.add(block);
        }
        if total.duration <= 0.0 {
            self.summary = Transfer::unknown();
            return;
        }
        let mean = TransferSample::of(total.integrals.map(|integral| integral / total.duration));
        let rms = |first: usize| [0, 1, 2].map(|k| (total.squares[first + k] / total.duration).sqrt());
        let top = if mean.torque[SURFACE].is_nan() {
            KICK_OFF
        } else {
            SURFACE
        };
        let put_in = mean.torque[top];
        self.summary = Transfer {
            duration: total.duration,
            torque: Along {
                mean: mean.torque,
                rms: rms(0),
            },
            weight: Along {
                mean: mean.weight,
                rms: rms(3),
            },
            mean,
            friction_torque: {
                let [inner, outer, joints] = mean.friction_power;
                let of = |power: f64| {
                    if mean.speed.abs() >= LEAST_SPEED {
                        power / mean.speed.abs()
                    } else {
                        f64::NAN
                    }
                };
                // What the advance does against the wall takes no torque.
                [of(inner), of(outer - mean.feed_power), of(joints), mean.string_torque]
            },
            torque_efficiency: if put_in.abs() >= LEAST_TORQUE {
                mean.torque[BIT] / put_in
            } else {
                f64::NAN
            },
            power: Powers::of(total.energies.map(|energy| energy / total.duration)),
        };
    }

    /// Judges the window at model time `time` (s), `elapsed` (s) after the last time. Only a full window of steady
    /// drilling is judged: the drive turns, the weight that is put in stays within its range, and that at the bit does not
    /// drift by more.
    fn judge(&mut self, time: f64, elapsed: f64) {
        let TransferSettings {
            window,
            least_weight,
            steadiness,
            ..
        } = self.settings;
        let Transfer { torque, weight, .. } = self.summary;
        let full = self.filled == BLOCKS && self.judged_for >= window;
        let (of_surface, of_bit) = (3 + SURFACE, weight.mean[BIT]);
        let (low, high) = self.full().iter().fold((f64::MAX, f64::MIN), |(low, high), block| {
            let mean = block.mean(of_surface);
            (low.min(mean), high.max(mean))
        });
        let put_in = weight.mean[SURFACE];
        // The weight at the bit may chatter, but must not be on its way to another value.
        let drift = self.drift(3 + BIT).abs();
        let is_steady = (high - low).max(drift) <= steadiness * put_in;
        let lost = |top: f64, bottom: f64| (1.0 - bottom / top).clamp(0.0, 1.0);
        let drilling = full && is_steady && put_in >= least_weight;
        let lost_weight = drilling.then(|| lost(put_in, of_bit));
        // Torque is the rock's answer to weight: without weight at the bit there is none to arrive.
        let top = torque.mean[SURFACE];
        let lost_torque =
            (drilling && of_bit >= least_weight && top >= LEAST_TORQUE).then(|| lost(top, torque.mean[BIT]));
        let settings = &self.settings;
        self.weight.update(time, elapsed, lost_weight, window, &settings.weight);
        self.torque.update(time, elapsed, lost_torque, window, &settings.torque);
    }

    /// Mean of a value over the newer half of a full window less that over the older half.
    fn drift(&self, value: usize) -> f64 {
        let half = |from: usize| {
            let blocks = (from..from + BLOCKS / 2).map(|k| &self.blocks[(self.next + k) % BLOCKS]);
            let sums = blocks.fold((0.0, 0.0), |(sum, time), block| {
                (sum + block.integrals[value], time + block.duration)
            });
            sums.0 / sums.1
        };
        half(BLOCKS / 2) - half(0)
    }

    /// Transfer over the window.
    pub fn summary(&self) -> &Transfer {
        &self.summary
    }

    /// Level of the weight that does not arrive at model time `now` (s).
    pub fn weight(&self, now: f64) -> TransferLevel {
        self.weight.level(now)
    }

    /// Level of the torque that does not arrive at model time `now` (s).
    pub fn torque(&self, now: f64) -> TransferLevel {
        self.torque.level(now)
    }

    /// The settings in use.
    pub fn settings(&self) -> &TransferSettings {
        &self.settings
    }

    /// Forms the summary anew, which is not saved.
    pub fn refresh(&mut self) {
        self.summarise();
    }

    /// Empties the window and forgets the levels; the audit restarts at zero too.
    pub fn reset(&mut self) {
        self.blocks.fill(Block::EMPTY);
        (self.next, self.filled, self.judged_for) = (0, 0, 0.0);
        (self.current, self.before) = (Block::EMPTY, [0.0; TERMS]);
        (self.weight, self.torque) = (Condition::default(), Condition::default());
        self.summary = Transfer::unknown();
    }
}
