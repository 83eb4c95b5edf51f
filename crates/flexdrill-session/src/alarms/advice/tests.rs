//! Advice for alarms that stand together.

use super::*;

const MEDIUM: Priority = Priority::Medium;
const HIGH: Priority = Priority::High;

fn demand(id: AlarmId, priority: Priority, rule: Advice) -> Demand {
    Demand {
        id,
        priority: Some(priority),
        rule,
        shelved: false,
        leads: false,
    }
}

fn at(rpm: f64, kn: f64) -> Operating {
    Operating {
        rpm,
        kn,
        unknown: Unknown::default(),
    }
}

fn told(demands: &[Demand], now: &Operating, ahead: &Ahead) -> Vec<String> {
    let actions = what_to_do(demands, now, &InputsConfig::default(), ahead);
    actions.into_iter().map(|action| action.text).collect()
}

fn texts(demands: &[Demand], rpm: f64, kn: f64) -> Vec<String> {
    told(demands, &at(rpm, kn), &Ahead::default())
}

fn alone(rule: Advice, rpm: f64, kn: f64, priority: Priority) -> String {
    texts(&[demand(AlarmId::StickSlip, priority, rule)], rpm, kn).remove(0)
}

const LESS: Advice = Advice {
    lower_weight_on_bit_kn: Some(8.0),
    raise_weight_on_bit_kn: None,
    lower_rotary_speed_rpm: None,
    raise_rotary_speed_rpm: Some(55.0),
};

#[test]
fn one_change_at_a_time_and_only_in_the_right_direction() {
    assert_eq!(
        alone(LESS, 40.0, 10.0, MEDIUM),
        "Lower the weight on bit below 8 kN (10.0 kN now) and keep the speed."
    );
    assert_eq!(
        alone(LESS, 40.0, 5.0, MEDIUM),
        "Raise the speed above 55 r/min (40 r/min now) and keep the weight on bit."
    );
    assert!(alone(LESS, 60.0, 5.0, MEDIUM).starts_with("Call the engineer"));
    assert_eq!(alone(LESS, 60.0, 5.0, HIGH), "Pick up off bottom and stop the drive.");
    // The drive cannot run that fast.
    let fast = Advice {
        raise_rotary_speed_rpm: Some(500.0),
        ..Advice::default()
    };
    assert!(alone(fast, 40.0, 10.0, MEDIUM).starts_with("Call the engineer"));
    // No driller sets down twenty times the load because of an alarm.
    let heavy = Advice {
        raise_weight_on_bit_kn: Some(25.0),
        ..Advice::default()
    };
    assert!(alone(heavy, 40.0, 1.3, MEDIUM).starts_with("Call the engineer"));
    assert!(alone(heavy, 40.0, 10.0, HIGH).starts_with("Raise the weight on bit above 25 kN (10.0 kN now)"));
}

#[test]
fn the_highest_priority_leads_and_the_others_follow() {
    let slower = |rpm| Advice {
        lower_rotary_speed_rpm: Some(rpm),
        ..Advice::default()
    };
    let sentences = texts(
        &[
            demand(AlarmId::ForwardWhirl, MEDIUM, slower(90.0)),
            demand(AlarmId::BackwardWhirl, HIGH, slower(80.0)),
            demand(AlarmId::StickSlip, MEDIUM, LESS),
        ],
        120.0,
        10.0,
    );
    assert_eq!(
        sentences,
        [
            "The change advised for backward whirl covers this alarm too.",
            "Lower the speed below 80 r/min (120 r/min now) and keep the weight on bit. If it persists, pick up off \
             bottom and stop the drive.",
            "Follow the advice for backward whirl first, then check this alarm again."
        ]
    );
    // A shelved alarm does not lead, and an alarm whose motion has ended asks for nothing.
    let mut demands = [
        demand(AlarmId::BackwardWhirl, HIGH, slower(80.0)),
        demand(AlarmId::StickSlip, MEDIUM, LESS),
    ];
    demands[0].shelved = true;
    assert!(texts(&demands, 120.0, 10.0)[1].starts_with("Lower the weight"));
    demands[0].priority = None;
    assert!(texts(&demands, 120.0, 10.0)[0].starts_with("No further action"));
}

/// The twin's own ramp to its safe value is no speed of the rig.
#[test]
fn without_the_rigs_speed_and_weight_no_number_of_the_twin_is_given() {
    let slower = Advice {
        lower_rotary_speed_rpm: Some(50.0),
        ..Advice::default()
    };
    let demands = [demand(AlarmId::ChaoticWhirl, HIGH, slower)];
    let text = |speed, weight| {
        let now = Operating {
            unknown: Unknown { speed, weight },
            ..at(95.0, 20.0)
        };
        told(&demands, &now, &Ahead::default()).remove(0)
    };
    assert_eq!(
        text(true, true),
        "The rig's speed and weight on bit are unknown to the twin. Read them on the rig's own instruments. If the \
         speed is above 50 r/min, lower it below that and keep the weight on bit. If it persists, pick up off bottom \
         and stop the drive."
    );
    assert!(text(false, true).starts_with("The rig's weight on bit is unknown to the twin. "));
    assert!(text(false, true).contains("Lower the speed below 50 r/min (95 r/min now)"));
    assert!(!text(true, false).contains("now)"));
    // What was tried from the twin's own speed is not told either.
    let tested = Tested {
        ends: [AlarmId::ChaoticWhirl].into_iter().collect(),
        stays: AlarmSet::EMPTY,
        from: [95.0, 20.0],
        change: Change {
            quantity: Knob::Speed,
            to: 66.0,
        },
        ended: 10,
        of: 10,
        tools: 0,
    };
    let now = Operating {
        unknown: Unknown {
            speed: true,
            weight: false,
        },
        ..at(95.0, 20.0)
    };
    let ahead = Ahead {
        trial: Some(Trial::Waits),
        tested: Some(tested),
    };
    assert!(!told(&demands, &now, &ahead)[0].contains("66 r/min"));
}

#[test]
fn a_rule_says_what_the_twin_does_about_it() {
    let slower = Advice {
        lower_rotary_speed_rpm: Some(50.0),
        ..Advice::default()
    };
    let demands = [demand(AlarmId::ChaoticWhirl, MEDIUM, slower)];
    let text = |trial| {
        let ahead = Ahead {
            trial: Some(trial),
            tested: None,
        };
        told(&demands, &at(95.0, 20.0), &ahead).remove(0)
    };
    for (trial, end) in [
        (Trial::Waits, "the twin has not tried it out."),
        (
            Trial::Runs { seconds: None },
            "the twin is searching for a change that ends the alarm.",
        ),
        (
            Trial::Runs { seconds: Some(40) },
            "the twin is searching for a change that ends the alarm, about 40 s.",
        ),
    ] {
        let expected = format!(
            "Lower the speed below 50 r/min (95 r/min now) and keep the weight on bit. This is a rule of thumb: {end}"
        );
        assert_eq!(text(trial), expected);
    }
}

/// What a search has refuted leaves the screen. A limit that lies beyond what it tried (below 0.3 of the present value, above
/// 2 of the speed or 1.5 of the weight) is not refuted, and neither is one at inputs that the twin does not know.
#[test]
fn a_rule_that_the_search_has_refuted_is_not_shown() {
    let slower = Advice {
        lower_rotary_speed_rpm: Some(50.0),
        ..Advice::default()
    };
    let found = Ahead {
        trial: Some(Trial::NothingFound),
        tested: None,
    };
    let text =
        |priority, now: &Operating| told(&[demand(AlarmId::ChaoticWhirl, priority, slower)], now, &found).remove(0);
    assert_eq!(
        text(MEDIUM, &at(95.0, 20.0)),
        "Nothing that the twin has tried ends it: from 0.3 to 2 times the speed, from 0.3 to 1.5 times the weight. Call the \
         engineer. If it gets worse, pick up off bottom."
    );
    assert_eq!(
        text(HIGH, &at(95.0, 20.0)),
        "Nothing that the twin has tried ends it: from 0.3 to 2 times the speed, from 0.3 to 1.5 times the weight. Pick up \
         off bottom and stop the drive."
    );
    // 50 of 200 r/min is a quarter.
    assert_eq!(
        text(MEDIUM, &at(200.0, 20.0)),
        "Lower the speed below 50 r/min (200 r/min now) and keep the weight on bit. This is a rule of thumb: the twin has \
         tried smaller changes, and none ended the alarm."
    );
    let unknown = Operating {
        unknown: Unknown {
            speed: true,
            weight: false,
        },
        ..at(95.0, 20.0)
    };
    assert!(text(MEDIUM, &unknown).contains("lower it below"));
}

/// The change that shock would ask for is put aside with it.
#[test]
fn no_alarm_refers_to_one_that_is_shelved() {
    let lighter = Advice {
        lower_weight_on_bit_kn: Some(8.0),
        ..Advice::default()
    };
    let mut demands = [
        demand(AlarmId::BackwardWhirl, MEDIUM, Advice::default()),
        demand(AlarmId::Shock, MEDIUM, lighter),
    ];
    assert!(texts(&demands, 60.0, 20.0)[0].starts_with("Follow the advice for lateral shock"));
    demands[1].shelved = true;
    assert!(texts(&demands, 60.0, 20.0)[0].starts_with("Call the engineer"));
}

#[test]
fn the_alarm_that_leads_goes_on_leading_among_equals() {
    let slower = |rpm| Advice {
        lower_rotary_speed_rpm: Some(rpm),
        ..Advice::default()
    };
    let mut demands = [
        demand(AlarmId::BackwardWhirl, MEDIUM, slower(80.0)),
        demand(AlarmId::StickSlip, MEDIUM, LESS),
    ];
    demands[1].leads = true;
    let actions = what_to_do(&demands, &at(120.0, 10.0), &InputsConfig::default(), &Ahead::default());
    assert_eq!(
        [actions[0].follows, actions[1].follows],
        [Some(AlarmId::StickSlip), None]
    );
    // One of a higher priority takes the lead.
    demands[0].priority = Some(HIGH);
    let actions = what_to_do(&demands, &at(120.0, 10.0), &InputsConfig::default(), &Ahead::default());
    assert_eq!(
        [actions[0].follows, actions[1].follows],
        [None, Some(AlarmId::BackwardWhirl)]
    );
}

#[test]
fn a_step_respects_the_limits_of_the_other_alarms() {
    let slow = Advice {
        lower_rotary_speed_rpm: Some(50.0),
        ..Advice::default()
    };
    let fast = Advice {
        raise_rotary_speed_rpm: Some(55.0),
        ..Advice::default()
    };
    // At 40 r/min the first rule is fulfilled; the second would undo it.
    let sentences = texts(
        &[
            demand(AlarmId::Shock, HIGH, slow),
            demand(AlarmId::StickSlip, MEDIUM, fast),
        ],
        40.0,
        10.0,
    );
    assert_eq!(
        sentences,
        [
            "Pick up off bottom and stop the drive.",
            "Follow the advice for lateral shock first, then check this alarm again."
        ]
    );
}

#[test]
fn a_tested_change_says_which_alarms_it_ends_and_which_stay() {
    let set = |ids: &[AlarmId]| ids.iter().copied().collect::<AlarmSet>();
    let tested = Tested {
        ends: set(&[AlarmId::BackwardWhirl, AlarmId::StickSlip]),
        stays: set(&[AlarmId::ChaoticWhirl]),
        from: [120.0, 10.0],
        change: Change {
            quantity: Knob::Speed,
            to: 84.0,
        },
        ended: 9,
        of: 10,
        tools: 0,
    };
    let demands = [
        demand(AlarmId::BackwardWhirl, HIGH, Advice::default()),
        demand(AlarmId::StickSlip, MEDIUM, LESS),
        demand(AlarmId::ChaoticWhirl, MEDIUM, Advice::default()),
        demand(AlarmId::Shock, MEDIUM, Advice::default()),
    ];
    let texts = |tested| {
        let ahead = Ahead {
            trial: Some(Trial::Waits),
            tested: Some(tested),
        };
        told(&demands, &at(120.0, 10.0), &ahead)
    };
    assert_eq!(
        texts(tested),
        [
            "Lower the speed to 84 r/min (120 r/min now) and keep the weight on bit: this ended backward whirl and \
             stick-slip in 9 of 10 runs that took no part in choosing it. It does not end chaotic whirl, which stays. If \
             backward whirl persists, pick up off bottom and stop the drive.",
            "The change advised for backward whirl covers this alarm too.",
            "The change advised for backward whirl does not end this alarm: make that change first, then check this \
             alarm again.",
            "Follow the advice for backward whirl first, then check this alarm again."
        ]
    );
    // From 120 to 84 r/min: with half of the way behind it, or beyond it, the sentence would be wrong.
    let ahead = [125.0, 120.0, 103.0, 101.0, 84.0, 80.0].map(|rpm| tested.lies_ahead([rpm, 10.0]));
    assert_eq!(ahead, [true, true, true, false, false, false]);
    let alone = Tested {
        ends: set(&[AlarmId::BackwardWhirl]),
        stays: AlarmSet::EMPTY,
        ..tested
    };
    assert!(texts(alone)[0].contains("this ended the alarm in 9 of 10 runs that took no part in choosing it. If"));
    let of_tools = |tools| texts(Tested { tools, ..alone })[0].clone();
    assert!(of_tools(10).contains("this ended the alarm in 9 of 10 plausible tools. If"));
    assert!(of_tools(7).contains("this ended the alarm in 9 of 10 runs of 7 plausible tools. If"));
    assert!(of_tools(1).contains("this ended the alarm in 9 of 10 runs of one plausible tool. If"));
    let two = Tested {
        stays: set(&[AlarmId::Shock, AlarmId::ChaoticWhirl]),
        ..tested
    };
    assert!(texts(two)[0].contains("It does not end lateral shock and chaotic whirl, which stay."));
}
