//! A map: which of its points to run, and what they say together.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::rounds::{Ran, Rounds};
use super::shared::Shared;
use super::states::Key;
use super::{point, program};
use crate::ahead::Chance;
use flexdrill_alarms::Priority;
use flexdrill_config::{Config, ConfigError};
use flexdrill_sweep::choice::Class;
use flexdrill_sweep::map::{Axis, Cell, FORMAT, Map, OfStart, Origin, ROTARY_SPEED, Start, Verdict, WEIGHT_ON_BIT};
use flexdrill_sweep::plan::{self, Fast, Grid, Plan, Point, Running, Runs};
use flexdrill_sweep::{Directory, Outcome, SweepError};
use serde_json::Value;

/// What is asked of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Keys of the axes with their values.
    pub axes: [(String, Vec<f64>); 2],
    /// Model time that each member is judged over (s).
    pub horizon: f64,
    /// Members per cell and start, at most.
    pub members: u32,
    /// Whether all of these run, also where the first ones decide every alarm.
    pub run_all: bool,
    /// Whether members end with their first alarm that counts, or once calm, and cells away from others have one member.
    pub fast: bool,
    /// Whether members are plausible tools.
    pub plausible: bool,
    /// Seed of the disturbances.
    pub seed: u64,
    /// State that the start from running comes from; its speed is the highest of the axes if not given.
    pub running_rpm: Option<f64>,
    /// Time at this speed (s).
    pub running_time: f64,
    /// Priority from which on an alarm counts.
    pub priority: Priority,
    /// Chance above which an alarm must be expected.
    pub limit: f64,
    /// Largest share of the grid's runs, 0 to 1; 1 runs every cell.
    pub share: f64,
}

/// Model time (s) after which a member of a fast map ends where it is calm: below 25 s, alarms of the way to the values count
/// as those of the values (`docs/safe_window.md`).
const CALM_AFTER: f64 = 30.0;

/// How far a map is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Runs with a result.
    pub done: usize,
    /// Most runs of the map.
    pub most: usize,
    /// Runs among the done that this call computed.
    pub here: usize,
}

/// The plan of a map: all cells of its grid, from all starts.
///
/// # Errors
/// When a value of the axes is out of the configuration's bounds, or the configuration cannot be written.
pub fn plan(name: &str, config: &Config, question: &Question) -> Result<Plan, SweepError> {
    let [(x, columns), (y, rows)] = &question.axes;
    // The order is that of the map's cells: rows outside, columns inside.
    let cells = rows
        .iter()
        .flat_map(|y| columns.iter().map(move |x| vec![Value::from(*x), Value::from(*y)]));
    let speeds = question.axes.iter().find(|(key, _)| key == ROTARY_SPEED);
    let highest = speeds.and_then(|(_, values)| values.iter().copied().reduce(f64::max));
    let program = program();
    let plan = Plan {
        format: plan::FORMAT,
        runs: Runs {
            program: program.name,
            arithmetic: program.arithmetic,
            configuration: config.to_yaml().map_err(|error| SweepError::Damaged {
                path: name.into(),
                reason: error.to_string(),
            })?,
            hash: config.hash(),
            horizon: question.horizon,
            members: question.members,
            run_all: question.run_all,
            fast: question.fast.then(|| Fast {
                first_alarm: question.priority,
                calm_after: CALM_AFTER.min(question.horizon),
                limit: question.limit,
                // What all tools are in all cells differs in their order alone.
                turns: if question.plausible { question.members } else { 1 },
            }),
            plausible: question.plausible,
            // A start at a running tool comes from the highest speed of the map by default, the state with most motion.
            running: Running {
                rpm: question
                    .running_rpm
                    .or(highest)
                    .unwrap_or(config.inputs.rotary_speed.max_rpm),
                time: question.running_time,
            },
            alarms: program.alarms,
            figures: program.figures,
        },
        keys: vec![x.clone(), y.clone()],
        rows: cells.collect(),
        starts: Start::ALL.to_vec(),
        seeds: vec![question.seed],
        map: Some(Grid {
            columns: columns.len(),
            rows: rows.len(),
        }),
        // The grid makes the sweep a map; other sweeps have rows only.
    };
    // Checked before any run: a point out of the bounds would fail after hours.
    plan.check_rows(name, config)?;
    Ok(plan)
}

/// What a map is made of.
#[derive(Clone, Copy)]
pub struct Study<'a> {
    /// The tool.
    pub config: &'a Config,
    /// What is asked of it.
    pub question: &'a Question,
    /// States that several cells begin from.
    pub shared: &'a Arc<Shared>,
}

/// Makes a map in a directory, on `jobs` threads; results that are there are used. Returns nothing when `stop` is set:
/// then the same call continues later.
///
/// The same plan and question give the same map, with any number of threads and interruptions.
///
/// # Errors
/// When the directory has another plan, or a file cannot be written or read or is damaged.
pub fn make(
    out: &Path,
    plan: &Plan,
    study: Study<'_>,
    jobs: usize,
    stop: &AtomicBool,
    progress: impl FnMut(Progress),
) -> Result<Option<Map>, SweepError> {
    let Study {
        config,
        question,
        shared,
    } = study;
    let rounds = Rounds {
        share: question.share,
        jobs,
        stop,
        compute: |plan: &Plan, point: &Point| point::run(plan, config, point, shared, stop),
        class: |outcome: &Outcome| class(outcome, question),
    };
    let Some(ran) = rounds.make(out, plan, progress)? else {
        return Ok(None);
    };
    Ok(Some(assemble(config, question, shared, ran)))
}

/// The alarm that most members saw among those that count: its identifier.
fn worst<'a>(outcome: &'a Outcome, question: &Question) -> Option<&'a str> {
    let counted = outcome
        .alarms
        .iter()
        .filter(|count| count.priority == question.priority);
    counted
        .rev()
        .max_by_key(|count| count.seen)
        .map(|count| count.alarm.as_str())
}

/// How many of the members that ended saw any alarm that counts. Two alarms of 10 % each may disturb a fifth of all runs, so
/// that the likeliest alone does not judge a cell.
fn chance(outcome: &Outcome, question: &Question) -> Option<Chance> {
    let seen = outcome.any_alarm[question.priority as usize];
    (outcome.ended() > 0).then(|| Chance::new(seen, outcome.ended()))
}

/// What a run says of its cell.
pub fn class(outcome: &Outcome, question: &Question) -> Class {
    match chance(outcome, question) {
        Some(chance) if chance.probability > question.limit => Class::Expected,
        Some(_) if outcome.failed == 0 => Class::Clear,
        _ => Class::Unknown,
    }
}

fn assemble(config: &Config, question: &Question, shared: &Shared, ran: Ran) -> Map {
    let Ran {
        plan,
        mut choice,
        outcomes,
        first_looks,
    } = ran;
    // What a run says stands before what its neighbours do.
    let inferred: Vec<_> = (0..plan.starts.len()).map(|start| choice.inferred(start)).collect();
    let cells = plan.rows.iter().enumerate().map(|(cell, row)| {
        let starts: Vec<OfStart> = (0..plan.starts.len())
            .map(|start| match (&outcomes[start][cell], inferred[start][cell]) {
                (Some(outcome), _) => known(outcome, question),
                (None, Some(cell)) => cell.of_start(),
                (None, None) => OfStart::not_known(0.0),
            })
            .collect();
        let value = |at: usize| row.get(at).and_then(Value::as_f64).unwrap_or(f64::NAN);
        Cell {
            x: value(0),
            y: value(1),
            verdict: Verdict::of(&starts),
            starts,
        }
    });
    let cells: Vec<Cell> = cells.collect();
    // Rows of the plan have x within y: the first row of cells has the values along x.
    let columns = plan.map.map_or(0, |grid| grid.columns);
    let along_x = cells.iter().take(columns).map(|cell| cell.x).collect();
    let along_y = cells.iter().step_by(columns.max(1)).map(|cell| cell.y).collect();
    Map {
        format: FORMAT,
        program: plan.runs.program.clone(),
        title: config.run.title.clone(),
        configuration: plan.runs.hash.clone(),
        motion: config.motion_hash(),
        x: axis(config, &plan.keys[0], along_x),
        y: axis(config, &plan.keys[1], along_y),
        horizon: plan.runs.horizon,
        members: plan.runs.members,
        run_all: plan.runs.run_all,
        first_alarm: plan.runs.fast.is_some(),
        plausible: plan.runs.plausible,
        posterior: shared.sample(),
        seed: question.seed,
        priority: question.priority,
        limit: question.limit,
        starts: plan.starts.clone(),
        runs: choice.runs() as u32,
        first_looks: first_looks as u32,
        model_time: model_time(config, &plan, &outcomes),
        cells,
    }
}

/// Model time of all members, and of the states that they began from, each once.
fn model_time(config: &Config, plan: &Plan, outcomes: &[Vec<Option<Outcome>>]) -> f64 {
    let mut begun = BTreeMap::new();
    let mut members = 0.0;
    for (start, of) in plan.starts.iter().zip(outcomes) {
        let running = (*start == Start::Running).then_some(&plan.runs.running);
        for (row, outcome) in of.iter().enumerate() {
            let Some(outcome) = outcome else { continue };
            members += outcome.model_time;
            // A row that the configuration refuses has begun nothing.
            let Ok(own) = plan.config(config, row) else { continue };
            for state in &outcome.begun {
                let tool = state
                    .tool
                    .map(|tool| (plan.seeds.first().copied().unwrap_or_default(), tool));
                begun.insert(Key::of(&own, config, running, tool), state.time);
            }
        }
    }
    members + begun.values().sum::<f64>()
}

fn known(outcome: &Outcome, question: &Question) -> OfStart {
    let chance = chance(outcome, question);
    OfStart {
        state: if chance.is_some() {
            Origin::Known
        } else {
            Origin::Unknown
        },
        expected: class(outcome, question) == Class::Expected,
        confidence: if chance.is_some() { 1.0 } else { 0.0 },
        chance: chance.map(|chance| chance.probability),
        interval: Chance::new(chance.map_or(0, |chance| chance.seen), outcome.ended()).interval,
        alarm: worst(outcome, question).unwrap_or_default().to_owned(),
        members: outcome.members,
        failed: outcome.failed,
        failure: outcome.failure.clone(),
        alarms: outcome.alarms.clone(),
        figures: if outcome.members > 0 {
            outcome.figures.clone()
        } else {
            Vec::new()
        },
    }
}

/// An axis with the name and unit of its key.
fn axis(config: &Config, key: &str, values: Vec<f64>) -> Axis {
    let unit = config
        .numbers()
        .into_iter()
        .find(|number| number.key == key)
        .map_or("", |number| number.unit);
    let name = match key {
        ROTARY_SPEED => "rotary speed",
        WEIGHT_ON_BIT => "weight on bit",
        key => key,
    };
    Axis {
        key: key.to_owned(),
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    }
}

/// Reads the configuration of a plan.
///
/// # Errors
/// When it is not that of the plan's hash, or is refused by this version.
pub fn configuration(directory: &Directory) -> Result<Config, SweepError> {
    let runs = &directory.plan().runs;
    let path = directory.path().join(flexdrill_sweep::directory::PLAN);
    let read: Result<Config, ConfigError> = Config::from_text(&path.display().to_string(), &runs.configuration);
    let config = read?;
    if config.hash() == runs.hash {
        return Ok(config);
    }
    Err(SweepError::Damaged {
        path,
        reason: "its configuration is not the one of its hash".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_sweep::map::AlarmCount;

    fn question(priority: Priority) -> Question {
        Question {
            axes: [ROTARY_SPEED, WEIGHT_ON_BIT].map(|key| (key.to_owned(), vec![1.0, 2.0])),
            horizon: 30.0,
            members: 20,
            run_all: true,
            fast: false,
            plausible: false,
            seed: 1,
            running_rpm: None,
            running_time: 10.0,
            priority,
            limit: 0.1,
            share: 0.4,
        }
    }

    /// Twenty members: two alarms, each seen by two of them, which are not the same.
    fn outcome(failed: u32) -> Outcome {
        let ended = 20 - failed;
        let count = |alarm: &str, priority| AlarmCount {
            alarm: alarm.to_owned(),
            priority,
            seen: 2,
            of: ended,
            interval: Chance::new(2, ended).interval,
            first: Some(7.0),
        };
        Outcome {
            members: 20,
            failed,
            failure: String::new(),
            run_up: Some(1.0),
            model_time: 0.0,
            begun: Vec::new(),
            any_alarm: [4, 2, 0],
            alarms: vec![
                count("backward_whirl", Priority::Low),
                count("shock", Priority::Low),
                count("shock", Priority::Medium),
            ],
            figures: Vec::new(),
            quality: [ended, 0, 0],
        }
    }

    #[test]
    fn a_cell_is_judged_by_any_alarm_that_counts() {
        // Each alarm has a chance of 10 %, which is not above the limit; a fifth of the runs has one of them.
        let any = known(&outcome(0), &question(Priority::Low));
        assert_eq!((any.expected, any.chance), (true, Some(0.2)));
        assert_eq!(any.interval, Chance::new(4, 20).interval);
        assert_eq!(any.alarm, "backward_whirl");
        let medium = known(&outcome(0), &question(Priority::Medium));
        assert_eq!((medium.expected, medium.chance), (false, Some(0.1)));
        assert_eq!(class(&outcome(0), &question(Priority::High)), Class::Clear);
        // One member that failed may have had what the limit excludes.
        assert_eq!(class(&outcome(1), &question(Priority::High)), Class::Unknown);
        let none = known(&outcome(20), &question(Priority::High));
        assert_eq!(
            (none.state, none.interval, none.confidence),
            (Origin::Unknown, [0.0, 1.0], 0.0)
        );
    }
}
