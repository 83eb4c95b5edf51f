//! The smallest change of speed or weight that ends the alarms that stand, found by looking ahead.
//!
//! A change is chosen by members of one set of seeds and confirmed by members of another, which took no part in
//! choosing it: the count of those that chose it is the best of many. Only the confirming count is given to the
//! driller.
//!
//! # Layout
//! - `trials`: the changes, by direction.
//! - `searching`: which of them get members, and how many.
//! - here: a member of the model.

mod searching;
mod trials;

use std::sync::atomic::AtomicBool;

use super::engine::disturbed;
use super::goal::{Candidate, MOST_RUN_UP};
use super::measured::{Measured, is_judged_at, least_hold};
use super::member::{Called, Ended, Horizon, LOOK, Member, Watched};
use super::start::Start;
use crate::alarms::{AlarmId, AlarmSet, Change, Knob, Leading, Tested};
use crate::ensemble::Forks;
use flexdrill_alarms::Priority;
use flexdrill_core::twin::SimulationSettings;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_text::counted;
use searching::{LEAST_CONFIRMING, Outcome, Search, Span};
use trials::{Trial, judged_trials};

pub use searching::{SearchProgress, Searched};

/// Speed (r/min) and weight (kN) after a change from `from`.
fn point(from: [f64; 2], change: Change) -> [f64; 2] {
    match change.quantity {
        Knob::Speed => [change.to, from[1]],
        Knob::Weight => [from[0], change.to],
    }
}

/// The runs of the model that try changes.
struct Runs<'a> {
    start: &'a Start,
    settings: SimulationSettings,
    leading: Leading,
    stop: &'a AtomicBool,
    /// Speed (r/min) and weight (kN).
    from: [f64; 2],
}

impl Runs<'_> {
    /// What the alarms of a member say in which `before` stood at its beginning, of which no change is the cause.
    fn outcome(&self, alarms: &[Called], before: AlarmSet) -> Outcome {
        let called = |of: &dyn Fn(Priority) -> bool| -> AlarmSet {
            let all = AlarmId::ALL.into_iter().zip(alarms);
            all.filter(|(_, called)| called.worst.is_some_and(of))
                .map(|(id, _)| id)
                .collect()
        };
        let Leading { standing, shelved, .. } = self.leading;
        let (any, known) = (called(&|_| true), standing.union(shelved).union(before));
        Outcome {
            open: any.common(standing),
            came: !any.is_within(known),
            destroys: !called(&|priority| priority == Priority::High).is_within(known),
            seconds: 0.0,
        }
    }

    /// A member's outcome; `None` where it was stopped. A member that fails speaks against the change, because what would have
    /// followed is unknown. One that chooses is a run of the twin; one that confirms, of the tool that is drawn for its
    /// number.
    fn member(&self, trial: &Trial, seed: u64, number: usize, member: u32, span: Span) -> Option<Outcome> {
        let of = |start: &Start| self.run(start, trial, seed, (number, member), span);
        let run = match span.lasting > 0.0 {
            true => self.start.with_tool(member, self.stop, of),
            false => of(self.start),
        };
        match run {
            Ok(outcome) => Some(outcome),
            Err(Ended::Stopped) => None,
            Err(_) => Some(Outcome {
                open: self.leading.standing,
                came: true,
                destroys: false,
                seconds: 0.0,
            }),
        }
    }

    /// A run of the tool of `start`. It parts from the others before the change: where a motion can continue or end, the path to
    /// the change decides which: with a shared path all members would end alike.
    fn run(
        &self,
        start: &Start,
        trial: &Trial,
        seed: u64,
        (number, member): (usize, u32),
        span: Span,
    ) -> Result<Outcome, Ended> {
        let config = start.config();
        let Leading {
            alarm,
            standing,
            shelved,
        } = self.leading;
        let before = start.standing();
        let at = point(self.from, trial.change);
        let target = start.target(&Candidate {
            rotary_speed: at[0],
            weight_on_bit: at[1],
            speed_ramp: 0.0,
            weight_ramp: 0.0,
        });
        // An alarm that comes with the change for a moment must have ended too before the alarms count as ended. One that stood
        // in this tool alone is not what the change is for.
        let aside = shelved.union(before.without(standing));
        let to_end: AlarmSet = AlarmId::ALL.into_iter().filter(|id| !aside.contains(*id)).collect();
        let horizon = Horizon::Settling {
            alarms: to_end,
            within: span.within,
            lasting: span.lasting,
            least: span.least,
            leading: (alarm, least_hold(alarm, &self.settings)),
        };
        let run = disturbed(start.state(), seed, number, member);
        let (there, way) = Watched::new(run, config, self.stop).run_up(&target, MOST_RUN_UP)?;
        // Without the end of the leading alarm no goal is reached, and the rest of the member says nothing more.
        let is_out = |alarms: &[Called]| {
            let outcome = self.outcome(alarms, before);
            outcome.came || outcome.open.contains(alarm)
        };
        let mut watched = Watched::new(there, config, self.stop).wavering(start.wavering(seed, number, member));
        if span.lasting > 0.0 {
            // Of a plausible tool, what acts is not what the rig shows.
            let acts = target.inputs;
            let acts = [rad_per_s_to_rpm(acts.rotary_speed), n_to_kn(acts.weight_on_bit)];
            watched = watched.measured(Measured::new(self.settings.clone(), acts, LOOK));
        }
        let member: Member = watched.judge(horizon, is_out)?;
        let mut outcome = self.outcome(&member.alarms, before);
        // What is not judged has not ended. A member that only chooses is asked at its point alone.
        let open = |id: &AlarmId| match &member.measured {
            Some(measured) => !measured.is_judged(*id) || measured.calls(*id, config),
            None => !is_judged_at(*id, at, &self.settings),
        };
        outcome.open = outcome.open.union(standing.iter().filter(open).collect());
        outcome.seconds = way + member.judged;
        Ok(outcome)
    }
}

/// Fixed, so that the same state gives the same advice.
pub const ADVICE_SEED: u64 = 1;

/// Those of some plausible tools that can confirm what ends an alarm: it stands in them.
///
/// # Errors
/// In words, where they are fewer than a first answer needs.
pub fn tools_in_which(forks: Forks, alarm: AlarmId) -> Result<Forks, String> {
    let forks = forks.in_which(alarm);
    match forks.known() {
        known if known >= LEAST_CONFIRMING as usize => Ok(forks),
        known => Err(format!(
            "{} stands in {} only",
            alarm.name(),
            counted(known as u64, "plausible tool")
        )),
    }
}

/// The smallest change that ends the alarms that stand, from `start`; where none of those tried does, one that ends the
/// leading alarm, with those that stay; none where none of those tried does that either; `None` once `stop` was set. A
/// change to a point at which the leading alarm is not judged is not tried: it would silence the alarm. `hear` hears of
/// each round of members. The same start and seed give the same answer, with any number of threads.
///
/// The state of `start` itself chooses the change. Where its members are plausible tools ([`Start::among`]), those confirm it.
pub fn search(
    start: &Start,
    leading: &Leading,
    seed: u64,
    threads: usize,
    stop: &AtomicBool,
    mut hear: impl FnMut(SearchProgress),
) -> Option<Searched> {
    let inputs = start.applied().inputs;
    let from = [rad_per_s_to_rpm(inputs.rotary_speed), n_to_kn(inputs.weight_on_bit)];
    let config = start.config();
    let settings = config.simulation();
    let trials = judged_trials(config, &settings, leading.alarm, from);
    let runs = Runs {
        start,
        settings,
        leading: *leading,
        stop,
        from,
    };
    let search = Search {
        leading: *leading,
        from,
        seed,
        threads,
        member: |trial: &Trial, seed, number, member, span| runs.member(trial, seed, number, member, span),
    };
    // Members confirm in the order of their numbers.
    let of_tools = |tested: Tested| Tested {
        tools: start.tools(0..tested.of),
        ..tested
    };
    let mut hear = |progress: SearchProgress| {
        hear(SearchProgress {
            first: progress.first.map(of_tools),
            ..progress
        });
    };
    let searched = search.run(&trials, &mut hear).ok()?;
    Some(Searched {
        tested: searched.tested.map(of_tools),
        ..searched
    })
}

#[cfg(test)]
mod tests;
