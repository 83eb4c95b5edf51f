//! The assembled tangent is the derivative of the assembled residual, for every term: stiffness, damping and mass, with
//! contacts, friction, stops and all joint kinds at work.

use super::interactions::Interactions;
use crate::Instructions;
use crate::chain::Effect;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Tolerances;
use crate::elements::factors::TangentFactors;
use crate::inputs::Inputs;
use crate::model::Model;
use crate::stations::Assembler;
use crate::step::{SolverKind, Stepper, StepperSettings};
use crate::support::{Random, small};
use crate::tool::{
    AddedMass, Body, FreeCurvature, FrictionLaw, JointKind, Location, MudDamping, MudDescription, MudFilm, PointMass,
    PressureDescription, PressureEnd, PressureSource, RockLaw, Shortening, Spine, ToolDescription, Weakening, WobPath,
};

/// A state with every term active: tilts, spins, contacts in both layers, stops, multipliers, axial forces.
/// Deterministic.
fn lively_state(model: &Model) -> State {
    let mut state = State::at_rest(model);
    let mut generator = Random(12345);
    let mut random = || generator.next();
    for i in 0..model.unknowns() {
        state.q[i] = 1e-5 * random();
        state.v[i] = 0.1 * random();
        state.a[i] = 10.0 * random();
    }
    for station in &model.stations {
        for (node, reach) in [
            (station.pipe_above, 0.019),
            (station.pipe_below, 0.019),
            (station.guide, 0.009),
        ] {
            let angle = 3.0 * random();
            state.q[node + 1] = reach * angle.cos();
            state.q[node + 2] = reach * angle.sin();
            state.q[node + 3] = 5.0 * random();
            state.q[node + 4] = 0.05 * random();
            state.q[node + 5] = 0.05 * random();
        }
    }
    state
        .pin_moments
        .iter_mut()
        .for_each(|moment| *moment = 40.0 + 20.0 * random());
    state.pipe_axial.iter_mut().for_each(|n| *n = 1e4 * random());
    state.guide_axial.iter_mut().for_each(|n| *n = 1e4 * random());
    state
}

fn check(tool: &ToolDescription) {
    check_turned(tool, 4e-4);
}

/// With a bit that the step has `turned` (rad).
fn check_turned(tool: &ToolDescription, turned: f64) {
    let settings = StepperSettings {
        time_step: 5e-4,
        scheme: Scheme::newmark(0.6),
        tolerances: Tolerances::default(),
        max_halvings: 0,
        solver: SolverKind::Stations,
        instructions: Instructions::best(),
    };
    let stepper = Stepper::new(tool, &settings).unwrap();
    let model = stepper.model();
    let mut conditions = stepper.conditions(
        0.0,
        &Inputs {
            weight_on_bit: 1e4,
            ..Inputs::ZERO
        },
    );
    conditions.rate_of_penetration = 0.2;
    let state = lively_state(model);
    // A step that began up to 40 um away: some bristles slip, others stick.
    let mut start = state.clone();
    let mut generator = Random(77);
    start
        .q
        .iter_mut()
        .for_each(|x| *x += 4e-5 * generator.next() * generator.next().abs());
    let forces = start.held_friction.iter_mut().flatten().flatten();
    forces.for_each(|force| *force = 300.0 * generator.next());
    let free = |i: usize| !model.held.contains(&i) && model.driven != Some(i) && !model.padding.contains(&i);
    let mut assembler = Assembler::new(model, Instructions::best());
    let mut interactions = Interactions::new(model, Instructions::best());
    interactions.begin(&start, settings.time_step);
    // The bit is 0.3 mm below the bottom: it cuts, and its wear flats bear fully.
    let bit_before = [
        state.q[model.places.end_spin] - turned,
        state.q[model.places.guide_end] - 3e-4,
    ];
    assembler.bit.begin(&start, settings.time_step);
    assembler.bit.start(bit_before);
    assembler.residual(&mut interactions, model, &state, &conditions);
    assert!(interactions.layers.inner.count() > 2, "no inner contact to test");
    assert!(interactions.layers.outer.count() > 2, "no outer contact to test");
    let n = model.unknowns();
    for (name, factors) in [
        (
            "stiffness",
            TangentFactors {
                stiffness: 1.0,
                damping: 0.0,
                mass: 0.0,
            },
        ),
        (
            "damping",
            TangentFactors {
                stiffness: 0.0,
                damping: 1.0,
                mass: 0.0,
            },
        ),
        (
            "mass",
            TangentFactors {
                stiffness: 0.0,
                damping: 0.0,
                mass: 1.0,
            },
        ),
    ] {
        assembler.residual(&mut interactions, model, &state, &conditions);
        assembler.tangent(&interactions, model, &state, &conditions, factors);
        let mut tangent = vec![0.0; n * n];
        assembler
            .system
            .for_each_entry(|row, column, value| tangent[row + column * n] = value);
        for column in (0..n).filter(|&i| free(i)) {
            let multiplier = model.joints.len() * 6 > 0
                && (0..model.joints.len()).any(|j| (model.multipliers(j)..model.multipliers(j) + 6).contains(&column))
                || model.tie == Some(column);
            // Constraint rows and multipliers keep their entries whatever the factors; they are tested with the
            // stiffness.
            if multiplier && name != "stiffness" {
                continue;
            }
            let h = if name == "stiffness" { 1e-8 } else { 1e-5 };
            let residual = |sign: f64| {
                let mut moved = state.clone();
                let step = sign * h;
                moved.q[column] += factors.stiffness * step;
                moved.v[column] += factors.damping * step;
                moved.a[column] += factors.mass * step;
                let mut assembler = Assembler::new(model, Instructions::best());
                let mut interactions = Interactions::new(model, Instructions::best());
                interactions.begin(&start, settings.time_step);
                assembler.bit.begin(&start, settings.time_step);
                assembler.bit.start(bit_before);
                assembler.residual(&mut interactions, model, &moved, &conditions);
                assembler.residual
            };
            let (high, low) = (residual(1.0), residual(-1.0));
            let scale = (0..n).map(|row| tangent[row + column * n].abs()).fold(0.0, f64::max);
            for row in (0..n).filter(|&i| free(i)) {
                let is_row = (0..model.joints.len())
                    .any(|j| (model.multipliers(j)..model.multipliers(j) + 6).contains(&row))
                    || model.tie == Some(row);
                if is_row && name != "stiffness" {
                    continue;
                }
                let difference = (high[row] - low[row]) / (2.0 * h);
                let error = (difference - tangent[row + column * n]).abs();
                // 1e-6 of the column's largest entry, as promised; differences of forces of 1e5 N at steps of 1e-8
                // round to 1e-3 N per unit.
                assert!(
                    error < 1e-6 * scale + 1e-2,
                    "{name}: d R[{row}] / d q[{column}] = {} against {difference}",
                    tangent[row + column * n]
                );
            }
        }
    }
}

#[test]
fn universal_joints() {
    check(&small());
}

#[test]
fn friction_laws() {
    for [inner, outer] in [
        [FrictionLaw::Vector, FrictionLaw::Vector],
        [FrictionLaw::Bristle, FrictionLaw::Bristle],
        [FrictionLaw::Vector, FrictionLaw::Bristle],
    ] {
        let mut tool = small();
        (tool.inner.friction_law, tool.outer.friction_law) = (inner, outer);
        (tool.inner.friction_axial, tool.outer.friction_axial) = (0.1, 0.5);
        check(&tool);
        tool.wall_friction_factors.arc = 1.7;
        check(&tool);
    }
}

/// A bit that sticks, slips ahead, and slips back.
#[test]
fn bits_that_stick() {
    for turned in [4e-4, 2e-2, -2e-2] {
        let mut tool = small();
        tool.rock = RockLaw::Weakening(Weakening { ratio: 1.8, rate: 4.0 });
        check_turned(&tool, turned);
    }
}

#[test]
fn ball_cage_joints() {
    let mut tool = small();
    tool.joint.kind = JointKind::BallCage;
    check(&tool);
}

#[test]
fn friction_in_pins() {
    let mut tool = small();
    tool.joint.friction.coefficient = 0.2;
    check(&tool);
}

#[test]
fn joints_with_play() {
    for kind in [JointKind::Universal, JointKind::BallCage] {
        let mut tool = small();
        tool.joint.kind = kind;
        tool.joint.play.half_angle = 0.05;
        tool.joint.play.stiffness = 1e4;
        check(&tool);
    }
}

#[test]
fn links_that_shorten() {
    let mut tool = small();
    tool.shortening = Shortening::SecondOrder;
    check(&tool);
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Constant(5e6),
        drop_per_metre: 0.05,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    });
    check(&tool);
}

#[test]
fn bodies_on_nodes() {
    let mut tool = small();
    tool.bit.inertia = 0.02;
    let body = |location, body, eccentricity| PointMass {
        location,
        body,
        mass: 8.0,
        axial_inertia: 0.05,
        transverse_inertia: 0.03,
        eccentricity,
        eccentricity_phase: 0.4,
    };
    tool.masses = vec![
        body(Location::Joint(1), Body::Pipe, 0.02),
        body(Location::Station(1), Body::Pipe, 0.01),
        body(Location::Station(4), Body::Guide, 0.03),
    ];
    check(&tool);
}

#[test]
fn a_preloaded_guide() {
    let mut tool = small();
    tool.guide_free_curvature = Some(FreeCurvature {
        curvature: 0.2,
        phase: 0.7,
    });
    check(&tool);
}

/// The tangent of the stations has the geometric stiffness too.
#[test]
fn a_spine_off_the_axis() {
    for phase in [0.0, 0.7] {
        let mut tool = small();
        (tool.guide_bending_factor, tool.guide_spine) = (0.05, Some(Spine { offset: 0.04, phase }));
        check(&tool);
    }
}

/// Some of the slots are closed, some open.
#[test]
fn slots_that_close() {
    for free in [
        None,
        Some(FreeCurvature {
            curvature: 0.2,
            phase: 0.7,
        }),
    ] {
        let mut tool = small();
        (tool.guide_bending_factor, tool.guide_free_curvature) = (0.05, free);
        tool.guide_slots_close_at = Some(0.15);
        check(&tool);
    }
}

#[test]
fn mud_around_the_pipes() {
    let mut tool = small();
    tool.mud = Some(MudDescription {
        density: 1100.0,
        viscosity: 2.0,
        frequency: 4.0,
        added_mass: AddedMass::Concentric,
        damping: MudDamping::Viscous,
        film: MudFilm::None,
    });
    check(&tool);
    if let Some(mud) = &mut tool.mud {
        (mud.added_mass, mud.film, mud.viscosity) = (AddedMass::Eccentric, MudFilm::Squeeze, 0.02);
    }
    check(&tool);
}

#[test]
fn revolute_joints_and_shared_weight() {
    let mut tool = small();
    tool.joint.kind = JointKind::Revolute;
    tool.wob_path = WobPath::Shared;
    check(&tool);
}
