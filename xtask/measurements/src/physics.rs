//! `--cases physics`: what each piece of the rig's physics costs.

use flexdrill_bench::measure::{Load, Measured, run};
use flexdrill_bench::table::Table;
use flexdrill_config::{Config, ConfigError};
use serde_json::{Value, json};

/// Runs of each, in turn: the machine's speed varies from minute to minute. The fastest counts.
const ROUNDS: u32 = 5;

/// A piece of physics as values to change.
struct Piece {
    name: &'static str,
    changes: fn() -> Vec<(&'static str, Value)>,
}

/// Pieces to leave out or to add. Where a tool has the value already, the row repeats it as it is.
const PIECES: &[Piece] = &[
    Piece {
        name: "as it is",
        changes: Vec::new,
    },
    Piece {
        name: "without mud",
        changes: || vec![("environment.mud", Value::Null)],
    },
    Piece {
        name: "friction by components in both layers",
        changes: || {
            vec![
                ("contact.inner.friction", json!("separate")),
                ("contact.outer.friction", json!("separate")),
            ]
        },
    },
    Piece {
        name: "without pin friction",
        changes: || vec![("tool.joint.friction", json!(0.0))],
    },
    Piece {
        name: "without string and rock",
        changes: || vec![("string.model", json!("none")), ("rock.law", json!("paper"))],
    },
    Piece {
        name: "string inclined by 60 deg over 400 m of 1000 m",
        changes: || vec![("string.sections", flexdrill_bench::cases::inclined())],
    },
    Piece {
        name: "play of 0.5 deg",
        changes: || vec![("tool.joint.play_deg", json!(0.5))],
    },
    Piece {
        name: "shortening of the second order",
        changes: || vec![("tool.shortening", json!("second_order"))],
    },
    Piece {
        name: "guide made straight",
        changes: || vec![("tool.guide.free_curvature", json!(0.0))],
    },
    Piece {
        name: "5 MPa in the pipe",
        changes: || vec![("environment.pressure", json!({"at_top": 5e6, "end": "closed"}))],
    },
];

/// Runs the configuration with every piece; gives the table. `paper` is the configuration to compare with.
///
/// # Errors
/// When a tool cannot be built or a step fails.
pub(crate) fn tables(config: &Config, paper: &Config, load: Load, duration: f64) -> anyhow::Result<String> {
    let mut table = Table::new([
        "tool",
        "real-time factor of processor time",
        "over `config/default.yaml`",
        "us per step",
        "iterations per step",
        "us per iteration",
    ]);
    let mut refused = String::new();
    // The paper's tool is the reference of every row.
    let mut tools = vec![("`config/default.yaml`", paper.clone())];
    for piece in PIECES {
        match changed(config, piece) {
            // A configuration that refuses a piece is a line of the result: pieces exclude each other.
            Ok(tool) => tools.push((piece.name, tool)),
            Err(error) => refused.push_str(&format!("\nNot run: {}: {error}.\n", piece.name)),
        }
    }
    let mut fastest: Vec<Option<Measured>> = tools.iter().map(|_| None).collect();
    // In turns and not one after another, so that a busy minute of the machine hits all tools alike.
    for round in 1..=ROUNDS {
        for ((name, tool), fastest) in tools.iter().zip(&mut fastest) {
            eprintln!("{name}: {duration} s of model time, {round} of {ROUNDS}");
            let measured = run(tool, load, duration, |_| {})?;
            if let Some(failure) = measured.failure {
                anyhow::bail!("{name}: a step failed: {failure}");
            }
            // The fastest of several runs is the one that was least disturbed.
            if fastest
                .as_ref()
                .is_none_or(|before| measured.step_time() < before.step_time())
            {
                *fastest = Some(measured);
            }
        }
    }
    // Processor time compares tools; wall time would compare the neighbours on the machine.
    let reference = fastest[0].as_ref().map_or(f64::NAN, Measured::processor_factor);
    for ((name, _), measured) in tools.iter().zip(fastest.iter().flatten()) {
        let (factor, time) = (measured.processor_factor(), measured.step_time());
        table.row([
            (*name).to_owned(),
            format!("{factor:.2}"),
            format!("{:.2}", factor / reference),
            format!("{time:.1}"),
            format!("{:.2}", measured.iterations()),
            format!("{:.1}", time / measured.iterations()),
        ]);
    }
    Ok(format!(
        "{duration} s of model time each from rest, the fastest of {ROUNDS} runs in turn, {} r/min, {} kN, step {} ms.\n\n{}{refused}",
        load.rpm,
        load.wob,
        1e3 * config.solver.time_step,
        table.text()
    ))
}

fn changed(config: &Config, piece: &Piece) -> Result<Config, ConfigError> {
    config.with_values(piece.name, (piece.changes)())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests {
    use super::*;

    #[test]
    fn every_piece_fits_the_rigs_tool() {
        let rig = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        for piece in PIECES {
            changed(&rig, piece).unwrap();
        }
    }
}
