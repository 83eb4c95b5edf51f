//! The reduced equations are those of the whole tool seen through the slaving: residual, tangent and solution.

use faer::prelude::Solve;
use nalgebra::{DMatrix, DVector, Matrix3};

use super::{MULTIPLIER, NODE, Reduced, equations};
use crate::Instructions;
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::EnergyPoint;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::newton::{Equations, correct};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::{Accuracy, Tolerances};
use crate::elements::gap::Layer;
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
fn lively(reduced: &Reduced, seed: u64) -> State {
    let mut seed = seed;
    let mut state = reduced.state();
    for values in [&mut state.v, &mut state.a] {
        values.iter_mut().for_each(|x| *x = random(&mut seed));
    }
    for node in state.q.chunks_exact_mut(NODE) {
        let angle = 3.0 * random(&mut seed);
        let reach = if random(&mut seed) > 0.0 { 0.019 } else { 1e-4 };
        (node[3], node[4], node[5]) = (1e-4 * random(&mut seed), reach * angle.cos(), reach * angle.sin());
        let angle = 3.0 * random(&mut seed);
        let reach = if random(&mut seed) > 0.0 { 0.009 } else { 1e-4 };
        (node[9], node[10], node[11]) = (1e-4 * random(&mut seed), reach * angle.cos(), reach * angle.sin());
        for k in [0, 6, 12] {
            node[k] = 5.0 * random(&mut seed);
        }
        for k in [1, 2, 7, 8, 13, 14] {
            node[k] = 0.05 * random(&mut seed);
        }
        node[MULTIPLIER] = 1e-4 * random(&mut seed);
    }
    state
}

/// The state with what is not in the equations at zero, as it is in motion.
fn clean(reduced: &Reduced, state: &mut State) {
    for (unknown, weight) in reduced.limits.weights(Accuracy::Rest).iter().enumerate() {
        if *weight == 0.0 && Some(unknown) != reduced.places.driven {
            (state.q[unknown], state.v[unknown], state.a[unknown]) = (0.0, 0.0, 0.0);
        }
    }
}

/// What the whole tool's unknowns are by each reduced one.
fn slaving(reduced: &Reduced, model: &Model) -> DMatrix<f64> {
    let n = reduced.unknowns();
    let mut out = DMatrix::zeros(model.unknowns(), n);
    let (mut unit, mut full) = (reduced.state(), State::at_rest(model));
    for j in 0..n {
        unit.q[j] = 1.0;
        reduced.show(model, (&unit, &vec![[0.0; 3]; reduced.spans()]), &mut full);
        out.set_column(j, &DVector::from_column_slice(&full.q));
        unit.q[j] = 0.0;
    }
    out
}

fn check(tool: &ToolDescription, h: f64, seed: u64) {
    let model = Model::new(tool).unwrap();
    let scheme = Scheme::generalised_alpha(0.45);
    let factors = scheme.factors(h);
    let mut conditions = Conditions::new(tool, &LiveParameters::of(tool), 0.3, 1e4);
    conditions.bit_torque = 90.0;
    for instructions in Instructions::available() {
        let mut reduced = Reduced::of(&model, &Tolerances::default(), instructions).expect("a tool of this form");
        let slaving = slaving(&reduced, &model);
        let mut state = lively(&reduced, seed);
        clean(&reduced, &mut state);
        // Each span has an axial force of its own.
        let mut next = seed + 9;
        for l in 0..reduced.spans() {
            (state.pipe_axial[l], state.guide_axial[l]) = (2e3 * random(&mut next), 2e3 * random(&mut next));
        }

        let mut assembler = Assembler::new(&model, instructions);
        equations(&mut reduced, &mut assembler).evaluate(&model, &mut state, &conditions, true);
        let mut full = State::at_rest(&model);
        reduced.show(&model, (&state, &vec![[0.0; 3]; reduced.spans()]), &mut full);
        let mut whole = Assembler::new(&model, instructions);
        whole.residual(&model, &full, &conditions);
        let inside = |layer: &Layer| {
            layer
                .iter()
                .filter(|(station, _)| model.stations[*station].joint.is_none())
                .count()
        };
        if tool.elements_per_link > 1 {
            assert!(
                inside(&assembler.inner) > 0 && inside(&assembler.outer) > 0,
                "no contact inside spans"
            );
        }
        assert!(assembler.stops().any(|stop| stop.moment > 0.0), "no shut stop");

        // Residual: the whole tool's through the slaving.
        let expected = slaving.tr_mul(&DVector::from_column_slice(&whole.residual));
        let scale = whole.residual.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (unknown, (got, expected)) in reduced.residual.iter().zip(expected.iter()).enumerate() {
            if reduced.limits.weights(Accuracy::Rest)[unknown] > 0.0 {
                // Rounding of stiffness times displacement, which cancel to the residual.
                assert!(
                    (got - expected).abs() < 1e-9 * scale,
                    "{instructions}: residual {unknown} is {got} against {expected}, scale {scale:e}"
                );
            }
        }

        // Tangent without geometric stiffness, and its solution.
        let mut system = whole.step_constant(&model, &conditions, factors);
        whole.linearise(&model, &full, &conditions, factors);
        whole.increment.add_to(&mut system);
        let mut matrix = DMatrix::zeros(model.unknowns(), model.unknowns());
        system.for_each_entry(|row, column, value| matrix[(row, column)] += value);
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            matrix[(unknown, unknown)] = 0.0;
        }
        let mut matrix = slaving.tr_mul(&(matrix * &slaving));
        let mut right = -DVector::from_column_slice(&reduced.residual);
        for (unknown, weight) in reduced.limits.weights(Accuracy::Rest).iter().enumerate() {
            if *weight == 0.0 {
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
        let lu = faer::Mat::from_fn(scaled.nrows(), scaled.ncols(), |i, j| scaled[(i, j)]).full_piv_lu();
        let x = lu.solve(faer::Mat::from_fn(right.len(), 1, |i, _| right[i]));
        let x = DVector::from_fn(right.len(), |i, _| x[(i, 0)]).component_mul(&sizes);
        assert!(x.iter().all(|x| x.is_finite()), "a tangent without an inverse");
        reduced.prepare(&model, &conditions, factors);
        for (single, within) in [(false, 1e-9), (true, 1e-3)] {
            let by = (&conditions, factors);
            if single {
                let solved = reduced.solve_in_single(&mut assembler, &model, &state, by);
                assert!(solved, "single precision was refused");
            } else {
                reduced.solve(&mut assembler, &model, &state, by).unwrap();
            }
            let (got, expected) = (DVector::from_column_slice(&reduced.correction), &x);
            // In the units that make the matrix of one size.
            let [got, expected] = [&got, expected].map(|x| x.component_div(&sizes));
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

#[test]
fn what_is_computed_station_by_station() {
    let is_reduced = |change: &dyn Fn(&mut ToolDescription)| {
        let mut tool = small(4, 3);
        change(&mut tool);
        let model = Model::new(&tool).unwrap();
        Reduced::of(&model, &Tolerances::default(), Instructions::best()).is_some()
    };
    assert!(is_reduced(&|_| ()));
    assert!(!is_reduced(&|tool| tool.joint.kind = JointKind::Revolute));
    assert!(!is_reduced(&|tool| tool.guide_fixed = true));
    assert!(!is_reduced(
        &|tool| tool.masses = vec![mass(Location::Station(1), Body::Pipe)]
    ));
    assert!(!is_reduced(
        &|tool| tool.loads = vec![load(Location::Station(1), Body::Guide)]
    ));
    for location in [Location::Station(1), Location::Joint(0)] {
        assert!(!is_reduced(&|tool| tool.supports.push(Support {
            location,
            body: Body::Pipe,
            directions: vec![Direction::V],
        })));
    }
}

#[test]
fn spans_that_are_too_long_or_too_soft_are_computed_station_by_station() {
    let holds_for = |tool: &ToolDescription, h: f64| {
        let model = Model::new(tool).unwrap();
        let reduced = Reduced::of(&model, &Tolerances::default(), Instructions::PORTABLE).unwrap();
        println!("frequency {:.3} give {:.4}", reduced.slowest * 5e-4, reduced.give);
        reduced.holds_for(h)
    };
    let default = ToolDescription::paper();
    assert!(holds_for(&default, 5e-4));
    // Links of a metre vibrate too slowly for steps of half a millisecond: (4.73 / l)^2 sqrt(EI / rho A) is 2000 rad/s.
    let mut long = default.clone().with_mesh(5, 5);
    (long.inner.stiffness, long.outer.stiffness) = (1e5, 2e5);
    assert!(!holds_for(&long, 5e-4) && holds_for(&long, 1e-2));
    // With contacts of their usual stiffness they give way too much under them, whatever the step.
    assert!(!holds_for(&default.clone().with_mesh(5, 5), 1e-2));
    // A soft guide on hard rock.
    let mut soft = default.clone();
    soft.guide_bending_factor = 0.05;
    assert!(holds_for(&soft, 5e-4));
    soft.outer.stiffness = 5e8;
    assert!(!holds_for(&soft, 5e-4));
    soft.guide_bending_factor = 1.0;
    assert!(holds_for(&soft, 5e-4));
}

#[test]
fn spans_bow_as_the_whole_tool_does_with_its_joints_held() {
    let mut tool = small(4, 5);
    tool.guide_bending_factor = 0.05;
    let model = Model::new(&tool).unwrap();
    let conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
    let reduced = Reduced::of(&model, &Tolerances::default(), Instructions::PORTABLE).unwrap();
    let elastic = TangentFactors {
        stiffness: 1.0,
        damping: 0.0,
        mass: 0.0,
    };
    let system = Assembler::new(&model, Instructions::PORTABLE).step_constant(&model, &conditions, elastic);
    let mut whole = DMatrix::zeros(model.unknowns(), model.unknowns());
    system.for_each_entry(|row, column, value| whole[(row, column)] += value);
    for (l, i, local) in [(0, 1, 1), (1, 2, 2), (3, 4, 4), (2, 3, 5)] {
        let first = l * reduced.per;
        for body in 0..2 {
            let at = |i: usize| {
                let station = &model.stations[first + i];
                if body == 0 { station.pipe_above } else { station.guide }
            };
            let inner: Vec<usize> = (1..reduced.per).flat_map(|i| at(i)..at(i) + 6).collect();
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
            let got = &reduced.kinds[reduced.links[l].kind].bow[i - 1][body][local];
            let scale = got.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(scale > 0.0);
            for other in 1..reduced.per {
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
        let mut reduced = Reduced::of(&model, &Tolerances::default(), instructions).unwrap();
        let mut state = lively(&reduced, 5);
        let spins: Vec<usize> = reduced.spins().collect();
        spins.iter().for_each(|&spin| state.q[spin] *= 2e-4);
        clean(&reduced, &mut state);
        let (mut assembler, mut whole) = (
            Assembler::new(&model, instructions),
            Assembler::new(&model, instructions),
        );
        let mut full = State::at_rest(&model);
        // Over the joints, and station by station.
        let mut stored = |state: &mut State| {
            equations(&mut reduced, &mut assembler).evaluate(&model, state, &conditions, true);
            let mut point = EnergyPoint::new(&model, reduced.unknowns(), reduced.spans());
            reduced.energy(&mut point, &model, state, &conditions, &assembler);
            reduced.show(&model, (state, &vec![[0.0; 3]; reduced.spans()]), &mut full);
            whole.residual(&model, &full, &conditions);
            let mut at_stations = EnergyPoint::new(&model, model.unknowns(), 0);
            at_stations.evaluate(&model, &full, &conditions, &whole);
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
    let by = (&conditions, factors);
    for instructions in Instructions::available() {
        let mut reduced = Reduced::of(&model, &Tolerances::default(), instructions).unwrap();
        let mut assembler = Assembler::new(&model, instructions);
        let mut state = lively(&reduced, 8);
        clean(&reduced, &mut state);
        reduced.prepare(&model, &conditions, factors);
        equations(&mut reduced, &mut assembler).evaluate(&model, &mut state, &conditions, false);
        assert!(reduced.solve_in_single(&mut assembler, &model, &state, by));

        // All below a node is out of balance: the elimination above is that of before, the solution that of the whole.
        let residual = reduced.residual.clone();
        let (first, bottom) = (25, reduced.nodes - 1);
        reduced.residual[..NODE * first].fill(0.0);
        reduced.solve(&mut assembler, &model, &state, by).unwrap();
        let expected = reduced.correction.clone();
        let weights = reduced.limits.weights(Accuracy::Rest).to_vec();
        reduced.reach.set_windows(&reduced.residual, &weights);
        assert!(reduced.solve_in_single(&mut assembler, &model, &state, by));
        let [window] = reduced.reach.windows[..] else {
            panic!("{:?}", reduced.reach.windows)
        };
        assert_eq!((window.first, window.last), (first, bottom));
        assert!(window.top < first, "nothing follows above");
        for place in 0..NODE {
            let at =
                |values: &[f64]| DVector::from_iterator(bottom + 1, values.iter().skip(place).step_by(NODE).copied());
            let (got, expected) = (at(&reduced.correction), at(&expected));
            let apart = (&got - &expected).amax() / expected.amax().max(f64::MIN_POSITIVE);
            // As single precision is held to the whole tool's above.
            assert!(apart < 1e-3, "{instructions}: unknowns {place} are {apart:e} apart");
        }

        // Two nodes out of balance.
        reduced.residual.copy_from_slice(&residual);
        reduced.foreseen_part = 0.0;
        let mut weights = vec![0.0; residual.len()];
        for node in [12, 28] {
            weights[NODE * node..NODE * (node + 1)].fill(1.0);
        }
        reduced.reach.set_windows(&residual, &weights);
        assert!(reduced.solve_in_single(&mut assembler, &model, &state, by));
        assert_eq!(reduced.reach.windows.len(), 2);
        let moved: Vec<bool> = reduced
            .correction
            .chunks_exact(NODE)
            .map(|node| node.iter().any(|dq| *dq != 0.0))
            .collect();
        let mut newton = equations(&mut reduced, &mut assembler);
        correct(&newton, &mut state, factors);
        newton.residual(&model, &mut state, &conditions, factors, 3);
        let kept = moved.iter().filter(|moved| !**moved).count();
        assert!(kept >= 5, "all but {kept} of the nodes move");
        for (node, felt) in reduced.reach.felt.iter().enumerate() {
            let neighbours = &moved[node.saturating_sub(1)..(node + 2).min(bottom + 1)];
            assert_eq!(*felt, neighbours.contains(&true), "node {node}");
            let range = NODE * node..NODE * (node + 1);
            assert!(
                *felt || reduced.residual[range.clone()] == residual[range],
                "node {node}"
            );
        }
        let (got, touching) = (
            reduced.residual.clone(),
            [contacts(&assembler.inner), contacts(&assembler.outer)],
        );
        equations(&mut reduced, &mut assembler).evaluate(&model, &mut state, &conditions, false);
        let scale = reduced.residual.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (unknown, (got, expected)) in got.iter().zip(&reduced.residual).enumerate() {
            // Rounding of stiffness times displacement, which cancel to the residual.
            assert!(
                (got - expected).abs() < 1e-9 * scale,
                "{instructions}: residual {unknown} is {got} against {expected}, scale {scale:e}"
            );
        }
        // The same numbers: what did not move was not looked at, what did was evaluated anew.
        assert_eq!(touching, [contacts(&assembler.inner), contacts(&assembler.outer)]);
        assert!(touching.iter().all(|layer| layer.len() > 8));
    }
}
