//! All alarms as one item of `/diagnostics`.

use super::item::{is_shown, level, text};
use crate::messages::diagnostic_msgs::{DiagnosticStatus, KeyValue};
use crate::messages::{Alarm, AlarmList};

/// The item `alarms`: the level of all alarms, the text of the worst one, and how many are in each state.
pub(super) fn alarms(list: &AlarmList) -> DiagnosticStatus {
    let count = |state: u8| list.alarms.iter().filter(|alarm| alarm.state == state).count();
    let all: Vec<&Alarm> = list.alarms.iter().collect();
    // The list has the worst first.
    let message = all
        .iter()
        .find(|alarm| is_shown(alarm))
        .map_or_else(|| "no alarm".to_owned(), |worst| text(worst));
    let states = [
        ("active, unacknowledged", Alarm::ACTIVE_UNACKNOWLEDGED),
        ("active, acknowledged", Alarm::ACTIVE_ACKNOWLEDGED),
        ("returned, unacknowledged", Alarm::RETURNED_UNACKNOWLEDGED),
        ("shelved", Alarm::SHELVED),
        ("suppressed by design", Alarm::SUPPRESSED_BY_DESIGN),
        ("out of service", Alarm::OUT_OF_SERVICE),
    ];
    let counts = states.into_iter().map(|(name, state)| (name, count(state).to_string()));
    let figures = [
        (
            "annunciations in 10 min",
            list.annunciations_last_ten_minutes.to_string(),
        ),
        ("flood", list.flood.to_string()),
    ];
    DiagnosticStatus {
        level: level(&all),
        name: "alarms".to_owned(),
        message,
        values: counts
            .chain(figures)
            .map(|(key, value)| KeyValue { key: key.into(), value })
            .collect(),
        ..DiagnosticStatus::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_standing_alarm_gives_the_level_and_a_shelved_one_does_not() {
        let alarm = |state, priority, active| Alarm {
            name: "lateral shock".into(),
            evidence: "Impacts.".into(),
            state,
            priority,
            active,
            ..Alarm::default()
        };
        let item = |alarm| {
            alarms(&AlarmList {
                alarms: vec![alarm],
                ..AlarmList::default()
            })
        };
        let high = item(alarm(Alarm::ACTIVE_ACKNOWLEDGED, Alarm::HIGH, true));
        assert_eq!(
            (high.level, high.message.as_str()),
            (
                DiagnosticStatus::ERROR,
                "HIGH lateral shock (active, acknowledged): Impacts."
            )
        );
        let returned = item(alarm(Alarm::RETURNED_UNACKNOWLEDGED, Alarm::HIGH, false));
        assert_eq!(returned.level, DiagnosticStatus::OK);
        let shelved = item(alarm(Alarm::SHELVED, Alarm::HIGH, true));
        assert_eq!(
            (shelved.level, shelved.message.as_str()),
            (DiagnosticStatus::OK, "no alarm")
        );
        let count = shelved.values.iter().find(|pair| pair.key == "shelved").unwrap();
        assert_eq!(count.value, "1");
    }
}
