//! The linear system that runs in motion (step-constant part condensed, increment added) is the derivative of the
//! residual: solved for a random right-hand side, its solution brings the residual's difference quotient back to that
//! right-hand side.

use crate::dynamics::assembly::Assembler;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::stepper::{SolverKind, Stepper};
use crate::dynamics::tolerances::Tolerances;
use crate::linear::{CondensedElimination, CondensedSystem};
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::{Body, JointKind, Location, PointMass, ToolDescription, WobPath};

/// Deterministic values in -1..1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
}

/// Tilts, spins, contacts of both layers inside spans and at joints, stops, multipliers; no axial force, whose
/// geometric stiffness the tangent of motion leaves out.
fn lively(model: &Model) -> State {
    let mut seed = 2024;
    let mut state = State::at_rest(model);
    for i in 0..model.unknowns() {
        state.q[i] = 1e-5 * random(&mut seed);
        state.v[i] = 0.1 * random(&mut seed);
        state.a[i] = 10.0 * random(&mut seed);
    }
    for (s, station) in model.stations.iter().enumerate() {
        let nodes = [
            (station.pipe_above, 0.019),
            (station.pipe_below, 0.019),
            (station.guide, 0.009),
        ];
        for (node, reach) in nodes {
            // Every third station only, so that some spans have no contact inside.
            let reach = if s % 3 == 0 { reach } else { 1e-4 };
            let angle = 3.0 * random(&mut seed);
            state.q[node + 1] = reach * angle.cos();
            state.q[node + 2] = reach * angle.sin();
            state.q[node + 3] = 5.0 * random(&mut seed);
            state.q[node + 4] = 0.05 * random(&mut seed);
            state.q[node + 5] = 0.05 * random(&mut seed);
        }
    }
    state
}

fn check(tool: &ToolDescription) {
    let (scheme, instructions) = (Scheme::newmark(0.6), Instructions::best());
    let solver = SolverKind::default();
    let stepper = Stepper::new(tool, scheme, Tolerances::default(), 0, solver, instructions).unwrap();
    let model = stepper.model();
    let mut conditions = stepper.conditions(0.0, 1e4);
    conditions.bit_torque = 90.0;
    let factors = scheme.factors(5e-4);
    let state = lively(model);

    let mut assembler = Assembler::new(model, instructions);
    let step_constant = assembler.step_constant(model, &conditions, factors);
    let system = CondensedSystem::of(step_constant, &model.joint_stations).expect("joints that can be condensed");
    assembler.residual(model, &state, &conditions);
    assert!(assembler.inner.count() > 2, "no inner contact to test");
    assert!(assembler.outer.count() > 2, "no outer contact to test");
    assert!(assembler.stops().any(|stop| stop.moment > 0.0), "no shut stop to test");
    assembler.linearise(model, &state, &conditions, factors);

    let mut seed = 7;
    let mut rhs: Vec<f64> = (0..model.unknowns()).map(|_| random(&mut seed)).collect();
    for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
        rhs[unknown] = 0.0;
    }
    let mut x = rhs.clone();
    let mut elimination = CondensedElimination::new(&model.layout, &model.joint_stations, instructions);
    elimination.solve(&system, &assembler.increment, &mut x).unwrap();

    // As a Newton correction moves the state: velocities and accelerations of everything but the multipliers follow.
    let multiplier = |unknown: usize| {
        (0..model.joints.len()).any(|j| (model.multipliers(j)..model.multipliers(j) + 6).contains(&unknown))
            || model.tie == Some(unknown)
    };
    let residual = |by: f64| {
        let mut moved = state.clone();
        for (unknown, &x) in x.iter().enumerate() {
            moved.q[unknown] += by * x;
            if !multiplier(unknown) {
                moved.v[unknown] += by * factors.damping * x;
                moved.a[unknown] += by * factors.mass * x;
            }
        }
        let mut assembler = Assembler::new(model, instructions);
        assembler.residual(model, &moved, &conditions);
        assembler.drop_reactions(model);
        assembler.residual
    };
    // The largest displacement moves by 1e-9 m: contact and stop laws are far from their ends, and forces of 1e6 N
    // round to 1e-10 of them.
    let by = 1e-9
        / x.iter()
            .enumerate()
            .filter(|&(i, _)| !multiplier(i))
            .fold(0.0_f64, |m, (_, x)| m.max(x.abs()));
    let (high, low) = (residual(by), residual(-by));
    for (unknown, rhs) in rhs.iter().enumerate() {
        let difference = (high[unknown] - low[unknown]) / (2.0 * by);
        // The right-hand side is of order one; what the quotient rounds to is that of forces of 1e6 N over the step
        // taken.
        let rounding = 1e6 * f64::EPSILON / by;
        assert!(
            (difference - rhs).abs() < 1e-4 + 10.0 * rounding,
            "row {unknown}: {difference} against {rhs}, rounding {rounding:e}"
        );
    }
    assert!(
        10.0 * 1e6 * f64::EPSILON / by < 0.05,
        "the quotient must tell something"
    );
}

fn small() -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(6, 3);
    // Six links build 15 degrees each; a wide limit leaves some of the stops shut and some open.
    tool.joint.limit = 0.26;
    tool
}

#[test]
fn universal_joints() {
    check(&small());
}

#[test]
fn ball_cages() {
    let mut tool = small();
    tool.joint.kind = JointKind::BallCage;
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
fn tied_ends() {
    let mut tool = small();
    tool.wob_path = WobPath::Shared;
    check(&tool);
}
