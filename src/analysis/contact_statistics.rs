//! Peak and root mean square between two outputs, since collisions are shorter than the time between them.

use serde::{Deserialize, Serialize};

/// Peak and root mean square of the normal force of every station of one gap layer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactStatistics {
    peak: Vec<f64>,
    square_integral: Vec<f64>,
    duration: f64,
}

impl ContactStatistics {
    /// For that many stations.
    pub fn new(stations: usize) -> Self {
        Self {
            peak: vec![0.0; stations],
            square_integral: vec![0.0; stations],
            duration: 0.0,
        }
    }

    /// Takes the normal forces (N) of a step of `dt` (s), one per station.
    pub fn push(&mut self, dt: f64, normal: impl IntoIterator<Item = f64>) {
        self.duration += dt;
        for ((peak, square), force) in self.peak.iter_mut().zip(&mut self.square_integral).zip(normal) {
            *peak = peak.max(force);
            *square += force * force * dt;
        }
    }

    /// Writes the peak and the root mean square (N) of the interval so far; zeros when nothing was pushed.
    pub fn write(&self, peak: &mut [f64], rms: &mut [f64]) {
        peak.copy_from_slice(&self.peak);
        for (out, square) in rms.iter_mut().zip(&self.square_integral) {
            *out = if self.duration > 0.0 {
                (square / self.duration).sqrt()
            } else {
                0.0
            };
        }
    }

    /// Starts the next interval.
    pub fn restart(&mut self) {
        self.peak.fill(0.0);
        self.square_integral.fill(0.0);
        self.duration = 0.0;
    }
}

/// Root mean square of one quantity over an interval.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RootMeanSquare {
    square_integral: f64,
    duration: f64,
}

impl RootMeanSquare {
    /// Takes the value of a step of `dt` (s).
    pub fn push(&mut self, dt: f64, value: f64) {
        self.push_square(dt, value * value);
    }

    /// Takes the square of the value of a step of `dt` (s), for magnitudes of vectors.
    pub fn push_square(&mut self, dt: f64, square: f64) {
        self.square_integral += square * dt;
        self.duration += dt;
    }

    /// Of the interval so far; 0 when nothing was pushed.
    pub fn value(&self) -> f64 {
        if self.duration > 0.0 {
            (self.square_integral / self.duration).sqrt()
        } else {
            0.0
        }
    }

    /// Starts the next interval.
    pub fn restart(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_collision_keeps_its_peak_and_its_share_of_the_rms() {
        let mut statistics = ContactStatistics::new(2);
        for step in 0..20 {
            statistics.push(1e-3, [if step == 7 { 1000.0 } else { 0.0 }, 50.0]);
        }
        let (mut peak, mut rms) = ([0.0; 2], [0.0; 2]);
        statistics.write(&mut peak, &mut rms);
        assert_eq!(peak, [1000.0, 50.0]);
        assert!(
            (rms[0] - 1000.0 / 20f64.sqrt()).abs() < 1e-9 && (rms[1] - 50.0).abs() < 1e-12,
            "{rms:?}"
        );
        statistics.restart();
        statistics.write(&mut peak, &mut rms);
        assert_eq!((peak, rms), ([0.0; 2], [0.0; 2]));
    }

    #[test]
    fn rms_weighs_steps_by_their_length() {
        let mut rms = RootMeanSquare::default();
        assert_eq!(rms.value(), 0.0);
        rms.push(3.0, 2.0);
        rms.push(1.0, -4.0);
        assert!((rms.value() - 7f64.sqrt()).abs() < 1e-12);
    }
}
