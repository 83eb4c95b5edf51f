//! A guide whose spine lies off its axis: thrust bends it, its energy is in the audit, and one on the axis changes no bit.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::Instructions;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::tool::{
    Body, Direction, LoadHistory, Location, PointLoad, Rayleigh, SectionProperties, Spine, Support, ToolDescription,
    WellSection, WobPath,
};
use flexdrill_core::twin::{Simulation, SimulationSettings};
use support::{coarse, same_bits, simulation, tiny};

/// Without anything that touches or damps.
fn alone(mut tool: ToolDescription) -> ToolDescription {
    (tool.inner.stiffness, tool.outer.stiffness) = (0.0, 0.0);
    tool.rayleigh = Rayleigh { alpha: 0.0, beta: 0.0 };
    tool.gravity = 0.0;
    tool.drive_top = false;
    tool
}

fn load(direction: Direction, history: LoadHistory) -> PointLoad {
    PointLoad {
        location: Location::Bottom,
        body: Body::Guide,
        direction,
        history,
    }
}

/// A guide of 1 m that is built in at its top, with its spine 40 mm off its axis, under a thrust on its axis (N).
fn cantilever(phase: f64, thrust: f64) -> ToolDescription {
    let mut tool = alone(ToolDescription::paper().with_mesh(1, 10));
    tool.well.sections = vec![WellSection::Straight { length: 1.0 }];
    (tool.guide_bending_factor, tool.guide_spine) = (0.05, Some(Spine { offset: 0.04, phase }));
    let all = vec![
        Direction::U,
        Direction::V,
        Direction::W,
        Direction::Psi,
        Direction::PhiY,
        Direction::PhiZ,
    ];
    tool.supports = [Body::Pipe, Body::Guide]
        .map(|body| Support {
            location: Location::Top,
            body,
            directions: all.clone(),
        })
        .to_vec();
    tool.wob_path = WobPath::Guide;
    tool.loads = vec![load(Direction::U, LoadHistory::Constant(-thrust))];
    tool
}

/// A thrust C on the axis bends the cantilever by e C / EI; with what the thrust does on the deflected guide, k^2 = C / EI,
/// its end has e (1 / cos k L - 1) across and e k tan k L of slope, towards the side opposite to the spine. By the chain and
/// station by station. Tolerance 1e-5: ten cubic elements have (k L / 10)^4 / 720 of k, 2e-6 of these at 10 kN; the balance
/// at rest leaves 10 mN of them.
#[test]
fn thrust_bends_a_guide_away_from_its_spine() {
    let length = 1.0;
    for solver in [SolverKind::Chain, SolverKind::Stations] {
        for (phase, thrust) in [(0.0, 100.0), (0.0, 1e4), (std::f64::consts::FRAC_PI_2, 1e4), (2.5, 1e4)] {
            let tool = cantilever(phase, thrust);
            let section = SectionProperties::of(tool.guide_section, tool.material, tool.guide_bending_factor);
            let settings = SimulationSettings::default().with(|settings| settings.initial_inputs = Inputs::ZERO);
            let simulation = Simulation::with_solver(&tool, &settings, solver, Instructions::best()).unwrap();
            let end = |direction| {
                simulation
                    .displacement(simulation.last_station(), Body::Guide, direction)
                    .unwrap()
            };
            let k = (thrust / section.bending).sqrt();
            let across = 0.04 * (1.0 / (k * length).cos() - 1.0);
            let slope = 0.04 * k * (k * length).tan();
            let row = |what: &str, expected: f64, got: f64, scale: f64| {
                println!("{solver:?}, {phase:.1} rad, {thrust} N: {what} {got:e} for {expected:e}");
                assert!(
                    (got - expected).abs() < 1e-5 * scale,
                    "{what}: {got:e} for {expected:e}"
                );
            };
            // phi_y turns to the high side, which is -w.
            row("w (m)", -across * phase.cos(), end(Direction::W), across);
            row("v (m)", across * phase.sin(), end(Direction::V), across);
            row("phi_y", slope * phase.cos(), end(Direction::PhiY), slope);
            row("phi_z", slope * phase.sin(), end(Direction::PhiZ), slope);
            // The axis is as much shorter as the spine turns.
            let shorter = thrust * length / section.axial + 0.04 * slope;
            row("u (m)", -shorter, end(Direction::U), shorter);
        }
    }
}

/// Loads that bend and turn a guide in an arc, in the plane and out of it, and let it go: its energy is all that they have
/// put into it and what the scheme damps, while it swings and stretches.
#[test]
fn a_guide_that_swings_freely_keeps_its_energy() {
    for phase in [0.0, 0.7] {
        let mut tool = alone(tiny());
        (tool.guide_bending_factor, tool.guide_spine) = (0.05, Some(Spine { offset: 0.04, phase }));
        tool.supports.push(Support {
            location: Location::Top,
            body: Body::Guide,
            directions: vec![Direction::Psi],
        });
        let pulse = |size: f64| LoadHistory::Table(vec![(0.0, 0.0), (0.02, size), (0.04, 0.0)]);
        let middle = |direction, size| PointLoad {
            location: Location::Station(1),
            ..load(direction, pulse(size))
        };
        tool.loads = vec![
            load(Direction::U, pulse(-2e4)),
            middle(Direction::V, 2e4),
            middle(Direction::Psi, 200.0),
        ];
        let mut simulation = simulation(&tool);
        let mut gone = None;
        while simulation.time() < 0.15 {
            simulation.advance(&Inputs::ZERO).ok().unwrap();
            if simulation.time() > 0.05 && gone.is_none() {
                gone = Some(*simulation.energy());
            }
        }
        let (gone, audit) = (gone.unwrap(), *simulation.energy());
        println!("{phase}: {audit:?}");
        assert!(audit.loads > 2e-3, "{audit:?}");
        assert!(
            (audit.loads - gone.loads).abs() < 1e-9 * audit.loads,
            "the loads have not ended"
        );
        // Newton leaves up to 1 N of the 20 kN: 5e-5, and as much again for both directions and the turn.
        assert!(audit.error.abs() < 5e-4 * audit.loads, "{audit:?}");
    }
}

/// With all that is in the paper's tool: contacts of both layers, friction, stops.
#[test]
fn a_spine_on_the_axis_changes_no_bit() {
    let run = |spine: Option<Spine>| {
        let tool = coarse().with(|tool| (tool.guide_bending_factor, tool.guide_spine) = (0.05, spine));
        let mut simulation = simulation(&tool);
        let inputs = Inputs {
            rotary_speed: 4.0,
            weight_on_bit: 1e4,
            ..Inputs::ZERO
        };
        for _ in 0..200 {
            simulation.advance(&inputs).ok().unwrap();
        }
        let mut snapshot = simulation.new_snapshot();
        simulation.snapshot(&mut snapshot, false);
        snapshot
    };
    let none = run(None);
    let on_axis = Spine {
        offset: 0.0,
        phase: 0.0,
    };
    assert!(same_bits(&none, &run(Some(on_axis))));
    let off_axis = Spine {
        offset: 0.01,
        phase: 0.0,
    };
    assert!(!same_bits(&none, &run(Some(off_axis))));
}
