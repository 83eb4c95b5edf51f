//! The paper's tool at 40 r/min and 10 kN: ten seconds, a line per second, and a picture of how the bit turns, how one
//! joint moves in its gap and where the pipes touch.
//!
//!     cargo run --release -p flexdrill-core --example whole_tool -- whole_tool.svg

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, ToolDescription};
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm, rpm_to_rad_per_s};
use plotters::prelude::*;

/// s, of which the picture shows the motion in the second half.
const DURATION: f64 = 10.0;
/// s, between samples.
const SAMPLE: f64 = 5e-3;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// What is drawn.
#[derive(Default)]
struct Record {
    /// s, r/min.
    bit_speed: Vec<(f64, f64)>,
    /// mm, y and z.
    orbit: Vec<(f64, f64)>,
    /// m, kN: largest normal force of the whole run by measured depth, pipe on guide and guide on wall.
    forces: [Vec<(f64, f64)>; 2],
}

fn main() -> Result<()> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "whole_tool.svg".to_owned());
    let tool = ToolDescription::paper();
    let mut twin = Simulation::new(&tool, &SimulationSettings::default())?;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(40.0),
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    let mut snapshot = twin.new_snapshot();
    // Where the pipe's orbit is drawn: at the joint in the middle.
    let joint = twin.joint_stations()[16];
    let clearance = twin.clearance(joint, Body::Pipe).unwrap_or(0.0);
    let mut record = Record::default();
    for layer in &mut record.forces {
        *layer = snapshot
            .contacts
            .measured_depth
            .iter()
            .map(|&depth| (depth, 0.0))
            .collect();
    }
    let samples = (DURATION / SAMPLE).round() as u32;
    for sample in 1..=samples {
        while twin.time() < f64::from(sample) * SAMPLE - 1e-9 {
            twin.advance(&inputs).ok()?;
        }
        twin.snapshot(&mut snapshot, true);
        note(&mut record, &snapshot, joint);
        if sample % 200 == 0 {
            tell(&snapshot);
        }
    }
    draw(&path, &record, 1e3 * clearance)?;
    println!("{path}");
    Ok(())
}

fn note(record: &mut Record, at: &Snapshot, joint: usize) {
    record.bit_speed.push((at.time, rad_per_s_to_rpm(at.bit.rotary_speed)));
    if at.time > 0.5 * DURATION {
        let (pipe, guide) = (at.shape.pipe[joint], at.shape.guide[joint]);
        record
            .orbit
            .push((1e3 * (pipe[0] - guide[0]), 1e3 * (pipe[1] - guide[1])));
    }
    let layers = [&at.contacts.pipe_guide, &at.contacts.guide_wall];
    for (largest, layer) in record.forces.iter_mut().zip(layers) {
        for ((_, most), peak) in largest.iter_mut().zip(&layer.normal_peak) {
            *most = most.max(n_to_kn(*peak));
        }
    }
}

fn tell(at: &Snapshot) {
    let bend = at.joints.bend_angle.iter().copied().fold(0.0, f64::max);
    let touching = at.contacts.state.iter().filter(|&&state| state != 0).count();
    println!(
        "{:5.1} s: bit {:6.2} r/min, {:5.1} N m, largest bend {:.2} deg, {touching} stations touch, whirl level {}",
        at.time,
        rad_per_s_to_rpm(at.bit.rotary_speed),
        at.bit.torque,
        bend.to_degrees(),
        at.warning.severity,
    );
}

fn draw(path: &str, record: &Record, clearance: f64) -> Result<()> {
    let area = SVGBackend::new(path, (900, 760)).into_drawing_area();
    area.fill(&WHITE)?;
    let (above, below) = area.split_vertically(330);
    let (left, right) = below.split_horizontally(430);
    let fastest = record.bit_speed.iter().map(|(_, speed)| *speed).fold(1.0, f64::max);
    let mut speed = ChartBuilder::on(&above)
        .caption("Speed of the bit", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..DURATION, 0.0..1.1 * fastest)?;
    speed
        .configure_mesh()
        .max_light_lines(0)
        .x_desc("model time (s)")
        .y_desc("r/min")
        .draw()?;
    speed.draw_series(LineSeries::new(record.bit_speed.iter().copied(), &BLUE))?;

    let reach = 1.3 * clearance;
    let mut orbit = ChartBuilder::on(&left)
        .caption("Pipe in guide, joint 16, low side down", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(-reach..reach, reach..-reach)?;
    orbit
        .configure_mesh()
        .max_light_lines(0)
        .x_desc("y (mm)")
        .y_desc("z (mm)")
        .draw()?;
    let circle = (0..=120).map(|k| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 120.0).sin_cos();
        (clearance * cos, clearance * sin)
    });
    orbit.draw_series(LineSeries::new(circle, &BLACK))?;
    orbit.draw_series(LineSeries::new(record.orbit.iter().copied(), &BLUE))?;

    let most = record
        .forces
        .iter()
        .flatten()
        .map(|(_, force)| *force)
        .fold(0.1, f64::max);
    let depth = record.forces[0].last().map_or(1.0, |(depth, _)| *depth);
    let mut forces = ChartBuilder::on(&right)
        .caption("Largest contact force", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..depth, 0.0..1.1 * most)?;
    forces
        .configure_mesh()
        .max_light_lines(0)
        .x_desc("measured depth (m)")
        .y_desc("kN")
        .draw()?;
    for (layer, name, colour) in [(0, "pipe on guide", BLUE), (1, "guide on wall", RED)] {
        forces
            .draw_series(LineSeries::new(record.forces[layer].iter().copied(), &colour))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour));
    }
    forces
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE)
        .border_style(BLACK)
        .draw()?;
    area.present()?;
    Ok(())
}
