//! Measured less predicted, with the band in which it is expected, and what a disagreement may mean.

use crate::BAND;

/// What is expected of a residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Standard deviation of a sample (noise of the sensor and ripple).
    pub noise: f64,
    /// Error of the twin, as a share of the prediction.
    pub model: f64,
    /// The same in the unit of the quantity, where the prediction is small.
    pub least: f64,
}

impl Expected {
    /// Half of the width of the band that holds 90 % of the residuals of means over `samples` samples.
    pub fn band(&self, predicted: f64, samples: f64) -> f64 {
        let model = (self.model * predicted).hypot(self.least);
        BAND * model.hypot(self.noise / samples.max(1.0).sqrt())
    }
}

/// A residual over a sliding mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Mean of the measured values.
    pub measured: f64,
    /// Mean of the predicted ones.
    pub predicted: f64,
    /// Half of the width of the 90 % band.
    pub band: f64,
}

impl Residual {
    /// Measured less predicted.
    pub fn difference(&self) -> f64 {
        self.measured - self.predicted
    }

    /// Difference over the half width of the band: beyond -1 to 1 one of ten lies.
    pub fn ratio(&self) -> f64 {
        self.difference() / self.band
    }
}

/// Sliding means of measured and predicted values: exponential, in a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watch {
    time: f64,
    means: Option<[f64; 2]>,
    /// Weight of all samples so far, 0 to 1.
    filled: f64,
}

impl Watch {
    /// Means over `time` (s).
    pub fn new(time: f64) -> Self {
        Self {
            time,
            means: None,
            filled: 0.0,
        }
    }

    /// Adds a sample after `step` seconds. A pair that is not finite is left out.
    pub fn push(&mut self, step: f64, measured: f64, predicted: f64) {
        if !(measured.is_finite() && predicted.is_finite() && step > 0.0) {
            return;
        }
        let part = 1.0 - libm::exp(-step / self.time);
        self.filled += part * (1.0 - self.filled);
        // Until the time is filled the mean is that of all samples so far.
        let share = (part / self.filled).min(1.0);
        let [a, b] = self.means.unwrap_or([measured, predicted]);
        self.means = Some([a + share * (measured - a), b + share * (predicted - b)]);
    }

    /// Forgets all samples: after a change of speed or weight.
    pub fn reset(&mut self) {
        *self = Self::new(self.time);
    }

    /// The residual, once samples of about the watch's time are in it.
    pub fn residual(&self, expected: &Expected) -> Option<Residual> {
        let [measured, predicted] = self.means.filter(|_| self.filled > 0.6)?;
        Some(Residual {
            measured,
            predicted,
            // An exponential mean over T has the variance of one over 2 T samples of a second.
            band: expected.band(predicted, 2.0 * self.time),
        })
    }
}

/// What a disagreement may mean, the likeliest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// Friction is higher than the twin's.
    FrictionHigher,
    /// Friction is lower than the twin's.
    FrictionLower,
    /// The bit takes less torque than the twin's: it is dull, balled or has less weight.
    BitTakesLess,
    /// The bit takes more torque: another rock, or more weight than is measured.
    BitTakesMore,
    /// The weight does not arrive at the bit.
    WeightLost,
    /// A sensor has an offset or a wrong scale.
    WeightSensor,
    /// The offset of the torque sensor has changed.
    TorqueSensor,
}

/// Likely causes of a residual of the surface torque, of which the ratio to its band is given, on or off bottom, and the
/// same of the hook load where it is measured.
pub fn causes(torque: Option<f64>, hook_load: Option<f64>, drilling: bool) -> Vec<Cause> {
    let beyond = |ratio: Option<f64>| ratio.filter(|ratio| ratio.abs() > 1.0);
    let mut all = Vec::new();
    if beyond(hook_load).is_some() {
        all.push(Cause::WeightSensor);
    }
    match (beyond(torque), drilling) {
        (Some(ratio), true) if ratio > 0.0 => {
            all.extend([Cause::FrictionHigher, Cause::BitTakesMore, Cause::WeightSensor])
        }
        (Some(_), true) => all.extend([
            Cause::BitTakesLess,
            Cause::WeightLost,
            Cause::FrictionLower,
            Cause::WeightSensor,
        ]),
        (Some(ratio), false) if ratio > 0.0 => all.extend([Cause::FrictionHigher, Cause::TorqueSensor]),
        (Some(_), false) => all.extend([Cause::TorqueSensor, Cause::FrictionLower]),
        (None, _) => {}
    }
    let mut seen = Vec::new();
    all.retain(|cause| {
        let fresh = !seen.contains(cause);
        seen.push(*cause);
        fresh
    });
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    const EXPECTED: Expected = Expected {
        noise: 10.0,
        model: 0.0,
        least: 0.0,
    };

    #[test]
    fn nine_of_ten_means_are_inside_the_band() {
        let mut random = Random::new(4);
        let (mut watch, mut inside, mut all) = (Watch::new(10.0), 0, 0);
        for second in 0..40_000 {
            watch.push(1.0, 200.0 + 10.0 * random.normal(), 200.0);
            // Means an effective time apart are independent.
            if let Some(residual) = watch.residual(&EXPECTED).filter(|_| second % 20 == 0) {
                all += 1;
                inside += usize::from(residual.ratio().abs() <= 1.0);
            }
        }
        let share = f64::from(inside as u32) / f64::from(all);
        // Five standard errors of 0.9 in 2000; an exponential mean over 10 s has 1.002 times the variance of 20 samples.
        assert!((share - 0.9).abs() < 5.0 * (0.09 / f64::from(all)).sqrt(), "{share}");
    }

    #[test]
    fn a_fresh_watch_says_nothing_and_bad_samples_are_left_out() {
        let mut watch = Watch::new(10.0);
        watch.push(1.0, f64::NAN, 1.0);
        assert_eq!(watch, Watch::new(10.0));
        for _ in 0..9 {
            watch.push(1.0, 5.0, 3.0);
        }
        assert_eq!(watch.residual(&EXPECTED), None);
        watch.push(1.0, 5.0, 3.0);
        let residual = watch.residual(&EXPECTED).unwrap();
        assert!((residual.difference() - 2.0).abs() < 1e-12);
        watch.reset();
        assert_eq!(watch.residual(&EXPECTED), None);
    }

    #[test]
    fn causes_follow_from_sign_and_motion() {
        assert_eq!(causes(Some(-2.0), None, true)[0], Cause::BitTakesLess);
        assert_eq!(causes(Some(3.0), None, false)[0], Cause::FrictionHigher);
        assert_eq!(causes(Some(2.0), Some(3.0), true)[0], Cause::WeightSensor);
        assert_eq!(causes(Some(0.5), None, true), []);
        let twice = causes(Some(2.0), Some(3.0), true);
        assert_eq!(twice.iter().filter(|cause| **cause == Cause::WeightSensor).count(), 1);
    }
}
