//! What is asked of the search for advice, and how long its answer holds.

use super::*;
use crate::alarms::{AlarmId, AlarmSet, Change, Knob};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

const AT: [f64; 2] = [120.0, 10.0];
/// Time on the clock of the host (s).
const NOW: f64 = 1000.0;

fn config() -> Config {
    Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
}

fn acting(at: [f64; 2]) -> Acting {
    Acting {
        set: Inputs {
            rotary_speed: rpm_to_rad_per_s(at[0]),
            weight_on_bit: kn_to_n(at[1]),
            rate_of_penetration: 10.0 / 3600.0,
            standpipe_pressure: 8e6,
        },
        parameters: InForce {
            live: LiveParameters {
                inner_friction: [0.7, 0.7],
                outer_friction: [0.2, 0.2],
                bit_friction_factor: 0.5,
            },
            whirl: WhirlSettings::default(),
            slew: [1.0; 4],
            limits: [[0.0, 150.0], [0.0, 60.0]],
            fluctuation: Fluctuation::of(&config().inputs),
        },
    }
}

fn set(ids: &[AlarmId]) -> AlarmSet {
    ids.iter().copied().collect()
}

fn leads_with(alarm: AlarmId, standing: &[AlarmId]) -> Option<Leading> {
    Some(Leading {
        alarm,
        standing: set(standing),
        shelved: AlarmSet::EMPTY,
    })
}

fn leads() -> Option<Leading> {
    leads_with(AlarmId::BackwardWhirl, &[AlarmId::BackwardWhirl])
}

fn shock() -> Option<Leading> {
    leads_with(AlarmId::Shock, &[AlarmId::Shock])
}

fn tested() -> Tested {
    Tested {
        ends: set(&[AlarmId::BackwardWhirl]),
        stays: AlarmSet::EMPTY,
        from: AT,
        change: Change {
            quantity: Knob::Speed,
            to: 72.0,
        },
        ended: 9,
        of: 10,
        tools: 0,
    }
}

/// An advisor that was asked `ago`.
fn asked(ago: f64) -> Advisor {
    let advisor = Advisor::default();
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), None);
    wait(&advisor, ago);
    advisor
}

fn wait(advisor: &Advisor, ago: f64) {
    if let Some(asked) = &mut advisor.lock().asked {
        asked.since -= ago;
    }
}

/// One that has its answer.
fn answered() -> Advisor {
    let advisor = asked(SETTLED);
    let (what, _) = advisor.due(NOW).unwrap();
    advisor.answer(what, Some(tested()));
    advisor
}

#[test]
fn a_search_waits_for_a_settled_alarm_and_holds_where_it_was_made() {
    assert!(asked(0.0).due(NOW).is_none());
    let advisor = answered();
    assert!(advisor.due(NOW).is_none(), "one search is enough");
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), Some(tested()));
    assert_eq!(advisor.follow(leads(), &acting([119.0, 10.1]), NOW), Some(tested()));
    // A rig wavers by more than a drive does.
    assert_eq!(advisor.follow(leads(), &acting([117.0, 9.0]), NOW), Some(tested()));
    // Somewhere else, or for another alarm, it says nothing.
    assert_eq!(advisor.follow(leads(), &acting([100.0, 10.0]), NOW), None);
    assert_eq!(advisor.follow(shock(), &acting(AT), NOW), None);
    // Once nothing stands it is forgotten.
    assert_eq!(advisor.follow(None, &acting(AT), NOW), None);
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), None);
}

/// What a change of each value within its tolerance does, and of one beyond.
#[test]
fn advice_ends_with_the_tool_that_it_was_tested_on_and_is_asked_for_anew() {
    type Changes = fn(&mut Acting, f64);
    let changes: [(&str, Changes, f64, f64); 11] = [
        (
            "inner friction, around",
            |now, by| now.parameters.live.inner_friction[0] *= by,
            1.04,
            1.0 / 0.7,
        ),
        (
            "inner friction, along",
            |now, by| now.parameters.live.inner_friction[1] *= by,
            0.96,
            0.9,
        ),
        (
            "outer friction, around",
            |now, by| now.parameters.live.outer_friction[0] *= by,
            1.04,
            1.1,
        ),
        (
            "outer friction, along",
            |now, by| now.parameters.live.outer_friction[1] *= by,
            0.96,
            0.9,
        ),
        (
            "bit",
            |now, by| now.parameters.live.bit_friction_factor *= by,
            1.04,
            1.1,
        ),
        (
            "rate of penetration",
            |now, by| now.set.rate_of_penetration *= by,
            1.09,
            1.3,
        ),
        ("pulling back", |now, by| now.set.rate_of_penetration *= by, 1.0, -1.0),
        ("pressure", |now, by| now.set.standpipe_pressure *= by, 0.92, 0.0),
        ("slew limit", |now, by| now.parameters.slew[0] *= by, 1.0, 2.0),
        (
            "limit of the speed",
            |now, by| now.parameters.limits[0][1] *= by,
            1.0,
            0.5,
        ),
        (
            "threshold of whirl",
            |now, by| now.parameters.whirl.backward_cycles[1] *= by,
            1.0,
            1.5,
        ),
    ];
    for (what, change, small, large) in changes {
        let advisor = answered();
        let mut now = acting(AT);
        change(&mut now, small);
        assert_eq!(advisor.follow(leads(), &now, NOW), Some(tested()), "{what}");
        let mut now = acting(AT);
        change(&mut now, large);
        assert_eq!(advisor.follow(leads(), &now, NOW), None, "{what}");
        assert!(advisor.due(NOW).is_none(), "{what} has not settled");
        wait(&advisor, SETTLED);
        assert!(advisor.due(NOW).is_some(), "{what} is not asked anew");
        assert_eq!(advisor.follow(leads(), &now, NOW), None, "{what}");
    }
    // Small changes that add up.
    let advisor = answered();
    let mut now = acting(AT);
    let followed = (0..10).map(|_| {
        now.parameters.live.inner_friction[0] *= 1.02;
        advisor.follow(leads(), &now, NOW).is_some()
    });
    assert_eq!(
        followed.take_while(|holds| *holds).count(),
        2,
        "5 % are two steps of 2 %"
    );
    // A rig that does not advance and does not pump.
    let (zero, mut jitter) = (acting(AT), acting(AT));
    let zero = Acting {
        set: Inputs {
            rate_of_penetration: 0.0,
            standpipe_pressure: 0.0,
            ..zero.set
        },
        ..zero
    };
    (jitter.set.rate_of_penetration, jitter.set.standpipe_pressure) = (0.5 / 3600.0, -0.1e6);
    assert!(zero.is(&jitter));
}

#[test]
fn an_alarm_that_comes_is_asked_for_too_and_one_that_goes_is_not_asked_for_anew() {
    let advisor = answered();
    let both = leads_with(AlarmId::BackwardWhirl, &[AlarmId::BackwardWhirl, AlarmId::Shock]);
    assert_eq!(
        advisor.follow(both, &acting(AT), NOW),
        None,
        "nothing has tested that shock ends"
    );
    wait(&advisor, SETTLED);
    let (what, stop) = advisor.due(NOW).unwrap();
    assert_eq!(Some(what.leading), both);
    // It goes, and returns: the search goes on. What was found before it came holds without it.
    for (leading, expected) in [(leads(), Some(tested())), (both, None)] {
        assert_eq!(advisor.follow(leading, &acting(AT), NOW), expected);
        assert!(!stop.load(Ordering::Relaxed));
    }
    advisor.answer(what, Some(tested()));
    for leading in [both, leads()] {
        assert_eq!(advisor.follow(leading, &acting(AT), NOW), Some(tested()));
    }
    assert!(advisor.due(NOW).is_none());
}

/// All alarms that stand are to end, so that nothing depends on which of them leads.
#[test]
fn another_alarm_that_leads_ends_neither_search_nor_advice() {
    let standing = [AlarmId::BackwardWhirl, AlarmId::Shock];
    let advisor = Advisor::default();
    let _ = advisor.follow(leads_with(AlarmId::BackwardWhirl, &standing), &acting(AT), NOW);
    wait(&advisor, SETTLED);
    let (what, stop) = advisor.due(NOW).unwrap();
    let by_shock = leads_with(AlarmId::Shock, &standing);
    assert_eq!(advisor.follow(by_shock, &acting(AT), NOW), None);
    assert_eq!(advisor.follow(shock(), &acting(AT), NOW), None);
    assert!(!stop.load(Ordering::Relaxed));
    advisor.answer(what, Some(tested()));
    for leading in [by_shock, shock(), leads()] {
        assert_eq!(advisor.follow(leading, &acting(AT), NOW), Some(tested()));
    }
}

/// A client that sends goals without end would otherwise end every search that begins.
#[test]
fn a_turn_that_is_kept_does_not_give_way_to_goals_and_ends_with_the_node() {
    let advisor = asked(SETTLED);
    let (_, search) = advisor.due(NOW).unwrap();
    advisor.yield_to_goal();
    assert!(search.load(Ordering::Relaxed));
    advisor.keep(true);
    let (_, search) = advisor.due(NOW).unwrap();
    let forecast = advisor.forecasts();
    advisor.yield_to_goal();
    assert!(!search.load(Ordering::Relaxed) && !forecast.load(Ordering::Relaxed));
    advisor.interrupt();
    assert!(search.load(Ordering::Relaxed) && forecast.load(Ordering::Relaxed));
}

/// Moves the beginning of the search that runs back.
fn ran_for(advisor: &Advisor, ago: f64) {
    if let Some(course) = &mut advisor.lock().course {
        course.began -= ago;
    }
}

#[test]
fn what_is_done_is_said_from_the_first_alarm_to_the_answer() {
    let advisor = asked(0.0);
    assert_eq!(advisor.trial(NOW), Trial::Waits);
    wait(&advisor, SETTLED);
    let (what, _) = advisor.due(NOW).unwrap();
    assert_eq!(advisor.trial(NOW), Trial::Runs { seconds: None });
    // A quarter of what a search usually takes, in 14.5 s: three quarters in 43.5 s, which are 50 s in tens.
    ran_for(&advisor, 14.5);
    let quarter = SearchProgress {
        seconds: 0.25 * USUAL,
        first: None,
    };
    advisor.hear(&what, &quarter, NOW);
    assert_eq!(advisor.trial(NOW), Trial::Runs { seconds: Some(50) });
    // One that takes longer has no number.
    ran_for(&advisor, 60.0);
    assert_eq!(advisor.trial(NOW), Trial::Runs { seconds: None });
    advisor.answer(what, None);
    assert_eq!(advisor.trial(NOW), Trial::NothingFound);
    // At another speed the next search is as fast: 58 s.
    let _ = advisor.follow(leads(), &acting([90.0, 10.0]), NOW);
    assert_eq!(advisor.trial(NOW), Trial::Waits);
    wait(&advisor, SETTLED);
    let (what, _) = advisor.due(NOW).unwrap();
    assert_eq!(advisor.trial(NOW), Trial::Runs { seconds: Some(60) });
    // Nothing was tried where the state of the run could not be had.
    advisor.give_up(what);
    assert_eq!(advisor.trial(NOW), Trial::Waits);
}

#[test]
fn a_first_answer_holds_until_more_members_refute_it() {
    let advisor = asked(SETTLED);
    let (what, stop) = advisor.due(NOW).unwrap();
    let progress = |first| SearchProgress { seconds: 200.0, first };
    let four = Tested {
        ended: 4,
        of: 4,
        tools: 0,
        ..tested()
    };
    advisor.hear(&what, &progress(None), NOW);
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), None);
    advisor.hear(&what, &progress(Some(four)), NOW);
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), Some(four));
    assert!(!stop.load(Ordering::Relaxed), "more members confirm it");
    // It is held against the set point as the last answer is.
    assert_eq!(advisor.follow(leads(), &acting([90.0, 10.0]), NOW), None);
    assert!(stop.load(Ordering::Relaxed));
    let (what, _) = {
        let _ = advisor.follow(leads(), &acting(AT), NOW);
        wait(&advisor, SETTLED);
        advisor.due(NOW).unwrap()
    };
    advisor.hear(&what, &progress(Some(four)), NOW);
    advisor.hear(&what, &progress(None), NOW);
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), None, "it is refuted");
    advisor.answer(what, Some(tested()));
    assert_eq!(advisor.follow(leads(), &acting(AT), NOW), Some(tested()));
}

/// The fluctuation counts 5 % and 2.5 % of the range as the same: 6 r/min of 120, and 1.5 kN of a range of 60.
#[test]
fn what_a_rig_that_wavers_seems_to_have_set_for_a_moment_ends_no_search() {
    let advisor = asked(SETTLED);
    let (_, stop) = advisor.due(NOW).unwrap();
    for _ in 0..3 {
        let _ = advisor.follow(leads(), &acting([120.0, 12.0]), NOW);
        let _ = advisor.follow(leads(), &acting(AT), NOW);
    }
    assert!(!stop.load(Ordering::Relaxed));
    // It stays there.
    let _ = advisor.follow(leads(), &acting([120.0, 12.0]), NOW);
    if let Some(away) = &mut advisor.lock().away {
        *away -= AWAY;
    }
    let _ = advisor.follow(leads(), &acting([120.0, 12.0]), NOW);
    assert!(stop.load(Ordering::Relaxed));
    // A change of twice as much is one at once.
    let advisor = asked(SETTLED);
    let (_, stop) = advisor.due(NOW).unwrap();
    let _ = advisor.follow(leads(), &acting([120.0, 13.5]), NOW);
    assert!(stop.load(Ordering::Relaxed));
}

#[test]
fn a_forecast_gives_way_to_goals_and_searches() {
    let advisor = asked(0.0);
    let forecast = advisor.forecasts();
    let _ = advisor.follow(leads(), &acting(AT), NOW);
    assert!(!forecast.load(Ordering::Relaxed), "the alarm has not settled");
    let advisor = asked(SETTLED);
    let forecast = advisor.forecasts();
    let _ = advisor.follow(leads(), &acting(AT), NOW);
    assert!(forecast.load(Ordering::Relaxed));
    let (asked, _) = advisor.due(NOW).unwrap();
    advisor.answer(asked, Some(tested()));
    let forecast = advisor.forecasts();
    let _ = advisor.follow(leads(), &acting(AT), NOW);
    assert!(!forecast.load(Ordering::Relaxed), "the search has its answer");
    advisor.interrupt();
    assert!(forecast.load(Ordering::Relaxed));
}

#[test]
fn what_changes_stops_the_search() {
    for change in [0, 1, 2, 3, 4] {
        let advisor = asked(SETTLED);
        let (_, stop) = advisor.due(NOW).unwrap();
        match change {
            0 => drop(advisor.follow(None, &acting(AT), NOW)),
            1 => drop(advisor.follow(leads(), &acting([90.0, 10.0]), NOW)),
            2 => drop(advisor.follow(shock(), &acting(AT), NOW)),
            3 => {
                let mut now = acting(AT);
                now.parameters.live.inner_friction = [1.0; 2];
                let _ = advisor.follow(leads(), &now, NOW);
            }
            _ => advisor.interrupt(),
        }
        assert!(stop.load(Ordering::Relaxed), "{change}");
    }
    let advisor = asked(SETTLED);
    let (_, stop) = advisor.due(NOW).unwrap();
    let _ = advisor.follow(leads(), &acting(AT), NOW);
    assert!(!stop.load(Ordering::Relaxed));
}
