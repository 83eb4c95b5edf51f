//! Once the tool is built, advancing it and looking at it allocate nothing.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]
#![allow(unsafe_code)] // the allocator that counts

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, ToolDescription};
use flexdrill_core::twin::Simulation;
use flexdrill_motion::{StationSample, WatchedStation, WhirlAnalysis, WhirlReport, WhirlSettings};
use support::{clock, coarse, hard_settings, simulation};

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

fn advances_without_allocation(tool: &ToolDescription) {
    let mut simulation = simulation(tool);
    let mut snapshot = simulation.new_snapshot();
    let inputs = Inputs {
        rotary_speed: 4.19,
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    simulation.advance(&inputs).ok().unwrap();
    let before = ALLOCATIONS.get();
    // Long enough for contacts, stops, evaluations of the whirl analysis and a slew of both inputs.
    for step in 0..2000 {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        if step % 40 == 0 {
            simulation.snapshot(&mut snapshot, true);
        }
    }
    assert_eq!(ALLOCATIONS.get() - before, 0);
}

#[test]
fn advance_and_snapshot_allocate_nothing() {
    advances_without_allocation(&ToolDescription::paper());
    // Slots that open and close.
    advances_without_allocation(&ToolDescription::paper().with(|tool| {
        (tool.guide_bending_factor, tool.guide_slots_close_at) = (0.05, Some(0.01));
    }));
    // And the counter counts.
    let before = ALLOCATIONS.get();
    drop(std::hint::black_box(vec![1_u8; 100]));
    assert_eq!(ALLOCATIONS.get() - before, 1);
}

#[test]
fn steps_that_are_halved_or_fail_allocate_nothing() {
    // Large steps and two corrections per sub-step: too few for a collision, so that steps are halved, and fail in the
    // end.
    let mut simulation = Simulation::new(&coarse(), &hard_settings(2, 3)).unwrap();
    simulation.set_clock(clock);
    let inputs = Inputs {
        rotary_speed: 4.19,
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    let before = ALLOCATIONS.get();
    let failed = (0..500)
        .filter(|_| matches!(simulation.advance(&inputs), StepOutcome::Failed(_)))
        .count();
    assert_eq!(ALLOCATIONS.get() - before, 0);
    assert!(failed > 0 && simulation.solver_counters().halved_steps > 0);
}

#[test]
fn nothing_is_allocated_per_sample_or_report() {
    let watched = |station| WatchedStation {
        station,
        body: Body::Pipe,
        measured_depth: 0.1,
        inclination: 0.1,
        clearance: 8.5e-3,
        body_diameter: 63e-3,
        length: 0.03,
    };
    let mut analysis = WhirlAnalysis::new(&WhirlSettings::default(), 4e-3, (0..8).map(watched).collect());
    let mut samples = [StationSample::default(); 8];
    let mut report = WhirlReport::default();
    analysis.report(&mut report);
    let before = ALLOCATIONS.get();
    for step in 1..5000 {
        let time = f64::from(step) * 4e-3;
        for (index, sample) in samples.iter_mut().enumerate() {
            let (sin, cos) = ((1.0 + index as f64) * 3.0 * time).sin_cos();
            *sample = StationSample {
                y: 5e-3 * cos,
                z: 5e-3 * sin,
                normal_force: 6e3,
                contact_share: 0.5,
                impulse: 1.0,
                friction_work: 0.1,
            };
        }
        analysis.push(time, 4.2, &samples);
        analysis.report(&mut report);
    }
    assert_eq!(ALLOCATIONS.get(), before);
    assert!(report.whirl_ratio.iter().all(|ratio| *ratio > 0.5), "{report:?}");
}
