//! `transfer`, `guide_preload` and `pressure_folding`: means from the surface to the bit, and loads against a rating.

use super::checker::Checker;
use super::section::section;
use super::vibration::Steps;
use flexdrill_core::units::{kn_to_n, n_to_kn};
use flexdrill_motion::{LoadSettings, TransferSettings};

section! {
    /// Torque and weight from the surface to the bit (`twin/transfer`), and the levels of what does not arrive. Judged
    /// below a string (`string.model: line`) with a hoist, where the weight at the bit is a result.
    #[derive(Copy)]
    pub struct Transfer(this) {
        /// Time over which torque, weight and power are averaged (s).
        window: f64 = TransferSettings::default().window, within(0.5, 60.0), "s",
            "shorter shows the joints' ripple, two per turn; longer than a minute warns too late";
        /// Weight at the surface, for torque also at the bit, below which nothing is judged (kN).
        least_weight_kn: f64 = n_to_kn(TransferSettings::default().least_weight), above(0.0, 200.0), "kN",
            "a share of nothing means nothing; more than any bit of this size needs";
        /// Largest range of the weight at the surface within the window, over its mean, that counts as steady drilling.
        steadiness: f64 = TransferSettings::default().steadiness, above(0.0, 1.0), "",
            "at 0 no weight is steady; from 1 on a bit that is just set down would be judged";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = TransferSettings::default().weight.hysteresis, within(0.0, 0.9), "",
            "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = TransferSettings::default().weight.hold_off, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the share of the weight that does not arrive. Default 0.7, 0.8, 0.95.
        weight_lost: Steps = Steps::from(TransferSettings::default().weight.levels);
        /// Thresholds of the share of the weight that ought to arrive and is not on the bottom: of the weight asked for, less
        /// what friction takes round the arc (a rope's) and along the string. Judged once the weight has been asked for over
        /// five response times of the hoist and two windows. Default 0.3, 0.4, 0.7.
        weight_short: Steps = Steps::from(TransferSettings::default().short.levels);
        /// Thresholds of the share of the torque that does not arrive. Default 0.7, 0.8, 0.95.
        torque_lost: Steps = Steps::from(TransferSettings::default().torque.levels);
        /// Thresholds of the time for which the top drive is at its torque limit while the bit does not turn (s). Default 2,
        /// 5, 10.
        stalled: Steps = Steps::from(TransferSettings::default().stall.levels);
    }
}

section! {
    /// Bending of a guide that was not made with the curvature of the hole (`tool.guide.free_curvature`) against its
    /// rating.
    #[derive(Copy)]
    pub struct GuidePreload(this) {
        /// Bending moment that the guide may carry permanently (N m), from its manufacturer; 0 is unknown, and then
        /// nothing is judged.
        rated_moment_nm: f64 = 0.0, within(0.0, 1e7), "N m", "far above any tube that fits into the hole";
        /// Interval over which the moment is averaged (s).
        interval: f64 = 1.0, within(1e-2, 60.0), "s", "the bend is constant: shorter shows vibration, longer warns too late";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = 0.1, within(0.0, 0.9), "", "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = 5.0, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the largest mean moment divided by the rated moment. Default 0.9, 1, 1.5.
        levels: Steps = Steps::from([0.9, 1.0, 1.5]);
    }
}

section! {
    /// Folding of the pipe under pressure (`environment.pressure`): its effective compression against a rating.
    #[derive(Copy)]
    pub struct PressureFolding(this) {
        /// Effective compression that the chain of links may carry permanently (kN), from its manufacturer; 0 is unknown,
        /// and then nothing is judged.
        rated_compression_kn: f64 = 0.0, within(0.0, 1e4), "kN", "far above what crushes the pipe";
        /// Interval over which the compression is averaged (s).
        interval: f64 = 1.0, within(1e-2, 60.0), "s", "shorter shows vibration, longer warns too late";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = 0.1, within(0.0, 0.9), "", "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = 5.0, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the largest mean compression divided by the rated one. Default 0.9, 1, 1.5.
        levels: Steps = Steps::from([0.9, 1.0, 1.5]);
    }
}

impl Transfer {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("weight_lost", |c| self.weight_lost.check(c, 1.0, ""));
        c.below("weight_short", |c| self.weight_short.check(c, 1.0, ""));
        c.below("torque_lost", |c| self.torque_lost.check(c, 1.0, ""));
        c.below("stalled", |c| self.stalled.check(c, 3600.0, "s"));
    }

    pub(super) fn describe(&self) -> TransferSettings {
        let mut settings = TransferSettings::default();
        let of = |levels: &Steps| levels.thresholds(self.hysteresis, self.hold_off);
        settings.window = self.window;
        settings.least_weight = kn_to_n(self.least_weight_kn);
        settings.steadiness = self.steadiness;
        settings.weight = of(&self.weight_lost);
        settings.short = of(&self.weight_short);
        settings.torque = of(&self.torque_lost);
        settings.stall = of(&self.stalled);
        settings
    }
}

impl GuidePreload {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("levels", |c| self.levels.check(c, 1e3, ""));
    }

    pub(super) fn describe(&self) -> Option<LoadSettings> {
        rated(
            self.rated_moment_nm,
            self.interval,
            &self.levels,
            self.hysteresis,
            self.hold_off,
        )
    }
}

impl PressureFolding {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("levels", |c| self.levels.check(c, 1e3, ""));
    }

    pub(super) fn describe(&self) -> Option<LoadSettings> {
        let rating = kn_to_n(self.rated_compression_kn);
        rated(rating, self.interval, &self.levels, self.hysteresis, self.hold_off)
    }
}

/// The settings of a load whose rating is known.
fn rated(rating: f64, interval: f64, levels: &Steps, hysteresis: f64, hold_off: f64) -> Option<LoadSettings> {
    (rating > 0.0).then(|| LoadSettings {
        rating,
        interval,
        thresholds: levels.thresholds(hysteresis, hold_off),
    })
}
