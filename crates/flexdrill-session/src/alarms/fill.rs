//! Messages from alarms, their findings and events.

use std::cmp::Reverse;

use super::catalogue::AlarmId;
use super::finding::Finding;
use super::plausible::Plausible;
use super::worst_moment::WorstMoment;
use crate::messages::builtin_interfaces::Time;
use crate::messages::std_msgs::Header;
use crate::messages::{Alarm, AlarmEvent, AlarmList};
use flexdrill_alarms::{AlarmSystem, Change, Event, State, Unshelving};
use flexdrill_core::tool::Body;
use flexdrill_outputs::words::priority_code;

/// All alarms, the worst first. `restored` says per alarm whether its state began in an earlier run, `tools` what plausible
/// tools say of it.
pub(super) fn list(
    system: &AlarmSystem,
    moments: &[WorstMoment],
    restored: &[bool],
    tools: &Plausible,
    header: Header,
) -> AlarmList {
    let mut order: Vec<usize> = (0..AlarmId::ALL.len().min(moments.len())).collect();
    order.sort_by_key(|index| {
        let (standing, moment) = (system.alarm(*index).standing, &moments[*index]);
        let category = AlarmId::ALL[*index].category();
        let follows = moment.finding.follows.is_some();
        let (state, priority) = (standing.state(), Reverse(standing.priority()));
        let rank = rank(state, moment.ended().is_some());
        (rank, category, follows, priority, state as u8, *index)
    });
    let figures = system.statistics().figures();
    let alarms: Vec<Alarm> = order
        .into_iter()
        .filter_map(|index| {
            let (id, moment) = (AlarmId::ALL[index], moments.get(index)?);
            let mut alarm = alarm(system, id, moment);
            // An alarm whose condition has ended says nothing that tools could differ in.
            if !alarm.evidence.is_empty() {
                alarm.evidence += &tools.sentence(id, moment, header.stamp.to_nanoseconds());
            }
            alarm.from_earlier_run = restored.get(index) == Some(&true);
            Some(alarm)
        })
        .collect();
    AlarmList {
        header,
        sequence: system.sequence(),
        unacknowledged: alarms.iter().filter(|alarm| !alarm.acknowledged).count() as u32,
        alarms,
        annunciations_last_ten_minutes: figures.last_ten_minutes as u32,
        flood: figures.flood,
        annunciations_per_hour: figures.per_hour.unwrap_or(f64::NAN),
        flood_share: figures.flood_share.unwrap_or(f64::NAN),
    }
}

/// The order of the states in the list: those whose condition stands come first, since they require a response.
fn rank(state: State, ended: bool) -> u8 {
    match state {
        State::ActiveUnacknowledged | State::ActiveAcknowledged => u8::from(ended),
        State::ReturnedUnacknowledged => 2,
        State::Shelved => 3,
        State::SuppressedByDesign => 4,
        State::Normal => 5,
        State::OutOfService => 6,
    }
}

fn alarm(system: &AlarmSystem, id: AlarmId, moment: &WorstMoment) -> Alarm {
    let (index, finding) = (id as usize, &moment.finding);
    let alarm = system.alarm(index);
    let standing = alarm.standing;
    let (body, measured_depth, inclination) = place(finding);
    Alarm {
        id: id.id().to_owned(),
        name: id.name().to_owned(),
        state: standing.state() as u8,
        priority: priority_code(standing.priority()),
        active: standing.active().is_some(),
        acknowledged: standing.unacknowledged().is_none(),
        since: Time::from_nanoseconds(alarm.since),
        shelved_until: Time::from_nanoseconds(standing.shelf().map_or(0, |shelf| shelf.until)),
        shelved_one_shot: standing.shelf().is_some_and(|shelf| shelf.one_shot),
        body,
        measured_depth,
        inclination,
        value: finding.value,
        threshold: finding.threshold,
        unit: finding.unit.to_owned(),
        confidence: finding.confidence,
        evidence: moment.evidence(&standing),
        cause: finding.cause.clone(),
        consequence: finding.consequence.clone(),
        what_to_do: finding.what_to_do.clone(),
        annunciations: system.statistics().annunciations(index),
        annunciations_last_minute: system.statistics().last_minute(index) as u32,
        category: id.category(),
        from_earlier_run: false,
        what_the_engineer_can_do: finding.what_the_engineer_can_do.clone(),
        worst_at: Time::from_nanoseconds(moment.at),
        ended: moment.ended().is_some(),
        ended_at: Time::from_nanoseconds(moment.ended().unwrap_or_default()),
        less_severe_since: Time::from_nanoseconds(moment.less_severe().unwrap_or_default()),
        episodes: moment.episodes,
        follows: finding.follows.map_or("", AlarmId::id).to_owned(),
    }
}

/// One event at its stamp (ns since 1970), with the worst moment of its alarm.
pub(super) fn event(event: &Event, stamp: i64, moment: &WorstMoment, frame_id: &str) -> AlarmEvent {
    let finding = &moment.finding;
    // The place is that of the worst moment: the place of the instant moves along the tool while the alarm stands.
    let (body, measured_depth, inclination) = place(finding);
    let alarm = AlarmId::ALL.get(event.alarm);
    let (id, name) = alarm.map_or(("", ""), |alarm| (alarm.id(), alarm.name()));
    // An end of shelving without an operator is the program's own, and its
    // reason is a fixed text; an operator's reason is quoted.
    let reason = match event.change {
        Change::Unshelved(why) if event.operator.is_empty() => unshelved(why),
        _ => &event.reason,
    };
    // Zero is the message's "not shelved"; a time that has passed would be read as one that is to come.
    let shelved_until = match event.change {
        Change::Shelved(shelf) => shelf.until,
        _ => 0,
    };
    AlarmEvent {
        header: Header {
            stamp: Time::from_nanoseconds(stamp),
            frame_id: frame_id.to_owned(),
        },
        sequence: event.sequence,
        id: id.to_owned(),
        name: name.to_owned(),
        change: change(&event.change),
        from_state: event.from as u8,
        to_state: event.to as u8,
        priority: priority_code(event.priority),
        annunciates: event.annunciates(),
        operator_name: event.operator.clone(),
        reason: reason.to_owned(),
        shelved_until: Time::from_nanoseconds(shelved_until),
        evidence: event.evidence.clone(),
        // A returned alarm asks for nothing. Its old advice in the journal could be followed by mistake.
        what_to_do: match event.change {
            Change::Returned => String::new(),
            _ => finding.what_to_do.clone(),
        },
        body,
        measured_depth,
        inclination,
        value: finding.value,
        category: alarm.map_or(Alarm::DRILLING, |alarm| alarm.category()),
        what_the_engineer_can_do: finding.what_the_engineer_can_do.clone(),
        worst_at: Time::from_nanoseconds(moment.at),
        // Zero is "not ended": the moment lasts.
        ended_at: Time::from_nanoseconds(moment.ended().unwrap_or_default()),
        less_severe_since: Time::from_nanoseconds(moment.less_severe().unwrap_or_default()),
        episodes: moment.episodes,
        follows: match event.change {
            Change::Returned => String::new(),
            _ => finding.follows.map_or("", AlarmId::id).to_owned(),
        },
    }
}

fn place(finding: &Finding) -> (u8, f64, f64) {
    match &finding.place {
        None => (Alarm::NOWHERE, f64::NAN, f64::NAN),
        Some(place) => {
            let body = match place.body {
                Body::Pipe => Alarm::PIPE,
                Body::Guide => Alarm::GUIDE,
            };
            (body, place.measured_depth, place.inclination)
        }
    }
}

fn change(change: &Change) -> u8 {
    match change {
        Change::Activated(_) => AlarmEvent::ACTIVATED,
        Change::Raised(_) => AlarmEvent::RAISED,
        Change::Lowered(_) => AlarmEvent::LOWERED,
        Change::Returned => AlarmEvent::RETURNED,
        Change::Acknowledged => AlarmEvent::ACKNOWLEDGED,
        Change::Shelved(_) => AlarmEvent::SHELVED,
        Change::Unshelved(_) => AlarmEvent::UNSHELVED,
        Change::Suppressed => AlarmEvent::SUPPRESSED,
        Change::Released => AlarmEvent::RELEASED,
        Change::TakenOut => AlarmEvent::TAKEN_OUT,
        Change::PutBack => AlarmEvent::PUT_BACK,
        Change::Adjusted => AlarmEvent::ADJUSTED,
    }
}

fn unshelved(why: Unshelving) -> &'static str {
    match why {
        Unshelving::Asked => "",
        Unshelving::Expired => "its time is over",
        Unshelving::Returned => "its condition has gone",
        Unshelving::Raised => "its priority rose to high",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_have_the_codes_of_the_message() {
        for (state, code) in State::ALL.into_iter().zip([
            Alarm::NORMAL,
            Alarm::ACTIVE_UNACKNOWLEDGED,
            Alarm::ACTIVE_ACKNOWLEDGED,
            Alarm::RETURNED_UNACKNOWLEDGED,
            Alarm::SHELVED,
            Alarm::SUPPRESSED_BY_DESIGN,
            Alarm::OUT_OF_SERVICE,
        ]) {
            assert_eq!(state as u8, code, "{}", state.name());
        }
    }
}
