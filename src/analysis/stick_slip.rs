//! Stick-slip index of the bit: (max - min) / (2 mean) of its speed over a window.

use serde::{Deserialize, Serialize};

use super::settings::StickSlipSettings;

/// The window moves in steps of a block, so that extremes need no queue.
const BLOCKS: usize = 30;

/// Watches the bit's speed. The index is 0 for a steady bit, 1 when it just stops once per period, above 1 when it
/// sticks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StickSlip {
    settings: StickSlipSettings,
    blocks: Vec<Block>,
    current: usize,
    filled: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Block {
    min: f64,
    max: f64,
    integral: f64,
    duration: f64,
}

impl Block {
    const EMPTY: Self = Self {
        min: f64::MAX,
        max: f64::MIN,
        integral: 0.0,
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
        }
    }

    /// Takes the bit's speed (rad/s) over a step of `dt` (s).
    pub fn push(&mut self, dt: f64, speed: f64) {
        // Half a step of slack, so that rounding in the sum does not make blocks of different lengths.
        if self.blocks[self.current].duration + 0.5 * dt >= self.settings.window / BLOCKS as f64 {
            self.current = (self.current + 1) % BLOCKS;
            self.blocks[self.current] = Block::EMPTY;
            self.filled = (self.filled + 1).min(BLOCKS);
        }
        let block = &mut self.blocks[self.current];
        block.min = block.min.min(speed);
        block.max = block.max.max(speed);
        block.integral += speed * dt;
        block.duration += dt;
    }

    /// The index over the window so far; 0 while half of the window is still empty or the mean speed is below the
    /// gate.
    pub fn index(&self) -> f64 {
        let mut total = Block::EMPTY;
        for block in &self.blocks {
            total.min = total.min.min(block.min);
            total.max = total.max.max(block.max);
            total.integral += block.integral;
            total.duration += block.duration;
        }
        if total.duration <= 0.0 || self.filled < BLOCKS / 2 {
            return 0.0;
        }
        let mean = total.integral / total.duration;
        if mean < self.settings.gate_speed {
            0.0
        } else {
            (total.max - total.min) / (2.0 * mean)
        }
    }

    /// Empties the window.
    pub fn reset(&mut self) {
        *self = Self::new(self.settings);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn index(mean: f64, amplitude: f64, seconds: f64) -> f64 {
        let mut watch = StickSlip::new(StickSlipSettings::default());
        let dt = 5e-4;
        for step in 0..(seconds / dt) as usize {
            watch.push(dt, mean + amplitude * (TAU * 1.3 * step as f64 * dt).sin());
        }
        watch.index()
    }

    #[test]
    fn sine_ripple_gives_amplitude_over_mean() {
        assert!((index(4.19, 0.5, 10.0) - 0.5 / 4.19).abs() < 2e-3);
        assert!((index(4.19, 4.19, 10.0) - 1.0).abs() < 1e-2);
    }

    #[test]
    fn silent_below_the_gate_and_while_the_window_fills() {
        assert_eq!(index(0.5, 3.0, 10.0), 0.0);
        assert_eq!(index(4.19, 4.0, 1.0), 0.0);
    }

    #[test]
    fn forgets_what_left_the_window() {
        let mut watch = StickSlip::new(StickSlipSettings::default());
        watch.push(1e-3, 100.0);
        for _ in 0..4000 {
            watch.push(1e-3, 4.0);
        }
        assert_eq!(watch.index(), 0.0);
    }
}
