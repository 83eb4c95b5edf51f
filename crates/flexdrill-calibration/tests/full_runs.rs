//! A log that a run of the twin itself made second by second, with known truth, noise and drift, calibrated with its
//! own design and checked by full runs: `cargo test --release -p flexdrill-calibration --test full_runs -- --ignored
//! --nocapture`.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use flexdrill_calibration::identify::Verdict;
use flexdrill_calibration::study::cover;
use flexdrill_calibration::study::points::{design, run};
use flexdrill_calibration::study::unknowns::Unknowns;
use flexdrill_calibration::study::{StudySettings, study};
use flexdrill_calibration::windows::{Activity, Channel, Sample, WindowSettings, find};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_motion::{BIT, SURFACE};

/// Speed (r/min), weight (kN) and seconds of the parts: two connections with rotation off bottom.
const SCHEDULE: [(f64, f64, u32); 7] = [
    (40.0, 0.0, 90),
    (40.0, 8.0, 100),
    (45.0, 14.0, 100),
    (55.0, 17.0, 100),
    (55.0, 0.0, 75),
    (60.0, 12.0, 100),
    (50.0, 10.0, 100),
];

/// Truth: standardised friction of pipe in guide, of guide on wall, of the bit; inclination of the cutters, force of the wear
/// flats, energy of the rock.
const TRUTH: [f64; 6] = [1.0, -0.8, 0.7, -0.5, 0.9, 0.4];
/// Factor and tare (N) of the weight indicator: what it shows is not what acts.
const INDICATOR: [f64; 2] = [1.03, -500.0];
/// Offsets of torque (N m) and hook load (N), noise and drift per root of an hour of all channels. The rate of penetration
/// scatters by 1.8 m/h.
const TARES: [f64; 5] = [18.0, -6e3, 0.0, 0.0, 0.0];
const NOISE: [f64; 5] = [15.0, 2e3, 10.0, 400.0, 5e-4];
const DRIFT: [f64; 5] = [5.0, 1e3, 0.0, 0.0, 0.0];

fn normal(random: &mut fastrand::Rng) -> f64 {
    (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (std::f64::consts::TAU * random.f64()).cos()
}

/// The log at 1 Hz: what the twin's transfer says over each second, with the errors of the sensors.
fn log(config: &Config) -> Vec<Sample> {
    let config = config
        .with_values(
            "truth",
            [("transfer.window", 1.0), ("inputs.weight_on_bit.initial_kn", 0.0)],
        )
        .unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let per_second = (1.0 / simulation.settings().time_step).round() as u64;
    let mut snapshot = simulation.new_snapshot();
    let mut random = fastrand::Rng::with_seed(5);
    let (mut walk, mut samples) = ([0.0; 5], Vec::new());
    for (rpm, kn, seconds) in SCHEDULE {
        let inputs = Inputs {
            rotary_speed: rpm * std::f64::consts::TAU / 60.0,
            weight_on_bit: 1e3 * kn,
            ..Inputs::default()
        };
        for _ in 0..seconds {
            for _ in 0..per_second {
                assert!(!matches!(simulation.advance(&inputs), StepOutcome::Failed(_)));
            }
            simulation.set_refinement(simulation.quality().choice.wanted);
            simulation.snapshot(&mut snapshot, true);
            let mean = &snapshot.transfer.mean;
            let exact = [
                mean.torque[SURFACE],
                mean.hook_load,
                mean.torque[BIT],
                mean.weight[BIT],
                if kn > 0.0 { mean.rate_of_penetration } else { f64::NAN },
            ];
            let mut measured = [0.0; 5];
            for k in 0..5 {
                walk[k] += DRIFT[k] / 60.0 * normal(&mut random);
                measured[k] = exact[k] + TARES[k] + walk[k] + NOISE[k] * normal(&mut random);
            }
            let row = samples.len() as u64;
            samples.push(Sample {
                time: row as f64,
                row: row + 2,
                rotary_speed: inputs.rotary_speed,
                weight: match kn {
                    0.0 => 0.0,
                    _ => INDICATOR[0] * inputs.weight_on_bit + INDICATOR[1],
                },
                measured,
            });
        }
    }
    samples
}

#[test]
#[ignore = "11 minutes of the short tool and some hundred full runs: some minutes"]
fn a_log_of_the_twin_gives_its_truth_back() {
    let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/short_rig.yaml")).unwrap();
    let unknowns = Unknowns::of(&config).unwrap();
    let truth: Vec<f64> = unknowns
        .modelled
        .iter()
        .zip(TRUTH)
        .map(|(modelled, z)| modelled.unknown.value(z))
        .collect();
    let samples = log(&unknowns.apply(&config, &truth).unwrap());
    let windows = find(&samples, &WindowSettings::default());
    eprintln!(
        "{} windows, left out: {:?}",
        windows.steady.len(),
        windows.left_out_by_reason()
    );
    let covers: Vec<_> = [Activity::OffBottom, Activity::Drilling]
        .into_iter()
        .filter_map(|motion| cover(&config, &unknowns, &windows, motion))
        .collect();
    let points = covers.iter().flat_map(|cover| design(&unknowns, cover, 1)).collect();
    let points = run(&config, &unknowns, points, 2, |_, _| {});
    let settings = StudySettings {
        jobs: 2,
        seed: 1,
        members: 1000,
    };
    let study = study(&config, unknowns, windows, &points, &settings).unwrap();
    let mut all = truth;
    // The rate of penetration is that of the twin, without an error.
    all.extend([TARES[0], TARES[1], INDICATOR[0], INDICATOR[1], 1.0]);
    for ((unknown, estimate), truth) in study.problem.unknowns.iter().zip(&study.outcome.estimates).zip(&all) {
        eprintln!("{}: truth {truth:.4}, {estimate:?}", unknown.name);
        if estimate.verdict != Verdict::NotIdentifiable {
            // A 90 % band misses one truth of ten; twice its width misses one of a thousand.
            let [low, high] = estimate.band;
            let half = 0.5 * (high - low);
            assert!((low - half..=high + half).contains(truth), "{}", unknown.name);
        }
    }
    for checked in &study.checked {
        eprintln!("{checked:?}");
        if checked.channel == Channel::SurfaceTorque {
            let run = checked.run.as_ref().unwrap();
            // Twice the 90 % band, as above.
            assert!((run - checked.measured).abs() <= 2.0 * checked.band, "{checked:?}");
        }
    }
    assert!(study.objections().is_empty(), "{:?}", study.objections());
}
