//! Plausible tools as look-aheads have them: each in the state that a full run of that tool has at that instant.

use super::*;
use crate::ensemble::place::State;
use crate::ensemble::{Forks, Pace, Running};
use flexdrill_core::tool::{Body, Direction};
use flexdrill_uncertainty::Priors;

/// Velocities of the pipe at all stations, to the bit.
fn velocities(simulation: &Simulation) -> Vec<u64> {
    let directions = [Direction::U, Direction::V, Direction::W, Direction::Psi];
    (0..=simulation.last_station())
        .flat_map(|station| directions.map(|direction| (station, direction)))
        .filter_map(|(station, direction)| simulation.velocity(station, Body::Pipe, direction))
        .map(f64::to_bits)
        .collect()
}

/// A full run of a draw from rest, with the change of speed and weight at 10 s.
fn alone(config: &Config, number: u64, changes: &[(u64, RunInputs)], seconds: u64) -> Vec<u64> {
    let drawn = Priors::of(config)
        .unwrap()
        .member(config.ensemble.as_ref().unwrap().seed, number);
    let drawn = drawn.unwrap().config;
    let settings = drawn
        .simulation()
        .with(|settings| settings.initial_inputs = changes[0].1.inputs);
    let simulation = Simulation::new(&drawn.tool(), &settings).unwrap();
    let mut run = Run::new(simulation, changes[0].1.schedule);
    let refinement = run.applied().refinement;
    for tick in 0..seconds * SECOND {
        for (_, acts) in changes.iter().filter(|(at, _)| *at == tick) {
            run.apply(&RunInputs {
                refinement,
                live: drawn.live(),
                ..*acts
            });
        }
        assert!(matches!(run.advance(), StepOutcome::Advanced { .. }));
    }
    velocities(run.simulation())
}

#[test]
fn a_fork_has_the_state_of_a_full_run_of_its_tool() {
    let config = &*WIDE;
    let changes = [acts(config, 0, 60.0, 5.0), acts(config, 10 * SECOND, 80.0, 8.0)];
    let mut ensemble = ensemble(config);
    for change in changes {
        ensemble.hear(told(config, change));
    }
    let why = |forks: Result<Forks, String>| forks.err().unwrap();
    assert!(why(ensemble.fork()).contains("have not begun yet"));
    ensemble.hear(Told::Reached(30 * SECOND));
    ensemble.begin(generation(2));
    found(&mut ensemble, 2);
    assert!(why(ensemble.fork()).contains("have run for 30 s, and need 60 s"));
    ensemble.hear(Told::Reached(60 * SECOND));
    found(&mut ensemble, 2);
    let forks = ensemble.fork().unwrap();
    assert_eq!((forks.time, forks.known()), (60.0, 2));
    assert!((forks.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    for (number, fork) in (0..).zip(&forks.tools) {
        let fork = fork.as_ref().unwrap();
        assert_eq!(
            velocities(fork.run.simulation()),
            alone(config, number, &changes, 60),
            "{number}"
        );
        assert_eq!(fork.shown.inputs, changes[1].1.inputs);
    }
    // The members have run on from where they were forked, and the forks have not.
    let before = forks
        .tools
        .iter()
        .map(|fork| velocities(fork.as_ref().unwrap().run.simulation()));
    let before: Vec<_> = before.collect();
    ensemble.hear(Told::Reached(61 * SECOND));
    found(&mut ensemble, 2);
    let after = ensemble.fork().unwrap();
    for ((before, fork), later) in before.iter().zip(&forks.tools).zip(&after.tools) {
        assert_eq!(velocities(fork.as_ref().unwrap().run.simulation()), *before);
        assert_ne!(velocities(later.as_ref().unwrap().run.simulation()), *before);
    }
    // The twin has run on by more than may count as the present.
    ensemble.hear(Told::Reached(64 * SECOND));
    assert!(why(ensemble.fork()).contains("are 3 s behind the twin"));
    // What one that failed would do is unknown, and counts as much as others.
    let mut failing = self::ensemble(config);
    failing.hear(told(config, changes[0]));
    failing.hear(Told::Reached(60 * SECOND));
    failing.begin(generation(2));
    found(&mut failing, 2);
    failing.places[1].state = State::Failed;
    let forks = failing.fork().unwrap();
    assert_eq!((forks.known(), forks.weights()), (1, vec![0.5, 0.5]));
    assert!(forks.tools[1].as_ref().err().unwrap().contains("unknown"));
    failing.places[0].state = State::Failed;
    assert!(why(failing.fork()).contains("no plausible tool can be computed"));
}

#[test]
fn who_asks_a_running_ensemble_hears_why_there_is_nothing_to_fork_yet() {
    let running = Running::start(ensemble(&WIDE), Pace::Clock).unwrap();
    let forking = running.forking();
    assert!(forking.ask().err().unwrap().contains("have not begun yet"));
    drop(running);
    // The thread has ended: the wait has an end too.
    assert!(forking.ask().err().unwrap().contains("did not answer"));
}
