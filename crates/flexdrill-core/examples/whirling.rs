//! What whirl costs and how it moves: Newton's corrections, halved steps, forces and losses of the paper's tool with a
//! friction of pipe and guide of your choice, after the motion has developed.
//!
//! ```text
//! cargo run --release -p flexdrill-core --example whirling -- FRICTION RPM KN PARTS
//! ```
//!
//! PARTS is 0 for whole steps, 1 for halves, 2 for quarters. Three runs, whose weights on bit differ by 1 N.

use flexdrill_core::dynamics::Energies;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};
use flexdrill_core::units::{kn_to_n, rad_per_s_to_rpm, rpm_to_rad_per_s};
use flexdrill_motion::WhirlKind;

/// Model time until the motion is judged, and for how long it is (s).
const DEVELOPED: f64 = 4.0;
const JUDGED: f64 = 8.0;
/// Steps between two samples.
const SAMPLE: u64 = 40;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = std::env::args().skip(1).map(|x| x.parse());
    let arguments: Vec<f64> = arguments.collect::<Result<_, _>>()?;
    let [friction, rpm, wob, parts] = arguments[..] else {
        return Err("four numbers: FRICTION RPM KN PARTS".into());
    };
    let mut tool = ToolDescription::paper();
    tool.inner.friction_tangential = friction;
    tool.inner.friction_axial = friction;
    for more in [0.0, 1.0, -1.0] {
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(wob) + more,
            ..Inputs::default()
        };
        run(&tool, &inputs, parts as u32)?;
    }
    Ok(())
}

fn run(tool: &ToolDescription, inputs: &Inputs, parts: u32) -> Result<(), Box<dyn std::error::Error>> {
    let mut settings =
        SimulationSettings::default().with(|settings| settings.rotary_speed_slew = rpm_to_rad_per_s(200.0));
    settings.initial_inputs.weight_on_bit = inputs.weight_on_bit;
    let mut simulation = Simulation::new(tool, &settings)?;
    simulation.set_refinement(parts);
    let steps = |duration: f64| (duration / settings.time_step).round() as u64;
    for _ in 0..steps(DEVELOPED) {
        simulation.advance(inputs).ok()?;
    }
    let (before, energy) = (simulation.solver_counters(), *simulation.energy());
    let mut snapshot = simulation.new_snapshot();
    // What came before is not judged.
    simulation.snapshot(&mut snapshot, true);
    let mut motion = Motion::default();
    for step in 1..=steps(JUDGED) {
        simulation.advance(inputs).ok()?;
        if step % SAMPLE == 0 {
            simulation.snapshot(&mut snapshot, true);
            motion.take(&snapshot);
        }
    }
    let after = simulation.solver_counters();
    let per_step = |count: u64| count as f64 / steps(JUDGED) as f64;
    println!(
        "corrections per step {:.2}, halved {:.2} %; {}; {}",
        per_step(after.newton_iterations - before.newton_iterations),
        100.0 * per_step(after.halved_steps - before.halved_steps),
        motion.text(),
        losses(&energy, simulation.energy()),
    );
    Ok(())
}

/// Sums over the samples.
#[derive(Default)]
struct Motion {
    samples: f64,
    /// Mean square of the pipe-guide force over all stations (N2), and its peak (N).
    squares: f64,
    peak: f64,
    /// Speed of the bit (r/min) and its square.
    bit: [f64; 2],
    /// Places that whirl backward and their whirl ratios.
    backward: [f64; 2],
}

impl Motion {
    fn take(&mut self, snapshot: &Snapshot) {
        self.samples += 1.0;
        let force = &snapshot.contacts.pipe_guide;
        let squares = force.normal_rms.iter().map(|x| x * x);
        self.squares += squares.sum::<f64>() / force.normal_rms.len() as f64;
        self.peak = force.normal_peak.iter().fold(self.peak, |peak, x| peak.max(*x));
        let speed = rad_per_s_to_rpm(snapshot.bit.rotary_speed);
        self.bit[0] += speed;
        self.bit[1] += speed * speed;
        let places = snapshot.whirl.kind.iter().zip(&snapshot.whirl.whirl_ratio);
        for (_, ratio) in places.filter(|(kind, _)| **kind == WhirlKind::Backward) {
            self.backward[0] += 1.0;
            self.backward[1] += ratio;
        }
    }

    fn text(&self) -> String {
        let mean = self.bit[0] / self.samples;
        format!(
            "force rms {:.1} N, peak {:.0} N; bit {mean:.1} r/min, ripple {:.1}; {:.1} places backward, ratio {:.2}",
            (self.squares / self.samples).sqrt(),
            self.peak,
            (self.bit[1] / self.samples - mean * mean).max(0.0).sqrt(),
            self.backward[0] / self.samples,
            self.backward[1] / self.backward[0],
        )
    }
}

/// Power of what takes energy, and the audit's error over the drive's work.
fn losses(before: &Energies, after: &Energies) -> String {
    let power = |of: fn(&Energies) -> f64| (of(after) - of(before)) / JUDGED;
    format!(
        "drive {:.0} W, friction {:.1}, collisions {:.1}, Rayleigh {:.1}, numerical {:.1}, error {:.2} %",
        power(|e| e.drive),
        power(|e| e.friction),
        power(|e| e.contact_damping),
        power(|e| e.rayleigh_damping),
        power(|e| e.numerical_damping),
        100.0 * power(|e| e.error) / power(|e| e.drive),
    )
}
