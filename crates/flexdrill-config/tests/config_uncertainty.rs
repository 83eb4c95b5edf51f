//! `uncertainty` is refused with key, bound and reason where it makes no sense, and is left out of what it does not change.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::{Config, ConfigError, Form};

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

fn with(section: &str) -> String {
    format!("{GOOD}uncertainty:\n{section}")
}

fn entry(fields: &str) -> String {
    with(&format!("  keys:\n    - {{{fields}, source: a test}}\n"))
}

/// The problems, as key and text.
fn problems(text: &str) -> Vec<(String, String)> {
    match Config::from_text("rig.yaml", text) {
        Ok(_) => Vec::new(),
        Err(ConfigError::Invalid { problems }) => problems
            .iter()
            .map(|problem| (problem.key.clone(), problem.to_string()))
            .collect(),
        Err(other) => panic!("{other}"),
    }
}

/// The only problem.
fn problem(text: &str) -> (String, String) {
    let found = problems(text);
    assert_eq!(found.len(), 1, "{found:?}");
    found[0].clone()
}

#[test]
fn a_file_without_the_section_has_the_hash_that_it_had() {
    let without = Config::from_text("rig.yaml", GOOD).unwrap();
    assert!(without.uncertainty.is_none());
    assert!(without.to_tree().get("uncertainty").is_none());
    let text = entry("key: tool.joint.limit_deg, form: offset, distribution: {normal: {low: -1, high: 1}}");
    let given = Config::from_text("rig.yaml", &text).unwrap();
    assert_ne!(given.hash(), without.hash());
    assert_eq!(given.motion_hash(), without.motion_hash());
    assert_eq!(given.without_uncertainty(), without);
    assert_eq!(given.without_uncertainty().hash(), without.hash());
    let again = Config::from_text("written", &given.to_yaml().unwrap()).unwrap();
    assert_eq!(again, given);
}

#[test]
fn a_distribution_stays_within_the_limits_of_its_key() {
    let (key, text) = problem(&entry(
        "key: contact.inner.friction_axial, distribution: {log_normal: {low: 0.2, high: 4}}",
    ));
    assert_eq!(key, "uncertainty.keys.0.distribution");
    assert_eq!(
        text,
        "rig.yaml:12: uncertainty.keys.0.distribution = log_normal {low: 0.2, high: 4}, which gives \
         contact.inner.friction_axial 4: must be 0 to 2 (dry surfaces stay below 1; 2 leaves room for trials)"
    );
    // A limit that is itself not allowed, below a factor and below an offset.
    for fields in [
        "key: tool.joint.limit_deg, distribution: {uniform: {low: 0, high: 4}}",
        "key: tool.joint.limit_deg, form: factor, distribution: {uniform: {low: 0, high: 1}}",
        "key: tool.joint.limit_deg, form: offset, distribution: {uniform: {low: -6, high: 1}}",
    ] {
        let (_, text) = problem(&entry(fields));
        assert!(
            text.contains("which gives tool.joint.limit_deg 0 deg: must be above 0"),
            "{text}"
        );
    }
    // Each key of the entry counts.
    let fields = "key: tool.damping.alpha, also: [tool.damping.beta], distribution: {uniform: {low: 0.5, high: 2}}";
    let (_, text) = problem(&entry(fields));
    assert!(text.contains("gives tool.damping.beta 2 s: must be 0 to 1 s"), "{text}");
}

#[test]
fn unknown_keys_are_named_with_the_one_that_was_meant() {
    let (key, text) = problem(&entry(
        "key: tool.joint.limit_dge, distribution: {uniform: {low: 1, high: 2}}",
    ));
    assert_eq!(key, "uncertainty.keys.0.key");
    assert!(text.contains("did you mean tool.joint.limit_deg?"), "{text}");
    // Counts, words, what is left out, and the section itself.
    for name in [
        "tool.links",
        "tool.joint.kind",
        "environment.mud.density",
        "uncertainty.sensors.hook_load.factor_error",
        "well",
        "\"\"",
    ] {
        let (_, text) = problem(&entry(&format!(
            "key: {name}, distribution: {{uniform: {{low: 1, high: 2}}}}"
        )));
        assert!(text.contains("must be the name of a number"), "{text}");
    }
    let fields = "key: tool.damping.alpha, also: [tool.damping.gamma], distribution: {uniform: {low: 0.5, high: 2}}";
    assert_eq!(problem(&entry(fields)).0, "uncertainty.keys.0.also");
    // A key of the section that does not exist is refused like any other.
    let error = Config::from_text("rig.yaml", &entry("key: a, distribution: {norml: {low: 1, high: 2}}"));
    assert!(error.unwrap_err().to_string().contains("did you mean `normal`?"));
    let error = Config::from_text("rig.yaml", &with("  sensor: {}\n"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("did you mean `sensors`?"), "{error}");
}

/// Dotted paths of all numbers of a configuration that are no counts.
fn continuous(value: &serde_json::Value, path: &str, into: &mut Vec<String>) {
    let below = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match value {
        serde_json::Value::Object(map) => {
            map.iter().for_each(|(key, value)| continuous(value, &below(key), into));
        }
        serde_json::Value::Array(items) => {
            let items = (0..).zip(items);
            items.for_each(|(index, value): (usize, _)| continuous(value, &below(&index.to_string()), into));
        }
        serde_json::Value::Number(number) if number.is_f64() => into.push(path.to_owned()),
        _ => {}
    }
}

/// What the schema has as a number that is no count has limits, within which it may be uncertain: the damping of contacts that a
/// file leaves out, numbers in lists.
#[test]
fn every_number_that_is_no_count_may_be_uncertain() {
    let every_number = include_str!("data/every_number.yaml");
    let rig = include_str!("../../../config/rig.yaml");
    for (name, text) in [("small", GOOD), ("every_number", every_number), ("rig", rig)] {
        let config = Config::from_text(name, text).unwrap().without_uncertainty();
        let mut keys = Vec::new();
        continuous(&config.to_tree(), "", &mut keys);
        assert!(keys.iter().any(|key| key == "contact.outer.damping"), "{keys:?}");
        let numbers = config.numbers();
        let unknown = keys
            .iter()
            .filter(|key| !numbers.iter().any(|number| number.key == **key));
        assert_eq!(unknown.collect::<Vec<_>>(), Vec::<&String>::new(), "{name}");
    }
    let fields = "key: contact.outer.damping, also: [contact.inner.damping], form: factor, distribution: {log_normal: {low: 0.5, high: 2}}";
    assert_eq!(problems(&entry(fields)), []);
}

#[test]
fn a_distribution_is_one() {
    for (distribution, bound) in [
        ("normal: {low: 2, high: 1}", "low below high"),
        ("normal: {low: 1, high: 1}", "low below high"),
        ("normal: {low: .nan, high: 1}", "low below high"),
        ("uniform: {low: 1, high: .inf}", "low below high"),
        ("log_normal: {low: 0, high: 1}", "low above 0"),
        ("log_normal: {low: 5.0e-324, high: 1}", "low above 0"),
        ("triangular: {low: 1, mode: 3, high: 2}", "mode from low to high"),
        ("triangular: {low: 1, mode: .nan, high: 2}", "mode from low to high"),
    ] {
        let text = entry(&format!("key: tool.joint.limit_deg, distribution: {{{distribution}}}"));
        let (key, text) = problem(&text);
        assert_eq!(key, "uncertainty.keys.0.distribution");
        assert!(text.contains(bound), "{text}");
    }
    let (key, text) = problem(&entry(
        "key: tool.joint.friction, form: factor, distribution: {uniform: {low: 1, high: 2}}",
    ));
    assert_eq!(key, "uncertainty.keys.0.form");
    assert!(
        text.contains("value or offset while tool.joint.friction is 0"),
        "{text}"
    );
    let text =
        "  keys:\n    - {key: tool.joint.limit_deg, distribution: {uniform: {low: 1, high: 2}}, source: \" \"}\n";
    assert_eq!(problem(&with(text)).0, "uncertainty.keys.0.source");
    let twice = "  keys:\n    - {key: tool.joint.limit_deg, distribution: {uniform: {low: 1, high: 2}}, source: a}\n"
        .to_owned()
        + "    - {key: tool.joint.limit_deg, distribution: {uniform: {low: 1, high: 2}}, source: b}\n";
    let (key, text) = problem(&with(&twice));
    assert!(key == "uncertainty.keys.1.key" && text.contains("given once"), "{text}");
}

/// Three keys with correlations of their pairs.
fn three(groups: &[(&[&str], f64)]) -> String {
    let mut text = "  keys:\n".to_owned();
    for key in ["tool.joint.limit_deg", "tool.damping.alpha", "solver.time_step"] {
        text += &format!(
            "    - {{key: {key}, form: factor, distribution: {{uniform: {{low: 0.9, high: 1.1}}}}, source: a test}}\n"
        );
    }
    text += "  correlated:\n";
    for (keys, correlation) in groups {
        text += &format!("    - {{keys: [{}], correlation: {correlation}}}\n", keys.join(", "));
    }
    with(&text)
}

#[test]
fn a_correlation_is_one() {
    let [a, b, c] = ["tool.joint.limit_deg", "tool.damping.alpha", "solver.time_step"];
    assert!(problems(&three(&[(&[a, b, c], 0.9)])).is_empty());
    assert!(problems(&three(&[(&[a, b, c], -0.49)])).is_empty());
    for (groups, key, part) in [
        // 1 + (n - 1) r is negative for three keys and r below -0.5.
        (
            vec![(&[a, b, c][..], -0.6)],
            "uncertainty.correlated",
            "positive definite",
        ),
        (
            vec![(&[a, b][..], 0.9), (&[b, c][..], 0.9), (&[a, c][..], -0.9)],
            "uncertainty.correlated",
            "positive definite",
        ),
        (
            vec![(&[a, b][..], 1.0)],
            "uncertainty.correlated.0.correlation",
            "-0.999 to 0.999",
        ),
        (vec![(&[a][..], 0.5)], "uncertainty.correlated.0.keys", "at least 2"),
        (
            vec![(&[a, a][..], 0.5)],
            "uncertainty.correlated.0.keys",
            "another draw",
        ),
        (
            vec![(&[a, "tool.damping.alhpa"][..], 0.5)],
            "uncertainty.correlated.0.keys",
            "did you mean tool.damping.alpha?",
        ),
        (
            vec![(&[a, b][..], 0.5), (&[b, a][..], 0.5)],
            "uncertainty.correlated",
            "a pair has one correlation",
        ),
    ] {
        let (found, text) = problem(&three(&groups));
        assert_eq!(found, key, "{text}");
        assert!(text.contains(part), "{text}");
    }
    let nan = three(&[(&[a, b], f64::NAN)]).replace("NaN", ".nan");
    assert_eq!(problem(&nan).0, "uncertainty.correlated.0.correlation");
}

#[test]
fn a_sensor_is_within_its_limits() {
    let (key, text) = problem(&with("  sensors: {weight_indicator: {factor_error: 0.5}}\n"));
    assert_eq!(key, "uncertainty.sensors.weight_indicator.factor_error");
    assert!(text.contains("must be 0 to 0.3"), "{text}");
}

#[test]
fn forms_lead_to_a_value_and_back() {
    for (form, draw, value) in [
        (Form::Value, 0.3, 0.3),
        (Form::Factor, 2.0, 0.4),
        (Form::Offset, -0.1, 0.1),
    ] {
        assert!((form.value(draw, 0.2) - value).abs() < 1e-16);
        assert!((form.draw(value, 0.2) - draw).abs() < 1e-15);
    }
}

#[test]
fn a_long_list_is_refused_before_its_pairs_are_formed() {
    let one = "    - {key: tool.joint.limit_deg, distribution: {uniform: {low: 1, high: 2}}, source: a}\n";
    let text = with(&format!("  keys:\n{}", one.repeat(201)));
    let (key, text) = problem(&text);
    assert!(key == "uncertainty.keys" && text.contains("at most 200"), "{text}");
}

/// The priors of the repository's tools.
#[test]
fn shipped_priors_have_sources() {
    for (name, count) in [("rig", 24), ("default", 10)] {
        let path = format!("{}/../../config/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        let config = Config::load(path).unwrap();
        let stated = config.uncertainty.as_ref().unwrap();
        assert_eq!(stated.keys.len(), count, "{name}");
        assert!(stated.keys.iter().all(|entry| entry.source.len() > 5), "{name}");
        assert!(stated.sensors.weight_indicator.factor_error > 0.0, "{name}");
    }
}

/// A sweep or a client changes the tool; a prior that has lost its meaning is removed with its value, and the others stay.
#[test]
fn a_changed_value_takes_its_prior_along() {
    let path = format!("{}/../../config/rig.yaml", env!("CARGO_MANIFEST_DIR"));
    let rig = Config::load(path).unwrap();
    let count = |config: &Config| {
        let stated = config.uncertainty.as_ref().unwrap();
        (stated.keys.len(), stated.correlated.len())
    };
    let changed = |key: &str, value: serde_json::Value| rig.with_value(key, value).unwrap();
    let (all, groups) = count(&rig);
    assert_eq!(
        count(&changed("contact.inner.friction_axial", 0.3.into())),
        (all, groups)
    );
    assert_eq!(
        count(&changed("tool.guide.free_curvature", "as_built".into())),
        (all - 1, groups)
    );
    assert_eq!(
        count(&changed("string.attenuation_per_km", 0.into())),
        (all - 1, groups)
    );
    // Density and viscosity, and the correlation of the first with buoyancy.
    assert_eq!(
        count(&changed("environment.mud", serde_json::Value::Null)),
        (all - 2, groups - 1)
    );
    // What is stated on purpose is checked.
    let all = [
        ("string.attenuation_per_km", serde_json::Value::from(0.0)),
        ("uncertainty.sensors.hook_load.factor_error", 0.1.into()),
    ];
    let error = rig.with_values("a test", all).unwrap_err().to_string();
    assert!(error.contains("string.attenuation_per_km is 0"), "{error}");
}

#[test]
fn an_ensemble_needs_members_that_have_a_band_and_something_to_draw() {
    let with_ensemble = |section: &str, ensemble: &str| format!("{GOOD}{section}ensemble: {ensemble}\n");
    let something = "uncertainty: {sensors: {rotary_speed: {factor_error: 0.01}}}\n";
    for good in [
        "{}",
        "{members: auto}",
        "{members: 8, seed: 5}",
        "{members: 256}",
        "{band_factors: [{figure: transfer/bit_torque, factor: 1.5, source: a test}]}",
    ] {
        let config = Config::from_text("rig.yaml", &with_ensemble(something, good)).unwrap();
        let again = Config::from_text("written", &config.to_yaml().unwrap()).unwrap();
        assert_eq!(again, config, "{good}");
        // It changes nothing of the motion, and no member has an ensemble.
        let plain = Config::from_text("rig.yaml", GOOD).unwrap();
        assert_eq!(
            (config.motion_hash(), config.without_uncertainty()),
            (plain.motion_hash(), plain)
        );
    }
    for (bad, bound) in [("{members: 7}", "7"), ("{members: 257}", "256")] {
        let (key, text) = problem(&with_ensemble(something, bad));
        assert!(key == "ensemble.members" && text.contains(bound), "{key}: {text}");
    }
    for (bad, wrong, bound) in [
        ("{figure: a/b, factor: 0.9, source: s}", "0.factor", "1 to 20"),
        ("{figure: a/b, factor: .nan, source: s}", "0.factor", "1 to 20"),
        ("{figure: a/b, factor: 2, source: ''}", "0.source", "the rigs"),
        (
            "{figure: a/b, factor: 2, source: s}, {figure: a/b, factor: 3, source: s}",
            "1.figure",
            "given once",
        ),
    ] {
        let (key, text) = problem(&with_ensemble(something, &format!("{{band_factors: [{bad}]}}")));
        assert!(
            key == format!("ensemble.band_factors.{wrong}") && text.contains(bound),
            "{key}: {text}"
        );
    }
    let (key, text) = problem(&with_ensemble("", "{members: 8}"));
    assert!(key == "ensemble.members" && text.contains("uncertainty.keys"), "{text}");
    for unreadable in [
        "{members: some}",
        "{members: -8}",
        "{members: 8.5}",
        "{member: 8}",
        "{seed: -1}",
        "{band_factors: [{figure: a/b, factor: 2}]}",
    ] {
        let error = Config::from_text("rig.yaml", &with_ensemble(something, unreadable)).unwrap_err();
        assert!(error.to_string().contains("ensemble"), "{unreadable}: {error}");
    }
}
