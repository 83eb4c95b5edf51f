//! Alarms in lines, the same for the screen and the plain output.

use std::fmt::Write as _;

use crate::messages::{Alarm, AlarmList};
use flexdrill_core::units::rad_to_deg;
use flexdrill_outputs::words;

/// The alarms that require a response, the worst first as in the list; those of the computer follow the driller's.
pub(super) fn standing(list: &AlarmList) -> impl Iterator<Item = &Alarm> {
    let of = |category: u8| {
        list.alarms.iter().filter(move |alarm| {
            alarm.category == category
                && [
                    Alarm::ACTIVE_UNACKNOWLEDGED,
                    Alarm::ACTIVE_ACKNOWLEDGED,
                    Alarm::RETURNED_UNACKNOWLEDGED,
                ]
                .contains(&alarm.state)
        })
    };
    of(Alarm::DRILLING).chain(of(Alarm::SYSTEM))
}

/// The number of alarms in each state.
pub(super) fn summary(list: &AlarmList) -> String {
    let count = |state: u8| list.alarms.iter().filter(|alarm| alarm.state == state).count();
    let counts = [
        (list.unacknowledged as usize, "to acknowledge"),
        (count(Alarm::ACTIVE_ACKNOWLEDGED), "acknowledged"),
        (count(Alarm::SHELVED), "shelved"),
        (count(Alarm::SUPPRESSED_BY_DESIGN), "suppressed by design"),
        (count(Alarm::OUT_OF_SERVICE), "out of service"),
    ];
    let texts: Vec<String> = counts
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    let mut text = if texts.is_empty() {
        "none".to_owned()
    } else {
        texts.join(", ")
    };
    if list.flood {
        let _ = write!(text, "; FLOOD: {} in 10 min", list.annunciations_last_ten_minutes);
    }
    text
}

/// Priority, name, state and location.
pub(super) fn headline(alarm: &Alarm) -> String {
    // A place without depth would read as "at NaN m".
    let location = match alarm.body {
        Alarm::NOWHERE => String::new(),
        _ if !alarm.measured_depth.is_finite() || !alarm.inclination.is_finite() => String::new(),
        body => format!(
            ", {} at {:.2} m ({:.0} deg)",
            if body == Alarm::GUIDE { "guide" } else { "pipe" },
            alarm.measured_depth,
            rad_to_deg(alarm.inclination)
        ),
    };
    // Three in a minute is the glossary's chattering.
    let chatters = if alarm.annunciations_last_minute >= 3 {
        format!(", {} times in the last minute", alarm.annunciations_last_minute)
    } else {
        String::new()
    };
    let addressee = if alarm.category == Alarm::SYSTEM {
        "computer: "
    } else {
        ""
    };
    let episodes = match alarm.episodes {
        0 | 1 => String::new(),
        times => format!(", came {times} times"),
    };
    // `active` with `ended`: the condition is over, but the alarm holds.
    let ended = if alarm.active && alarm.ended {
        ", condition ended"
    } else {
        ""
    };
    let earlier = if alarm.from_earlier_run {
        ", since an earlier run"
    } else {
        ""
    };
    format!(
        "{addressee}{} {}, {}{ended}{location}{episodes}{chatters}{earlier}",
        words::alarm_priority(alarm.priority).to_uppercase(),
        alarm.name,
        words::alarm_state(alarm.state)
    )
}

/// What happens, why it matters, what the driller can do and what the engineer can do.
pub(super) fn sentences(alarm: &Alarm) -> String {
    let mut text = [&alarm.evidence, &alarm.consequence, &alarm.what_to_do]
        .into_iter()
        .filter(|sentence| !sentence.is_empty())
        .cloned()
        .collect::<Vec<_>>()
        .join(" ");
    if !alarm.what_the_engineer_can_do.is_empty() {
        let _ = write!(text, " Engineer: {}", alarm.what_the_engineer_can_do);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_driller_reads_what_why_and_what_to_do_before_the_engineer() {
        let alarm = Alarm {
            evidence: "Backward whirl.".into(),
            consequence: "Joint fatigue.".into(),
            what_to_do: "Lower the speed.".into(),
            what_the_engineer_can_do: "Add lubricant.".into(),
            ..Alarm::default()
        };
        assert_eq!(
            sentences(&alarm),
            "Backward whirl. Joint fatigue. Lower the speed. Engineer: Add lubricant."
        );
        assert_eq!(sentences(&Alarm::default()), "");
    }

    #[test]
    fn only_a_condition_that_has_ended_is_called_ended() {
        let alarm = Alarm {
            name: "backward whirl".into(),
            state: Alarm::ACTIVE_UNACKNOWLEDGED,
            priority: Alarm::HIGH,
            active: true,
            episodes: 4,
            ..Alarm::default()
        };
        assert_eq!(
            headline(&alarm),
            "HIGH backward whirl, active, unacknowledged, came 4 times"
        );
        let ended = Alarm { ended: true, ..alarm };
        assert_eq!(
            headline(&ended),
            "HIGH backward whirl, active, unacknowledged, condition ended, came 4 times"
        );
    }

    #[test]
    fn alarms_of_the_computer_follow_the_drillers_and_say_so() {
        let alarm = |name: &str, category, priority| Alarm {
            name: name.to_owned(),
            state: Alarm::ACTIVE_UNACKNOWLEDGED,
            category,
            priority,
            ..Alarm::default()
        };
        let list = AlarmList {
            alarms: vec![
                alarm("not in real time", Alarm::SYSTEM, Alarm::MEDIUM),
                alarm("lateral shock", Alarm::DRILLING, Alarm::LOW),
            ],
            ..AlarmList::default()
        };
        let lines: Vec<String> = standing(&list).map(headline).collect();
        assert_eq!(
            lines,
            [
                "LOW lateral shock, active, unacknowledged",
                "computer: MEDIUM not in real time, active, unacknowledged"
            ]
        );
    }
}
