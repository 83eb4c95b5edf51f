//! Hole as drilled is a hole like any other: where its points are those of an arc or of a straight section, the tool rests
//! and moves in it as in that, and a hole that drops is one that builds, mirrored.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{
    Body, Direction, FreeCurvature, HoleInterval, ToolDescription, WallFrictionFactors, WellSection,
};
use flexdrill_core::twin::{Simulation, SimulationSettings};

const RADIUS: f64 = 3.2;
/// Length of a point as drilled (m).
const SPACING: f64 = 0.02;

fn straight(length: f64) -> WellSection {
    WellSection::Straight { length }
}

fn arc(radius: f64, length: f64) -> WellSection {
    WellSection::Arc {
        radius,
        angle: length / radius,
    }
}

/// Some points of one curvature.
fn drilled(curvature: f64, length: f64, interval: HoleInterval) -> WellSection {
    let points = (length / SPACING).round();
    WellSection::Drilled {
        spacing: length / points,
        build: vec![curvature; points as usize],
        interval,
    }
}

/// The paper's tool, two elements per link, at rest or turning under weight, with other friction in the arc.
fn tool(sections: Vec<WellSection>) -> ToolDescription {
    support::coarse().with(|tool| {
        tool.well.sections = sections;
        tool.static_start = true;
        tool.wall_friction_factors = WallFrictionFactors {
            before_arc: 0.5,
            arc: 1.0,
            after_arc: 1.5,
        };
    })
}

/// Displacements at rest and after `steps` steps at 60 r/min under 10 kN, with the largest of all forces of the walls (N).
fn motion(tool: &ToolDescription, steps: u32) -> [Vec<f64>; 2] {
    let inputs = Inputs {
        rotary_speed: std::f64::consts::TAU,
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    let settings = SimulationSettings::default().with(|settings| settings.initial_inputs = inputs);
    let mut simulation = Simulation::new(tool, &settings).unwrap();
    let rest = simulation.state().q.clone();
    for _ in 0..steps {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
    }
    [rest, simulation.state().q.clone()]
}

/// Rounding of a path's points is some 1e-15 m, and of a wall's force 2e7 N/m times that. Newton's iteration ends at 1e-9 of
/// the loads, and the displacements of micrometres and milliradians that result are alike within 1e-9; a run of 100 steps
/// of contacts amplifies it.
fn alike(what: &str, one: &ToolDescription, other: &ToolDescription) {
    let (one, other) = (motion(one, 100), motion(other, 100));
    for (when, (one, other), tolerance) in [
        ("at rest", (&one[0], &other[0]), 1e-9),
        ("in motion", (&one[1], &other[1]), 1e-7),
    ] {
        let largest = one.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
        let off = one
            .iter()
            .zip(other)
            .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        println!("{what}, {when}: {off:e} of {largest:e}");
        assert!(largest > 1e-4, "{what}, {when}: the tool does not move");
        assert!(off <= tolerance, "{what}, {when}: {off:e} off, of {largest:e}");
    }
}

#[test]
fn a_tool_in_a_drilled_arc_is_one_in_the_arc() {
    let length = 1.2 * RADIUS;
    let arc = tool(vec![straight(1.0), arc(RADIUS, length), straight(0.5)]);
    let same = |interval| {
        tool(vec![
            straight(1.0),
            drilled(1.0 / RADIUS, length, interval),
            straight(0.5),
        ])
    };
    alike("arc", &arc, &same(HoleInterval::Arc));
    // Its interval counts.
    let (other, arc) = (motion(&same(HoleInterval::AfterArc), 100), motion(&arc, 100));
    assert!(arc[1].iter().zip(&other[1]).any(|(a, b)| (a - b).abs() > 1e-7));
}

#[test]
fn a_tool_in_arcs_and_straight_hole_as_drilled_is_one_in_these_sections() {
    let sections = vec![straight(1.0), arc(3.0, 1.5), straight(0.4), arc(4.0, 2.0)];
    let as_drilled = vec![
        drilled(0.0, 1.0, HoleInterval::BeforeArc),
        drilled(1.0 / 3.0, 1.5, HoleInterval::Arc),
        drilled(0.0, 0.4, HoleInterval::AfterArc),
        drilled(0.25, 2.0, HoleInterval::Arc),
    ];
    alike("all sections", &tool(sections.clone()), &tool(as_drilled));
    // Two curvatures within one section, as a hole that is appended to has them.
    let WellSection::Drilled {
        spacing,
        mut build,
        interval,
    } = drilled(1.0 / 3.0, 1.5, HoleInterval::Arc)
    else {
        unreachable!()
    };
    build.extend(std::iter::repeat_n(0.25, (2.0 / spacing).round() as usize));
    let one = WellSection::Drilled {
        spacing,
        build,
        interval,
    };
    let two = vec![straight(1.0), arc(3.0, 1.5), arc(4.0, 2.0)];
    alike("one section", &tool(two), &tool(vec![straight(1.0), one]));
}

/// Without gravity nothing knows up from down: a straight guide in a hole that drops presses on the other side of the wall, as
/// far as it does in one that builds.
#[test]
fn a_hole_that_drops_is_one_that_builds_mirrored() {
    let in_hole = |curvature| {
        let mut tool = tool(vec![drilled(curvature, 4.0, HoleInterval::Arc)]);
        tool.gravity = 0.0;
        tool.well.start_inclination = std::f64::consts::FRAC_PI_2 - 2.0 * curvature;
        tool.guide_bending_factor = 0.05;
        tool.guide_free_curvature = Some(FreeCurvature {
            curvature: 0.0,
            phase: 0.0,
        });
        let simulation = support::simulation(&tool);
        let of = |station: usize| {
            [Direction::U, Direction::W, Direction::PhiY]
                .map(|direction| simulation.displacement(station, Body::Guide, direction).unwrap())
        };
        (0..=simulation.last_station()).map(of).collect::<Vec<_>>()
    };
    let (builds, drops) = (in_hole(0.2), in_hole(-0.2));
    let most = builds.iter().fold(0.0_f64, |most, [_, w, _]| most.max(w.abs()));
    // The gap of the guide is 8 mm, and the guide lies on the wall.
    assert!(most > 5e-3, "{most}");
    for ([u, w, tilt], [other_u, other_w, other_tilt]) in builds.into_iter().zip(drops) {
        // Newton's iteration ends at 1e-9 of the loads.
        assert!((u - other_u).abs() < 1e-8 && (w + other_w).abs() < 1e-8 && (tilt + other_tilt).abs() < 1e-8);
    }
}

/// The length of hole is the sum of the given rate over all steps with weight, also over those of other intervals. A motion
/// that begins again begins a hole.
#[test]
fn the_bit_makes_as_much_hole_as_the_rate_says() {
    let mut simulation = support::simulation(&support::tiny());
    let mut snapshot = simulation.new_snapshot();
    let dt = simulation.settings().time_step;
    let mut inputs = Inputs {
        rotary_speed: 2.0,
        weight_on_bit: 5e3,
        rate_of_penetration: 0.01,
        ..Inputs::default()
    };
    let (mut expected, mut before) = (0.0, 0.0);
    for step in 0..2000 {
        // Lifted for the second half of a second.
        inputs.weight_on_bit = if step < 1000 { 5e3 } else { 0.0 };
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        let applied = simulation.applied();
        if applied.weight_on_bit > 0.0 {
            expected += applied.rate_of_penetration * dt;
        }
        if step % 150 == 0 {
            simulation.snapshot(&mut snapshot, true);
            assert!(snapshot.steering.drilled >= before);
            before = snapshot.steering.drilled;
        }
    }
    simulation.snapshot(&mut snapshot, true);
    // Sums of 2000 terms of micrometres round to 1e-15 m.
    assert!(
        expected > 1e-4 && (snapshot.steering.drilled - expected).abs() < 1e-12,
        "{snapshot:?}"
    );
    simulation.reset();
    simulation.snapshot(&mut snapshot, true);
    assert!(snapshot.steering.drilled == 0.0);
}
