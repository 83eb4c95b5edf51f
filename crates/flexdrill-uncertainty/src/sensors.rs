//! The errors of the rig's sensors: reading = factor x truth + tare + drift + noise, in SI units.
//!
//! Factors, and what `calibration` does not state, are in `uncertainty.sensors`; tare, noise and drift of torque and hook
//! load and the noise of the sensors in the hole are in `calibration`. They are joined here.

use flexdrill_config::{Config, Distribution, Uncertainty};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

use crate::law::Law;

flexdrill_base::listed! {
    /// What a sensor measures, in the order of the draws.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Channel: 1 {
        /// The weight indicator (N).
        WeightIndicator: "weight_indicator";
        /// Rotary speed of the inputs (rad/s).
        RotarySpeed: "rotary_speed";
        /// Torque at the surface (N m).
        SurfaceTorque: "surface_torque";
        /// Hook load (N).
        HookLoad: "hook_load";
        /// Rotary speed in the hole (rad/s).
        DownholeSpeed: "downhole_speed";
        /// Torque in the hole (N m).
        DownholeTorque: "downhole_torque";
        /// Weight on bit in the hole (N).
        DownholeWeight: "downhole_weight";
    }
}

impl Channel {
    /// Its name in a file, below `uncertainty.sensors`.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }

    /// Unit of its tare, noise and drift.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::WeightIndicator | Self::HookLoad | Self::DownholeWeight => "N",
            Self::RotarySpeed | Self::DownholeSpeed => "rad/s",
            Self::SurfaceTorque | Self::DownholeTorque => "N m",
        }
    }
}

/// What is known of a sensor's error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// What it measures.
    pub channel: Channel,
    /// Expected factor, around which the factors lie.
    pub expected_factor: f64,
    /// Distance from it within which 90 % of the factors lie.
    pub factor_error: f64,
    /// Configured tare, around which the tares lie.
    pub tare: f64,
    /// Distance from it within which 90 % of the tares lie.
    pub tare_range: f64,
    /// Standard deviation from second to second.
    pub noise: f64,
    /// Standard deviation of the drift after an hour; it grows with the root of time.
    pub drift: f64,
}

/// The error of a sensor that is constant in time, drawn once per plausible tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorError {
    /// What it measures.
    pub channel: Channel,
    /// Reading over truth, without the tare.
    pub factor: f64,
    /// Reading at a truth of 0.
    pub tare: f64,
}

impl Sensor {
    /// Distribution of the factor; none where there is one value, the expected one.
    pub fn factor(&self) -> Option<Law> {
        // A reading has the sign of the truth.
        around(self.expected_factor, self.factor_error, f64::MIN_POSITIVE)
    }

    /// Distribution of the tare; none where there is one value, the configured one.
    pub fn tare(&self) -> Option<Law> {
        around(self.tare, self.tare_range, f64::NEG_INFINITY)
    }

    /// The error for two shares between 0 and 1, of the factor and of the tare.
    pub(crate) fn error(&self, [of_factor, of_tare]: [f64; 2]) -> SensorError {
        SensorError {
            channel: self.channel,
            factor: self
                .factor()
                .map_or(self.expected_factor, |law| law.quantile(of_factor)),
            tare: self.tare().map_or(self.tare, |law| law.quantile(of_tare)),
        }
    }
}

/// A normal distribution of which 90 % lie within `range` of `middle`, cut off at `low`; none without a range.
fn around(middle: f64, range: f64, low: f64) -> Option<Law> {
    let ends = Distribution::Normal {
        low: middle - range,
        high: middle + range,
    };
    Law::new(&ends, [low, f64::INFINITY])
}

/// All sensors, joined from both sections.
pub(crate) fn sensors(config: &Config, stated: &Uncertainty) -> Vec<Sensor> {
    let (of, known) = (&stated.sensors, &config.calibration);
    let sensor =
        |channel, [expected_factor, factor_error]: [f64; 2], [tare, tare_range, noise, drift]: [f64; 4]| Sensor {
            channel,
            expected_factor,
            factor_error,
            tare,
            tare_range,
            noise,
            drift,
        };
    // The inputs drive the twin and are compared with nothing: all of their errors are in `uncertainty`.
    let weight = of.weight_indicator;
    let (torque, below) = (of.downhole_torque, of.downhole_weight);
    // The order is that of the channels, which the draws follow.
    vec![
        sensor(
            Channel::WeightIndicator,
            [weight.factor, weight.factor_error],
            [weight.tare_kn, weight.tare_range_kn, weight.noise_kn, weight.drift_kn].map(kn_to_n),
        ),
        sensor(
            Channel::RotarySpeed,
            [of.rotary_speed.factor, of.rotary_speed.factor_error],
            [0.0, 0.0, rpm_to_rad_per_s(of.rotary_speed.noise_rpm), 0.0],
        ),
        // A comparison without priors needs tare, noise and drift of these two, so that `calibration` has them.
        sensor(
            Channel::SurfaceTorque,
            [of.surface_torque.factor, of.surface_torque.factor_error],
            [
                known.torque_tare_nm,
                known.torque_tare_range_nm,
                known.torque_noise_nm,
                known.torque_drift_nm,
            ],
        ),
        sensor(
            Channel::HookLoad,
            [of.hook_load.factor, of.hook_load.factor_error],
            [
                known.hook_load_tare_kn,
                known.hook_load_tare_range_kn,
                known.hook_load_noise_kn,
                known.hook_load_drift_kn,
            ]
            .map(kn_to_n),
        ),
        // The sensors in the hole have their noise there, and the rest here.
        sensor(
            Channel::DownholeSpeed,
            [of.downhole_speed.factor, of.downhole_speed.factor_error],
            [0.0, 0.0, rpm_to_rad_per_s(known.downhole_speed_noise_rpm), 0.0],
        ),
        sensor(
            Channel::DownholeTorque,
            [torque.factor, torque.factor_error],
            [
                torque.tare_nm,
                torque.tare_range_nm,
                known.downhole_torque_noise_nm,
                torque.drift_nm,
            ],
        ),
        sensor(
            Channel::DownholeWeight,
            [below.factor, below.factor_error],
            [
                below.tare_kn,
                below.tare_range_kn,
                known.downhole_weight_noise_kn,
                below.drift_kn,
            ]
            .map(kn_to_n),
        ),
    ]
}
