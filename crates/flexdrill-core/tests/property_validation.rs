//! Whatever number a field of the description or the settings is set to: it is refused with the field's name, or the
//! twin runs or says why it cannot. Nothing panics.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::Scheme;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{
    Body, Direction, LoadHistory, Location, PointLoad, PointMass, Support, ToolDescription, WellSection,
};
use flexdrill_core::twin::{BuildError, Simulation, SimulationSettings};
use flexdrill_core::validation::ValidationError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use support::tiny;

const INPUTS: Inputs = Inputs {
    rotary_speed: 4.0,
    weight_on_bit: 1e3,
    ..Inputs::ZERO
};

/// The tool with one of everything, so that every numeric field is there.
fn with_everything() -> ToolDescription {
    let mut tool = tiny();
    tool.well.sections.push(WellSection::Straight { length: 0.1 });
    let load = |history| PointLoad {
        location: Location::Joint(0),
        body: Body::Pipe,
        direction: Direction::V,
        history,
    };
    tool.loads = vec![
        load(LoadHistory::Constant(1.0)),
        load(LoadHistory::Ramp {
            rate: 1.0,
            start: 0.5,
            end: 2.0,
        }),
        load(LoadHistory::Sine {
            amplitude: 1.0,
            frequency: 2.0,
            phase: 0.3,
        }),
        load(LoadHistory::Table(vec![(0.5, 1.0), (1.5, 2.0)])),
    ];
    tool.masses = vec![PointMass {
        location: Location::Station(1),
        body: Body::Guide,
        mass: 1.0,
        axial_inertia: 0.02,
        transverse_inertia: 0.03,
        eccentricity: 0.01,
        eccentricity_phase: 0.5,
    }];
    tool
}

/// Builds and takes some steps; the error if it was refused.
fn run(tool: &ToolDescription, settings: &SimulationSettings) -> Option<BuildError> {
    match Simulation::new(tool, settings) {
        Ok(mut simulation) => {
            for _ in 0..5 {
                // A step may fail here; it may not panic.
                let _ = simulation.advance(&INPUTS);
            }
            let mut snapshot = simulation.new_snapshot();
            simulation.snapshot(&mut snapshot, true);
            None
        }
        Err(error) => Some(error),
    }
}

/// Pointers to all numbers of a value.
fn numbers(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(at.to_owned()),
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                numbers(item, &format!("{at}/{index}"), found);
            }
        }
        Value::Object(items) => {
            for (key, item) in items {
                numbers(item, &format!("{at}/{key}"), found);
            }
        }
        _ => {}
    }
}

/// Copies of `original` with each number in turn replaced by each of `values`; those that are no such type (-1 for a
/// count) left out.
fn changed<T: Serialize + DeserializeOwned>(original: &T, values: &[f64]) -> Vec<(String, f64, T)> {
    let tree = serde_json::to_value(original).unwrap();
    let mut pointers = Vec::new();
    numbers(&tree, "", &mut pointers);
    let mut copies = Vec::new();
    for pointer in pointers {
        for &value in values {
            let mut tree = tree.clone();
            let number = tree.pointer_mut(&pointer).unwrap();
            *number = if number.is_u64() {
                Value::from(value as i64)
            } else {
                Value::from(value)
            };
            if let Ok(copy) = serde_json::from_value(tree) {
                copies.push((pointer.clone(), value, copy));
            }
        }
    }
    copies
}

/// JSON has no NaN and no infinity: a number that stands in for each, found again by its bits in the postcard bytes.
fn with_bits<T: Serialize + DeserializeOwned>(original: &T, value: f64) -> Vec<(String, T)> {
    const MARK: f64 = 1.234_567_890_123e-3;
    changed(original, &[MARK])
        .into_iter()
        .filter_map(|(field, _, copy)| {
            let mut bytes = postcard::to_stdvec(&copy).unwrap();
            let at = bytes.windows(8).position(|window| window == MARK.to_le_bytes())?;
            bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
            Some((field, postcard::from_bytes(&bytes).unwrap()))
        })
        .collect()
}

#[test]
fn zero_and_negative_numbers_are_refused_or_work() {
    let (tool, settings) = (with_everything(), SimulationSettings::default());
    assert!(run(&tool, &settings).is_none());
    let mut refused = 0;
    for (field, value, changed) in changed(&tool, &[0.0, -1.0, 1e-300, 1e300]) {
        let error = run(&changed, &settings);
        refused += usize::from(matches!(error, Some(BuildError::Tool(_))));
        println!(
            "{field} = {value}: {}",
            error.map_or("runs".into(), |error| error.to_string())
        );
    }
    assert!(refused > 60, "{refused}");
    refused = 0;
    for (field, value, changed) in changed(&settings, &[0.0, -1.0, 1e-300, 1e300]) {
        let error = run(&tool, &changed);
        refused += usize::from(matches!(error, Some(BuildError::Settings(_))));
        println!(
            "{field} = {value}: {}",
            error.map_or("runs".into(), |error| error.to_string())
        );
    }
    assert!(refused > 60, "{refused}");
}

#[test]
fn nan_and_infinity_are_refused_in_every_field() {
    let (tool, settings) = (with_everything(), SimulationSettings::default());
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let tools = with_bits(&tool, value);
        assert!(tools.len() > 50, "{}", tools.len());
        for (field, changed) in tools {
            let error = changed.validate().expect_err(&field);
            // The error names the last part of the field's path, or one that is held against it.
            let last = field.rsplit('/').find(|part| part.parse::<usize>().is_err()).unwrap();
            let known = [
                "inner_diameter",
                "outer_diameter",
                "hole_diameter",
                "Constant",
                "Table",
                "end",
            ];
            assert!(
                error.to_string().contains(last) || known.contains(&last),
                "{field} = {value}: {error}"
            );
            assert!(matches!(run(&changed, &settings), Some(BuildError::Tool(_))));
        }
        let all = with_bits(&settings, value);
        assert!(all.len() > 40, "{}", all.len());
        for (field, changed) in all {
            assert!(changed.validate(2).is_err(), "{field} = {value}");
            assert!(matches!(run(&tool, &changed), Some(BuildError::Settings(_))));
        }
    }
}

/// Each error as it reads.
#[test]
fn errors_name_field_value_bound_and_unit() {
    type Change = fn(&mut ToolDescription);
    let cases: [(Change, &str); 14] = [
        (|t| t.links = 0, "links = 0: must be 1 to 20000"),
        (
            |t| t.links = 19_999,
            "links x elements_per_link = 99995: must be 1 to 20000",
        ),
        (
            |t| t.elements_per_link = 4,
            "pipe_sections: 5 entries, must be 4, one per element of a link (elements_per_link)",
        ),
        (
            |t| t.pipe_contact_diameters.truncate(5),
            "pipe_contact_diameters: 5 entries, must be 6, one per station of a link (elements_per_link + 1)",
        ),
        (
            |t| t.well.sections.clear(),
            "well.sections: 0 entries, must be at least 1",
        ),
        (
            |t| t.guide_section.inner_diameter = 0.06,
            "guide_section.inner_diameter = 0.06 m: must be finite and above 0.063",
        ),
        (
            |t| t.hole_diameter = 0.1,
            "hole_diameter = 0.1 m: must be finite and above 0.102",
        ),
        (
            |t| t.inner.friction_axial = -0.2,
            "inner.friction_axial = -0.2: must be finite and at least 0",
        ),
        (
            |t| t.joint.limit = f64::NAN,
            "joint.limit = NaN rad: must be finite and above 0",
        ),
        (
            |t| t.material.poisson_ratio = 0.6,
            "material.poisson_ratio = 0.6: must be above -1, at most 0.5",
        ),
        (
            |t| t.supports[0].location = Location::Joint(32),
            "supports[0].location = Joint(32): not on the tool, which has stations 0 to 165 and 32 joints",
        ),
        (
            |t| t.supports[1].directions.clear(),
            "supports[1].directions: a support that holds no direction",
        ),
        (
            |t| {
                t.supports.push(Support {
                    location: Location::Station(0),
                    body: Body::Pipe,
                    directions: vec![Direction::Psi],
                });
            },
            "supports[4].directions: psi of the driven node is held",
        ),
        (
            |t| t.initial_spin_rate = 1.0,
            "static_start: a start from rest with an initial motion",
        ),
    ];
    for (change, expected) in cases {
        let mut tool = ToolDescription::paper();
        change(&mut tool);
        let error = tool.validate().unwrap_err();
        assert!(error.to_string().starts_with(expected), "{error}\n{expected}");
    }
}

#[test]
fn schemes_that_gain_energy_are_refused() {
    for stable in [
        Scheme::newmark(0.5),
        Scheme::newmark(1.0),
        Scheme::hht(0.5),
        Scheme::hht(1.0),
        Scheme::generalised_alpha(0.0),
        Scheme::generalised_alpha(1.0),
    ] {
        stable.validate().unwrap();
    }
    for unstable in [
        Scheme::newmark(0.49),
        Scheme::newmark(f64::NAN),
        Scheme::hht(0.2),
        Scheme::generalised_alpha(1.1),
        Scheme::generalised_alpha(-0.1),
        Scheme {
            beta: 0.0,
            ..Scheme::newmark(0.5)
        },
    ] {
        let error = unstable.validate().unwrap_err();
        assert!(
            matches!(&error, ValidationError::Value { field, .. } if field.starts_with("scheme.")),
            "{error}"
        );
    }
}

#[test]
fn what_changes_while_running_is_checked_too() {
    let mut simulation = support::simulation(&tiny());
    let before = simulation.checkpoint().unwrap();
    let mut live = simulation.live();
    live.outer_friction[1] = f64::NAN;
    assert!(simulation.set_live(live).is_err());
    assert!(simulation.set_slew(-1.0, 1e3).is_err() && simulation.set_slew(1.0, f64::NAN).is_err());
    let mut whirl = simulation.settings().whirl;
    whirl.evaluation_interval = 0.0;
    assert!(simulation.set_whirl(&whirl).is_err());
    assert_eq!(simulation.checkpoint().unwrap(), before);
}
