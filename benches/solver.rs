//! One step and its parts, per size of the tool: `cargo bench --bench solver`. Figures and what they mean:
//! `docs/solver.md`.
//!
//! The state is one of a tool in motion, with contacts and stops at work. Times are processor time of the thread, so
//! that neighbours on the machine disturb them little.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::hint::black_box;

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BatchSize, Bencher, BenchmarkId, Criterion, criterion_group, criterion_main};
use flexdrill_config::Config;
use flexdrill_core::dynamics::assembly::Assembler;
use flexdrill_core::dynamics::outcome::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::linear::{BlockLu, CondensedElimination, LinearSolver, Operator};
use flexdrill_core::twin::Simulation;
use flexdrill_realtime::monotonic;

const LINKS: [usize; 5] = [8, 16, 33, 66, 132];
const INPUTS: Inputs = Inputs {
    rotary_speed: 4.19,
    weight_on_bit: 10e3,
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
    let config = Config::load("config/default.yaml")
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

fn parts(c: &mut Criterion<ProcessorTime>) {
    for links in LINKS {
        let simulation = moving(links);
        let stepper = simulation.stepper();
        let (model, state) = (stepper.model(), stepper.state());
        let conditions = stepper.conditions(simulation.time(), INPUTS.weight_on_bit);
        let settings = simulation.settings();
        let factors = settings.scheme.factors(settings.time_step);
        let mut assembler = Assembler::new(model);
        let mut bench = |part: &str, routine: &mut dyn FnMut(&mut Bencher<'_, ProcessorTime>)| {
            c.bench_with_input(BenchmarkId::new(part, links), &(), |b, ()| routine(b));
        };
        bench("residual", &mut |b| {
            b.iter(|| assembler.residual(model, black_box(state), &conditions));
        });
        bench("tangent", &mut |b| {
            b.iter(|| assembler.tangent(model, black_box(state), &conditions, factors));
        });
        // What an iteration on condensed links needs of it.
        bench("linearise", &mut |b| {
            b.iter(|| assembler.linearise(model, black_box(state), factors));
        });
        // Once per step size.
        let lasting = assembler.lasting(model, &conditions, factors);
        bench("condense", &mut |b| {
            b.iter_batched(
                || lasting.clone(),
                |lasting| Operator::of(lasting, &model.joint_stations),
                BatchSize::SmallInput,
            );
        });
        assembler.residual(model, state, &conditions);
        assembler.drop_reactions(model);
        assembler.tangent(model, state, &conditions, factors);
        let rhs = assembler.residual.clone();
        let mut stations = StationElimination::new(&model.layout);
        bench("factor and solve, stations", &mut |b| {
            b.iter_batched_ref(
                || rhs.clone(),
                |x| stations.solve(black_box(&assembler.system), x),
                BatchSize::SmallInput,
            );
        });
        let operator = Operator::of(lasting, &model.joint_stations).expect("joints that can be condensed");
        let mut condensed = CondensedElimination::new(&model.layout, &model.joint_stations);
        bench("factor and solve, condensed", &mut |b| {
            b.iter_batched_ref(
                || rhs.clone(),
                |x| condensed.solve(black_box(&operator), &assembler.changes, x),
                BatchSize::SmallInput,
            );
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(50).with_measurement(ProcessorTime { wall: WallTime });
    targets = steps, parts
}
criterion_main!(benches);
