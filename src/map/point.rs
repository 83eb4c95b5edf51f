//! One point of a sweep, computed with the twin.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::shared::{Looked, Shared};
use super::states::{Key, State};
use crate::ahead::{Candidate, CandidateAnswer, Ends, Figure, Goal, NoTool, Start as Begin, look_further};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{Run, RunInputs, Simulation};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_outputs::schedule;
use flexdrill_sweep::map::{self, AlarmCount, Start};
use flexdrill_sweep::outcome::Begun;
use flexdrill_sweep::plan::Running;
use flexdrill_sweep::{Outcome, Plan, Point};
use flexdrill_uncertainty::{Readings, UncertaintyError};

/// Model time between two looks at the refinement that the motion asks for (s), as in the node.
const PERIOD: f64 = 5e-3;
/// Longest way to the speed that a start comes from (s), as for a look-ahead's candidate.
const LONGEST_WAY: f64 = 300.0;

/// Computes a point of a plan whose configuration is `base`; nothing when `stop` is set. What fails is part of the
/// outcome. The outcome is the same whatever other points have shared before.
pub fn run(plan: &Plan, base: &Config, point: &Point, shared: &Arc<Shared>, stop: &AtomicBool) -> Option<Outcome> {
    let config = match plan.config(base, point.row) {
        Ok(config) => Arc::new(config),
        Err(error) => return Some(unknown(plan, error.to_string())),
    };
    let candidate = Candidate {
        rotary_speed: config.inputs.rotary_speed.initial_rpm,
        weight_on_bit: config.inputs.weight_on_bit.initial_kn,
        speed_ramp: 0.0,
        weight_ramp: 0.0,
    };
    let running = (point.start == Start::Running).then_some(&plan.runs.running);
    // Plausible tools have their own states: of the configuration's tool only what it is counts then.
    let nominal = running.filter(|_| !plan.runs.plausible);
    let begun = shared.states.fork(Key::of(&config, base, nominal, None), || {
        begin(&config, nominal, candidate.weight_on_bit, Readings::default(), stop)
    });
    let state = match begun {
        Ok(state) => state,
        Err(NoTool::Unknown(why)) => return Some(unknown(plan, why)),
        Err(NoTool::Stopped) => return None,
    };
    let own = Begun {
        tool: None,
        time: state.0.simulation().time(),
    };
    let mut start = started(&config, state, Readings::default());
    // The first member of a fast map's run was its look, if this process made it.
    let is_look = plan.runs.fast.is_some() && plan.runs.members == 1;
    let looked = match plan.runs.fast {
        Some(_) if !is_look => shared.look(point),
        _ => Looked::default(),
    };
    let made = Arc::new(Mutex::new(looked.begun));
    if plan.runs.plausible {
        match tools(plan, base, point, &config, shared, Arc::clone(&made)) {
            Ok(tools) => start = start.with_tools(tools),
            Err(error) => return Some(unknown(plan, error.to_string())),
        }
    }
    let goal = Goal {
        candidates: vec![candidate],
        horizon: plan.runs.horizon,
        members: plan.runs.members,
        run_all: plan.runs.run_all,
        ends: plan.runs.fast.map_or(Ends::Horizon, |fast| Ends::FirstAlarm {
            least: fast.first_alarm,
            calm_after: fast.calm_after,
            limit: fast.limit,
        }),
        seed: point.seed,
    };
    let (answer, members) = look_further(&start, &goal, looked.members, 1, stop, |_| {});
    if answer.stopped {
        return None;
    }
    let answer = answer.candidates.first()?;
    // Of members that began and do not count, the answer says nothing.
    let made = made.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let of_tools = made.range(..answer.members).map(|(_, begun)| *begun);
    let begun = of_tools.chain([own]).filter(|begun| begun.time > 0.0).collect();
    if is_look {
        shared.keep_look(point, Looked { members, begun: made });
    }
    Some(Outcome {
        begun,
        ..outcome(answer)
    })
}

/// The plausible tools that the members of a point are, each in the state that it starts from; `made` gets what these took.
///
/// # Errors
/// When the configuration has no priors.
fn tools(
    plan: &Plan,
    base: &Config,
    point: &Point,
    config: &Arc<Config>,
    shared: &Arc<Shared>,
    made: Arc<Mutex<BTreeMap<u32, Begun>>>,
) -> Result<impl Fn(u32, &AtomicBool) -> Result<Begin, NoTool> + Send + Sync + use<>, UncertaintyError> {
    let priors = shared.priors(config)?;
    let (seed, row, running) = (point.seed, point.row, plan.runs.running);
    let running = (point.start == Start::Running).then_some(running);
    let numbers: Vec<u32> = (0..plan.runs.members).map(|member| plan.tool(row, member)).collect();
    let (shared, base, config) = (Arc::clone(shared), base.clone(), Arc::clone(config));
    let kn = config.inputs.weight_on_bit.initial_kn;
    Ok(move |member: u32, stop: &AtomicBool| {
        // A tool of a number is the same in all cells: what differs between cells is speed and weight alone.
        let tool = numbers.get(member as usize).copied().unwrap_or(member);
        let drawn = priors.member(seed, u64::from(tool));
        let drawn = drawn.map_err(|error| NoTool::Unknown(error.to_string()))?;
        let (readings, own) = (Readings::of(&drawn), Arc::new(drawn.config));
        let key = Key::of(&config, &base, running.as_ref(), Some((seed, tool)));
        let state = shared
            .states
            .fork(key, || begin(&own, running.as_ref(), kn, readings, stop))?;
        let begun = Begun {
            tool: Some(tool),
            time: state.0.simulation().time(),
        };
        made.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(member, begun);
        Ok(started(&own, state, readings))
    })
}

/// The state that a point starts from: at rest without weight, or running under the weight that the rig shows.
fn begin(
    config: &Arc<Config>,
    running: Option<&Running>,
    kn: f64,
    readings: Readings,
    stop: &AtomicBool,
) -> Result<State, NoTool> {
    let mut settings = config.simulation();
    settings.initial_inputs = Inputs {
        rotary_speed: 0.0,
        weight_on_bit: 0.0,
        ..settings.initial_inputs
    };
    let simulation = Simulation::new(&config.tool(), &settings).map_err(|error| NoTool::Unknown(error.to_string()))?;
    let mut run = Run::new(simulation, schedule(config, &config.outputs.rates));
    let slew = run.applied().slew;
    if let Some(running) = running {
        let target = Inputs {
            rotary_speed: rpm_to_rad_per_s(running.rpm),
            weight_on_bit: kn_to_n(kn),
            ..run.applied().inputs
        };
        let acts = readings.acting(&RunInputs {
            inputs: target,
            ..run.applied()
        });
        run.apply(&acts);
        let target = acts.inputs;
        let arrived = |run: &Run| {
            let applied = run.simulation().applied();
            applied.rotary_speed == target.rotary_speed && applied.weight_set == target.weight_on_bit
        };
        while !arrived(&run) {
            if run.simulation().time() > LONGEST_WAY {
                let why = format!("speed or weight did not reach the start's within {LONGEST_WAY} s");
                return Err(NoTool::Unknown(why));
            }
            advance(&mut run, stop)?;
        }
        let end = run.simulation().time() + running.time;
        while run.simulation().time() < end {
            advance(&mut run, stop)?;
        }
    }
    // What a candidate asks for has the configured slew limits as the rig shows them.
    let applied = RunInputs { slew, ..run.applied() };
    Ok((run, applied))
}

/// A look-ahead's start from a state, which is the tool's own.
fn started(config: &Arc<Config>, (run, applied): State, readings: Readings) -> Begin {
    Begin::new(Arc::clone(config), run.simulation().fork(), &applied).on_rig(readings)
}

/// Advances by a period.
fn advance(run: &mut Run, stop: &AtomicBool) -> Result<(), NoTool> {
    if stop.load(Ordering::Relaxed) {
        return Err(NoTool::Stopped);
    }
    let refinement = run.wanted_refinement();
    if refinement != run.applied().refinement {
        run.apply(&RunInputs {
            refinement,
            ..run.applied()
        });
    }
    let steps = (PERIOD / run.simulation().settings().time_step).round().max(1.0) as u64;
    for _ in 0..steps {
        if let StepOutcome::Failed(failure) = run.advance() {
            return Err(NoTool::Unknown(format!(
                "a step failed, so that the rest is unknown: {failure}"
            )));
        }
    }
    Ok(())
}

/// An outcome of which nothing is known.
fn unknown(plan: &Plan, failure: String) -> Outcome {
    let none = |(name, unit): &(String, String)| map::Figure {
        name: name.clone(),
        unit: unit.clone(),
        quantiles: None,
    };
    Outcome {
        members: 0,
        failed: 0,
        failure,
        run_up: None,
        model_time: 0.0,
        begun: Vec::new(),
        any_alarm: [0; 3],
        alarms: Vec::new(),
        figures: plan.runs.figures.iter().map(none).collect(),
        quality: [0; 3],
    }
}

fn outcome(answer: &CandidateAnswer) -> Outcome {
    let finite = |value: f64| value.is_finite().then_some(value);
    let figures = Figure::ALL.into_iter().zip(&answer.figures);
    Outcome {
        members: answer.members,
        failed: answer.failed,
        failure: answer.failure.clone(),
        run_up: finite(answer.run_up),
        model_time: answer.model_time,
        begun: Vec::new(),
        any_alarm: answer.any_by_priority,
        alarms: answer
            .alarms
            .iter()
            .map(|alarm| AlarmCount {
                alarm: alarm.id.id().to_owned(),
                priority: alarm.priority,
                seen: alarm.chance.seen,
                of: alarm.chance.of,
                interval: alarm.chance.interval,
                first: finite(alarm.first),
            })
            .collect(),
        figures: figures
            .map(|(figure, band)| {
                let (name, unit) = figure.name_and_unit();
                let known = band.quantiles.iter().all(|value| value.is_finite());
                map::Figure {
                    name: name.to_owned(),
                    unit: unit.to_owned(),
                    quantiles: known.then_some(band.quantiles),
                }
            })
            .collect(),
        quality: answer.quality,
    }
}
