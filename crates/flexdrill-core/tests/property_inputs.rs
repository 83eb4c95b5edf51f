//! Input conditioning: what it refuses, how states age, and that its targets are always within the limits.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_core::inputs::{Conditioner, InputKind, InputRule, InputState, RejectionReason, Stamp};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use proptest::prelude::*;

use InputKind::{RateOfPenetration, RotarySpeed, StandpipePressure, WeightOnBit};

/// Rules like those of `config/default.yaml`.
fn conditioner() -> Conditioner {
    let rotary_speed = InputRule {
        min: 0.0,
        max: 120.0,
        tare_error: 0.0,
        initial: 0.0,
        safe: 0.0,
        safe_ramp: 5.0,
        slow_age: 2.5,
        max_age: 5.0,
        hold_before_safe: 10.0,
        used: true,
    };
    let weight_on_bit = InputRule {
        max: 60.0,
        tare_error: 0.5,
        safe_ramp: 1.0,
        ..rotary_speed
    };
    let rate_of_penetration = InputRule {
        min: -200.0,
        max: 200.0,
        initial: 3.0,
        safe_ramp: 1.0,
        used: true,
        ..rotary_speed
    };
    let standpipe_pressure = InputRule {
        max: 70.0,
        tare_error: 0.2,
        safe_ramp: 0.2,
        used: false,
        ..rotary_speed
    };
    Conditioner::new([rotary_speed, weight_on_bit, rate_of_penetration, standpipe_pressure])
}

#[test]
fn before_the_first_sample_the_start_value_acts() {
    let conditioner = conditioner();
    assert_eq!(conditioner.state(RotarySpeed, 1e9), InputState::NotReceived);
    assert_eq!(conditioner.targets(1e9).rotary_speed, 0.0);
    assert_eq!(conditioner.age(RotarySpeed, 5.0), None);
}

#[test]
fn good_samples_act_in_si() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 1.0).unwrap();
    conditioner.offer(WeightOnBit, 10.0, 1.0).unwrap();
    let targets = conditioner.targets(1.5);
    assert_eq!(targets.rotary_speed, rpm_to_rad_per_s(40.0));
    assert_eq!(targets.weight_on_bit, kn_to_n(10.0));
    assert_eq!(conditioner.quality(1.5), InputState::Ok);
}

#[test]
fn optional_inputs_act_in_si_and_are_refused_beyond_their_limits() {
    let mut conditioner = conditioner();
    assert!(!conditioner.is_of_interest(StandpipePressure));
    // The tool uses it.
    assert!(conditioner.is_of_interest(RateOfPenetration));
    assert_eq!(conditioner.targets(0.0).rate_of_penetration, 3.0 / 3600.0);
    conditioner.offer(RateOfPenetration, -36.0, 1.0).unwrap();
    conditioner.offer(StandpipePressure, 20.0, 1.0).unwrap();
    let targets = conditioner.targets(1.5);
    assert_eq!((targets.rate_of_penetration, targets.standpipe_pressure), (-0.01, 2e7));
    assert!(conditioner.is_of_interest(StandpipePressure));
    // A gauge that reads slightly below zero.
    conditioner.offer(StandpipePressure, -0.1, 2.0).unwrap();
    assert_eq!(conditioner.target(StandpipePressure, 2.0), 0.0);
    for (kind, value, words) in [
        (
            RateOfPenetration,
            f64::NAN,
            "rig/rate_of_penetration: NaN m/h refused: not a finite number",
        ),
        (
            RateOfPenetration,
            -201.0,
            "-201 m/h refused: below the minimum of -200 m/h (inputs.rate_of_penetration)",
        ),
        (
            StandpipePressure,
            f64::INFINITY,
            "rig/standpipe_pressure: inf MPa refused: not a finite number",
        ),
        (
            StandpipePressure,
            71.0,
            "71 MPa refused: above the maximum of 70 MPa (inputs.standpipe_pressure)",
        ),
        (
            StandpipePressure,
            -1.0,
            "negative by more than the tare error of 0.2 MPa (inputs.standpipe_pressure)",
        ),
    ] {
        let sentence = conditioner.offer(kind, value, 3.0).unwrap_err().to_string();
        assert!(sentence.contains(words), "{sentence}");
    }
    assert_eq!(conditioner.counts(RateOfPenetration).rejected_total(), 2);
    assert_eq!(conditioner.counts(StandpipePressure).rejected_total(), 3);
}

#[test]
fn each_reason_is_told_and_counted() {
    let mut conditioner = conditioner();
    conditioner.offer(WeightOnBit, 5.0, 10.0).unwrap();
    let cases = [
        (
            f64::NAN,
            11.0,
            "rig/weight_on_bit_kn: NaN kN refused: not a finite number",
        ),
        (
            f64::INFINITY,
            11.0,
            "rig/weight_on_bit_kn: inf kN refused: not a finite number",
        ),
        (
            -3.0,
            11.0,
            "negative by more than the tare error of 0.5 kN (inputs.weight_on_bit)",
        ),
        (
            61.0,
            11.0,
            "rig/weight_on_bit_kn: 61 kN refused: above the maximum of 60 kN (inputs.weight_on_bit)",
        ),
        (6.0, 9.5, "its time is 0.5 s before that of the last good sample"),
        // Readings that were converted have fifteen digits, a sentence has those that mean something.
        (
            6.0,
            10.0 - 0.1 - 0.2,
            "its time is 0.3 s before that of the last good sample",
        ),
        (
            17.637 * 4.448_221_615_260_5,
            11.0,
            "rig/weight_on_bit_kn: 78.453 kN refused: above the maximum of 60 kN",
        ),
        (
            60.000_1,
            11.0,
            "rig/weight_on_bit_kn: 60.0001 kN refused: above the maximum of 60 kN",
        ),
    ];
    for (value, time, words) in cases {
        let sentence = conditioner.offer(WeightOnBit, value, time).unwrap_err().to_string();
        assert!(sentence.contains(words), "{sentence}");
    }
    assert_eq!(conditioner.counts(WeightOnBit).rejected, [2, 1, 0, 3, 2, 0, 0, 0]);
    assert_eq!(conditioner.counts(WeightOnBit).rejected_total(), 8);
    assert_eq!(conditioner.counts(WeightOnBit).accepted, 1);
    assert_eq!(conditioner.last_good(WeightOnBit), Some(5.0));
    let sentence = conditioner.offer(RotarySpeed, -1.0, 0.0).unwrap_err().to_string();
    assert!(
        sentence.contains("rig/rotary_speed_rpm: -1 r/min refused: below the minimum of 0 r/min"),
        "{sentence}"
    );
}

#[test]
fn an_imperfect_tare_counts_as_zero() {
    let mut conditioner = conditioner();
    conditioner.offer(WeightOnBit, -0.4, 0.0).unwrap();
    assert_eq!(conditioner.last_good(WeightOnBit), Some(0.0));
}

#[test]
fn states_follow_age_and_refusals() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 100.0).unwrap();
    assert_eq!(conditioner.state(RotarySpeed, 102.4), InputState::Ok);
    assert_eq!(conditioner.state(RotarySpeed, 102.5), InputState::Slow);
    assert_eq!(conditioner.state(RotarySpeed, 105.0), InputState::Stale);
    conditioner.offer(RotarySpeed, 500.0, 103.0).unwrap_err();
    assert_eq!(conditioner.state(RotarySpeed, 103.0), InputState::Rejected);
    assert_eq!(conditioner.state(RotarySpeed, 105.0), InputState::Stale);
    conditioner.offer(RotarySpeed, 41.0, 112.0).unwrap();
    assert_eq!(conditioner.state(RotarySpeed, 112.0), InputState::Ok);
}

/// Values that keep coming and are all refused are as old as the last good one.
#[test]
fn refused_values_for_longer_than_max_age_are_stale_and_lead_to_the_safe_value() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 100.0).unwrap();
    for tenth in 1..=250 {
        let now = 100.0 + f64::from(tenth) / 10.0;
        conditioner.offer(RotarySpeed, 500.0, now).unwrap_err();
        let expected = if now - 100.0 < 5.0 {
            InputState::Rejected
        } else {
            InputState::Stale
        };
        assert_eq!(conditioner.state(RotarySpeed, now), expected, "at {now} s");
        assert_eq!(
            conditioner.is_brought_to_safe(RotarySpeed, now),
            now > 115.0,
            "at {now} s"
        );
    }
    // 40 r/min, held to 115 s, then 5 r/min per s.
    assert_eq!(conditioner.target(RotarySpeed, 114.0), 40.0);
    assert_eq!(conditioner.target(RotarySpeed, 117.0), 30.0);
    assert_eq!(conditioner.target(RotarySpeed, 125.0), 0.0);
    conditioner.offer(RotarySpeed, 41.0, 125.1).unwrap();
    assert_eq!(conditioner.state(RotarySpeed, 125.1), InputState::Ok);
    assert!(!conditioner.is_brought_to_safe(RotarySpeed, 125.1));
}

/// Without a good sample ever, too: then the start value is what is held.
#[test]
fn an_input_that_was_never_good_becomes_stale() {
    let mut rules = [*conditioner().rule(RotarySpeed); InputKind::COUNT];
    rules[0].initial = 20.0;
    let mut conditioner = Conditioner::new(rules);
    conditioner.offer(RotarySpeed, f64::NAN, 10.0).unwrap_err();
    conditioner.offer(RotarySpeed, -7.0, 14.0).unwrap_err();
    assert_eq!(conditioner.state(RotarySpeed, 14.9), InputState::Rejected);
    assert_eq!(conditioner.state(RotarySpeed, 15.0), InputState::Stale);
    assert_eq!(conditioner.target(RotarySpeed, 25.0), 20.0);
    assert_eq!(conditioner.target(RotarySpeed, 27.0), 10.0);
    // A simulated clock that starts over begins the time anew.
    conditioner.clock_set(3.0);
    assert_eq!(conditioner.state(RotarySpeed, 7.9), InputState::Rejected);
    assert_eq!(conditioner.state(RotarySpeed, 8.0), InputState::Stale);
}

#[test]
fn a_stamped_sample_is_as_old_as_its_stamp_says() {
    let mut conditioner = conditioner();
    let stamp = |age: f64| Stamp {
        age,
        bad: false,
        max_skew: 0.5,
    };
    conditioner
        .offer_stamped(RotarySpeed, 40.0, 100.0, &stamp(2.0))
        .unwrap();
    assert_eq!(conditioner.age(RotarySpeed, 100.0), Some(2.0));
    assert_eq!(conditioner.state(RotarySpeed, 100.5), InputState::Slow);
    // A clock a little ahead is no news from the future.
    conditioner
        .offer_stamped(RotarySpeed, 41.0, 101.0, &stamp(-0.5))
        .unwrap();
    assert_eq!(conditioner.age(RotarySpeed, 101.0), Some(0.0));
    let mut refuse = |value: f64, stamp: Stamp| {
        let refused = conditioner.offer_stamped(RotarySpeed, value, 102.0, &stamp);
        refused.unwrap_err().to_string()
    };
    let said = refuse(42.0, stamp(-0.6));
    assert!(
        said.starts_with(
            "rig/inputs: rotary_speed 42 r/min refused: its stamp is 0.600 s ahead of the clock, at most 0.5 s"
        ),
        "{said}"
    );
    let said = refuse(42.0, stamp(5.0));
    assert!(said.contains("its stamp is 5.000 s old, stale from 5 s on"), "{said}");
    let bad = Stamp {
        bad: true,
        ..stamp(0.1)
    };
    assert!(refuse(42.0, bad).contains("its source calls it BAD"));
    assert!(refuse(42.0, stamp(f64::NAN)).contains("not a finite number"));
    assert!(refuse(500.0, stamp(0.1)).contains("above the maximum of 120 r/min"));
    // The stamps' order counts, not that of arrival.
    assert!(refuse(42.0, stamp(1.5)).contains("before that of the last good sample"));
    assert_eq!(conditioner.last_good(RotarySpeed), Some(41.0));
    assert_eq!(conditioner.counts(RotarySpeed).rejected, [1, 0, 0, 1, 1, 1, 1, 1]);
}

/// A log of 1 Hz with steps of up to 2 s and 0.3 s of jitter on the network is never called slow.
#[test]
fn a_jittering_1_hz_log_is_ok() {
    let mut conditioner = conditioner();
    for step in 0..100 {
        let time = 2.0 * f64::from(step) + if step % 2 == 0 { 0.0 } else { 0.3 };
        assert!(step == 0 || conditioner.state(RotarySpeed, time) == InputState::Ok);
        conditioner.offer(RotarySpeed, 40.0, time).unwrap();
    }
}

#[test]
fn stale_is_held_then_brought_to_safe() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 0.0).unwrap();
    assert_eq!(conditioner.target(RotarySpeed, 15.0), 40.0);
    assert_eq!(conditioner.target(RotarySpeed, 17.0), 30.0);
    assert_eq!(conditioner.target(RotarySpeed, 1000.0), 0.0);
}

/// The safe value of a silent rig is a bound from above, in either sense of rotation.
#[test]
fn a_silent_rig_is_never_sped_up_by_its_safe_value() {
    for (safe, value, after) in [
        (120.0, 40.0, 40.0),
        (30.0, 40.0, 30.0),
        (-50.0, -20.0, -20.0),
        (-50.0, 20.0, 0.0),
        (0.0, -20.0, 0.0),
        (60.0, 0.0, 0.0),
    ] {
        let mut rules = [*conditioner().rule(RotarySpeed); InputKind::COUNT];
        (rules[0].min, rules[0].safe) = (-120.0, safe);
        let mut conditioner = Conditioner::new(rules);
        conditioner.offer(RotarySpeed, value, 0.0).unwrap();
        assert_eq!(
            conditioner.target(RotarySpeed, 1000.0),
            after,
            "safe {safe} after {value}"
        );
    }
}

/// Each rule that could raise the target of a silent rig is changed once it has been brought to standstill.
#[test]
fn no_change_of_rules_raises_the_target_of_a_silent_rig() {
    let changes: [fn(&mut InputRule); 4] = [
        |rule| rule.safe = 120.0,
        |rule| rule.hold_before_safe = 1e6,
        |rule| rule.max_age = 1e6,
        |rule| (rule.min, rule.safe) = (100.0, 120.0),
    ];
    for (number, change) in changes.into_iter().enumerate() {
        // Changed on the way to the safe value, at 20 r/min, and at standstill.
        for (at, present) in [(19.0, 20.0), (1000.0, 0.0)] {
            let mut conditioner = conditioner();
            conditioner.offer(RotarySpeed, 40.0, 0.0).unwrap();
            let mut rule = *conditioner.rule(RotarySpeed);
            change(&mut rule);
            let mut rules = InputKind::ALL.map(|kind| *conditioner.rule(kind));
            rules[0] = rule;
            assert_eq!(conditioner.target(RotarySpeed, at), present);
            conditioner.set_rules(rules, at);
            for later in [0.0, 1.0, 100.0, 1e5] {
                let target = conditioner.target(RotarySpeed, at + later);
                assert!(
                    target <= present,
                    "change {number} at {at} s: {target} r/min after {later} s"
                );
            }
            // A good sample ends it.
            conditioner.offer(RotarySpeed, 110.0, at + 2e5).unwrap();
            assert_eq!(conditioner.target(RotarySpeed, at + 2e5), 110.0);
        }
    }
}

/// A changed ramp acts from the change on, without a jump.
#[test]
fn a_changed_ramp_begins_at_the_present_value() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 0.0).unwrap();
    let mut rules = InputKind::ALL.map(|kind| *conditioner.rule(kind));
    rules[0].safe_ramp = 1.0;
    // Held to 15 s, then 5 r/min per s for 2 s, then 1 r/min per s.
    conditioner.set_rules(rules, 17.0);
    assert_eq!(conditioner.target(RotarySpeed, 17.0), 30.0);
    assert_eq!(conditioner.target(RotarySpeed, 20.0), 27.0);
    assert_eq!(conditioner.target(RotarySpeed, 100.0), 0.0);
}

#[test]
fn a_clock_that_starts_over_does_not_lock_the_input() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 1000.0).unwrap();
    conditioner.clock_set(0.0);
    assert_eq!(conditioner.state(RotarySpeed, 0.0), InputState::Ok);
    conditioner.offer(RotarySpeed, 41.0, 0.5).unwrap();
}

#[test]
fn an_old_sample_that_comes_late_does_not_make_the_input_rejected() {
    let mut conditioner = conditioner();
    conditioner.offer(RotarySpeed, 40.0, 10.0).unwrap();
    let rejection = conditioner.offer(RotarySpeed, 41.0, 9.0).unwrap_err();
    assert_eq!(rejection.reason, RejectionReason::TimeBackwards { by: 1.0 });
    assert_eq!(conditioner.state(RotarySpeed, 10.0), InputState::Ok);
    assert_eq!(conditioner.last_rejection(RotarySpeed), Some(rejection));
}

fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..150.0, any::<f64>(), Just(f64::NAN), Just(f64::INFINITY)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn targets_stay_within_limits_whatever_comes(
        samples in prop::collection::vec((0..InputKind::COUNT, any_value(), any_value()), 0..50),
        now in any_value(),
    ) {
        let mut conditioner = conditioner();
        for (index, value, time) in samples {
            let _ = conditioner.offer(InputKind::ALL[index], value, time);
            for kind in InputKind::ALL {
                let target = conditioner.target(kind, now);
                prop_assert!(target >= conditioner.rule(kind).min && target <= conditioner.rule(kind).max, "{kind}: {target}");
            }
            let _ = conditioner.quality(now);
        }
    }

    #[test]
    fn every_sample_is_counted_once(
        samples in prop::collection::vec((0..InputKind::COUNT, any_value(), 0.0..1e3f64), 0..50),
    ) {
        let mut conditioner = conditioner();
        for (index, value, time) in &samples {
            let _ = conditioner.offer(InputKind::ALL[*index], *value, *time);
        }
        for kind in InputKind::ALL {
            let counts = conditioner.counts(kind);
            let sent = samples.iter().filter(|(index, ..)| *index == kind.index()).count();
            prop_assert_eq!(counts.accepted + counts.rejected_total(), sent as u64);
        }
    }

    /// Whatever the other inputs do, one that is optional and was never sent is assumed, and changes no quality.
    #[test]
    fn an_optional_input_that_never_came_changes_nothing(
        samples in prop::collection::vec((any::<bool>(), any_value(), 0.0..1e3f64), 0..50),
        now in 0.0..2e3f64,
    ) {
        let mut conditioner = conditioner();
        for (speed, value, time) in samples {
            let _ = conditioner.offer(if speed { RotarySpeed } else { WeightOnBit }, value, time);
        }
        let required = conditioner.state(RotarySpeed, now).worse(conditioner.state(WeightOnBit, now));
        prop_assert_eq!(conditioner.quality(now), required);
        for (kind, assumed) in [(RateOfPenetration, 3.0), (StandpipePressure, 0.0)] {
            prop_assert_eq!(conditioner.state(kind, now), InputState::Assumed);
            prop_assert_eq!(conditioner.target(kind, now), assumed);
            prop_assert!(!conditioner.is_brought_to_safe(kind, now));
        }
    }

    /// An optional input that was sent ages as the others do, and the quality says so.
    #[test]
    fn an_optional_input_that_was_sent_becomes_stale(value in -200.0..200.0f64, silence in 0.0..100.0f64) {
        let mut conditioner = conditioner();
        conditioner.offer(RateOfPenetration, value, 0.0).unwrap();
        for kind in [RotarySpeed, WeightOnBit] {
            conditioner.offer(kind, 10.0, silence).unwrap();
        }
        let expected = match silence {
            silence if silence < 2.5 => InputState::Ok,
            silence if silence < 5.0 => InputState::Slow,
            _ => InputState::Stale,
        };
        prop_assert_eq!(conditioner.state(RateOfPenetration, silence), expected);
        prop_assert_eq!(conditioner.quality(silence), expected);
        let target = conditioner.target(RateOfPenetration, silence);
        prop_assert!(target.abs() <= value.abs() && target * value >= 0.0, "{target} from {value}");
        if silence <= 15.0 {
            prop_assert_eq!(target, value);
        }
    }

    /// Between samples the target never moves away from the safe value and never faster than the ramp.
    #[test]
    fn the_way_to_safe_is_monotone_and_bounded(
        value in 0.0..120.0f64,
        from in 0.0..100.0f64,
        step in 0.0..10.0f64,
    ) {
        let mut conditioner = conditioner();
        conditioner.offer(RotarySpeed, value, 0.0).unwrap();
        let (before, after) = (conditioner.target(RotarySpeed, from), conditioner.target(RotarySpeed, from + step));
        prop_assert!(after <= before);
        prop_assert!(before - after <= conditioner.rule(RotarySpeed).safe_ramp * step + 1e-9);
    }
}
