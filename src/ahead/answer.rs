//! What the members of a look-ahead say together.

use std::collections::BTreeMap;

use super::chance::{Band, Chance};
use super::goal::{Candidate, Ends, Goal, MOST_RUN_UP};
use super::member::{Ended, Figure, Member};
use super::start::Start;
use crate::alarms::AlarmId;
use flexdrill_alarms::Priority;
use flexdrill_core::twin::QualityLevel;
use flexdrill_messages as messages;
use flexdrill_outputs::words::priority_code;

/// The chance of one alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlarmChance {
    /// Which.
    pub id: AlarmId,
    /// Of this priority or a higher one.
    pub priority: Priority,
    /// How often.
    pub chance: Chance,
    /// Median over the members that saw it of the time to the first of it (s); NaN where none did.
    pub first: f64,
}

impl AlarmChance {
    /// As a message.
    pub fn message(&self) -> messages::AlarmChance {
        messages::AlarmChance {
            id: self.id.id().to_owned(),
            name: self.id.name().to_owned(),
            priority: priority_code(Some(self.priority)),
            seen: self.chance.seen,
            members: self.chance.of,
            probability: self.chance.probability,
            lower: self.chance.interval[0],
            upper: self.chance.interval[1],
            time_to_first: self.first,
        }
    }
}

/// The answer on one candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateAnswer {
    /// Which.
    pub candidate: Candidate,
    /// Time of the run-up (s), of the first member that ended where each has its way; NaN where it failed.
    pub run_up: f64,
    /// Model time of the run-up and of the members that ended, with their ways (s).
    pub model_time: f64,
    /// Members that count: those up to the first number at which every alarm is decided.
    pub members: u32,
    /// Plausible tools that these members are runs of; 0 where they are runs of the twin.
    pub tools: u32,
    /// Members that failed among them: what would have come is unknown.
    pub failed: u32,
    /// Why the first of these failed; empty where none did.
    pub failure: String,
    /// Whether the test decided every alarm.
    pub decided: bool,
    /// Alarms that a member saw, by [`AlarmId::ALL`] and from the lowest priority.
    pub alarms: Vec<AlarmChance>,
    /// Chance that a member saw any alarm of the tool.
    pub any_alarm: Chance,
    /// Members that saw any alarm of the tool with this priority or a higher one, by [`Priority::ALL`].
    pub any_by_priority: [u32; 3],
    /// By [`Figure::ALL`].
    pub figures: [Band; Figure::ALL.len()],
    /// Members by the worst quality of their motion: good, degraded, poor.
    pub quality: [u32; 3],
}

/// The answer on all candidates.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// In the order of the goal.
    pub candidates: Vec<CandidateAnswer>,
    /// Whether it was stopped: then only the members that had ended count.
    pub stopped: bool,
}

/// Whether members of whom `any` of `of` saw the alarm that ends them decide a candidate of `members` in all: by the test, or
/// because the others cannot bring the share below the limit.
fn first_alarm_decides(members: u32, limit: f64, any: u32, of: u32) -> bool {
    f64::from(any) > limit * f64::from(members) || Chance::new(any, of).decided().is_some()
}

/// How far a look-ahead is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Members that ended.
    pub done: u32,
    /// Members that may have to run yet.
    pub remaining: u32,
    /// What they say so far.
    pub answer: Answer,
}

/// What is known of one candidate.
pub(super) struct Gathered {
    /// The time to get to the candidate's speed and weight (s), or why no member does; nothing where each has its way.
    pub run_up: Result<Option<f64>, Ended>,
    /// Members by number.
    pub members: BTreeMap<u32, Result<Member, Ended>>,
    /// Members that count, once that is decided.
    pub enough: Option<u32>,
}

/// The number of members that are enough, if the first ones that ended are; all of them where all ended.
pub(super) fn enough(members: &BTreeMap<u32, Result<Member, Ended>>, goal: &Goal) -> Option<u32> {
    let mut seen = vec![0; AlarmId::ALL.len()];
    let (mut any, mut of) = (0, 0);
    for (number, (member, result)) in (0..goal.members).zip(members) {
        if number != *member {
            return None;
        }
        if let Ok(result) = result {
            of += 1;
            any += u32::from(result.saw(goal.ends));
            for (seen, called) in seen.iter_mut().zip(&result.alarms) {
                *seen += u32::from(called.worst.is_some());
            }
        }
        let decided = || match goal.ends {
            Ends::Horizon => seen.iter().all(|&seen| Chance::new(seen, of).decided().is_some()),
            Ends::FirstAlarm { limit, .. } => first_alarm_decides(goal.members, limit, any, of),
        };
        if number + 1 == goal.members || (!goal.run_all && decided()) {
            return Some(number + 1);
        }
    }
    None
}

/// How far a look-ahead is.
pub(super) fn told(start: &Start, goal: &Goal, gathered: &[Gathered]) -> Progress {
    let done = gathered.iter().map(|candidate| candidate.members.len() as u32).sum();
    let remaining = gathered
        .iter()
        .filter(|candidate| candidate.enough.is_none())
        .map(|candidate| goal.members.saturating_sub(candidate.members.len() as u32))
        .sum();
    Progress {
        done,
        remaining,
        answer: answer(start, goal, gathered, false),
    }
}

/// The answer of the members so far.
pub(super) fn answer(start: &Start, goal: &Goal, gathered: &[Gathered], stopped: bool) -> Answer {
    Answer {
        candidates: goal
            .candidates
            .iter()
            .zip(gathered)
            .map(|(candidate, gathered)| summed(start, goal, candidate, gathered))
            .collect(),
        stopped,
    }
}

fn summed(start: &Start, goal: &Goal, candidate: &Candidate, gathered: &Gathered) -> CandidateAnswer {
    let ends = goal.ends;
    let counted = gathered.enough.map_or(gathered.members.len(), |enough| enough as usize);
    let results: Vec<&Result<Member, Ended>> = gathered.members.values().take(counted).collect();
    let numbers = gathered.members.keys().take(counted).copied();
    let members: Vec<&Member> = results.iter().filter_map(|result| result.as_ref().ok()).collect();
    let of = members.len() as u32;
    let failures = results.iter().filter_map(|result| result.as_ref().err());
    let failure = gathered.run_up.as_ref().err().or_else(|| failures.clone().next());
    let of_quality = |level: QualityLevel| members.iter().filter(|member| member.quality == level).count() as u32;
    let mut seen = vec![0; AlarmId::ALL.len()];
    for member in &members {
        for (seen, called) in seen.iter_mut().zip(&member.alarms) {
            *seen += u32::from(called.worst.is_some());
        }
    }
    // A member that ended with an alarm has no figures of its whole horizon.
    let whole = members.iter().filter(|member| !member.saw(ends));
    let saw = of - whole.clone().count() as u32;
    CandidateAnswer {
        candidate: *candidate,
        run_up: match gathered.run_up {
            Ok(Some(time)) => time,
            Ok(None) => members.first().map_or(f64::NAN, |member| member.way),
            Err(_) => f64::NAN,
        },
        model_time: gathered.run_up.as_ref().map_or(0.0, |way| way.unwrap_or(0.0))
            + members.iter().map(|member| member.way + member.judged).sum::<f64>(),
        members: counted as u32,
        tools: start.tools(numbers),
        failed: failures.count() as u32,
        failure: failure.map_or(String::new(), sentence),
        decided: match ends {
            Ends::Horizon => seen.iter().all(|&seen| Chance::new(seen, of).decided().is_some()),
            Ends::FirstAlarm { limit, .. } => first_alarm_decides(goal.members, limit, saw, of),
        },
        alarms: alarm_chances(&members),
        any_alarm: any_alarm(&members),
        any_by_priority: Priority::ALL.map(|least| {
            let saw = |member: &&&Member| member.alarms.iter().any(|called| called.worst >= Some(least));
            members.iter().filter(saw).count() as u32
        }),
        figures: Figure::ALL.map(|figure| Band::of(whole.clone().map(|member| member.figures[figure as usize]))),
        quality: [QualityLevel::Good, QualityLevel::Degraded, QualityLevel::Poor].map(of_quality),
    }
}

/// The alarms that a member saw, by [`AlarmId::ALL`] and from the lowest priority.
pub(super) fn alarm_chances(members: &[&Member]) -> Vec<AlarmChance> {
    let mut alarms = Vec::new();
    for id in AlarmId::ALL {
        for priority in [Priority::Low, Priority::Medium, Priority::High] {
            let called = members.iter().map(|member| member.alarms[id as usize]);
            let firsts: Vec<f64> = called
                .filter(|called| called.worst >= Some(priority))
                .map(|called| called.first)
                .collect();
            if !firsts.is_empty() {
                alarms.push(AlarmChance {
                    id,
                    priority,
                    chance: Chance::new(firsts.len() as u32, members.len() as u32),
                    first: Band::of(firsts.into_iter()).quantiles[1],
                });
            }
        }
    }
    alarms
}

/// The chance that a member saw any alarm.
pub(super) fn any_alarm(members: &[&Member]) -> Chance {
    let any = |member: &&&Member| member.alarms.iter().any(|called| called.worst.is_some());
    Chance::new(members.iter().filter(any).count() as u32, members.len() as u32)
}

/// Why a member ended early.
pub(super) fn sentence(ended: &Ended) -> String {
    match ended {
        Ended::Failed(failure) => format!("a step failed, so that the rest is unknown: {failure}"),
        Ended::NoTool(why) => why.clone(),
        Ended::NotReached => format!(
            "speed or weight did not reach the candidate's within {MOST_RUN_UP} s; give a faster ramp or a nearer candidate"
        ),
        Ended::Stopped => "stopped".to_owned(),
    }
}
