//! Steps that a client orders of a model that is paused.

use super::*;

/// A bench whose steps are divided as the motion needs, paused before its first step.
fn paused() -> Bench {
    let mut bench = Bench::new();
    let settings = settings().with(|settings| settings.step = StepRule::Auto);
    let mut simulation = Simulation::new(&tool(), &settings).unwrap();
    simulation.set_clock(monotonic::now);
    bench.solver.run = Run::new(simulation, Schedule::new(1e-3, |_| 100.0));
    bench.requests.commands.push(Command::Pause(true)).unwrap();
    bench.period(0);
    bench
}

/// Orders steps, and runs periods until they are taken, and some more. The snapshots of the frames that were published.
fn ordered(bench: &mut Bench, steps: u64) -> Vec<Snapshot> {
    bench.requests.commands.push(Command::Step(steps)).unwrap();
    let mut found = Vec::new();
    for _ in 0..steps.div_ceil(5) + 2 {
        // Each period is as late as can be caught up: the pace of the machine decides nothing here.
        bench.period(6 * MS);
        while let Ok(event) = bench.publisher.events.pop() {
            match event {
                LoopEvent::Frame(frame) => {
                    found.push(frame.snapshot.clone());
                    bench.publisher.empty.push(frame).unwrap();
                }
                LoopEvent::Applied { inputs, .. } => assert!(!inputs.reset),
                other => panic!("{other:?}"),
            }
        }
    }
    let order = bench.gauges.order();
    assert_eq!((order.left, order.end), (0, OrderEnd::Done));
    assert_eq!(bench.gauges.run_state(), RunState::Paused);
    found
}

#[test]
fn ordered_steps_are_the_same_however_they_are_divided() {
    let (mut one, mut each, mut some) = (paused(), paused(), paused());
    for bench in [&one, &each, &some] {
        bench.speed(12.0);
    }
    let at_once = ordered(&mut one, 60);
    let singly: Vec<Snapshot> = (0..60).flat_map(|_| ordered(&mut each, 1)).collect();
    let mixed: Vec<Snapshot> = [7, 1, 30, 22]
        .into_iter()
        .flat_map(|steps| ordered(&mut some, steps))
        .collect();
    let steps: Vec<u64> = at_once.iter().map(|snapshot| snapshot.step).collect();
    assert_eq!(steps, [0, 10, 20, 30, 40, 50, 60]);
    // As text, in which a NaN equals a NaN and different numbers have different digits.
    let text = |snapshots: &[Snapshot]| format!("{snapshots:?}");
    assert!(text(&at_once) == text(&singly) && text(&at_once) == text(&mixed));
    let state = |bench: &Bench| bench.solver.run.simulation().checkpoint().unwrap();
    assert!(state(&one) == state(&each) && state(&one) == state(&some));
    let run = &one.solver.run;
    assert_eq!(run.applied().refinement, run.wanted_refinement());
}

#[test]
fn an_order_takes_its_steps_and_no_more_and_other_commands_end_it() {
    let mut bench = paused();
    let step = |bench: &Bench| bench.gauges.step.load(Ordering::Relaxed);
    ordered(&mut bench, 3);
    assert_eq!(step(&bench), 3);
    // A period takes five of them; what is left of a period is skipped, so that stamps follow the clock.
    let ticks = bench.gauges.ticks.load(Ordering::Relaxed);
    bench.requests.commands.push(Command::Step(100)).unwrap();
    bench.period(0);
    let order = bench.gauges.order();
    assert_eq!((order.command, order.left, order.end), (3, 95, OrderEnd::Open));
    assert_eq!(
        bench.gauges.commands.load(Ordering::Relaxed),
        3,
        "a pause and two orders"
    );
    for ending in [
        Command::StopSteps,
        Command::Pause(true),
        Command::Pause(false),
        Command::Reset,
    ] {
        bench.requests.commands.push(Command::Pause(true)).unwrap();
        bench.requests.commands.push(Command::Step(100)).unwrap();
        bench.period(0);
        bench.requests.commands.push(ending).unwrap();
        bench.period(0);
        let order = bench.gauges.order();
        assert_eq!((order.left, order.end), (95, OrderEnd::Stopped));
    }
    assert_eq!(bench.gauges.ticks.load(Ordering::Relaxed), ticks + 9 * 5);
    // A model that runs takes no orders.
    bench.requests.commands.push(Command::Pause(false)).unwrap();
    bench.requests.commands.push(Command::Step(7)).unwrap();
    bench.period(0);
    let order = bench.gauges.order();
    assert_eq!((order.left, order.end), (7, OrderEnd::Stopped));
}

#[test]
fn a_failed_step_ends_the_order_and_the_next_order_tries_again() {
    let mut bench = paused();
    bench.speed(TOO_FAST);
    bench.requests.commands.push(Command::Step(8)).unwrap();
    bench.period(0);
    let order = bench.gauges.order();
    assert_eq!((order.left, order.end), (8, OrderEnd::Failed));
    bench.period(0);
    bench.speed(2.0);
    bench.period(0);
    assert_eq!(
        bench.gauges.step.load(Ordering::Relaxed),
        0,
        "nothing moves without an order"
    );
    bench.requests.commands.push(Command::Step(8)).unwrap();
    bench.period(0);
    bench.period(0);
    assert_eq!(bench.gauges.order().end, OrderEnd::Done);
    assert_eq!(bench.gauges.step.load(Ordering::Relaxed), 8);
    let reports = bench.reports();
    assert!(reports.contains(&"recovered".to_owned()), "{reports:?}");
}

/// The state travels to the requester in the room that it gave.
#[test]
fn a_state_that_is_asked_for_comes_back_in_its_slot() {
    let mut bench = Bench::new();
    bench.speed(4.0);
    bench.period(MS);
    for (number, room) in [(1, 16), (2, 4 << 20)] {
        let mut slot = StateSlot::new(room);
        slot.number = number;
        bench.requests.commands.push(Command::State(slot)).unwrap();
        let run = &bench.solver.run;
        let (expected, applied) = (run.simulation().checkpoint().unwrap(), run.applied());
        bench.period(MS);
        let slot = bench.requests.states.pop().unwrap();
        assert_eq!((slot.number, slot.applied), (number, Some(applied)));
        match slot.checkpoint() {
            Ok(bytes) => assert!(number == 2 && bytes == expected),
            Err(error) => assert!(
                number == 1 && error.to_string().contains("longer than the 16 bytes"),
                "{error}"
            ),
        }
    }
    // Without a listener nothing is held up.
    for _ in 0..20 {
        bench
            .requests
            .commands
            .push(Command::State(StateSlot::new(16)))
            .unwrap();
        bench.period(MS);
    }
    assert!(bench.gauges.steps_taken.load(Ordering::Relaxed) > 100);
}
