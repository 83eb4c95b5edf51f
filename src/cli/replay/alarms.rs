//! The table of a replay's alarms, and the figures of the alarm system.

use std::fmt;

use super::log::LogPlace;
use crate::alarms::AlarmId;
use crate::messages::{Alarm, AlarmEvent, AlarmMoment};
use flexdrill_alarms::{Figures, Incidents, Time, span};
use flexdrill_outputs::words;

/// The alarms of a replay, in model time.
#[derive(Debug)]
pub(super) struct AlarmTally {
    incidents: Incidents<AlarmMoment>,
    /// The field log that drove the run.
    pub log: LogPlace,
    now: Time,
    /// The figures of the whole run.
    figures: Figures,
}

impl Default for AlarmTally {
    fn default() -> Self {
        Self {
            // The table has a row per alarm, so that the list of single incidents is not needed.
            incidents: Incidents::new(0),
            log: LogPlace::default(),
            now: 0,
            figures: Figures::default(),
        }
    }
}

impl AlarmTally {
    /// An empty one of a run that this log drives.
    pub(super) fn of_log(log: LogPlace) -> Self {
        Self { log, ..Self::default() }
    }

    /// Adds the events up to an instant (s).
    pub(super) fn add(&mut self, now: f64, events: Vec<AlarmEvent>) {
        self.now = span(now);
        for event in events {
            self.incidents
                .add(self.now, &event.occurrence(), || AlarmMoment::from(&event));
        }
    }

    /// Takes the worst moments of the alarms that stand. Events have the moment at which a priority was reached.
    pub(super) fn worsen(&mut self, alarms: &[Alarm]) {
        for alarm in alarms.iter().filter(|alarm| alarm.active) {
            let moment = AlarmMoment::from(alarm);
            self.incidents
                .worsen(&alarm.id, alarm.priority, &moment, AlarmMoment::is_worse_than);
        }
    }

    /// Ends the replay with the figures of its alarms.
    pub(super) fn finish(&mut self, figures: Figures) {
        self.incidents.finish(self.now);
        self.figures = figures;
    }
}

impl fmt::Display for AlarmTally {
    /// The table, worst first, then the figures.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let groups = self.incidents.groups();
        let mut rows: Vec<_> = AlarmId::ALL.into_iter().filter_map(|id| groups.get(id.id())).collect();
        // Worst first: priority, then whether it asks for an action, then how often it came.
        rows.sort_by_key(|group| std::cmp::Reverse((group.priority, group.acts, group.times)));
        if rows.is_empty() {
            return writeln!(f, "  alarms                 none");
        }
        let [low, medium, high] = self.figures.of_priority;
        writeln!(
            f,
            "\nalarms: {} ({high} high, {medium} medium, {low} low) in {:.1} min, {}",
            self.figures.annunciations,
            self.figures.watched / 60.0,
            // A rate of less than an hour would make one early alarm look like a flood.
            match self.figures.per_hour {
                Some(rate) => format!("{rate:.1} per hour"),
                None => "per hour: not before a full hour".to_owned(),
            }
        )?;
        writeln!(
            f,
            "  {:<8} {:<26} {:>5} {:>9} {:>8} {:>9}  evidence at the worst moment",
            "priority", "alarm", "times", "first s", "for s", "worst s"
        )?;
        for group in rows {
            let (worst, moment) = (&group.worst, &group.moment);
            // Times of the table are seconds of the replay, as in the log's own rows.
            let worst_at = seconds(moment.worst_at.saturating_sub(self.log.start));
            writeln!(
                f,
                "  {:<8} {:<26} {:>5} {:>9.2} {:>8.2} {worst_at:>9.2}  {}",
                words::alarm_priority(group.priority).to_uppercase(),
                worst.name,
                group.times,
                seconds(group.first),
                seconds(group.duration),
                moment.evidence
            )?;
            let [first, worst_row] = [seconds(group.first), worst_at].map(|at| self.log.row(at));
            if !first.is_empty() {
                writeln!(f, "  {:<71}Log: first at {first}, worst at {worst_row}", "")?;
            }
            writeln!(f, "  {:<71}{}", "", worst.what_to_do)?;
            if !worst.what_the_engineer_can_do.is_empty() {
                writeln!(f, "  {:<71}Engineer: {}", "", worst.what_the_engineer_can_do)?;
            }
        }
        // The two limits are those of EEMUA 191 and ISA 18.2, and comparable with the rig's alarm system.
        writeln!(
            f,
            "  at most {} within 10 min; in flood (more than 10 within 10 min) {}; one alarm at most {} times within 60 s",
            self.figures.most_in_ten_minutes,
            match self.figures.flood_share {
                Some(share) => format!("{:.2} % of the time", 100.0 * share),
                None => "not before a full 10 min".to_owned(),
            },
            self.figures.most_repeats
        )
    }
}

fn seconds(time: Time) -> f64 {
    time as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field_log::{LogRows, row_source};

    /// The event of the raise has 138 %, and the index reached 8.96 two rows later.
    #[test]
    fn the_table_has_the_worst_moment_and_its_row() {
        const SECOND: i64 = 1_000_000_000;
        let mut rows = LogRows::default();
        for row in 0..10 {
            rows.push(row * SECOND, &row_source(63 + row as u64, "", "demo.csv"));
        }
        let mut tally = AlarmTally::of_log(LogPlace { rows, start: 0 });
        let id = AlarmId::StickSlip.id().to_owned();
        let raised = AlarmEvent {
            id: id.clone(),
            change: AlarmEvent::ACTIVATED,
            priority: Alarm::HIGH,
            value: 1.38,
            evidence: "swings 138 %".to_owned(),
            ..AlarmEvent::default()
        };
        tally.add(3.0, vec![raised]);
        for (second, value) in [(4, 2.0), (5, 8.96), (6, 4.0)] {
            let mut alarm = Alarm {
                id: id.clone(),
                active: true,
                priority: Alarm::HIGH,
                value,
                threshold: 1.0,
                evidence: format!("swings {:.0} %", 100.0 * value),
                ..Alarm::default()
            };
            alarm.worst_at.sec = second;
            tally.worsen(&[alarm]);
        }
        tally.finish(Figures::default());
        let table = tally.to_string();
        assert!(table.contains("swings 896 %") && !table.contains("138 %"), "{table}");
        assert!(table.contains("Log: first at row 66, worst at row 68"), "{table}");
    }
}
