//! One run of the twin at constant speed and weight, until its means are settled.

use std::f64::consts::TAU;

use crate::windows::{Activity, Channel};
use flexdrill_config::{Config, ConfigError, Law};
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{m_per_h_to_m_per_s, n_to_kn};
use flexdrill_motion::{BIT, KICK_OFF, SURFACE};

/// Shortest time of a mean (s): two turns at 40 r/min.
const SHORTEST_MEAN: f64 = 3.0;
/// The watch of transfer divides its window into this many parts, each a whole number of steps.
const PARTS: f64 = 50.0;
/// Means that a figure is the mean of.
const MEANS: usize = 4;
/// Response times of the auto-driller before its result counts: e^-8 is 0.03 %.
const RESPONSES: f64 = 8.0;
/// Time (s) before the result of a tool without a hoist counts: its run-up and some turns.
const RUN_UP: f64 = 12.0;

/// What a run is loaded with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// Off bottom or drilling.
    pub motion: Activity,
    /// Speed of the drive (rad/s), above 0.
    pub rotary_speed: f64,
    /// Weight at the surface (N); 0 off bottom.
    pub weight: f64,
}

/// Settled means in the order of [`Channel::ALL`]; NaN where the tool has no such figure.
pub type Figures = [f64; Channel::COUNT];

/// Runs the twin and returns its settled means.
///
/// # Errors
/// Why there are none, in words.
pub fn run(config: &Config, load: &Load) -> Result<Figures, String> {
    // The window of means depends on the speed, so the configuration is prepared with it before the tool is built.
    let window = window(config, load);
    let config = prepared(config, load, window).map_err(|error| error.to_string())?;
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).map_err(|error| error.to_string())?;
    let hoist = config.rock.law == Law::DepthOfCut;
    let advance = config.inputs.rate_of_penetration.assumed_m_per_h;
    let inputs = Inputs {
        rotary_speed: load.rotary_speed,
        weight_on_bit: load.weight,
        // With a hoist the advance is a result; without one it is an input of the friction along the hole.
        rate_of_penetration: if hoist { 0.0 } else { m_per_h_to_m_per_s(advance) },
        ..Inputs::default()
    };
    // An auto-driller approaches its weight exponentially; without one the run-up is over sooner.
    let settled = if hoist {
        RESPONSES * config.string.hoist.response_time
    } else {
        RUN_UP
    };
    let step = simulation.settings().time_step;
    let steps = |seconds: f64| (seconds / step).round() as u64;
    let per_second = steps(1.0).max(1);
    // As a run that need not keep a pace: the step that the motion needs.
    simulation.set_refinement(simulation.quality().choice.wanted);
    // Failures are text here: a point without figures is a result of the design, not an error of the program.
    let advance_by = |simulation: &mut Simulation, count: u64| {
        for _ in 0..count {
            if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
                return Err(format!("the step at {:.1} s failed: {failure}", simulation.time()));
            }
            if simulation.step().is_multiple_of(per_second) {
                simulation.set_refinement(simulation.quality().choice.wanted);
            }
        }
        Ok(())
    };
    advance_by(&mut simulation, steps(settled))?;
    let mut snapshot = simulation.new_snapshot();
    let mut sum = [0.0; Channel::COUNT];
    // Several windows in a row average the slow drift of whirl, which one window would show as its mean.
    for _ in 0..MEANS {
        advance_by(&mut simulation, steps(window))?;
        simulation.snapshot(&mut snapshot, true);
        let mean = &snapshot.transfer.mean;
        // Torque is compared where the rig measures it: at the surface if there is a string.
        let top = if mean.torque[SURFACE].is_finite() {
            SURFACE
        } else {
            KICK_OFF
        };
        // Without a rock that answers the advance, the rate is an input and no result.
        let drilled = if hoist { mean.rate_of_penetration } else { f64::NAN };
        let figures = [
            mean.torque[top],
            mean.hook_load,
            mean.torque[BIT],
            mean.weight[BIT],
            drilled,
        ];
        for (sum, figure) in sum.iter_mut().zip(figures) {
            *sum += figure / MEANS as f64;
        }
    }
    Ok(sum)
}

/// Time of a mean (s): whole turns, but for half a step in each of the parts of the watch.
fn window(config: &Config, load: &Load) -> f64 {
    let turn = TAU / load.rotary_speed;
    let whole = (SHORTEST_MEAN / turn - 1e-9).ceil().max(1.0) * turn;
    let step = config.solver.time_step;
    PARTS * step * (whole / PARTS / step).round().max(1.0)
}

fn prepared(config: &Config, load: &Load, window: f64) -> Result<Config, ConfigError> {
    config.with_values(
        "calibration",
        [
            ("inputs.weight_on_bit.initial_kn", n_to_kn(load.weight)),
            ("transfer.window", window.min(60.0)),
        ],
    )
}
