//! Where spans are split, how they deflect, what energy they store.

use super::*;

#[test]
fn spans_that_are_too_long_or_too_soft_have_nodes_inside() {
    let spans = |tool: &ToolDescription, h: f64| {
        let model = Model::new(tool).unwrap();
        let chain = Chain::of(
            &model,
            &Tolerances::default(),
            h,
            &acting(&model),
            Instructions::PORTABLE,
        );
        chain.spans()
    };
    let default = ToolDescription::paper();
    assert_eq!(spans(&default, 5e-4), 33);
    // Links of a metre vibrate too slowly for steps of half a millisecond: (4.73 / l)^2 sqrt(EI / rho A) is 2000 rad/s.
    let mut long = default.clone().with_mesh(5, 5);
    (long.inner.stiffness, long.outer.stiffness) = (1e5, 2e5);
    // Three fifths of one still do (5556 rad/s), two fifths do not: a link of five elements has spans of 2, 1 and 2.
    assert_eq!((spans(&long, 5e-4), spans(&long, 1e-2)), (15, 5));
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
    let chain = Chain::of(
        &model,
        &Tolerances::default(),
        1.0,
        &acting(&model),
        Instructions::PORTABLE,
    );
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

/// The energy of a preloaded guide is the same over the chain and over the stations, up to that of the inner stations'
/// own deflection, which is constant and zero in an arc.
#[test]
fn a_preload_stores_the_same_energy_over_the_chain() {
    let mut tool = small(4, 5);
    tool.guide_free_curvature = Some(FreeCurvature {
        curvature: 0.1,
        phase: 0.0,
    });
    let [(preloaded, _), (built, scale)] =
        [tool.clone(), tool.with(|tool| tool.guide_free_curvature = None)].map(|tool| {
            let model = Model::new(&tool).unwrap();
            let conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
            let mut chain = Chain::of(
                &model,
                &Tolerances::default(),
                5e-4,
                &acting(&model),
                Instructions::best(),
            );
            let mut state = lively(&chain, &model, 5);
            clean(&chain, &mut state);
            let mut room = Room::new(&model, &chain, Instructions::best());
            equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, true);
            let mut point = LedgerPoint::new(&model, chain.unknowns(), chain.spans(), false);
            let mut carried = Carried::new(&model, chain.spans());
            equations(&model, &mut chain, &mut room).energy(&mut carried, &mut point, &state, &conditions);
            let mut full = State::at_rest(&model);
            chain.show(&model, &state, &no_forces(&chain), &mut full);
            let mut whole = Assembler::new(&model, Instructions::best());
            let mut interactions = Interactions::new(&model, Instructions::best());
            whole.residual(&mut interactions, &model, &full, &conditions);
            let mut at_stations = LedgerPoint::new(&model, model.unknowns(), 0, false);
            at_stations.evaluate(
                &mut Carried::new(&model, 0),
                &model,
                &full,
                &conditions,
                &whole,
                &interactions,
            );
            (
                point.sums.stored - at_stations.sums.stored,
                at_stations.sums.stored.abs(),
            )
        });
    // The two states differ in nothing but the preload, and so do both ways of adding up: rounding of all energies.
    assert!(
        (preloaded - built).abs() < 1e-9 * scale,
        "{preloaded} against {built} J of {scale}"
    );
}

#[test]
fn turning_as_a_whole_changes_no_energy() {
    let tool = ToolDescription::paper();
    let model = Model::new(&tool).unwrap();
    let conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
    for instructions in Instructions::available() {
        let mut chain = Chain::of(&model, &Tolerances::default(), 5e-4, &acting(&model), instructions);
        let mut state = lively(&chain, &model, 5);
        let spins: Vec<usize> = chain.spins().collect();
        spins.iter().for_each(|&spin| state.q[spin] *= 2e-4);
        clean(&chain, &mut state);
        let mut room = Room::new(&model, &chain, instructions);
        let mut whole = Assembler::new(&model, instructions);
        let mut interactions = Interactions::new(&model, instructions);
        let mut full = State::at_rest(&model);
        // Over the chain, and station by station.
        let mut stored = |state: &mut State| {
            equations(&model, &mut chain, &mut room).evaluate(state, &conditions, true);
            let mut point = LedgerPoint::new(&model, chain.unknowns(), chain.spans(), false);
            let mut carried = Carried::new(&model, chain.spans());
            equations(&model, &mut chain, &mut room).energy(&mut carried, &mut point, state, &conditions);
            chain.show(&model, state, &no_forces(&chain), &mut full);
            whole.residual(&mut interactions, &model, &full, &conditions);
            let mut at_stations = LedgerPoint::new(&model, model.unknowns(), 0, false);
            at_stations.evaluate(
                &mut Carried::new(&model, 0),
                &model,
                &full,
                &conditions,
                &whole,
                &interactions,
            );
            [point.sums.stored, at_stations.sums.stored]
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
