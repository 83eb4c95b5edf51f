//! `uncertainty.sensors`: factors of all sensors, and tare, noise and drift of those that `calibration` does not state.
//!
//! A sensor shows factor x truth + tare + drift + noise. The factor lies around 1, or around what a calibration has found,
//! and is drawn once per plausible tool, as is the tare; drift and noise are the standard deviations of what changes with
//! time.

use super::super::section::section;

section! {
    /// Errors of the rig's sensors. Tare, noise and drift of torque and hook load, and the noise of the sensors in the hole
    /// are in `calibration`, which compares by them.
    #[derive(Copy)]
    pub struct Sensors(this) {
        /// The weight indicator, which `rig/weight_on_bit_kn` comes from.
        weight_indicator: WeightIndicator = WeightIndicator::default(), below;
        /// The rotary speed of the inputs.
        rotary_speed: SpeedSensor = SpeedSensor::default(), below;
        /// The torque at the surface.
        surface_torque: Factor = Factor::default(), below;
        /// The hook load.
        hook_load: Factor = Factor::default(), below;
        /// The rotary speed that is measured in the hole.
        downhole_speed: Factor = Factor::default(), below;
        /// The torque that is measured in the hole.
        downhole_torque: DownholeTorque = DownholeTorque::default(), below;
        /// The weight on bit that is measured in the hole.
        downhole_weight: DownholeWeight = DownholeWeight::default(), below;
    }
}

section! {
    /// Error of a factor.
    #[derive(Copy)]
    pub struct Factor(this) {
        /// The likeliest factor between reading and truth, as `flexdrill calibrate` has found it. Default 1.
        factor: f64 = 1.0, within(0.7, 1.3), "", "a sensor that errs by more is defective";
        /// Distance from `factor` within which 90 % of the factors lie. Default 0: not drawn.
        factor_error: f64 = 0.0, within(0.0, 0.3), "", "a sensor that errs by more is defective";
    }
}

section! {
    /// Errors of the weight indicator.
    #[derive(Copy)]
    pub struct WeightIndicator(this) {
        /// The likeliest factor between reading and truth, as `flexdrill calibrate` has found it. Default 1.
        factor: f64 = 1.0, within(0.7, 1.3), "", "a sensor that errs by more is defective";
        /// Distance from `factor` within which 90 % of the factors lie. Default 0: not drawn.
        factor_error: f64 = 0.0, within(0.0, 0.3), "", "a sensor that errs by more is defective";
        /// The likeliest offset, as `flexdrill calibrate` has found it (kN). Default 0.
        tare_kn: f64 = 0.0, within(-1e4, 1e4), "kN", "an offset beyond any rig's load is a defect";
        /// Distance from it within which 90 % of the offsets lie (kN). Default 0: not drawn.
        tare_range_kn: f64 = 0.0, within(0.0, 1e4), "kN", "0 is a sensor without offset";
        /// Scatter from second to second (kN, standard deviation).
        noise_kn: f64 = 0.0, within(0.0, 1e4), "kN", "0 is a sensor without noise";
        /// Drift after an hour (kN, standard deviation); it grows with the root of time.
        drift_kn: f64 = 0.0, within(0.0, 1e4), "kN", "0 is a sensor without drift";
    }
}

section! {
    /// Errors of the rotary speed.
    #[derive(Copy)]
    pub struct SpeedSensor(this) {
        /// The likeliest factor between reading and truth, as `flexdrill calibrate` has found it. Default 1.
        factor: f64 = 1.0, within(0.7, 1.3), "", "a sensor that errs by more is defective";
        /// Distance from `factor` within which 90 % of the factors lie. Default 0: not drawn.
        factor_error: f64 = 0.0, within(0.0, 0.3), "", "a sensor that errs by more is defective";
        /// Scatter from second to second (r/min, standard deviation).
        noise_rpm: f64 = 0.0, within(0.0, 1e3), "r/min", "0 is a sensor without noise";
    }
}

section! {
    /// Errors of the torque that is measured in the hole.
    #[derive(Copy)]
    pub struct DownholeTorque(this) {
        /// The likeliest factor between reading and truth, as `flexdrill calibrate` has found it. Default 1.
        factor: f64 = 1.0, within(0.7, 1.3), "", "a sensor that errs by more is defective";
        /// Distance from `factor` within which 90 % of the factors lie. Default 0: not drawn.
        factor_error: f64 = 0.0, within(0.0, 0.3), "", "a sensor that errs by more is defective";
        /// The likeliest offset, as `flexdrill calibrate` has found it (N m). Default 0.
        tare_nm: f64 = 0.0, within(-1e5, 1e5), "N m", "an offset beyond any rig's load is a defect";
        /// Distance from it within which 90 % of the offsets lie (N m). Default 0: not drawn.
        tare_range_nm: f64 = 0.0, within(0.0, 1e5), "N m", "0 is a sensor without offset";
        /// Drift after an hour (N m, standard deviation); it grows with the root of time.
        drift_nm: f64 = 0.0, within(0.0, 1e5), "N m", "0 is a sensor without drift";
    }
}

section! {
    /// Errors of the weight on bit that is measured in the hole.
    #[derive(Copy)]
    pub struct DownholeWeight(this) {
        /// The likeliest factor between reading and truth, as `flexdrill calibrate` has found it. Default 1.
        factor: f64 = 1.0, within(0.7, 1.3), "", "a sensor that errs by more is defective";
        /// Distance from `factor` within which 90 % of the factors lie. Default 0: not drawn.
        factor_error: f64 = 0.0, within(0.0, 0.3), "", "a sensor that errs by more is defective";
        /// The likeliest offset, as `flexdrill calibrate` has found it (kN). Default 0.
        tare_kn: f64 = 0.0, within(-1e4, 1e4), "kN", "an offset beyond any rig's load is a defect";
        /// Distance from it within which 90 % of the offsets lie (kN). Default 0: not drawn.
        tare_range_kn: f64 = 0.0, within(0.0, 1e4), "kN", "0 is a sensor without offset";
        /// Drift after an hour (kN, standard deviation); it grows with the root of time.
        drift_kn: f64 = 0.0, within(0.0, 1e4), "kN", "0 is a sensor without drift";
    }
}
