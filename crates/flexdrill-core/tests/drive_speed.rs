//! What the speed of the drive does to the alarms of the tool, on the whole tool: a swing that comes in by the drive is
//! stick-slip, a change of the set speed is not.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::f64::consts::TAU;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{DriveState, HazardKind, Severity};

/// Time between two looks (s), as the alarms take.
const LOOK: f64 = 0.1;

/// Drives the paper's tool at 10 kN with the speed that `rpm` gives for a time (s), no faster than `slew` (r/min per
/// s), and shows every tenth of a second.
fn drive(slew: f64, seconds: f64, rpm: impl Fn(f64) -> f64, mut look: impl FnMut(&Snapshot)) {
    let settings = SimulationSettings::default().with(|settings| settings.rotary_speed_slew = rpm_to_rad_per_s(slew));
    let mut twin = Simulation::new(&ToolDescription::paper(), &settings).unwrap();
    let mut snapshot = twin.new_snapshot();
    for number in 1..=(seconds / LOOK).round() as u32 {
        let next = f64::from(number) * LOOK;
        while twin.time() < next - 1e-9 {
            let inputs = Inputs {
                rotary_speed: rpm_to_rad_per_s(rpm(twin.time())),
                weight_on_bit: kn_to_n(10.0),
                ..Inputs::default()
            };
            twin.advance(&inputs).ok().unwrap();
        }
        twin.snapshot(&mut snapshot, false);
        look(&snapshot);
    }
}

/// 40 r/min with a swing of 95 % at 0.2 Hz, as a sensor above the tool shows severe stick-slip. The model follows at
/// 200 r/min per s, as the configuration has it for speeds that are measured downhole.
#[test]
fn a_swing_of_the_drive_is_critical_stick_slip_and_suppresses_nothing() {
    const BEGINS: f64 = 8.0;
    let swing = |time: f64| {
        let phase = 0.2 * TAU * (time - BEGINS).max(0.0);
        40.0 * (1.0 + 0.95 * phase.sin())
    };
    let (mut turning, mut critical, mut indices) = (None, None, vec![]);
    drive(200.0, 26.0, swing, |snapshot| {
        let (time, drive) = (snapshot.time, snapshot.hazards.drive);
        if drive == DriveState::Turning {
            turning = turning.or(Some(time));
        }
        assert!(turning.is_none() || drive == DriveState::Turning, "{drive:?} at {time}");
        let hazard = snapshot.hazards.of(HazardKind::StickSlip);
        if hazard.severity == Severity::Critical {
            critical = critical.or(Some(time - BEGINS));
        }
        if time > BEGINS + 12.0 {
            indices.push(hazard.value);
        }
    });
    // Two turns at 40 r/min after a run-up of a fifth of a second.
    assert!(turning.is_some_and(|time| time < 4.0), "{turning:?}");
    // Two swings up and down, and what the search for them leaves.
    assert!(critical.is_some_and(|after| after < 10.0), "{critical:?}");
    // The window of 10 s holds two periods: the swing alone gives 0.95, and the joints' ripple at 78 r/min the rest.
    let (low, high) = indices.iter().fold((f64::MAX, 0.0_f64), |(low, high), &index| {
        (low.min(index), high.max(index))
    });
    println!("critical {critical:?} s after the swing begins, index {low:.2} to {high:.2}");
    assert!(low > 0.95 && high < 1.4, "{low} to {high}");
}

/// 60 r/min, 10 r/min, stop, pause of 3 s, 50 r/min, by the drive's slew limit of 20 r/min per s.
#[test]
fn changes_of_the_set_speed_and_a_short_stop_raise_no_level() {
    let set = |time: f64| match time {
        ..12.0 => 60.0,
        ..22.0 => 10.0,
        ..26.0 => 0.0,
        _ => 50.0,
    };
    let mut turning = false;
    drive(20.0, 36.0, set, |snapshot| {
        let (time, drive) = (snapshot.time, snapshot.hazards.drive);
        turning |= drive == DriveState::Turning;
        assert!(!turning || drive == DriveState::Turning, "{drive:?} at {time}");
        for hazard in &snapshot.hazards.list {
            assert_eq!(hazard.severity, Severity::Ok, "{hazard:?} at {time}");
        }
    });
    assert!(turning);
}

/// A connection: the drive stands for long, and the next start is a run-up.
#[test]
fn a_stop_for_some_seconds_is_a_standstill_and_the_next_start_a_run_up() {
    let set = |time: f64| if (8.0..16.0).contains(&time) { 0.0 } else { 40.0 };
    let mut states = vec![];
    drive(20.0, 24.0, set, |snapshot| {
        let state = snapshot.hazards.drive;
        if states.last() != Some(&state) {
            states.push(state);
        }
        for hazard in &snapshot.hazards.list {
            assert_eq!(hazard.severity, Severity::Ok, "{hazard:?} at {}", snapshot.time);
        }
    });
    use DriveState::{RunningUp, Standing, Turning};
    assert_eq!(states, [Standing, RunningUp, Turning, Standing, RunningUp, Turning]);
}
