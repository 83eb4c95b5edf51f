//! What plausible tools say of an alarm that stands.

use std::collections::VecDeque;

use super::catalogue::AlarmId;
use super::worst_moment::WorstMoment;
use crate::messages::{Alarm, AlarmChance, Bands};
use flexdrill_alarms::Time;
use flexdrill_motion::HazardKind;
use flexdrill_text::time_of_day;

/// Age of what a list says of plausible tools (ns). A replay computes them up to ten seconds behind its run, a node mostly one
/// or two: both have the same second at this age.
const AGE: Time = 11_000_000_000;
/// Time between two messages of plausible tools (ns).
const SECOND: Time = 1_000_000_000;
/// Part by which a share by weights differs from that by number where it is said too.
const OTHERWISE: f64 = 0.05;

/// In how many plausible tools each alarm stood at an instant.
#[derive(Debug, Clone, PartialEq)]
struct Stood {
    /// ns.
    at: Time,
    /// Tools that were computed.
    of: u32,
    /// With any priority; none where no tool has the alarm.
    alarms: Vec<AlarmChance>,
}

/// The newest seconds of plausible tools.
#[derive(Debug, Clone, Default)]
pub(super) struct Plausible(VecDeque<Stood>);

impl Plausible {
    /// Takes the message of a second. Where it has no bands, too few tools are there to speak of.
    pub fn take(&mut self, bands: &Bands) {
        let at = bands.header.stamp.to_nanoseconds();
        // A clock that was set back begins again.
        self.0
            .retain(|stood| (0..2 * AGE).contains(&at.saturating_sub(stood.at)));
        if bands.no_bands.is_empty() {
            let of_any_priority = bands.alarms.iter().filter(|chance| chance.priority == Alarm::LOW);
            self.0.push_back(Stood {
                at,
                of: bands.members.saturating_sub(bands.failed),
                alarms: of_any_priority.cloned().collect(),
            });
        }
    }

    /// A sentence on an alarm for a list at an instant, after a space; empty where no tools were computed for the second that
    /// it speaks of, where the alarm has come since, and where they all agree that it stands.
    pub fn sentence(&self, id: AlarmId, moment: &WorstMoment, time: Time) -> String {
        let age = |stood: &&Stood| (AGE..AGE + SECOND).contains(&time.saturating_sub(stood.at));
        let is_of_motion = HazardKind::ALL.into_iter().any(|kind| AlarmId::of_hazard(kind) == id);
        let stood = self
            .0
            .iter()
            .find(age)
            .filter(|stood| is_of_motion && moment.stood_at(stood.at));
        let Some(stood) = stood else { return String::new() };
        let chance = stood.alarms.iter().find(|chance| chance.id == id.id());
        let (seen, of) = (chance.map_or(0, |chance| chance.seen), stood.of);
        if seen >= of {
            return String::new();
        }
        let number = match seen {
            0 => "none".to_owned(),
            seen => seen.to_string(),
        };
        let share = chance.map_or(0.0, |chance| chance.probability);
        let by_number = f64::from(seen) / f64::from(of);
        let weighed = match (share - by_number).abs() > OTHERWISE {
            true => format!(" ({:.0} % by what the rig measures)", 100.0 * share),
            false => String::new(),
        };
        format!(
            " At {} it stood in {number} of {of} plausible tools{weighed}.",
            time_of_day(stood.at)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alarms::Finding;
    use crate::messages::builtin_interfaces;
    use flexdrill_alarms::{Priority, Standing};

    fn bands(second: i64, members: u32, failed: u32, chances: &[(AlarmId, u8, u32, f64)]) -> Bands {
        let mut bands = Bands {
            members,
            failed,
            ..Bands::default()
        };
        bands.header.stamp = builtin_interfaces::Time::from_nanoseconds(second * SECOND);
        for (id, priority, seen, probability) in chances {
            bands.alarms.push(AlarmChance {
                id: id.id().to_owned(),
                priority: *priority,
                seen: *seen,
                members: members - failed,
                probability: *probability,
                ..AlarmChance::default()
            });
        }
        bands
    }

    /// A moment of an alarm that has stood from a second on.
    fn since(second: i64) -> WorstMoment {
        let mut moment = WorstMoment::default();
        let finding = Finding {
            priority: Some(Priority::High),
            ..Finding::default()
        };
        moment.observe(finding, second * SECOND, &Standing::default());
        moment
    }

    const WHIRL: AlarmId = AlarmId::BackwardWhirl;

    #[test]
    fn a_list_says_in_how_many_plausible_tools_its_alarm_stood() {
        let mut tools = Plausible::default();
        tools.take(&bands(
            100,
            12,
            0,
            &[
                (WHIRL, Alarm::LOW, 7, 7.0 / 12.0),
                (WHIRL, Alarm::HIGH, 2, 2.0 / 12.0),
                (AlarmId::Shock, Alarm::LOW, 12, 1.0),
                (AlarmId::StickSlip, Alarm::LOW, 3, 0.6),
                (AlarmId::ModelQuality, Alarm::LOW, 3, 0.25),
            ],
        ));
        let moment = since(50);
        let at = |id, second: i64| tools.sentence(id, &moment, second * SECOND);
        assert_eq!(
            at(WHIRL, 111),
            " At model time 100 s it stood in 7 of 12 plausible tools."
        );
        assert_eq!(
            at(AlarmId::JointLoad, 111),
            " At model time 100 s it stood in none of 12 plausible tools."
        );
        assert_eq!(
            at(AlarmId::StickSlip, 111),
            " At model time 100 s it stood in 3 of 12 plausible tools (60 % by what the rig measures)."
        );
        // All agree, and what the computation is worth is no question of the tool.
        assert_eq!([at(AlarmId::Shock, 111), at(AlarmId::ModelQuality, 111)], ["", ""]);
        // Another second, of which nothing is known, and an alarm that has come since.
        assert_eq!([at(WHIRL, 110), at(WHIRL, 112)], ["", ""]);
        assert_eq!(tools.sentence(WHIRL, &since(101), 111 * SECOND), "");
    }

    #[test]
    fn tools_that_failed_are_not_counted_and_too_few_say_nothing() {
        let mut tools = Plausible::default();
        tools.take(&bands(100, 12, 2, &[(WHIRL, Alarm::LOW, 7, 0.7)]));
        let few = Bands {
            no_bands: "7 plausible tools".to_owned(),
            ..bands(101, 7, 0, &[(WHIRL, Alarm::LOW, 3, 3.0 / 7.0)])
        };
        tools.take(&few);
        let at = |second: i64| tools.sentence(WHIRL, &since(50), second * SECOND);
        assert_eq!(at(111), " At model time 100 s it stood in 7 of 10 plausible tools.");
        assert_eq!(at(112), "");
    }

    /// Messages that come late, in one go, give the same as those that come in time: what a list says depends on instants.
    #[test]
    fn it_does_not_matter_when_the_messages_came() {
        let messages: Vec<Bands> = (0..60)
            .map(|second| bands(second, 12, 0, &[(WHIRL, Alarm::LOW, second as u32 % 12, 0.5)]))
            .collect();
        let moment = since(-1);
        let by_delay = |delay: i64| {
            let mut tools = Plausible::default();
            let mut said = Vec::new();
            for now in 0..60_i64 {
                for message in messages.iter().filter(|message| {
                    let stamp = message.header.stamp.to_nanoseconds();
                    stamp == (now - delay) * SECOND
                }) {
                    tools.take(message);
                }
                said.push(tools.sentence(WHIRL, &moment, now * SECOND));
            }
            said
        };
        let in_time = by_delay(1);
        assert_eq!(in_time, by_delay(10));
        assert_eq!(in_time.iter().filter(|words| !words.is_empty()).count(), 60 - 11);
        // Those that come later are not waited for.
        assert!(by_delay(20).iter().all(String::is_empty));
    }
}
