//! One run at constant inputs as fast as it goes, with its times.

use hdrhistogram::Histogram;

use super::figures::Figures;
use flexdrill_config::Config;
use flexdrill_core::Instructions;
use flexdrill_core::dynamics::phases::{Phase, PhaseTimes};
use flexdrill_core::dynamics::{Energies, StepFailure, StepOutcome};
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::twin::{Simulation, Snapshot, SolverCounters};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_realtime::monotonic;

/// Model time in one published frame (s).
const FRAME: f64 = 0.02;
/// Longest time resolved (ns): a minute.
const LONGEST: u64 = 60_000_000_000;

/// What is run.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    /// Rotary speed (r/min).
    pub rpm: f64,
    /// Weight on bit (kN), on from the static start.
    pub wob: f64,
    /// Vector instructions to use.
    pub instructions: Instructions,
}

/// What a run came to.
pub struct Measured {
    /// Wall time of the static start (s).
    pub start: f64,
    /// Degrees of freedom.
    pub unknowns: usize,
    /// Time step (s).
    pub time_step: f64,
    /// Steps taken.
    pub steps: u64,
    /// Wall time of steps and frames (s).
    pub wall: f64,
    /// This thread's processor time of steps and frames (s).
    pub processor: f64,
    /// Times of single steps (ns).
    pub step_times: Histogram<u64>,
    /// Times of frames of 20 ms (ns).
    pub frame_times: Histogram<u64>,
    /// Time per phase.
    pub phases: PhaseTimes,
    /// The solver's counters.
    pub counters: SolverCounters,
    /// Most corrections of a step.
    pub most_iterations: u32,
    /// Energy since the start.
    pub energy: Energies,
    /// Figures of the motion.
    pub figures: Figures,
    /// The last snapshot.
    pub last: Snapshot,
    /// Where the run ended, if a step failed.
    pub failure: Option<StepFailure>,
}

impl Measured {
    /// Model time per wall time.
    pub fn real_time_factor(&self) -> f64 {
        self.steps as f64 * self.time_step / self.wall
    }

    /// Model time per processor time.
    pub fn processor_factor(&self) -> f64 {
        self.steps as f64 * self.time_step / self.processor
    }

    /// Newton iterations per step.
    pub fn iterations(&self) -> f64 {
        self.counters.newton_iterations as f64 / self.steps.max(1) as f64
    }

    /// Energy error over the drive's work (%).
    pub fn energy_error(&self) -> f64 {
        100.0 * self.energy.error.abs() / self.energy.drive.abs().max(f64::MIN_POSITIVE)
    }

    /// Mean processor time of a step (us).
    pub fn step_time(&self) -> f64 {
        1e6 * self.processor / self.steps.max(1) as f64
    }

    /// Mean per step of one phase (us): its share of the wall time, of the processor time. So neighbours on the machine
    /// do not count.
    pub fn phase(&self, phase: Phase) -> f64 {
        self.step_time() * self.phases.of(phase) as f64 / self.phases.total().max(1) as f64
    }
}

/// Median, p99, p99.9 and longest (ms).
pub fn percentiles(times: &Histogram<u64>) -> [f64; 4] {
    let at = |q: f64| times.value_at_quantile(q) as f64 * 1e-6;
    [at(0.5), at(0.99), at(0.999), times.max() as f64 * 1e-6]
}

/// Runs `config` for `duration` (s) of model time after the static start; `every_frame` gets the model time.
///
/// # Errors
/// When the tool cannot be built. A step that fails ends the run and is part of the result.
pub fn run(config: &Config, load: Load, duration: f64, mut every_frame: impl FnMut(f64)) -> anyhow::Result<Measured> {
    // The tool starts under its load, so that the static start is the one that the node would have.
    let config = config.with_value("inputs.weight_on_bit.initial_kn", load.wob)?;
    // The clock around the construction shows the static start, which has no steps.
    let began = monotonic::now();
    let mut simulation = Simulation::with_solver(
        &config.tool(),
        &config.simulation(),
        SolverKind::default(),
        load.instructions,
    )?;
    let start = seconds(monotonic::now() - began);
    simulation.set_clock(monotonic::now);
    let time_step = simulation.settings().time_step;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(load.rpm),
        weight_on_bit: kn_to_n(load.wob),
        ..Inputs::default()
    };
    let mut last = simulation.new_snapshot();
    let mut figures = Figures::new(&last);
    // A histogram instead of a list: the tail counts, and its memory does not grow with the run.
    let mut step_times = Histogram::<u64>::new_with_bounds(1, LONGEST, 3)?;
    let mut frame_times = step_times.clone();
    // A frame is the snapshot of 20 ms that the node publishes; the step alone would hide its cost.
    let per_frame = (FRAME / time_step).round().max(1.0) as u64;
    let total = (duration / time_step).round() as u64;
    let (mut steps, mut busy, mut frame) = (0, 0, 0);
    let mut most_iterations = 0;
    let mut failure = None;
    let mut aside = 0;
    let processor = monotonic::processor_time();
    while steps < total {
        // The clock is read around each step. Sums from one reading to the
        // next would have the figures and the output in them.
        let before = monotonic::now();
        let outcome = simulation.advance(&inputs);
        let mut took = monotonic::now() - before;
        match outcome {
            StepOutcome::Advanced { iterations, .. } => most_iterations = most_iterations.max(iterations),
            StepOutcome::Failed(failed) => {
                failure = Some(failed);
                break;
            }
        }
        steps += 1;
        step_times.saturating_record(took);
        let ends_frame = steps % per_frame == 0;
        if ends_frame {
            let before = monotonic::now();
            simulation.snapshot(&mut last, true);
            took += monotonic::now() - before;
        }
        busy += took;
        frame += took;
        if ends_frame {
            frame_times.saturating_record(frame);
            frame = 0;
            // What the bench itself does is not the model's.
            let before = monotonic::processor_time();
            // The first quarter is the run-up to speed, and does not belong to the figures.
            if steps * 4 >= total {
                figures.add(&last);
            }
            let time = steps as f64 * time_step;
            every_frame(time);
            aside += monotonic::processor_time() - before;
        }
    }
    let processor = monotonic::processor_time() - processor - aside;
    Ok(Measured {
        start,
        unknowns: simulation.degrees_of_freedom(),
        time_step,
        steps,
        wall: seconds(busy),
        processor: seconds(processor),
        step_times,
        frame_times,
        phases: simulation.phase_times(),
        counters: simulation.solver_counters(),
        most_iterations,
        energy: *simulation.energy(),
        figures,
        last,
        failure,
    })
}

fn seconds(nanoseconds: u64) -> f64 {
    nanoseconds as f64 * 1e-9
}
