//! The alarms as an item of `/diagnostics`.

use super::judgement::Judgement;
use crate::messages::diagnostic_msgs::DiagnosticStatus;
use crate::messages::{Alarm, AlarmList, words};

pub(super) fn alarms(list: &AlarmList) -> Judgement {
    let shown = |alarm: &&Alarm| {
        [
            Alarm::ACTIVE_UNACKNOWLEDGED,
            Alarm::ACTIVE_ACKNOWLEDGED,
            Alarm::RETURNED_UNACKNOWLEDGED,
        ]
        .contains(&alarm.state)
    };
    let active = list.alarms.iter().filter(|alarm| shown(alarm) && alarm.active);
    let level = match active.map(|alarm| alarm.priority).max() {
        Some(Alarm::HIGH) => DiagnosticStatus::ERROR,
        Some(_) => DiagnosticStatus::WARN,
        None => DiagnosticStatus::OK,
    };
    let count = |state: u8| list.alarms.iter().filter(|alarm| alarm.state == state).count();
    // The list has the worst first.
    let message = match list.alarms.iter().find(shown) {
        Some(worst) => format!(
            "{} {} ({}): {}",
            words::alarm_priority(worst.priority).to_uppercase(),
            worst.name,
            words::alarm_state(worst.state),
            worst.evidence
        ),
        None => "no alarm".to_owned(),
    };
    let states = [
        ("active, unacknowledged", Alarm::ACTIVE_UNACKNOWLEDGED),
        ("active, acknowledged", Alarm::ACTIVE_ACKNOWLEDGED),
        ("returned, unacknowledged", Alarm::RETURNED_UNACKNOWLEDGED),
        ("shelved", Alarm::SHELVED),
        ("suppressed by design", Alarm::SUPPRESSED_BY_DESIGN),
        ("out of service", Alarm::OUT_OF_SERVICE),
    ];
    let mut values: Vec<_> = states
        .into_iter()
        .map(|(name, state)| (name, count(state).to_string()))
        .collect();
    values.push((
        "annunciations in 10 min",
        list.annunciations_last_ten_minutes.to_string(),
    ));
    values.push(("flood", list.flood.to_string()));
    Judgement {
        name: "alarms",
        level,
        message,
        values,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_that_stands_gives_the_level_and_a_shelved_one_does_not() {
        let alarm = |state, priority, active| Alarm {
            name: "lateral shock".into(),
            evidence: "Collisions.".into(),
            state,
            priority,
            active,
            ..Alarm::default()
        };
        let judged = |alarm| {
            alarms(&AlarmList {
                alarms: vec![alarm],
                ..AlarmList::default()
            })
        };
        let high = judged(alarm(Alarm::ACTIVE_ACKNOWLEDGED, Alarm::HIGH, true));
        assert_eq!(
            (high.level, high.message.as_str()),
            (
                DiagnosticStatus::ERROR,
                "HIGH lateral shock (active, acknowledged): Collisions."
            )
        );
        let gone = judged(alarm(Alarm::RETURNED_UNACKNOWLEDGED, Alarm::HIGH, false));
        assert_eq!(gone.level, DiagnosticStatus::OK);
        let shelved = judged(alarm(Alarm::SHELVED, Alarm::HIGH, true));
        assert_eq!(
            (shelved.level, shelved.message.as_str()),
            (DiagnosticStatus::OK, "no alarm")
        );
        assert!(shelved.values.contains(&("shelved", "1".to_owned())));
    }
}
