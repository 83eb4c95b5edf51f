//! Whirl analysis on orbits with known answers.

mod synthetic_orbits;

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use flexdrill::analysis::{Severity, WhirlKind, WhirlSettings};
use proptest::prelude::*;
use synthetic_orbits::{Bench, CLEARANCE, Ellipse, Labelled, Random, SAMPLE_INTERVAL, circle};

/// 40 r/min.
const SPEED: f64 = 40.0 * TAU / 60.0;

fn rotor(radius: f64, rate: f64) -> impl Fn(f64) -> [f64; 2] + Copy {
    move |time| [radius * (rate * time).cos(), radius * (rate * time).sin()]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any ellipse that is no line: kind, ratio within 3 % (two windows of whole turns and parts of turns), radius.
    #[test]
    fn ellipses_are_named_and_measured(
        ratio in 0.4f64..5.0, backward: bool, size in 0.2f64..1.0, flat in 0.4f64..1.0, tilt in 0.0f64..3.0,
        rpm in 20.0f64..120.0,
    ) {
        let speed = rpm * TAU / 60.0;
        let ratio = if backward { -ratio } else { ratio };
        let orbit = Ellipse {
            major: size * CLEARANCE, minor: flat * size * CLEARANCE, tilt, rate: ratio * speed, phase: 0.3,
        };
        let mut bench = Bench::new();
        let kind = bench.run(speed, 10.0 * TAU / speed, |time| orbit.at(time));
        prop_assert_eq!(kind, if backward { WhirlKind::Backward } else { WhirlKind::Forward });
        // A window that does not hold whole turns sees an ellipse off its centre: 10 % below one whirl turn per tool turn.
        let tolerance = if ratio.abs() < 1.0 || flat < 0.7 { 0.1 } else { 0.03 };
        prop_assert!((bench.ratio() / ratio - 1.0).abs() < tolerance, "ratio {} for {}", bench.ratio(), ratio);
        let radius = bench.report.orbit_radius[0];
        prop_assert!((radius / orbit.power().sqrt() - 1.0).abs() < 0.12, "radius {radius}");
        prop_assert!(bench.report.confidence[0] > 0.8, "confidence {}", bench.report.confidence[0]);
    }

    /// Turning the tool the other way and mirroring the motion changes nothing but the sign convention.
    #[test]
    fn direction_is_relative_to_the_rotation(ratio in 0.5f64..4.0, size in 0.2f64..1.0) {
        let orbit = rotor(size * CLEARANCE, ratio * SPEED);
        let mut one = Bench::new();
        let mut other = Bench::new();
        prop_assert_eq!(one.run(SPEED, 10.0, orbit), WhirlKind::Forward);
        let mirrored = other.run(-SPEED, 10.0, |time| { let [y, z] = orbit(time); [y, -z] });
        prop_assert_eq!(mirrored, WhirlKind::Forward);
        prop_assert!((one.ratio() - other.ratio()).abs() < 1e-9);
    }

    /// Planar motion in any direction and at any rate is no whirl.
    #[test]
    fn planar_motion_is_no_whirl(rate in 0.5f64..5.0, tilt in 0.0f64..3.2, flat in -0.15f64..0.15) {
        let line = Ellipse {
            major: 0.8 * CLEARANCE, minor: flat * CLEARANCE, tilt, rate: rate * SPEED, phase: 0.0,
        };
        prop_assert_eq!(Bench::new().run(SPEED, 12.0, |time| line.at(time)), WhirlKind::None);
    }

    /// Below the smallest orbit nothing is called whirl, whatever its direction.
    #[test]
    fn noise_and_small_orbits_are_no_whirl(size in 0.0f64..0.07, ratio in -5.0f64..5.0, seed: u64) {
        let mut random = Random(seed);
        let orbit = rotor(size * CLEARANCE, ratio * SPEED);
        let kind = Bench::new().run(SPEED, 12.0, |time| orbit(time).map(|at| at + 0.03 * CLEARANCE * random.normal()));
        prop_assert_eq!(kind, WhirlKind::None);
    }

    /// Whatever is pushed, nothing is out of its range and nothing panics.
    #[test]
    fn outputs_stay_in_their_ranges(seed: u64, jump in 0.0f64..3.0) {
        let mut random = Random(seed);
        let mut bench = Bench::new();
        for step in 0..4000u32 {
            if step % 700 == 699 {
                bench.skip(jump);
            }
            let speed = SPEED * random.within(-1.0, 2.0);
            let at = [random.normal() * CLEARANCE, random.normal() * CLEARANCE];
            bench.push(speed, at, random.within(-1.0, 1.0).max(0.0) * 1e4);
            let report = &bench.report;
            prop_assert!((0.0..=1.0).contains(&report.confidence[0]) && (0.0..=1.0).contains(&report.contact_duty[0]));
            prop_assert!(report.orbit_radius[0].is_finite() && report.whirl_ratio[0].is_finite());
        }
    }
}

/// From rest and from the opposite direction the new kind stands within two turns of the new whirl.
#[test]
fn detected_within_two_whirl_turns() {
    let mut late = 0;
    for ratio in [0.5, 1.0, 1.0 / 0.7, 2.0, 3.7] {
        for sign in [1.0, -1.0] {
            let turn = TAU / (ratio * SPEED);
            let orbit = rotor(0.8 * CLEARANCE, sign * ratio * SPEED);
            let against = rotor(0.8 * CLEARANCE, -sign * ratio * SPEED);
            let expected = if sign > 0.0 {
                WhirlKind::Forward
            } else {
                WhirlKind::Backward
            };
            for (name, before) in [("rest", None), ("the other direction", Some(against))] {
                let mut bench = Bench::new();
                bench.run(SPEED, 15.0, |time| {
                    before.map_or([0.0, 0.5 * CLEARANCE], |motion| motion(time))
                });
                assert_ne!(bench.kind(), expected);
                let mut delay = None;
                for step in 0..(4.0 * turn / SAMPLE_INTERVAL) as usize {
                    let time = step as f64 * SAMPLE_INTERVAL;
                    if bench.push(SPEED, orbit(time), 0.0) == expected && delay.is_none() {
                        delay = Some(time / turn);
                    }
                }
                assert_eq!(bench.kind(), expected);
                println!(
                    "ratio {:5.2} from {name}: {:.2} turns",
                    sign * ratio,
                    delay.unwrap_or(f64::NAN)
                );
                late += u32::from(delay.is_none_or(|turns| turns > 2.0));
            }
        }
    }
    assert_eq!(late, 0, "later than two turns");
}

/// A rotary speed that climbs from 30 to 90 r/min in 20 s: synchronous whirl stays forward and its ratio near 1.
#[test]
fn whirl_is_followed_through_a_change_of_speed() {
    let mut bench = Bench::new();
    let mut angle = 0.0;
    let mut worst: f64 = 0.0;
    let mut steady = 0;
    for step in 0..6000 {
        let speed = (TAU / 60.0) * (30.0 + 60.0 * (f64::from(step) - 1000.0).clamp(0.0, 5000.0) / 5000.0);
        angle += speed * SAMPLE_INTERVAL;
        let kind = bench.push(
            speed,
            [0.6 * CLEARANCE * f64::cos(angle), 0.6 * CLEARANCE * f64::sin(angle)],
            0.0,
        );
        // After two windows at the first speed.
        if step > 2200 {
            assert_eq!(kind, WhirlKind::Forward, "step {step}");
            worst = worst.max((bench.ratio() - 1.0).abs());
            steady += 1;
        }
    }
    assert!(steady > 3000 && worst < 0.05, "ratio off by up to {worst}");
}

/// A short gap is bridged; a long one restarts the window and nothing is claimed until it has refilled.
#[test]
fn gaps_are_bridged_or_restart_the_window() {
    let orbit = rotor(0.7 * CLEARANCE, -2.0 * SPEED);
    let mut bench = Bench::new();
    assert_eq!(bench.run(SPEED, 10.0, orbit), WhirlKind::Backward);
    bench.skip(0.06);
    for step in 0..250 {
        let time = bench.time + SAMPLE_INTERVAL * if step == 0 { 16.0 } else { 1.0 };
        assert_eq!(
            bench.push(SPEED, orbit(time), 0.0),
            WhirlKind::Backward,
            "after a short gap"
        );
    }
    bench.skip(1.0);
    assert_eq!(bench.push(SPEED, orbit(bench.time), 0.0), WhirlKind::None);
    assert_eq!(bench.report.confidence[0], 0.0);
    assert_eq!(bench.run(SPEED, 8.0, orbit), WhirlKind::Backward);
}

/// Rolling backward whirl with strikes: the level rises in order, says where and why, and stays through a pause that is
/// shorter than the hold-off.
#[test]
fn level_rises_holds_and_names_its_evidence() {
    let settings = WhirlSettings::default();
    let rolling = -63.0 / 17.0;
    let orbit = rotor(1.02 * CLEARANCE, rolling * SPEED);
    let mut bench = Bench::with(&settings);
    let mut seen = vec![Severity::Ok];
    for step in 0..3000 {
        bench.push(SPEED, orbit(f64::from(step) * SAMPLE_INTERVAL), 25e3);
        let severity = bench.analysis.level().severity;
        if seen.last() != Some(&severity) {
            seen.push(severity);
        }
    }
    assert_eq!(seen.first(), Some(&Severity::Ok));
    assert_eq!(seen.last(), Some(&Severity::Critical));
    assert!(seen.is_sorted(), "{seen:?}");
    let level = bench.analysis.level();
    assert_eq!(level.kind, WhirlKind::Backward);
    assert!((level.whirl_ratio / rolling - 1.0).abs() < 0.03, "{level:?}");
    assert!(
        level.contact_duty > 0.99 && (level.clearance_ratio - 1.02).abs() < 1e-3,
        "{level:?}"
    );
    let sequence = level.sequence;
    bench.run(SPEED, 4.0, |_| [0.0; 2]);
    assert_eq!(bench.analysis.level().severity, Severity::Critical);
    bench.run(SPEED, 60.0, |_| [0.0; 2]);
    let after = bench.analysis.level();
    assert_eq!(after.severity, Severity::Ok);
    assert!(after.sequence > sequence && after.since > level.since);
}

/// Forward whirl whose size wavers around the smallest orbit: one change at most.
#[test]
fn no_flapping_at_the_smallest_orbit() {
    let settings = WhirlSettings::default();
    let mut bench = Bench::new();
    let mut changes = 0;
    let mut last = WhirlKind::None;
    for step in 0..20_000 {
        let time = f64::from(step) * SAMPLE_INTERVAL;
        let size = settings.min_orbit_ratio * (1.0 + 0.06 * (0.9 * time).sin()) * CLEARANCE;
        let kind = bench.push(SPEED, rotor(size, SPEED)(time), 0.0);
        changes += u32::from(kind != last);
        last = kind;
    }
    assert!(changes <= 1, "{changes} changes");
}

/// A checkpoint goes on with the same bits.
#[test]
fn serialised_state_continues_bit_for_bit() {
    let mut random = Random(5);
    let orbit = circle(0.7 * CLEARANCE, 2.3 * SPEED, &mut random);
    let mut one = Bench::new();
    one.run(SPEED, 7.3, |time| orbit.at(time));
    let state = serde_json::to_value(&one.analysis).unwrap();
    let mut other = Bench::new();
    other.run(SPEED, 7.3, |_| [0.0; 2]);
    other.analysis = serde_json::from_value(state).unwrap();
    for bench in [&mut one, &mut other] {
        bench.run(SPEED, 3.0, |time| orbit.at(time + 7.3));
    }
    let states = [&one, &other].map(|bench| serde_json::to_value(&bench.analysis).unwrap());
    assert!(states[0] == states[1]);
    assert_eq!(one.report, other.report);
}

/// 2,000 generated orbits with noise 20 dB below the motion. Prints the table that `docs/whirl.md` shows
/// (`cargo test --release --test property_whirl confusion -- --nocapture`).
#[test]
fn confusion_table_of_generated_orbits() {
    const COUNT: usize = 2000;
    let kinds = [
        WhirlKind::None,
        WhirlKind::Forward,
        WhirlKind::Backward,
        WhirlKind::Chaotic,
    ];
    let mut table = [[0u32; 4]; 4];
    let mut families: BTreeMap<&str, [u32; 2]> = BTreeMap::new();
    let mut ratio_errors = Vec::new();
    let mut random = Random(2024);
    for index in 0..COUNT {
        let labelled = Labelled::generate(index, &mut random);
        let mut bench = Bench::new();
        let mut noise = Random(index as u64);
        let got = bench.run(labelled.rotary_speed, labelled.duration(), |time| {
            labelled.at(time, &mut noise)
        });
        table[labelled.kind as usize][got as usize] += 1;
        let right = got == labelled.kind;
        let counts = families.entry(labelled.family).or_default();
        counts[0] += u32::from(right);
        counts[1] += 1;
        if let (true, Some(ratio)) = (right, labelled.ratio) {
            ratio_errors.push((bench.ratio() / ratio - 1.0).abs());
        }
    }
    println!(
        "{:>10} {:>8} {:>8} {:>8} {:>8}",
        "is \\ called", "none", "forward", "backward", "chaotic"
    );
    for (kind, row) in kinds.iter().zip(&table) {
        println!(
            "{:>10} {:>8} {:>8} {:>8} {:>8}",
            format!("{kind:?}"),
            row[0],
            row[1],
            row[2],
            row[3]
        );
    }
    for (family, [right, count]) in &families {
        println!("{family}: {right} of {count}");
    }
    ratio_errors.sort_by(f64::total_cmp);
    let at = |part: f64| ratio_errors[(part * (ratio_errors.len() - 1) as f64) as usize];
    println!(
        "ratio error: median {:.4}, 95 % {:.4}, 99 % {:.4}",
        at(0.5),
        at(0.95),
        at(0.99)
    );
    let right: u32 = (0..4).map(|kind| table[kind][kind]).sum();
    println!("right: {right} of {COUNT}");
    assert!(f64::from(right) >= 0.99 * COUNT as f64, "{right} of {COUNT}");
}
