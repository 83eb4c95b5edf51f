//! The last seconds of one watched station, and the points that the estimators see.
//!
//! Samples are kept one by one only as far back as a fast whirl needs; for longer windows they are summed up in blocks
//! while they come in, so that no evaluation walks through thousands of samples.

use serde::{Deserialize, Serialize};

use super::StationSample;

/// Most points of a long window: 32 per turn of the tool in a window of four turns.
pub(super) const LONG_POINTS: usize = 128;

/// Most points of a short window: 32 per turn of the whirl in a window of two.
pub(super) const SHORT_POINTS: usize = 64;

/// Length of a block (s): 31 per turn of a tool at 120 r/min.
const BLOCK: f64 = 0.016;

/// Lanes of the reductions over blocks: fixed, so that the sums are the same on every machine.
const LANES: usize = 8;

/// Samples and blocks of one station. Single precision is a ten-millionth of a clearance and halves the memory that
/// each evaluation walks through.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct OrbitWindow {
    samples_per_block: usize,
    /// The newest samples (y, z).
    samples: Ring<[f32; 2]>,
    /// Of the same blocks: mean position, largest square of the distance from the gap's centre, largest force, mean
    /// part of the time in contact.
    position: Ring<[f32; 2]>,
    reach_square: Ring<f32>,
    force: Ring<f32>,
    contact: Ring<f32>,
    open: OpenBlock,
}

/// The block that is being filled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct OpenBlock {
    samples: usize,
    position: [f64; 2],
    reach_square: f64,
    force: f64,
    contact: f64,
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

/// How far the motion reaches and how it touches in a window.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Touches {
    /// Largest distance from the gap's centre of any sample (m).
    pub(super) reach: f64,
    /// Largest normal force (N).
    pub(super) peak_force: f64,
    /// Mean part of the time in contact.
    pub(super) contact_duty: f64,
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
            reach_square: Ring::new(blocks),
            force: Ring::new(blocks),
            contact: Ring::new(blocks),
            open: OpenBlock::default(),
        }
    }

    pub(super) fn push(&mut self, sample: &StationSample) {
        self.samples.push([sample.y as f32, sample.z as f32]);
        let open = &mut self.open;
        open.samples += 1;
        open.position[0] += sample.y;
        open.position[1] += sample.z;
        open.reach_square = open.reach_square.max(sample.y * sample.y + sample.z * sample.z);
        open.force = open.force.max(sample.normal_force);
        open.contact += sample.contact_share;
        if open.samples == self.samples_per_block {
            let block = std::mem::take(open);
            let part = 1.0 / block.samples as f64;
            self.position.push(block.position.map(|sum| (sum * part) as f32));
            self.reach_square.push(block.reach_square as f32);
            self.force.push(block.force as f32);
            self.contact.push((block.contact * part) as f32);
        }
    }

    pub(super) fn clear(&mut self) {
        self.samples.clear();
        self.position.clear();
        self.reach_square.clear();
        self.force.clear();
        self.contact.clear();
        self.open = OpenBlock::default();
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

    /// Over the newest `samples`, in whole blocks, and what has come in since the last one.
    pub(super) fn touches(&self, samples: usize) -> Touches {
        let count = samples / self.samples_per_block;
        let largest = |ring: &Ring<f32>| {
            let lanes = fold(
                ring.newest(count),
                |most, value| if value > most { value } else { most },
            );
            f64::from(lanes.into_iter().fold(0f32, f32::max))
        };
        let contact = self.contact.newest(count);
        let in_contact: f64 = fold(contact, |sum, value| sum + value).into_iter().map(f64::from).sum();
        let open = &self.open;
        let blocks = contact.len() as f64 + open.samples as f64 / self.samples_per_block as f64;
        Touches {
            reach: largest(&self.reach_square).max(open.reach_square).sqrt(),
            peak_force: largest(&self.force).max(open.force),
            contact_duty: if blocks > 0.0 {
                (in_contact + open.contact / self.samples_per_block as f64) / blocks
            } else {
                0.0
            },
        }
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
        let touches = filled(2002).touches(1000);
        assert_eq!(touches.peak_force, 2001.0);
        assert!((touches.reach - 2001f64.hypot(1.0)).abs() < 1e-9);
        assert_eq!(touches.contact_duty, 0.5);
        let mut window = filled(30);
        assert_eq!(window.touches(1000).peak_force, 29.0);
        window.clear();
        assert_eq!(window.touches(1000), Touches::default());
        let mut points = Points::new();
        window.short_points(10, 4e-3, &mut points);
        assert!(points.position.is_empty());
    }
}
