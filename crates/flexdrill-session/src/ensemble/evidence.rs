//! What the rig measures, as evidence for a member.
//!
//! Residuals of steady seconds are averaged over windows and divided by the error that is stated for the twin and the offset
//! of the sensor, which are the same in all windows: a discrepancy of 1, which no log averages away
//! ([`flexdrill_ensemble::Evidence`]).

use flexdrill_calibration::monitor::MonitorSettings;
use flexdrill_calibration::residual::{Expected, Residual, RigQuantity, Watch};
use flexdrill_config::Config;
use flexdrill_ensemble::{Evidence, Measurement};
use flexdrill_uncertainty::{Channel, Priors};

/// Model time of a window (s).
pub(super) const WINDOW: f64 = 20.0;
/// Time within which residuals of a motion are one piece of information (s): a window counts for a third of it.
const CORRELATED: f64 = 60.0;
/// Time after which the discrepancy of the model is another one, as depth and rock change (s).
const LASTING: f64 = 7200.0;
/// Seconds of a window that must be steady and measured.
const LEAST_SECONDS: f64 = 5.0;
/// Least noise of a window's mean, as a share of the discrepancy.
const LEAST_NOISE: f64 = 0.1;
/// Time of the means by which members' readings move (s): longer than any swing of a tool's motion.
const SLOW: f64 = 10.0;
/// A range that holds 90 % of a normal distribution, in standard deviations.
const RANGE: f64 = 1.645;

/// A comparison of the rig with the twin, once per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// Time since the comparison before (s).
    pub step: f64,
    /// Whether speed and weight are steady and all inputs are good.
    pub steady: bool,
    /// Whether the bit drills.
    pub drilling: bool,
    /// What the rig has measured since the comparison before, by [`RigQuantity::ALL`] (SI); NaN where nothing came.
    pub measured: [f64; RigQuantity::COUNT],
    /// What the twin computes (SI).
    pub predicted: [f64; RigQuantity::COUNT],
}

/// The stated errors of a rig, per quantity (SI).
#[derive(Debug, Clone, Copy)]
pub(super) struct Errors {
    of: [OneError; RigQuantity::COUNT],
    /// Time of the sliding means that the alarm is judged by (s).
    mean: f64,
}

#[derive(Debug, Clone, Copy)]
struct OneError {
    /// Of sensor and twin, but for the offset.
    expected: Expected,
    /// Age of the newest sample (s) beyond which the quantity counts as not measured.
    longest_age: f64,
    /// Standard deviation of the sensor's offset about `tare`.
    offset: f64,
    tare: f64,
    /// Drift of the offset within [`CORRELATED`].
    drift: f64,
}

/// The sensor of a quantity.
pub(super) const fn channel(quantity: RigQuantity) -> Channel {
    match quantity {
        RigQuantity::SurfaceTorque => Channel::SurfaceTorque,
        RigQuantity::HookLoad => Channel::HookLoad,
        RigQuantity::DownholeSpeed => Channel::DownholeSpeed,
        RigQuantity::DownholeTorque => Channel::DownholeTorque,
        RigQuantity::DownholeWeight => Channel::DownholeWeight,
    }
}

impl Errors {
    pub(super) fn of(config: &Config, priors: &Priors) -> Self {
        let stated = MonitorSettings::stated(&flexdrill_calibration::stated(config));
        let of = RigQuantity::ALL.map(|quantity| {
            let expected = stated.expected[quantity as usize];
            let sensor = priors
                .sensors()
                .iter()
                .find(|sensor| sensor.channel == channel(quantity));
            OneError {
                expected,
                longest_age: stated.longest_age[quantity as usize],
                offset: sensor.map_or(0.0, |sensor| sensor.tare_range / RANGE),
                tare: stated.tare[quantity as usize],
                drift: expected.drift * (CORRELATED / 3600.0).sqrt(),
            }
        });
        Self { of, mean: stated.mean }
    }

    /// Noise of a sample of a quantity, and how late its sensor may follow the rig (s).
    pub(super) fn sample(&self, quantity: RigQuantity) -> [f64; 2] {
        let error = &self.of[quantity as usize];
        // A sample counts as new up to this age; the one after it has followed.
        [error.expected.noise, 2.0 * error.longest_age]
    }
}

impl OneError {
    /// What residuals are divided by where the twin computes `predicted`.
    fn scale(&self, predicted: f64) -> f64 {
        let Expected { model, least, .. } = self.expected;
        (model * predicted).hypot(least).hypot(self.offset)
    }
}

/// The windows of a member.
#[derive(Debug, Clone)]
pub(super) struct Windows {
    pub(super) evidence: Evidence,
    /// Factors of the member's sensors, by [`RigQuantity::ALL`].
    factors: [f64; RigQuantity::COUNT],
    sums: [Sums; RigQuantity::COUNT],
    /// Sliding means of what is measured and of the member's readings, as the twin has them.
    watches: [Option<Watch>; RigQuantity::COUNT],
    /// Means of the readings over about the last [`WINDOW`] of steady seconds, however long ago; NaN before.
    newest: [f64; RigQuantity::COUNT],
    /// How the readings move.
    slow: [Option<Slow>; RigQuantity::COUNT],
}

/// A slow mean of a reading, and its range since the sensor began to show one value.
#[derive(Debug, Clone, Copy)]
struct Slow {
    mean: f64,
    range: [f64; 2],
}

/// Sums of the present window, all over the scale of the second.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    residuals: f64,
    /// Squares of the noise and of the drift.
    noise: f64,
    drift: f64,
    seconds: f64,
}

impl Windows {
    /// Nothing measured, with the sensors of a member.
    pub(super) fn new(member: &flexdrill_uncertainty::Member) -> Self {
        let factor = |quantity| {
            let sensor = member.sensors.iter().find(|sensor| sensor.channel == channel(quantity));
            sensor.map_or(1.0, |sensor| sensor.factor)
        };
        Self {
            evidence: Evidence::new(&[1.0; RigQuantity::COUNT]),
            factors: RigQuantity::ALL.map(factor),
            sums: Default::default(),
            watches: Default::default(),
            newest: [f64::NAN; RigQuantity::COUNT],
            slow: Default::default(),
        }
    }

    /// Forgets the present window and means, after a reset of the model.
    pub(super) fn restart(&mut self) {
        self.slow = Default::default();
        self.sums = Default::default();
        self.watches = Default::default();
    }

    /// Forgets what was measured, but for the means that the alarm is judged by.
    pub(super) fn begin_again(&mut self) {
        self.evidence = Evidence::new(&[1.0; RigQuantity::COUNT]);
        self.sums = Default::default();
    }

    /// The sliding means of a quantity `hours` after the tares of the sensors were known, with the error that this member
    /// shares with all others; `None` while they are not filled.
    pub(super) fn mean(&self, errors: &Errors, quantity: RigQuantity, hours: f64) -> Option<Residual> {
        let error = &errors.of[quantity as usize];
        let watch = self.watches[quantity as usize].as_ref()?;
        let of = watch.residual(&error.expected, error.longest_age, hours)?;
        Some(Residual {
            error: of.error.hypot(error.offset),
            ..of
        })
    }

    /// The mean of the member's readings of a quantity over the newest steady seconds, however long ago; NaN before.
    pub(super) fn newest(&self, quantity: RigQuantity) -> f64 {
        self.newest[quantity as usize]
    }

    /// Takes a second in which the member computes `computed`, steady or not, for how its readings move. `restarted` has the
    /// sensors that have begun to show another value.
    pub(super) fn follow(
        &mut self,
        step: f64,
        computed: &[f64; RigQuantity::COUNT],
        restarted: &[bool; RigQuantity::COUNT],
    ) {
        for (index, slow) in self.slow.iter_mut().enumerate() {
            let reading = self.factors[index] * computed[index];
            if !reading.is_finite() {
                continue;
            }
            let Slow { mean, range } = slow.unwrap_or(Slow {
                mean: reading,
                range: [reading; 2],
            });
            let mean = mean + (step / SLOW).min(1.0) * (reading - mean);
            let range = match restarted[index] {
                true => [mean; 2],
                false => [range[0].min(mean), range[1].max(mean)],
            };
            *slow = Some(Slow { mean, range });
        }
    }

    /// By how much the readings of a quantity have moved since its sensor began to show one value.
    pub(super) fn moved(&self, quantity: RigQuantity) -> f64 {
        self.slow[quantity as usize].map_or(0.0, |slow| slow.range[1] - slow.range[0])
    }

    /// Takes a second in which the member computes `computed`.
    pub(super) fn add(&mut self, errors: &Errors, compared: &Compared, computed: &[f64; RigQuantity::COUNT]) {
        if !compared.steady {
            self.watches = Default::default();
            return;
        }
        for (index, error) in errors.of.iter().enumerate() {
            let scale = error.scale(compared.predicted[index]);
            // The offset of the sensor about its tare is part of the scale, since all windows share it.
            let reading = self.factors[index] * computed[index] + error.tare;
            let watch = self.watches[index].get_or_insert(Watch::new(errors.mean));
            watch.push(compared.step, compared.measured[index], reading);
            if compared.measured[index].is_finite() && reading.is_finite() {
                let newest = &mut self.newest[index];
                let toward = (reading - *newest) / WINDOW;
                *newest = if newest.is_finite() { *newest + toward } else { reading };
            }
            let residual = (compared.measured[index] - reading) / scale;
            if residual.is_finite() {
                let sums = &mut self.sums[index];
                sums.residuals += residual;
                sums.noise += (error.expected.noise / scale).powi(2);
                sums.drift += (error.drift / scale).powi(2);
                sums.seconds += 1.0;
            }
        }
    }

    /// Mean residuals of the present window, over the stated errors of twin and offset; none where too little was measured.
    pub(super) fn residuals(&self) -> [Option<f64>; RigQuantity::COUNT] {
        self.sums
            .map(|sums| (sums.seconds >= LEAST_SECONDS).then(|| sums.residuals / sums.seconds))
    }

    /// Ends the window. What a sensor shows that is not believed (`doubted`) says nothing of which tool it is.
    pub(super) fn end(&mut self, doubted: &[bool; RigQuantity::COUNT]) {
        for (index, sums) in self.sums.into_iter().enumerate() {
            let n = sums.seconds;
            if n < LEAST_SECONDS || doubted[index] {
                continue;
            }
            // Noise falls with the number of seconds; the drift of the sensor within a window does not.
            let noise = (sums.noise / n / n + sums.drift / n).sqrt();
            let measurement = Measurement {
                residual: sums.residuals / n,
                // A sensor that is stated to be exact shows the tool's own ripple.
                noise: noise.max(LEAST_NOISE),
                independent: WINDOW / CORRELATED,
            };
            self.evidence.add(index, &measurement);
        }
        self.evidence.fade(WINDOW, LASTING);
        self.sums = Default::default();
    }
}
