//! Tests of the stick-slip index.

use super::*;
use std::f64::consts::TAU;

/// Speed of the drive in the tests (rad/s), 40 r/min.
const DRIVE: f64 = 4.19;

const DT: f64 = 5e-4;

fn watched(drive: impl Fn(f64) -> f64, bit: impl Fn(f64) -> f64, seconds: f64) -> StickSlip {
    let mut watch = StickSlip::new(StickSlipSettings::default());
    for step in 0..(seconds / DT) as usize {
        let time = step as f64 * DT;
        watch.push(time, DT, bit(time), drive(time), true);
    }
    watch
}

fn rippled(mean: f64, amplitude: f64, seconds: f64) -> StickSlip {
    watched(|_| mean, |time| mean + amplitude * (TAU * 1.3 * time).sin(), seconds)
}

/// The drive follows `points` (s, rad/s) in straight lines; the bit follows it with a ripple of 5 %. The highest
/// level and the largest index.
fn driven(points: &[(f64, f64)], seconds: f64) -> (Severity, f64) {
    let drive = |time: f64| {
        let after = points.iter().position(|point| point.0 > time).unwrap_or(points.len());
        match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
            (Some((t0, v0)), Some((t1, v1))) => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
            (Some((_, last)), None) => last,
            (None, _) => points[0].1,
        }
    };
    let mut watch = StickSlip::new(StickSlipSettings::default());
    let (mut worst, mut most) = (Severity::Ok, 0.0_f64);
    for step in 0..(seconds / DT) as usize {
        let time = step as f64 * DT;
        let bit = drive(time) * (1.0 + 0.05 * (TAU * 1.3 * time).sin());
        watch.push(time, DT, bit, drive(time), true);
        worst = worst.max(watch.severity());
        most = most.max(watch.index());
    }
    (worst, most)
}

#[test]
fn sine_ripple_gives_amplitude_over_mean() {
    // The window holds 13 periods and the mean is that of whole ones; steps cut the extremes by less.
    assert!((rippled(DRIVE, 0.5, 10.0).index() - 0.5 / DRIVE).abs() < 2e-3);
    let stopping = rippled(DRIVE, DRIVE, 10.0);
    assert!((stopping.index() - 1.0).abs() < 1e-2);
    assert!(stopping.severity() >= Severity::Warning);
    assert_eq!(rippled(DRIVE, 0.5, 10.0).severity(), Severity::Ok);
}

#[test]
fn silent_below_the_gate_and_while_the_window_fills() {
    assert_eq!(rippled(0.5, 3.0, 10.0).index(), 0.0);
    assert_eq!(rippled(DRIVE, 4.0, 1.0).index(), 0.0);
    // 40 r/min is four times the gate: half of it, with the bit stopping, is still seen.
    assert!(rippled(0.5 * DRIVE, 0.5 * DRIVE, 10.0).index() > 0.9);
}

#[test]
fn a_swing_of_the_drive_counts_in_full() {
    let swing = |time: f64| DRIVE * (1.0 + 0.95 * (0.2 * TAU * time).sin());
    let mut watch = StickSlip::new(StickSlipSettings::default());
    let mut called = None;
    for step in 0..(30.0 / DT) as usize {
        let time = step as f64 * DT;
        // Steady at first: the swing begins at 10 s.
        let drive = if time < 10.0 { DRIVE } else { swing(time) };
        watch.push(time, DT, drive, drive, true);
        if watch.severity() == Severity::Warning {
            called = called.or(Some(time - 10.0));
        }
        // Whole periods in the window: 0.95, which is just below the level of a bit that stops.
        assert!(
            time < 20.5 || (watch.index() - 0.95).abs() < 0.01,
            "{} at {time}",
            watch.index()
        );
    }
    // Up, down, up, and half of the next way down.
    assert!(called.is_some_and(|after| after < 8.75), "{called:?}");
}

#[test]
fn a_measured_bit_that_sticks_for_seconds_is_critical() {
    // Stands for 3 s of every 6, then turns at twice the mean speed.
    let sticking = |time: f64| if time % 6.0 < 3.0 { 0.0 } else { 2.0 * DRIVE };
    let watch = watched(sticking, sticking, 40.0);
    assert_eq!(watch.severity(), Severity::Critical);
    assert!((0.9..1.6).contains(&watch.index()), "{}", watch.index());
}

#[test]
fn a_change_of_the_set_speed_is_no_stick_slip() {
    let rpm = rpm_to_rad_per_s;
    // 20 r/min per s each: slower, faster, stopped, a pause and back, and a driller who takes the speed back for a
    // moment.
    let cases: [&[(f64, f64)]; 5] = [
        &[(12.0, rpm(60.0)), (14.5, rpm(10.0))],
        &[(12.0, rpm(20.0)), (17.0, rpm(120.0))],
        &[(12.0, rpm(60.0)), (15.0, 0.0)],
        &[(12.0, rpm(60.0)), (15.0, 0.0), (18.0, 0.0), (21.0, rpm(60.0))],
        &[
            (12.0, rpm(60.0)),
            (14.5, rpm(10.0)),
            (16.0, rpm(10.0)),
            (18.5, rpm(60.0)),
        ],
    ];
    for points in cases {
        let (worst, most) = driven(points, 45.0);
        assert_eq!(worst, Severity::Ok, "{points:?}");
        // The ripple of 5 %, and a change of a tenth within one set speed.
        assert!(most < 0.12, "{most} with {points:?}");
    }
}

#[test]
fn a_change_of_the_set_speed_ends_no_stick_slip() {
    // The bit stops twice a second at 40 r/min and at 55 r/min; the drive goes from one to the other at 20 r/min
    // per s.
    let drive = |time: f64| rpm_to_rad_per_s((40.0 + 20.0 * (time - 20.0).max(0.0)).min(55.0));
    let mut watch = StickSlip::new(StickSlipSettings::default());
    for step in 0..(30.0 / DT) as usize {
        let time = step as f64 * DT;
        let bit = drive(time) * (1.0 + 1.05 * (2.0 * TAU * time).sin());
        watch.push(time, DT, bit, drive(time), true);
        assert!(time < 5.0 || watch.severity() == Severity::Critical, "{time}");
        // The condition of the level counts as met all the time.
        assert!(time < 5.0 || watch.hold(time) == Hold::Met, "{time}");
    }
}

#[test]
fn noise_of_a_measured_speed_hides_no_change_of_the_set_speed() {
    // 60 r/min, then 10, with 4 % of noise that changes every second: held, as a log of 1 Hz.
    let mut seed = 9_u32;
    let noise: Vec<f64> = (0..60)
        .map(|_| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            0.08 * (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5)
        })
        .collect();
    let drive = |time: f64| {
        let set = (60.0 - 20.0 * (time - 30.0).max(0.0)).max(10.0);
        rpm_to_rad_per_s(set) * (1.0 + noise[time as usize])
    };
    let mut watch = StickSlip::new(StickSlipSettings::default());
    for step in 0..(60.0 / DT) as usize {
        let time = step as f64 * DT;
        watch.push(time, DT, drive(time), drive(time), true);
        assert_eq!(watch.severity(), Severity::Ok, "{} at {time}", watch.index());
    }
}

#[test]
fn nothing_is_judged_before_the_drive_turns_steadily() {
    let mut watch = StickSlip::new(StickSlipSettings::default());
    for step in 0..20_000 {
        let time = f64::from(step) * DT;
        // The bit sticks for 2 s, then springs forward, while the tool is run up.
        let bit = if time < 2.0 { 0.0 } else { 4.0 * DRIVE };
        watch.push(time, DT, bit, DRIVE, time > 4.0);
        assert!(
            time > 5.4 || (watch.index() == 0.0 && watch.severity() == Severity::Ok),
            "{time}"
        );
    }
    assert!(watch.index() == 0.0, "{}", watch.index());
}

#[test]
fn a_stuck_bit_is_seen_although_its_own_speed_is_nothing() {
    let stops = |time: f64| if time < 5.0 { DRIVE } else { 0.0 };
    // After 1 s in which it stands, and the rest of a block.
    let stuck = watched(|_| DRIVE, stops, 6.2);
    assert_eq!(stuck.severity(), Severity::Critical, "{}", stuck.index());
    let for_long = watched(|_| DRIVE, stops, 40.0);
    assert!(for_long.index() >= 1.0, "{}", for_long.index());
    // Sticks for 2 s, then slips through what the drive has wound up.
    let slipping = watched(|_| DRIVE, |time| if time % 2.5 < 2.0 { 0.0 } else { 5.0 * DRIVE }, 12.0);
    assert!(slipping.index() > 2.0, "{}", slipping.index());
}

#[test]
fn forgets_what_left_the_window() {
    let mut watch = StickSlip::new(StickSlipSettings::default());
    watch.push(0.0, 1e-3, 100.0, 4.0, true);
    for _ in 0..11_000 {
        watch.push(0.0, 1e-3, 4.0, 4.0, true);
    }
    assert_eq!(watch.index(), 0.0);
}

/// The same index says nothing of the sense: the least speed does.
#[test]
fn a_bit_that_spins_back_differs_from_one_that_only_stops() {
    let drive = rpm_to_rad_per_s(60.0);
    // Swings about the drive's speed, once a second: down to a standstill, and to half of the speed against the drive.
    for (sense, swing, least) in [(1.0, 1.0, 0.0), (1.0, 1.5, -0.5), (-1.0, 1.5, -0.5)] {
        let mut watch = StickSlip::new(StickSlipSettings::default());
        for step in 0..(20.0 / DT) as usize {
            let time = step as f64 * DT;
            let bit = sense * drive * (1.0 + swing * (TAU * time).sin());
            watch.push(time, DT, bit, sense * drive, true);
        }
        assert!((watch.worst().0 - swing).abs() < 0.01, "{:?}", watch.worst());
        // A step of the sine at its least is 0.002 at most.
        assert!(
            (watch.least_speed() - least).abs() < 0.01,
            "{} for {least}",
            watch.least_speed()
        );
    }
}
