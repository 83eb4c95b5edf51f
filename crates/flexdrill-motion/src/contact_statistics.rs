//! Peak and root mean square between two outputs: collisions are shorter than the time between outputs.

use serde::{Deserialize, Serialize};

/// Peak and root mean square of the normal force of every station of one gap layer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactStatistics {
    peak: Vec<f64>,
    square_integral: Vec<f64>,
    duration: f64,
}

impl ContactStatistics {
    /// Statistics of `stations` stations.
    pub fn new(stations: usize) -> Self {
        Self {
            peak: vec![0.0; stations],
            square_integral: vec![0.0; stations],
            duration: 0.0,
        }
    }

    /// Takes the normal force (N) of a closed gap in a step of `dt` (s).
    pub fn touch(&mut self, station: usize, dt: f64, normal: f64) {
        self.peak[station] = self.peak[station].max(normal);
        self.square_integral[station] += normal * normal * dt;
    }

    /// Ends a step of `dt` (s); the gaps of all other stations were open.
    pub fn advance(&mut self, dt: f64) {
        self.duration += dt;
    }

    /// Writes the peak and the root mean square (N) of the interval so far; zeros at its start.
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

/// Root mean square, peak and impulse of one quantity over an interval.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RootMeanSquare {
    square_integral: f64,
    integral: f64,
    peak: f64,
    duration: f64,
}

impl RootMeanSquare {
    /// Takes the value of a step of `dt` (s).
    pub fn push(&mut self, dt: f64, value: f64) {
        self.push_square(dt, value * value);
    }

    /// Takes the square of the value of a step of `dt` (s), for magnitudes of vectors.
    pub fn push_square(&mut self, dt: f64, square: f64) {
        let size = square.sqrt();
        self.square_integral += square * dt;
        self.integral += size * dt;
        self.peak = self.peak.max(size);
        self.duration += dt;
    }

    /// Largest magnitude of the interval so far.
    pub fn peak(&self) -> f64 {
        self.peak
    }

    /// Integral of the magnitude over the interval so far: of an acceleration, the speed that it could have changed.
    pub fn impulse(&self) -> f64 {
        self.integral
    }

    /// Root mean square of the interval so far; 0 at its start.
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

/// Means of three quantities over an interval, in which every step counts. An instant per message would alias with a
/// ripple near a multiple of the messages' rate, and stay wrong for as long as the speed stays.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Means {
    integrals: [f64; 3],
    duration: f64,
}

impl Means {
    /// Takes the values of a step of `dt` (s).
    pub fn push(&mut self, dt: f64, values: [f64; 3]) {
        for (integral, value) in self.integrals.iter_mut().zip(values) {
            *integral += value * dt;
        }
        self.duration += dt;
    }

    /// Means of the interval so far; `None` at its start.
    pub fn value(&self) -> Option<[f64; 3]> {
        (self.duration > 0.0).then(|| self.integrals.map(|integral| integral / self.duration))
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
            if step == 7 {
                statistics.touch(0, 1e-3, 1000.0);
            }
            statistics.touch(1, 1e-3, 50.0);
            statistics.advance(1e-3);
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
        assert_eq!((rms.peak(), rms.impulse()), (4.0, 10.0));
    }

    /// A ripple of 49.9 and of 50 Hz about 100 N m, published 50 times per second. The instants show a slow swing of 0.1
    /// Hz, and for 50 Hz a constant error; the means show what is there.
    #[test]
    fn a_ripple_that_aliases_with_the_messages_does_not_show_in_the_means() {
        const DT: f64 = 0.5e-3;
        for (frequency, instants_swing) in [(50.0, 0.0), (49.9, 60.0)] {
            let torque = |time: f64| 100.0 + 30.0 * (std::f64::consts::TAU * frequency * time + 1.0).sin();
            let (mut means, mut instants, mut published) = (Means::default(), Vec::new(), Vec::new());
            for step in 1..=20_000 {
                let time = DT * f64::from(step);
                means.push(DT, [torque(time), 4.0, 0.0]);
                if step % 40 == 0 {
                    instants.push(torque(time));
                    published.push(means.value().unwrap());
                    means.restart();
                }
            }
            let range = |values: &[f64]| {
                let (low, high) = values
                    .iter()
                    .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
                high - low
            };
            let of_torque: Vec<f64> = published.iter().map(|means| means[0]).collect();
            // 10 s are a period of 0.1 Hz: 500 instants meet its top within a hundredth of a per cent.
            assert!(
                (range(&instants) - instants_swing).abs() < 0.01,
                "{frequency} Hz: {}",
                range(&instants)
            );
            assert!((instants[0] - 100.0).abs() > 10.0, "{frequency} Hz: {}", instants[0]);
            // An interval of 20 ms holds the period but for a 500th of it: 30 N m times 2 per mille are left, and half a per
            // cent of that by the rule of the steps.
            let worst = of_torque.iter().map(|mean| (mean - 100.0).abs()).fold(0.0, f64::max);
            assert!(worst < 30.0 * 0.002 * 1.005, "{frequency} Hz: {worst} N m");
            assert!(published.iter().all(|means| (means[1] - 4.0).abs() < 1e-12));
        }
        assert_eq!(Means::default().value(), None);
    }
}
