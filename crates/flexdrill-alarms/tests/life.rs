//! The life of an alarm, written out.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use flexdrill_alarms::{
    AlarmSystem, Change, Definition, Delays, Event, Observation, Operator, Priority, Refusal, SavedError, Shelving,
    State, Time, Unshelving, span,
};

const ANN: Operator<'static> = Operator {
    name: "ann",
    reason: "reaming",
};

/// One alarm, an on-delay of 2 s, an off-delay of 5 s, shelved for an hour at most.
struct Plant {
    system: AlarmSystem,
    time: Time,
    events: Vec<Event>,
}

impl Plant {
    fn new() -> Self {
        let whirl = Definition {
            id: "whirl",
            delays: Delays { on: 2.0, off: 5.0 },
            in_service: true,
        };
        Self {
            system: AlarmSystem::new(vec![whirl], 3600.0),
            time: 0,
            events: Vec::new(),
        }
    }

    /// The condition as it is for so many seconds, looked at every 0.1 s.
    fn run(&mut self, seconds: f64, priority: Option<Priority>, suppressed: bool) -> State {
        for _ in 0..(seconds * 10.0).round() as u32 {
            self.time += span(0.1);
            let observed = Observation {
                priority,
                suppressed,
                evidence: "4.4 bends per turn",
            };
            self.system.advance(self.time, &mut self.events);
            self.system.observe(0, self.time, &observed, &mut self.events);
        }
        self.state()
    }

    fn state(&self) -> State {
        self.system.alarm(0).standing.state()
    }

    fn shelve(&mut self, how: Shelving) -> Result<Time, Refusal> {
        self.system.shelve(0, self.time, how, &ANN, &mut self.events)
    }

    fn acknowledge(&mut self) -> Result<(), Refusal> {
        self.system.acknowledge(0, self.time, &ANN, &mut self.events)
    }

    fn changes(&self) -> Vec<&'static str> {
        self.events.iter().map(|event| event.change.name()).collect()
    }
}

use Priority::{High, Low, Medium};

#[test]
fn a_condition_counts_after_its_delay_and_a_gap_begins_it_anew() {
    let mut plant = Plant::new();
    assert_eq!(plant.run(1.9, Some(Low), false), State::Normal);
    plant.run(0.1, None, false);
    assert_eq!(plant.run(1.9, Some(Low), false), State::Normal);
    assert_eq!(plant.run(0.3, Some(Low), false), State::ActiveUnacknowledged);
    assert_eq!(plant.events[0].evidence, "4.4 bends per turn");
    assert_eq!(plant.run(4.9, None, false), State::ActiveUnacknowledged);
    assert_eq!(plant.run(0.3, None, false), State::ReturnedUnacknowledged);
    plant.acknowledge().unwrap();
    assert_eq!(plant.state(), State::Normal);
    assert_eq!(plant.changes(), ["activated", "returned", "acknowledged"]);
    assert_eq!(
        (plant.events[2].operator.as_str(), plant.events[2].reason.as_str()),
        ("ann", "reaming")
    );
}

#[test]
fn a_rise_calls_again_and_a_fall_does_not() {
    let mut plant = Plant::new();
    plant.run(3.0, Some(Low), false);
    plant.acknowledge().unwrap();
    assert_eq!(plant.run(3.0, Some(High), false), State::ActiveUnacknowledged);
    plant.acknowledge().unwrap();
    assert_eq!(plant.run(6.0, Some(Medium), false), State::ActiveAcknowledged);
    assert_eq!(plant.system.alarm(0).standing.active(), Some(Medium));
    assert_eq!(plant.run(6.0, None, false), State::Normal);
    assert_eq!(
        plant.changes(),
        [
            "activated",
            "acknowledged",
            "raised",
            "acknowledged",
            "lowered",
            "returned"
        ]
    );
    assert_eq!(plant.system.statistics().figures().of_priority, [1, 0, 1]);
    assert_eq!(
        plant.acknowledge(),
        Err(Refusal::NothingToAcknowledge {
            alarm: "whirl",
            state: State::Normal
        })
    );
}

#[test]
fn a_rise_of_what_calls_already_is_the_same_call() {
    let mut plant = Plant::new();
    plant.run(3.0, Some(Low), false);
    plant.run(3.0, Some(High), false);
    plant.run(6.0, Some(Low), false);
    plant.run(3.0, Some(Medium), false);
    assert_eq!(plant.changes(), ["activated", "raised", "lowered", "raised"]);
    assert_eq!(plant.system.statistics().figures().of_priority, [0, 0, 1]);
    assert_eq!(
        plant.events.iter().map(|event| event.priority).collect::<Vec<_>>(),
        [Some(Low), Some(High), Some(Low), Some(Medium)]
    );
    // What is to be acknowledged is the highest that it was.
    assert_eq!(plant.system.alarm(0).standing.unacknowledged(), Some(High));
}

#[test]
fn a_shelf_ends_by_its_time_and_what_stands_calls_then() {
    let mut plant = Plant::new();
    plant.run(3.0, Some(Medium), false);
    plant.shelve(Shelving::Timed(60.0)).unwrap();
    assert_eq!(plant.run(59.9, Some(Medium), false), State::Shelved);
    assert_eq!(plant.run(0.1, Some(Medium), false), State::ActiveUnacknowledged);
    assert_eq!(
        plant.events.last().unwrap().change,
        Change::Unshelved(Unshelving::Expired)
    );
    for duration in [0.0, -1.0, 3601.0, f64::NAN, f64::INFINITY] {
        let refusal = plant.shelve(Shelving::Timed(duration)).unwrap_err();
        assert!(refusal.to_string().contains("at most 3600 s"), "{refusal}");
    }
}

#[test]
fn one_shot_lasts_until_the_condition_has_gone() {
    let mut plant = Plant::new();
    plant.shelve(Shelving::OneShot).unwrap();
    assert_eq!(plant.run(60.0, Some(Medium), false), State::Shelved);
    assert_eq!(plant.run(6.0, None, false), State::Normal);
    assert_eq!(plant.changes(), ["shelved", "activated", "returned", "unshelved"]);
    assert_eq!(plant.system.statistics().figures().annunciations, 0);
}

#[test]
fn what_rises_to_high_under_a_shelf_ends_it() {
    let mut plant = Plant::new();
    plant.run(3.0, Some(Low), false);
    plant.shelve(Shelving::Timed(600.0)).unwrap();
    assert_eq!(plant.run(6.0, Some(Medium), false), State::Shelved);
    assert_eq!(plant.run(2.1, Some(High), false), State::ActiveUnacknowledged);
    // Shelved while it stands at high, it stays shelved.
    plant.shelve(Shelving::Timed(600.0)).unwrap();
    assert_eq!(plant.run(60.0, Some(High), false), State::Shelved);
    plant.system.unshelve(0, plant.time, &ANN, &mut plant.events).unwrap();
    assert_eq!(plant.state(), State::ActiveUnacknowledged);
}

#[test]
fn a_drive_that_is_stopped_because_of_an_alarm_does_not_wipe_it_away() {
    let mut plant = Plant::new();
    plant.run(3.0, Some(High), false);
    assert_eq!(plant.run(30.0, Some(High), true), State::SuppressedByDesign);
    assert_eq!(plant.system.alarm(0).standing.unacknowledged(), Some(High));
    assert_eq!(plant.run(1.0, None, false), State::ReturnedUnacknowledged);
    assert_eq!(plant.run(30.0, None, true), State::SuppressedByDesign);
    plant.acknowledge().unwrap();
    assert_eq!(plant.run(1.0, None, false), State::Normal);
    // A condition that is there when the drive turns has all its delay before it.
    plant.run(30.0, Some(High), true);
    assert_eq!(plant.run(1.9, Some(High), false), State::Normal);
    assert_eq!(plant.run(0.3, Some(High), false), State::ActiveUnacknowledged);
}

#[test]
fn requests_want_a_name_and_shelving_a_reason() {
    let mut plant = Plant::new();
    plant.run(3.0, Some(High), false);
    let nobody = Operator { name: " ", ..ANN };
    let (time, events) = (plant.time, &mut plant.events);
    assert_eq!(
        plant.system.acknowledge(0, time, &nobody, events),
        Err(Refusal::NoOperator)
    );
    assert_eq!(
        plant.system.acknowledge_all(time, &nobody, events),
        Err(Refusal::NoOperator)
    );
    let silent = Operator { reason: "", ..ANN };
    assert_eq!(
        plant.system.shelve(0, time, Shelving::OneShot, &silent, events),
        Err(Refusal::NoReason { alarm: "whirl" })
    );
    assert!(matches!(
        plant.system.unshelve(0, time, &ANN, events),
        Err(Refusal::NotShelved { .. })
    ));
    assert!(plant.system.find("wirl").unwrap_err().to_string().contains("whirl"));
    assert_eq!(plant.system.acknowledge_all(time, &ANN, events), Ok(1));
}

#[test]
fn a_state_of_another_format_is_refused() {
    let plant = Plant::new();
    let text = serde_json::to_string(&plant.system.save()).unwrap();
    let other = text.replacen("\"format\":1", "\"format\":7", 1);
    let mut system = Plant::new().system;
    assert_eq!(
        system.restore(&serde_json::from_str(&other).unwrap()),
        Err(SavedError::Format { found: 7 })
    );
}
