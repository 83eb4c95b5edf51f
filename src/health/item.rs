//! One item of `/diagnostics`: its alarms decide its level and its text.

use crate::alarms::AlarmId;
use crate::messages::diagnostic_msgs::{DiagnosticStatus, KeyValue};
use crate::messages::{Alarm, AlarmList};
use flexdrill_outputs::words;

/// An item before it is held against the alarms.
pub(super) struct Item {
    /// Name of the item, such as `pacing`.
    pub(super) name: &'static str,
    /// The alarms that the item shows.
    pub(super) alarms: &'static [AlarmId],
    /// The text while none of these alarms calls for attention.
    pub(super) calm: String,
    /// Keys, with their unit unless the value has it, and values.
    pub(super) values: Vec<(&'static str, String)>,
}

impl Item {
    /// The item with the level and the texts of its alarms, which the list has with the worst first.
    pub(super) fn with(self, list: &AlarmList) -> DiagnosticStatus {
        let own: Vec<&Alarm> = list
            .alarms
            .iter()
            .filter(|alarm| self.alarms.iter().any(|id| id.id() == alarm.id))
            .collect();
        let texts: Vec<String> = own
            .iter()
            .filter(|alarm| is_shown(alarm))
            .map(|alarm| text(alarm))
            .collect();
        let mut message = if texts.is_empty() { self.calm } else { texts.join(" ") };
        for state in [Alarm::SHELVED, Alarm::SUPPRESSED_BY_DESIGN, Alarm::OUT_OF_SERVICE] {
            let silent: Vec<&str> = own
                .iter()
                .filter(|alarm| alarm.state == state)
                .map(|alarm| alarm.name.as_str())
                .collect();
            if !silent.is_empty() {
                message += &format!(" ({}: {})", words::alarm_state(state), silent.join(", "));
            }
        }
        let values = self
            .values
            .into_iter()
            .map(|(key, value)| KeyValue { key: key.into(), value });
        let states = own.iter().map(|alarm| KeyValue {
            key: format!("alarm {}", alarm.id),
            value: match words::alarm_priority(alarm.priority) {
                "-" => words::alarm_state(alarm.state).to_owned(),
                priority => format!("{priority}, {}", words::alarm_state(alarm.state)),
            },
        });
        DiagnosticStatus {
            level: level(&own),
            name: self.name.to_owned(),
            message,
            values: values.chain(states).collect(),
            ..DiagnosticStatus::default()
        }
    }
}

/// Whether the alarm calls for attention: it stands, or it has returned and is not yet acknowledged.
pub(super) fn is_shown(alarm: &Alarm) -> bool {
    is_standing(alarm) || alarm.state == Alarm::RETURNED_UNACKNOWLEDGED
}

/// Whether the condition is met and neither shelved nor suppressed.
fn is_standing(alarm: &Alarm) -> bool {
    [Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::ACTIVE_ACKNOWLEDGED].contains(&alarm.state)
}

/// The level of alarms: ERROR while one of high priority stands, WARN while any other does.
pub(super) fn level(alarms: &[&Alarm]) -> u8 {
    let standing = alarms.iter().filter(|alarm| is_standing(alarm));
    match standing.map(|alarm| alarm.priority).max() {
        Some(Alarm::HIGH) => DiagnosticStatus::ERROR,
        Some(_) => DiagnosticStatus::WARN,
        None => DiagnosticStatus::OK,
    }
}

/// Priority, name, state and evidence of an alarm.
pub(super) fn text(alarm: &Alarm) -> String {
    format!(
        "{} {} ({}): {}",
        words::alarm_priority(alarm.priority).to_uppercase(),
        alarm.name,
        words::alarm_state(alarm.state),
        alarm.evidence
    )
}

/// A figure with so many decimals.
pub(super) fn figure(value: f64, decimals: usize) -> String {
    figure_in(value, decimals, "")
}

pub(super) fn figure_in(value: f64, decimals: usize, unit: &str) -> String {
    let space = if unit.is_empty() { "" } else { " " };
    if value.is_finite() {
        format!("{value:.decimals$}{space}{unit}")
    } else {
        "not measured".to_owned()
    }
}
