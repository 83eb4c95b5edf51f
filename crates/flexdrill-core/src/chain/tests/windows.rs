//! Corrections in windows against those of the whole tool.

use super::*;

/// Station and force of each contact, in the order of the stations.
fn contacts(layer: &LayerContacts) -> Vec<(usize, [f64; 6])> {
    let mut contacts: Vec<_> = layer.iter().map(|(station, touch)| (station, touch.force())).collect();
    contacts.sort_by_key(|(station, _)| *station);
    contacts
}

#[test]
fn a_window_is_solved_for_as_the_whole_tool_and_leaves_its_residual() {
    let tool = small(40, 2);
    let model = Model::new(&tool).unwrap();
    let factors = Scheme::generalised_alpha(0.45).factors(5e-4);
    let conditions = Conditions::new(&tool, &LiveParameters::of(&tool), 0.3, 1e4);
    for instructions in Instructions::available() {
        let mut chain = Chain::of(&model, &Tolerances::default(), 5e-4, &acting(&model), instructions);
        let mut room = Room::new(&model, &chain, instructions);
        let mut state = lively(&chain, &model, 8);
        clean(&chain, &mut state);
        chain.prepare(&model, &conditions, factors);
        equations(&model, &mut chain, &mut room).evaluate(&mut state, &conditions, false);
        assert!(
            equations(&model, &mut chain, &mut room).solve_in_single(&state, &Iteration::first(&conditions, factors))
        );

        // All below a node is out of balance: the elimination above is that of before, the solution that of the whole.
        let residual = chain.residual.clone();
        let (first, bottom) = (25, chain.spans());
        chain.residual[..NODE * first].fill(0.0);
        equations(&model, &mut chain, &mut room)
            .solve_in_double(&state, &Iteration::first(&conditions, factors))
            .unwrap();
        let expected = chain.correction.clone();
        let weights = chain.limits.weights(Accuracy::Rest).to_vec();
        chain.active.set_windows(&chain.residual, &weights);
        assert!(
            equations(&model, &mut chain, &mut room).solve_in_single(&state, &Iteration::first(&conditions, factors))
        );
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
        assert!(
            equations(&model, &mut chain, &mut room).solve_in_single(&state, &Iteration::first(&conditions, factors))
        );
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
            [contacts(&room.layers().inner), contacts(&room.layers().outer)],
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
            [contacts(&room.layers().inner), contacts(&room.layers().outer)]
        );
        assert!(touching.iter().all(|layer| layer.len() > 8));
    }
}
