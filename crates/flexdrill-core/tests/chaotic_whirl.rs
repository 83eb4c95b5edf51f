//! Thrown motion on the whole tool: what much friction throws about is called in time, what is ordinary is not, and the
//! advice ends it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{DriveState, HazardKind, Severity};

/// Time between two looks (s), as the alarms take.
const LOOK: f64 = 0.1;

/// What a run of the paper's tool shows.
struct Run {
    /// First moment at which chaotic whirl reached each level after the drive turned (s).
    reached: [Option<f64>; 3],
    /// Its level at the end.
    last: Severity,
    /// Largest power of the chaotic part (W/m).
    most: f64,
}

/// Runs at a friction of the pipe in the guide, a weight on bit and the speed that `rpm` gives for a time (s), in
/// halves of the step as the node does.
fn run(friction: f64, kn: f64, seconds: f64, rpm: impl Fn(f64) -> f64) -> Run {
    let mut twin = Simulation::new(&ToolDescription::paper(), &SimulationSettings::default()).unwrap();
    let mut live = twin.live();
    live.inner_friction[0] = friction;
    twin.set_live(live).unwrap();
    twin.set_refinement(1);
    let mut snapshot = twin.new_snapshot();
    let mut turning = None;
    let mut run = Run {
        reached: [None; 3],
        last: Severity::Ok,
        most: 0.0,
    };
    for number in 1..=(seconds / LOOK).round() as u32 {
        while twin.time() < f64::from(number) * LOOK - 1e-9 {
            let inputs = Inputs {
                rotary_speed: rpm_to_rad_per_s(rpm(twin.time())),
                weight_on_bit: kn_to_n(kn),
                ..Inputs::default()
            };
            twin.advance(&inputs).ok().unwrap();
        }
        twin.snapshot(&mut snapshot, false);
        if turning.is_none() && snapshot.hazards.drive == DriveState::Turning {
            turning = Some(snapshot.time);
        }
        let hazard = snapshot.hazards.of(HazardKind::ChaoticWhirl);
        for (at, level) in run.reached.iter_mut().zip(Severity::RAISED) {
            if hazard.severity >= level && at.is_none() {
                *at = turning.map(|from| snapshot.time - from);
            }
        }
        run.last = hazard.severity;
        run.most = run.most.max(hazard.value);
    }
    println!(
        "friction {friction}, {kn} kN: {:?} s after the run-up, {:.2} W/m",
        run.reached, run.most
    );
    run
}

/// 20 of 32 joints are chaotic then. The window of 3 s need not be full.
#[test]
fn a_friction_of_07_at_100_rpm_warns_within_four_seconds_of_the_run_up() {
    let run = run(0.7, 10.0, 14.0, |_| 100.0);
    assert!(run.reached[0].is_some_and(|after| after < 3.0), "{:?}", run.reached);
    assert!(run.reached[1].is_some_and(|after| after < 4.0), "{:?}", run.reached);
}

/// A third to half of the joints, with blows of a third of the power.
#[test]
fn a_friction_of_07_at_80_rpm_and_5_kn_is_watched() {
    let run = run(0.7, 5.0, 18.0, |_| 80.0);
    assert!(run.reached[0].is_some(), "{:.2} W/m", run.most);
    assert_eq!(run.reached[2], None);
}

/// The advice of the alarm: below 50 r/min. The window and the hold-off are over 8 s after the motion has ended.
#[test]
fn a_lower_speed_ends_it() {
    let run = run(0.7, 10.0, 36.0, |time| if time < 12.0 { 80.0 } else { 48.0 });
    assert!(run.reached[1].is_some(), "{:.2} W/m", run.most);
    assert_eq!(run.last, Severity::Ok);
}

/// Usual friction at three times the paper's speed: collisions take as much as at 80 r/min with a friction of 0.7 and 5
/// kN, but the pipe turns in order.
#[test]
fn fast_drilling_with_usual_friction_is_none() {
    let run = run(0.2, 10.0, 16.0, |_| 120.0);
    assert_eq!(run.reached, [None; 3], "{:.2} W/m", run.most);
}
