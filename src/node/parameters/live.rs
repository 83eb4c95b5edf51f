//! Which parameters may change while the node runs.

/// A parameter outside of the configuration: whether `/clock` paces the model.
pub const USE_SIM_TIME: &str = "use_sim_time";
/// A parameter outside of the configuration: its file.
pub const CONFIG_FILE: &str = "config_file";

/// Keys of parameters that may change while running: exact, or a group that ends with a dot.
const LIVE: [&str; 17] = [
    "calibration.friction_factor",
    "calibration.torque_tare_nm",
    "contact.inner.friction_tangential",
    "contact.inner.friction_axial",
    "contact.outer.friction_tangential",
    "contact.outer.friction_axial",
    "tool.bit.friction_factor",
    "inputs.rotary_speed.",
    "inputs.weight_on_bit.",
    "inputs.rate_of_penetration.",
    "inputs.standpipe_pressure.",
    "whirl.backward_cycles.",
    "whirl.forward_power.",
    "whirl.lasting_turns.",
    "whirl.hysteresis",
    "outputs.rates.",
    "outputs.exaggeration",
];
/// Keys within those groups that act at the start only.
const START_ONLY: [&str; 9] = [
    "inputs.rotary_speed.initial_rpm",
    "inputs.rotary_speed.measured",
    "inputs.weight_on_bit.initial_kn",
    "inputs.rate_of_penetration.assumed_m_per_h",
    "inputs.rate_of_penetration.safe_m_per_h",
    "inputs.rate_of_penetration.safe_ramp_m_per_h_per_s",
    "inputs.standpipe_pressure.assumed_mpa",
    "inputs.standpipe_pressure.safe_mpa",
    "inputs.standpipe_pressure.safe_ramp_mpa_per_s",
];

/// Whether a parameter may change while running.
pub fn is_live(key: &str) -> bool {
    let listed = LIVE.iter().any(|live| {
        if live.ends_with('.') {
            key.starts_with(live)
        } else {
            key == *live
        }
    });
    listed && !START_ONLY.contains(&key)
}

/// Why a parameter that is not live cannot change.
pub(super) fn why_fixed(key: &str) -> String {
    let what = match key.split('.').next().unwrap_or_default() {
        // One call would end every alarm of whirl while the pipe whirls.
        "whirl" if key == "whirl.gate_speed_rpm" => "below it no alarm of whirl is judged",
        _ if key.starts_with("inputs.hard_limits.") => "no parameter may exceed it while the node runs",
        "well" | "tool" | "masses" => "it is part of the geometry that the model is built from",
        "solver" => "the time step and the solver's limits are fixed when the model is built",
        "contact" | "environment" | "boundary" | "loads" => "the model is built with it",
        "start" | "initial" | "run" | "inputs" => "it acts at the start only",
        "whirl" | "stick_slip" | "shock" | "chaotic_whirl" | "joint_load" | "transfer" | "guide_preload"
        | "pressure_folding" => "the analysis is built with it",
        USE_SIM_TIME => "the clock is chosen at the start",
        CONFIG_FILE => "the configuration is read at the start",
        _ => "it is fixed at the start",
    };
    format!("{what}; start the node again with -p {key}:=VALUE or another configuration")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn live_and_fixed_parameters() {
        for (key, live) in [
            ("contact.inner.friction_axial", true),
            ("contact.inner.stiffness", false),
            ("tool.bit.friction_factor", true),
            ("calibration.friction_factor", true),
            ("calibration.torque_tare_nm", true),
            ("calibration.follow", false),
            ("tool.links", false),
            ("solver.time_step", false),
            ("inputs.rotary_speed.slew_rpm_per_s", true),
            ("inputs.rotary_speed.initial_rpm", false),
            ("inputs.rotary_speed.downhole_slew_rpm_per_s", true),
            ("inputs.rotary_speed.measured", false),
            ("inputs.hard_limits.max_rpm", false),
            ("inputs.rate_of_penetration.slew_m_per_h_per_s", true),
            ("inputs.standpipe_pressure.assumed_mpa", false),
            ("inputs.driver.policy", false),
            ("whirl.backward_cycles.warning", true),
            ("whirl.gate_speed_rpm", false),
            ("outputs.rates.bit_state", true),
            ("use_sim_time", false),
        ] {
            assert_eq!(is_live(key), live, "{key}");
        }
    }
}
