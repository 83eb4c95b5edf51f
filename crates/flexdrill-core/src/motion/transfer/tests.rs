//! Means over the window, and the levels of what does not arrive.

use super::*;
use crate::motion::Severity;

const DT: f64 = 1e-3;

/// A tool below a string with a hoist: weight and torque at the surface and at the bit.
struct Fed {
    watch: TransferWatch,
    audit: EnergyAudit,
    time: f64,
}

impl Fed {
    fn new() -> Self {
        Self {
            watch: TransferWatch::new(&TransferSettings::default()),
            audit: EnergyAudit::default(),
            time: 0.0,
        }
    }

    fn run(&mut self, seconds: f64, judged: bool, sample: impl Fn(f64) -> TransferSample) {
        for _ in 0..(seconds / DT).round() as usize {
            self.time += DT;
            self.audit.drive += 1500.0 * DT;
            self.watch.push(self.time, DT, &sample(self.time), &self.audit, judged);
        }
    }

    fn levels(&self) -> [Severity; 2] {
        [
            self.watch.weight(self.time).severity,
            self.watch.torque(self.time).severity,
        ]
    }
}

fn sample(weight: [f64; 2], torque: [f64; 2]) -> TransferSample {
    TransferSample {
        weight: [weight[0], weight[0], weight[1]],
        torque: [torque[0], torque[0], torque[1]],
        ..TransferSample::default()
    }
}

/// Weight (N) at a time (s).
type Weight = fn(f64) -> f64;

#[test]
fn every_step_counts_and_the_window_slides() {
    let mut fed = Fed::new();
    // A swing of 7 Hz, which no sampling at 10 Hz would average out, about 100 N m.
    let swing = |time: f64| {
        sample(
            [10e3, 8e3],
            [100.0 + 60.0 * (std::f64::consts::TAU * 7.0 * time).sin(), 50.0],
        )
    };
    fed.run(5.0, true, swing);
    let summary = *fed.watch.summary();
    assert!((summary.duration - 5.0).abs() < 1e-9);
    // 35 whole periods: rounding of the sums alone.
    assert!((summary.torque.mean[SURFACE] - 100.0).abs() < 1e-6);
    assert!((summary.torque.rms[SURFACE] - (100.0_f64.powi(2) + 0.5 * 60.0_f64.powi(2)).sqrt()).abs() < 1e-6);
    assert!((summary.torque_efficiency - 0.5).abs() < 1e-8);
    assert!((summary.power.drive - 1500.0).abs() < 1e-6);
    assert!(summary.mean.depth_of_cut.is_nan() && summary.mean.hook_load.is_nan());
    // After another window nothing of the first is left.
    fed.run(5.0, true, |_| sample([10e3, 8e3], [40.0, 30.0]));
    let summary = fed.watch.summary();
    assert!((summary.torque.rms[SURFACE] - 40.0).abs() < 1e-9 && (summary.duration - 5.0).abs() < 1e-9);
    fed.watch.reset();
    assert!(fed.watch.summary().torque.mean[BIT].is_nan() && fed.watch.summary().torque_efficiency.is_nan());
}

#[test]
fn without_a_string_the_efficiency_counts_from_the_kick_off() {
    let mut fed = Fed::new();
    let mut bare = sample([f64::NAN, 8e3], [120.0, 90.0]);
    bare.torque[SURFACE] = f64::NAN;
    fed.run(20.0, true, |_| bare);
    assert!((fed.watch.summary().torque_efficiency - 0.75).abs() < 1e-9);
    // No weight and no torque at the surface: nothing is judged, whatever arrives.
    bare.weight[BIT] = 0.0;
    bare.torque[BIT] = 0.0;
    fed.run(20.0, true, |_| bare);
    assert_eq!(fed.levels(), [Severity::Ok; 2]);
}

#[test]
fn only_steady_drilling_is_judged() {
    // A third lost is normal; nothing at the bit is not.
    let mut fed = Fed::new();
    fed.run(30.0, true, |_| sample([10e3, 6.6e3], [150.0, 60.0]));
    assert_eq!(fed.levels(), [Severity::Ok; 2]);
    fed.run(6.0, true, |_| sample([10e3, 1e3], [150.0, 10.0]));
    // Without weight at the bit the missing torque is no condition of its own.
    assert_eq!(fed.levels(), [Severity::Warning, Severity::Ok]);
    assert!((fed.watch.weight(fed.time).lost - 0.9).abs() < 1e-9);
    fed.run(15.0, true, |_| sample([10e3, 6.6e3], [900.0, 60.0]));
    assert_eq!(fed.levels(), [Severity::Ok, Severity::Warning]);

    // Setting down, picking up, light weight, a drive that does not turn.
    let cases: [(bool, Weight); 4] = [
        (true, |time| 1e3 * time),
        (true, |time| 20e3 - 1e3 * time),
        (true, |_| 2.9e3),
        (false, |_| 10e3),
    ];
    for (index, (judged, weight)) in cases.into_iter().enumerate() {
        let mut fed = Fed::new();
        // Up to 20 kN in 20 s: the range in a window stays above a fifth of the mean.
        fed.run(20.0, judged, |time| sample([weight(time), 0.0], [150.0, 0.0]));
        assert_eq!(fed.levels(), [Severity::Ok; 2], "case {index}");
    }
}

#[test]
fn a_level_outlasts_a_short_disturbance_and_ends_off_bottom() {
    let mut fed = Fed::new();
    fed.run(10.0, true, |_| sample([10e3, 0.5e3], [150.0, 10.0]));
    assert_eq!(fed.levels()[0], Severity::Critical);
    // The driller moves the weight: nothing new can be said for a moment.
    fed.run(3.0, true, |_| sample([15e3, 0.5e3], [150.0, 10.0]));
    assert_eq!(fed.levels()[0], Severity::Critical);
    fed.run(16.0, true, |_| sample([0.0, 0.0], [60.0, 0.0]));
    assert_eq!(fed.levels()[0], Severity::Ok);
}
