//! Logs with known truth from a soft string on a bit of Detournay and Defourny, both in closed form: how near the
//! estimates are, how often their 90 % bands hold the truth, and what is called not identifiable. The surrogates see
//! the closed form at the points of a design, as they see the twin's runs; `cargo xtask measure --cases calibration`
//! has full runs for both.
//!
//! What a log has, as real sensors do:
//! - torque of the top drive: white noise of 15 N m (4 % of 350 N m) at 1 Hz, a drift of 5 N m per root of an hour, and an
//!   offset that 90 % of the time is within 50 N m;
//! - hook load: 2 kN, 1 kN per root of an hour, an offset within 20 kN;
//! - torque and weight above the bit, where there is such a tool: 10 N m and 400 N, no drift: they are tared downhole.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail by panicking")]

use flexdrill_calibration::fit::{Outcome, Problem, observations};
use flexdrill_calibration::identify::Verdict;
use flexdrill_calibration::smoother::SmootherSettings;
use flexdrill_calibration::study::overlay::{self, Provenance};
use flexdrill_calibration::study::point::{Figures, Load};
use flexdrill_calibration::study::points::{Cover, design};
use flexdrill_calibration::study::unknowns::Unknowns;
use flexdrill_calibration::study::{self, Study};
use flexdrill_calibration::surrogate::usual_points;
use flexdrill_calibration::windows::{Activity, Channel, Sample, WindowSettings, Windows, find};
use flexdrill_config::Config;
use flexdrill_core::tool::{HoleInterval, SectionProperties};

/// Logs of a usual run. Fewer than 31 of 40 bands hold a truth that nine of ten hold once in 100 times (binomial).
const FEW: u64 = 40;
const LEAST_OF_FEW: u32 = 31;
/// Logs that decide whether 80 to 95 of 100 bands hold the truth: the count scatters by 1.3 of 100.
const MANY: u64 = 500;
/// Radius of the arc (m), and of the bit.
const ARC: f64 = 3.2;
const BIT: f64 = 0.059;

struct World {
    config: Config,
    unknowns: Unknowns,
    /// Of every channel.
    problem: Problem,
}

/// A tool in a right angle of 3.2 m, and 20 m of level hole after it where `level`. The weight at the bit is what the
/// wall's friction leaves of that at the surface, as `flexdrill verify --only capstan_intervals` holds the twin to.
fn world(level: bool) -> World {
    let text = include_str!("../../../tests/data/short_rig.yaml")
        .replace("radius: 1.2, build_angle_deg: 60", "radius: 3.2, build_angle_deg: 90")
        .replace("limit_deg: 13.0", "limit_deg: 13.0, friction: 0.1")
        .replace("links: 6", "links: 33");
    let arc = Config::from_text("arc.yaml", &text).unwrap();
    let config = if level { arc.with_links(165).unwrap() } else { arc };
    let unknowns = Unknowns::of(&config).unwrap();
    let modelled = unknowns.modelled.len();
    let rpm = |rpm: f64| rpm * std::f64::consts::TAU / 60.0;
    let mut points = Vec::new();
    for (motion, weight, inputs) in [
        (Activity::OffBottom, [0.0; 2], modelled + 1),
        (Activity::Drilling, [9e3, 21e3], modelled + 2),
    ] {
        let cover = Cover {
            motion,
            rotary_speed: [rpm(35.0), rpm(65.0)],
            weight,
            points: usual_points(inputs),
        };
        points.extend(design(modelled, &cover, 1));
    }
    for point in &mut points {
        point.found = Some(Ok(soft_string(&config, &unknowns, &point.z, &point.load)));
    }
    let problem = study::problem(&config, &unknowns, &everywhere(), &points).unwrap();
    World {
        config,
        unknowns,
        problem,
    }
}

/// The figures of a soft string with standardised unknowns. Torques along the tool are of the size of a rig's.
fn soft_string(config: &Config, unknowns: &Unknowns, z: &[f64], load: &Load) -> Figures {
    let values: Vec<f64> = unknowns
        .modelled
        .iter()
        .zip(z)
        .map(|(modelled, z)| modelled.unknown.value(*z))
        .collect();
    let (inside, arc, after, bit, joints) = match *values.as_slice() {
        [inside, arc, after, bit, joints] => (inside, arc, after, bit, joints),
        [inside, arc, bit, joints] => (inside, arc, 0.0, bit, joints),
        _ => panic!("other unknowns: {values:?}"),
    };
    let tool = config.tool();
    let weight = |tube| tool.gravity * SectionProperties::of(tube, tool.material, 1.0).mass;
    let guide = weight(tool.guide_section);
    let whole = guide + weight(tool.pipe_sections[0]);
    let level = config.well.length() - ARC * std::f64::consts::FRAC_PI_2;
    // In small steps down the arc, as in `flexdrill reach`.
    let (mut on_bit, steps) = (load.weight, 2000);
    let turn = std::f64::consts::FRAC_PI_2 / f64::from(steps);
    for step in 0..steps {
        let (sin, cos) = ((f64::from(step) + 0.5) * turn).sin_cos();
        on_bit += (ARC * guide * cos - arc * (on_bit + ARC * whole * sin)) * turn;
    }
    let on_bit = match load.motion {
        Activity::OffBottom => 0.0,
        Activity::Drilling => on_bit - after * whole * level.max(0.0),
    };
    // The wear flats carry up to their force; what is beyond cuts.
    let rock = &config.rock.depth_of_cut;
    let on_flats = on_bit.min(rock.wear_flat_force);
    let bit_torque = 0.5 * BIT * (bit * on_flats + (on_bit - on_flats) / rock.cutter_inclination);
    let torque = bit_torque * (1.0 + 0.6 * joints) + 40.0 * inside + 20.0 * joints;
    [torque, 130e3 - load.weight, bit_torque, on_bit]
}

/// Windows of both states of motion that have every channel.
fn everywhere() -> Windows {
    let mut samples = Vec::new();
    for weight in [0.0, 10e3] {
        for second in 0..80 {
            let ripple = 0.01 * f64::from(second % 3);
            samples.push(Sample {
                time: samples.len() as f64,
                row: samples.len() as u64,
                rotary_speed: 5.0,
                weight,
                measured: [1.0 + ripple; 4],
            });
        }
    }
    find(&samples, &WindowSettings::default())
}

/// Standard normal numbers of a seed.
struct Normal(fastrand::Rng);

impl Normal {
    fn next(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.0.f64()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.0.f64()).cos()
    }
}

/// Parts of the log: speed (r/min), weight (kN), seconds. 40 minutes with three times off bottom. At the lightest
/// weights no tool of the prior cuts, at the heaviest every one does.
fn schedule() -> Vec<(f64, f64, u32)> {
    let mut all = Vec::new();
    for (rpm, kn) in [(40.0, 10.0), (60.0, 20.0), (50.0, 14.0)] {
        all.push((rpm, 0.0, 90));
        all.push((rpm, kn, 240));
        all.push((rpm + 4.0, kn - 1.0, 240));
        all.push((rpm, kn - 3.0 + 0.3 * (kn - 10.0), 240));
    }
    all
}

/// The samples of a schedule with noise, drift and tares.
fn log(world: &World, truth: &[f64], schedule: &[(f64, f64, u32)], random: &mut Normal) -> Vec<Sample> {
    let modelled = world.unknowns.modelled.len();
    let tares = [
        world.unknowns.torque_tare.value(truth[modelled]),
        world.unknowns.hook_load_tare.value(truth[modelled + 1]),
        0.0,
        0.0,
    ];
    let noise = [15.0, 2e3, 10.0, 400.0];
    let drift = [5.0, 1e3, 0.0, 0.0].map(|hour: f64| hour / 60.0);
    let (mut walk, mut samples) = ([0.0; 4], Vec::new());
    for &(rpm, kn, seconds) in schedule {
        let load = Load {
            motion: if kn > 0.0 {
                Activity::Drilling
            } else {
                Activity::OffBottom
            },
            rotary_speed: rpm * std::f64::consts::TAU / 60.0,
            weight: 1e3 * kn,
        };
        let exact = soft_string(&world.config, &world.unknowns, &truth[..modelled], &load);
        for _ in 0..seconds {
            let mut measured = [f64::NAN; 4];
            for k in 0..measured.len() {
                walk[k] += drift[k] * random.next();
                measured[k] = exact[k] + tares[k] + walk[k] + noise[k] * random.next();
            }
            let row = samples.len() as u64;
            samples.push(Sample {
                time: row as f64,
                row: row + 2,
                rotary_speed: load.rotary_speed,
                weight: load.weight,
                measured,
            });
        }
    }
    samples
}

/// What one log gives, with its truth.
struct Trial {
    truth: Vec<f64>,
    problem: Problem,
    outcome: Outcome,
    windows: Windows,
}

fn trial(world: &World, seed: u64, channels: &[Channel], schedule: &[(f64, f64, u32)]) -> Trial {
    let mut random = Normal(fastrand::Rng::with_seed(seed));
    let truth: Vec<f64> = (0..world.unknowns.modelled.len() + 2)
        .map(|_| random.next().clamp(-2.0, 2.0))
        .collect();
    let mut samples = log(world, &truth, schedule, &mut random);
    for sample in &mut samples {
        for channel in Channel::ALL.into_iter().filter(|channel| !channels.contains(channel)) {
            sample.measured[channel as usize] = f64::NAN;
        }
    }
    let windows = find(&samples, &WindowSettings::default());
    let mut problem = world.problem.clone();
    problem.observations = observations(&windows, &problem.quantities);
    let smoother = SmootherSettings {
        members: 1000,
        seed,
        ..SmootherSettings::default()
    };
    let outcome = problem.fit(&smoother).unwrap();
    Trial {
        truth,
        problem,
        outcome,
        windows,
    }
}

/// Counts over all logs, per unknown.
#[derive(Default, Clone, Debug)]
struct Count {
    covered: u32,
    identified: u32,
    bounded: u32,
    combined: u32,
    not_identifiable: u32,
    /// Identified and within 5 % (of a tare: of its prior's 90 % range).
    near: u32,
    /// Within 5 %, whatever the verdict.
    within: u32,
    /// Mean of the variance ratios.
    ratio: f64,
}

fn counts(world: &World, channels: &[Channel], logs: u64) -> (Vec<Count>, f64) {
    let mut all = vec![Count::default(); world.unknowns.modelled.len() + 2];
    let (mut misfit, mut explained) = (0.0, 0);
    for seed in 1..=logs {
        let trial = trial(world, seed, channels, &schedule());
        misfit += trial.outcome.misfit / logs as f64;
        explained += u32::from(trial.outcome.explains());
        assert!(trial.windows.steady.len() > 15);
        for (k, (unknown, estimate)) in trial.problem.unknowns.iter().zip(&trial.outcome.estimates).enumerate() {
            let (truth, count) = (unknown.value(trial.truth[k]), &mut all[k]);
            let [lowest, highest] = estimate.band;
            count.covered += u32::from((lowest..=highest).contains(&truth));
            count.ratio += estimate.variance_ratio / logs as f64;
            let [low, high] = unknown.prior();
            let size = if low > 0.0 { truth } else { high - low };
            let within = (estimate.value - truth).abs() <= 0.05 * size;
            count.within += u32::from(within);
            match estimate.verdict {
                Verdict::NotIdentifiable => count.not_identifiable += 1,
                Verdict::InCombination => count.combined += 1,
                Verdict::Bounded => count.bounded += 1,
                Verdict::Identified => {
                    count.identified += 1;
                    count.near += u32::from(within);
                }
            }
        }
    }
    eprintln!("{explained} of {logs} logs are explained");
    // The mean square of some sixty residuals with stated errors is never above 4.
    assert!(100 * explained >= 98 * logs as u32, "{explained} of {logs}");
    (all, misfit)
}

fn shown(world: &World, counts: &[Count]) -> String {
    let names = world.problem.unknowns.iter().map(|unknown| unknown.name.as_str());
    names
        .zip(counts)
        .map(|(name, count)| format!("{name}: {count:?}\n"))
        .collect()
}

/// The counts of so many logs, of which at least some bands hold the truth, and 5 % where an unknown is identified.
fn checked(channels: &[Channel], logs: u64, least: u32) -> Vec<Count> {
    let world = world(false);
    let (counts, misfit) = counts(&world, channels, logs);
    let text = shown(&world, &counts);
    eprintln!("{text}misfit {misfit:.2}");
    for count in &counts {
        assert!(count.covered >= least, "{text}");
        // The band of an identified unknown is at most 5 % wide to each side, and holds nine of ten truths; a few logs
        // identify one that most do not, and say less.
        assert!(
            count.identified < 20 || 10 * count.near >= 8 * count.identified,
            "{text}"
        );
    }
    counts
}

const SURFACE: [Channel; 2] = [Channel::SurfaceTorque, Channel::HookLoad];

#[test]
fn surface_and_downhole_measurements() {
    let counts = checked(&Channel::ALL, FEW, LEAST_OF_FEW);
    let [inside, wall, bit, joints, torque, hook_load] = counts.as_slice() else {
        panic!("six unknowns");
    };
    // The pipe rubs in the guide with a few of 300 N m: nothing can be said of its coefficient.
    assert!(inside.not_identifiable >= 36, "{inside:?}");
    // The weight that does not arrive at the bit shows the friction of the guide on the wall.
    assert!(
        wall.not_identifiable == 0 && wall.near + wall.bounded >= 36 && wall.ratio < 0.1,
        "{wall:?}"
    );
    assert!(
        bit.not_identifiable == 0 && joints.not_identifiable <= 2,
        "{bit:?} {joints:?}"
    );
    for tare in [torque, hook_load] {
        assert!(tare.identified == 40 && tare.near >= 38, "{tare:?}");
    }
}

#[test]
fn surface_measurements_alone() {
    let counts = checked(&SURFACE, FEW, LEAST_OF_FEW);
    assert!(counts[0].not_identifiable >= 36, "{:?}", counts[0]);
}

/// Friction in the arc takes a share of the weight, friction after it a constant part. Where the weight varies, a sub
/// above the bit tells one from the other.
#[test]
fn arc_and_straight_part_are_told_apart() {
    let world = world(true);
    let logs = 20;
    let (counts, misfit) = counts(&world, &Channel::ALL, logs);
    eprintln!("{}misfit {misfit:.2}", shown(&world, &counts));
    for wall in &counts[1..3] {
        // A 90 % band misses 2 of 20 truths, and more than 6 of them once in 400 (binomial).
        assert!(wall.covered >= 14 && wall.identified + wall.bounded == 20, "{wall:?}");
        // The surrogate of a soft string is better than one of the twin's runs.
        assert!(wall.within >= 18 && wall.ratio < 0.1, "{wall:?}");
    }
}

#[test]
fn at_one_weight_arc_and_straight_part_are_known_in_combination_only() {
    let world = world(true);
    let one: Vec<(f64, f64, u32)> = (0..12)
        .map(|part| (45.0, if part % 4 == 0 { 0.0 } else { 15.0 }, 300))
        .collect();
    let combined = (1..=10).filter(|seed| {
        let outcome = trial(&world, *seed, &Channel::ALL, &one).outcome;
        outcome.pairs.iter().any(|pair| pair.unknowns == [1, 2])
    });
    let combined = combined.count();
    assert!(combined >= 8, "{combined} of 10 logs");
}

/// The overlay's keys, set over the configuration, give the coefficients that were fitted.
#[test]
fn the_overlay_gives_the_coefficient_of_each_interval() {
    let world = world(true);
    let trial = trial(&world, 3, &Channel::ALL, &schedule());
    let study = Study {
        unknowns: world.unknowns.clone(),
        windows: trial.windows,
        refused: Vec::new(),
        failed: Vec::new(),
        problem: trial.problem,
        outcome: trial.outcome,
        checked: Vec::new(),
    };
    let provenance = Provenance {
        log: "log.csv".to_owned(),
        sha256: String::new(),
        rows: [2, 3],
        configuration: world.config.hash(),
        version: String::new(),
        seed: 3,
    };
    let text = overlay::yaml(&study, &provenance);
    let (mut path, mut keys): (Vec<&str>, Vec<(String, f64)>) = (Vec::new(), Vec::new());
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (name, rest) = line.trim_start().split_once(':').unwrap();
        path.truncate((line.len() - line.trim_start().len()) / 2);
        path.push(name);
        let value = rest.split('#').next().unwrap().trim();
        if !value.is_empty() {
            keys.push((path.join("."), value.parse().unwrap()));
        }
    }
    let read = world.config.with_values("overlay", keys).unwrap();
    assert_eq!(read, overlay::apply(&world.config, &study).unwrap());
    let tool = read.tool();
    for (index, interval) in [(1, HoleInterval::Arc), (2, HoleInterval::AfterArc)] {
        let fitted = study.outcome.estimates[index].value;
        let got = tool.outer.friction_axial * tool.wall_friction_factors.of(interval);
        // The file has six digits.
        assert!((got / fitted - 1.0).abs() < 5e-6, "{got} against {fitted}\n{text}");
    }
    assert!(text.contains("friction of guide on wall after the arc 0."), "{text}");
}

/// As above, with so many logs that chance does not decide:
///
///     cargo test --release -p flexdrill-fit --test acceptance -- --ignored --nocapture
#[test]
#[ignore = "some ten minutes"]
fn the_bands_of_five_hundred_logs_hold_the_truth_in_at_least_80_of_100() {
    for channels in [&Channel::ALL[..], &SURFACE] {
        checked(channels, MANY, 80 * MANY as u32 / 100);
    }
}

#[test]
fn the_same_log_and_seed_give_the_same_bits() {
    let world = world(false);
    let run = || trial(&world, 7, &Channel::ALL, &schedule()).outcome;
    assert_eq!(run(), run());
}
