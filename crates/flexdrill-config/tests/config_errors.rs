//! A wrong configuration is refused with file, line, key, value, bound and unit.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::{Config, ConfigError, HardBounds, TimeScheme};
use flexdrill_core::dynamics::Scheme;
use flexdrill_core::tool::{ToolDescription, WobPath};
use proptest::prelude::*;

const GOOD: &str = "\
well:
  sections: [{arc: {radius: 3.2, build_angle_deg: 90}}]
  hole_diameter: 0.118
tool:
  links: 33
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118}
";

fn error_of(text: &str) -> String {
    match Config::from_text("rig.yaml", text) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

fn replaced(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from));
    GOOD.replace(from, to)
}

#[test]
fn range_errors_name_everything() {
    let error = error_of(&replaced("hole_diameter: 0.118", "hole_diameter: 118"));
    assert_eq!(
        error,
        "rig.yaml:3: well.hole_diameter = 118 m: must be above 0, at most 2 m (a bore of a slim drilling tool, given in metres)"
    );
}

#[test]
fn all_problems_are_reported_at_once() {
    let text = replaced("limit_deg: 6", "limit_deg: .nan") + "solver:\n  gamma: 0.4\n  time_step: -1\n";
    let Err(ConfigError::Invalid { problems }) = Config::from_text("rig.yaml", &text) else {
        panic!("accepted");
    };
    let places: Vec<_> = problems
        .iter()
        .map(|problem| (problem.key.as_str(), problem.line))
        .collect();
    assert_eq!(
        places,
        [
            ("tool.joint.limit_deg", Some(8)),
            ("solver.time_step", Some(12)),
            ("solver.gamma", Some(11))
        ]
    );
}

#[test]
fn unknown_keys_are_refused() {
    let error = error_of(&(GOOD.to_string() + "solver:\n  tim_step: 1e-4\n"));
    assert!(
        error.starts_with("rig.yaml:11:3: solver.tim_step: unknown field `tim_step`; did you mean `time_step`?"),
        "{error}"
    );
    let error = error_of(&(GOOD.to_string() + "inputs: {driver: {policy: frist}}\n"));
    assert!(
        error.contains("unknown variant `frist`; did you mean `first`?"),
        "{error}"
    );
    // No guess where no key is similar.
    let error = error_of(&(GOOD.to_string() + "colour: red\n"));
    assert!(
        error.contains("unknown field `colour`") && !error.contains("did you mean"),
        "{error}"
    );
}

#[test]
fn missing_keys_are_named_with_their_path() {
    assert_eq!(
        error_of(&replaced("  links: 33\n", "")),
        "rig.yaml:4:1: tool.links: must be given, it has no default"
    );
    assert_eq!(
        error_of("run: {title: a}\n"),
        "rig.yaml:1:1: well: must be given, it has no default"
    );
}

#[test]
fn wrong_types_show_the_value() {
    assert_eq!(
        error_of(&replaced("links: 33", "links: -3")),
        "rig.yaml:5:10: tool.links = -3: must be a whole number, 0 or more"
    );
    assert_eq!(
        error_of(&replaced("limit_deg: 6", "limit_deg: six")),
        "rig.yaml:8:22: tool.joint.limit_deg = six: must be a number"
    );
}

#[test]
fn what_is_no_yaml_is_said_without_names_of_the_library() {
    let twice = error_of(&replaced("  links: 33", "  links: 33\n  links: 34"));
    assert_eq!(twice, "rig.yaml:6:3: `links` is given twice; keep one of them");
    let two = error_of(&format!("{GOOD}---\n{GOOD}"));
    assert!(two.contains("a second document begins here"), "{two}");
    for text in [
        replaced("  links: 33", "\tlinks: 33"),
        replaced("well:", "\twell:"),
        replaced("  hole_diameter", "\thole_diameter"),
        replaced("  links: 33", "  links: 33\n\t"),
        replaced("  hole_diameter: 0.118", "\thole_diameter: 0.118\n  other: 1"),
    ] {
        match Config::from_text("rig.yaml", &text) {
            // A line of a tab alone has no key.
            Ok(_) => assert!(text.contains("\n\t\n"), "{text}"),
            Err(error) => {
                let (error, line) = (
                    error.to_string(),
                    text.lines().position(|line| line.contains('\t')).unwrap() + 1,
                );
                assert_eq!(
                    error,
                    format!("rig.yaml:{line}:1: a tab stands before this key; YAML indents with spaces")
                );
            }
        }
    }
    for (from, to, words) in [
        (
            "joint: {limit_deg: 6}",
            "joint: 6",
            "tool.joint: must be a group of keys",
        ),
        (
            "joint: {limit_deg: 6}",
            "joint: [6]",
            "tool.joint: must be a group of keys",
        ),
        ("bit: {diameter: 0.118}", "bit: {diameter: 0.118", "bracket"),
        ("  links: 33", "   links: 33", "indented"),
        ("  links: 33", "  links: 33: 34", "a second `: `"),
        ("  links: 33", "  links:", "links"),
        ("  links: 33", "  links: [33]", "links"),
    ] {
        let error = error_of(&replaced(from, to));
        assert!(error.starts_with("rig.yaml:") && error.contains(words), "{to}: {error}");
        for name in [
            "Option",
            "Policy",
            "from_str",
            "struct ",
            "Schema",
            "usize",
            "mapping start",
            "parsing a",
        ] {
            assert!(!error.contains(name), "{to}: {error}");
        }
    }
}

#[test]
fn a_decimal_comma_is_quoted_and_named() {
    assert_eq!(
        error_of(&replaced("hole_diameter: 0.118", "hole_diameter: 0,118")),
        "rig.yaml:3:18: well.hole_diameter = 0,118: must be a number; decimals follow a point, not a comma"
    );
    let error = error_of(&replaced("bit: {diameter: 0.118}", "bit: {diameter: 0,118}"));
    assert!(
        error.ends_with("unknown field `118`; in a number, decimals follow a point, not a comma"),
        "{error}"
    );
}

#[test]
fn a_default_that_contradicts_the_file_is_called_a_default() {
    let error = error_of(&(GOOD.to_string() + "inputs:\n  rotary_speed:\n    min_rpm: 10\n"));
    assert!(
        error.contains("rig.yaml:11: inputs.rotary_speed.initial_rpm = 0 r/min (the default): must be 10 to 120 r/min"),
        "{error}"
    );
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Config::load("no/such.yaml").unwrap_err().to_string();
    assert!(error.starts_with("no/such.yaml: cannot be read: "), "{error}");
}

#[test]
fn friction_and_weight_are_refused_where_they_have_no_meaning() {
    let error = error_of(&format!(
        "{GOOD}contact: {{outer: {{friction: bristle, slip_speed: 1.0e-4}}}}\n"
    ));
    assert!(
        error.contains("contact.outer.slip_speed = 0.0001 m/s") && error.contains("friction: bristle"),
        "{error}"
    );
    let error = error_of(&format!(
        "{GOOD}contact: {{inner: {{friction: vector, slip_speed: 0}}}}\n"
    ));
    assert!(error.contains("contact.inner.slip_speed = 0 m/s"), "{error}");
    for (other, named) in [
        ("wob_path: shared", "boundary.wob_path"),
        ("bottom_axial: fixed", "boundary.bottom_axial"),
        (
            "preset: none, supports: [{at: bottom, body: guide, fix: [v]}]",
            "boundary.supports",
        ),
    ] {
        let error = error_of(&format!("{GOOD}boundary: {{weight_on_bit_at: kickoff, {other}}}\n"));
        assert!(
            error.contains("boundary.weight_on_bit_at = kickoff") && error.contains(named),
            "{error}"
        );
    }
    let text = format!("{GOOD}boundary: {{weight_on_bit_at: kickoff}}\n");
    let tool = Config::from_text("rig.yaml", &text).unwrap().tool();
    tool.validate().unwrap();
    // The mechanics refuses the same on its own.
    for change in [
        |tool: &mut ToolDescription| tool.wob_path = WobPath::Shared,
        |tool: &mut ToolDescription| tool.supports.clear(),
        |tool: &mut ToolDescription| tool.guide_fixed = true,
    ] {
        let error = tool.clone().with(change).validate().unwrap_err().to_string();
        assert!(error.contains("weight_place"), "{error}");
    }
}

#[test]
fn places_are_held_against_the_mesh() {
    let load = |at: &str| {
        format!("{GOOD}loads:\n  - at: {at}\n    body: pipe\n    direction: w\n    history: {{constant: 1}}\n")
    };
    assert!(Config::from_text("rig.yaml", &load("{joint: 31}")).is_ok());
    assert!(error_of(&load("{joint: 32}")).starts_with("rig.yaml:11: loads.0.at.joint = 32: must be 0 to 31"));
    assert!(Config::from_text("rig.yaml", &load("{station: 165}")).is_ok());
    assert!(error_of(&load("{station: 166}")).contains("loads.0.at.station = 166: must be 0 to 165"));
    assert!(error_of(&load("{measured_depth: 5.1}")).contains("loads.0.at.measured_depth = 5.1 m"));
}

#[test]
fn a_body_has_the_inertia_that_a_body_can_have() {
    let mass = |more: &str| format!("{GOOD}masses:\n  - {{at: bottom, body: pipe, mass: 8, inertia: 0.02{more}}}\n");
    let disc = Config::from_text("rig.yaml", &mass("")).unwrap().tool().masses[0];
    assert_eq!((disc.axial_inertia, disc.transverse_inertia), (0.02, 0.01));
    let long = Config::from_text("rig.yaml", &mass(", transverse_inertia: 0.3")).unwrap();
    assert_eq!(long.tool().masses[0].transverse_inertia, 0.3);
    assert!(error_of(&mass(", transverse_inertia: 0.009")).starts_with(
        "rig.yaml:11: masses.0.transverse_inertia = 0.009 kg m2: must be at least half of inertia, 0.01 kg m2 (a thin disc"
    ));
    assert!(error_of(&mass(", eccentricity: -0.1")).contains("masses.0.eccentricity = -0.1 m: must be 0 to 1 m"));
}

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
fn gamma_means_newmark() {
    let with = |solver: &str| GOOD.to_string() + &format!("solver: {{{solver}}}\n");
    // Files from before the other schemes name Newmark by its parameter only.
    let config = Config::from_text("rig.yaml", &with("gamma: 0.6")).unwrap();
    assert_eq!(config.solver.scheme, TimeScheme::Newmark);
    assert_eq!(config.simulation().scheme, Scheme::newmark(0.6));
    let config = Config::from_text("rig.yaml", &with("scheme: hht, rho_infinity: 0.7")).unwrap();
    assert_eq!(config.simulation().scheme, Scheme::hht(0.7));
    for (solver, key) in [
        ("scheme: generalised_alpha, gamma: 0.6", "solver.gamma = 0.6"),
        ("scheme: newmark, rho_infinity: 0.6", "solver.rho_infinity = 0.6"),
        ("scheme: hht, rho_infinity: 0.4", "solver.rho_infinity = 0.4"),
    ] {
        let error = error_of(&with(solver));
        assert!(error.starts_with(&format!("rig.yaml:10: {key}: must be ")), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn garbage_never_panics(text in "\\PC{0,200}") {
        let _ = Config::from_text("garbage", &text);
    }

    #[test]
    fn damaged_files_never_panic(cut in 0..GOOD.len(), insert in "[-:\\[\\]{}0-9a-z,\n ]{0,6}") {
        let text = format!("{}{insert}{}", &GOOD[..cut], &GOOD[cut..]);
        if let Ok(config) = Config::from_text("damaged", &text) {
            let _ = config.tool();
            let _ = config.warnings();
        }
    }

    /// Any numbers, however wild, give either a configuration that reads back equal or an error, never a panic.
    #[test]
    fn accepted_numbers_round_trip(limit: f64, step: f64, links in 0usize..1000) {
        let text = replaced("limit_deg: 6", &format!("limit_deg: {limit:e}"))
            .replace("links: 33", &format!("links: {links}"))
            + &format!("solver: {{time_step: {step:e}}}\n");
        if let Ok(config) = Config::from_text("wild", &text) {
            let again = Config::from_text("again", &config.to_yaml().unwrap()).unwrap();
            prop_assert_eq!(&config, &again);
            prop_assert_eq!(config.hash(), again.hash());
        }
    }
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

/// What a pressure, a guide's free curvature, and mud need of other keys.
#[test]
fn impossible_pressures_preloads_and_mud_name_both_keys() {
    for (more, key, reason) in [
        (
            "environment: {pressure: {at_top: 5e6}}\n",
            "environment.pressure.end = left out",
            "closed, sealed or held",
        ),
        (
            "environment: {pressure: {end: sealed}}\n",
            "environment.pressure.seal_diameter = left out",
            "given with end sealed",
        ),
        (
            "environment: {pressure: {end: closed, seal_diameter: 0.06}}\n",
            "environment.pressure.seal_diameter = 0.06",
            "only with it",
        ),
        (
            "environment: {pressure: {end: held}}\n",
            "environment.pressure.end = held",
            "boundary.wob_path",
        ),
        (
            "environment: {pressure: {end: closed}}\nboundary: {wob_path: shared}\n",
            "environment.pressure.end = closed",
            "must be held",
        ),
        (
            "environment: {pressure: {end: closed, drop_per_metre: 0.3}}\n",
            "environment.pressure.drop_per_metre = 0.3 1/m",
            "one over the tool's length",
        ),
        (
            "environment: {mud: {film: squeeze, viscosity: 0}}\n",
            "environment.mud.film = squeeze",
            "environment.mud.viscosity above 0",
        ),
        ("start: slid_in\n", "start = slid_in", "contact.outer.friction: bristle"),
    ] {
        let error = error_of(&(GOOD.to_owned() + more));
        assert!(error.contains(key) && error.contains(reason), "{error}");
    }
    for (guide, key, reason) in [
        (
            "free_curvature: 0, fixed: true",
            "tool.guide.free_curvature = 0 1/m",
            "tool.guide.fixed",
        ),
        (
            "free_curvature: 0.1, free_curvature_phase_deg: 90",
            "tool.guide.free_curvature_phase_deg = 90 deg",
            "boundary.supports",
        ),
        (
            "free_curvature_phase_deg: 90",
            "tool.guide.free_curvature_phase_deg = 90 deg",
            "tool.guide.free_curvature is as_built",
        ),
        (
            "free_curvature: -0.1",
            "tool.guide.free_curvature = -0.1 1/m",
            "0 to 2 1/m",
        ),
        (
            "slots_close_at: 0.2",
            "tool.guide.slots_close_at = 0.2 1/m",
            "tool.guide.bending_factor is 1",
        ),
        (
            "bending_factor: 0.05, slots_close_at: 0.2, fixed: true",
            "tool.guide.slots_close_at = 0.2 1/m",
            "tool.guide.fixed",
        ),
        (
            "spine_offset: 0.02",
            "tool.guide.spine_offset = 0.02 m",
            "tool.guide.bending_factor is 1",
        ),
        (
            "bending_factor: 0.05, spine_offset: 0.052",
            "tool.guide.spine_offset = 0.052 m",
            "at most 0.051 m",
        ),
        (
            "bending_factor: 0.05, spine_offset: -0.01",
            "tool.guide.spine_offset = -0.01 m",
            "0 to 0.15 m",
        ),
        (
            "bending_factor: 0.05, spine_offset: 0.02, fixed: true",
            "tool.guide.spine_offset = 0.02 m",
            "tool.guide.fixed",
        ),
        (
            "bending_factor: 0.05, spine_offset: 0.02, spine_toolface_deg: 0",
            "tool.guide.spine_toolface_deg = 0 deg",
            "boundary.supports",
        ),
        (
            "spine_toolface_deg: 90",
            "tool.guide.spine_toolface_deg = 90 deg",
            "tool.guide.spine_offset is 0",
        ),
        (
            "bending_factor: 0.05, slots_close_at: 0",
            "tool.guide.slots_close_at = 0 1/m",
            "above 0, at most 10 1/m",
        ),
    ] {
        let with = format!("inner_diameter: 0.080, {guide}}}");
        let error = error_of(&replaced("inner_diameter: 0.080}", &with));
        assert!(error.contains(key) && error.contains(reason), "{error}");
    }
    let error = error_of(&replaced(
        "inner_diameter: 0.080}",
        "inner_diameter: 0.080, free_curvature: straight}",
    ));
    assert!(error.contains("free_curvature"), "{error}");
}

/// What a string and a rock that holds the bit need of other keys.
#[test]
fn impossible_strings_and_rocks_name_both_keys() {
    const LINE: &str =
        "string: {model: line, sections: [{length: 1000, outer_diameter: 0.073, inner_diameter: 0.0546}]}\n";
    let with_line = |more: &str| format!("{GOOD}{LINE}{more}");
    for (text, key, reason) in [
        (
            with_line("boundary: {drive: none}\n"),
            "boundary.drive = none",
            "string.model: line",
        ),
        (
            with_line("inputs: {rotary_speed: {measured: downhole}}\n"),
            "string.model = line",
            "inputs.rotary_speed.measured: surface",
        ),
        (
            format!("{GOOD}string: {{model: measured}}\n"),
            "string.model = measured",
            "inputs.rotary_speed.measured: downhole",
        ),
        (
            format!("{GOOD}rock: {{law: depth_of_cut}}\n"),
            "rock.law = depth_of_cut",
            "string.model: line",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {bottom_axial: fixed}\n"),
            "boundary.bottom_axial = fixed",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {weight_on_bit_at: kickoff}\n"),
            "boundary.weight_on_bit_at = kickoff",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {preset: none}\n"),
            "boundary.preset = none",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\nboundary: {supports: [{at: top, body: guide, fix: [u]}]}\n"),
            "boundary.supports = u of a pipe at the top",
            "rock.law: depth_of_cut",
        ),
        (
            with_line("rock: {law: depth_of_cut}\n")
                .replace("inner_diameter: 0.080}", "inner_diameter: 0.080, fixed: true}"),
            "tool.guide.fixed = true",
            "rock.law: depth_of_cut",
        ),
        // The string turns the first link, which nothing else may hold.
        (
            with_line("boundary: {supports: [{at: top, body: pipe, fix: [psi]}]}\n"),
            "boundary.supports.0.fix = psi of the driven node",
            "boundary.drive none",
        ),
    ] {
        let error = error_of(&text);
        assert!(error.contains(key) && error.contains(reason), "{error}");
    }
    // The rock then holds both ends together.
    let shared = with_line("rock: {law: depth_of_cut}\nboundary: {wob_path: shared}\n");
    assert!(Config::from_text("rig.yaml", &shared).is_ok());
}
