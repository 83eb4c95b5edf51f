//! The alarms of a replay, grouped, and the key figures of the alarm system.

use std::fmt;

use crate::alarms::AlarmId;
use crate::messages::{AlarmEvent, words};
use flexdrill_alarms::Figures;

/// All occurrences of one alarm.
#[derive(Debug, Clone, Default)]
struct Group {
    /// The first event of its highest priority.
    worst: Option<AlarmEvent>,
    annunciations: u64,
    first: f64,
    /// Begin of the present occurrence (s).
    active_since: Option<f64>,
    active: f64,
}

/// Alarms over a replay, in model time.
#[derive(Debug)]
pub(super) struct AlarmTally {
    groups: Vec<Group>,
    now: f64,
    /// Key figures of the whole run.
    pub(super) figures: Figures,
}

impl Default for AlarmTally {
    fn default() -> Self {
        Self {
            groups: vec![Group::default(); AlarmId::ALL.len()],
            now: 0.0,
            figures: Figures::default(),
        }
    }
}

impl AlarmTally {
    /// Adds the events up to an instant (s).
    pub(super) fn add(&mut self, now: f64, events: Vec<AlarmEvent>) {
        self.now = now;
        for event in events {
            let Some(index) = AlarmId::ALL.iter().position(|id| id.id() == event.id) else {
                continue;
            };
            self.groups[index].add(now, event);
        }
    }
}

impl Group {
    fn add(&mut self, now: f64, event: AlarmEvent) {
        match event.change {
            AlarmEvent::ACTIVATED => self.active_since = Some(now),
            AlarmEvent::RETURNED | AlarmEvent::SUPPRESSED => {
                self.active += self.active_since.take().map_or(0.0, |since| now - since);
            }
            _ => {}
        }
        if !event.annunciates && event.change != AlarmEvent::RAISED {
            return;
        }
        if self.annunciations == 0 {
            self.first = now;
        }
        self.annunciations += u64::from(event.annunciates);
        if self.worst.as_ref().is_none_or(|worst| event.priority > worst.priority) {
            self.worst = Some(event);
        }
    }

    /// Total time active up to an instant (s).
    fn active(&self, now: f64) -> f64 {
        self.active + self.active_since.map_or(0.0, |since| now - since)
    }
}

impl fmt::Display for AlarmTally {
    /// The table, worst first, then the figures.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rows: Vec<(&Group, &AlarmEvent)> = self
            .groups
            .iter()
            .filter_map(|group| Some((group, group.worst.as_ref()?)))
            .collect();
        rows.sort_by_key(|(group, worst)| std::cmp::Reverse((worst.priority, group.annunciations)));
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
                None => "rate per hour not known before a full hour".to_owned(),
            }
        )?;
        writeln!(
            f,
            "  {:<8} {:<26} {:>5} {:>9} {:>8}  evidence at the worst moment",
            "priority", "alarm", "times", "first s", "for s"
        )?;
        for (group, worst) in rows {
            writeln!(
                f,
                "  {:<8} {:<26} {:>5} {:>9.2} {:>8.2}  {}",
                words::alarm_priority(worst.priority).to_uppercase(),
                worst.name,
                group.annunciations,
                group.first,
                group.active(self.now),
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
                None => "not known before a full 10 min".to_owned(),
            },
            self.figures.most_repeats
        )
    }
}
