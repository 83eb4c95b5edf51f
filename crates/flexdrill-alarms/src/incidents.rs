//! Incidents: the times in which alarms stood, collected from a journal of events.

use std::collections::BTreeMap;

use crate::Time;

/// What an event of the journal means for the incident of its alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// The alarm stands from now on, or stands with another priority.
    Stands,
    /// The alarm does not stand any more.
    Ends,
    /// An operator acknowledged the alarm.
    Acknowledged,
    /// Neither of these.
    Unchanged,
}

/// An event of the journal.
#[derive(Debug, Clone, Copy)]
pub struct Occurrence<'a> {
    /// The id of the alarm.
    pub alarm: &'a str,
    /// What happened to the alarm.
    pub course: Course,
    /// The priority as a code that rises with it.
    pub priority: u8,
    /// The operator who caused the event; empty without one.
    pub operator: &'a str,
    /// Whether the event asks for an action itself, and does not refer to another alarm's.
    pub acts: bool,
}

/// The time in which an alarm stood.
#[derive(Debug, Clone, PartialEq)]
pub struct Incident<D> {
    /// The id of the alarm.
    pub alarm: String,
    /// The highest priority.
    pub priority: u8,
    /// The time at which the alarm began to stand.
    pub begin: Time,
    /// The time at which it ended; none while the alarm stands.
    pub end: Option<Time>,
    /// Whether the alarm stood already when the journal began.
    pub from_before: bool,
    /// The operator who acknowledged it; empty until then.
    pub acknowledged_by: String,
    /// The details of the first event of the highest priority, or of a worse moment since: see [`Incidents::worsen`].
    pub worst: D,
}

/// All incidents of one alarm.
#[derive(Debug, Clone, PartialEq)]
pub struct Group<D> {
    /// The number of incidents.
    pub times: u64,
    /// The begin of the first incident.
    pub first: Time,
    /// The sum of the durations within the journal (ns).
    pub duration: Time,
    /// The highest priority.
    pub priority: u8,
    /// Whether `worst` asks for an action itself.
    pub acts: bool,
    /// The details of the first event of the highest priority, of those with an action of their own where there are any.
    pub worst: D,
    /// The priority of `moment`.
    pub moment_priority: u8,
    /// The details of the worst moment of all incidents: see [`Incidents::worsen`].
    pub moment: D,
}

/// The incidents of a journal. `D` are the details that the caller keeps of an event.
#[derive(Debug, Clone)]
pub struct Incidents<D> {
    list: Vec<Incident<D>>,
    groups: BTreeMap<String, Group<D>>,
    /// Per standing alarm: the time from which its duration counts, and the index of its incident if the list has it.
    standing: BTreeMap<String, (Time, Option<usize>)>,
    most: usize,
    more: u64,
}

impl<D: Clone> Group<D> {
    fn take(&mut self, priority: u8, acts: bool, details: &D) {
        if (priority, acts) > (self.priority, self.acts) {
            (self.priority, self.acts) = (priority, acts);
            self.worst.clone_from(details);
        }
        if priority > self.moment_priority {
            self.moment_priority = priority;
            self.moment.clone_from(details);
        }
    }
}

impl<D: Clone> Incidents<D> {
    /// No incidents yet. The list keeps `most`; later ones are in the groups only.
    pub fn new(most: usize) -> Self {
        Self {
            list: Vec::new(),
            groups: BTreeMap::new(),
            standing: BTreeMap::new(),
            most,
            more: 0,
        }
    }

    /// The incidents in the order of their begin.
    pub fn list(&self) -> &[Incident<D>] {
        &self.list
    }

    /// All incidents of each alarm, by its id.
    pub fn groups(&self) -> &BTreeMap<String, Group<D>> {
        &self.groups
    }

    /// The number of incidents that the list does not have.
    pub fn more(&self) -> u64 {
        self.more
    }

    /// Adds an alarm that stood when the journal began, at `origin`; its duration counts from there.
    pub fn add_standing(&mut self, begin: Time, origin: Time, event: &Occurrence<'_>, details: D) {
        self.begin(
            origin.max(begin),
            event.acts,
            Incident {
                alarm: event.alarm.to_owned(),
                priority: event.priority,
                begin,
                end: None,
                from_before: true,
                acknowledged_by: String::new(),
                worst: details,
            },
        );
    }

    /// Adds an event of the journal at its time.
    pub fn add(&mut self, time: Time, event: &Occurrence<'_>, details: impl FnOnce() -> D) {
        match event.course {
            Course::Stands if !self.standing.contains_key(event.alarm) => self.begin(
                time,
                event.acts,
                Incident {
                    alarm: event.alarm.to_owned(),
                    priority: event.priority,
                    begin: time,
                    end: None,
                    from_before: false,
                    acknowledged_by: String::new(),
                    worst: details(),
                },
            ),
            Course::Stands => self.update(event, details()),
            Course::Ends => self.end(time, event.alarm),
            Course::Acknowledged => {
                let newest = self
                    .list
                    .iter_mut()
                    .rev()
                    .find(|incident| incident.alarm == event.alarm);
                if let Some(incident) = newest {
                    event.operator.clone_into(&mut incident.acknowledged_by);
                }
            }
            Course::Unchanged => {}
        }
    }

    /// Replaces the details of a standing alarm's worst moment by `details`, of a moment with this priority, where that was
    /// worse: of a higher priority, or of the same one where `worse(details, kept)` holds. Events carry the moment at which
    /// a priority was reached; the worst one often follows.
    pub fn worsen(&mut self, alarm: &str, priority: u8, details: &D, worse: impl Fn(&D, &D) -> bool) {
        let Some((_, index)) = self.standing.get(alarm) else {
            return;
        };
        if let Some(group) = self.groups.get_mut(alarm)
            && (priority > group.moment_priority || priority == group.moment_priority && worse(details, &group.moment))
        {
            group.moment_priority = priority;
            group.moment.clone_from(details);
        }
        if let Some(incident) = index.and_then(|index| self.list.get_mut(index))
            && (priority > incident.priority || priority == incident.priority && worse(details, &incident.worst))
        {
            incident.priority = priority;
            incident.worst.clone_from(details);
        }
    }

    /// Adds the time until the end of the journal to the groups; in the list a standing alarm has no end.
    pub fn finish(&mut self, time: Time) {
        for (alarm, (since, _)) in std::mem::take(&mut self.standing) {
            self.count(&alarm, since, time);
        }
    }

    fn begin(&mut self, counted_from: Time, acts: bool, incident: Incident<D>) {
        let group = self.groups.entry(incident.alarm.clone()).or_insert_with(|| Group {
            times: 0,
            first: incident.begin,
            duration: 0,
            priority: incident.priority,
            acts,
            worst: incident.worst.clone(),
            moment_priority: incident.priority,
            moment: incident.worst.clone(),
        });
        group.times += 1;
        group.take(incident.priority, acts, &incident.worst);
        let index = (self.list.len() < self.most).then_some(self.list.len());
        self.standing.insert(incident.alarm.clone(), (counted_from, index));
        if index.is_some() {
            self.list.push(incident);
        } else {
            self.more += 1;
        }
    }

    fn update(&mut self, event: &Occurrence<'_>, details: D) {
        if let Some(group) = self.groups.get_mut(event.alarm) {
            group.take(event.priority, event.acts, &details);
        }
        let index = self.standing.get(event.alarm).and_then(|(_, index)| *index);
        if let Some(incident) = index.and_then(|index| self.list.get_mut(index))
            && event.priority > incident.priority
        {
            incident.priority = event.priority;
            incident.worst = details;
        }
    }

    fn end(&mut self, time: Time, alarm: &str) {
        let Some((since, index)) = self.standing.remove(alarm) else {
            return;
        };
        self.count(alarm, since, time);
        if let Some(incident) = index.and_then(|index| self.list.get_mut(index)) {
            incident.end = Some(time);
        }
    }

    fn count(&mut self, alarm: &str, since: Time, time: Time) {
        if let Some(group) = self.groups.get_mut(alarm) {
            group.duration += time.saturating_sub(since).max(0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shock(course: Course, priority: u8) -> Occurrence<'static> {
        Occurrence {
            alarm: "shock",
            course,
            priority,
            operator: "ann",
            acts: true,
        }
    }

    /// What the group says to do is an action, where any event of its priority has one.
    #[test]
    fn an_action_of_its_own_goes_before_one_that_refers_to_another_alarm() {
        let mut incidents = Incidents::new(10);
        let events = [
            (1, 2, true, "soon"),
            (2, 3, false, "follow the other one"),
            (3, 3, true, "act"),
            (4, 3, true, "act again"),
            (5, 3, false, "follow again"),
        ];
        for (time, priority, acts, text) in events {
            let event = Occurrence {
                acts,
                ..shock(Course::Stands, priority)
            };
            incidents.add(time, &event, || text);
        }
        let group = &incidents.groups()["shock"];
        assert_eq!((group.priority, group.acts, group.worst), (3, true, "act"));
    }

    #[test]
    fn an_incident_lasts_from_begin_to_end_with_its_worst_moment() {
        let mut incidents = Incidents::new(10);
        let events = [
            (1, Course::Stands, 1, "weak"),
            (2, Course::Stands, 3, "strong"),
            (3, Course::Stands, 2, "less"),
            (4, Course::Acknowledged, 3, ""),
            (5, Course::Ends, 3, ""),
            (6, Course::Unchanged, 3, ""),
            (8, Course::Stands, 2, "again"),
        ];
        for (time, course, priority, text) in events {
            incidents.add(time, &shock(course, priority), || text);
        }
        incidents.finish(10);
        let [first, second] = incidents.list() else {
            panic!("{:?}", incidents.list())
        };
        assert_eq!(
            (first.begin, first.end, first.priority, first.worst),
            (1, Some(5), 3, "strong")
        );
        assert_eq!(first.acknowledged_by, "ann");
        assert_eq!((second.begin, second.end, second.worst), (8, None, "again"));
        let group = &incidents.groups()["shock"];
        assert_eq!(
            (group.times, group.first, group.duration, group.priority, group.worst),
            (2, 1, 6, 3, "strong")
        );
    }

    /// An event has the moment at which its priority was reached, and the worst one follows in the lists.
    #[test]
    fn the_worst_moment_is_the_worst_while_the_alarm_stands() {
        let worse = |new: &i32, kept: &i32| new > kept;
        let mut incidents = Incidents::new(10);
        // Of an alarm that does not stand there is no moment.
        incidents.worsen("shock", 3, &99, worse);
        incidents.add(1, &shock(Course::Stands, 2), || 138);
        for (priority, value) in [(2, 140), (2, 139), (1, 500)] {
            incidents.worsen("shock", priority, &value, worse);
        }
        assert_eq!(incidents.list()[0].worst, 140);
        incidents.add(2, &shock(Course::Stands, 3), || 200);
        incidents.worsen("shock", 3, &896, worse);
        incidents.add(3, &shock(Course::Ends, 3), || 0);
        incidents.worsen("shock", 3, &999, worse);
        incidents.add(4, &shock(Course::Stands, 3), || 150);
        incidents.worsen("shock", 3, &160, worse);
        let worst: Vec<i32> = incidents.list().iter().map(|incident| incident.worst).collect();
        assert_eq!(worst, [896, 160]);
        assert_eq!(incidents.groups()["shock"].moment, 896);
    }

    #[test]
    fn an_alarm_that_stood_before_the_journal_counts_from_its_begin() {
        let mut incidents = Incidents::new(10);
        incidents.add_standing(-30, 0, &shock(Course::Stands, 2), "old");
        // Of an alarm that stands, a second begin is none.
        incidents.add(3, &shock(Course::Stands, 2), || "same");
        incidents.add(4, &shock(Course::Ends, 2), || "");
        let [only] = incidents.list() else {
            panic!("{:?}", incidents.list())
        };
        assert!(only.from_before && only.end == Some(4));
        assert_eq!(incidents.groups()["shock"].duration, 4);
    }

    #[test]
    fn incidents_beyond_the_list_are_counted() {
        let mut incidents = Incidents::new(1);
        for time in 0..3 {
            incidents.add(10 * time, &shock(Course::Stands, 1), || ());
            incidents.add(10 * time + 2, &shock(Course::Ends, 1), || ());
        }
        assert_eq!((incidents.list().len(), incidents.more()), (1, 2));
        let group = &incidents.groups()["shock"];
        assert_eq!((group.times, group.duration), (3, 6));
    }
}
