//! One step and its phases, per size of the tool: `cargo bench -p flexdrill-benches --bench solver`. `docs/solver.md` has
//! the figures and what they mean.
//!
//! The state is one of a tool in motion, with contacts and stops at work. Times are processor time of the thread, so
//! that neighbours on the machine disturb them little.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::dynamics::phases::Phase;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_realtime::monotonic;

const LINKS: [usize; 5] = [8, 16, 33, 66, 132];
const INPUTS: Inputs = Inputs {
    rotary_speed: 4.19,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};
/// Model time that sets the tool in motion (s).
const RUN_UP: f64 = 1.0;

/// Nanoseconds that the thread had a processor.
struct ProcessorTime {
    /// Writes nanoseconds as it does those of the wall.
    wall: WallTime,
}

impl Measurement for ProcessorTime {
    type Intermediate = u64;
    type Value = u64;

    fn start(&self) -> u64 {
        monotonic::processor_time()
    }
    fn end(&self, start: u64) -> u64 {
        monotonic::processor_time() - start
    }
    fn add(&self, a: &u64, b: &u64) -> u64 {
        a + b
    }
    fn zero(&self) -> u64 {
        0
    }
    fn to_f64(&self, value: &u64) -> f64 {
        *value as f64
    }
    fn formatter(&self) -> &dyn ValueFormatter {
        self.wall.formatter()
    }
}

/// A tool of `links` links after its run-up.
fn moving(links: usize) -> Simulation {
    let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../config/default.yaml"))
        .and_then(|config| config.with_links(links))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", 10.0))
        .expect("the shipped configuration");
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).expect("a tool that can be built");
    let steps = (RUN_UP / simulation.settings().time_step) as u64;
    for _ in 0..steps {
        advance(&mut simulation);
    }
    simulation
}

fn advance(simulation: &mut Simulation) {
    assert!(matches!(simulation.advance(&INPUTS), StepOutcome::Advanced { .. }));
}

fn steps(c: &mut Criterion<ProcessorTime>) {
    let mut group = c.benchmark_group("step");
    for links in LINKS {
        let mut simulation = moving(links);
        group.bench_function(BenchmarkId::from_parameter(links), |b| {
            b.iter(|| advance(&mut simulation));
        });
    }
}

/// The phases of a step, on the clock of the whole.
fn parts(c: &mut Criterion<ProcessorTime>) {
    for links in LINKS {
        let mut simulation = moving(links);
        simulation.set_clock(monotonic::processor_time);
        for phase in Phase::ALL {
            c.bench_with_input(BenchmarkId::new(phase.name(), links), &phase, |b, &phase| {
                b.iter_custom(|steps| {
                    let before = simulation.phase_times();
                    for _ in 0..steps {
                        advance(&mut simulation);
                    }
                    simulation.phase_times().since(&before).of(phase)
                });
            });
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(50).with_measurement(ProcessorTime { wall: WallTime });
    targets = steps, parts
}
criterion_main!(benches);
