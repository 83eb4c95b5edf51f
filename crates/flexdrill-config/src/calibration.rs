//! `calibration`: what `flexdrill calibrate` fits, and what follows while drilling.

use super::checker::Checker;
use super::section::section;

section! {
    /// What `flexdrill calibrate` fits to a log, with the ranges that are known beforehand, and what follows the rig while
    /// it drills. Of these keys only `friction_factor` acts on the model.
    #[derive(Copy)]
    pub struct Calibration(this) {
        /// Whether `friction_factor` and `torque_tare_nm` follow the running estimate of `twin/residuals`, within
        /// `follow_limits` and `follow_tare_limit_nm`. Default false: the estimate is published and changes nothing.
        follow: bool = false;
        /// Factor on the friction coefficients of both layers (`contact.inner`, `contact.outer`). With `follow` the node
        /// changes it while it drills; friction around the hole then never falls below that of the start. Default 1.
        friction_factor: f64 = 1.0, above(0.0, 1e3), "", "a coefficient is positive";
        /// Offset of the surface torque's sensor (N m): what it shows without torque. With `follow` the node changes it while
        /// it drills. Default 0.
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
        /// Range of the inclination of the cutters over the configured one. Default a fifth to each side.
        cutter_inclination: Range = Range::new(0.8333, 1.2);
        /// Range of the force that the wear flats carry over the configured one. Default half to each side.
        wear_flat_force: Range = Range::new(0.6667, 1.5);
        /// Range of the rock's specific energy over the configured one. Default half to each side.
        specific_energy: Range = Range::new(0.6667, 1.5);
        /// Error of the twin's rate of penetration, as a share (standard deviation). A half of its variance is that of all
        /// windows of a log, a half that of each, since rock changes from metre to metre.
        rate_of_penetration_error: f64 = 0.15, above(0.0, 1.0), "", "no rock is exact; an error of 1 compares nothing";
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
        /// Limits of the running estimate of friction and of `friction_factor` while it follows.
        follow_limits: Range = Range::new(0.5, 2.0);
        /// Largest change of `friction_factor` per minute.
        follow_rate: f64 = 0.02, above(0.0, 1.0), "1/min", "faster than friction changes in a well";
        /// Half of the 90 % band of the estimated friction factor above which nothing follows. A time off bottom narrows it.
        follow_band: f64 = 0.15, above(0.0, 1.0), "", "a band of the factor itself says nothing";
        /// Largest distance of the followed torque tare from the configured one (N m).
        follow_tare_limit_nm: f64 = 200.0, above(0.0, 1e5), "N m", "a larger offset is a defect of the sensor";
        /// Largest change of the torque tare per minute (N m/min).
        follow_tare_rate_nm: f64 = 5.0, above(0.0, 1e4), "N m/min", "faster than any sensor drifts";
        /// Half of the 90 % band of the estimated torque tare above which nothing follows (N m).
        follow_tare_band_nm: f64 = 15.0, above(0.0, 1e5), "N m", "without a limit any guess would act";
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
            ("cutter_inclination", &self.cutter_inclination),
            ("wear_flat_force", &self.wear_flat_force),
            ("specific_energy", &self.specific_energy),
            ("follow_limits", &self.follow_limits),
        ] {
            c.below(key, |c| range.check_numbers(c));
        }
        c.below("follow_limits", |c| {
            let factor = self.friction_factor;
            c.require(
                self.follow_limits.low <= factor && factor <= self.follow_limits.high,
                "low",
                self.follow_limits.low,
                "",
                format!("at most calibration.friction_factor ({factor}), with high at least that"),
                "the factor begins there",
            );
        });
    }
}
