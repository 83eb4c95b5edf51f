//! The last seconds of one watched place, and the points that the estimators see.

use serde::{Deserialize, Serialize};

use super::PlaceSample;

/// Most points that a window is averaged down to: 32 per turn of the tool in a window of four turns.
pub(super) const MAX_POINTS: usize = 128;

/// Ring of the newest samples. Single precision is a ten-millionth of a clearance and halves the memory that each
/// evaluation walks through.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct OrbitWindow {
    records: Vec<[f32; 4]>,
    next: usize,
    filled: usize,
}

/// A window averaged down, oldest first.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Points {
    /// Lateral position (y, z), m.
    pub(super) position: Vec<[f64; 2]>,
    /// Time between two points (s).
    pub(super) spacing: f64,
    /// Largest distance from the gap's centre of any sample (m).
    pub(super) reach: f64,
    /// Largest normal force (N).
    pub(super) peak_force: f64,
    /// Mean part of the time in contact.
    pub(super) contact_duty: f64,
}

impl Points {
    pub(super) fn new() -> Self {
        Self {
            position: Vec::with_capacity(MAX_POINTS),
            spacing: 0.0,
            reach: 0.0,
            peak_force: 0.0,
            contact_duty: 0.0,
        }
    }
}

impl OrbitWindow {
    pub(super) fn new(capacity: usize) -> Self {
        Self {
            records: vec![[0.0; 4]; capacity.max(1)],
            next: 0,
            filled: 0,
        }
    }

    pub(super) fn push(&mut self, sample: &PlaceSample) {
        self.records[self.next] = [
            sample.y as f32,
            sample.z as f32,
            sample.normal_force as f32,
            sample.contact_share as f32,
        ];
        self.next = (self.next + 1) % self.records.len();
        self.filled = (self.filled + 1).min(self.records.len());
    }

    pub(super) fn clear(&mut self) {
        self.next = 0;
        self.filled = 0;
    }

    pub(super) fn filled(&self) -> usize {
        self.filled
    }

    /// Averages the newest `samples` down to at most [`MAX_POINTS`] points.
    pub(super) fn points(&self, samples: usize, sample_interval: f64, out: &mut Points) {
        let samples = samples.min(self.filled);
        let group = samples.div_ceil(MAX_POINTS).max(1);
        let count = samples / group;
        let used = count * group;
        out.position.clear();
        out.spacing = group as f64 * sample_interval;
        let (mut reach_square, mut peak, mut contact) = (0f32, 0f32, 0f64);
        let mut index = (self.next + self.records.len() - used) % self.records.len();
        for _ in 0..count {
            let mut sum = [0f64; 2];
            for _ in 0..group {
                let [y, z, force, share] = self.records[index];
                index += 1;
                if index == self.records.len() {
                    index = 0;
                }
                sum[0] += f64::from(y);
                sum[1] += f64::from(z);
                reach_square = reach_square.max(y * y + z * z);
                peak = peak.max(force);
                contact += f64::from(share);
            }
            out.position.push([sum[0] / group as f64, sum[1] / group as f64]);
        }
        out.reach = f64::from(reach_square).sqrt();
        out.peak_force = f64::from(peak);
        out.contact_duty = if used > 0 { contact / used as f64 } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newest_samples_averaged_oldest_first() {
        let mut window = OrbitWindow::new(300);
        let mut points = Points::new();
        for step in 0..450 {
            let on = step % 2 == 0;
            let sample = PlaceSample {
                y: f64::from(step),
                z: -1.0,
                normal_force: f64::from(step),
                contact_share: if on { 1.0 } else { 0.0 },
            };
            window.push(&sample);
        }
        assert_eq!(window.filled(), 300);
        window.points(1000, 0.01, &mut points);
        // 300 samples in groups of three.
        assert_eq!(points.position.len(), 100);
        assert_eq!(points.position[0], [151.0, -1.0]);
        assert_eq!(points.position[99], [448.0, -1.0]);
        assert!((points.spacing - 0.03).abs() < 1e-15);
        assert_eq!(points.peak_force, 449.0);
        assert_eq!(points.contact_duty, 0.5);
        window.points(10, 0.01, &mut points);
        assert_eq!(points.position.len(), 10);
        window.clear();
        window.points(10, 0.01, &mut points);
        assert!(points.position.is_empty() && points.contact_duty == 0.0);
    }
}
