//! `--cases batch`: how many members of look-aheads, maps and sweeps the machine runs, alone and next to a live run.
//!
//! A member is a fork of a run that has come to its motion. Members run on idle threads. The live run
//! keeps the node's period at the node's priority and counts the deadlines that it misses.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::machine;
use super::measure::Load;
use super::table::Table;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_realtime::{Pacer, monotonic};

/// Model time of the run before it is forked (s): the speed has been reached and the pipe moves.
const RUN_UP: f64 = 5.0;
/// Period of the live run (s), as in the node.
const PERIOD: f64 = 5e-3;
/// Periods of lateness that the live run catches up.
const TOLERANCE: u64 = 20;
/// Lateral velocities by which members differ (m/s), as those of a look-ahead.
const DISTURBANCE: f64 = 1e-5;
/// Model time of a member of a map (s), in which the results are given too.
const MEMBER: f64 = 60.0;

/// How members share threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Mode {
    threads: usize,
    /// Members that a thread advances in turn, a step each.
    in_turn: usize,
    live: bool,
}

/// What a mode came to.
struct Measured {
    /// Model time of all members (s).
    model: f64,
    /// Wall time (s).
    wall: f64,
    /// Processor time of all members (s).
    processor: f64,
    /// Deadlines of the live run: missed, of so many.
    deadlines: Option<[u64; 2]>,
}

/// Runs all modes, each for `duration` (s) of wall time and announced to `say`; gives the table.
///
/// # Errors
/// When the tool cannot be built, or a step fails.
pub fn tables(config: &Config, load: Load, duration: f64, mut say: impl FnMut(&str)) -> anyhow::Result<String> {
    let config = config.with_value("inputs.weight_on_bit.initial_kn", load.wob)?;
    let mut run = Simulation::with_solver(
        &config.tool(),
        &config.simulation(),
        SolverKind::default(),
        load.instructions,
    )?;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(load.rpm),
        weight_on_bit: kn_to_n(load.wob),
        ..Inputs::default()
    };
    say(&format!("{RUN_UP} s of model time until the run is forked"));
    // The speed must have been reached before the fork: members at rest
    // would cost fewer iterations than those of a look-ahead.
    advance(&mut run, &inputs, (RUN_UP / config.solver.time_step).round() as u64)?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    // Model time per wall time is what a user waits for; per processor time shows whether threads hinder each other.
    let mut table = Table::new([
        "threads",
        "members in turn on a thread",
        "live run",
        "model time per wall time",
        "per processor time",
        "members of 60 s per minute",
        "deadlines missed",
    ]);
    let mut modes = Vec::new();
    // Powers of two show the trend; all counts between them would take long on a large machine.
    for live in [false, true] {
        for threads in (1..=cores).filter(|threads| threads.is_power_of_two()) {
            // Two members in turn on one thread show what the cache loses by a second state. Once is enough.
            let in_turn = if threads == 1 && !live { &[1, 2][..] } else { &[1] };
            modes.extend(in_turn.iter().map(|&in_turn| Mode { threads, in_turn, live }));
        }
    }
    for mode in modes {
        say(&format!("{mode:?}: {duration} s"));
        let measured = measure(&run, &inputs, mode, duration)?;
        let factor = measured.model / measured.wall;
        table.row([
            mode.threads.to_string(),
            mode.in_turn.to_string(),
            if mode.live { "yes" } else { "no" }.to_owned(),
            format!("{factor:.2}"),
            format!("{:.2}", measured.model / measured.processor),
            // The unit of a map: members of a minute of model time, by the minute.
            format!("{:.1}", 60.0 * factor / MEMBER),
            measured
                .deadlines
                .map_or("-".to_owned(), |[missed, of]| format!("{missed} of {of}")),
        ]);
    }
    Ok(format!(
        "Forks at {} r/min and {} kN, {duration} s of wall time each; {} links x {} elements, step {} ms.\n\n{}",
        load.rpm,
        load.wob,
        config.tool.links,
        config.tool.elements_per_link,
        1e3 * config.solver.time_step,
        table.text()
    ))
}

/// The section of a document that [`tables`] of the configuration `name` make.
pub fn section(name: &str, duration: f64, tables: &str) -> String {
    format!(
        "Command: `flexdrill bench --cases batch --duration {duration}`, `{name}`. {}\n\n{tables}",
        machine::describe()
    )
}

fn advance(simulation: &mut Simulation, inputs: &Inputs, steps: u64) -> anyhow::Result<()> {
    for _ in 0..steps {
        if let StepOutcome::Failed(failure) = simulation.advance(inputs) {
            anyhow::bail!("a step failed at model time {:.4} s: {failure}", failure.time);
        }
    }
    Ok(())
}

fn measure(run: &Simulation, inputs: &Inputs, mode: Mode, duration: f64) -> anyhow::Result<Measured> {
    let stop = AtomicBool::new(false);
    let (steps, processor) = (AtomicU64::new(0), AtomicU64::new(0));
    let step = run.settings().time_step;
    // Forks are made before the time begins.
    let members: Vec<Vec<Simulation>> = (0..mode.threads)
        .map(|thread| {
            let of_thread = (0..mode.in_turn).map(|number| member(run, thread * mode.in_turn + number));
            of_thread.collect()
        })
        .collect();
    let (wall, deadlines) = std::thread::scope(|scope| {
        let workers: Vec<_> = members
            .into_iter()
            .map(|members| scope.spawn(|| work(members, inputs, &stop, &steps, &processor)))
            .collect();
        let began = monotonic::now();
        let deadlines = if mode.live {
            live(run.fork(), inputs, duration).map(Some)
        } else {
            std::thread::sleep(std::time::Duration::from_secs_f64(duration));
            Ok(None)
        };
        stop.store(true, Ordering::Relaxed);
        let wall = (monotonic::now() - began) as f64 * 1e-9;
        for worker in workers {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        }
        anyhow::Ok((wall, deadlines?))
    })?;
    Ok(Measured {
        model: steps.load(Ordering::Relaxed) as f64 * step,
        wall,
        processor: processor.load(Ordering::Relaxed) as f64 * 1e-9,
        deadlines,
    })
}

/// A fork that parts from the others.
fn member(run: &Simulation, number: usize) -> Simulation {
    let mut fork = run.fork();
    let mut state = 2 * number as u64 + 1;
    fork.disturb(|| {
        // Any sequence will do that differs by member (a step of a linear congruential generator, Knuth's constants).
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        DISTURBANCE * ((state >> 33) as f64 / f64::from(1u32 << 30) - 1.0)
    });
    fork
}

/// Advances members in turn until `stop` is set.
fn work(
    mut members: Vec<Simulation>,
    inputs: &Inputs,
    stop: &AtomicBool,
    steps: &AtomicU64,
    processor: &AtomicU64,
) -> anyhow::Result<()> {
    // As the threads of a look-ahead; it is a hint.
    let _ = rustix::process::nice(19);
    let before = monotonic::processor_time();
    let mut taken = 0;
    while !stop.load(Ordering::Relaxed) {
        for member in &mut members {
            advance(member, inputs, 1)?;
            taken += 1;
        }
    }
    steps.fetch_add(taken, Ordering::Relaxed);
    processor.fetch_add(monotonic::processor_time() - before, Ordering::Relaxed);
    Ok(())
}

/// Keeps real time for `duration` (s); deadlines missed, of so many.
fn live(mut simulation: Simulation, inputs: &Inputs, duration: f64) -> anyhow::Result<[u64; 2]> {
    let per_period = (PERIOD / simulation.settings().time_step).round().max(1.0) as u64;
    let periods = (duration / PERIOD).round() as u64;
    let mut pacer = Pacer::new(monotonic::now(), PERIOD, TOLERANCE);
    let mut count = 0;
    while count < periods {
        monotonic::sleep_until(pacer.deadline());
        advance(&mut simulation, inputs, per_period)?;
        count += 1 + pacer.step_done(monotonic::now()).skipped;
    }
    Ok([pacer.misses() + pacer.skipped(), count])
}
