//! The last seconds of one watched station, and the points for the estimators.
//!
//! Single samples are kept only as far back as a fast whirl needs. For longer windows samples are averaged in blocks as
//! they arrive, so that no evaluation processes thousands of samples.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::StationSample;

/// Most points of a long window: 32 per turn of the tool in a window of four turns.
pub(super) const LONG_POINTS: usize = 128;

/// Most points of a short window: 32 per turn of the whirl in a window of two.
pub(super) const SHORT_POINTS: usize = 64;

/// Length of a block (s): 31 per turn of a tool at 120 r/min.
const BLOCK: f64 = 0.016;

/// Impulse above the resting one from which a block counts as an impact (N s): a link of 2.8 kg that rebounds at 0.18
/// m/s, the speed after a free fall through a fifth of the default clearance.
const IMPACT: f64 = 1.0;

/// Smaller swings (rad) do not count as a change of direction: they are noise and rattling at the wall.
const SWING: f64 = 0.125 * TAU;

/// Lanes of the reductions over blocks. The number is fixed, so that the sums are the same on every machine.
const LANES: usize = 8;

/// Samples and blocks of one station. Single precision resolves a ten-millionth of a clearance and halves the memory
/// that each evaluation reads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct OrbitWindow {
    samples_per_block: usize,
    /// The newest samples (y, z).
    samples: Ring<[f32; 2]>,
    /// Per block: mean position, angle (rad) turned about the gap's centre, largest squared distance from it, largest
    /// force, mean share of the time in contact, impulse (N s), work of the friction (J).
    position: Ring<[f32; 2]>,
    turned: Ring<f32>,
    reach_square: Ring<f32>,
    force: Ring<f32>,
    contact: Ring<f32>,
    impulse: Ring<f32>,
    friction_work: Ring<f32>,
    open: OpenBlock,
    /// The newest position, none before the first sample.
    last: Option<[f64; 2]>,
}

/// The block that is being filled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct OpenBlock {
    samples: usize,
    position: [f64; 2],
    turned: f64,
    reach_square: f64,
    force: f64,
    contact: f64,
    impulse: f64,
    friction_work: f64,
}

/// A window averaged down, oldest first.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Points {
    /// Lateral position (y, z), m.
    pub(super) position: Vec<[f64; 2]>,
    /// Time between two points (s).
    pub(super) spacing: f64,
}

impl Points {
    pub(super) fn new() -> Self {
        Self {
            position: Vec::with_capacity(LONG_POINTS),
            spacing: 0.0,
        }
    }

    pub(super) fn duration(&self) -> f64 {
        self.position.len() as f64 * self.spacing
    }

    /// Averages `group` records at a time, so that the newest one is in.
    fn average(&mut self, records: &[[f32; 2]], group: usize, record_interval: f64) {
        self.spacing = group as f64 * record_interval;
        let part = 1.0 / group as f64;
        self.position.clear();
        let mean = |records: &[[f32; 2]]| {
            let sum = records.iter().fold([0f64; 2], |sum, [y, z]| {
                [sum[0] + f64::from(*y), sum[1] + f64::from(*z)]
            });
            sum.map(|sum| sum * part)
        };
        let oldest = records.len() % group;
        self.position.extend(records[oldest..].chunks_exact(group).map(mean));
    }
}

/// The newest values, always in one piece: each is written twice, half a buffer apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Ring<T> {
    values: Vec<T>,
    next: usize,
    filled: usize,
}

impl<T: Copy + Default> Ring<T> {
    fn new(length: usize) -> Self {
        Self {
            values: vec![T::default(); 2 * length],
            next: 0,
            filled: 0,
        }
    }

    fn length(&self) -> usize {
        self.values.len() / 2
    }

    fn push(&mut self, value: T) {
        let length = self.length();
        self.values[self.next] = value;
        self.values[self.next + length] = value;
        self.next += 1;
        if self.next == length {
            self.next = 0;
        }
        self.filled = (self.filled + 1).min(length);
    }

    /// The newest `count`, or as many as there are, oldest first.
    fn newest(&self, count: usize) -> &[T] {
        let end = self.next + self.length();
        &self.values[end - count.min(self.filled)..end]
    }

    fn clear(&mut self) {
        (self.next, self.filled) = (0, 0);
    }
}

/// Revolution of the motion about the gap's centre in a window, whatever the motion's mean position.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Round {
    /// Turns about the gap's centre, positive from y towards z.
    pub(super) net: f64,
    /// The same with every swing counted as positive; reversals of less than an eighth of a turn are ignored.
    pub(super) gross: f64,
}

impl Round {
    /// Net over gross turns: 1 for a motion in one direction only, 0 for one that swings.
    pub(super) fn directness(&self) -> f64 {
        if self.gross > 0.0 {
            self.net.abs() / self.gross
        } else {
            0.0
        }
    }
}

/// Extent and contact of the motion in a window.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Touches {
    /// Largest distance from the gap's centre of any sample (m).
    pub(super) largest_distance: f64,
    /// Largest normal force (N).
    pub(super) peak_force: f64,
    /// Mean part of the time in contact.
    pub(super) contact_duty: f64,
    /// Largest impulse of a block above the mean of the window (N s); zero for a body that rests or rolls.
    pub(super) impulse: f64,
    /// Blocks per second whose impulse above the mean reaches [`IMPACT`] (1/s).
    pub(super) impact_rate: f64,
    /// Mean power of the friction (W).
    pub(super) friction_power: f64,
}

impl OrbitWindow {
    /// For windows of up to `longest` s of samples that are `sample_interval` s apart.
    pub(super) fn new(longest: f64, sample_interval: f64) -> Self {
        let samples_per_block = ((BLOCK / sample_interval).round() as usize).max(1);
        let blocks = ((longest / (samples_per_block as f64 * sample_interval)).ceil() as usize).max(1);
        Self {
            samples_per_block,
            samples: Ring::new(SHORT_POINTS * samples_per_block),
            position: Ring::new(blocks),
            turned: Ring::new(blocks),
            reach_square: Ring::new(blocks),
            force: Ring::new(blocks),
            contact: Ring::new(blocks),
            impulse: Ring::new(blocks),
            friction_work: Ring::new(blocks),
            open: OpenBlock::default(),
            last: None,
        }
    }

    pub(super) fn push(&mut self, sample: &StationSample) {
        self.samples.push([sample.y as f32, sample.z as f32]);
        let at = [sample.y, sample.z];
        let open = &mut self.open;
        open.samples += 1;
        if let Some([y, z]) = self.last {
            open.turned += libm::atan2(y * at[1] - z * at[0], y * at[0] + z * at[1]);
        }
        self.last = Some(at);
        open.position[0] += sample.y;
        open.position[1] += sample.z;
        open.impulse += sample.impulse;
        open.friction_work += sample.friction_work;
        open.reach_square = open.reach_square.max(sample.y * sample.y + sample.z * sample.z);
        open.force = open.force.max(sample.normal_force);
        open.contact += sample.contact_share;
        if open.samples == self.samples_per_block {
            let block = std::mem::take(open);
            let part = 1.0 / block.samples as f64;
            self.position.push(block.position.map(|sum| (sum * part) as f32));
            self.turned.push(block.turned as f32);
            self.reach_square.push(block.reach_square as f32);
            self.force.push(block.force as f32);
            self.contact.push((block.contact * part) as f32);
            self.impulse.push(block.impulse as f32);
            self.friction_work.push(block.friction_work as f32);
        }
    }

    pub(super) fn clear(&mut self) {
        self.samples.clear();
        self.position.clear();
        self.turned.clear();
        self.reach_square.clear();
        self.force.clear();
        self.contact.clear();
        self.impulse.clear();
        self.friction_work.clear();
        self.open = OpenBlock::default();
        self.last = None;
    }

    /// Samples in complete blocks, the longest window there is.
    pub(super) fn filled(&self) -> usize {
        self.position.filled * self.samples_per_block
    }

    /// The newest `samples`, in whole blocks, averaged down to at most [`LONG_POINTS`] points.
    pub(super) fn long_points(&self, samples: usize, sample_interval: f64, out: &mut Points) {
        self.block_points(samples, LONG_POINTS, sample_interval, out);
    }

    /// The newest `samples` averaged down to at most [`SHORT_POINTS`] points.
    pub(super) fn short_points(&self, samples: usize, sample_interval: f64, out: &mut Points) {
        if samples > self.samples.length() {
            self.block_points(samples, SHORT_POINTS, sample_interval, out);
            return;
        }
        let records = self.samples.newest(samples);
        let group = records.len().div_ceil(SHORT_POINTS).max(1);
        out.average(records, group, sample_interval);
    }

    fn block_points(&self, samples: usize, most: usize, sample_interval: f64, out: &mut Points) {
        let records = self.position.newest(samples / self.samples_per_block);
        let group = records.len().div_ceil(most).max(1);
        out.average(records, group, self.samples_per_block as f64 * sample_interval);
    }

    /// Revolution of the newest `samples`, in whole blocks, about the gap's centre.
    pub(super) fn round(&self, samples: usize) -> Round {
        let (mut angle, mut gross) = (0.0f64, 0.0f64);
        // The current swing: its start, and its extremes so far.
        let (mut from, mut high, mut low) = (0.0f64, 0.0f64, 0.0f64);
        let mut rising = None;
        for turned in self.turned.newest(samples / self.samples_per_block) {
            angle += f64::from(*turned);
            (high, low) = (high.max(angle), low.min(angle));
            match rising {
                None if high - low > SWING => {
                    rising = Some(angle == high);
                    from = if angle == high { low } else { high };
                }
                Some(true) if high - angle > SWING => {
                    gross += high - from;
                    (from, low, rising) = (high, angle, Some(false));
                }
                Some(false) if angle - low > SWING => {
                    gross += from - low;
                    (from, high, rising) = (low, angle, Some(true));
                }
                _ => {}
            }
        }
        gross += match rising {
            Some(true) => high - from,
            Some(false) => from - low,
            None => 0.0,
        };
        Round {
            net: angle / TAU,
            gross: gross / TAU,
        }
    }

    /// Extent and contact over the newest `samples`, `sample_interval` (s) apart, in whole blocks. Force, distance and
    /// contact include the block that is being filled.
    pub(super) fn touches(&self, samples: usize, sample_interval: f64) -> Touches {
        let count = samples / self.samples_per_block;
        let largest = |ring: &Ring<f32>| {
            let lanes = fold(
                ring.newest(count),
                |most, value| if value > most { value } else { most },
            );
            f64::from(lanes.into_iter().fold(0f32, f32::max))
        };
        let sum = |ring: &Ring<f32>| -> f64 {
            let lanes = fold(ring.newest(count), |sum, value| sum + value);
            lanes.into_iter().map(f64::from).sum()
        };
        let open = &self.open;
        let closed = self.contact.newest(count).len() as f64;
        let blocks = closed + open.samples as f64 / self.samples_per_block as f64;
        let mut touches = Touches {
            largest_distance: largest(&self.reach_square).max(open.reach_square).sqrt(),
            peak_force: largest(&self.force).max(open.force),
            ..Touches::default()
        };
        if blocks > 0.0 {
            touches.contact_duty = (sum(&self.contact) + open.contact / self.samples_per_block as f64) / blocks;
        }
        if closed > 0.0 {
            let duration = closed * self.samples_per_block as f64 * sample_interval;
            let mean = sum(&self.impulse) / closed;
            let least = (mean + IMPACT) as f32;
            let strikes = fold(self.impulse.newest(count), |strikes, impulse| {
                strikes + f32::from(u8::from(impulse >= least))
            });
            touches.impulse = (largest(&self.impulse) - mean).max(0.0);
            touches.impact_rate = strikes.into_iter().map(f64::from).sum::<f64>() / duration;
            touches.friction_power = sum(&self.friction_work) / duration;
        }
        touches
    }
}

/// Takes values into lanes in turn, from zero.
fn fold(values: &[f32], combine: impl Fn(f32, f32) -> f32) -> [f32; LANES] {
    let mut lanes = [0f32; LANES];
    let chunks = values.chunks_exact(LANES);
    let rest = chunks.remainder();
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane = combine(*lane, *value);
        }
    }
    for (lane, value) in lanes.iter_mut().zip(rest) {
        *lane = combine(*lane, *value);
    }
    lanes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(count: u32) -> OrbitWindow {
        let mut window = OrbitWindow::new(6.0, 4e-3);
        for step in 0..count {
            window.push(&StationSample {
                y: f64::from(step),
                z: -1.0,
                normal_force: f64::from(step),
                contact_share: f64::from(step % 2),
                impulse: if step % 40 == 0 { 3.0 } else { 0.1 },
                friction_work: 0.02,
            });
        }
        window
    }

    #[test]
    fn newest_blocks_averaged_oldest_first() {
        let window = filled(2002);
        let mut points = Points::new();
        assert_eq!(window.filled(), 1500);
        window.long_points(1500, 4e-3, &mut points);
        // 375 blocks of four samples, three blocks to a point; the open block of two samples is not in yet.
        assert_eq!(points.position.len(), 125);
        assert_eq!(points.position[0], [505.5, -1.0]);
        assert_eq!(points.position[124], [1993.5, -1.0]);
        assert!((points.spacing - 0.048).abs() < 1e-15 && (points.duration() - 6.0).abs() < 1e-12);
    }

    #[test]
    fn short_windows_see_single_samples_or_blocks() {
        let window = filled(2002);
        let mut points = Points::new();
        window.short_points(50, 4e-3, &mut points);
        assert_eq!((points.position.len(), points.position[49][0]), (50, 2001.0));
        window.short_points(250, 4e-3, &mut points);
        assert_eq!((points.position.len(), points.position[61][0]), (62, 1999.5));
        window.short_points(600, 4e-3, &mut points);
        assert_eq!((points.position.len(), points.position[49][0]), (50, 1993.5));
    }

    #[test]
    fn touches_count_the_open_block_too() {
        let touches = filled(2002).touches(1000, 4e-3);
        assert_eq!(touches.peak_force, 2001.0);
        assert!((touches.largest_distance - 2001f64.hypot(1.0)).abs() < 1e-9);
        assert_eq!(touches.contact_duty, 0.5);
        // One block in ten has 3.3 N s, the others 0.4: 0.69 in the mean.
        assert!((touches.impulse - 2.61).abs() < 1e-4, "{touches:?}");
        assert!((touches.impact_rate - 6.25).abs() < 1e-9 && (touches.friction_power - 5.0).abs() < 1e-4);
        let mut window = filled(30);
        assert_eq!(window.touches(1000, 4e-3).peak_force, 29.0);
        window.clear();
        assert_eq!(window.touches(1000, 4e-3), Touches::default());
        let mut points = Points::new();
        window.short_points(10, 4e-3, &mut points);
        assert!(points.position.is_empty());
    }
}
