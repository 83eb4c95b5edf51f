//! The orbit in frequency: the spectrum of y + i z, whose positive lines turn forward (y towards z) and whose
//! negative ones turn backward.
//!
//! The transform is a plain radix-2 one with a fixed order of operations: libraries choose their code by the
//! processor, and then the same recording would not give the same bits on another machine.

use std::f64::consts::TAU;

use super::orbit_window::{LONG_POINTS, SHORT_POINTS};

/// Lines of the transform; windows with few points take half of it.
const SIZE: usize = LONG_POINTS;
const HALF_SIZE: usize = SHORT_POINTS;

/// Figures of the spectrum's lines.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Lines {
    /// (forward - backward) / (forward + backward) power, -1 to 1.
    pub(super) direction: f64,
    /// Rate of the strongest line (rad/s), its sign that of the stronger side.
    pub(super) rate: f64,
    /// Part of the power in the strongest line and its mirror image, 0 to 1.
    pub(super) concentration: f64,
    /// Magnitude (rad/s) of the strongest line after weighting the power with frequency^1.5. The power of a jump of the
    /// centre falls with frequency^2 and would hide a whirl that has just begun at the lowest lines. The weight removes
    /// this, and does not yet favour white noise.
    pub(super) pace: f64,
}

/// Tables and scratch of the transform.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FullSpectrum {
    /// Roots of unity by stage, so that each stage reads them in order.
    twiddle: Vec<[f64; 2]>,
    /// Bit-reversed index of each point.
    reversed: Vec<usize>,
    line: Vec<[f64; 2]>,
    power: Vec<f64>,
    /// Weight of each line in the pace.
    emphasis: Vec<f64>,
}

impl FullSpectrum {
    pub(super) fn new() -> Self {
        let mut twiddle = Vec::with_capacity(SIZE);
        let mut half = 1;
        while half < SIZE {
            twiddle.extend((0..half).map(|index| {
                let (sin, cos) = libm::sincos(-0.5 * TAU * index as f64 / half as f64);
                [cos, sin]
            }));
            half *= 2;
        }
        Self {
            twiddle,
            reversed: (0..SIZE)
                .map(|index| index.reverse_bits() >> (usize::BITS - SIZE.trailing_zeros()))
                .collect(),
            line: vec![[0.0; 2]; SIZE],
            power: vec![0.0; SIZE],
            emphasis: (0..SIZE).map(|index| index as f64 * (index as f64).sqrt()).collect(),
        }
    }

    /// Lines of centred points that are `spacing` (s) apart, with a Hann window.
    pub(super) fn lines(&mut self, position: &[[f64; 2]], spacing: f64) -> Lines {
        let count = position.len().min(SIZE);
        // Fewer points give no spectrum: two lobes of the window would fill it.
        if count < 8 {
            return Lines::default();
        }
        // Half the size, where that is enough, halves the cost of the transform.
        let size = if count > HALF_SIZE { SIZE } else { HALF_SIZE };
        self.fill(&position[..count], size);
        self.transform(size);
        for (power, [re, im]) in self.power[..size].iter_mut().zip(&self.line) {
            *power = re * re + im * im;
        }
        // The remainder of the centre leaks into the lines around zero, which are left out.
        let first = size.div_ceil(count);
        let half = size / 2;
        let (mut forward, mut backward, mut peak, mut peak_power) = (0.0, 0.0, first, 0.0);
        let (mut pace, mut pace_power) = (first, 0.0);
        // The transform of y + i z is not symmetric: index k is the forward line, size - k the backward one.
        for index in first..half {
            let (plus, minus) = (self.power[index], self.power[size - index]);
            forward += plus;
            backward += minus;
            // Peak and pace look at both directions together. Otherwise the
            // stronger of two near lines would decide by a little noise.
            let both = plus + minus;
            if both > peak_power {
                (peak, peak_power) = (index, both);
            }
            // The emphasis lets a fast line count against a larger slow one,
            // because the pace sets the length of the short window.
            let weighed = both * self.emphasis[index];
            if weighed > pace_power {
                (pace, pace_power) = (index, weighed);
            }
        }
        let total = forward + backward;
        // Points without any motion have no line.
        if total <= 0.0 {
            return Lines::default();
        }
        // A Hann window's main lobe reaches two resolution steps to each side.
        let lobe = (2 * size).div_ceil(count);
        let around = peak.saturating_sub(lobe).max(first)..=(peak + lobe).min(half - 1);
        let within: f64 = around.map(|index| self.power[index] + self.power[size - index]).sum();
        // The direction of the peak decides the sign of the rate, the energy of all lines the direction of the motion.
        let is_forward = self.power[peak] >= self.power[size - peak];
        let step = TAU / (size as f64 * spacing);
        let rate = step * (peak as f64 + self.peak_offset(peak, size, is_forward));
        Lines {
            direction: (forward - backward) / total,
            rate: if is_forward { rate } else { -rate },
            concentration: within / total,
            pace: step * pace as f64,
        }
    }

    /// Offset of the peak from its index: the vertex of a parabola through the logarithms of three lines.
    fn peak_offset(&self, peak: usize, size: usize, is_forward: bool) -> f64 {
        let log = |index: usize| {
            let at = if is_forward { index } else { (size - index) % size };
            libm::log(self.power[at].max(f64::MIN_POSITIVE))
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
    fn fill(&mut self, position: &[[f64; 2]], size: usize) {
        let shift = SIZE.trailing_zeros() - size.trailing_zeros();
        self.line[..size].fill([0.0; 2]);
        // cos of the window by rotation, one multiplication per point instead of one cosine.
        let (step_sin, step_cos) = libm::sincos(TAU / position.len() as f64);
        let (mut sin, mut cos) = libm::sincos(0.5 * TAU / position.len() as f64);
        for ([y, z], index) in position.iter().zip(&self.reversed) {
            let weight = 0.5 * (1.0 - cos);
            self.line[index >> shift] = [weight * y, weight * z];
            (cos, sin) = (cos * step_cos - sin * step_sin, sin * step_cos + cos * step_sin);
        }
    }

    fn transform(&mut self, size: usize) {
        let lines = &mut self.line[..size];
        // The first two stages rotate by quarter turns only, which are exchanges and signs instead of products.
        for quad in lines.chunks_exact_mut(4) {
            let (a, b) = sum_and_difference(quad[0], quad[1]);
            let (c, d) = sum_and_difference(quad[2], quad[3]);
            (quad[0], quad[2]) = sum_and_difference(a, c);
            (quad[1], quad[3]) = sum_and_difference(b, [d[1], -d[0]]);
        }
        // Decimation in time: each stage joins pairs of transforms of `half` points.
        let mut half = 4;
        while half < size {
            let twiddle = &self.twiddle[half - 1..2 * half - 1];
            for block in lines.chunks_exact_mut(2 * half) {
                let (lower, upper) = block.split_at_mut(half);
                for ((a, b), [cos, sin]) in lower.iter_mut().zip(upper).zip(twiddle) {
                    let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                    (*a, *b) = sum_and_difference(*a, turned);
                }
            }
            half *= 2;
        }
    }
}

fn sum_and_difference(a: [f64; 2], b: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    ([a[0] + b[0], a[1] + b[1]], [a[0] - b[0], a[1] - b[1]])
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
        for size in [HALF_SIZE, SIZE] {
            let position: Vec<_> = (0..size)
                .map(|k| [(k as f64 * 0.37).sin(), (k as f64 * 0.11).cos()])
                .collect();
            spectrum.fill(&position, size);
            spectrum.transform(size);
            for line in [0, 1, 7, size / 2, size - 1] {
                let mut sum = [0.0; 2];
                for (k, [y, z]) in position.iter().enumerate() {
                    let weight = 0.5 * (1.0 - (TAU * (k as f64 + 0.5) / size as f64).cos());
                    let (sin, cos) = (-TAU * (line * k) as f64 / size as f64).sin_cos();
                    sum[0] += weight * (y * cos - z * sin);
                    sum[1] += weight * (y * sin + z * cos);
                }
                let got = spectrum.line[line];
                assert!(
                    (got[0] - sum[0]).abs() < 1e-10 && (got[1] - sum[1]).abs() < 1e-10,
                    "{line} of {size}: {got:?} {sum:?}"
                );
            }
        }
    }

    #[test]
    fn circles_give_their_rate_and_direction() {
        let mut spectrum = FullSpectrum::new();
        for rate in [4.0, -4.0, 15.5, -33.0] {
            for count in [40, 64, 70, 128] {
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
