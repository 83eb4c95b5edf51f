//! The seeded plan: a Latin hypercube, then descents from the best points that lie apart, then the best with the full
//! record.

use super::descent::Descent;
use super::outcome::{Outcome, Trial};
use super::random::Random;
use super::space::{DIMENSIONS, Scale, case, starts, written};
use flexdrill_config::Config;
use flexdrill_paper::{Setup, record};

/// How much is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Coarse mesh, for the Latin hypercube: bounds and everything that the space does not change come from it.
    pub coarse: Config,
    /// Full mesh.
    pub full: Config,
    /// Points of the Latin hypercube.
    pub points: usize,
    /// Descents, from the best trials that lie apart.
    pub descents: usize,
    /// Generations of a descent.
    pub generations: usize,
    /// Trials per generation.
    pub per_generation: usize,
    /// Best trials run again with the full record.
    pub finalists: usize,
    /// Seed.
    pub seed: u64,
    /// Turns recorded per trial.
    pub turns: f64,
    /// Turns recorded of the finalists.
    pub full_turns: f64,
}

impl Plan {
    /// Trials of the whole plan, if enough of them run.
    pub fn total(&self) -> usize {
        starts().len() + self.points + self.descents * self.generations * self.per_generation + self.finalists
    }
}

/// The best trial of every stage that had one.
pub fn leaders(trials: &[Trial]) -> Vec<(&'static str, &Trial)> {
    [Stage::Start, Stage::Screening, Stage::Descent, Stage::Confirmation]
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
    /// Values with reasons; full mesh.
    Start,
    /// Latin hypercube; coarse mesh.
    Screening,
    /// Descents; full mesh.
    Descent,
    /// The best, full mesh and full record.
    Confirmation,
}

impl Stage {
    /// As the table says it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Screening => "screening",
            Self::Descent => "descent",
            Self::Confirmation => "confirmation",
        }
    }
}

/// Runs the plan. `known` gives the outcome of a trial that an earlier run of the same plan has done, from its number
/// and parameters as written; `done` is given every trial as it ends, in order.
///
/// # Errors
/// When `known` or `done` fails.
pub fn run<E>(
    plan: &Plan,
    mut known: impl FnMut(usize, Stage, &[String]) -> Result<Option<Outcome>, E>,
    mut done: impl FnMut(&Trial) -> Result<(), E>,
) -> Result<Vec<Trial>, E> {
    let mut random = Random::new(plan.seed);
    let mut trials: Vec<Trial> = Vec::new();
    let mut try_one = |trials: &mut Vec<Trial>, stage: Stage, point: Vec<f64>| {
        // Parameters are compared as written: a table read back has no more digits than it was written with.
        let parameters: Vec<String> = DIMENSIONS.iter().zip(&point).map(|(d, &at)| written(d, at)).collect();
        let outcome = match known(trials.len(), stage, &parameters)? {
            Some(outcome) => outcome,
            None => outcome(plan, stage, &point),
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
    // The order of the plan fixes the numbers of the trials, by which an earlier table is recognised.
    for point in starts() {
        try_one(&mut trials, Stage::Start, point)?;
    }
    for point in latin_hypercube(plan.points, &mut random) {
        try_one(&mut trials, Stage::Screening, point)?;
    }
    let mut descents = descents(&trials, plan.descents);
    for _ in 0..plan.generations {
        // Turn by turn, so that a search that is stopped has gone equally far with each.
        for descent in &mut descents {
            let first = trials.len();
            for _ in 0..plan.per_generation {
                let point = descent.sample(&mut random);
                try_one(&mut trials, Stage::Descent, point)?;
            }
            let mut ranked: Vec<&Trial> = trials[first..].iter().collect();
            ranked.sort_by(|a, b| better(a, b));
            descent.learn(&ranked.iter().map(|trial| trial.point.as_slice()).collect::<Vec<_>>());
        }
    }
    // Finalists come from the full mesh only, since the order of coarse trials may differ.
    let on_full_mesh = trials.iter().filter(|trial| trial.stage == Stage::Descent.word());
    let finalists: Vec<Vec<f64>> = best(on_full_mesh, plan.finalists)
        .into_iter()
        .map(|trial| trial.point.clone())
        .collect();
    for point in finalists {
        try_one(&mut trials, Stage::Confirmation, point)?;
    }
    Ok(trials)
}

fn outcome(plan: &Plan, stage: Stage, point: &[f64]) -> Outcome {
    let base = match stage {
        Stage::Screening => &plan.coarse,
        Stage::Start | Stage::Descent | Stage::Confirmation => &plan.full,
    };
    match case(base, point) {
        Ok(mut case) => {
            if stage == Stage::Confirmation {
                case.turns = plan.full_turns;
                case.settling_turns = Setup::new(case.config.clone()).settling_turns;
            } else {
                case.turns = plan.turns;
            }
            Outcome::of(record(&case, |_| ()))
        }
        Err(error) => Outcome::Failed(error.to_string()),
    }
}

/// Distance of the descents' first points in the unit cube: a little more than half of that of two random points,
/// sqrt(n / 6).
const APART: f64 = 1.0;

/// From the best trials that lie apart.
fn descents(trials: &[Trial], count: usize) -> Vec<Descent> {
    let moves = |k: &usize| !matches!(DIMENSIONS[*k].scale, Scale::Choice(_));
    let free: Vec<usize> = (0..DIMENSIONS.len()).filter(moves).collect();
    let mut chosen: Vec<&Trial> = Vec::new();
    for trial in best(trials, trials.len()) {
        let apart = |other: &&Trial| {
            let squares = trial.point.iter().zip(&other.point).map(|(a, b)| (a - b).powi(2));
            squares.sum::<f64>() >= APART * APART
        };
        if chosen.len() < count && chosen.iter().all(apart) {
            chosen.push(trial);
        }
    }
    chosen
        .iter()
        .map(|trial| Descent::new(&trial.point, free.clone()))
        .collect()
}

/// The `count` best trials that ran, best first; of equals the earlier one.
fn best<'a>(trials: impl IntoIterator<Item = &'a Trial>, count: usize) -> Vec<&'a Trial> {
    let mut ran: Vec<&Trial> = trials.into_iter().filter(|trial| trial.outcome.ran()).collect();
    ran.sort_by(|a, b| better(a, b));
    ran.truncate(count);
    ran
}

/// Higher score first, of equals the earlier one.
fn better(a: &Trial, b: &Trial) -> std::cmp::Ordering {
    let [(score_a, _), (score_b, _)] = [a, b].map(|trial| trial.outcome.score());
    score_b.total_cmp(&score_a).then(a.index.cmp(&b.index))
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
}
