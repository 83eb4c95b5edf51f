use super::*;

fn config() -> Config {
    Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
}

fn set(ids: &[AlarmId]) -> AlarmSet {
    ids.iter().copied().collect()
}

fn order(rule: &Advice) -> Vec<(Knob, f64)> {
    let trials = trials(&config(), rule, 60.0, 20.0);
    trials
        .iter()
        .map(|trial| (trial.change.quantity, trial.change.to))
        .collect()
}

#[test]
fn the_smallest_come_first_and_those_against_the_rule_last() {
    let order = order(&Advice {
        lower_weight_on_bit_kn: Some(8.0),
        raise_rotary_speed_rpm: Some(80.0),
        ..Advice::default()
    });
    assert_eq!(order.len(), 20);
    let first = [(Knob::Weight, 18.0), (Knob::Speed, 69.0)];
    assert_eq!(order[..2], first);
    assert_eq!(order[order.len() - 1], (Knob::Speed, 18.0));
    let against = order
        .iter()
        .position(|(quantity, to)| *quantity == Knob::Speed && *to < 60.0);
    assert_eq!(against, Some(10), "{order:?}");
}

#[test]
fn without_a_rule_less_comes_before_more() {
    let order = order(&Advice::default());
    let first = [(Knob::Speed, 54.0), (Knob::Weight, 18.0), (Knob::Speed, 69.0)];
    assert_eq!(order[..3], first);
}

#[test]
fn two_members_against_decide_and_so_do_eight_without_one() {
    let decided = |of, against| Votes { of, against }.decided();
    assert_eq!([decided(1, 0), decided(7, 0), decided(8, 1), decided(13, 1)], [None; 4]);
    assert_eq!([decided(2, 2), decided(14, 2)], [Some(false); 2]);
    assert_eq!([decided(8, 0), decided(14, 1)], [Some(true); 2]);
}

/// Changes to points at which the alarm is not judged are no candidates: of 20 r/min, half is below the gate of
/// stick-slip; of 8 r/min, half is below that of whirl; of 5 kN, half is below the least weight of transfer.
#[test]
fn no_change_goes_below_the_gate_of_the_alarm_that_it_is_to_end() {
    let config = config();
    let settings = config.simulation();
    let least = |alarm, from: [f64; 2], quantity| {
        let trials = judged_trials(&config, &settings, alarm, from);
        let of_quantity = trials.iter().filter(|trial| trial.change.quantity == quantity);
        of_quantity.map(|trial| trial.change.to).fold(f64::INFINITY, f64::min)
    };
    let gate = |alarm, from, quantity, expected: f64| assert_eq!(least(alarm, from, quantity), expected, "{alarm:?}");
    let (speed, weight) = (Knob::Speed, Knob::Weight);
    gate(AlarmId::StickSlip, [20.0, 40.0], speed, 12.0);
    gate(AlarmId::BackwardWhirl, [20.0, 40.0], speed, 6.0);
    for alarm in [
        AlarmId::BackwardWhirl,
        AlarmId::ForwardWhirl,
        AlarmId::Shock,
        AlarmId::JointLoad,
        AlarmId::ChaoticWhirl,
        AlarmId::GuidePreload,
        AlarmId::PressureFolding,
    ] {
        gate(alarm, [8.0, 5.0], speed, 6.0);
        gate(alarm, [8.0, 5.0], weight, 1.5);
    }
    for alarm in [AlarmId::WeightTransfer, AlarmId::TorqueTransfer] {
        gate(alarm, [60.0, 5.0], weight, 3.5);
        gate(alarm, [8.0, 5.0], speed, 6.0);
    }
}

const WHIRL: AlarmId = AlarmId::BackwardWhirl;
const SHOCK: AlarmId = AlarmId::Shock;
const CHAOS: AlarmId = AlarmId::ChaoticWhirl;
const SEED: u64 = 7;
const DONE: Outcome = Outcome {
    open: AlarmSet::EMPTY,
    came: false,
};

fn open(ids: &[AlarmId]) -> Outcome {
    Outcome { open: set(ids), ..DONE }
}

/// What a search finds where members say what `member` does, by trial, number, and whether they confirm; with one
/// thread and with five.
fn found(standing: &[AlarmId], member: impl Fn(&Trial, u32, bool) -> Outcome + Sync) -> Option<Tested> {
    let from = [120.0, 10.0];
    let trials = trials(&config(), &Advice::default(), from[0], from[1]);
    let [one, five] = [1, 5].map(|threads| {
        let search = Search {
            leading: Leading {
                alarm: WHIRL,
                standing: set(standing),
                shelved: AlarmSet::EMPTY,
            },
            from,
            seed: SEED,
            threads,
            member: |trial: &Trial, seed, _: usize, number| Some(member(trial, number, seed != SEED)),
        };
        search.run(&trials).ok().flatten()
    });
    assert_eq!(one, five, "threads");
    one
}

fn is_to(trial: &Trial, rpm: f64) -> bool {
    trial.change
        == Change {
            quantity: Knob::Speed,
            to: rpm,
        }
}

#[test]
fn the_count_is_that_of_the_members_that_took_no_part_in_choosing() {
    // One of the ten that confirm it is against; none of those that chose it was.
    let tested = found(
        &[WHIRL],
        |_, number, confirms| {
            if confirms && number == 3 { open(&[WHIRL]) } else { DONE }
        },
    );
    let tested = tested.unwrap();
    assert_eq!((tested.ended, tested.of), (9, 10));
    assert_eq!(tested.change.to, 108.0);
    assert!(
        tested
            .to_string()
            .ends_with("this ended the alarm in 9 of 10 runs that took no part in choosing it.")
    );
}

#[test]
fn a_change_that_was_lucky_in_its_choice_is_dropped() {
    // 108 r/min: all that choose it are for it, and two of ten that confirm it are not.
    let tested = found(&[WHIRL], |trial, number, confirms| {
        let is_unlucky = is_to(trial, 108.0) && confirms && number < 2;
        if is_unlucky { open(&[WHIRL]) } else { DONE }
    });
    let tested = tested.unwrap();
    assert!(!is_to(
        &Trial {
            change: tested.change,
            raises: false,
            size: 0.1
        },
        108.0
    ));
    assert_eq!((tested.ended, tested.of), (10, 10));
}

#[test]
fn all_standing_alarms_end_under_the_change() {
    // 108 r/min ends the leading alarm alone, 72 r/min all.
    let tested = found(&[WHIRL, SHOCK, CHAOS], |trial, _, _| match trial {
        trial if is_to(trial, 72.0) => DONE,
        trial if is_to(trial, 108.0) => open(&[CHAOS]),
        _ => open(&[WHIRL]),
    });
    let tested = tested.unwrap();
    assert_eq!(tested.change.to, 72.0);
    assert_eq!(
        (tested.ends, tested.stays),
        (set(&[WHIRL, SHOCK, CHAOS]), AlarmSet::EMPTY)
    );
    assert!(
        tested.to_string().contains("this ended all 3 alarms in 10 of 10 runs"),
        "{tested}"
    );
}

#[test]
fn what_no_change_ends_is_said_to_stay() {
    // Chaotic whirl stays everywhere. 108 r/min leaves shock too, 72 r/min ends it.
    let tested = found(&[WHIRL, SHOCK, CHAOS], |trial, _, _| match trial {
        trial if is_to(trial, 72.0) => open(&[CHAOS]),
        trial if is_to(trial, 108.0) => open(&[SHOCK, CHAOS]),
        _ => open(&[WHIRL]),
    });
    let tested = tested.unwrap();
    assert_eq!(tested.change.to, 72.0);
    assert_eq!((tested.ends, tested.stays), (set(&[WHIRL, SHOCK]), set(&[CHAOS])));
    assert!(
        tested.to_string().ends_with(
            "this ended backward whirl and lateral shock in 10 of 10 runs that took no part in choosing it. It does not \
             end chaotic whirl, which stays."
        ),
        "{tested}"
    );
    // One alarm is left by each of two changes: the leading one ends, by the smaller change.
    let tested = found(&[WHIRL, SHOCK, CHAOS], |trial, _, _| match trial {
        trial if is_to(trial, 108.0) => open(&[SHOCK]),
        trial if is_to(trial, 72.0) => open(&[CHAOS]),
        _ => open(&[WHIRL]),
    });
    let tested = tested.unwrap();
    assert_eq!((tested.change.to, tested.stays), (108.0, set(&[SHOCK])));
    assert_eq!(tested.ends, set(&[WHIRL, CHAOS]));
}

#[test]
fn a_change_that_brings_another_alarm_or_ends_nothing_is_no_advice() {
    let brings = |_: &Trial, _, _| Outcome { came: true, ..DONE };
    assert_eq!(found(&[WHIRL], brings), None);
    assert_eq!(found(&[WHIRL, SHOCK], |_, _, _| open(&[WHIRL])), None);
    // Half of the members.
    assert_eq!(
        found(&[WHIRL], |_, number, _| if number % 2 == 0 {
            DONE
        } else {
            open(&[WHIRL])
        }),
        None
    );
}
