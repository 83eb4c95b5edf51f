//! A wrong configuration is refused with file, line, key, value, bound and unit.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod live;
mod physics;

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

/// Anybody may send a configuration, and a thread that reads one may have little stack: half of what a new thread has.
#[test]
fn deep_nesting_is_refused_before_it_takes_the_stack() {
    let reads = || {
        for depth in [20, 64, 1000, 100_000] {
            for [open, close] in [["[", "]"], ["{a: ", "}"], ["- ", ""]] {
                let text = format!("tool:\n  {}1{}\n", open.repeat(depth), close.repeat(depth));
                assert!(Config::from_text("rig.yaml", &text).is_err(), "{depth} {open}");
            }
        }
    };
    let thread = std::thread::Builder::new().stack_size(1 << 20);
    thread.spawn(reads).unwrap().join().unwrap();
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
