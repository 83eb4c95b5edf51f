//! What if there were more weight on the bit? A run is saved after three seconds and continued twice, as it was and
//! with twice the weight; both continuations begin from the same bits.
//!
//!     cargo run --release -p flexdrill-core --example what_if

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm, rpm_to_rad_per_s};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Steps on for `seconds` and says what is known then, with statistics over these seconds.
fn go_on(twin: &mut Simulation, inputs: &Inputs, seconds: f64) -> Result<Snapshot> {
    let mut snapshot = twin.new_snapshot();
    twin.snapshot(&mut snapshot, true);
    let end = twin.time() + seconds;
    while twin.time() < end {
        twin.advance(inputs).ok()?;
    }
    twin.snapshot(&mut snapshot, true);
    Ok(snapshot)
}

fn main() -> Result<()> {
    let tool = ToolDescription::paper().with_mesh(33, 2);
    let mut twin = Simulation::new(&tool, &SimulationSettings::default())?;
    let as_it_is = Inputs {
        rotary_speed: rpm_to_rad_per_s(40.0),
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    go_on(&mut twin, &as_it_is, 3.0)?;
    let saved = twin.checkpoint()?;
    println!("saved at {:.1} s: {} bytes", twin.time(), saved.len());

    println!(
        "{:>14} {:>12} {:>12} {:>16} {:>16}",
        "weight (kN)", "bit (r/min)", "torque (N m)", "on guide (kN)", "on wall (kN)"
    );
    for weight_on_bit in [10e3, 20e3] {
        let mut twin = Simulation::new(&tool, &SimulationSettings::default())?;
        twin.restore(&saved)?;
        let then = go_on(
            &mut twin,
            &Inputs {
                weight_on_bit,
                ..as_it_is
            },
            3.0,
        )?;
        let largest = |peaks: &[f64]| n_to_kn(peaks.iter().copied().fold(0.0, f64::max));
        println!(
            "{:>14} {:>12.2} {:>12.1} {:>16.2} {:>16.2}",
            n_to_kn(weight_on_bit),
            rad_per_s_to_rpm(then.bit.rotary_speed),
            then.bit.torque,
            largest(&then.contacts.pipe_guide.normal_peak),
            largest(&then.contacts.guide_wall.normal_peak),
        );
    }

    // A checkpoint goes back to its own tool only.
    let other = tool.with(|tool| tool.slip_speed = 0.02);
    if let Err(refused) = Simulation::new(&other, &SimulationSettings::default())?.restore(&saved) {
        println!("another tool: {refused}");
    }
    Ok(())
}
