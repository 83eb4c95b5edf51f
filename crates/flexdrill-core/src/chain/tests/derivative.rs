//! The tangent against the difference quotient of the residual.

use super::*;

/// The linear system that steps solve is the derivative of the residual that they judge by: the solution for a random
/// right-hand side brings the residual's difference quotient back to it.
fn check_derivative(tool: &ToolDescription) {
    check_turned(tool, 4e-4);
}

/// With a bit that the step has `turned` (rad).
fn check_turned(tool: &ToolDescription, turned: f64) {
    let model = Model::new(tool).unwrap();
    let chain = Chain::of(
        &model,
        &Tolerances::default(),
        5e-4,
        &acting(&model),
        Instructions::best(),
    );
    // No axial force: the tangent of steps leaves geometric stiffness out.
    check_chain(tool, &model, chain, 0.0, turned);
}

/// Over `chain`, with axial forces up to `axial` (N).
fn check_chain(tool: &ToolDescription, model: &Model, mut chain: Chain, axial: f64, turned: f64) {
    let factors = Scheme::newmark(0.6).factors(5e-4);
    let mut conditions = Conditions::new(tool, &LiveParameters::of(tool), 0.0, 1e4);
    conditions.rate_of_penetration = 0.2;
    let instructions = Instructions::best();
    let mut state = lively(&chain, model, 21);
    clean(&chain, &mut state);
    let mut tension = 31;
    for force in state.pipe_axial.iter_mut().chain(&mut state.guide_axial) {
        *force = axial * random(&mut tension);
    }
    let mut room = Room::new(model, &chain, instructions);
    let start = before(&chain, &state, 22);
    let bit_before = bit_before(&chain, &state, turned);
    room.begin(&start, 5e-4, bit_before);
    equations(model, &mut chain, &mut room).evaluate(&mut state, &conditions, true);
    assert!(room.layers().inner.count() > 2, "no inner contact to test");
    assert!(
        tool.guide_fixed || room.layers().outer.count() > 2,
        "no outer contact to test"
    );
    let mut seed = 7;
    let mut wanted: Vec<f64> = chain
        .limits
        .weights(Accuracy::Rest)
        .iter()
        .map(|weight| if *weight > 0.0 { random(&mut seed) } else { 0.0 })
        .collect();
    // The moments on rotations that follow from others are in balance whatever happens.
    for (k, dependents) in chain.dependents.iter().enumerate() {
        let slots = dependents.iter().map(|dependent| dependent.slot);
        slots
            .filter(|&slot| slot != FIRST_ROW)
            .for_each(|slot| wanted[NODE * k + slot] = 0.0);
    }
    chain.residual.copy_from_slice(&wanted);
    chain.prepare(model, &conditions, factors);
    equations(model, &mut chain, &mut room)
        .solve_in_double(&state, &Iteration::first(&conditions, factors))
        .unwrap();
    let solution = chain.correction.clone();
    // The largest displacement moves by 1e-9 m: contact and stop laws are far from their ends, and forces of 1e6 N round
    // to 1e-10 of them.
    let by = 1e-9 / solution.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut residual = |by: f64| {
        let mut moved = state.clone();
        chain
            .correction
            .iter_mut()
            .zip(&solution)
            .for_each(|(to, x)| *to = by * x);
        // New room each time, as the laws learn of friction from one correction to the next.
        let mut room = Room::new(model, &chain, instructions);
        room.begin(&start, 5e-4, bit_before);
        let mut newton = equations(model, &mut chain, &mut room);
        correct(&newton, &mut moved, factors);
        newton.evaluate(&mut moved, &conditions, true);
        chain.residual.clone()
    };
    let (high, low) = (residual(by), residual(-by));
    let rounding = 1e6 * f64::EPSILON / by;
    assert!(10.0 * rounding < 0.05, "the quotient must tell something");
    for (unknown, wanted) in wanted.iter().enumerate() {
        if chain.limits.weights(Accuracy::Rest)[unknown] > 0.0 {
            let difference = (high[unknown] - low[unknown]) / (2.0 * by);
            // The right-hand side is of order one; what the quotient rounds to is that of forces of 1e6 N over the step.
            assert!(
                (difference + wanted).abs() < 1e-4 + 10.0 * rounding,
                "row {unknown}: {difference} against {}, rounding {rounding:e}",
                -wanted
            );
        }
    }
}

/// With up to 200 kN: without geometric stiffness a row is then off by 4e-3, forty times what the quotient may be.
#[test]
fn the_tangent_over_all_stations_has_the_geometric_stiffness() {
    let mut tied = small(6, 2);
    tied.wob_path = WobPath::Shared;
    let mut soft = small(6, 2);
    soft.guide_bending_factor = 0.05;
    let [low, high, aside] = with_spine(&small(6, 2));
    for tool in [small(6, 2), with_shortening(small(6, 2)), tied, soft, low, high, aside] {
        let model = Model::new(&tool).unwrap();
        let chain = Chain::over_stations(&model, &Tolerances::default(), &acting(&model), Instructions::best());
        check_chain(&tool, &model, chain, 2e5, 4e-4);
    }
}

#[test]
fn the_tangent_is_the_derivative_of_the_residual() {
    for kind in [JointKind::Universal, JointKind::BallCage, JointKind::Revolute] {
        let mut tool = small(6, 3);
        tool.joint.kind = kind;
        check_derivative(&tool);
        tool.guide_fixed = true;
        check_derivative(&tool);
    }
    check_derivative(&with_pin_friction(small(6, 3)));
    check_derivative(&with_play(small(6, 3)));
    check_derivative(&with_play(with_pin_friction(small(6, 3))));
    for [inner, outer] in FRICTION {
        check_derivative(&with_friction(small(6, 3), inner, outer));
        check_derivative(&with_intervals(with_friction(small(6, 3), inner, outer)));
    }
    check_derivative(&with_shortening(small(6, 3)));
    for tool in with_slots(&small(6, 3)) {
        check_derivative(&tool);
    }
    for tool in with_spine(&small(6, 3)) {
        check_derivative(&tool);
    }
    for rock in ROCKS {
        let mut tool = small(6, 3);
        tool.rock = rock;
        // It sticks, slips ahead, and slips back.
        for turned in [4e-4, 2e-2, -2e-2] {
            check_turned(&tool, turned);
        }
    }
    check_derivative(&with_mud(small(6, 3)));
    check_derivative(&with_mud_near_walls(small(6, 3)));
    let mut tool = small(6, 3);
    tool.guide_free_curvature = Some(FreeCurvature {
        curvature: 0.2,
        phase: 0.7,
    });
    tool.bit.inertia = 0.02;
    tool.wob_path = WobPath::Shared;
    tool.masses = vec![
        mass(Location::Joint(1), Body::Pipe),
        mass(Location::Station(1), Body::Pipe),
        mass(Location::Station(4), Body::Guide),
    ];
    check_derivative(&tool);
}
