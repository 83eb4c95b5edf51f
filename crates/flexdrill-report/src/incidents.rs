//! The incidents of a recording: each time in which an alarm stood.

use flexdrill_alarms::{self as life, Time};
use flexdrill_messages::{Alarm, AlarmEvent, AlarmList, AlarmMoment};

/// Most incidents that are listed; later ones are counted.
const MOST: usize = 5000;

/// The time in which an alarm stood, in ns from the beginning of the recording.
pub(crate) type Incident = life::Incident<AlarmMoment>;
/// All incidents of one alarm.
pub(crate) type Group = life::Group<AlarmMoment>;

/// The alarms of a recording.
#[derive(Debug)]
pub(crate) struct Incidents {
    log: life::Incidents<AlarmMoment>,
    /// The newest list of alarms.
    pub newest: Option<AlarmList>,
    has_events: bool,
}

impl Default for Incidents {
    fn default() -> Self {
        Self {
            log: life::Incidents::new(MOST),
            newest: None,
            has_events: false,
        }
    }
}

/// Ids of the alarms of an input, in the order of `InputKind::ALL`.
pub const INPUT_ALARMS: [&str; 4] = [
    "rotary_speed_input",
    "weight_on_bit_input",
    "rate_of_penetration_input",
    "standpipe_pressure_input",
];

fn is_input(id: &str) -> bool {
    INPUT_ALARMS.contains(&id)
}

/// A time of the recording in seconds.
pub(crate) fn seconds(time: Time) -> f64 {
    time as f64 * 1e-9
}

impl Incidents {
    /// Adds a list of all alarms. `since` gives the time at which an alarm's state began (ns from the beginning).
    pub(crate) fn alarms(&mut self, list: AlarmList, since: impl Fn(&Alarm) -> Time) {
        // A recording that began later does not have the events of the alarms that stood already.
        if self.newest.is_none() && !self.has_events {
            for alarm in list.alarms.iter().filter(|alarm| alarm.active) {
                let standing = life::Occurrence {
                    alarm: &alarm.id,
                    course: life::Course::Stands,
                    priority: alarm.priority,
                    operator: "",
                    acts: alarm.follows.is_empty(),
                };
                self.log
                    .add_standing(since(alarm), 0, &standing, AlarmMoment::from(alarm));
            }
        }
        // An event has the moment at which the priority was reached, and the lists have the worst one since.
        for alarm in list.alarms.iter().filter(|alarm| alarm.active) {
            self.log.worsen(
                &alarm.id,
                alarm.priority,
                &AlarmMoment::from(alarm),
                AlarmMoment::is_worse_than,
            );
        }
        self.newest = Some(list);
    }

    /// Whether the recording has the lists of all alarms, and with them the worst moment of each.
    pub(crate) fn has_lists(&self) -> bool {
        self.newest.is_some()
    }

    /// Adds an event at its time (ns from the beginning).
    pub(crate) fn event(&mut self, time: Time, event: &AlarmEvent) {
        self.has_events = true;
        self.log.add(time, &event.occurrence(), || AlarmMoment::from(event));
    }

    /// Ends the recording at its time (ns from the beginning).
    pub(crate) fn finish(&mut self, time: Time) {
        self.log.finish(time);
    }

    /// The listed incidents in the order of their begin.
    pub(crate) fn list(&self) -> &[Incident] {
        self.log.list()
    }

    /// The number of incidents that are not listed.
    pub(crate) fn more(&self) -> u64 {
        self.log.more()
    }

    /// The incidents of each alarm.
    pub(crate) fn groups(&self) -> impl Iterator<Item = &Group> {
        self.log.groups().values()
    }

    /// The same with the alarms' ids, in their order.
    pub(crate) fn by_id(&self) -> impl Iterator<Item = (&str, &Group)> {
        self.log.groups().iter().map(|(id, group)| (id.as_str(), group))
    }

    /// The input alarms that stand when the recording ends: the log or the rig had ended before, which says nothing
    /// about the drilling. They begin with the alarm, some seconds after the last sample.
    pub(crate) fn inputs_at_the_end(&self) -> impl Iterator<Item = &Incident> {
        self.list()
            .iter()
            .filter(|incident| incident.end.is_none() && is_input(&incident.alarm))
    }

    /// The worst of the driller's alarms, for a headline. An input that is silent until the end does not count.
    pub(crate) fn worst(&self) -> Option<Group> {
        let drilling = self
            .log
            .groups()
            .iter()
            .filter(|(_, group)| group.worst.category == Alarm::DRILLING);
        let counted = drilling.filter_map(|(id, group)| {
            if !is_input(id) || !self.inputs_at_the_end().any(|incident| incident.alarm == *id) {
                return Some(group.clone());
            }
            let ended = || {
                self.list()
                    .iter()
                    .filter(|incident| incident.alarm == *id && incident.end.is_some())
            };
            Some(Group {
                priority: ended().map(|incident| incident.priority).max()?,
                times: ended().count() as u64,
                duration: ended()
                    .filter_map(|incident| Some(incident.end? - incident.begin.max(0)))
                    .sum(),
                ..group.clone()
            })
        });
        counted.max_by_key(|group| (group.priority, group.acts, group.times))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Time = 1_000_000_000;

    fn event(change: u8, priority: u8, evidence: &str) -> AlarmEvent {
        AlarmEvent {
            id: "shock".to_owned(),
            name: "Shock".to_owned(),
            change,
            priority,
            evidence: evidence.to_owned(),
            operator_name: "Ada".to_owned(),
            ..AlarmEvent::default()
        }
    }

    /// A log that ends leaves both inputs stale; the shock while it drilled is what the report is about.
    #[test]
    fn an_input_that_is_silent_to_the_end_heads_no_report() {
        let input = |change: u8, priority: u8| AlarmEvent {
            id: "weight_on_bit_input".to_owned(),
            name: "no valid weight on bit".to_owned(),
            ..event(change, priority, "")
        };
        let mut incidents = Incidents::default();
        incidents.event(60 * SECOND, &input(AlarmEvent::ACTIVATED, Alarm::MEDIUM));
        incidents.event(70 * SECOND, &input(AlarmEvent::RAISED, Alarm::HIGH));
        assert_eq!(incidents.worst(), None);
        assert_eq!(
            incidents.inputs_at_the_end().map(|input| input.begin).next(),
            Some(60 * SECOND)
        );
        let mut incidents = Incidents::default();
        incidents.event(5 * SECOND, &input(AlarmEvent::ACTIVATED, Alarm::LOW));
        incidents.event(9 * SECOND, &input(AlarmEvent::RETURNED, Alarm::LOW));
        incidents.event(60 * SECOND, &input(AlarmEvent::ACTIVATED, Alarm::HIGH));
        let worst = incidents.worst().unwrap();
        assert_eq!(
            (worst.priority, worst.times, worst.duration),
            (Alarm::LOW, 1, 4 * SECOND)
        );
        incidents.event(20 * SECOND, &event(AlarmEvent::ACTIVATED, Alarm::MEDIUM, "strong"));
        assert_eq!(incidents.worst().unwrap().worst.name, "Shock");
        // A matter of the computer is none of the drilling.
        let behind = AlarmEvent {
            id: "real_time".to_owned(),
            category: Alarm::SYSTEM,
            ..event(AlarmEvent::ACTIVATED, Alarm::HIGH, "")
        };
        incidents.event(30 * SECOND, &behind);
        assert_eq!(incidents.worst().unwrap().worst.name, "Shock");
    }

    /// The event of a raise has 138 %; the lists that follow have the index at its worst, with its place.
    #[test]
    fn evidence_and_place_are_of_the_worst_moment() {
        let listed = |value: f64, measured_depth: f64, active: bool| AlarmList {
            alarms: vec![Alarm {
                id: "shock".to_owned(),
                active,
                priority: Alarm::HIGH,
                value,
                threshold: 1.0,
                measured_depth,
                evidence: format!("index {value} at {measured_depth} m"),
                ..Alarm::default()
            }],
            ..AlarmList::default()
        };
        let mut incidents = Incidents::default();
        let mut raised = event(AlarmEvent::ACTIVATED, Alarm::HIGH, "index 1.38 at 1 m");
        (raised.value, raised.measured_depth) = (1.38, 1.0);
        incidents.event(5 * SECOND, &raised);
        for (value, depth, active) in [
            (1.5, 1.5, true),
            (8.96, 4.0, true),
            (3.0, 2.0, true),
            (99.0, 5.0, false),
        ] {
            incidents.alarms(listed(value, depth, active), |_| 0);
        }
        let worst = &incidents.list()[0].worst;
        assert_eq!((worst.value, worst.measured_depth), (8.96, 4.0));
        assert_eq!(worst.evidence, "index 8.96 at 4 m");
        assert!(incidents.has_lists());
    }

    #[test]
    fn what_stood_before_the_recording_began_is_in_it() {
        let mut incidents = Incidents::default();
        let alarm = Alarm {
            id: "shock".to_owned(),
            active: true,
            priority: 2,
            ..Alarm::default()
        };
        let list = AlarmList {
            alarms: vec![alarm, Alarm::default()],
            ..AlarmList::default()
        };
        incidents.alarms(list.clone(), |_| -30 * SECOND);
        incidents.alarms(list, |_| -30 * SECOND);
        incidents.event(4 * SECOND, &event(AlarmEvent::RETURNED, 2, ""));
        assert_eq!(incidents.list().len(), 1);
        assert!(incidents.list()[0].from_before);
        // Of the time before the recording nothing is counted.
        assert_eq!(incidents.groups().map(|group| group.duration).sum::<Time>(), 4 * SECOND);
    }
}
