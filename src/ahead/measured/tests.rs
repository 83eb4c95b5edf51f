use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::*;
use crate::ahead::member::{Horizon, LOOK, Watched};
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{Run, RunInputs, Simulation};
use flexdrill_outputs::schedule;

fn config() -> Config {
    Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
}

/// A tool that turns at a speed (r/min) with two watched stations of the pipe, at rest in their gap.
fn turning(rpm: f64) -> Snapshot {
    let mut snapshot = Snapshot::default();
    snapshot.hazards.drive = DriveState::Turning;
    snapshot.applied.rotary_speed = rpm_to_rad_per_s(rpm);
    snapshot.bit.rotary_speed = rpm_to_rad_per_s(rpm);
    snapshot.contacts.measured_depth = vec![0.0, 5.0];
    for layer in [&mut snapshot.contacts.pipe_guide, &mut snapshot.contacts.guide_wall] {
        layer.shock = vec![0.0; 2];
    }
    let report = &mut snapshot.whirl;
    report.kind = vec![WhirlKind::None; 2];
    report.body = vec![Body::Pipe; 2];
    report.confidence = vec![0.9; 2];
    report.rolling = vec![false; 2];
    report.whirl_rate = vec![0.0; 2];
    report.friction_power = vec![0.0; 2];
    snapshot
}

/// Twenty seconds of looks at a speed (r/min) and weight (kN); `motion` changes each by its time (s).
fn measured(at: [f64; 2], motion: impl Fn(f64, &mut Snapshot)) -> Measured {
    let mut measured = Measured::new(config().simulation(), at, LOOK);
    for look in 0..200 {
        let mut snapshot = turning(at[0]);
        for step in 0..10 {
            motion((f64::from(look) + 0.1 * f64::from(step)) * LOOK, &mut snapshot);
            measured.step(snapshot.bit.rotary_speed);
        }
        measured.look(&snapshot);
    }
    measured
}

fn calls(measured: &Measured) -> Vec<AlarmId> {
    let config = config();
    AlarmId::ALL
        .into_iter()
        .filter(|id| measured.calls(*id, &config))
        .collect()
}

#[test]
fn each_gate_is_kept_with_a_margin() {
    let settings = config().simulation();
    let judged = |id, rpm, kn| is_judged_at(id, [rpm, kn], &settings);
    for kind in HazardKind::ALL {
        let id = AlarmId::of_hazard(kind);
        // Below 5 r/min the drive counts as standing.
        for rpm in [0.0, 1.0, 4.0, 5.0, -4.0] {
            assert!(!judged(id, rpm, 30.0), "{id:?} at {rpm} r/min");
        }
        // Stick-slip has a gate of its own, at 11 r/min.
        let at_ten = id != AlarmId::StickSlip;
        for (rpm, expected) in [
            (10.0, at_ten),
            (11.0, at_ten),
            (12.0, true),
            (60.0, true),
            (-60.0, true),
        ] {
            assert_eq!(judged(id, rpm, 30.0), expected, "{id:?} at {rpm} r/min");
        }
        // Transfer is judged from 3 kN on.
        let light = !matches!(id, AlarmId::WeightTransfer | AlarmId::TorqueTransfer);
        for (kn, expected) in [(0.0, light), (2.0, light), (3.0, light), (3.5, true)] {
            assert_eq!(judged(id, 60.0, kn), expected, "{id:?} at {kn} kN");
        }
    }
    // Without gates a drive that stands is not judged either.
    let mut ungated = settings.clone();
    (ungated.whirl.min_rotary_speed, ungated.stick_slip.gate_speed) = (0.0, 0.0);
    assert!(!is_judged_at(AlarmId::StickSlip, [0.0, 30.0], &ungated));
    assert!(is_judged_at(AlarmId::StickSlip, [1.0, 30.0], &ungated));
}

#[test]
fn a_quiet_tool_calls_for_nothing_and_one_that_stands_is_not_judged() {
    let quiet = measured([60.0, 10.0], |_, _| {});
    assert_eq!(calls(&quiet), []);
    assert!(quiet.is_judged(AlarmId::StickSlip) && quiet.is_judged(AlarmId::Shock));
    // For a moment, as far as the analysis is concerned.
    let stood = measured([60.0, 10.0], |time, snapshot| {
        if time > 7.0 && time < 7.2 {
            snapshot.hazards.drive = DriveState::Standing;
        }
    });
    for kind in HazardKind::ALL {
        assert!(!stood.is_judged(AlarmId::of_hazard(kind)), "{kind:?}");
    }
}

/// The alarms are silent in all of these: no hazard of the snapshots has a level.
#[test]
fn the_motion_is_seen_where_the_alarm_is_silent() {
    // The bit swings by 0.93 of its mean, at 10 r/min, and stands still at 60.
    let swings = measured([10.0, 40.0], |time, snapshot| {
        snapshot.bit.rotary_speed = rpm_to_rad_per_s(10.0) * (1.0 + 0.93 * (TAU * 3.0 * time).sin());
    });
    assert_eq!(calls(&swings), [AlarmId::StickSlip]);
    let stuck = measured([60.0, 10.0], |_, snapshot| snapshot.bit.rotary_speed = 0.0);
    assert_eq!(calls(&stuck), [AlarmId::StickSlip]);
    // Against the sense of the rotation, at four times its rate: below the gate the report has no ratio and no
    // cycles.
    let whirls = |kind, rate: f64, power: f64| {
        move |_: f64, snapshot: &mut Snapshot| {
            let report = &mut snapshot.whirl;
            report.kind[1] = kind;
            report.whirl_rate[1] = rate * snapshot.applied.rotary_speed;
            report.friction_power[1] = power;
        }
    };
    // A turn and a half in the twenty seconds is the least that a level needs.
    for rpm in [4.8, 60.0] {
        let backward = measured([rpm, 10.0], whirls(WhirlKind::Backward, -4.0, 0.0));
        assert_eq!(calls(&backward), [AlarmId::BackwardWhirl], "{rpm}");
        let forward = measured([rpm, 10.0], whirls(WhirlKind::Forward, 1.0, 320.0));
        assert_eq!(calls(&forward), [AlarmId::ForwardWhirl], "{rpm}");
    }
    // One turn of the tool is a second: half of it is no whirl yet.
    let short = measured([60.0, 10.0], |time, snapshot| {
        if time % 5.0 < 0.45 {
            whirls(WhirlKind::Backward, -4.0, 0.0)(time, snapshot);
        }
    });
    assert_eq!(calls(&short), []);
    // 20 N s, three times in ten seconds; once is not enough.
    let strikes = |every: f64| {
        measured([60.0, 10.0], move |time, snapshot| {
            if time % every < 0.5 * LOOK {
                snapshot.contacts.pipe_guide.shock[0] = 20.0;
            }
        })
    };
    assert_eq!(calls(&strikes(3.0)), [AlarmId::Shock]);
    assert_eq!(calls(&strikes(12.0)), []);
    // Half of the pipe is chaotic, and collisions take 20 W over 5 m: 2 W/m.
    let chaotic = |power: f64| {
        measured([60.0, 10.0], move |time, snapshot| {
            snapshot.whirl.kind[0] = WhirlKind::Chaotic;
            snapshot.energy.contact_damping = 1e4 + power * time;
        })
    };
    assert_eq!(calls(&chaotic(20.1)), [AlarmId::ChaoticWhirl]);
    assert_eq!(calls(&chaotic(1.0)), []);
    // What the stop of a joint carries, judged or not.
    let loaded = measured([60.0, 10.0], |_, snapshot| {
        snapshot.hazards.list[HazardKind::JointLoad as usize].value = 1.1;
    });
    assert_eq!(calls(&loaded), [AlarmId::JointLoad]);
}

#[test]
fn transfer_is_judged_by_the_weight_that_there_is() {
    let weights = |[top, bit]: [f64; 2], [above, below]: [f64; 2]| {
        measured([60.0, 10.0], move |_, snapshot| {
            snapshot.transfer.weight.mean = [top, f64::NAN, bit];
            snapshot.transfer.torque.mean = [above, f64::NAN, below];
        })
    };
    let judged =
        |measured: &Measured| [AlarmId::WeightTransfer, AlarmId::TorqueTransfer].map(|id| measured.is_judged(id));
    // All arrives; a tenth does; too little is there, or too little arrives.
    let good = weights([10e3, 9e3], [1000.0, 900.0]);
    assert_eq!((judged(&good), calls(&good)), ([true; 2], vec![]));
    let lost = weights([10e3, 1e3], [1000.0, 100.0]);
    assert_eq!(judged(&lost), [true, false]);
    assert_eq!(calls(&lost), [AlarmId::WeightTransfer, AlarmId::TorqueTransfer]);
    assert_eq!(judged(&weights([2.9e3, 2.9e3], [1000.0, 900.0])), [false; 2]);
    assert_eq!(judged(&weights([10e3, 2.9e3], [1000.0, 900.0])), [true, false]);
    // A tool without a hoist has neither.
    assert_eq!(judged(&good), [true; 2]);
    let none = measured([60.0, 10.0], |_, _| {});
    assert_eq!((judged(&none), calls(&none)), ([false; 2], vec![]));
}

/// The real tool sticks and slips at 20 r/min and 40 kN. At 10 r/min its alarm ends, since it is not judged below
/// 11 r/min, and the bit continues to swing.
#[test]
fn less_speed_than_the_gate_ends_the_alarm_and_not_the_motion() {
    let config = Config::from_text("coarse.yaml", include_str!("../../../config/coarse.yaml"))
        .and_then(|config| config.with_value("contact.inner.friction_tangential", 0.7))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", 40.0));
    let config = Arc::new(config.unwrap());
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(&config, &config.outputs.rates));
    let applied = run.applied();
    let at = |rpm: f64| RunInputs {
        inputs: Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(40.0),
            ..Inputs::ZERO
        },
        ..applied
    };
    run.apply(&at(20.0));
    // The alarm has a window of ten seconds.
    for _ in 0..(14.0 / config.solver.time_step) as u32 {
        assert!(matches!(run.advance(), StepOutcome::Advanced { .. }));
    }
    let mut snapshot = run.simulation().new_snapshot();
    run.look(&mut snapshot);
    assert!(snapshot.hazards.of(HazardKind::StickSlip).severity >= Severity::Warning);
    let stop = AtomicBool::new(false);
    let (slow, _) = Watched::new(run, &config, &stop).run_up(&at(10.0), 10.0).unwrap();
    let point = [10.0, 40.0];
    let watched = Watched::new(slow, &config, &stop).measured(Measured::new(config.simulation(), point, LOOK));
    // The second half holds the window of stick-slip once.
    let member = watched.judge(Horizon::Of(24.0), |_| false).unwrap();
    assert_eq!(
        member.alarms[AlarmId::StickSlip as usize].worst,
        None,
        "the alarm has ended"
    );
    let measured = member.measured.unwrap();
    assert!(measured.calls(AlarmId::StickSlip, &config), "the motion has not");
    assert!(!measured.is_judged(AlarmId::StickSlip));
}
