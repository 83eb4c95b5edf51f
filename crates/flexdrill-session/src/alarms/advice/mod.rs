//! What the driller can do about the tool's alarms, by the rules of the configuration: limits for the speed and the
//! weight on bit.
//!
//! All standing alarms share one advice, one change at a time. The alarm of the highest priority leads and asks for its
//! change alone; the others refer to it. No run has shown that two changes at once work (`docs/alarms.md` lists the
//! runs).

mod step;

use std::fmt;

use super::catalogue::AlarmId;
use super::sentence::capitalized;
use super::set::AlarmSet;
use flexdrill_alarms::Priority;
use flexdrill_config::{Advice, InputsConfig};
use flexdrill_core::inputs::{Conditioner, InputKind, InputState};
use flexdrill_core::twin::Applied;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use step::Step;

/// The last resort of a driller, for an alarm of high priority.
const STOP: &str = "pick up off bottom and stop the drive";
/// Part of a limit by which an input must pass the limit before its alarm no longer asks for the change. A drive's speed
/// and a weight indicator fluctuate by a few percent, and without this margin the advice would fluctuate with them.
/// Assumption.
const FLUCTUATION: f64 = 0.05;

/// The action of an alarm that no limit of speed or weight ends.
fn own_action(id: AlarmId) -> Option<&'static str> {
    match id {
        AlarmId::WeightTransfer => Some(
            "Pick up off bottom, rotate, and slack off again slowly. If the weight still does not arrive, call the engineer.",
        ),
        AlarmId::TorqueTransfer => Some(
            "Pick up off bottom and rotate there. If the torque stays high, do not drill on, and call the engineer.",
        ),
        AlarmId::GuidePreload => Some(
            "Do not push the tool further into the curve, and call the engineer: no change of speed or weight relieves the \
             guide.",
        ),
        AlarmId::PressureFolding => Some("Reduce the pump rate until the alarm clears, and call the engineer."),
        AlarmId::BitStuck => Some(
            "Stop the rotation and hold the torque, then let it out slowly: never release or reverse the drive suddenly. Pick \
             up gently until the bit is free, or slack off if the tool is held on the way up. If neither frees it, call the \
             engineer.",
        ),
        _ => None,
    }
}

/// The operating point: speed and weight that act on the model.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Operating {
    /// r/min.
    pub rpm: f64,
    /// Weight on bit (kN).
    pub kn: f64,
    /// Which of them are the twin's own.
    pub unknown: Unknown,
}

impl Operating {
    pub fn of(applied: &Applied, unknown: Unknown) -> Self {
        Self {
            rpm: rad_per_s_to_rpm(applied.rotary_speed),
            kn: n_to_kn(applied.weight_on_bit),
            unknown,
        }
    }
}

/// Which of the rig's values the twin does not know: it then runs on the last one, a ramp to the safe value, or the
/// configured start value.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Unknown {
    /// The rotary speed.
    pub speed: bool,
    /// The weight on bit.
    pub weight: bool,
}

impl Unknown {
    /// What a conditioner does not know at an instant of its clock (s).
    pub fn of(conditioner: &Conditioner, now: f64) -> Self {
        let is_unknown = |kind| {
            matches!(
                conditioner.state(kind, now),
                InputState::Stale | InputState::NotReceived
            )
        };
        Self {
            speed: is_unknown(InputKind::RotarySpeed),
            weight: is_unknown(InputKind::WeightOnBit),
        }
    }

    /// Whether it is speed or weight.
    pub fn any(self) -> bool {
        self.speed || self.weight
    }

    /// Two sentences to a driller; empty where both are known.
    fn words(self) -> &'static str {
        match (self.speed, self.weight) {
            (false, false) => "",
            (true, false) => "The rig's speed is unknown to the twin. Read it on the rig's own instruments. ",
            (false, true) => "The rig's weight on bit is unknown to the twin. Read it on the rig's own instruments. ",
            (true, true) => {
                "The rig's speed and weight on bit are unknown to the twin. Read them on the rig's own instruments. "
            }
        }
    }
}

/// An input that the driller can change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knob {
    /// Rotary speed (r/min).
    Speed,
    /// Weight on bit (kN).
    Weight,
}

/// One input set to a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Which input.
    pub quantity: Knob,
    /// r/min or kN.
    pub to: f64,
}

/// The alarm of the tool's motion that leads, with those that stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Leading {
    /// The alarm that leads.
    pub alarm: AlarmId,
    /// All that stand and are not shelved, `alarm` among them.
    pub standing: AlarmSet,
    /// Those that stand and that an operator has put aside.
    pub shelved: AlarmSet,
}

/// A change that look-aheads have tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tested {
    /// The standing alarms that it ends, the one that led among them.
    pub ends: AlarmSet,
    /// The standing alarms that it does not end.
    pub stays: AlarmSet,
    /// Speed (r/min) and weight (kN) from which it was tried.
    pub from: [f64; 2],
    /// What to set.
    pub change: Change,
    /// Runs in which all of `ends` ended and no other alarm came, of those that took no part in choosing the change.
    pub ended: u32,
    /// Runs that took no part in choosing the change: the count of those that chose it is the best of many, and too
    /// good.
    pub of: u32,
    /// Plausible tools that these runs are of, none of which took part in choosing the change; 0 where they are runs of the
    /// twin.
    pub tools: u32,
}

impl Tested {
    /// Whether the change lies ahead of what is set now (r/min and kN): in the same direction, and at least half of it.
    pub fn lies_ahead(&self, now: [f64; 2]) -> bool {
        let Change { quantity, to } = self.change;
        let of = match quantity {
            Knob::Speed => 0,
            Knob::Weight => 1,
        };
        (to - now[of]) / (to - self.from[of]) >= 0.5
    }
}

impl fmt::Display for Tested {
    /// A sentence to a driller.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Change { quantity, to } = self.change;
        let (from, unit) = match quantity {
            Knob::Speed => (self.from[0], "r/min"),
            Knob::Weight => (self.from[1], "kN"),
        };
        let verb = if to > from { "Raise" } else { "Lower" };
        let what = match (self.ends.len(), self.stays.is_empty()) {
            (..=1, true) => "the alarm".to_owned(),
            (_, true) => format!("all {} alarms", self.ends.len()),
            (_, false) => self.ends.to_string(),
        };
        write!(
            f,
            "{verb} the {} to {to} {unit} ({from:.0} {unit} now) and keep the {}: this ended {what} in {} of {} ",
            quantity.name(),
            quantity.other().name(),
            self.ended,
            self.of
        )?;
        match self.tools {
            0 => f.write_str("runs that took no part in choosing it.")?,
            tools if tools == self.of => f.write_str("plausible tools.")?,
            1 => f.write_str("runs of one plausible tool.")?,
            tools => write!(f, "runs of {tools} plausible tools.")?,
        }
        match self.stays.len() {
            0 => Ok(()),
            1 => write!(f, " It does not end {}, which stays.", self.stays),
            _ => write!(f, " It does not end {}, which stay.", self.stays),
        }
    }
}

/// Where advice comes from in addition to the rules.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Ahead {
    /// What look-aheads do for advice; none where the node does not look ahead for it.
    pub trial: Option<Trial>,
    /// What look-aheads have found for the present state.
    pub tested: Option<Tested>,
}

/// What look-aheads do for the alarms that stand.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Trial {
    /// Nothing yet.
    #[default]
    Waits,
    /// They try changes.
    Runs {
        /// Time until an answer (s), in tens; none before that is known, and where a search takes longer than others.
        seconds: Option<u64>,
    },
    /// They tried changes within the limits, and none ended the leading alarm.
    NothingFound,
}

impl Trial {
    /// A sentence to a driller on the limit of a rule.
    fn words(self) -> String {
        let now = match self {
            Self::Waits => "the twin has not tried it out.".to_owned(),
            Self::Runs { seconds: None } => "the twin is searching for a change that ends the alarm.".to_owned(),
            Self::Runs { seconds: Some(seconds) } => {
                format!("the twin is searching for a change that ends the alarm, about {seconds} s.")
            }
            // A rule that was tried is not shown any more.
            Self::NothingFound => "the twin has tried smaller changes, and none ended the alarm.".to_owned(),
        };
        format!(" This is a rule of thumb: {now}")
    }
}

/// What is said where look-aheads have refuted the rule of the leading alarm.
const NOTHING: &str =
    "Nothing that the twin has tried ends it: from 0.3 to 2 times the speed, from 0.3 to 1.5 times the weight. ";
/// Least and most speed that look-aheads try, as parts of the present one.
pub const TRIED_SPEED: [f64; 2] = [0.3, 2.0];
/// Least and most weight that look-aheads try, as parts of the present one.
pub const TRIED_WEIGHT: [f64; 2] = [0.3, 1.5];

impl Knob {
    fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Weight => "weight on bit",
        }
    }

    fn other(self) -> Self {
        match self {
            Self::Speed => Self::Weight,
            Self::Weight => Self::Speed,
        }
    }

    fn now(self, now: &Operating) -> f64 {
        match self {
            Self::Speed => now.rpm,
            Self::Weight => now.kn,
        }
    }

    fn tried(self) -> [f64; 2] {
        match self {
            Self::Speed => TRIED_SPEED,
            Self::Weight => TRIED_WEIGHT,
        }
    }

    fn is_unknown(self, now: &Operating) -> bool {
        match self {
            Self::Speed => now.unknown.speed,
            Self::Weight => now.unknown.weight,
        }
    }

    fn most(self, inputs: &InputsConfig) -> f64 {
        match self {
            Self::Speed => inputs.rotary_speed.max_rpm,
            Self::Weight => inputs.weight_on_bit.max_kn,
        }
    }
}

/// An alarm with its rule.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand {
    pub id: AlarmId,
    /// The priority of the alarm; none once the condition has ended and the alarm is only held.
    pub priority: Option<Priority>,
    pub rule: Advice,
    /// A shelved alarm leads only where no other alarm does.
    pub shelved: bool,
    /// It has led so far, and leads on among alarms of the same priority: advice that changes with every alarm that comes
    /// cannot be followed.
    pub leads: bool,
}

/// What the driller can do about an alarm.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Action {
    pub text: String,
    /// The alarm whose action comes first; none for an alarm with its own action.
    pub follows: Option<AlarmId>,
}

/// Whether a rule has a step that changes the present inputs. `stands` says whether its alarm stands already.
pub(super) fn applies(rule: &Advice, now: &Operating, inputs: &InputsConfig, stands: bool) -> bool {
    Step::of(rule).any(|step| step.applies(now, inputs, stands))
}

/// One action per alarm, in the order of `demands`.
pub(super) fn what_to_do(demands: &[Demand], now: &Operating, inputs: &InputsConfig, ahead: &Ahead) -> Vec<Action> {
    let order = by_rank(demands);
    // An action of an alarm that an operator has put aside is none for those that stand.
    let shelved = order.first().is_some_and(|first| first.shelved);
    let may_lead = |demand: &Demand| demand.shelved == shelved;
    // A change that was tried from the twin's own speed and weight says nothing of the rig's.
    let tested = ahead.tested.filter(|_| !now.unknown.any()).and_then(|tested| {
        let mut leading = order.iter().filter(|demand| may_lead(demand));
        let demand = *leading.find(|demand| tested.ends.contains(demand.id))?;
        Some((demand, Lead::Tested(tested)))
    });
    let lead = tested.or_else(|| {
        order
            .iter()
            .enumerate()
            .filter(|(_, demand)| may_lead(demand))
            .find_map(|(rank, demand)| {
                // The search is for the alarm that leads, at the twin's own speed and weight.
                let is_searched = ahead.trial == Some(Trial::NothingFound) && rank == 0 && !now.unknown.any();
                Some((*demand, lead(demand, &order[..rank], &order, now, inputs, is_searched)?))
            })
    });
    let note = ahead.trial.map_or(String::new(), Trial::words);
    demands
        .iter()
        .map(|demand| Action {
            text: sentence(demand, lead, now, inputs, &note),
            follows: lead
                .map(|(leading, _)| leading.id)
                .filter(|leading| demand.priority.is_some() && *leading != demand.id),
        })
        .collect()
}

/// The alarms whose conditions stand, the one that leads first.
pub(super) fn by_rank(demands: &[Demand]) -> Vec<&Demand> {
    let mut order: Vec<&Demand> = demands.iter().filter(|demand| demand.priority.is_some()).collect();
    order.sort_by_key(|demand| {
        let priority = std::cmp::Reverse(demand.priority);
        (demand.shelved, priority, !demand.leads, demand.id as usize)
    });
    order
}

/// The action of the leading alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Lead {
    Step(Step),
    /// The alarm's own action.
    Own(&'static str),
    /// What look-aheads have tried.
    Tested(Tested),
    /// Look-aheads have tried what the rule asks for, and it does not end the alarm.
    Refuted,
    Stop,
}

/// The action of an alarm if it leads: the first step that respects the limits of all other rules, else the first that
/// respects those of the alarms before it, else, for a high alarm, the last resort. None where no step is allowed. Where a
/// search has found nothing, a step that it has tried is none.
fn lead(
    demand: &Demand,
    before: &[&Demand],
    all: &[&Demand],
    now: &Operating,
    inputs: &InputsConfig,
    is_searched: bool,
) -> Option<Lead> {
    let free_of = |step: &Step, others: &[&Demand]| {
        others
            .iter()
            .filter(|other| other.id != demand.id)
            .all(|other| !step.is_against(&other.rule))
    };
    let (refuted, steps): (Vec<Step>, Vec<Step>) = Step::of(&demand.rule)
        .filter(|step| step.applies(now, inputs, true))
        .partition(|step| is_searched && step.was_tried(now));
    let step = steps
        .iter()
        .find(|step| free_of(step, all))
        .or_else(|| steps.iter().find(|step| free_of(step, before)));
    match (step, demand.priority) {
        (Some(step), _) => Some(Lead::Step(*step)),
        (None, _) if own_action(demand.id).is_some() => own_action(demand.id).map(Lead::Own),
        (None, _) if !refuted.is_empty() => Some(Lead::Refuted),
        (None, Some(Priority::High)) => Some(Lead::Stop),
        (None, _) => None,
    }
}

/// `note` says that a limit is a rule of the configuration where advice from look-aheads may follow. An action of its own
/// begins with what the twin does not know of the rig.
fn sentence(
    demand: &Demand,
    lead: Option<(&Demand, Lead)>,
    now: &Operating,
    inputs: &InputsConfig,
    note: &str,
) -> String {
    // The unknowns come first in a sentence that asks for an action: the driller must know them before acting on it.
    let unknown = now.unknown.words();
    let Some(priority) = demand.priority else {
        return "No further action: the alarm clears by itself unless the motion returns.".to_owned();
    };
    // The leading alarm carries the action. All others refer to it, so that two rows never ask for two changes at once.
    match lead {
        Some((leading, lead)) if leading.id == demand.id => match (lead, priority) {
            (Lead::Stop, _) => format!("{unknown}{}.", capitalized(STOP)),
            (Lead::Own(action), _) => format!("{unknown}{action}"),
            (Lead::Refuted, Priority::High) => format!("{NOTHING}{}.", capitalized(STOP)),
            (Lead::Refuted, _) => format!("{NOTHING}Call the engineer. If it gets worse, pick up off bottom."),
            // A tested change was run ahead by the twin; its text holds the
            // evidence, and the remark on rules would be wrong for it.
            (Lead::Tested(tested), Priority::High) => {
                let what = if tested.stays.is_empty() {
                    "it"
                } else {
                    leading.id.name()
                };
                format!("{tested} If {what} persists, {STOP}.")
            }
            (Lead::Tested(tested), _) => tested.to_string(),
            // High priority gets a second action, because a rule's step has not been run and may fail.
            (Lead::Step(step), Priority::High) => {
                format!("{unknown}{} If it persists, {STOP}.{note}", step.sentence(now))
            }
            (Lead::Step(step), _) => format!("{unknown}{}{note}", step.sentence(now)),
        },
        // Evidence before rules: where look-aheads say that the change ends
        // this alarm or leaves it, the rule is not consulted.
        Some((leading, Lead::Tested(tested))) if tested.ends.contains(demand.id) => {
            format!("The change advised for {} covers this alarm too.", leading.id.name())
        }
        Some((leading, Lead::Tested(tested))) if tested.stays.contains(demand.id) => format!(
            "The change advised for {} does not end this alarm: make that change first, then check this alarm again.",
            leading.id.name()
        ),
        Some((leading, Lead::Step(step)))
            // Two rules with the same direction need one change. A step that
            // the inputs' bounds do not allow does not count.
            if Step::of(&demand.rule).any(|own| own.applies(now, inputs, true) && step.serves(&own)) =>
        {
            format!("The change advised for {} covers this alarm too.", leading.id.name())
        }
        Some((leading, _)) => format!(
            "Follow the advice for {} first, then check this alarm again.",
            leading.id.name()
        ),
        None => format!(
            "{unknown}Call the engineer: no change of speed or weight is known to end this motion. If it gets worse, pick \
             up off bottom."
        ),
    }
}

#[cfg(test)]
mod tests;
