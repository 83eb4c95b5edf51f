//! `calibration`: what `flexdrill calibrate` fits, and what follows while drilling.

use super::checker::Checker;
use super::section::section;

section! {
    /// What `flexdrill calibrate` fits to a log, with the ranges that are known beforehand, and what follows the rig while
    /// it drills. Without effect on the model until a value is fitted.
    #[derive(Copy)]
    pub struct Calibration(this) {
        /// Reserved, without effect: the running estimate of friction and tare is published (`twin/residuals`) and changes
        /// nothing. Default false.
        follow: bool = false;
        /// Offset of the surface torque's sensor (N m): what it shows without torque. Default 0.
        torque_tare_nm: f64 = 0.0, within(-1e5, 1e5), "N m", "an offset beyond any top drive's torque is a defect";
        /// Offset of the hook load's sensor (kN). Default 0.
        hook_load_tare_kn: f64 = 0.0, within(-1e4, 1e4), "kN", "an offset beyond any hook's load is a defect";
        /// Range of the friction coefficients, 90 % of what is expected. Default 0.25 to 0.40, measured in water-base mud
        /// (SPE 11380).
        friction: Range = Range::new(0.25, 0.40);
        /// Range of the coefficient of friction in the pins of the joints. Default 0.05 to 0.3.
        joint_friction: Range = Range::new(0.05, 0.3);
        /// Range of the bit's friction over the configured one. Default 0.5 to 2.
        bit: Range = Range::new(0.5, 2.0);
        /// Distance from the configured tare within which 90 % of the torque sensor's offsets lie (N m).
        torque_tare_range_nm: f64 = 50.0, above(0.0, 1e5), "N m", "without a range nothing is fitted";
        /// Distance from the configured tare within which 90 % of the hook load's offsets lie (kN).
        hook_load_tare_range_kn: f64 = 20.0, above(0.0, 1e4), "kN", "without a range nothing is fitted";
        /// Drift of the torque sensor after an hour (N m, standard deviation); it grows with the root of time.
        torque_drift_nm: f64 = 5.0, within(0.0, 1e5), "N m", "0 is a sensor without drift";
        /// Drift of the hook load's sensor after an hour (kN, standard deviation).
        hook_load_drift_kn: f64 = 1.0, within(0.0, 1e4), "kN", "0 is a sensor without drift";
        /// Scatter of the measured torque from second to second while drilling steadily (N m, standard deviation).
        torque_noise_nm: f64 = 15.0, above(0.0, 1e5), "N m", "no sensor is without noise";
        /// Scatter of the measured hook load (kN, standard deviation).
        hook_load_noise_kn: f64 = 2.0, above(0.0, 1e4), "kN", "no sensor is without noise";
        /// Scatter of the rotary speed that is measured in the hole (r/min, standard deviation).
        downhole_speed_noise_rpm: f64 = 3.0, above(0.0, 1e3), "r/min", "no sensor is without noise";
        /// Scatter of the torque that is measured in the hole (N m, standard deviation).
        downhole_torque_noise_nm: f64 = 10.0, above(0.0, 1e5), "N m", "no sensor is without noise";
        /// Scatter of the weight on bit that is measured in the hole (kN, standard deviation).
        downhole_weight_noise_kn: f64 = 0.4, above(0.0, 1e4), "kN", "no sensor is without noise";
        /// Error of the twin's torque and hook load, as a share (standard deviation).
        model_error: f64 = 0.05, above(0.0, 1.0), "", "no model is exact; an error of 1 compares nothing";
        /// Limits of the running estimate of friction, as a factor on the configured one.
        follow_limits: Range = Range::new(0.5, 2.0);
        /// Largest change of that factor per minute.
        follow_rate: f64 = 0.02, above(0.0, 1.0), "1/min", "faster than friction changes in a well";
    }
}

section! {
    /// A range, from low to high.
    #[derive(Copy)]
    pub struct Range(this) {
        /// Lower end. Required.
        low: f64, above(0.0, 1e3), "", "a coefficient is positive";
        /// Upper end. Required.
        high: f64, above(this.low, 1e3), "", "above the lower end";
    }
}

impl Range {
    /// From low to high.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Both ends.
    pub const fn ends(self) -> [f64; 2] {
        [self.low, self.high]
    }
}

impl Calibration {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        for (key, range) in [
            ("friction", &self.friction),
            ("joint_friction", &self.joint_friction),
            ("bit", &self.bit),
            ("follow_limits", &self.follow_limits),
        ] {
            c.below(key, |c| range.check_numbers(c));
        }
        c.below("follow_limits", |c| {
            c.require(
                self.follow_limits.low <= 1.0 && self.follow_limits.high >= 1.0,
                "low",
                self.follow_limits.low,
                "",
                "at most 1, with high at least 1",
                "the factor begins at 1",
            );
        });
    }
}
