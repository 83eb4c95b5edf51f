//! What collisions take from the paper's tool, and how much of the pipe is chaotic, by friction, speed and weight on
//! bit: where the levels of chaotic whirl come from. A line per run; with a fifth argument the speed is brought to that
//! one (r/min) when half of the time is over.
//!
//!     cargo run --release -p flexdrill-core --example collision_power -- 16 0.2,0.4,0.7 40,60,80,100,120 5,10,20
//!     cargo run --release -p flexdrill-core --example collision_power -- 30 0.7 80,100,120 10 48

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, ToolDescription};
use flexdrill_core::twin::{Simulation, SimulationSettings};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{HazardKind, Severity, WhirlKind};

/// Model time that is passed over at the start of a run (s): the run-up to 120 r/min and the first turns.
const SETTLED: f64 = 8.0;
/// Looks over which the power is averaged: 3 s, as the hazard does by default.
const WINDOW: usize = 30;
/// Time between two looks (s).
const LOOK: f64 = 0.1;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

struct Case {
    friction: f64,
    rpm: f64,
    kn: f64,
    duration: f64,
    then_rpm: Option<f64>,
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let list = |index: usize, usual: &[f64]| match arguments.get(index) {
        None => Ok(usual.to_vec()),
        Some(text) => text
            .split(',')
            .map(str::parse)
            .collect::<std::result::Result<Vec<f64>, _>>(),
    };
    let duration = list(0, &[16.0])?.first().copied().unwrap_or(16.0);
    let (frictions, speeds) = (list(1, &[0.2, 0.4, 0.7])?, list(2, &[40.0, 60.0, 80.0, 100.0, 120.0])?);
    let (weights, then) = (list(3, &[5.0, 10.0, 20.0])?, list(4, &[])?);
    println!("| friction | r/min | kN | collisions (W/m) | chaotic of 32 | chaotic part (W/m) | levels |");
    println!("|---|---|---|---|---|---|---|");
    for &friction in &frictions {
        for &rpm in &speeds {
            for &kn in &weights {
                let case = Case {
                    friction,
                    rpm,
                    kn,
                    duration,
                    then_rpm: then.first().copied(),
                };
                println!("{}", row(&case)?);
            }
        }
    }
    Ok(())
}

fn row(case: &Case) -> Result<String> {
    let mut twin = Simulation::new(&ToolDescription::paper(), &SimulationSettings::default())?;
    let mut live = twin.live();
    live.inner_friction[0] = case.friction;
    twin.set_live(live)?;
    let length = twin.stations().last().map_or(1.0, |station| station.measured_depth);
    let mut snapshot = twin.new_snapshot();
    let joints = twin.joint_stations().len() as f64;
    let (mut looks, mut chaotic, mut before, mut taken) = (0_u32, 0, 0.0, 0.0);
    // Of the chaotic part, look by look (W/m).
    let mut powers = vec![];
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    let mut changes = vec![];
    let mut levels = [Severity::Ok; HazardKind::ALL.len()];
    for number in 1..=(case.duration / LOOK).round() as u32 {
        let next = f64::from(number) * LOOK;
        while twin.time() < next - 1e-9 {
            let rpm = case.then_rpm.filter(|_| twin.time() >= 0.5 * case.duration);
            let inputs = Inputs {
                rotary_speed: rpm_to_rad_per_s(rpm.unwrap_or(case.rpm)),
                weight_on_bit: kn_to_n(case.kn),
                ..Inputs::default()
            };
            twin.advance(&inputs).ok()?;
        }
        // As the node does where the machine keeps up.
        twin.set_refinement(twin.quality().choice.wanted);
        twin.snapshot(&mut snapshot, false);
        for (level, hazard) in levels.iter_mut().zip(&snapshot.hazards.list) {
            if hazard.severity != *level {
                *level = hazard.severity;
                changes.push(format!("{} {level} {:.1} s", hazard.kind.name(), snapshot.time));
            }
        }
        let places = snapshot.whirl.kind.iter().zip(&snapshot.whirl.body);
        let thrown = places
            .filter(|&(&kind, &body)| kind == WhirlKind::Chaotic && body == Body::Pipe)
            .count();
        let power = (snapshot.energy.contact_damping - taken) / LOOK / length;
        powers.push(power * thrown as f64 / joints);
        taken = snapshot.energy.contact_damping;
        if next < SETTLED {
            before = taken;
            continue;
        }
        looks += 1;
        chaotic += thrown;
        let power = powers[powers.len() - WINDOW..].iter().sum::<f64>() / WINDOW as f64;
        (least, most) = (least.min(power), most.max(power));
    }
    let seconds = f64::from(looks.max(1)) * LOOK;
    Ok(format!(
        "| {} | {} | {} | {:.1} | {:.0} | {least:.2} to {most:.2} | {} |",
        case.friction,
        case.rpm,
        case.kn,
        (snapshot.energy.contact_damping - before) / seconds / length,
        chaotic as f64 / f64::from(looks.max(1)),
        changes.join(", ")
    ))
}
