//! Any sequence of conditions, requests, shelvings, times and restarts.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use flexdrill_alarms::{
    AlarmSystem, Change, Definition, Delays, Event, Observation, Operator, Priority, Saved, Shelving, Standing, State,
    Time, span,
};
use proptest::prelude::*;

const IDS: [&str; 3] = ["whirl", "shock", "input"];
const LONGEST: f64 = 100.0;

#[derive(Debug, Clone)]
enum Action {
    /// Seconds that pass, then what is seen of an alarm.
    Observe(usize, f64, Option<Priority>, bool),
    Advance(f64),
    Acknowledge(usize),
    AcknowledgeAll,
    Shelve(usize, Shelving),
    Unshelve(usize),
    InService(usize, bool),
    Adjusted(usize),
}

fn priority() -> impl Strategy<Value = Option<Priority>> {
    prop_oneof![
        2 => Just(None),
        3 => prop::sample::select(Priority::ALL.to_vec()).prop_map(Some),
    ]
}

fn action() -> impl Strategy<Value = Action> {
    let alarm = || 0..IDS.len();
    let seconds = || prop_oneof![Just(0.1), Just(1.0), Just(5.0), 0.0..150.0_f64, Just(-3.0)];
    prop_oneof![
        8 => (alarm(), seconds(), priority(), prop::bool::weighted(0.15))
            .prop_map(|(alarm, seconds, priority, suppressed)| Action::Observe(alarm, seconds, priority, suppressed)),
        1 => seconds().prop_map(Action::Advance),
        1 => alarm().prop_map(Action::Acknowledge),
        1 => Just(Action::AcknowledgeAll),
        1 => (alarm(), prop_oneof![Just(Shelving::OneShot), (-10.0..200.0_f64).prop_map(Shelving::Timed)])
            .prop_map(|(alarm, how)| Action::Shelve(alarm, how)),
        1 => alarm().prop_map(Action::Unshelve),
        1 => (alarm(), any::<bool>()).prop_map(|(alarm, on)| Action::InService(alarm, on)),
        1 => alarm().prop_map(Action::Adjusted),
    ]
}

fn definitions(in_service: [bool; 3]) -> Vec<Definition> {
    let delays = [(0.0, 0.0), (1.0, 4.0), (5.0, 0.5)];
    let rows = IDS.into_iter().zip(delays).zip(in_service);
    rows.map(|((id, (on, off)), in_service)| Definition {
        id,
        delays: Delays { on, off },
        in_service,
    })
    .collect()
}

/// A system with its clock, its journal and which alarms are in service.
#[derive(Clone)]
struct Plant {
    system: AlarmSystem,
    time: Time,
    in_service: [bool; 3],
    journal: Vec<Event>,
}

impl Plant {
    fn new() -> Self {
        Self {
            system: AlarmSystem::new(definitions([true; 3]), LONGEST),
            time: 0,
            in_service: [true; 3],
            journal: Vec::new(),
        }
    }

    /// A new process that takes up what the old one has kept.
    fn restart(&mut self) {
        let text = serde_json::to_string(&self.system.save()).unwrap();
        let mut system = AlarmSystem::new(definitions(self.in_service), LONGEST);
        system.restore(&serde_json::from_str::<Saved>(&text).unwrap()).unwrap();
        self.system = system;
    }

    fn act(&mut self, action: &Action) {
        let by = Operator {
            name: "ann",
            reason: "test",
        };
        if let Action::Observe(_, seconds, ..) | Action::Advance(seconds) = *action {
            self.time += (seconds * 1e9) as Time;
        }
        let (system, time, journal) = (&mut self.system, self.time, &mut self.journal);
        system.advance(time, journal);
        match *action {
            Action::Observe(alarm, _, priority, suppressed) => {
                let observed = Observation {
                    priority,
                    suppressed,
                    evidence: "seen",
                };
                system.observe(alarm, time, &observed, journal);
            }
            Action::Advance(_) => {}
            Action::Acknowledge(alarm) => drop(system.acknowledge(alarm, time, &by, journal)),
            Action::AcknowledgeAll => drop(system.acknowledge_all(time, &by, journal)),
            Action::Shelve(alarm, how) => drop(system.shelve(alarm, time, how, &by, journal)),
            Action::Adjusted(alarm) => system.adjusted(
                alarm,
                time,
                &Operator {
                    name: "",
                    reason: "the friction factor",
                },
                journal,
            ),
            Action::Unshelve(alarm) => drop(system.unshelve(alarm, time, &by, journal)),
            Action::InService(alarm, on) => {
                self.in_service[alarm] = on;
                let saved = system.save();
                *system = AlarmSystem::new(definitions(self.in_service), LONGEST);
                system.restore(&saved).unwrap();
                system.follow_definitions(time, journal);
            }
        }
    }
}

/// The transitions that there are, written out: from the states of ISA-18.2, with what happens under a shelf
/// or suppressed beside it.
fn is_legal(event: &Event) -> bool {
    use State::*;
    let (from, to) = (event.from, event.to);
    let covered = [Shelved, SuppressedByDesign].contains(&from) && from == to;
    match event.change {
        Change::Activated(_) => {
            (from == Normal || from == ReturnedUnacknowledged) && to == ActiveUnacknowledged
                || from == Shelved && to == Shelved
        }
        Change::Raised(_) => {
            (from == ActiveUnacknowledged || from == ActiveAcknowledged) && to == ActiveUnacknowledged
                || from == Shelved && to == Shelved
        }
        Change::Lowered(_) => from == to && [ActiveUnacknowledged, ActiveAcknowledged, Shelved].contains(&from),
        Change::Returned => {
            (from, to) == (ActiveUnacknowledged, ReturnedUnacknowledged)
                || (from, to) == (ActiveAcknowledged, Normal)
                || from == Shelved && to == Shelved
        }
        Change::Acknowledged => {
            (from, to) == (ActiveUnacknowledged, ActiveAcknowledged)
                || (from, to) == (ReturnedUnacknowledged, Normal)
                || from == SuppressedByDesign && to == SuppressedByDesign
        }
        Change::Shelved(_) => covered || (![OutOfService, SuppressedByDesign].contains(&from) && to == Shelved),
        Change::Unshelved(_) => {
            from == Shelved && (to == Normal || to == ActiveUnacknowledged)
                || from == SuppressedByDesign && to == SuppressedByDesign
        }
        Change::Suppressed => ![OutOfService, SuppressedByDesign].contains(&from) && to == SuppressedByDesign,
        Change::Released => from == SuppressedByDesign && [Normal, ReturnedUnacknowledged, Shelved].contains(&to),
        Change::TakenOut => from != OutOfService && to == OutOfService,
        Change::PutBack => from == OutOfService && to == Normal,
        Change::Adjusted => from == to,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The journal is complete: it has no gaps, every event changes something in a legal way, and what it tells is the
    /// state.
    #[test]
    fn the_journal_gives_the_state(actions in prop::collection::vec(action(), 1..80)) {
        let mut plant = Plant::new();
        let mut told = [Standing::default(); 3];
        for action in &actions {
            let read = plant.journal.len();
            plant.act(action);
            for event in &plant.journal[read..] {
                let before = told[event.alarm];
                prop_assert_eq!(before.state(), event.from);
                told[event.alarm].apply(&event.change);
                prop_assert_eq!(told[event.alarm].state(), event.to);
                let is_of_state = event.change != Change::Adjusted;
                prop_assert!(!is_of_state || told[event.alarm] != before, "no event without a change: {:?}", event);
                prop_assert!(is_legal(event), "{:?}", event);
                prop_assert_eq!(event.time, plant.time);
            }
            for (index, told) in told.iter().enumerate() {
                prop_assert_eq!(plant.system.alarm(index).standing, *told);
            }
        }
        for (index, event) in plant.journal.iter().enumerate() {
            prop_assert_eq!(event.sequence, index as u64 + 1);
        }
        prop_assert_eq!(plant.system.sequence(), plant.journal.len() as u64);
    }

    /// A restart after any action is as none: the same events, the same state.
    #[test]
    fn a_restart_changes_nothing(actions in prop::collection::vec((action(), any::<bool>()), 1..80)) {
        let (mut plant, mut restarted) = (Plant::new(), Plant::new());
        for (action, restart) in &actions {
            plant.act(action);
            restarted.act(action);
            if *restart {
                restarted.restart();
            }
        }
        prop_assert_eq!(&plant.journal, &restarted.journal);
        prop_assert_eq!(plant.system, restarted.system);
    }

    /// What has reached high is shown until somebody has acknowledged or shelved it, or the configuration has switched
    /// it off; and a condition that stands at high for its delay is active unless it is shelved at high.
    #[test]
    fn a_high_alarm_is_never_lost(actions in prop::collection::vec(action(), 1..80)) {
        let mut plant = Plant::new();
        let mut owed = [false; 3];
        let mut high_since = [None; 3];
        for action in &actions {
            let read = plant.journal.len();
            plant.act(action);
            for event in &plant.journal[read..] {
                match event.change {
                    Change::Activated(Priority::High) | Change::Raised(Priority::High) if event.from != State::Shelved => {
                        owed[event.alarm] = true;
                    }
                    Change::Acknowledged | Change::Shelved(_) | Change::TakenOut => owed[event.alarm] = false,
                    _ => {}
                }
            }
            for (index, owed) in owed.iter().enumerate() {
                let standing = plant.system.alarm(index).standing;
                prop_assert!(!owed || standing.unacknowledged() == Some(Priority::High), "{index}: {:?}", standing);
            }
            if let Action::Observe(alarm, seconds, priority, suppressed) = *action {
                let standing = plant.system.alarm(alarm).standing;
                let high = priority == Some(Priority::High) && !suppressed && !standing.is_out_of_service();
                // A clock that goes back begins the delay anew.
                let began = high_since[alarm].filter(|_| high && seconds >= 0.0);
                high_since[alarm] = high.then(|| began.unwrap_or(plant.time));
                let delay = span(definitions([true; 3])[alarm].delays.on);
                if began.is_some_and(|began| plant.time - began >= delay) {
                    prop_assert_eq!(standing.active(), Some(Priority::High));
                    let shown = [State::ActiveUnacknowledged, State::ActiveAcknowledged].contains(&standing.state());
                    let covered = standing.shelf().is_some_and(|shelf| shelf.covers == Priority::High);
                    prop_assert!(shown || covered, "{:?}", standing);
                }
            } else if let Action::InService(alarm, _) = *action {
                high_since[alarm] = None;
            }
        }
    }

    /// Nothing is shelved for longer than the longest time, and no shelf outlasts its end.
    #[test]
    fn shelving_ends(actions in prop::collection::vec(action(), 1..80)) {
        let mut plant = Plant::new();
        for action in &actions {
            let read = plant.journal.len();
            plant.act(action);
            for event in &plant.journal[read..] {
                if let Change::Shelved(shelf) = event.change {
                    prop_assert!(shelf.until > event.time && shelf.until - event.time <= span(LONGEST));
                    prop_assert!(!event.operator.is_empty() && !event.reason.is_empty());
                }
            }
            for index in 0..IDS.len() {
                let shelf = plant.system.alarm(index).standing.shelf();
                let left = shelf.map(|shelf| shelf.until - plant.time);
                prop_assert!(left.is_none_or(|left| left > 0 && left <= span(LONGEST)), "{:?}", left);
            }
        }
    }

    /// The figures are those that the journal gives.
    #[test]
    fn the_figures_are_the_journals(actions in prop::collection::vec(action(), 1..120)) {
        let mut plant = Plant::new();
        for action in &actions {
            // On a clock that goes back a minute has no meaning.
            if !matches!(action, Action::Observe(_, seconds, ..) | Action::Advance(seconds) if *seconds < 0.0) {
                plant.act(action);
            }
        }
        let statistics = plant.system.statistics();
        let mut all = 0;
        let mut most_in_any = 0;
        for index in 0..IDS.len() {
            let times: Vec<Time> = plant
                .journal
                .iter()
                .filter(|event| event.alarm == index && event.annunciates())
                .map(|event| event.time)
                .collect();
            prop_assert_eq!(statistics.annunciations(index), times.len() as u64);
            let within = |from: usize| times[from..].iter().filter(|time| **time - times[from] < span(60.0)).count();
            let most = (0..times.len()).map(within).max().unwrap_or(0);
            prop_assert_eq!(statistics.most_repeats(index), most);
            all += times.len() as u64;
            most_in_any = most_in_any.max(most);
        }
        let figures = statistics.figures();
        prop_assert_eq!(figures.annunciations, all);
        prop_assert_eq!(figures.of_priority.iter().sum::<u64>(), all);
        prop_assert_eq!(figures.most_repeats, most_in_any);
        prop_assert!(figures.flood_share.is_none_or(|share| (0.0..=1.0).contains(&share)));
        prop_assert!(figures.per_hour.is_none_or(|rate| (0.0..1e12).contains(&rate)));
    }
}
