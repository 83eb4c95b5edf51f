//! The orbit in frequency: the spectrum of y + i z, whose positive lines turn forward (y towards z) and whose
//! negative ones turn backward.
//!
//! The transform is a plain radix-2 one with a fixed order of operations: libraries choose their code by the
//! processor, and then the same recording would not give the same bits on another machine.

use std::f64::consts::TAU;

use super::orbit_window::MAX_POINTS;

/// Twice the points: the padding halves the distance between lines, which the peak's parabola needs.
const SIZE: usize = 2 * MAX_POINTS;

/// What the lines say.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Lines {
    /// (forward - backward) / (forward + backward) power, -1 to 1.
    pub(super) direction: f64,
    /// Rate of the strongest line (rad/s), its sign that of the stronger side.
    pub(super) rate: f64,
    /// Part of the power in the strongest line and its mirror image, 0 to 1.
    pub(super) concentration: f64,
    /// Size (rad/s) of the line that is strongest when power is weighed by frequency^1.5. A jump of the centre has its
    /// power, which falls with frequency^2, at the lowest lines and would hide a whirl that has just begun; weighed, it
    /// does not, and white noise does not take its place yet.
    pub(super) pace: f64,
}

/// Tables and scratch of the transform.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FullSpectrum {
    twiddle: Vec<[f64; 2]>,
    line: Vec<[f64; 2]>,
    power: Vec<f64>,
}

impl FullSpectrum {
    pub(super) fn new() -> Self {
        let twiddle = (0..SIZE / 2)
            .map(|index| {
                let (sin, cos) = (-TAU * index as f64 / SIZE as f64).sin_cos();
                [cos, sin]
            })
            .collect();
        Self {
            twiddle,
            line: vec![[0.0; 2]; SIZE],
            power: vec![0.0; SIZE],
        }
    }

    /// Lines of centred points that are `spacing` (s) apart, with a Hann window.
    pub(super) fn lines(&mut self, position: &[[f64; 2]], spacing: f64) -> Lines {
        let count = position.len().min(MAX_POINTS);
        if count < 8 {
            return Lines::default();
        }
        self.fill(&position[..count]);
        self.transform();
        for (power, [re, im]) in self.power.iter_mut().zip(&self.line) {
            *power = re * re + im * im;
        }
        // What is left of the centre leaks into the lines around zero.
        let first = SIZE.div_ceil(2 * count);
        let half = SIZE / 2;
        let (mut forward, mut backward, mut peak, mut peak_power) = (0.0, 0.0, first, 0.0);
        let (mut pace, mut pace_power) = (first, 0.0);
        for index in first..half {
            let (plus, minus) = (self.power[index], self.power[SIZE - index]);
            forward += plus;
            backward += minus;
            if plus + minus > peak_power {
                (peak, peak_power) = (index, plus + minus);
            }
            let frequency = index as f64;
            let weighed = (plus + minus) * frequency * frequency.sqrt();
            if weighed > pace_power {
                (pace, pace_power) = (index, weighed);
            }
        }
        let total = forward + backward;
        if total <= 0.0 {
            return Lines::default();
        }
        // A Hann window's main lobe reaches two resolution steps to each side.
        let lobe = (2 * SIZE).div_ceil(count);
        let around = peak.saturating_sub(lobe).max(first)..=(peak + lobe).min(half - 1);
        let within: f64 = around.map(|index| self.power[index] + self.power[SIZE - index]).sum();
        let is_forward = self.power[peak] >= self.power[SIZE - peak];
        let index = peak as f64 + self.peak_offset(peak, is_forward);
        let rate = TAU * index / (SIZE as f64 * spacing);
        Lines {
            direction: (forward - backward) / total,
            rate: if is_forward { rate } else { -rate },
            concentration: within / total,
            pace: TAU * pace as f64 / (SIZE as f64 * spacing),
        }
    }

    /// Offset of the peak from its index: the vertex of a parabola through the logarithms of three lines.
    fn peak_offset(&self, peak: usize, is_forward: bool) -> f64 {
        let log = |index: usize| {
            let at = if is_forward { index } else { (SIZE - index) % SIZE };
            self.power[at].max(f64::MIN_POSITIVE).ln()
        };
        let (left, middle, right) = (log(peak - 1), log(peak), log(peak + 1));
        let curvature = left - 2.0 * middle + right;
        if curvature < 0.0 {
            (0.5 * (left - right) / curvature).clamp(-0.5, 0.5)
        } else {
            0.0
        }
    }

    /// Windowed points in bit-reversed order, zeros behind.
    fn fill(&mut self, position: &[[f64; 2]]) {
        let shift = usize::BITS - SIZE.trailing_zeros();
        self.line.fill([0.0; 2]);
        // cos of the window by rotation, one multiplication per point instead of one cosine.
        let (step_sin, step_cos) = (TAU / position.len() as f64).sin_cos();
        let (mut sin, mut cos) = (0.5 * TAU / position.len() as f64).sin_cos();
        for (index, [y, z]) in position.iter().enumerate() {
            let weight = 0.5 * (1.0 - cos);
            self.line[index.reverse_bits() >> shift] = [weight * y, weight * z];
            (cos, sin) = (cos * step_cos - sin * step_sin, sin * step_cos + cos * step_sin);
        }
    }

    fn transform(&mut self) {
        let mut half = 1;
        while half < SIZE {
            let stride = SIZE / (2 * half);
            for block in self.line.chunks_exact_mut(2 * half) {
                let (lower, upper) = block.split_at_mut(half);
                for ((a, b), [cos, sin]) in lower.iter_mut().zip(upper).zip(self.twiddle.iter().step_by(stride)) {
                    let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                    *b = [a[0] - turned[0], a[1] - turned[1]];
                    *a = [a[0] + turned[0], a[1] + turned[1]];
                }
            }
            half *= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(rate: f64, amplitude: f64, count: usize, spacing: f64) -> Vec<[f64; 2]> {
        (0..count)
            .map(|index| {
                let (sin, cos) = (rate * index as f64 * spacing + 0.4).sin_cos();
                [amplitude * cos, amplitude * sin]
            })
            .collect()
    }

    #[test]
    fn transform_equals_the_sum_it_stands_for() {
        let mut spectrum = FullSpectrum::new();
        let position: Vec<_> = (0..MAX_POINTS)
            .map(|k| [(k as f64 * 0.37).sin(), (k as f64 * 0.11).cos()])
            .collect();
        spectrum.fill(&position);
        spectrum.transform();
        for line in [0usize, 1, 7, 100, 255] {
            let mut sum = [0.0; 2];
            for (k, [y, z]) in position.iter().enumerate() {
                let weight = 0.5 * (1.0 - (TAU * (k as f64 + 0.5) / MAX_POINTS as f64).cos());
                let (sin, cos) = (-TAU * (line * k) as f64 / SIZE as f64).sin_cos();
                sum[0] += weight * (y * cos - z * sin);
                sum[1] += weight * (y * sin + z * cos);
            }
            let got = spectrum.line[line];
            assert!(
                (got[0] - sum[0]).abs() < 1e-10 && (got[1] - sum[1]).abs() < 1e-10,
                "{line}: {got:?} {sum:?}"
            );
        }
    }

    #[test]
    fn circles_give_their_rate_and_direction() {
        let mut spectrum = FullSpectrum::new();
        for rate in [4.0, -4.0, 15.5, -33.0] {
            for count in [70, 128] {
                let lines = spectrum.lines(&circle(rate, 2.0, count, 0.045), 0.045);
                assert!((lines.rate / rate - 1.0).abs() < 0.02, "{lines:?} for {rate}");
                assert!(
                    (lines.direction - rate.signum()).abs() < 0.02 && lines.concentration > 0.98,
                    "{lines:?}"
                );
            }
        }
    }

    #[test]
    fn two_lines_share_the_direction_by_power() {
        let mut spectrum = FullSpectrum::new();
        let mut position = circle(6.0, 1.0, 128, 0.045);
        for (point, other) in position.iter_mut().zip(circle(-15.0, 0.5, 128, 0.045)) {
            point[0] += other[0];
            point[1] += other[1];
        }
        let lines = spectrum.lines(&position, 0.045);
        assert!((lines.direction - 0.6).abs() < 0.03, "{lines:?}");
        assert!(
            (lines.concentration - 0.8).abs() < 0.03 && (lines.rate - 6.0).abs() < 0.2,
            "{lines:?}"
        );
    }
}
