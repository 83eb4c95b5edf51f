//! Residual, tangent and solution against those over all stations, multipliers among the unknowns.

use super::*;
use crate::stations::{add_shortening_tangent, add_slots_tangent};

/// Over the fewest nodes there can be, and over those that steps of this size need.
fn check(tool: &ToolDescription, h: f64, seed: u64) {
    for nodes_for in [1.0, h] {
        check_over(tool, (h, nodes_for), seed, 4e-4);
    }
}

/// States tried until one touches inside a span.
const TRIES: u64 = 20;

/// With a bit that the step has `turned` (rad), in the first state from `seed` on that touches inside spans.
fn check_over(tool: &ToolDescription, nodes: (f64, f64), seed: u64, turned: f64) {
    let touches = (0..TRIES).any(|more| check_state(tool, nodes, seed + 1000 * more, turned));
    assert!(touches, "no contact inside spans");
}

/// In one state; `false` without a comparison where it does not touch inside spans.
fn check_state(tool: &ToolDescription, (h, nodes_for): (f64, f64), seed: u64, turned: f64) -> bool {
    let model = Model::new(tool).unwrap();
    let scheme = Scheme::generalised_alpha(0.45);
    let factors = scheme.factors(h);
    let mut conditions = Conditions::new(tool, &LiveParameters::of(tool), 0.3, 1e4);
    conditions.rate_of_penetration = 0.2;
    conditions.standpipe_pressure = 5e6;
    for instructions in Instructions::available() {
        let mut chain = Chain::of(&model, &Tolerances::default(), nodes_for, &acting(&model), instructions);
        let slaving = slaving(&chain, &model);
        let mut state = lively(&chain, &model, seed);
        clean(&chain, &mut state);
        // Each span has a different axial force.
        let mut next = seed + 9;
        for l in 0..chain.spans() {
            (state.pipe_axial[l], state.guide_axial[l]) = (2e3 * random(&mut next), 2e3 * random(&mut next));
        }

        let mut room = Room::new(&model, &chain, instructions);
        let start = before(&chain, &state, seed);
        let bit_before = bit_before(&chain, &state, turned);
        room.begin(&start, h, bit_before);
        equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, true);
        let mut full = State::at_rest(&model);
        let forces = JointForces {
            multipliers: chain.multipliers.clone(),
            ..no_forces(&chain)
        };
        chain.show(&model, &state, &forces, &mut full);
        let mut whole = Assembler::new(&model, instructions);
        let mut at_stations = Interactions::new(&model, instructions);
        let mut full_start = State::at_rest(&model);
        chain.show(&model, &start, &forces, &mut full_start);
        at_stations.begin(&full_start, h);
        whole.bit.begin(&full_start, h);
        whole.bit.start(bit_before);
        whole.residual(&mut at_stations, &model, &full, &conditions);
        let inside = |layer: &LayerContacts| {
            layer
                .iter()
                .filter(|(station, _)| model.stations[*station].joint.is_none())
                .count()
        };
        let touches = inside(&room.layers().inner) > 0 && (tool.guide_fixed || inside(&room.layers().outer) > 0);
        if tool.elements_per_link > 1 && !touches {
            return false;
        }
        assert!(
            model.joints.is_empty()
                || tool.joint.kind == JointKind::Revolute
                || room.joints.stops().any(|stop| stop.moment > 0.0),
            "no shut stop"
        );

        // Residual: the whole tool's through the slaving. The multipliers that follow from the dependent rotations balance
        // those; their places hold the rows.
        let n = chain.unknowns();
        let mut expected = slaving.tr_mul(&DVector::from_column_slice(&whole.residual));
        let rows = Joint::constraints(&tool.joint);
        let mut right = -expected.clone();
        let scale = whole.residual.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let near = |got: f64, expected: f64, what: &str| {
            // Rounding of stiffness times displacement, which cancel to the residual.
            let apart = (got - expected).abs();
            assert!(
                apart < 1e-9 * scale,
                "{instructions}: {what} is {got} against {expected}, scale {scale:e}"
            );
        };
        for (joint, node) in chain.model.nodes.of_joints.iter().enumerate() {
            for dependent in chain.dependents[*node].iter() {
                near(
                    0.0,
                    expected[NODE * node + dependent.slot],
                    "moment on a dependent rotation",
                );
                expected[NODE * node + dependent.slot] = 0.0;
            }
            for (row, place) in [FIRST_ROW, SECOND_ROW].into_iter().enumerate().take(rows) {
                expected[NODE * node + place] = expected[n + rows * joint + row];
            }
        }
        for (unknown, got) in chain.residual.iter().enumerate() {
            if chain.limits.weights(Accuracy::Rest)[unknown] > 0.0 {
                near(*got, expected[unknown], &format!("residual {unknown}"));
            }
        }

        // Tangent without geometric stiffness, and its solution.
        let mut system = whole.step_constant(&model, &conditions, factors);
        if crate::effects::shortening::is_on(&model) {
            add_shortening_tangent(&mut system, &model, &full, &conditions, factors);
        }
        add_slots_tangent(&mut system, &model, &full, factors);
        whole.linearise(&at_stations, &model, &full, &conditions, factors);
        whole.increment.add_to(&mut system);
        let mut matrix = DMatrix::zeros(model.unknowns(), model.unknowns());
        system.for_each_entry(|row, column, value| matrix[(row, column)] += value);
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            matrix[(unknown, unknown)] = 0.0;
        }
        let mut matrix = slaving.tr_mul(&(matrix * &slaving));
        for (unknown, weight) in chain.limits.weights(Accuracy::Rest).iter().enumerate() {
            if *weight == 0.0 || matrix.column(unknown).amax() == 0.0 {
                matrix.row_mut(unknown).fill(0.0);
                matrix.column_mut(unknown).fill(0.0);
                matrix[(unknown, unknown)] = 1.0;
                right[unknown] = 0.0;
            }
        }
        // By rows and columns of like size, as their units differ.
        let size = |i: usize| 1.0 / matrix.column(i).norm().max(f64::MIN_POSITIVE).sqrt();
        let sizes = DVector::from_fn(matrix.nrows(), |i, _| size(i));
        let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            sizes[i] * matrix[(i, j)] * sizes[j]
        });
        let right = right.component_mul(&sizes);
        let x = scaled.full_piv_lu().solve(&right).unwrap().component_mul(&sizes);
        assert!(x.iter().all(|x| x.is_finite()), "a tangent without an inverse");
        chain.prepare(&model, &conditions, factors);
        for (single, within) in [(false, 1e-9), (true, 1e-3)] {
            if single {
                let solved = equations(&model, &mut chain, &mut room)
                    .solve_in_single(&state, &Iteration::first(&conditions, factors));
                assert!(solved, "single precision was refused");
            } else {
                equations(&model, &mut chain, &mut room)
                    .solve_in_double(&state, &Iteration::first(&conditions, factors))
                    .unwrap();
            }
            let got = DVector::from_column_slice(&chain.correction);
            for (k, node) in chain.model.nodes.list.iter().enumerate() {
                if node.joint.is_none() {
                    let first = NODE * k;
                    assert_eq!(got.rows(first, 3), got.rows(first + 6, 3), "node {k} is in one piece");
                }
            }
            let one_piece = |i: usize| chain.model.nodes.list[i / NODE].joint.is_none() && (6..9).contains(&(i % NODE));
            let got = DVector::from_fn(n, |i, _| if one_piece(i) { 0.0 } else { got[i] });
            let (expected, sizes) = (x.rows(0, n).clone_owned(), sizes.rows(0, n).clone_owned());
            // In the units that make the matrix of one size.
            let [got, expected] = [&got, &expected].map(|x| x.component_div(&sizes));
            let apart = (&got - &expected).amax() / expected.amax();
            assert!(
                apart < within,
                "{instructions}, single {single}: solutions {apart:e} apart"
            );
        }
    }
    true
}

#[test]
fn default_tools() {
    for (elements, seed) in [(1, 3), (2, 5), (3, 7), (5, 11), (8, 2)] {
        check(&small(6, elements), 5e-4, seed);
        check(&with_soft_contacts(small(6, elements)), 5e-4, seed);
    }
    check(&small(4, 5), 5e-4 / 64.0, 1);
}

#[test]
fn friction_laws() {
    for [inner, outer] in FRICTION {
        check(&with_friction(small(6, 3), inner, outer), 5e-4, 7);
        check(&with_intervals(with_friction(small(6, 3), inner, outer)), 5e-4, 7);
    }
}

#[test]
fn ball_cages_and_a_tie() {
    let mut tool = small(5, 3);
    tool.joint.kind = JointKind::BallCage;
    tool.wob_path = WobPath::Shared;
    check(&tool, 5e-4, 4);
}

#[test]
fn friction_in_pins_and_play() {
    for (elements, seed) in [(1, 3), (3, 7)] {
        check(&with_pin_friction(small(6, elements)), 5e-4, seed);
        check(&with_play(small(6, elements)), 5e-4, seed);
    }
    let mut tool = with_play(small(5, 3));
    tool.joint.kind = JointKind::BallCage;
    tool.wob_path = WobPath::Shared;
    check(&tool, 5e-4, 4);
    // More than eight joints, which are evaluated in two groups.
    let mut tool = with_play(with_pin_friction(small(12, 3)));
    tool.joint.limit = 0.13;
    check(&tool, 5e-4, 24);
}

/// With one element per link: within longer spans the axial force is made even, which over all stations it becomes by
/// their motion along the link.
#[test]
fn links_that_shorten() {
    check(&with_shortening(small(6, 1)), 5e-4, 3);
    let mut tool = with_shortening(small(5, 1));
    tool.wob_path = WobPath::Shared;
    check(&tool, 5e-4, 4);
    // Under the standpipe's pressure, which falls along the tool.
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Standpipe,
        drop_per_metre: 0.05,
        end: PressureEnd::Held,
        joint_seal_diameter: 0.062,
    });
    check(&tool, 5e-4, 4);
}

/// A bit that sticks, slips ahead, and slips back.
#[test]
fn bits_that_stick() {
    for rock in ROCKS {
        let mut tool = small(5, 3);
        tool.rock = rock;
        for turned in [4e-4, 2e-2, -2e-2] {
            check_over(&tool, (5e-4, 5e-4), 7, turned);
        }
    }
}

#[test]
fn masses_loads_and_supports_at_nodes() {
    let mut tool = small(5, 3);
    tool.bit.inertia = 0.02;
    tool.masses = vec![
        mass(Location::Joint(1), Body::Pipe),
        mass(Location::Joint(2), Body::Guide),
    ];
    tool.loads = vec![
        load(Location::Joint(0), Body::Pipe),
        load(Location::Joint(3), Body::Guide),
    ];
    tool.supports.push(Support {
        location: Location::Joint(2),
        body: Body::Guide,
        directions: vec![Direction::W, Direction::PhiY],
    });
    check(&tool, 5e-4, 6);
}

/// What is attached inside links, a fixed guide, long links: there are nodes there, and no other equations.
#[test]
fn masses_loads_and_supports_inside_links() {
    let mut tool = small(4, 4);
    tool.masses = vec![
        mass(Location::Station(1), Body::Pipe),
        mass(Location::Station(6), Body::Guide),
    ];
    tool.loads = vec![
        load(Location::Station(3), Body::Guide),
        load(Location::Station(10), Body::Pipe),
    ];
    tool.supports.push(Support {
        location: Location::Station(11),
        body: Body::Pipe,
        directions: vec![Direction::V, Direction::PhiZ],
    });
    tool.supports.push(Support {
        location: Location::Joint(1),
        body: Body::Pipe,
        directions: vec![Direction::V],
    });
    check(&tool, 5e-4, 12);
}

#[test]
fn fixed_guides() {
    let mut tool = small(5, 4);
    tool.guide_fixed = true;
    check(&tool, 5e-4, 13);
}

/// A pipe of two bores under the standpipe's pressure, its end in a seal, and tied.
#[test]
fn pressure_in_the_pipe() {
    let mut tool = small(5, 4);
    tool.pipe_sections[2].inner_diameter = 0.020;
    let mut pressure = PressureDescription {
        at_top: PressureSource::Standpipe,
        drop_per_metre: 0.05,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    };
    tool.pressure = Some(pressure);
    check(&tool, 5e-4, 22);
    pressure.end = PressureEnd::Held;
    tool.pressure = Some(pressure);
    tool.wob_path = WobPath::Shared;
    check(&tool, 5e-4, 23);
}

/// A guide that was straight, and one that is bent sideways, whose couples act inside spans too.
#[test]
fn preloaded_guides() {
    for (curvature, phase) in [(0.0, 0.0), (0.2, 0.7)] {
        let mut tool = small(5, 4);
        tool.guide_free_curvature = Some(FreeCurvature { curvature, phase });
        tool.supports.push(Support {
            location: Location::Top,
            body: Body::Guide,
            directions: vec![Direction::Psi],
        });
        check(&tool, 5e-4, 19);
        tool.guide_bending_factor = 0.05;
        check(&with_soft_contacts(tool), 5e-4, 20);
    }
}

/// Guides with open and closed slots, straight, bent, and as the path.
#[test]
fn slots_that_close() {
    for (elements, seed) in [(1, 3), (4, 11)] {
        for tool in with_slots(&small(5, elements)) {
            check(&tool, 5e-4, seed);
        }
    }
}

/// Guides that thrust bends with the path, against it and out of it.
#[test]
fn spines_off_the_axis() {
    for (elements, seed) in [(1, 3), (4, 11)] {
        for tool in with_spine(&small(5, elements)) {
            check(&with_soft_contacts(tool), 5e-4, seed);
        }
    }
}

/// Mud around pipes with and without joints, of two diameters, in free and fixed guides, with masses.
#[test]
fn mud_around_the_pipes() {
    for (elements, seed) in [(1, 3), (3, 7), (5, 11)] {
        check(&with_mud(small(6, elements)), 5e-4, seed);
    }
    let mut tool = with_mud(small(5, 4));
    tool.pipe_sections[1].outer_diameter = 0.050;
    tool.pipe_sections[2].inner_diameter = 0.020;
    tool.masses = vec![
        mass(Location::Joint(1), Body::Pipe),
        mass(Location::Station(6), Body::Guide),
    ];
    check(&tool, 5e-4, 25);
    tool.wob_path = WobPath::Shared;
    tool.guide_bending_factor = 0.05;
    check(&with_soft_contacts(tool), 5e-4, 26);
    for (elements, seed) in [(1, 3), (3, 7), (5, 11)] {
        check(&with_mud_near_walls(small(6, elements)), 5e-4, seed);
    }
    let mut tool = with_mud_near_walls(small(5, 4));
    tool.pipe_sections[1].outer_diameter = 0.050;
    check(&tool, 5e-4, 29);
    tool.guide_fixed = true;
    check(&tool, 5e-4, 27);
    tool.guide_fixed = false;
    tool.joint.kind = JointKind::Revolute;
    check(&tool, 5e-4, 28);
}

#[test]
fn no_joint_at_all() {
    let mut tool = small(1, 12);
    check(&tool, 5e-4, 14);
    tool.guide_fixed = true;
    check(&tool, 5e-5, 15);
}

#[test]
fn revolute_joints() {
    let mut tool = small(6, 3);
    tool.joint.kind = JointKind::Revolute;
    check(&tool, 5e-4, 16);
    tool.guide_fixed = true;
    check(&tool, 5e-4, 17);
    // One tilt below is held, so that the other one follows.
    for direction in [Direction::PhiY, Direction::PhiZ] {
        tool.supports.push(Support {
            location: Location::Joint(2),
            body: Body::Pipe,
            directions: vec![direction],
        });
        check(&tool, 5e-4, 18);
        tool.supports.pop();
    }
}
