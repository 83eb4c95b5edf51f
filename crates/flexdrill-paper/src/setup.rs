//! Running a case and recording it.

use super::error::{ENERGY_LIMIT, ITERATION_LIMIT, PaperError};
use super::record::{Record, Recorder};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// A configuration at constant inputs, from rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// Tool, well, solver.
    pub config: Config,
    /// Rotary speed (r/min).
    pub rotary_speed_rpm: f64,
    /// Weight on bit (kN), on from the start.
    pub weight_on_bit_kn: f64,
    /// Turns of the drive at full speed before recording, in which the vibration of the run-up decays.
    pub settling_turns: f64,
    /// Turns recorded.
    pub turns: f64,
    /// Samples per second; rounded to whole steps.
    pub sample_rate: f64,
    /// Whether the run ends early when steps take too many iterations, so that a search does not spend its time on one
    /// tool.
    pub impatient: bool,
}

/// Rotary speed of the paper (r/min), for configurations that begin at rest.
const PAPER_RPM: f64 = 40.0;
/// Weight on bit (kN) where the configuration has none.
const USUAL_KN: f64 = 10.0;
/// Steps before [`Setup::impatient`] judges.
const PATIENCE: u64 = 400;

impl Setup {
    /// The configuration at its initial inputs, or at 40 r/min and 10 kN where these are zero.
    pub fn new(config: Config) -> Self {
        let given = |value: f64, otherwise: f64| if value > 0.0 { value } else { otherwise };
        Self {
            rotary_speed_rpm: given(config.inputs.rotary_speed.initial_rpm, PAPER_RPM),
            weight_on_bit_kn: given(config.inputs.weight_on_bit.initial_kn, USUAL_KN),
            config,
            settling_turns: 2.0,
            turns: 8.0,
            sample_rate: 250.0,
            impatient: false,
        }
    }

    /// Model time until recording begins and until the end (s).
    pub fn times(&self) -> [f64; 2] {
        let turn = 60.0 / self.rotary_speed_rpm;
        let run_up = self.rotary_speed_rpm / self.config.inputs.rotary_speed.slew_rpm_per_s;
        let begin = run_up + self.settling_turns * turn;
        [begin, begin + self.turns * turn]
    }
}

/// Runs a case; `progress` receives the model time (s) at intervals.
///
/// # Errors
/// When the configuration is refused, a step fails, or the energy audit does.
pub fn record(case: &Setup, mut progress: impl FnMut(f64)) -> Result<Record, PaperError> {
    // Turns are the unit of the record, so a standing tool has none.
    if case.rotary_speed_rpm.is_nan() || case.rotary_speed_rpm <= 0.0 {
        return Err(PaperError::Standing {
            rpm: case.rotary_speed_rpm,
        });
    }
    // The run begins at speed and under load: the paper shows the settled motion and no run-up.
    let config = case
        .config
        .with_value("inputs.weight_on_bit.initial_kn", case.weight_on_bit_kn)?
        .with_value("inputs.rotary_speed.initial_rpm", case.rotary_speed_rpm)?;
    let settings = config.simulation();
    let mut simulation = Simulation::new(&config.tool(), &settings)?;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(case.rotary_speed_rpm),
        weight_on_bit: kn_to_n(case.weight_on_bit_kn),
        ..Inputs::default()
    };
    let dt = settings.time_step;
    // The sampling rate is rounded to whole steps; the record has the interval that results.
    let per_sample = (1.0 / (case.sample_rate * dt)).round().max(1.0) as u64;
    let mut recorder = Recorder::new(&simulation, inputs.rotary_speed, dt, per_sample);
    let [begin, end] = case.times().map(|time| (time / dt).round() as u64);
    // Whole samples.
    let end = begin + (end - begin) / per_sample * per_sample;
    while simulation.step() < end {
        if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
            return Err(PaperError::Step { failure });
        }
        let step = simulation.step();
        let iterations = simulation.solver_counters().newton_iterations;
        // In a search a case that needs many iterations would cost as much as several others.
        if case.impatient && step >= PATIENCE && iterations > ITERATION_LIMIT * step {
            return Err(PaperError::Slow {
                iterations,
                steps: step,
            });
        }
        // The settling turns are not part of the record.
        if step > begin {
            recorder.after_step(&simulation);
        }
        if step.is_multiple_of(100) {
            progress(simulation.time());
        }
    }
    let record = recorder.finish(&simulation);
    // A run that does not keep its energy proves nothing, whatever its figures say.
    if record.energy_error() > ENERGY_LIMIT {
        return Err(PaperError::Energy {
            error: record.energy.error,
            drive: record.energy.drive,
        });
    }
    Ok(record)
}
