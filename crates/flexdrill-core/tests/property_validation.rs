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
    AddedMass, Body, DepthOfCut, Direction, Feed, FreeCurvature, FrictionLaw, Hoist, LoadHistory, Location, MudDamping,
    MudDescription, MudFilm, Piece, PointLoad, PointMass, PressureDescription, PressureEnd, PressureSource, RockLaw,
    SectionProperties, SpeedController, Spine, StringDescription, Support, ToolDescription, TopDrive, Tube,
    WallFriction, Weakening, WellSection,
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
    tool.guide_bending_factor = 0.5;
    tool.guide_spine = Some(Spine {
        offset: 0.01,
        phase: 0.0,
    });
    tool
}

/// The same below a string, on a rock that holds the bit, with all of the rig's physics.
fn below_a_string() -> ToolDescription {
    let mut tool = with_everything();
    let tube = Tube {
        outer_diameter: 0.0730,
        inner_diameter: 0.0546,
    };
    let mut piece = Piece::of(&SectionProperties::of(tube, tool.material, 1.0), 100.0).with_loss(0.01);
    piece.friction = Some(WallFriction {
        sliding: 300.0,
        static_ratio: 1.3,
        static_speed: 0.01,
        radius: 0.0365,
    });
    tool.string = Some(StringDescription {
        pieces: vec![
            piece,
            Piece {
                friction: None,
                ..piece
            },
        ],
        drive: TopDrive::Controlled(SpeedController {
            inertia: 50.0,
            proportional: 200.0,
            integral: 400.0,
            torque_limit: 2000.0,
        }),
        hoist: Some(Hoist {
            stiffness: 5e6,
            response_time: 1.0,
            fastest: 8e-3,
            touch_down: 3e-3,
            clearance: 10e-3,
            feed: Feed::Weight,
        }),
        weight: 20e3,
    });
    tool.rock = RockLaw::DepthOfCut(DepthOfCut {
        blades: 4,
        specific_energy: 30e6,
        cutter_inclination: 0.6,
        wear_flat_force: 8670.0,
        wear_flat_friction: 0.106,
        wear_flat_travel: 1e-4,
        cutting_weakening: 0.0,
        weakening: Weakening { ratio: 1.3, rate: 3.0 },
    });
    for support in &mut tool.supports {
        if support.location == Location::Top {
            support.directions.retain(|&direction| direction != Direction::U);
        }
    }
    tool.outer.friction_law = FrictionLaw::Bristle;
    tool.joint.friction.coefficient = 0.1;
    tool.joint.play.half_angle = 4e-3;
    tool.guide_free_curvature = Some(FreeCurvature {
        curvature: 0.1,
        phase: 0.0,
    });
    tool.mud = Some(MudDescription {
        density: 1100.0,
        viscosity: 0.02,
        frequency: 4.0 / 3.0,
        added_mass: AddedMass::Eccentric,
        damping: MudDamping::Viscous,
        film: MudFilm::Squeeze,
    });
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Constant(5e6),
        drop_per_metre: 0.01,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    });
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
    let settings = SimulationSettings::default();
    for (tool, least) in [(with_everything(), 60), (below_a_string(), 120)] {
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
        assert!(refused > least, "{refused}");
    }
    let tool = with_everything();
    let mut refused = 0;
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
        let mut tools = with_bits(&tool, value);
        assert!(tools.len() > 50, "{}", tools.len());
        let below = with_bits(&below_a_string(), value);
        assert!(below.len() > tools.len() + 30, "{}", below.len());
        tools.extend(below);
        // Entries of the guide's pieces that no piece has have no meaning; those of pieces have tests of their type.
        let unused = |field: &str| field.starts_with("/guide_bends/changes/");
        for (field, changed) in tools.into_iter().filter(|(field, _)| !unused(field)) {
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

/// A string, a hoist and a rock that do not go together, or need more memory than there is, are refused with what to change.
#[test]
fn strings_hoists_and_rocks_that_do_not_go_together_are_refused() {
    type Change = fn(&mut ToolDescription);
    let cases: [(Change, &str); 9] = [
        (
            |tool| tool.string = None,
            "rock: DepthOfCut gives the weight on bit as a result",
        ),
        (
            |tool| tool.rock = RockLaw::Paper,
            "string.hoist: a hoist needs a rock that holds the bit",
        ),
        (
            |tool| tool.drive_top = false,
            "string: the string turns the first link; set drive_top to true",
        ),
        (
            |tool| {
                tool.supports.push(Support {
                    location: Location::Top,
                    body: Body::Guide,
                    directions: vec![Direction::U],
                });
            },
            "string.hoist: the hoist carries the tops of both pipes along the hole",
        ),
        (
            |tool| {
                tool.supports.push(Support {
                    location: Location::Top,
                    body: Body::Pipe,
                    directions: vec![Direction::Psi],
                });
            },
            "psi of the driven node is held",
        ),
        (
            |tool| tool.string.as_mut().unwrap().pieces.clear(),
            "string.pieces = 0: must be 1 to 10000",
        ),
        (
            |tool| {
                let RockLaw::DepthOfCut(cut) = &mut tool.rock else {
                    panic!()
                };
                cut.blades = u32::MAX;
            },
            "rock.blades = 4294967295: must be 1 to 1000",
        ),
        (
            // A wave that would arrive within the step that sends it.
            |tool| tool.string.as_mut().unwrap().pieces[1].axial.delay = 1e-4,
            "string.pieces[1].axial.delay = 0.0001 s: must be",
        ),
        (
            // 30 TB of waves under way.
            |tool| tool.string.as_mut().unwrap().pieces[0].torsion.delay = 1e8,
            "time_step = 0.0005 s: must be at least 4.00e2 s",
        ),
    ];
    let whole = below_a_string();
    for (change, expected) in cases {
        let mut tool = whole.clone();
        change(&mut tool);
        let error = run(&tool, &SimulationSettings::default()).expect(expected).to_string();
        assert!(error.contains(expected), "{error}\n{expected}");
    }
}

/// Each error as it reads.
fn mass_on_station(station: usize) -> PointMass {
    PointMass {
        location: Location::Station(station),
        body: Body::Pipe,
        mass: 1.0,
        axial_inertia: 0.0,
        transverse_inertia: 0.0,
        eccentricity: 0.0,
        eccentricity_phase: 0.0,
    }
}

#[test]
fn errors_name_field_value_bound_and_unit() {
    type Change = fn(&mut ToolDescription);
    let cases: [(Change, &str); 16] = [
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
            |t| t.wall_friction_factors.after_arc = -1.0,
            "wall_friction_factors.after_arc = -1: must be finite and at least 0",
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
            |t| t.masses = [165, 166].map(mass_on_station).to_vec(),
            "masses[1].location = Station(166): not on the tool, which has stations 0 to 165 and 32 joints",
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
