//! The seeded plan: a Latin hypercube, then changes to the best, then the best on the full mesh.

use super::outcome::{Outcome, Trial};
use super::space::{DIMENSIONS, case, starts};
use crate::config::Config;
use crate::paper::record;

/// How much is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Coarse mesh: bounds and everything that the space does not change come from it.
    pub coarse: Config,
    /// Full mesh.
    pub full: Config,
    /// Points of the Latin hypercube.
    pub points: usize,
    /// Rounds of refinement.
    pub rounds: usize,
    /// Trials per round.
    pub per_round: usize,
    /// Best trials run again on the full mesh.
    pub finalists: usize,
    /// Seed.
    pub seed: u64,
    /// Turns recorded per trial.
    pub turns: f64,
}

impl Plan {
    /// Trials of the whole plan, if enough of them run.
    pub fn total(&self) -> usize {
        starts().len() + self.points + self.rounds * self.per_round + self.finalists
    }
}

/// The best trial of every stage that had one.
pub fn leaders(trials: &[Trial]) -> Vec<(&'static str, &Trial)> {
    [Stage::Start, Stage::Screening, Stage::Refinement, Stage::Full]
        .iter()
        .filter_map(|stage| {
            let of_stage = trials.iter().filter(|trial| trial.stage == stage.word());
            best(of_stage, 1).first().map(|trial| (stage.word(), *trial))
        })
        .collect()
}

/// Part of the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The usual values with different joints.
    Start,
    /// Latin hypercube.
    Screening,
    /// Changes to the best.
    Refinement,
    /// The best on the full mesh.
    Full,
}

impl Stage {
    fn word(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Screening => "screening",
            Self::Refinement => "refinement",
            Self::Full => "full",
        }
    }
}

/// Of the trials so far, the parents of a round's changes.
const PARENTS: usize = 5;
/// Size of a change in the first round, as a part of the whole range; halved until the last.
const FIRST_CHANGE: f64 = 0.2;
/// Part of the coordinates that are changed at a time.
const CHANGED: f64 = 0.35;

/// Runs the plan; `done` is given every trial as it ends, in order.
///
/// # Errors
/// When `done` fails.
pub fn run<E>(plan: &Plan, mut done: impl FnMut(&Trial) -> Result<(), E>) -> Result<Vec<Trial>, E> {
    let mut random = Random::new(plan.seed);
    let mut trials: Vec<Trial> = Vec::new();
    let mut try_one = |trials: &mut Vec<Trial>, stage: Stage, point: Vec<f64>| {
        let base = if stage == Stage::Full { &plan.full } else { &plan.coarse };
        let outcome = match case(base, &point) {
            Ok(mut case) => {
                case.turns = plan.turns;
                Outcome::of(record(&case, |_| ()))
            }
            Err(error) => Outcome::Failed(error.to_string()),
        };
        let trial = Trial {
            index: trials.len(),
            stage: stage.word(),
            point,
            outcome,
        };
        done(&trial)?;
        trials.push(trial);
        Ok(())
    };
    for point in starts() {
        try_one(&mut trials, Stage::Start, point)?;
    }
    for point in latin_hypercube(plan.points, &mut random) {
        try_one(&mut trials, Stage::Screening, point)?;
    }
    for round in 0..plan.rounds {
        let change = FIRST_CHANGE * 0.5_f64.powf(2.0 * round as f64 / plan.rounds.max(1) as f64);
        let parents: Vec<Vec<f64>> = best(&trials, PARENTS).into_iter().map(|t| t.point.clone()).collect();
        if parents.is_empty() {
            break;
        }
        for k in 0..plan.per_round {
            let parent = &parents[k % parents.len()];
            let other = &parents[random.below(parents.len())];
            let point = changed(parent, other, change, &mut random);
            try_one(&mut trials, Stage::Refinement, point)?;
        }
    }
    let finalists: Vec<Vec<f64>> = best(&trials, plan.finalists)
        .into_iter()
        .map(|t| t.point.clone())
        .collect();
    for point in finalists {
        try_one(&mut trials, Stage::Full, point)?;
    }
    Ok(trials)
}

/// The `count` best trials that ran, best first; of equals the earlier one.
fn best<'a>(trials: impl IntoIterator<Item = &'a Trial>, count: usize) -> Vec<&'a Trial> {
    let mut ran: Vec<&Trial> = trials
        .into_iter()
        .filter(|t| matches!(t.outcome, Outcome::Ran { .. }))
        .collect();
    ran.sort_by(|a, b| {
        b.outcome
            .score()
            .0
            .total_cmp(&a.outcome.score().0)
            .then(a.index.cmp(&b.index))
    });
    ran.truncate(count);
    ran
}

/// One value in each of `count` equal parts of every dimension, in random order.
fn latin_hypercube(count: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; DIMENSIONS.len()]; count];
    for dimension in 0..DIMENSIONS.len() {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, random.below(i + 1));
        }
        for (point, part) in points.iter_mut().zip(order) {
            point[dimension] = (part as f64 + random.unit()) / count as f64;
        }
    }
    points
}

/// A parent with some coordinates taken from another parent or moved by about `change`, reflected at the bounds.
fn changed(parent: &[f64], other: &[f64], change: f64, random: &mut Random) -> Vec<f64> {
    parent
        .iter()
        .zip(other)
        .map(|(&own, &others)| {
            if random.unit() >= CHANGED {
                return own;
            }
            if random.unit() < 0.3 {
                return others;
            }
            // Sum of three even numbers: near enough to normal, and bounded.
            let step = (random.unit() + random.unit() + random.unit() - 1.5) * 2.0 * change;
            let moved = (own + step).rem_euclid(2.0);
            (if moved > 1.0 { 2.0 - moved } else { moved }).min(1.0 - 1e-9)
        })
        .collect()
}

/// SplitMix64 (Steele, Lea, Flood, 2014): small, fast, the same everywhere.
struct Random {
    state: u64,
}

impl Random {
    fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0 to 1, 1 excluded.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hypercube_has_one_point_per_part_and_is_seeded() {
        let points = latin_hypercube(16, &mut Random::new(7));
        for dimension in 0..DIMENSIONS.len() {
            let mut parts: Vec<usize> = points.iter().map(|p| (p[dimension] * 16.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..16).collect::<Vec<_>>());
        }
        assert_eq!(points, latin_hypercube(16, &mut Random::new(7)));
        assert_ne!(points, latin_hypercube(16, &mut Random::new(8)));
    }

    #[test]
    fn changes_stay_in_the_cube() {
        let mut random = Random::new(1);
        let parent = vec![0.01; DIMENSIONS.len()];
        let other = vec![0.99; DIMENSIONS.len()];
        for _ in 0..1000 {
            let point = changed(&parent, &other, 0.5, &mut random);
            assert!(point.iter().all(|x| (0.0..1.0).contains(x)), "{point:?}");
        }
    }
}
