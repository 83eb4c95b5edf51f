//! The model's word on its own motion: good for the paper's tool at the default step, poor where an eighth of the step
//! shows another motion (`docs/measurements.md`).

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{ModelQuality, QualityCause, QualityLevel, Simulation, SimulationSettings, Snapshot};
use flexdrill_core::units::rpm_to_rad_per_s;

/// Window of the judgement and the run-up before it matters (s).
const JUDGED: f64 = 10.5;

fn run(tool: &ToolDescription, time_step: f64) -> (Simulation, Snapshot) {
    let settings = SimulationSettings::default().with(|settings| {
        settings.time_step = time_step;
        settings.initial_inputs = Inputs {
            rotary_speed: 0.0,
            weight_on_bit: 10e3,
            ..Inputs::default()
        };
    });
    let mut twin = Simulation::new(tool, &settings).unwrap();
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(40.0),
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    while twin.time() < JUDGED {
        twin.advance(&inputs).ok().unwrap();
    }
    let mut snapshot = twin.new_snapshot();
    twin.snapshot(&mut snapshot, false);
    (twin, snapshot)
}

fn largest_confidence(snapshot: &Snapshot) -> f64 {
    snapshot.whirl.confidence.iter().copied().fold(0.0, f64::max)
}

#[test]
fn the_papers_tool_is_good_at_the_default_step() {
    let (_, snapshot) = run(&ToolDescription::paper(), 0.5e-3);
    let quality = snapshot.quality;
    assert!(quality.judged);
    assert_eq!(
        (quality.level, quality.cause),
        (QualityLevel::Good, None),
        "{quality:?}"
    );
    // Some places whirl beyond doubt: nothing lowers their confidence.
    assert!(largest_confidence(&snapshot) > 0.8, "{:?}", snapshot.whirl.confidence);
}

/// Its ripple is a quarter to a third too large, with an energy error of 1 % of the drive's work.
#[test]
fn the_papers_tool_is_poor_at_twice_the_step() {
    let (mut twin, snapshot) = run(&ToolDescription::paper(), 1e-3);
    let quality = snapshot.quality;
    assert_eq!(
        (quality.level, quality.cause),
        (QualityLevel::Poor, Some(QualityCause::EnergyError)),
        "{quality:?}"
    );
    assert!((snapshot.energy.error / snapshot.energy.drive).abs() < 0.02);
    let trust = QualityLevel::Poor.trust();
    assert!(
        largest_confidence(&snapshot) <= trust,
        "{:?}",
        snapshot.whirl.confidence
    );

    // It is part of the state, and goes with it.
    let saved = twin.checkpoint().unwrap();
    twin.reset();
    let fresh = ModelQuality {
        choice: twin.quality().choice,
        ..ModelQuality::default()
    };
    assert_eq!(twin.quality(), fresh);
    twin.restore(&saved).unwrap();
    assert_eq!(twin.quality(), quality);
}

/// Collisions that last half a step: ripple 60 % too large.
#[test]
fn contacts_much_shorter_than_the_step_are_poor() {
    let mut tool = ToolDescription::paper();
    (tool.inner.stiffness, tool.outer.stiffness) = (1e8, 5e8);
    let (_, snapshot) = run(&tool, 0.5e-3);
    assert_eq!(snapshot.quality.level, QualityLevel::Poor, "{:?}", snapshot.quality);
}
