//! Steps of a configuration, in a function of their own so that a profiler can see them alone: `launch_scripts/step_path.sh`.
//!
//! Without a third argument the tool drills for some seconds and its state is written to a file; with one, so many steps are
//! taken from there.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::path::Path;

use anyhow::Context as _;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// Time (s) until the tool turns and touches as it does while it drills.
const RUN_UP: f64 = 12.0;

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (config, state) = (
        arguments.next().context("which configuration?")?,
        arguments.next().context("which file for the state?")?,
    );
    let config = Config::load(Path::new(&config))?;
    let mut twin = Simulation::new(&config.tool(), &config.simulation())?;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(40.0),
        weight_on_bit: kn_to_n(10.0),
        ..Inputs::default()
    };
    match arguments.next() {
        None => {
            while twin.time() < RUN_UP {
                step(&mut twin, &inputs)?;
            }
            std::fs::write(&state, twin.checkpoint()?)?;
        }
        Some(steps) => {
            twin.restore(&std::fs::read(&state)?)?;
            for _ in 0..steps.parse::<u32>()? {
                step(&mut twin, &inputs)?;
            }
            println!("{:.4} s", twin.time());
        }
    }
    Ok(())
}

/// One step, by whose name the profiler knows when to count.
#[inline(never)]
fn one_step_of_the_twin(twin: &mut Simulation, inputs: &Inputs) -> bool {
    twin.advance(inputs).ok().is_ok()
}

fn step(twin: &mut Simulation, inputs: &Inputs) -> anyhow::Result<()> {
    anyhow::ensure!(one_step_of_the_twin(twin, inputs), "a step failed");
    Ok(())
}
