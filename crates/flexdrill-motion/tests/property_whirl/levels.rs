//! Levels: when they rise, hold and end, and what they name.

use super::*;

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
    bench.run(SPEED, 1.5, |_| [0.0; 2]);
    assert_eq!(bench.analysis.level().severity, Severity::Critical);
    bench.run(SPEED, 60.0, |_| [0.0; 2]);
    let after = bench.analysis.level();
    assert_eq!(after.severity, Severity::Ok);
    assert!(after.sequence > sequence && after.since > level.since);
}

/// A level that is held for a weaker motion is not held for one that has ended.
#[test]
fn a_held_level_says_whether_its_motion_is_weaker_or_has_ended() {
    let thresholds = AlarmThresholds {
        levels: [1.0, 2.0, 4.0],
        hysteresis: 0.1,
        hold_off: 20.0,
    };
    let mut level = Alarm::default();
    let mut hold = |from: u32, to: u32, value: f64| {
        for tenth in from..to {
            level.update(f64::from(tenth) / 10.0, 0.1, value, &thresholds);
        }
        assert_eq!(level.severity(), Severity::Critical);
        level.hold(f64::from(to - 1) / 10.0)
    };
    assert_eq!(hold(0, 21, 5.0), Hold::Met);
    // Within 1.5 s it still counts.
    assert_eq!(hold(21, 30, 2.5), Hold::Met);
    let (severity, since) = (Severity::Warning, 2.0);
    assert_eq!(hold(30, 41, 2.5), Hold::Less { severity, since });
    assert_eq!(hold(41, 50, 0.0), Hold::Less { severity, since });
    assert_eq!(hold(50, 61, 0.0), Hold::Ended { at: 4.0 });
    // It is back.
    assert_eq!(hold(61, 62, 5.0), Hold::Met);
}

/// Rolling backward whirl that turns into forward whirl: for as long as the level is held, the hazard and the warning
/// keep the figures of the worst moment and not those of the forward whirl, and say since when the motion is less severe
/// or over.
#[test]
fn a_held_level_keeps_its_worst_moment_and_says_when_it_ended() {
    let rolling = -63.0 / 17.0;
    let backward = rotor(0.98 * CLEARANCE, rolling * SPEED);
    let forward = rotor(0.8 * CLEARANCE, 0.7 * SPEED);
    let mut bench = Bench::new();
    bench.run(SPEED, 12.0, backward);
    let stands = bench.analysis.backward();
    assert_eq!((stands.severity, stands.hold), (Severity::Critical, Hold::Met));
    let (mut held, mut ended) = (0, None);
    while bench.analysis.backward().severity == Severity::Critical {
        let time = 12.0 + f64::from(held) * SAMPLE_INTERVAL;
        bench.push(SPEED, forward(time), 0.0);
        held += 1;
        let (hazard, level) = (bench.analysis.backward(), bench.analysis.level());
        if hazard.severity == Severity::Critical {
            assert!((hazard.whirl_ratio / rolling - 1.0).abs() < 0.05, "{hazard:?}");
            assert!((hazard.value / (1.0 - rolling) - 1.0).abs() < 0.05, "{hazard:?}");
            assert!((level.whirl_ratio / rolling - 1.0).abs() < 0.05, "{level:?}");
            match hazard.hold {
                Hold::Met => {}
                Hold::Less { since, .. } => ended = Some(since),
                Hold::Ended { at } => ended = Some(at),
            }
        }
        assert!(held < 4000, "the level never falls");
    }
    let (released, ended) = (
        12.0 + f64::from(held) * SAMPLE_INTERVAL,
        ended.expect("it never says that it ended"),
    );
    // The new kind leads within two turns of a whirl at 0.7 times the speed, 4.3 s at 40 r/min.
    assert!((12.0..16.5).contains(&ended), "ended at {ended} s");
    let held_for = released - ended;
    let hold_off = WhirlSettings::default().hold_off;
    assert!(
        (hold_off - 0.1..hold_off + 0.2).contains(&held_for),
        "held for {held_for} s"
    );
}

/// Doubtful inputs lower every confidence at once, raise nothing that is not beyond doubt, and end nothing.
#[test]
fn doubtful_inputs_lower_the_confidence_and_freeze_the_level() {
    let orbit = |time: f64| {
        let ([a, b], [c, d]) = (
            rotor(0.5 * CLEARANCE, -0.7 * SPEED)(time),
            rotor(0.2 * CLEARANCE, 2.6 * SPEED)(time),
        );
        [a + c, b + d]
    };
    let mut fresh = Bench::new();
    fresh.run(SPEED, 12.0, orbit);
    let level = fresh.analysis.level();
    assert_eq!((level.severity, level.kind), (Severity::Watch, WhirlKind::Backward));
    // Direction 0.72: enough by itself, not with the trust in stale inputs.
    assert!((0.55..0.83).contains(&level.confidence), "{level:?}");
    fresh.analysis.set_input_trust(0.6);
    let doubtful = fresh.analysis.level();
    assert!((doubtful.confidence / level.confidence - 0.6).abs() < 1e-12 && doubtful.sequence == level.sequence + 1);
    fresh.run(SPEED, 20.0, orbit);
    assert_eq!(
        fresh.analysis.level().severity,
        Severity::Watch,
        "a standing level stays"
    );
    assert!(fresh.report.confidence[0] < 0.5);

    let mut stale = Bench::new();
    stale.analysis.set_input_trust(0.6);
    stale.run(SPEED, 30.0, orbit);
    assert_eq!(stale.analysis.level().severity, Severity::Ok, "and none rises");
    stale.analysis.set_input_trust(1.0);
    stale.run(SPEED, 3.0, orbit);
    assert_eq!(stale.analysis.level().severity, Severity::Watch);
}
