//! The twin's own points: what the surrogates of the acceptance are made from.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::path::Path;

use flexdrill_calibration::windows::Motion;
use flexdrill_config::Config;
use flexdrill_fit::points::{self, Cover};
use flexdrill_fit::unknowns::Unknowns;

fn rig() -> Config {
    Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap()
}

/// Makes `tests/data/rig_points.csv`: `cargo test --release -p flexdrill-fit --test points -- --ignored`. It goes on where
/// it was interrupted.
#[test]
#[ignore = "80 runs of 45 s of model time: some minutes"]
fn make_the_points_of_the_acceptance() {
    let config = rig();
    let unknowns = Unknowns::of(&config).unwrap();
    let rpm = |rpm: f64| rpm * std::f64::consts::TAU / 60.0;
    let covers = [
        Cover {
            motion: Motion::OffBottom,
            rotary_speed: [rpm(35.0), rpm(65.0)],
            weight: [0.0, 0.0],
            points: 36,
        },
        Cover {
            motion: Motion::Drilling,
            rotary_speed: [rpm(35.0), rpm(65.0)],
            weight: [9e3, 21e3],
            points: 48,
        },
    ];
    let mut all: Vec<_> = covers
        .iter()
        .flat_map(|cover| points::design(unknowns.modelled.len(), cover, 1))
        .collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/rig_points.csv");
    if let Ok(text) = std::fs::read_to_string(&path) {
        points::fill(&path, &text, &config, &unknowns, 1, &mut all).unwrap();
    }
    points::run(&config, &unknowns, all, 2, |points, left| {
        std::fs::write(&path, points::to_csv(&config, &unknowns, 1, points)).unwrap();
        eprintln!("{left} left");
    });
}
