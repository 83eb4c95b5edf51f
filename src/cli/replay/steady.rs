//! A run of a verification case as a bag.

use std::path::Path;

use super::player::Player;
use crate::bag::Recording;
use crate::cli::source::FromRig;
use flexdrill_core::twin::RunInputs;
use flexdrill_verify::CaseRun;

/// Messages of each kind that a bag is to have: enough for the curve of a vibration or a collision.
const MESSAGES: f64 = 2000.0;

/// Highest rate of a topic (Hz), that of the configuration.
const HIGHEST_RATE: f64 = 1000.0;

/// Repeats `run` into the bag `out`. Model time 0 is 1970-01-01, so that the bag is the same every time.
///
/// # Errors
/// When a step fails or the bag cannot be written.
pub(in crate::cli) fn record_case(run: &CaseRun, out: &Path) -> anyhow::Result<Recording> {
    let seconds = run.steps as f64 * run.settings.time_step;
    let rate = (MESSAGES / seconds).clamp(1.0, HIGHEST_RATE).round();
    let topics = [
        "joint_deflections",
        "contact_forces",
        "bit_state",
        "transfer",
        "tool_shape",
    ];
    let config = run
        .config
        .with_values("the case", topics.map(|topic| (format!("outputs.rates.{topic}"), rate)))?;
    let mut player = Player::with_settings(config, &run.settings, 0, FromRig::default(), None, out, |topic| {
        format!("/{}", topic.name.trim_start_matches('/'))
    })?;
    let inputs = RunInputs {
        inputs: run.inputs,
        ..player.inputs()
    };
    player.apply(&inputs, &[], true)?;
    while player.step() < run.steps {
        player.advance_or_fail()?;
    }
    Ok(player.finish()?.0)
}
