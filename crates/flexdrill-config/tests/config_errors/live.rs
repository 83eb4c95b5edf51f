//! Values that change by key, and limits of what may be set while a node runs.

use super::*;

#[test]
fn values_change_by_key_and_are_checked() {
    let config = Config::from_text("rig.yaml", GOOD).unwrap();
    let changed = config.with_value("contact.inner.friction_axial", 0.25).unwrap();
    assert_eq!(changed.contact.inner.friction_axial, 0.25);
    assert_ne!(changed.hash(), config.hash());
    let error = config
        .with_value("contact.inner.friction_axial", -1.0)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("contact.inner.friction_axial = -1: must be 0 to 2"),
        "{error}"
    );
    assert!(matches!(
        config.with_value("contact.inner.nose", 1.0),
        Err(ConfigError::UnknownKey { meant: None, .. })
    ));
    for (wrong, right) in [
        ("contact.inner.friction_axail", "contact.inner.friction_axial"),
        ("solver.links", "tool.links"),
    ] {
        let error = config.with_value(wrong, 1.0).unwrap_err().to_string();
        assert!(error.ends_with(&format!("did you mean {right}?")), "{error}");
    }
    assert!(matches!(
        config.with_value("solver.gamma", "x"),
        Err(ConfigError::WrongType { .. })
    ));
    let key = config
        .numbers()
        .into_iter()
        .find(|number| number.key == "solver.gamma")
        .unwrap();
    assert_eq!(
        (key.value, key.low, key.high, key.unit),
        (config.solver.gamma, 0.5, 1.0, "")
    );
}

#[test]
fn live_parameters_stop_at_the_hard_limits() {
    let config = Config::from_text("rig.yaml", GOOD).unwrap();
    let bounds = HardBounds::of(&config);
    let refused = |key: &str, value: f64| {
        let changed = config.with_value(key, value).unwrap();
        match bounds.check(&changed) {
            Ok(()) => panic!("{key} = {value} was accepted"),
            Err(error) => error.to_string(),
        }
    };
    assert_eq!(
        refused("inputs.rotary_speed.max_rpm", 301.0),
        "parameter: inputs.rotary_speed.max_rpm = 301 r/min: must be at most 300 r/min (the hard limit \
         inputs.hard_limits.max_rpm, which holds while the twin runs; start it again with another configuration)"
    );
    // One of each kind: limit, safe value, slew, ramp, tare, ages, publishing rate.
    for (key, within, beyond) in [
        ("inputs.rotary_speed.min_rpm", 10.0, -1.0),
        ("inputs.rotary_speed.slew_rpm_per_s", 200.0, 200.1),
        ("inputs.rotary_speed.downhole_slew_rpm_per_s", 200.0, 200.1),
        ("inputs.rotary_speed.safe_ramp_rpm_per_s", 0.5, 0.4),
        ("inputs.rotary_speed.safe_ramp_rpm_per_s", 200.0, 1e5),
        ("inputs.weight_on_bit.max_kn", 200.0, 200.1),
        ("inputs.weight_on_bit.tare_error_kn", 5.0, 5.1),
        ("inputs.weight_on_bit.max_age", 60.0, 61.0),
        ("inputs.rotary_speed.hold_before_safe", 600.0, 601.0),
        ("outputs.rates.contact_forces", 200.0, 201.0),
    ] {
        assert!(refused(key, beyond).contains(key));
        // A minimum of 10 r/min needs a start and a safe value above it.
        let start = [("initial_rpm", 20.0), ("safe_rpm", 20.0)]
            .map(|(name, value)| (format!("inputs.rotary_speed.{name}"), value));
        let config = config.with_values("rig.yaml", start).unwrap();
        let bounds = HardBounds::of(&config);
        assert!(
            bounds.check(&config.with_value(key, within).unwrap()).is_ok(),
            "{key} = {within}"
        );
    }
    // A safe value is only lowered: a rig that falls silent is not brought to full speed by a parameter.
    for (key, value, unit) in [
        ("inputs.rotary_speed.safe_rpm", 120.0, "r/min"),
        ("inputs.weight_on_bit.safe_kn", 60.0, "kN"),
    ] {
        let error = refused(key, value);
        assert!(
            error.contains(&format!("{key} = {value} {unit}: must be at most 0 {unit}")),
            "{error}"
        );
    }
    let started = config.with_value("inputs.rotary_speed.safe_rpm", 30.0).unwrap();
    let bounds_of_started = HardBounds::of(&started);
    for (value, accepted) in [(30.0, true), (10.0, true), (31.0, false)] {
        let changed = started.with_value("inputs.rotary_speed.safe_rpm", value).unwrap();
        assert_eq!(bounds_of_started.check(&changed).is_ok(), accepted, "{value} r/min");
    }
    assert_eq!(
        bounds.cut("inputs.rotary_speed.max_rpm", [-5000.0, 5000.0]),
        [-5000.0, 300.0]
    );
    assert_eq!(bounds.cut("whirl.hysteresis", [0.0, 1.0]), [0.0, 1.0]);
}

/// One call must not end an alarm whose motion goes on: what decides whether it is raised stays near the configuration.
#[test]
fn what_alarms_depend_on_stays_near_its_configured_value() {
    let config = Config::from_text("rig.yaml", GOOD).unwrap();
    let bounds = HardBounds::of(&config);
    let value = |key: &str| {
        config
            .numbers()
            .into_iter()
            .find(|number| number.key == key)
            .unwrap()
            .value
    };
    let check = |key: &str, value: f64| bounds.check(&config.with_value(key, value).unwrap());
    for (key, least, most) in [
        ("whirl.backward_cycles.critical", None, 1.25),
        ("whirl.forward_power.warning", None, 1.25),
        ("whirl.lasting_turns.critical", None, 1.25),
        ("contact.inner.friction_tangential", Some(0.5), 2.0),
        ("contact.outer.friction_axial", Some(0.5), 2.0),
        ("tool.bit.friction_factor", Some(0.5), 2.0),
    ] {
        let own = value(key);
        check(key, most * own).unwrap();
        let refused = check(key, 1.01 * most * own).unwrap_err().to_string();
        assert!(
            refused.contains(key) && refused.contains("alarms depend on it"),
            "{refused}"
        );
        match least {
            Some(least) => {
                check(key, least * own).unwrap();
                check(key, 0.99 * least * own).unwrap_err();
            }
            None => assert_eq!(bounds.cut(key, [0.0, 1e9])[0], 0.0, "{key} may be lowered"),
        }
    }
}

/// Otherwise a configuration that has run so far would be refused, or could not be set back to itself.
#[test]
fn what_the_configuration_itself_asks_for_is_within_its_hard_limits() {
    let text = format!("{GOOD}inputs: {{rotary_speed: {{max_rpm: 400}}, hard_limits: {{rate: 1}}}}\n");
    let config = Config::from_text("rig.yaml", &text).unwrap();
    let bounds = HardBounds::of(&config);
    bounds.check(&config).unwrap();
    let higher = config.with_value("inputs.rotary_speed.max_rpm", 401.0).unwrap();
    assert!(
        bounds
            .check(&higher)
            .unwrap_err()
            .to_string()
            .contains("at most 400 r/min")
    );
    let warnings = config.warnings().join("\n");
    assert!(
        warnings.contains("inputs.rotary_speed.max_rpm 400 r/min is beyond inputs.hard_limits.max_rpm 300 r/min"),
        "{warnings}"
    );
}

/// The outputs by which an operator knows that the twin works cannot be switched off; the others can.
#[test]
fn status_and_diagnostics_have_a_least_rate() {
    let config = Config::from_text("rig.yaml", GOOD).unwrap();
    for key in ["outputs.rates.status", "outputs.rates.diagnostics"] {
        for rate in [0.0, 0.999] {
            let error = config.with_value(key, rate).unwrap_err().to_string();
            assert!(
                error.contains(&format!("{key} = {rate} Hz: must be 1 to 1000 Hz")),
                "{error}"
            );
        }
        assert!(config.with_value(key, 1.0).is_ok());
    }
    assert!(config.with_value("outputs.rates.contact_forces", 0.0).is_ok());
}

#[test]
fn named_drivers_need_names() {
    let error = error_of(&format!("{GOOD}inputs: {{driver: {{policy: named}}}}\n"));
    assert!(
        error.contains("inputs.driver.named = []")
            && error.contains("must be a list of nodes or ids when driver.policy is named"),
        "{error}"
    );
    let error = error_of(&format!("{GOOD}inputs: {{driver: {{named: [/rig]}}}}\n"));
    assert!(error.contains("left out unless driver.policy is named"), "{error}");
    assert!(
        Config::from_text(
            "rig.yaml",
            &format!("{GOOD}inputs: {{driver: {{policy: named, named: [/rig]}}}}\n")
        )
        .is_ok()
    );
}
