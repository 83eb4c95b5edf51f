//! Transfer: how much of the torque and the weight at the surface arrives at the bit, and where the rest is lost.
//!
//! All figures are means over a sliding window in which every step counts. A torque or a weight at an instant says
//! little: joints ripple twice per turn, and waves travel in the string above. A figure that the tool does not have is
//! NaN: no surface torque without a string above, no weight at the surface without a hoist.
//!
//! Two conditions are judged in steady drilling only: weight that does not arrive and torque that does not arrive, both
//! as the lost share of what is put in at the surface. Weight that is asked for and is not on the bottom, by more than
//! sliding friction takes, is judged once the hoist has had the time to bring it. A stall is judged while the drive is asked
//! to turn, by its time.

mod figures;
#[cfg(test)]
mod tests;

use figures::VALUES;
pub use figures::{Along, Transfer, TransferLevel, TransferSample};

use serde::{Deserialize, Serialize};

use super::hysteresis::{Alarm, AlarmThresholds};
use flexdrill_base::energies::Energies;
use flexdrill_base::units::kn_to_n;

/// Blocks per window: a tenth of a second each in the default window of 5 s.
const BLOCKS: usize = 50;

/// Smallest torque at the top (N m) for which an efficiency is formed: below, the quotient means nothing.
const LEAST_TORQUE: f64 = 1.0;

/// Speed of the tool's top (rad/s) below which it stands: a tenth of a turn per minute.
const LEAST_SPEED: f64 = 0.01;

/// Share of the speed asked for, and of the root mean square of its own speed, above which the tool's top turns. Below,
/// a tool that is held or swings to and fro has losses that are not those of a rotation.
const LEAST_TURNING: f64 = 0.1;

/// Share of the weight asked for from which the bit counts as set down: below, the block is on its way.
const SET_DOWN: f64 = 0.1;

/// Response times of the hoist after which the weight ought to be there: e^-5 of a change is left.
const RESPONSES: f64 = 5.0;

/// Share of a block in which the drive is at its limit, so that the block counts as one of a stall.
const MOSTLY: f64 = 0.5;

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
    /// Levels of the share of the weight that ought to arrive and is not on the bottom, 0 to 1.
    pub short: AlarmThresholds,
    /// Levels of the lost share of the torque, 0 to 1.
    pub torque: AlarmThresholds,
    /// Levels of the time for which the drive stalls on a bit that is stuck (s).
    pub stall: AlarmThresholds,
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
            // A coefficient of friction of 0.1 more than assumed takes 15 % of what ought to arrive round a right angle.
            short: AlarmThresholds {
                levels: [0.3, 0.4, 0.7],
                ..thresholds
            },
            // Longer than a string of 4000 m needs for its slowest swing, 5 s, a bit that sticks does not slip by itself.
            stall: AlarmThresholds {
                levels: [2.0, 5.0, 10.0],
                ..thresholds
            },
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
    /// The thresholds that it was judged by last.
    levels: [f64; 3],
}

impl Condition {
    /// A condition at level OK.
    fn calm(thresholds: &AlarmThresholds) -> Self {
        Self {
            levels: thresholds.levels,
            ..Self::default()
        }
    }

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
        self.levels = thresholds.levels;
        self.alarm.update(time, elapsed, self.last, thresholds);
    }

    fn level(&self, now: f64) -> TransferLevel {
        let severity = self.alarm.severity();
        TransferLevel {
            severity,
            value: self.alarm.worst(),
            threshold: self.levels[(severity as usize).saturating_sub(1)],
            seen: self.alarm.worst_at(),
            since: self.alarm.since(),
            hold: self.alarm.hold(now),
        }
    }
}

/// Sums over a part of the window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Block {
    duration: f64,
    integrals: [f64; VALUES],
    /// Of the squares of torques, weights and the speed of the tool's top.
    squares: [f64; 7],
    energies: [f64; Energies::COUNT],
}

impl Block {
    const EMPTY: Self = Self {
        duration: 0.0,
        integrals: [0.0; VALUES],
        squares: [0.0; 7],
        energies: [0.0; Energies::COUNT],
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
    before: [f64; Energies::COUNT],
    /// Time for which the drive has turned steadily (s).
    judged_for: f64,
    /// Response time of the hoist (s).
    response: f64,
    /// Weight that is asked for (N), and the time for which it has been, with the drive turning and the bit set down (s).
    asked: f64,
    asked_for: f64,
    weight: Condition,
    short: Condition,
    torque: Condition,
    stall: Condition,
    /// Time for which the drive has been at its limit while the bit did not turn (s).
    stalled_for: f64,
    #[serde(skip)]
    summary: Transfer,
}

impl TransferWatch {
    /// A watch with an empty window, of a tool whose hoist has a `response` time (s; 0 without a hoist).
    pub fn new(settings: &TransferSettings, response: f64) -> Self {
        Self {
            settings: *settings,
            blocks: vec![Block::EMPTY; BLOCKS],
            next: 0,
            filled: 0,
            current: Block::EMPTY,
            before: [0.0; Energies::COUNT],
            judged_for: 0.0,
            response,
            asked: 0.0,
            asked_for: 0.0,
            weight: Condition::calm(&settings.weight),
            short: Condition::calm(&settings.short),
            torque: Condition::calm(&settings.torque),
            stall: Condition::calm(&settings.stall),
            stalled_for: 0.0,
            summary: Transfer::unknown(),
        }
    }

    /// Takes the readings of a step of `dt` (s) that ends at model time `time` (s), with the energies since the start (J)
    /// then. While the drive does not turn steadily (`judged` is false) no level rises.
    pub fn push(&mut self, time: f64, dt: f64, sample: &TransferSample, energies: &Energies, judged: bool) {
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
        let now = energies.values();
        for (energy, (now, before)) in block.energies.iter_mut().zip(now.into_iter().zip(self.before)) {
            *energy = now - before;
        }
        self.before = now;
        self.judge_stall(time, judged);
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
        // Whole blocks only: one that is being filled would weigh a part of a turn.
        let mut total = Block::EMPTY;
        for block in self.full() {
            total.add(block);
        }
        // Without a full block there is no mean; NaN says so, and zero would be a finding.
        if total.duration <= 0.0 {
            self.summary = Transfer::unknown();
            return;
        }
        let mean = TransferSample::of(total.integrals.map(|integral| integral / total.duration));
        // Deviations are summed in the order torque, weight, speed, three places for each of the first two.
        let rms = |first: usize| [0, 1, 2].map(|k| (total.squares[first + k] / total.duration).sqrt());
        // What is put in is measured at the highest place that the tool has.
        let top = if mean.torque[SURFACE].is_nan() {
            KICK_OFF
        } else {
            SURFACE
        };
        let put_in = mean.torque[top];
        let swing = (total.squares[6] / total.duration).sqrt();
        // Friction torques are powers over the speed. Near standstill the quotient says nothing, and the swing of a
        // sticking bit counts as standstill.
        let turns = mean.speed.abs() >= LEAST_SPEED.max(LEAST_TURNING * mean.asked_speed.abs().max(swing));
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
                // The sign of the speed is that of the loss.
                let of = |power: f64| if turns { power / mean.speed } else { f64::NAN };
                // What the advance does against the wall takes no torque.
                [of(inner), of(outer - mean.feed_power), of(joints), mean.string_torque]
            },
            // A torque near zero would make the share of noise over noise.
            torque_efficiency: if turns && put_in.abs() >= LEAST_TORQUE {
                mean.torque[BIT] / put_in
            } else {
                f64::NAN
            },
            power: Energies::of(total.energies.map(|energy| energy / total.duration)),
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
        let (short, thresholds) = self.short_of_asked(elapsed, full);
        self.short.update(time, elapsed, short, window, &thresholds);
        let settings = &self.settings;
        self.torque.update(time, elapsed, lost_torque, window, &settings.torque);
    }

    /// Share of the weight asked for that is not on the bottom, and its thresholds: those of the share that ought to arrive,
    /// which friction round the arc and along the string leaves. `None` where it cannot be judged: before the hoist has had
    /// the time to bring the weight, off bottom, and without a hoist. Neither the weight at the surface nor that at the bit
    /// has to be steady: a bit that whips on the rock never is.
    fn short_of_asked(&mut self, elapsed: f64, full: bool) -> (Option<f64>, AlarmThresholds) {
        let settings = self.settings;
        let Transfer { weight, mean, .. } = self.summary;
        let (asked, put_in) = (mean.asked_weight, weight.mean[SURFACE]);
        let is_down = put_in > SET_DOWN * asked && asked >= settings.least_weight;
        if !full || !is_down || (asked - self.asked).abs() > settings.steadiness * self.asked {
            (self.asked, self.asked_for) = (asked, 0.0);
        } else {
            self.asked_for += elapsed;
        }
        let ought = (mean.arrives - mean.axial_drag[2].max(0.0) / asked).clamp(0.0, 1.0);
        let thresholds = AlarmThresholds {
            levels: settings.short.levels.map(|level| 1.0 - (1.0 - level) * ought),
            ..settings.short
        };
        let settled = self.asked_for >= 2.0 * settings.window + RESPONSES * self.response;
        let lost = (1.0 - weight.mean[BIT] / asked).clamp(0.0, 1.0);
        (settled.then_some(lost), thresholds)
    }

    /// Judges the block that ends at model time `time` (s): the drive stalls where its torque is at the limit and the bit,
    /// asked to turn, does not.
    fn judge_stall(&mut self, time: f64, judged: bool) {
        let mean = TransferSample::of(self.current.integrals.map(|integral| integral / self.current.duration));
        let stands = mean.bit_speed.abs() < LEAST_TURNING * mean.asked_speed.abs();
        // A share of NaN is a tool without a string, whose drive has no limit.
        self.stalled_for = if judged && stands && mean.drive_at_limit >= MOSTLY {
            self.stalled_for + self.current.duration
        } else {
            0.0
        };
        let (window, thresholds) = (self.settings.window, self.settings.stall);
        let elapsed = self.current.duration;
        self.stall
            .update(time, elapsed, Some(self.stalled_for), window, &thresholds);
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

    /// Level of the weight that does not arrive at model time `now` (s): the higher one of the weight that is lost on the
    /// way and of the weight that was asked for and is not on the bottom.
    pub fn weight(&self, now: f64) -> TransferLevel {
        let [lost, short] = [self.weight.level(now), self.short.level(now)];
        if short.severity > lost.severity { short } else { lost }
    }

    /// Level of the torque that does not arrive at model time `now` (s).
    pub fn torque(&self, now: f64) -> TransferLevel {
        self.torque.level(now)
    }

    /// Level of the drive that stalls on a stuck bit at model time `now` (s).
    pub fn stall(&self, now: f64) -> TransferLevel {
        self.stall.level(now)
    }

    /// The settings in use.
    pub fn settings(&self) -> &TransferSettings {
        &self.settings
    }

    /// Forms the summary again, since a checkpoint does not hold it.
    pub fn refresh(&mut self) {
        self.summarise();
    }

    /// Empties the window and forgets the levels; the audit restarts at zero too.
    pub fn reset(&mut self) {
        self.blocks.fill(Block::EMPTY);
        (self.next, self.filled, self.judged_for) = (0, 0, 0.0);
        (self.current, self.before) = (Block::EMPTY, [0.0; Energies::COUNT]);
        let settings = &self.settings;
        (self.asked, self.asked_for, self.stalled_for) = (0.0, 0.0, 0.0);
        (self.weight, self.short) = (Condition::calm(&settings.weight), Condition::calm(&settings.short));
        (self.torque, self.stall) = (Condition::calm(&settings.torque), Condition::calm(&settings.stall));
        self.summary = Transfer::unknown();
    }
}
