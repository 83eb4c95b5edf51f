//! The analysis allocates nothing after construction, counted by the allocator itself.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use flexdrill_core::motion::{PlaceSample, WatchedPlace, WhirlAnalysis, WhirlReport, WhirlSettings};
use flexdrill_core::tool::Body;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call is passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promises are those that System asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above; the pointer came from System.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn nothing_is_allocated_per_sample_or_report() {
    let place = |station| WatchedPlace {
        station,
        body: Body::Pipe,
        measured_depth: 0.1,
        inclination: 0.1,
        clearance: 8.5e-3,
        body_diameter: 63e-3,
    };
    let mut analysis = WhirlAnalysis::new(&WhirlSettings::default(), 4e-3, (0..8).map(place).collect());
    let mut samples = [PlaceSample::default(); 8];
    let mut report = WhirlReport::default();
    analysis.report(&mut report);
    let before = COUNT.with(Cell::get);
    for step in 1..5000 {
        let time = f64::from(step) * 4e-3;
        for (index, sample) in samples.iter_mut().enumerate() {
            let (sin, cos) = ((1.0 + index as f64) * 3.0 * time).sin_cos();
            *sample = PlaceSample {
                y: 5e-3 * cos,
                z: 5e-3 * sin,
                normal_force: 6e3,
                contact_share: 0.5,
            };
        }
        analysis.push(time, 4.2, &samples);
        analysis.report(&mut report);
    }
    assert_eq!(COUNT.with(Cell::get), before);
    assert!(report.whirl_ratio.iter().all(|ratio| *ratio > 0.5), "{report:?}");
}
