//! The findings of synthetic records with known answers, and that a report says "no" where it must.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::f64::consts::TAU;

use flexdrill_paper::{
    Axis, Finding, Layer, Record, Series, Stations, Verdict, contact_episodes, dominant_period, findings, rms,
};

const STATIONS: usize = 31;
const RATE: f64 = 250.0;
const TURN: f64 = 1.5;
const TURNS: usize = 6;

/// What moves how in a record.
struct Motion {
    /// Whirl over rotary speed, per station.
    whirl: fn(usize) -> f64,
    /// Radius of the pipe's orbit (m).
    radius: fn(usize) -> f64,
    /// Pipe-guide force (N) at a station and a time in turns.
    inner: fn(usize, f64) -> f64,
    /// Guide-wall force.
    outer: fn(usize, f64) -> f64,
}

fn degrees(station: usize) -> f64 {
    90.0 * station as f64 / (STATIONS - 1) as f64
}

fn record(motion: &Motion) -> Record {
    let stations = Stations {
        depth: (0..STATIONS).map(|s| 0.1675 * s as f64).collect(),
        inclination: (0..STATIONS).map(|s| degrees(s).to_radians()).collect(),
        joint: (0..STATIONS).map(|s| s % 5 == 0 && s > 0 && s + 1 < STATIONS).collect(),
        position: vec![[0.0; 2]; STATIONS],
        low_side: vec![[0.0; 2]; STATIONS],
        offset: vec![[0.0; 2]; STATIONS],
        inner_clearance: vec![8.5e-3; STATIONS],
        outer_clearance: 8e-3,
        pipe_diameter: vec![0.063; STATIONS],
        guide_diameter: 0.102,
    };
    let samples = (TURN * RATE) as usize * TURNS;
    let time: Vec<f64> = (1..=samples).map(|k| k as f64 / RATE).collect();
    let rotary_speed = TAU / TURN;
    let series = |value: &dyn Fn(usize, f64) -> f64| {
        let mut series = Series::new(STATIONS);
        for &t in &time {
            series.push((0..STATIONS).map(|s| value(s, t)));
        }
        series
    };
    let phase = |s: usize, t: f64| rotary_speed * (motion.whirl)(s) * t;
    let layer = |force: fn(usize, f64) -> f64| {
        let at = |s: usize, t: f64| force(s, t / TURN);
        let sum = |f: &dyn Fn(f64) -> f64, s: usize| time.iter().map(|&t| f(at(s, t))).sum::<f64>() / samples as f64;
        Layer {
            mean: series(&at),
            peak: series(&at),
            square: (0..STATIONS).map(|s| sum(&|f| f * f, s)).collect(),
            contact: (0..STATIONS)
                .map(|s| sum(&|f| f64::from(u8::from(f > 0.0)), s))
                .collect(),
        }
    };
    let acceleration = |scale: [f64; 3]| scale.map(|a| vec![a * a; STATIONS]);
    Record {
        pipe: Axis {
            y: series(&|s, t| (motion.radius)(s) * phase(s, t).cos()),
            z: series(&|s, t| (motion.radius)(s) * phase(s, t).sin()),
            // The ripple grows with inclination.
            spin: series(&|s, t| rotary_speed * (1.0 + 1e-3 * degrees(s) * (2.0 * rotary_speed * t).sin())),
            acceleration: [Series::new(STATIONS), Series::new(STATIONS), Series::new(STATIONS)],
            acceleration_square: acceleration([1.0, 40.0, 30.0]),
        },
        guide: Axis {
            // A smooth shape that whirls as the pipe does, and stands where the whirl turns over, or it would have a
            // kink there.
            y: series(&|s, t| 1e-3 * (degrees(s).to_radians() * 4.0).sin() * phase(s, t).cos()),
            z: series(&|s, t| 1e-3 * (degrees(s).to_radians() * 4.0).sin() * phase(s, t).sin()),
            // Between -0.74 and 0.97 r/min once per turn.
            spin: series(&|_, t| TAU / 60.0 * (0.115 + 0.855 * (rotary_speed * t).sin())),
            acceleration: [Series::new(STATIONS), Series::new(STATIONS), Series::new(STATIONS)],
            acceleration_square: acceleration([1.0, 10.0, 8.0]),
        },
        inner: layer(motion.inner),
        outer: layer(motion.outer),
        drive_torque: vec![100.0; samples],
        stations,
        interval: 1.0 / RATE,
        time,
        rotary_speed,
        ..Record::default()
    }
}

/// `height` for the first `part` of every turn at the station nearest to `place` (deg), a tenth of it elsewhere.
fn pulse(station: usize, turns: f64, place: f64, part: f64, height: f64) -> f64 {
    let here = (degrees(station) - place).abs() <= 1.5;
    let on = turns.fract() < part;
    if !on {
        0.0
    } else {
        height * if here { 1.0 } else { 0.1 }
    }
}

fn zigzag(station: usize) -> f64 {
    // Kinks at joints only: a broken line that moves most at 30 and at 75 degrees, and stands where the whirl turns
    // over.
    let points = [1e-3, 3e-3, 6e-3, 0.0, 4e-3, 8e-3, 0.5e-3];
    let (link, part) = (station / 5, (station % 5) as f64 / 5.0);
    let next = points[(link + 1).min(points.len() - 1)];
    points[link] + (next - points[link]) * part
}

fn as_the_paper() -> Motion {
    Motion {
        whirl: |s| if s < 15 { 1.0 } else { -1.0 },
        radius: zigzag,
        inner: |s, turns| pulse(s, turns, 87.0, 1.27 / 1.5, 19_970.0 / (1.27_f64 / 1.5).sqrt()),
        outer: |s, turns| pulse(s, turns, 81.0, 0.56 / 1.5, 4_820.0 / (0.56_f64 / 1.5).sqrt()),
    }
}

fn get<'a>(all: &'a [Finding], key: &str) -> &'a Finding {
    all.iter().find(|finding| finding.key == key).unwrap()
}

#[test]
fn a_record_as_the_paper_describes_agrees() {
    let all = findings(&record(&as_the_paper()));
    for key in [
        "pipe_shape",
        "pipe_whirl",
        "pipe_bottom",
        "guide_shape",
        "guide_whirl",
        "ripple",
        "guide_speed",
        "guide_period",
        "inner_force",
        "inner_place",
        "inner_period",
        "inner_contact",
        "outer_force",
        "outer_place",
        "outer_period",
        "outer_contact",
        "lateral",
        "pipe_over_guide",
    ] {
        let finding = get(&all, key);
        assert_eq!(finding.verdict, Verdict::Agrees, "{finding:?}");
        assert_eq!(finding.closeness, 1.0, "{finding:?}");
    }
    // The pulse's RMS, contact time and period are known exactly, but for one sample in 375 per turn.
    assert!((get(&all, "inner_force").value / 19.97 - 1.0).abs() < 0.01);
    assert!((get(&all, "inner_contact").value - 1.27).abs() < 0.01);
    assert!((get(&all, "outer_contact").value - 0.56).abs() < 0.01);
    assert!((get(&all, "inner_period").value - 1.5).abs() < 0.005);
    // A rectangular pulse's peak is its height: 21.7 kN is half of the paper's 44.42.
    let peak = get(&all, "inner_peak");
    assert!(
        (peak.value - 21.7).abs() < 0.1 && peak.verdict == Verdict::No,
        "{peak:?}"
    );
}

#[test]
fn what_differs_is_said_to_differ() {
    let all = findings(&record(&Motion {
        whirl: |_| 1.0,
        radius: |s| 5e-3 * (1.0 - s as f64 / 60.0),
        // 80 N twice a turn in the middle; resting on the wall at 45 degrees.
        inner: |s, turns| pulse(s, 2.0 * turns, 45.0, 0.5, 80.0),
        outer: |s, _| 1_200.0 * (1.0 - (degrees(s) - 45.0).abs() / 90.0),
    }));
    for key in [
        "pipe_shape",
        "pipe_whirl",
        "pipe_bottom",
        "inner_force",
        "inner_place",
        "inner_peak",
        "inner_period",
        "outer_force",
        "outer_place",
        "outer_peak",
        "outer_period",
        "outer_contact",
    ] {
        let finding = get(&all, key);
        assert_eq!(finding.verdict, Verdict::No, "{finding:?}");
        assert!(finding.closeness < 1.0);
    }
    assert!((get(&all, "inner_period").value - 0.75).abs() < 0.005);
    assert!((get(&all, "outer_contact").value - 1.5).abs() < 1e-9);
}

#[test]
fn backward_whirl_is_not_taken_for_forward() {
    let mut motion = as_the_paper();
    motion.whirl = |s| if s < 15 { -1.0 } else { -2.0 };
    let all = findings(&record(&motion));
    let whirl = get(&all, "pipe_whirl");
    assert_eq!(whirl.verdict, Verdict::No);
    assert!(
        whirl.ours.contains("backward") && !whirl.ours.contains("forward"),
        "{whirl:?}"
    );
}

#[test]
fn measures_of_a_series() {
    let pulses: Vec<f64> = (0..2000).map(|k| f64::from(u8::from(k % 250 < 40))).collect();
    let period = dominant_period(&pulses, 0.004, 0.05);
    assert!(
        (period.period - 1.0).abs() < 1e-9 && period.strength > 0.99,
        "{period:?}"
    );
    assert_eq!(contact_episodes(pulses.iter().copied()), 8);
    assert!((rms(pulses.iter().copied()) - (0.16_f64).sqrt()).abs() < 1e-12);
    // A still series repeats nothing.
    assert_eq!(dominant_period(&[3.0; 500], 0.004, 0.05).strength, 0.0);
}
