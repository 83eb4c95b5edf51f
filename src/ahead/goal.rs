//! What is asked.

use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_text::{beyond, six_digits};

/// Most candidates of a goal: more is a map, not a question.
pub const MOST_CANDIDATES: usize = 16;
/// Most members per candidate.
pub const MOST_MEMBERS: u32 = 200;
/// Longest horizon (s): forks of a chaotic motion say nothing about a certain minute beyond it.
pub const MOST_HORIZON: f64 = 600.0;
/// Shortest horizon (s): the delays of the alarms and the windows of the analysis have to pass.
pub const LEAST_HORIZON: f64 = 10.0;
/// Longest run-up to a candidate (s).
pub const MOST_RUN_UP: f64 = 300.0;
/// Most model time of all members together (s): some two hours of one core at ten times real time.
pub const MOST_MODEL_TIME: f64 = 72_000.0;

/// Speed and weight to be tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Rotary speed (r/min).
    pub rotary_speed: f64,
    /// Weight on bit (kN).
    pub weight_on_bit: f64,
    /// How fast the speed changes (r/min per s); 0: as the configuration's slew limit.
    pub speed_ramp: f64,
    /// How fast the weight changes (kN/s); 0: as the configuration's slew limit.
    pub weight_ramp: f64,
}

/// Which futures to look at.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// In the order of the answer.
    pub candidates: Vec<Candidate>,
    /// Model time that each member is judged over, after the run-up (s).
    pub horizon: f64,
    /// Members per candidate, at most.
    pub members: u32,
    /// Whether all members run, also where a part of them decides every alarm.
    pub run_all: bool,
    /// Where a member ends, and what decides a candidate.
    pub ends: Ends,
    /// Of the disturbances.
    pub seed: u64,
}

/// Where a member ends, and what decides a candidate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Ends {
    /// A member ends with the horizon; a candidate once every alarm is decided.
    #[default]
    Horizon,
    /// A member ends with the first alarm of a priority, and has no figures then; a candidate once that alarm is
    /// decided, or more members saw one than the limit allows.
    FirstAlarm {
        /// Least priority of the alarm.
        least: Priority,
        /// Time (s) after which a member ends whose motion has stayed away from all levels; the horizon ends all.
        calm_after: f64,
        /// Share of all members that saw one, 0 to 1, above which the others change nothing: it decides the candidate.
        limit: f64,
    },
}

impl Ends {
    /// The priority of the alarm that ends a member; none where the horizon does.
    pub const fn priority(self) -> Option<Priority> {
        match self {
            Self::Horizon => None,
            Self::FirstAlarm { least, .. } => Some(least),
        }
    }
}

/// Why a goal is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GoalError {
    /// None or too many.
    #[error("{0} candidates: give 1 to {MOST_CANDIDATES}; for more, make a map (flexdrill map)")]
    Candidates(usize),
    /// None or too many.
    #[error("{0} members per candidate: give 1 to {MOST_MEMBERS}")]
    Members(u32),
    /// Too short, too long, or no number.
    #[error("a horizon of {0} s: give {LEAST_HORIZON} to {MOST_HORIZON} s")]
    Horizon(f64),
    /// All together.
    #[error(
        "{0:.0} s of model time for all members together: the most is {MOST_MODEL_TIME} s; ask for fewer candidates, \
         fewer members or a shorter horizon"
    )]
    ModelTime(f64),
    /// An input out of its limits.
    #[error("candidate {candidate}: {} ({key})", not_within(.value, .least, .most, .unit))]
    Input {
        /// Number of the candidate, from 1.
        candidate: usize,
        /// As given.
        value: f64,
        /// Lower limit.
        least: f64,
        /// Upper limit.
        most: f64,
        /// Of these.
        unit: &'static str,
        /// Key of the limits.
        key: &'static str,
    },
    /// A ramp that is negative or no number.
    #[error("candidate {candidate}: a ramp of {value} {unit} must be 0 (the configured slew limit) or more")]
    Ramp {
        /// Number of the candidate, from 1.
        candidate: usize,
        /// As given.
        value: f64,
        /// Of this.
        unit: &'static str,
    },
}

/// A value and its limits in words.
fn not_within(value: &f64, least: &f64, most: &f64, unit: &str) -> String {
    let bound = if value > most { most } else { least };
    let [value, least, most] = [beyond(*value, *bound), six_digits(*least), six_digits(*most)];
    format!("{value} {unit} is not within {least} to {most} {unit}")
}

impl Goal {
    /// Whether it can be answered.
    ///
    /// # Errors
    /// With the first value that is out of its bounds.
    pub fn check(&self, config: &Config) -> Result<(), GoalError> {
        // Counts first: the sums below are meaningful only within them, and
        // a client that sends 10^9 members must cost nothing.
        if !(1..=MOST_CANDIDATES).contains(&self.candidates.len()) {
            return Err(GoalError::Candidates(self.candidates.len()));
        }
        if !(1..=MOST_MEMBERS).contains(&self.members) {
            return Err(GoalError::Members(self.members));
        }
        if !(LEAST_HORIZON..=MOST_HORIZON).contains(&self.horizon) {
            return Err(GoalError::Horizon(self.horizon));
        }
        // The bound on the product protects the machine: each factor
        // within its own bound would allow days of computing.
        let all = self.horizon * f64::from(self.members) * self.candidates.len() as f64;
        if all > MOST_MODEL_TIME {
            return Err(GoalError::ModelTime(all));
        }
        let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
        // Candidates are counted from 1 in the error, as the client's form numbers them.
        for (candidate, asked) in (1..).zip(&self.candidates) {
            let inputs = [
                (
                    asked.rotary_speed,
                    [speed.min_rpm, speed.max_rpm],
                    "r/min",
                    "inputs.rotary_speed",
                ),
                (
                    asked.weight_on_bit,
                    [weight.min_kn, weight.max_kn],
                    "kN",
                    "inputs.weight_on_bit",
                ),
            ];
            for (value, [least, most], unit, key) in inputs {
                // `contains` is false for NaN, so that NaN is refused too.
                if !(least..=most).contains(&value) {
                    return Err(GoalError::Input {
                        candidate,
                        value,
                        least,
                        most,
                        unit,
                        key,
                    });
                }
            }
            for (value, unit) in [(asked.speed_ramp, "r/min per s"), (asked.weight_ramp, "kN/s")] {
                // A ramp of 0 means the configured slew limit.
                if !(value >= 0.0 && value.is_finite()) {
                    return Err(GoalError::Ramp { candidate, value, unit });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_input_has_no_meaningless_digits() {
        let error = GoalError::Input {
            candidate: 1,
            // 13.5 klbf.
            value: 13.5 * 4.448_221_615_260_5,
            least: 0.1 + 0.2,
            most: 60.0,
            unit: "kN",
            key: "inputs.weight_on_bit",
        };
        assert_eq!(
            error.to_string(),
            "candidate 1: 60.051 kN is not within 0.3 to 60 kN (inputs.weight_on_bit)"
        );
    }
}
