//! The chain's equations are those of the whole tool seen through the slaving: residual, tangent and solution.

use nalgebra::{DMatrix, DVector, Matrix3};

use super::dependents::{FIRST_ROW, SECOND_ROW};
use super::{Chain, ChainEquations, NODE, TIE};
use crate::Instructions;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{EnergyPoint, JointForces};
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::interactions::Interactions;
use crate::dynamics::newton::{Equations, Iteration, correct};
use crate::dynamics::phases::Stopwatch;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::stations::Assembler;
use crate::dynamics::tolerances::{Accuracy, Tolerances};
use crate::elements::gap::Layer;
use crate::elements::joint::Joint;
use crate::model::Model;
use crate::tool::description::LiveParameters;
use crate::tool::{
    Body, Direction, JointKind, LoadHistory, Location, PointLoad, PointMass, Support, ToolDescription, WobPath,
};

fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
}

fn small(links: usize, elements: usize) -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(links, elements);
    // A wide limit leaves some of the stops shut and some open.
    tool.joint.limit = 0.26;
    tool
}

/// Contacts that spans of a metre do not give way to.
fn with_soft_contacts(mut tool: ToolDescription) -> ToolDescription {
    (tool.inner.stiffness, tool.outer.stiffness) = (1e5, 2e5);
    tool
}

fn mass(location: Location, body: Body) -> PointMass {
    PointMass {
        location,
        body,
        mass: 8.0,
        axial_inertia: 0.05,
        transverse_inertia: 0.03,
        eccentricity: 0.02,
        eccentricity_phase: 0.4,
    }
}

fn load(location: Location, body: Body) -> PointLoad {
    PointLoad {
        location,
        body,
        direction: Direction::V,
        history: LoadHistory::Constant(300.0),
    }
}

/// Contact in both layers at about a third of the stations, inside spans too, at joints and at the first station.
fn lively(chain: &Chain, seed: u64) -> State {
    let mut seed = seed;
    let mut state = chain.state();
    for values in [&mut state.v, &mut state.a] {
        values.iter_mut().for_each(|x| *x = random(&mut seed));
    }
    for node in state.q.chunks_exact_mut(NODE) {
        let angle = 3.0 * random(&mut seed);
        let active = if random(&mut seed) > 0.0 { 0.019 } else { 1e-4 };
        (node[3], node[4], node[5]) = (1e-4 * random(&mut seed), active * angle.cos(), active * angle.sin());
        let angle = 3.0 * random(&mut seed);
        let active = if random(&mut seed) > 0.0 { 0.009 } else { 1e-4 };
        (node[9], node[10], node[11]) = (1e-4 * random(&mut seed), active * angle.cos(), active * angle.sin());
        // A twist that a joint carries: what is out of balance by more has multipliers that no motion has.
        (node[0], node[12]) = (2.0 + 1e-3 * random(&mut seed), 5.0 * random(&mut seed));
        // Near what the joint's row asks for.
        node[6] = node[0] + 0.3 * random(&mut seed);
        for k in [1, 2, 7, 8, 13, 14] {
            node[k] = 0.05 * random(&mut seed);
        }
        node[TIE] = 1e-4 * random(&mut seed);
    }
    for (k, node) in chain.model.nodes.list.iter().enumerate() {
        if node.joint.is_none() {
            for values in [&mut state.q, &mut state.v, &mut state.a] {
                values.copy_within(NODE * k..NODE * k + 3, NODE * k + 6);
            }
        }
    }
    state
}

/// The state with what is not in the equations at zero, as it is in motion.
fn clean(chain: &Chain, state: &mut State) {
    for (unknown, weight) in chain.limits.weights(Accuracy::Rest).iter().enumerate() {
        let node = unknown / NODE * NODE;
        if *weight == 0.0 && Some(unknown) != chain.model.places.driven {
            (state.q[unknown], state.v[unknown], state.a[unknown]) = (0.0, 0.0, 0.0);
        }
        if chain.model.nodes.list[unknown / NODE].joint.is_none() {
            for values in [&mut state.q, &mut state.v, &mut state.a] {
                values.copy_within(node..node + 3, node + 6);
            }
        }
    }
}

/// No force in any joint.
fn no_forces(chain: &Chain) -> JointForces {
    JointForces {
        on_top: vec![[0.0; 3]; chain.spans()],
        multipliers: vec![[0.0; 2]; chain.multipliers.len()],
    }
}

/// What the chain's equations need apart from the chain.
struct Room {
    interactions: Interactions,
    stopwatch: Stopwatch,
}

impl Room {
    fn new(model: &Model, instructions: Instructions) -> Self {
        Self {
            interactions: Interactions::new(model, instructions),
            stopwatch: Stopwatch::default(),
        }
    }
}

fn equations<'a>(model: &'a Model, chain: &'a mut Chain, room: &'a mut Room) -> ChainEquations<'a> {
    ChainEquations {
        model,
        chain,
        interactions: &mut room.interactions,
        stopwatch: &mut room.stopwatch,
    }
}

/// What the whole tool's unknowns are by each of the chain's and, in further columns, by the multiplier of each rotational
/// row.
fn slaving(chain: &Chain, model: &Model) -> DMatrix<f64> {
    let n = chain.unknowns();
    let rows = Joint::rotational_rows(model.description.joint.kind);
    let mut out = DMatrix::zeros(model.unknowns(), n + rows * model.joints.len());
    let (mut unit, mut full) = (chain.state(), State::at_rest(model));
    for j in 0..n {
        // Where the pipe passes a node in one piece, the rotations below are those above.
        let one_piece = chain.model.nodes.list[j / NODE].joint.is_none();
        let (above, below) = ((0..3).contains(&(j % NODE)), (6..9).contains(&(j % NODE)));
        let with = if one_piece && above { j + 6 } else { j };
        (unit.q[j], unit.q[with]) = (1.0, 1.0);
        if !(one_piece && below) {
            chain.show(model, &unit, &no_forces(chain), &mut full);
            out.set_column(j, &DVector::from_column_slice(&full.q));
        }
        (unit.q[j], unit.q[with]) = (0.0, 0.0);
    }
    for joint in 0..model.joints.len() {
        for row in 0..rows {
            out[(model.multipliers(joint) + 3 + row, n + rows * joint + row)] = 1.0;
        }
    }
    out
}

/// Over the fewest nodes there can be, and over those that steps of this size need.
fn check(tool: &ToolDescription, h: f64, seed: u64) {
    for nodes_for in [1.0, h] {
        check_over(tool, (h, nodes_for), seed);
    }
}

fn check_over(tool: &ToolDescription, (h, nodes_for): (f64, f64), seed: u64) {
    let model = Model::new(tool).unwrap();
    let scheme = Scheme::generalised_alpha(0.45);
    let factors = scheme.factors(h);
    let mut conditions = Conditions::new(tool, &LiveParameters::of(tool), 0.3, 1e4);
    conditions.bit_torque = 90.0;
    for instructions in Instructions::available() {
        let mut chain = Chain::of(&model, &Tolerances::default(), nodes_for, instructions);
        let slaving = slaving(&chain, &model);
        let mut state = lively(&chain, seed);
        clean(&chain, &mut state);
        // Each span has an axial force of its own.
        let mut next = seed + 9;
        for l in 0..chain.spans() {
            (state.pipe_axial[l], state.guide_axial[l]) = (2e3 * random(&mut next), 2e3 * random(&mut next));
        }

        let mut room = Room::new(&model, instructions);
        equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, true);
        let mut full = State::at_rest(&model);
        let forces = JointForces {
            multipliers: chain.multipliers.clone(),
            ..no_forces(&chain)
        };
        chain.show(&model, &state, &forces, &mut full);
        let mut whole = Assembler::new(&model, instructions);
        let mut at_stations = Interactions::new(&model, instructions);
        whole.residual(&mut at_stations, &model, &full, &conditions);
        let inside = |layer: &Layer| {
            layer
                .iter()
                .filter(|(station, _)| model.stations[*station].joint.is_none())
                .count()
        };
        if tool.elements_per_link > 1 {
            assert!(
                inside(&room.interactions.inner) > 0 && (tool.guide_fixed || inside(&room.interactions.outer) > 0),
                "no contact inside spans"
            );
        }
        assert!(
            model.joints.is_empty()
                || tool.joint.kind == JointKind::Revolute
                || room.interactions.joints.stops().any(|stop| stop.moment > 0.0),
            "no shut stop"
        );

        // Residual: the whole tool's through the slaving. The multipliers that follow from the dependent rotations balance
        // those; their places hold the rows.
        let n = chain.unknowns();
        let mut expected = slaving.tr_mul(&DVector::from_column_slice(&whole.residual));
        let rows = Joint::rotational_rows(tool.joint.kind);
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
                let solved = equations(&model, &mut chain, &mut room).solve_in_single(&state, &conditions, factors);
                assert!(solved, "single precision was refused");
            } else {
                equations(&model, &mut chain, &mut room)
                    .solve_in_double(&state, &conditions, factors)
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
fn ball_cages_and_a_tie() {
    let mut tool = small(5, 3);
    tool.joint.kind = JointKind::BallCage;
    tool.wob_path = WobPath::Shared;
    check(&tool, 5e-4, 4);
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

/// The linear system that steps solve is the derivative of the residual that they judge by: the solution for a random
/// right-hand side brings the residual's difference quotient back to it.
fn check_derivative(tool: &ToolDescription) {
    let model = Model::new(tool).unwrap();
    let factors = Scheme::newmark(0.6).factors(5e-4);
    let mut conditions = Conditions::new(tool, &LiveParameters::of(tool), 0.0, 1e4);
    conditions.bit_torque = 90.0;
    let instructions = Instructions::best();
    let mut chain = Chain::of(&model, &Tolerances::default(), 5e-4, instructions);
    // No axial force: the tangent leaves geometric stiffness out.
    let mut state = lively(&chain, 21);
    clean(&chain, &mut state);
    let mut room = Room::new(&model, instructions);
    equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, true);
    assert!(room.interactions.inner.count() > 2, "no inner contact to test");
    assert!(
        tool.guide_fixed || room.interactions.outer.count() > 2,
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
    chain.prepare(&model, &conditions, factors);
    equations(&model, &mut chain, &mut room)
        .solve_in_double(&state, &conditions, factors)
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
        let mut room = Room::new(&model, instructions);
        let mut newton = equations(&model, &mut chain, &mut room);
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

#[test]
fn the_tangent_is_the_derivative_of_the_residual() {
    for kind in [JointKind::Universal, JointKind::BallCage, JointKind::Revolute] {
        let mut tool = small(6, 3);
        tool.joint.kind = kind;
        check_derivative(&tool);
        tool.guide_fixed = true;
        check_derivative(&tool);
    }
    let mut tool = small(6, 3);
    tool.bit.inertia = 0.02;
    tool.wob_path = WobPath::Shared;
    tool.masses = vec![
        mass(Location::Joint(1), Body::Pipe),
        mass(Location::Station(1), Body::Pipe),
        mass(Location::Station(4), Body::Guide),
    ];
    check_derivative(&tool);
}

#[test]
fn spans_that_are_too_long_or_too_soft_have_nodes_inside() {
    let spans = |tool: &ToolDescription, h: f64| {
        let model = Model::new(tool).unwrap();
        let chain = Chain::of(&model, &Tolerances::default(), h, Instructions::PORTABLE);
        chain.spans()
    };
    let default = ToolDescription::paper();
    assert_eq!(spans(&default, 5e-4), 33);
    // Links of a metre vibrate too slowly for steps of half a millisecond: (4.73 / l)^2 sqrt(EI / rho A) is 2000 rad/s.
    let mut long = default.clone().with_mesh(5, 5);
    (long.inner.stiffness, long.outer.stiffness) = (1e5, 2e5);
    // Half of one still does, so that nodes are at every station.
    assert_eq!((spans(&long, 5e-4), spans(&long, 1e-2)), (25, 5));
    // With contacts of their usual stiffness they deflect too much under them, whatever the step.
    assert!(spans(&default.clone().with_mesh(5, 5), 1e-2) > 5);
    // A soft guide on hard rock.
    let mut soft = default.clone();
    soft.guide_bending_factor = 0.05;
    assert_eq!(spans(&soft, 5e-4), 33);
    soft.outer.stiffness = 5e8;
    assert!(spans(&soft, 5e-4) > 33);
    soft.guide_bending_factor = 1.0;
    assert_eq!(spans(&soft, 5e-4), 33);
}

#[test]
fn spans_bow_as_the_whole_tool_does_with_its_joints_held() {
    let mut tool = small(4, 5);
    tool.guide_bending_factor = 0.05;
    (tool.inner.stiffness, tool.outer.stiffness) = (1e3, 1e3);
    let model = Model::new(&tool).unwrap();
    let conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
    // Over the fewest nodes.
    let chain = Chain::of(&model, &Tolerances::default(), 1.0, Instructions::PORTABLE);
    let elastic = TangentFactors {
        stiffness: 1.0,
        damping: 0.0,
        mass: 0.0,
    };
    let system = Assembler::new(&model, Instructions::PORTABLE).step_constant(&model, &conditions, elastic);
    let mut whole = DMatrix::zeros(model.unknowns(), model.unknowns());
    system.for_each_entry(|row, column, value| whole[(row, column)] += value);
    for (l, i, local) in [(0, 1, 1), (1, 2, 2), (3, 4, 4), (2, 3, 5)] {
        let (first, per) = (chain.model.nodes.first(l), chain.model.nodes.elements(l));
        for body in 0..2 {
            let at = |i: usize| {
                let station = &model.stations[first + i];
                if body == 0 { station.pipe_above } else { station.guide }
            };
            let inner: Vec<usize> = (1..per).flat_map(|i| at(i)..at(i) + 6).collect();
            let stiffness = DMatrix::from_fn(inner.len(), inner.len(), |r, c| whole[(inner[r], inner[c])]);
            // A unit force in the station's frame; a couple at the pipe acts at its radius.
            let station = &model.stations[first + i];
            let frame = |k: usize| {
                if body == 0 {
                    station.pipe_to_station.row(k).transpose()
                } else {
                    Matrix3::identity().column(k).into()
                }
            };
            let mut force = DVector::zeros(inner.len());
            let place = 6 * (i - 1);
            if local < 3 {
                force.rows_mut(place, 3).copy_from(&frame(local));
            } else {
                force[place + local] = if body == 0 { station.pipe_radius } else { 1.0 };
            }
            let bowed = stiffness.cholesky().unwrap().solve(&force);
            let got = &chain.model.kinds[chain.model.links[l].kind].deflection[i - 1][body][local];
            let scale = got.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(scale > 0.0);
            for other in 1..per {
                let station = &model.stations[first + other];
                let node = bowed.fixed_rows::<3>(6 * (other - 1)).clone_owned();
                let lateral = if body == 0 {
                    station.pipe_to_station * node
                } else {
                    node
                };
                for (lane, expected) in [(other - 1, lateral.y), (8 + other - 1, lateral.z)] {
                    // Both solve the same matrix, whose entries differ by rounding.
                    assert!(
                        (got[lane] - expected).abs() < 1e-9 * scale,
                        "span {l}, station {i}, body {body}: {} at {other} against {expected}",
                        got[lane]
                    );
                }
            }
        }
    }
}

#[test]
fn turning_as_a_whole_changes_no_energy() {
    let tool = ToolDescription::paper();
    let model = Model::new(&tool).unwrap();
    let conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
    for instructions in Instructions::available() {
        let mut chain = Chain::of(&model, &Tolerances::default(), 5e-4, instructions);
        let mut state = lively(&chain, 5);
        let spins: Vec<usize> = chain.spins().collect();
        spins.iter().for_each(|&spin| state.q[spin] *= 2e-4);
        clean(&chain, &mut state);
        let mut room = Room::new(&model, instructions);
        let mut whole = Assembler::new(&model, instructions);
        let mut interactions = Interactions::new(&model, instructions);
        let mut full = State::at_rest(&model);
        // Over the chain, and station by station.
        let mut stored = |state: &mut State| {
            equations(&model, &mut chain, &mut room).evaluate(state, &conditions, true);
            let mut point = EnergyPoint::new(&model, chain.unknowns(), chain.spans());
            equations(&model, &mut chain, &mut room).energy(&mut point, state, &conditions);
            chain.show(&model, state, &no_forces(&chain), &mut full);
            whole.residual(&mut interactions, &model, &full, &conditions);
            let mut at_stations = EnergyPoint::new(&model, model.unknowns(), 0);
            at_stations.evaluate(&model, &full, &conditions, &whole, &interactions);
            [point.stored, at_stations.stored]
        };
        let before = stored(&mut state);
        let turned = 900.0 * std::f64::consts::TAU;
        spins.iter().for_each(|&spin| state.q[spin] += turned);
        let after = stored(&mut state);
        for (before, after) in before.iter().zip(after) {
            // 900 turns leave an angle to 1e-12 rad, which at 1.3e7 N m per rad and 1e-3 rad is some 1e-8 J per element;
            // the rounding of the forces times the turns would be 0.03 J.
            assert!(
                (after - before).abs() < 1e-5,
                "{instructions}: {before} J, turned {after} J"
            );
        }
    }
}

/// Station and force of each contact, in the order of the stations.
fn contacts(layer: &Layer) -> Vec<(usize, [f64; 6])> {
    let mut contacts: Vec<_> = layer.iter().map(|(station, touch)| (station, touch.force())).collect();
    contacts.sort_by_key(|(station, _)| *station);
    contacts
}

#[test]
fn a_window_is_solved_for_as_the_whole_tool_and_leaves_its_residual() {
    let tool = small(40, 2);
    let model = Model::new(&tool).unwrap();
    let factors = Scheme::generalised_alpha(0.45).factors(5e-4);
    let mut conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
    conditions.bit_torque = 90.0;
    for instructions in Instructions::available() {
        let mut chain = Chain::of(&model, &Tolerances::default(), 5e-4, instructions);
        let mut room = Room::new(&model, instructions);
        let mut state = lively(&chain, 8);
        clean(&chain, &mut state);
        chain.prepare(&model, &conditions, factors);
        equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, false);
        assert!(equations(&model, &mut chain, &mut room).solve_in_single(&state, &conditions, factors));

        // All below a node is out of balance: the elimination above is that of before, the solution that of the whole.
        let residual = chain.residual.clone();
        let (first, bottom) = (25, chain.spans());
        chain.residual[..NODE * first].fill(0.0);
        equations(&model, &mut chain, &mut room)
            .solve_in_double(&state, &conditions, factors)
            .unwrap();
        let expected = chain.correction.clone();
        let weights = chain.limits.weights(Accuracy::Rest).to_vec();
        chain.active.set_windows(&chain.residual, &weights);
        assert!(equations(&model, &mut chain, &mut room).solve_in_single(&state, &conditions, factors));
        let [window] = chain.active.windows[..] else {
            panic!("{:?}", chain.active.windows)
        };
        assert_eq!((window.first, window.last), (first, bottom));
        assert!(window.top < first, "nothing follows above");
        for place in 0..NODE {
            let at =
                |values: &[f64]| DVector::from_iterator(bottom + 1, values.iter().skip(place).step_by(NODE).copied());
            let (got, expected) = (at(&chain.correction), at(&expected));
            let apart = (&got - &expected).amax() / expected.amax().max(f64::MIN_POSITIVE);
            // As single precision is held to the whole tool's above.
            assert!(apart < 1e-3, "{instructions}: unknowns {place} are {apart:e} apart");
        }

        // Two nodes out of balance.
        chain.residual.copy_from_slice(&residual);
        chain.foreseen_part = 0.0;
        let mut weights = vec![0.0; residual.len()];
        for node in [12, 28] {
            weights[NODE * node..NODE * (node + 1)].fill(1.0);
        }
        chain.active.set_windows(&residual, &weights);
        assert!(equations(&model, &mut chain, &mut room).solve_in_single(&state, &conditions, factors));
        assert_eq!(chain.active.windows.len(), 2);
        let moved: Vec<bool> = chain
            .correction
            .chunks_exact(NODE)
            .map(|node| node.iter().any(|dq| *dq != 0.0))
            .collect();
        let mut newton = equations(&model, &mut chain, &mut room);
        correct(&newton, &mut state, factors);
        newton.residual(
            &mut state,
            &Iteration {
                conditions: &conditions,
                factors,
                corrections: 3,
            },
        );
        let kept = moved.iter().filter(|moved| !**moved).count();
        assert!(kept >= 5, "all but {kept} of the nodes move");
        for (node, affected) in chain.active.affected.iter().enumerate() {
            let neighbours = &moved[node.saturating_sub(1)..(node + 2).min(bottom + 1)];
            assert_eq!(*affected, neighbours.contains(&true), "node {node}");
            let range = NODE * node..NODE * (node + 1);
            assert!(
                *affected || chain.residual[range.clone()] == residual[range],
                "node {node}"
            );
        }
        let (got, touching) = (
            chain.residual.clone(),
            [contacts(&room.interactions.inner), contacts(&room.interactions.outer)],
        );
        equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, false);
        let scale = chain.residual.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (unknown, (got, expected)) in got.iter().zip(&chain.residual).enumerate() {
            // Rounding of stiffness times displacement, which cancel to the residual.
            assert!(
                (got - expected).abs() < 1e-9 * scale,
                "{instructions}: residual {unknown} is {got} against {expected}, scale {scale:e}"
            );
        }
        // The same numbers: what did not move was not looked at, what did was evaluated anew.
        assert_eq!(
            touching,
            [contacts(&room.interactions.inner), contacts(&room.interactions.outer)]
        );
        assert!(touching.iter().all(|layer| layer.len() > 8));
    }
}
