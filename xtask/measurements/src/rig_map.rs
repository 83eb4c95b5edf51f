//! `--cases rig-map`: what the rig's tool does over rotary speed and weight, with three guides.

use flexdrill_bench::parallel::in_order;
use flexdrill_bench::table::Table;
use flexdrill_config::{Config, ConfigError};
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{kn_to_n, m_per_s_to_m_per_h, rpm_to_rad_per_s};
use flexdrill_motion::BIT;
use flexdrill_plot::{Figure, Line, Panel};
use serde_json::{Value, json};

/// Rotary speeds (r/min).
const SPEEDS: [f64; 3] = [20.0, 40.0, 60.0];
/// Weights slacked off at the surface (kN).
const WEIGHTS: [f64; 4] = [5.0, 10.0, 20.0, 30.0];
/// Model time of turning off bottom before the weight is asked for (s).
const OFF_BOTTOM: f64 = 8.0;
/// Model time at the end over which the figures are means (s): the window of the stick-slip index.
const JUDGED: f64 = 10.0;
/// Model time between two looks (s).
const LOOK: f64 = 0.1;

/// A guide as values to change.
struct Guide {
    name: &'static str,
    changes: fn() -> Vec<(&'static str, Value)>,
}

const GUIDES: [Guide; 3] = [
    Guide {
        name: "as shipped: two spines, 3.45 m",
        changes: Vec::new,
    },
    Guide {
        name: "two spines, made straight",
        changes: || vec![("tool.guide.free_curvature", json!(0.0))],
    },
    Guide {
        name: "plain tube without stress in the arc",
        changes: || {
            vec![
                ("tool.guide.bending_factor", json!(1.0)),
                ("tool.guide.free_curvature", json!("as_built")),
            ]
        },
    },
];

/// What a cell came to.
#[derive(Debug, Clone, Copy)]
struct Cell {
    /// (max - min) / (2 mean) of the bit's speed, as the alarm has it at the end.
    index: f64,
    /// Rate of penetration (m/h).
    rate: f64,
    /// Weight at the bit (kN).
    weight: f64,
    /// Torque at the bit (N m).
    torque: f64,
}

/// Runs every cell with every guide, on `jobs` threads; gives the tables and their picture.
///
/// # Errors
/// When a tool cannot be built or a step fails.
pub(crate) fn tables(config: &Config, duration: f64, jobs: usize) -> anyhow::Result<(String, Figure)> {
    let tools: Vec<Config> = GUIDES
        .iter()
        .map(|guide| config.with_values(guide.name, (guide.changes)()))
        .collect::<Result<_, ConfigError>>()?;
    // A cell's number counts guides, speeds and weights in this order.
    let (of_guide, of_speed) = (SPEEDS.len() * WEIGHTS.len(), WEIGHTS.len());
    let numbers: Vec<usize> = (0..GUIDES.len() * of_guide).collect();
    // A run that fails ends the study: a map with a hole would be quoted without its reason.
    let cells: Vec<Cell> = in_order(&numbers, jobs, |number| {
        let (rpm, kn) = (SPEEDS[number % of_guide / of_speed], WEIGHTS[number % of_speed]);
        let cell = run(&tools[number / of_guide], rpm, kn, duration)?;
        eprintln!("{}, {rpm} r/min, {kn} kN: {cell:?}", GUIDES[number / of_guide].name);
        anyhow::Ok(cell)
    })?;
    let of = |guide: usize, speed: usize, weight: usize| cells[guide * of_guide + speed * of_speed + weight];
    // The width of these lines is that of the document that they are pasted into.
    let mut text = format!(
        "{duration} s of model time each, {OFF_BOTTOM} s of them off bottom. In a cell: stick-slip index and rate of penetration\n\
         (m/h) over the last {JUDGED} s, and in brackets weight (kN) and torque (N m) at the bit.\n"
    );
    for (guide, Guide { name, .. }) in GUIDES.iter().enumerate() {
        let speeds = SPEEDS.map(|rpm| format!("{rpm} r/min"));
        let head: Vec<&str> = std::iter::once("weight (kN)")
            .chain(speeds.iter().map(String::as_str))
            .collect();
        let mut table = Table::with_head(&head);
        for (weight, kn) in WEIGHTS.iter().enumerate() {
            let cells = (0..SPEEDS.len()).map(|speed| {
                let cell = of(guide, speed, weight);
                format!(
                    "{:.2}, {:.1} ({:.1}, {:.0})",
                    cell.index, cell.rate, cell.weight, cell.torque
                )
            });
            table.cells(&std::iter::once(kn.to_string()).chain(cells).collect::<Vec<_>>());
        }
        text.push_str(&format!("\n**Guide: {name}.**\n\n{}", table.text()));
    }
    // The first row of panels shows the index, the second the advance, a column per guide.
    let panels = [true, false].into_iter().flat_map(|index| {
        GUIDES.iter().enumerate().map(move |(guide, Guide { name, .. })| {
            let quantity = if index {
                "stick-slip index"
            } else {
                "rate of penetration (m/h)"
            };
            SPEEDS.iter().enumerate().fold(
                Panel::new(*name, "weight at the surface (kN)", quantity).from_zero(),
                |panel, (speed, rpm)| {
                    let points = WEIGHTS.iter().enumerate().map(|(weight, kn)| {
                        let cell = of(guide, speed, weight);
                        (*kn, if index { cell.index } else { cell.rate })
                    });
                    panel.line(Line::new(format!("{rpm} r/min"), points.collect()))
                },
            )
        })
    });
    let figure = Figure {
        name: "rig_map",
        title: "The rig's tool over speed and weight".to_owned(),
        caption: String::new(),
        columns: GUIDES.len(),
        height: 300,
        panels: panels.collect(),
    };
    Ok((text, figure))
}

/// Turns off bottom, then drills at `rpm` (r/min) under `kn` (kN).
fn run(config: &Config, rpm: f64, kn: f64, duration: f64) -> anyhow::Result<Cell> {
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    let mut snapshot = simulation.new_snapshot();
    let steps = (LOOK / config.solver.time_step).round() as u32;
    // Two windows of the transfer make the mean, each half.
    let mut sums = [0.0; 3];
    while simulation.time() < duration {
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            // The tool turns off bottom first, as a rig puts weight on a bit that turns.
            weight_on_bit: if simulation.time() < OFF_BOTTOM {
                0.0
            } else {
                kn_to_n(kn)
            },
            ..Inputs::ZERO
        };
        for _ in 0..steps {
            let outcome = simulation.advance(&inputs);
            anyhow::ensure!(
                matches!(outcome, StepOutcome::Advanced { .. }),
                "{rpm} r/min, {kn} kN: {outcome:?}"
            );
        }
        // The snapshot ends the interval of the stick-slip index, so that the last one belongs to the end of the run.
        simulation.snapshot(&mut snapshot, true);
        // The window of `transfer` is 5 s: two of them.
        let left = duration - simulation.time();
        if left < 0.5 * LOOK || (left - 0.5 * JUDGED).abs() < 0.5 * LOOK {
            let transfer = &snapshot.transfer;
            for (sum, value) in sums.iter_mut().zip([
                transfer.mean.rate_of_penetration,
                transfer.weight.mean[BIT],
                transfer.torque.mean[BIT],
            ]) {
                *sum += 0.5 * value;
            }
        }
    }
    Ok(Cell {
        index: snapshot.bit.stick_slip_index,
        rate: m_per_s_to_m_per_h(sums[0]),
        weight: 1e-3 * sums[1],
        torque: sums[2],
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests {
    use super::*;

    #[test]
    fn every_guide_fits_the_rigs_tool_and_a_run_has_figures() {
        let rig = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        for guide in &GUIDES {
            rig.with_values(guide.name, (guide.changes)()).unwrap();
        }
        // Long enough for one window of the transfer; off bottom nothing cuts, once the tool has left the bottom.
        let cell = run(&rig, 40.0, 10.0, 6.0).unwrap();
        assert!(cell.rate < 0.01 && cell.weight < 0.01 && cell.torque < 0.1, "{cell:?}");
    }
}
