//! The whole tool of `config/default.yaml`: its step is converged, its energy adds up. `cargo xtask measure
//! --cases step-error` has the same of the hard cases.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_verify::step_error::{Calm, Course, Figure, Record, Statistics, refined};

const RATED: Inputs = Inputs {
    rotary_speed: 40.0 * std::f64::consts::TAU / 60.0,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};

fn configured(eta: f64, step: f64) -> Config {
    let config = Config::load("../../config/default.yaml").unwrap();
    let config = config.with_value("tool.bit.friction_factor", eta).unwrap();
    config.with_value("solver.time_step", step).unwrap()
}

fn default_step() -> f64 {
    Config::load("../../config/default.yaml").unwrap().solver.time_step
}

#[test]
fn an_eighth_of_the_step_changes_little_without_bit_torque() {
    let config = configured(0.0, default_step());
    let motion = Course::of(&config, RATED, 5.0);
    let run = |config: &Config| Record::run(config, &motion, 0.0).unwrap();
    let calm = Calm::of(&run(&config), &run(&refined(&config).unwrap()));
    println!("{calm:?}");
    assert!(
        calm.bit_speed < 0.01,
        "bit speed differs by {:.3} % of its range",
        100.0 * calm.bit_speed
    );
    assert!(
        calm.positions < 0.01,
        "joint {} differs by {:.3} % of its own range",
        calm.worst_joint,
        100.0 * calm.positions
    );
    for (name, error) in ["pipe-guide", "guide-wall"].into_iter().zip(calm.forces) {
        assert!(
            error <= 0.05,
            "{name} force differs by {:.2} % of its range",
            100.0 * error
        );
    }
}

#[test]
fn with_bit_torque_statistics_agree_and_energy_adds_up() {
    let config = configured(0.235, default_step());
    let motion = Course::of(&config, RATED, 30.0);
    // The error of the step falls with its square: finer runs have a sixteenth of it, which their scatter hides.
    let finer = configured(0.235, default_step() / 4.0);
    let (runs, fine) = std::thread::scope(|scope| {
        let fine = scope.spawn(|| Record::runs(&finer, &motion).unwrap());
        (Record::runs(&config, &motion).unwrap(), fine.join().unwrap())
    });
    let statistics = Statistics::of(&runs, &fine);
    println!("{statistics:#?}");
    let whole = statistics.whole;
    // What the scatter of the runs does not explain is smaller than that scatter, or than 1 %, the limit on positions.
    let spread = whole.runs[1].max(whole.fine[1]);
    assert!(
        whole.systematic <= spread.max(0.01),
        "RMS contact forces differ by {:.4}; runs of one step by {spread:.4}",
        whole.systematic
    );

    for (name, figure) in [
        ("ripple of the bit speed (rad/s)", statistics.ripple),
        ("mean whirl ratio", statistics.whirl_ratio),
    ] {
        // The range of three draws is 1.7 standard deviations s on average, the difference of two means of three
        // scatters by 0.82 s: both ranges together are four times that.
        let (difference, both) = mean_and_range(&figure);
        assert!(difference <= both, "{name}: {figure:?}");
    }

    for record in runs.iter().chain(&fine) {
        let part = record.energy_error_ratio().abs();
        assert!(
            part < 0.01,
            "energy error {} J, {part} of the drive's work",
            record.energy_error
        );
    }
}

/// Difference of the means, sum of the ranges.
fn mean_and_range(figure: &Figure) -> (f64, f64) {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let range = |x: &[f64]| x.iter().copied().fold(f64::MIN, f64::max) - x.iter().copied().fold(f64::MAX, f64::min);
    (
        (mean(&figure.runs) - mean(&figure.fine)).abs(),
        range(&figure.runs) + range(&figure.fine),
    )
}

/// Distance of two RMS profiles relative to their size.
fn profile_distance(a: &[f64], b: &[f64]) -> f64 {
    let norm = |x: &mut dyn Iterator<Item = f64>| x.map(|v| v * v).sum::<f64>().sqrt();
    norm(&mut a.iter().zip(b).map(|(x, y)| x - y)) / norm(&mut a.iter().copied())
}

/// The table by which scheme and step were chosen.
#[test]
#[ignore = "takes half an hour"]
fn schemes_and_steps() {
    let with = |scheme: &str, key: &str, value: f64, step: f64| {
        let config = configured(0.235, step).with_value("solver.rho_infinity", 0.5).unwrap();
        let text = config.to_yaml().unwrap();
        let given = |line: &str| line.trim_start().split(':').next().unwrap_or_default().to_owned();
        let text: String = text
            .lines()
            .filter(|line| !["scheme", "gamma", "rho_infinity"].contains(&given(line).as_str()))
            .map(|line| match given(line).as_str() {
                "solver" => format!("solver:\n  scheme: {scheme}\n  {key}: {value}\n"),
                _ => format!("{line}\n"),
            })
            .collect();
        Config::from_text("schemes_and_steps", &text).unwrap()
    };
    let duration = 30.0;
    // Intervals of 20 ms are whole numbers of every step.
    let motion = Course {
        inputs: RATED,
        duration,
        interval: 0.02,
    };
    let run = |config: &Config| Record::run(config, &motion, 0.0);
    let fine = run(&with("generalised_alpha", "rho_infinity", 0.8, 6.25e-5)).unwrap();
    println!("ripple {:.4}, whirl {:.4}", fine.ripple(), fine.whirl_ratio);
    for step in [2.5e-4, 5e-4, 8e-4, 1e-3] {
        let mut runs = vec![("newmark", "gamma", 0.55), ("hht", "rho_infinity", 0.8)];
        runs.extend([1.0, 0.8, 0.5, 0.4, 0.3, 0.0].map(|rho| ("generalised_alpha", "rho_infinity", rho)));
        for (scheme, key, value) in runs {
            let config = with(scheme, key, value, step);
            let got = match run(&config) {
                Ok(got) => got,
                Err(failure) => {
                    println!("{step} s {scheme} {value}: {failure}");
                    continue;
                }
            };
            println!(
                "{step} s {scheme} {value}: profile {:.4}, ripple {:.4}, whirl {:.4}, iterations/s {:.0}, energy error {:.4} %",
                profile_distance(&fine.rms, &got.rms),
                got.ripple(),
                got.whirl_ratio,
                got.iterations,
                100.0 * got.energy_error_ratio()
            );
        }
    }
}
