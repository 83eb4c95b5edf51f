//! One run, sampled for comparison.

use std::panic::resume_unwind;

use super::{NUDGES, StepErrorFailure};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, Direction};
use flexdrill_core::twin::{ModelQuality, Simulation};
use flexdrill_core::units::n_to_kn;
use flexdrill_motion::Transfer;

/// Contact forces are averaged over about this (s).
const INTERVAL: f64 = 0.02;
/// Model time between two readings of the whirl ratios (s). The window of the analysis is longer, so that more frequent
/// readings add nothing.
const WHIRL_EVERY: f64 = 0.5;

/// Inputs and duration of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Constant inputs; the weight is on before the start, so that the run begins at rest under it.
    pub inputs: Inputs,
    /// Model time after the static start (s).
    pub duration: f64,
    /// Time over which forces are averaged and after which the rest is sampled (s), a whole number of steps.
    pub interval: f64,
}

impl Course {
    /// With intervals of some 20 ms that are whole numbers of `config`'s steps, and so of steps that are a whole part
    /// of them.
    pub fn of(config: &Config, inputs: Inputs, duration: f64) -> Self {
        let step = config.solver.time_step;
        Self {
            inputs,
            duration,
            interval: (INTERVAL / step).round().max(1.0) * step,
        }
    }
}

/// Sums of torque and weight at surface, kick-off and bit.
#[derive(Debug, Default)]
struct Transferred {
    sums: [[f64; 3]; 2],
    count: f64,
}

impl Transferred {
    fn add(&mut self, transfer: &Transfer) {
        for (sums, means) in self.sums.iter_mut().zip([&transfer.torque.mean, &transfer.weight.mean]) {
            sums.iter_mut().zip(means).for_each(|(sum, mean)| *sum += mean);
        }
        self.count += 1.0;
    }

    /// Means of torque and weight; NaN without a window.
    fn means(&self) -> [[f64; 3]; 2] {
        self.sums.map(|sums| sums.map(|sum| sum / self.count))
    }
}

/// What is compared, sampled at the end of every interval. Stations of the layers: all of pipe-guide, then all of
/// guide-wall.
#[derive(Debug, Clone, Default)]
pub struct Record {
    /// Bit speed (rad/s).
    pub bit_speed: Vec<f64>,
    /// Both lateral coordinates of every joint (m).
    pub positions: Vec<Vec<f64>>,
    /// Normal forces, averaged over the interval (N).
    pub forces: Vec<Vec<f64>>,
    /// Root mean square of the normal forces after the run-up, the first quarter (N).
    pub rms: Vec<f64>,
    /// Mean whirl ratio over time and stations, after the run-up.
    pub whirl_ratio: f64,
    /// Mean torque at surface, kick-off and bit (N m) after the run-up, over the sliding windows of the simulation's
    /// transfer that lie behind it. NaN where the tool has none, or where no window fits.
    pub torque: [f64; 3],
    /// Mean weight at surface, kick-off and bit (N) over the same windows.
    pub weight: [f64; 3],
    /// Energy that the integration has gained or lost (J).
    pub energy_error: f64,
    /// Work of the drive (J).
    pub drive_work: f64,
    /// Newton iterations per second of model time.
    pub iterations: f64,
    /// As the simulation judged it after the run-up, at every interval.
    pub qualities: Vec<ModelQuality>,
}

impl Record {
    /// Runs `config`; during the first interval the weight on bit is greater by `nudge` (N).
    ///
    /// # Errors
    /// When the tool cannot be built or a step fails.
    pub fn run(config: &Config, motion: &Course, nudge: f64) -> Result<Self, StepErrorFailure> {
        let step = config.solver.time_step;
        // The run starts under its weight, so that the nudge is the only disturbance.
        let weight = motion.inputs.weight_on_bit;
        let config = config.with_value("inputs.weight_on_bit.initial_kn", n_to_kn(weight))?;
        let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
        // Runs of different steps are compared at common instants; an interval is a whole number of steps for each.
        let per_interval = (motion.interval / step).round() as usize;
        let intervals = (motion.duration / motion.interval).round() as usize;
        let whirl_every = (WHIRL_EVERY / motion.interval).round().max(1.0) as usize;
        let stations = simulation.last_station() + 1;
        let gaps = 2 * stations;
        let mut record = Self {
            rms: vec![0.0; gaps],
            ..Self::default()
        };
        let mut snapshot = simulation.new_snapshot();
        let mut ratios = (0.0, 0_u32);
        let mut transfer = Transferred::default();
        // The first quarter is the run-up; means of transfer reach back by one window, so they count later.
        let first_window = 0.25 * motion.duration + simulation.settings().transfer.window;
        for interval in 0..intervals {
            let run_up = 4 * interval < intervals;
            let mut mean = vec![0.0; gaps];
            // The nudge shows how far two runs part by chance: a difference
            // by the step must be larger to mean something.
            let inputs = Inputs {
                weight_on_bit: weight + if interval == 0 { nudge } else { 0.0 },
                ..motion.inputs
            };
            for _ in 0..per_interval {
                if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
                    return Err(StepErrorFailure::Step { step, failure });
                }
                // Pipe and guide in one list: the forces of the first half are those of the pipe.
                for (k, mean) in mean.iter_mut().enumerate() {
                    let body = if k < stations { Body::Pipe } else { Body::Guide };
                    let normal = simulation.normal_force(k % stations, body).unwrap_or(f64::NAN);
                    // Means over the interval, since single impacts of two chaotic runs never coincide.
                    *mean += normal / per_interval as f64;
                    if !run_up {
                        record.rms[k] += normal * normal / (per_interval * (intervals - intervals / 4)) as f64;
                    }
                }
            }
            record.sample(&simulation, mean);
            if !run_up {
                record.qualities.push(simulation.quality());
            }
            // The whirl analysis changes slowly, and a snapshot costs more than a step.
            if !run_up && interval % whirl_every == 0 {
                simulation.snapshot(&mut snapshot, false);
                for ratio in snapshot.whirl.whirl_ratio.iter().filter(|ratio| ratio.is_finite()) {
                    ratios = (ratios.0 + ratio, ratios.1 + 1);
                }
                if simulation.time() >= first_window {
                    transfer.add(&snapshot.transfer);
                }
            }
        }
        // Sums become means and roots once, at the end.
        [record.torque, record.weight] = transfer.means();
        record.whirl_ratio = ratios.0 / f64::from(ratios.1.max(1));
        record.rms.iter_mut().for_each(|square| *square = square.sqrt());
        record.energy_error = simulation.energy().error;
        record.drive_work = simulation.energy().drive;
        record.iterations = simulation.solver_counters().newton_iterations as f64 / motion.duration;
        Ok(record)
    }

    /// Three runs of `config`, nudged by [`NUDGES`], each on a thread.
    ///
    /// # Errors
    /// As [`Record::run`].
    pub fn runs(config: &Config, motion: &Course) -> Result<[Self; 3], StepErrorFailure> {
        let [a, b, c] = std::thread::scope(|scope| {
            NUDGES
                .map(|nudge| scope.spawn(move || Self::run(config, motion, nudge)))
                .map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)))
        });
        Ok([a?, b?, c?])
    }

    fn sample(&mut self, simulation: &Simulation, forces: Vec<f64>) {
        let bit = simulation.velocity(simulation.last_station(), Body::Pipe, Direction::Psi);
        self.bit_speed.push(bit.unwrap_or(f64::NAN));
        let position = |s: usize, direction| simulation.displacement(s, Body::Pipe, direction).unwrap_or(f64::NAN);
        let joints = simulation.joint_stations().iter();
        self.positions.push(
            joints
                .flat_map(|&s| [position(s, Direction::V), position(s, Direction::W)])
                .collect(),
        );
        self.forces.push(forces);
    }

    /// Root mean square of the bit speed about its mean after the run-up (rad/s).
    pub fn ripple(&self) -> f64 {
        let after = &self.bit_speed[self.bit_speed.len() / 4..];
        let mean = after.iter().sum::<f64>() / after.len() as f64;
        (after.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / after.len() as f64).sqrt()
    }

    /// Energy error over the drive's work.
    pub fn energy_error_ratio(&self) -> f64 {
        self.energy_error / self.drive_work
    }

    /// Root sum square over a layer's stations of their RMS force (N): 0 pipe-guide, 1 guide-wall.
    pub fn force(&self, layer: usize) -> f64 {
        self.layers().get(layer).map_or(f64::NAN, |stations| {
            self.rms[stations.clone()]
                .iter()
                .map(|rms| rms * rms)
                .sum::<f64>()
                .sqrt()
        })
    }

    /// Where the gaps of the two layers stand in [`Record::forces`] and [`Record::rms`]: pipe-guide, guide-wall.
    pub fn layers(&self) -> [std::ops::Range<usize>; 2] {
        let stations = self.rms.len() / 2;
        [0..stations, stations..2 * stations]
    }
}
