//! Alarms as incidents: each period in which an alarm stood, with its priority, its location and its acknowledgement.

use std::collections::BTreeMap;

use flexdrill_messages::{Alarm, AlarmEvent, AlarmList};

/// Largest number of incidents kept; further ones are only counted.
const MOST: usize = 5000;

/// A period in which an alarm stood.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Incident {
    pub id: String,
    pub name: String,
    /// The highest priority in it.
    pub priority: u8,
    /// s from the beginning.
    pub start: f64,
    /// s from the beginning; `None` while it stands.
    pub end: Option<f64>,
    /// Whether the alarm stood when the recording began.
    pub from_before: bool,
    pub evidence: String,
    pub what_to_do: String,
    pub what_the_engineer_can_do: String,
    /// Measured depth (m), NaN if the alarm has no location.
    pub measured_depth: f64,
    pub inclination: f64,
    pub body: u8,
    /// The operator who acknowledged it.
    pub acknowledged_by: String,
    /// Addressee, a constant of [`Alarm`].
    pub category: u8,
}

/// All incidents of one alarm.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Group {
    pub name: String,
    pub priority: u8,
    pub times: u64,
    /// Total time in which it stood (s).
    pub active: f64,
    pub what_to_do: String,
    /// Addressee, a constant of [`Alarm`].
    pub category: u8,
    pub what_the_engineer_can_do: String,
}

/// The alarms of a recording.
#[derive(Debug, Default)]
pub(crate) struct Incidents {
    pub list: Vec<Incident>,
    pub groups: BTreeMap<String, Group>,
    /// Number of further incidents.
    pub more: u64,
    /// The newest list of alarms.
    pub newest: Option<AlarmList>,
    /// Standing alarms by id: their begin (s), and the index of the incident in the list, if it is there.
    standing: BTreeMap<String, (f64, Option<usize>)>,
    events: u64,
}

/// Ids of the alarms for an input that is not known, in the order of `InputKind::ALL`.
pub const INPUT_ALARMS: [&str; 2] = ["rotary_speed_input", "weight_on_bit_input"];

fn is_input(id: &str) -> bool {
    INPUT_ALARMS.contains(&id)
}

fn is_active(state: u8) -> bool {
    [Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::ACTIVE_ACKNOWLEDGED].contains(&state)
}

impl Incidents {
    /// Adds a list of all alarms. `since` gives the begin of an alarm (s from the beginning).
    pub(crate) fn alarms(&mut self, list: AlarmList, since: impl Fn(&Alarm) -> f64) {
        // A recording that began later has no events of the alarms that stood before.
        if self.newest.is_none() && self.events == 0 {
            for alarm in list.alarms.iter().filter(|alarm| alarm.active) {
                self.begin(Incident {
                    id: alarm.id.clone(),
                    name: alarm.name.clone(),
                    priority: alarm.priority,
                    start: since(alarm),
                    end: None,
                    from_before: true,
                    evidence: alarm.evidence.clone(),
                    what_to_do: alarm.what_to_do.clone(),
                    what_the_engineer_can_do: alarm.what_the_engineer_can_do.clone(),
                    measured_depth: alarm.measured_depth,
                    inclination: alarm.inclination,
                    body: alarm.body,
                    acknowledged_by: String::new(),
                    category: alarm.category,
                });
            }
        }
        self.newest = Some(list);
    }

    /// Adds an event at a time (s from the beginning).
    pub(crate) fn event(&mut self, time: f64, event: &AlarmEvent) {
        self.events += 1;
        match event.change {
            AlarmEvent::ACTIVATED | AlarmEvent::RAISED => self.activate(time, event),
            AlarmEvent::RELEASED | AlarmEvent::PUT_BACK | AlarmEvent::UNSHELVED if is_active(event.to_state) => {
                self.activate(time, event);
            }
            AlarmEvent::RETURNED | AlarmEvent::SUPPRESSED | AlarmEvent::TAKEN_OUT => self.end(time, &event.id),
            AlarmEvent::ACKNOWLEDGED => {
                if let Some(incident) = self.newest_of(&event.id) {
                    incident.acknowledged_by.clone_from(&event.operator_name);
                }
            }
            _ => {}
        }
    }

    /// Adds the standing alarms to the sums; in the list they stay open.
    pub(crate) fn finish(&mut self, time: f64) {
        for (id, (since, _)) in std::mem::take(&mut self.standing) {
            if let Some(group) = self.groups.get_mut(&id) {
                group.active += (time - since).max(0.0);
            }
        }
    }

    /// The input alarms that stand at the end of the recording: the log or the rig had ended before, which says nothing
    /// about the drilling. They begin some seconds after the last sample.
    pub(crate) fn inputs_at_the_end(&self) -> impl Iterator<Item = &Incident> {
        self.list
            .iter()
            .filter(|incident| incident.end.is_none() && is_input(&incident.id))
    }

    /// The worst of the driller's alarms, for the headline. An input that is silent until the end is not included.
    pub(crate) fn worst(&self) -> Option<Group> {
        let drilling = self
            .groups
            .iter()
            .filter(|(_, group)| group.category == Alarm::DRILLING);
        let counted = drilling.filter_map(|(id, group)| {
            if !is_input(id) || !self.inputs_at_the_end().any(|incident| incident.id == *id) {
                return Some(group.clone());
            }
            let ended = || {
                self.list
                    .iter()
                    .filter(|incident| incident.id == *id && incident.end.is_some())
            };
            Some(Group {
                priority: ended().map(|incident| incident.priority).max()?,
                times: ended().count() as u64,
                active: ended()
                    .filter_map(|incident| Some(incident.end? - incident.start.max(0.0)))
                    .sum(),
                ..group.clone()
            })
        });
        counted.max_by_key(|group| (group.priority, group.times))
    }

    fn newest_of(&mut self, id: &str) -> Option<&mut Incident> {
        self.list.iter_mut().rev().find(|incident| incident.id == id)
    }

    fn activate(&mut self, time: f64, event: &AlarmEvent) {
        let Some((_, index)) = self.standing.get(&event.id) else {
            self.begin(Incident {
                id: event.id.clone(),
                name: event.name.clone(),
                priority: event.priority,
                start: time,
                end: None,
                from_before: false,
                evidence: event.evidence.clone(),
                what_to_do: event.what_to_do.clone(),
                what_the_engineer_can_do: event.what_the_engineer_can_do.clone(),
                measured_depth: event.measured_depth,
                inclination: event.inclination,
                body: event.body,
                acknowledged_by: String::new(),
                category: event.category,
            });
            return;
        };
        if let Some(group) = self.groups.get_mut(&event.id) {
            group.priority = group.priority.max(event.priority);
        }
        if let Some(incident) = index.and_then(|index| self.list.get_mut(index))
            && event.priority >= incident.priority
        {
            incident.priority = event.priority;
            incident.evidence.clone_from(&event.evidence);
            incident.what_to_do.clone_from(&event.what_to_do);
            incident.measured_depth = event.measured_depth;
            incident.inclination = event.inclination;
            incident.body = event.body;
        }
    }

    fn begin(&mut self, incident: Incident) {
        let group = self.groups.entry(incident.id.clone()).or_default();
        group.times += 1;
        if incident.priority >= group.priority {
            group.priority = incident.priority;
            group.name.clone_from(&incident.name);
            group.what_to_do.clone_from(&incident.what_to_do);
            group.category = incident.category;
            let engineer = &incident.what_the_engineer_can_do;
            group.what_the_engineer_can_do.clone_from(engineer);
        }
        let kept = self.list.len() < MOST;
        let index = kept.then_some(self.list.len());
        self.standing
            .insert(incident.id.clone(), (incident.start.max(0.0), index));
        if kept {
            self.list.push(incident);
        } else {
            self.more += 1;
        }
    }

    fn end(&mut self, time: f64, id: &str) {
        let Some((since, index)) = self.standing.remove(id) else {
            return;
        };
        if let Some(group) = self.groups.get_mut(id) {
            group.active += (time - since).max(0.0);
        }
        if let Some(incident) = index.and_then(|index| self.list.get_mut(index)) {
            incident.end = Some(time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn an_incident_begins_rises_is_acknowledged_and_ends() {
        let mut incidents = Incidents::default();
        incidents.event(1.0, &event(AlarmEvent::ACTIVATED, 1, "weak"));
        incidents.event(2.0, &event(AlarmEvent::RAISED, 3, "strong"));
        incidents.event(2.5, &event(AlarmEvent::LOWERED, 1, "weak again"));
        incidents.event(3.0, &event(AlarmEvent::ACKNOWLEDGED, 3, ""));
        incidents.event(5.0, &event(AlarmEvent::RETURNED, 3, ""));
        incidents.event(8.0, &event(AlarmEvent::ACTIVATED, 2, "once more"));
        incidents.finish(10.0);
        let [first, second] = incidents.list.as_slice() else {
            panic!("{:?}", incidents.list)
        };
        assert_eq!((first.start, first.end, first.priority), (1.0, Some(5.0), 3));
        assert_eq!(
            (first.evidence.as_str(), first.acknowledged_by.as_str()),
            ("strong", "Ada")
        );
        assert_eq!((second.start, second.end), (8.0, None));
        let group = &incidents.groups["shock"];
        assert_eq!((group.times, group.priority, group.active), (2, 3, 6.0));
    }

    /// A log that ends leaves both inputs stale; the report's headline is the shock during drilling.
    #[test]
    fn an_input_that_is_silent_to_the_end_is_not_the_headline() {
        let input = |change: u8, priority: u8| AlarmEvent {
            id: "weight_on_bit_input".to_owned(),
            name: "weight on bit not known".to_owned(),
            ..event(change, priority, "")
        };
        let mut incidents = Incidents::default();
        incidents.event(60.0, &input(AlarmEvent::ACTIVATED, Alarm::MEDIUM));
        incidents.event(70.0, &input(AlarmEvent::RAISED, Alarm::HIGH));
        assert_eq!(incidents.worst(), None);
        assert_eq!(
            incidents.inputs_at_the_end().map(|input| input.start).next(),
            Some(60.0)
        );
        let mut incidents = Incidents::default();
        incidents.event(5.0, &input(AlarmEvent::ACTIVATED, Alarm::LOW));
        incidents.event(9.0, &input(AlarmEvent::RETURNED, Alarm::LOW));
        incidents.event(60.0, &input(AlarmEvent::ACTIVATED, Alarm::HIGH));
        let worst = incidents.worst().unwrap();
        assert_eq!((worst.priority, worst.times, worst.active), (Alarm::LOW, 1, 4.0));
        incidents.event(20.0, &event(AlarmEvent::ACTIVATED, Alarm::MEDIUM, "strong"));
        assert_eq!(incidents.worst().unwrap().name, "Shock");
        // An alarm about the computer does not concern the drilling.
        let behind = AlarmEvent {
            id: "real_time".to_owned(),
            category: Alarm::SYSTEM,
            ..event(AlarmEvent::ACTIVATED, Alarm::HIGH, "")
        };
        incidents.event(30.0, &behind);
        assert_eq!(incidents.worst().unwrap().name, "Shock");
    }

    #[test]
    fn an_alarm_from_before_the_recording_is_in_it() {
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
        incidents.alarms(list.clone(), |_| -30.0);
        incidents.alarms(list, |_| -30.0);
        incidents.event(4.0, &event(AlarmEvent::RETURNED, 2, ""));
        assert_eq!(incidents.list.len(), 1);
        assert!(incidents.list[0].from_before);
        // The time before the recording is not counted.
        assert_eq!(incidents.groups["shock"].active, 4.0);
    }
}
