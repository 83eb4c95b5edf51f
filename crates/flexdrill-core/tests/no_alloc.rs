//! Once the tool is built, advancing it and looking at it allocate nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use flexdrill_config::Config;
use flexdrill_core::dynamics::outcome::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: all calls go to the system's allocator; counting touches a thread-local cell that needs no allocation itself.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn advance_and_snapshot_allocate_nothing() {
    let config = Config::load("../../config/default.yaml").unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut snapshot = simulation.new_snapshot();
    let inputs = Inputs {
        rotary_speed: 4.19,
        weight_on_bit: 10e3,
    };
    simulation.advance(&inputs);
    let before = ALLOCATIONS.get();
    // Long enough for contacts, stops, evaluations of the whirl analysis and a slew of both inputs.
    for step in 0..2000 {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        if step % 40 == 0 {
            simulation.snapshot(&mut snapshot, true);
        }
    }
    assert_eq!(ALLOCATIONS.get() - before, 0);
    // And the counter counts.
    drop(std::hint::black_box(vec![1_u8; 100]));
    assert_eq!(ALLOCATIONS.get() - before, 1);
}

#[test]
fn steps_that_are_halved_or_fail_allocate_nothing() {
    // Large steps and two corrections per sub-step: too few for a collision, so that steps are halved, and fail in the end.
    let config = Config::load("../../config/coarse.yaml")
        .and_then(|config| config.with_value("solver.time_step", 0.002))
        .and_then(|config| config.with_value("solver.max_iterations", 2))
        .and_then(|config| config.with_value("solver.max_halvings", 3))
        .unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    simulation.set_clock(flexdrill_realtime::monotonic::now);
    let inputs = Inputs {
        rotary_speed: 4.19,
        weight_on_bit: 10e3,
    };
    let before = ALLOCATIONS.get();
    let failed = (0..500)
        .filter(|_| matches!(simulation.advance(&inputs), StepOutcome::Failed(_)))
        .count();
    assert_eq!(ALLOCATIONS.get() - before, 0);
    assert!(failed > 0 && simulation.stepper().counters().halved_steps > 0);
}
