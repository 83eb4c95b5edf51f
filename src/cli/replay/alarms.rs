//! The table of a replay's alarms, and the figures of the alarm system.

use std::fmt;

use crate::alarms::AlarmId;
use crate::messages::{AlarmEvent, words};
use flexdrill_alarms::{Figures, Incidents, Time, span};

/// The alarms of a replay, in model time.
#[derive(Debug)]
pub(super) struct AlarmTally {
    incidents: Incidents<AlarmEvent>,
    now: Time,
    /// The figures of the whole run.
    figures: Figures,
}

impl Default for AlarmTally {
    fn default() -> Self {
        Self {
            // The table has a row per alarm, so that the list of single incidents is not needed.
            incidents: Incidents::new(0),
            now: 0,
            figures: Figures::default(),
        }
    }
}

impl AlarmTally {
    /// Adds the events up to an instant (s).
    pub(super) fn add(&mut self, now: f64, events: Vec<AlarmEvent>) {
        self.now = span(now);
        for event in events {
            self.incidents.add(self.now, &event.occurrence(), || event.clone());
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
            match self.figures.per_hour {
                Some(rate) => format!("{rate:.1} per hour"),
                None => "per hour: not before a full hour".to_owned(),
            }
        )?;
        writeln!(
            f,
            "  {:<8} {:<26} {:>5} {:>9} {:>8}  evidence at the worst moment",
            "priority", "alarm", "times", "first s", "for s"
        )?;
        for group in rows {
            let worst = &group.worst;
            writeln!(
                f,
                "  {:<8} {:<26} {:>5} {:>9.2} {:>8.2}  {}",
                words::alarm_priority(group.priority).to_uppercase(),
                worst.name,
                group.times,
                seconds(group.first),
                seconds(group.duration),
                worst.evidence
            )?;
            writeln!(f, "  {:<61}{}", "", worst.what_to_do)?;
            if !worst.what_the_engineer_can_do.is_empty() {
                writeln!(f, "  {:<61}Engineer: {}", "", worst.what_the_engineer_can_do)?;
            }
        }
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
