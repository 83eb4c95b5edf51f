//! Plausible tools in their present state, for who looks ahead from them.

use std::sync::Arc;

use super::engine::{Ensemble, PREPARED};
use super::place::State;
use crate::alarms::{AlarmId, AlarmSet};
use flexdrill_config::Config;
use flexdrill_core::twin::{Run, RunInputs};
use flexdrill_text::counted;
use flexdrill_uncertainty::Readings;

/// How far the members may be behind the twin (s) for their state to count as the present one: two slices, and as much
/// again for a machine that is busy.
const PRESENT: f64 = 2.0;

/// A plausible tool in its present state.
pub struct Fork {
    /// The configuration with what was drawn.
    pub config: Arc<Config>,
    /// Its run, under what acts on it.
    pub run: Run,
    /// What the rig shows of what acts, with the tool's own friction and bit.
    pub shown: RunInputs,
    /// The sensors of the inputs.
    pub readings: Readings,
    /// Alarms that stand in it.
    pub standing: AlarmSet,
}

/// All plausible tools of an instant.
pub struct Forks {
    /// The instant: time since the twin's start (s).
    pub time: f64,
    /// The tools; in words why one is unknown.
    pub tools: Vec<Result<Fork, String>>,
    /// Weights of the tools, which sum up to 1; of one that is unknown 0.
    pub shares: Vec<f64>,
}

impl Forks {
    /// What each is drawn by. What an unknown tool would do counts for as much as what one of mean weight does: it is unknown, not
    /// left out.
    pub fn weights(&self) -> Vec<f64> {
        let unknown = self.tools.iter().filter(|tool| tool.is_err()).count() as f64;
        let all = self.tools.len() as f64;
        let shares = self.tools.iter().zip(&self.shares);
        shares
            .map(|(tool, share)| match tool {
                Ok(_) => share * (all - unknown) / all,
                Err(_) => 1.0 / all,
            })
            .collect()
    }

    /// Those in which an alarm stands, and those that are unknown: what the others do says nothing of what ends it.
    #[must_use]
    pub fn in_which(self, alarm: AlarmId) -> Self {
        let both = self.tools.into_iter().zip(self.shares);
        let stands =
            |(tool, _): &(Result<Fork, String>, f64)| tool.as_ref().map_or(true, |fork| fork.standing.contains(alarm));
        let (tools, shares) = both.filter(stands).unzip();
        Self { tools, shares, ..self }
    }

    /// How many of them are known.
    pub fn known(&self) -> usize {
        self.tools.iter().filter(|tool| tool.is_ok()).count()
    }
}

impl Ensemble {
    /// The members of now.
    ///
    /// # Errors
    /// Why they are not to be looked ahead from, in words.
    pub fn fork(&self) -> Result<Forks, String> {
        if self.places.is_empty() {
            return Err(self.generation.why.clone());
        }
        let step = self.config.solver.time_step;
        let seconds = |ticks: u64| ticks as f64 * step;
        let [at, reached] = self.ticks();
        let run = seconds(at - self.generation.begun);
        if run < PREPARED {
            return Err(format!(
                "the plausible tools have run for {run:.0} s, and need {PREPARED:.0} s from rest to the motion of the twin"
            ));
        }
        let behind = seconds(reached.saturating_sub(at));
        if behind > PRESENT {
            return Err(format!(
                "the plausible tools are {behind:.0} s behind the twin on this busy computer, and may be {PRESENT:.0} s"
            ));
        }
        let acts = self.acts.ok_or("nothing acts on the twin yet")?;
        let tools: Vec<Result<Fork, String>> = (1..)
            .zip(&self.places)
            .map(|(number, place)| match (&place.drawn, &place.state) {
                (_, State::Runs(member)) => Ok(member.fork(&acts)),
                (Err(why), _) => Err(format!("plausible tool {number} is unknown: {why}")),
                _ => Err(format!(
                    "plausible tool {number} of {} failed before this instant, so that what would come is unknown",
                    counted(self.places.len() as u64, "plausible tool")
                )),
            })
            .collect();
        if tools.iter().all(Result::is_err) {
            return Err("no plausible tool can be computed".to_owned());
        }
        Ok(Forks {
            time: seconds(at),
            shares: self.weights(),
            tools,
        })
    }
}
