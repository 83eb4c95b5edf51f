//! The errors of sensors and twin that a configuration states.

use crate::monitor::Stated;
use crate::residual::RigQuantity;
use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// The errors that a configuration states.
pub fn stated(config: &Config) -> Stated {
    let given = &config.calibration;
    let zero = [0.0; RigQuantity::COUNT];
    let mut stated = Stated {
        noise: zero,
        tare: zero,
        drift: zero,
        model: given.model_error,
    };
    for (quantity, noise, tare) in [
        (RigQuantity::SurfaceTorque, given.torque_noise_nm, given.torque_tare_nm),
        (
            RigQuantity::HookLoad,
            kn_to_n(given.hook_load_noise_kn),
            kn_to_n(given.hook_load_tare_kn),
        ),
        (
            RigQuantity::DownholeSpeed,
            rpm_to_rad_per_s(given.downhole_speed_noise_rpm),
            0.0,
        ),
        (RigQuantity::DownholeTorque, given.downhole_torque_noise_nm, 0.0),
        (
            RigQuantity::DownholeWeight,
            kn_to_n(given.downhole_weight_noise_kn),
            0.0,
        ),
    ] {
        stated.noise[quantity as usize] = noise;
        stated.tare[quantity as usize] = tare;
    }
    stated.drift[RigQuantity::SurfaceTorque as usize] = given.torque_drift_nm;
    stated.drift[RigQuantity::HookLoad as usize] = kn_to_n(given.hook_load_drift_kn);
    stated
}
