//! Measured less predicted, with the band in which it is expected, and what a disagreement may mean.

use crate::BAND;

/// What rig and twin are compared in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum RigQuantity {
    /// Torque of the drive at the surface, N m.
    SurfaceTorque,
    /// Load on the hook, N.
    HookLoad,
    /// Rotary speed above the bit, rad/s.
    DownholeSpeed,
    /// Torque above the bit, N m.
    DownholeTorque,
    /// Weight on bit, measured in the hole, N.
    DownholeWeight,
}

impl RigQuantity {
    /// Number of quantities.
    pub const COUNT: usize = 5;
    /// All, in the order of every array with an entry per quantity.
    pub const ALL: [Self; Self::COUNT] = [
        Self::SurfaceTorque,
        Self::HookLoad,
        Self::DownholeSpeed,
        Self::DownholeTorque,
        Self::DownholeWeight,
    ];
}

/// What is expected of a residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Standard deviation of a sample (noise of the sensor and ripple).
    pub noise: f64,
    /// Error of the twin, as a share of the prediction.
    pub model: f64,
    /// The same in the unit of the quantity, where the prediction is small.
    pub least: f64,
    /// Drift of the sensor's offset after an hour (standard deviation); it grows with the root of time.
    pub drift: f64,
}

/// Standard deviations of a sensor's scatter that are deducted before a residual counts as an error of the twin. A day has
/// some ten thousand independent means of all quantities, of which less than one is beyond.
const CERTAIN: f64 = 4.0;

/// A residual over a sliding mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Mean of the measured values.
    pub measured: f64,
    /// Mean of the predicted ones.
    pub predicted: f64,
    /// Standard deviation of the error of twin and tare.
    pub error: f64,
    /// Standard deviation of the measured mean, from the scatter of the sensor.
    pub scatter: f64,
}

impl Residual {
    /// Measured less predicted.
    pub fn difference(&self) -> f64 {
        self.measured - self.predicted
    }

    /// Half of the width of the band that holds 90 % of the differences.
    pub fn band(&self) -> f64 {
        BAND * self.error.hypot(self.scatter)
    }

    /// Difference over the half width of the band: one of ten lies beyond -1 to 1.
    pub fn ratio(&self) -> f64 {
        self.difference() / self.band()
    }

    /// The difference beyond which the twin's error is surely larger than `level` times half of its own 90 % band.
    pub fn limit(&self, level: f64) -> f64 {
        limit(self.error, self.scatter, level)
    }
}

/// The distance beyond which an error with the standard deviation `error` is surely larger than `level` times half of its 90 %
/// band, of a mean with this `scatter`.
pub(crate) fn limit(error: f64, scatter: f64, level: f64) -> f64 {
    level * BAND * error + CERTAIN * scatter
}

/// Sliding means of measured and predicted values: exponential, in a time. Samples need not come regularly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watch {
    time: f64,
    means: Option<[f64; 2]>,
    /// Weight of all samples so far, 0 to 1.
    filled: f64,
    /// Sum of the squares of the samples' weights in the mean: the variance of the mean over that of a sample.
    squares: f64,
    /// Time since the last sample (s).
    since: f64,
}

impl Watch {
    /// Means over `time` (s).
    pub fn new(time: f64) -> Self {
        Self {
            time,
            means: None,
            filled: 0.0,
            squares: 0.0,
            since: 0.0,
        }
    }

    /// Advances by `step` seconds, and adds a sample where both values are finite.
    pub fn push(&mut self, step: f64, measured: f64, predicted: f64) {
        if !(step > 0.0 && step.is_finite()) {
            return;
        }
        self.since += step;
        if !(measured.is_finite() && predicted.is_finite()) {
            return;
        }
        let part = 1.0 - libm::exp(-self.since / self.time);
        self.since = 0.0;
        self.filled += part * (1.0 - self.filled);
        // Until the time is filled the mean is that of all samples so far.
        let share = match self.means {
            None => 1.0,
            Some(_) => (part / self.filled).min(1.0),
        };
        let [a, b] = self.means.unwrap_or([measured, predicted]);
        self.means = Some([a + share * (measured - a), b + share * (predicted - b)]);
        self.squares = (1.0 - share).powi(2) * self.squares + share.powi(2);
    }

    /// Forgets all samples: after a change of speed or weight.
    pub fn reset(&mut self) {
        *self = Self::new(self.time);
    }

    /// The residual, once the samples of about the watch's time are in it, and while the newest is not older than
    /// `longest_age` (s). `hours` have passed since the tare of the sensor was known.
    pub fn residual(&self, expected: &Expected, longest_age: f64, hours: f64) -> Option<Residual> {
        let [measured, predicted] = self.means.filter(|_| self.filled > 0.6 && self.since <= longest_age)?;
        Some(Residual {
            measured,
            predicted,
            error: (expected.model * predicted)
                .hypot(expected.least)
                .hypot(expected.drift * hours.sqrt()),
            scatter: expected.noise * self.squares.sqrt(),
        })
    }
}

/// What a disagreement may mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// Friction is higher than the twin's.
    FrictionHigher,
    /// Friction is lower than the twin's.
    FrictionLower,
    /// The bit takes less torque than the twin's: it is dull or balled.
    BitTakesLess,
    /// The bit takes more torque: another rock, or more weight than is measured.
    BitTakesMore,
    /// The weight does not arrive at the bit.
    WeightLost,
    /// Weight or hook load is measured wrongly.
    WeightSensor,
    /// The torque is measured wrongly.
    TorqueSensor,
    /// A speed is measured wrongly.
    SpeedSensor,
    /// A sensor in the hole has an offset.
    DownholeSensor,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Unknown,
    Within,
    High,
    Low,
}

/// Likely causes of residuals, given as ratios to what is surely beyond their bands, on or off bottom; the likeliest first, none where all are
/// within their bands. What is measured in the hole decides between causes that look the same from the surface.
pub fn causes(ratios: &[Option<f64>; RigQuantity::COUNT], drilling: bool) -> Vec<Cause> {
    use Cause::*;
    // A quantity that is not measured (unknown) and one that agrees (within) mean different causes.
    let [torque, hook_load, speed, bit_torque, bit_weight] = ratios.map(|ratio| match ratio {
        Some(ratio) if ratio > 1.0 => Side::High,
        Some(ratio) if ratio < -1.0 => Side::Low,
        Some(_) => Side::Within,
        None => Side::Unknown,
    });
    let beyond = |side: Side| matches!(side, Side::High | Side::Low);
    let mut all = Vec::new();
    // The order within the lists is that of likelihood, and the causes
    // nearest to the bit come first: they explain all others.
    if drilling {
        match bit_weight {
            Side::Low => all.extend([WeightLost, WeightSensor]),
            Side::High => all.push(WeightSensor),
            Side::Within | Side::Unknown => {}
        }
        // Less torque at the bit is the bit's own only if the weight has arrived there.
        match (bit_torque, bit_weight) {
            (Side::Low, Side::Within | Side::High) => all.push(BitTakesLess),
            (Side::Low, Side::Unknown) => all.extend([BitTakesLess, WeightLost]),
            (Side::High, Side::Within | Side::Low | Side::Unknown) => all.push(BitTakesMore),
            _ => {}
        }
        // A torque at the bit that is measured removes the bit from the causes of the torque at the surface.
        all.extend::<&[Cause]>(match (torque, bit_torque) {
            (Side::High, Side::Unknown) => &[FrictionHigher, BitTakesMore, WeightSensor, TorqueSensor],
            (Side::High, Side::Within | Side::Low) => &[FrictionHigher, TorqueSensor],
            (Side::Low, Side::Unknown) => &[BitTakesLess, WeightLost, FrictionLower, WeightSensor, TorqueSensor],
            (Side::Low, Side::Within | Side::High) => &[FrictionLower, TorqueSensor],
            _ => &[],
        });
    } else {
        // Off bottom only friction remains. Friction rarely falls by
        // itself, so with a low torque the sensor comes first.
        all.extend::<&[Cause]>(match torque {
            Side::High => &[FrictionHigher, TorqueSensor],
            Side::Low => &[TorqueSensor, FrictionLower],
            Side::Within | Side::Unknown => &[],
        });
        // Off bottom the bit carries neither torque nor weight, so what a sensor in the hole shows is its own error.
        if beyond(bit_torque) || beyond(bit_weight) {
            all.push(DownholeSensor);
        }
    }
    if beyond(hook_load) {
        all.push(WeightSensor);
    }
    if beyond(speed) {
        all.push(SpeedSensor);
    }
    // Several measurements may name the same cause. The first mention counts, so that the order of likelihood remains.
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
        drift: 0.0,
    };

    /// Share of the means within their band, of samples that come every `every` seconds.
    fn share_within(every: u32, seed: u64) -> (f64, f64) {
        let mut random = Random::new(seed);
        let (mut watch, mut inside, mut all) = (Watch::new(20.0), 0.0, 0.0);
        for second in 0..120_000_u32 {
            let noise = 10.0 * random.normal();
            let measured = if second.is_multiple_of(every) {
                200.0 + noise
            } else {
                f64::NAN
            };
            watch.push(1.0, measured, 200.0);
            // Means that are three times the watch's time apart share 5 % of their weight.
            if let Some(residual) = watch
                .residual(&EXPECTED, 30.0, 0.0)
                .filter(|_| second.is_multiple_of(60))
            {
                all += 1.0;
                inside += f64::from(u8::from(residual.ratio().abs() <= 1.0));
            }
        }
        (inside / all, all)
    }

    #[test]
    fn nine_of_ten_means_are_inside_the_band_whatever_the_rate_of_the_sensor() {
        for (every, seed) in [(1, 4), (7, 5), (30, 6)] {
            let (share, all) = share_within(every, seed);
            // Four standard errors of 0.9.
            assert!(
                (share - 0.9).abs() < 4.0 * (0.09 / all).sqrt(),
                "every {every} s: {share}"
            );
        }
    }

    #[test]
    fn a_fresh_watch_and_an_old_one_say_nothing() {
        let mut watch = Watch::new(10.0);
        for _ in 0..9 {
            watch.push(1.0, 5.0, 3.0);
        }
        assert_eq!(watch.residual(&EXPECTED, 5.0, 0.0), None);
        watch.push(1.0, 5.0, 3.0);
        let residual = watch.residual(&EXPECTED, 5.0, 0.0).unwrap();
        assert!((residual.difference() - 2.0).abs() < 1e-12);
        // A sample without a number changes no mean, and the age of the last one counts.
        for second in 1..=6 {
            watch.push(1.0, f64::NAN, 3.0);
            let known = watch.residual(&EXPECTED, 5.0, 0.0);
            assert_eq!(known, (second <= 5).then_some(residual), "{second}");
        }
        watch.push(1.0, 5.0, 3.0);
        assert!(watch.residual(&EXPECTED, 5.0, 0.0).is_some());
        watch.reset();
        assert_eq!(watch, Watch::new(10.0));
    }

    /// Ratios of surface torque, hook load, speed, torque and weight in the hole.
    fn of(drilling: bool, ratios: [Option<f64>; RigQuantity::COUNT]) -> Vec<Cause> {
        causes(&ratios, drilling)
    }

    #[test]
    fn causes_follow_from_sign_motion_and_what_is_measured_in_the_hole() {
        let none = None;
        assert_eq!(of(true, [Some(0.9), Some(-0.9), none, none, none]), []);
        assert_eq!(of(true, [Some(-2.0), none, none, none, none])[0], Cause::BitTakesLess);
        assert_eq!(of(false, [Some(3.0), none, none, none, none])[0], Cause::FrictionHigher);
        // The bit takes what it should, so that the torque is lost on the way.
        let arc = of(true, [Some(3.0), none, none, Some(0.1), Some(0.2)]);
        assert_eq!(arc, [Cause::FrictionHigher, Cause::TorqueSensor]);
        // The weight arrives, the torque of the bit is low: the bit.
        let dull = of(true, [Some(-2.0), none, none, Some(-4.0), Some(0.2)]);
        assert_eq!(dull, [Cause::BitTakesLess]);
        // Neither weight nor torque arrives.
        let lost = of(true, [none, none, none, Some(-4.0), Some(-5.0)]);
        assert_eq!(lost[0], Cause::WeightLost);
        assert!(!lost.contains(&Cause::BitTakesLess));
        assert_eq!(
            of(false, [none, none, Some(2.0), none, Some(2.0)]),
            [Cause::DownholeSensor, Cause::SpeedSensor]
        );
        let twice = of(true, [Some(2.0), Some(3.0), none, none, none]);
        assert_eq!(twice.iter().filter(|cause| **cause == Cause::WeightSensor).count(), 1);
    }
}
