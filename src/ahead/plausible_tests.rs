//! Members that are plausible tools, in a world in which friction decides whether an alarm stands.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::{Answer, Candidate, Ends, Goal, SetPoint, Start, forecast, keep_priority, look_ahead};
use crate::alarms::{AlarmId, AlarmSet};
use crate::ensemble::{Fork, Forks};
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::twin::{Run, Simulation};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_uncertainty::{Priors, Readings};

const TOOLS: u64 = 8;
/// Model time before the look-ahead, and that each member is judged over (s).
const BEFORE: f64 = 6.0;
const HORIZON: f64 = 10.0;

/// A short tool without a string, whose bit swings by what friction does in its joints and contacts. The watch and the
/// warning of stick-slip are at these indices.
fn world([watch, warning]: [f64; 2]) -> Arc<Config> {
    let text = format!(
        "\
well: {{start_inclination_deg: 70, sections: [{{arc: {{radius: 6.4, build_angle_deg: 9}}}}], hole_diameter: 0.118}}
tool:
  links: 6
  elements_per_link: 2
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080}}
  joint: {{limit_deg: 6.0}}
  bit: {{diameter: 0.118}}
environment: {{gravity: 100}}
solver: {{time_step: 0.001, step: fixed}}
stick_slip:
  {{window: 3.0, hysteresis: 1.0e-9, hold_off: 0.0, levels: {{watch: {watch}, warning: {warning}, critical: 9.0}}}}
uncertainty:
  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial, contact.outer.friction_tangential, contact.outer.friction_axial]
      distribution: {{uniform: {{low: 0.2, high: 0.6}}}}
      source: a test
ensemble: {{members: {TOOLS}}}
"
    );
    Arc::new(Config::from_text("world.yaml", &text).unwrap())
}

/// The nominal tool of a configuration at the beginning of a run at 60 r/min and 5 kN.
fn begun(config: &Config) -> Run {
    let settings = config.simulation().with(|settings| {
        settings.initial_inputs.rotary_speed = rpm_to_rad_per_s(60.0);
        settings.initial_inputs.weight_on_bit = kn_to_n(5.0);
    });
    let simulation = Simulation::new(&config.tool(), &settings).unwrap();
    Run::new(simulation, flexdrill_outputs::schedule(config, &config.outputs.rates))
}

/// The tool of a number of a world, some seconds after its start.
fn tool(world: &Arc<Config>, number: u64) -> (Arc<Config>, Run) {
    let config = Arc::new(Priors::of(world).unwrap().member(1, number).unwrap().config);
    let mut run = begun(&config);
    advance(&mut run, BEFORE);
    (config, run)
}

fn advance(run: &mut Run, seconds: f64) {
    let steps = (seconds / run.simulation().settings().time_step).round() as u64;
    for _ in 0..steps {
        assert!(matches!(run.advance(), StepOutcome::Advanced { .. }));
    }
}

/// The largest swing of the bit's speed from a second before the second half of the horizon on, the time in which an alarm of a
/// member that ended may stand: a full run of the tool, without a look-ahead.
fn swing(world: &Arc<Config>, number: u64) -> f64 {
    let (_, mut run) = tool(world, number);
    let mut snapshot = run.simulation().new_snapshot();
    let mut most: f64 = 0.0;
    for look in 1..=(10.0 * HORIZON) as u32 {
        advance(&mut run, 0.1);
        run.look(&mut snapshot);
        if f64::from(look) > 5.0 * HORIZON - 10.0 {
            most = most.max(snapshot.bit.stick_slip_index);
        }
    }
    most
}

fn forks(world: &Arc<Config>, shares: [f64; TOOLS as usize]) -> Forks {
    let tools = (0..TOOLS).map(|number| {
        let (config, run) = tool(world, number);
        Ok(Fork {
            shown: run.applied(),
            config,
            run,
            readings: Readings::default(),
            standing: AlarmSet::EMPTY,
        })
    });
    Forks {
        time: 100.0 + BEFORE,
        tools: tools.collect(),
        shares: shares.into(),
    }
}

fn goal(members: u32) -> Goal {
    Goal {
        candidates: vec![Candidate {
            rotary_speed: 60.0,
            weight_on_bit: 5.0,
            speed_ramp: 0.0,
            weight_ramp: 0.0,
        }],
        horizon: HORIZON,
        members,
        run_all: true,
        ends: Ends::Horizon,
        seed: 3,
    }
}

/// Members that saw stick-slip of medium priority, of those that ended.
fn stuck(answer: &Answer) -> [u32; 2] {
    let of = &answer.candidates[0];
    let seen = of
        .alarms
        .iter()
        .find(|alarm| alarm.id == AlarmId::StickSlip && alarm.priority == Priority::Medium);
    [seen.map_or(0, |alarm| alarm.chance.seen), of.any_alarm.of]
}

/// The share of plausible tools in the answer is the share by direct full runs; by their weights, where these differ; and one
/// that failed is unknown.
#[test]
fn the_share_of_plausible_tools_is_that_of_direct_full_runs() {
    keep_priority();
    // The level lies in the widest gap between the swings of the tools, with two at least on either side.
    let calm = world([7.0, 8.0]);
    let swings: Vec<f64> = (0..TOOLS).map(|number| swing(&calm, number)).collect();
    let mut sorted = swings.clone();
    sorted.sort_by(f64::total_cmp);
    let gap = (1..sorted.len() - 2).max_by(|a, b| {
        let ratio = |at: usize| sorted[at + 1] / sorted[at];
        ratio(*a).total_cmp(&ratio(*b))
    });
    let gap = gap.unwrap();
    let level = (sorted[gap] * sorted[gap + 1]).sqrt();
    // Disturbances of 10 um/s move the largest swing of seconds by less than the gap, or nothing could be said.
    assert!(sorted[gap + 1] > 1.02 * sorted[gap], "{swings:?}");
    let world = world([0.999 * level, level]);
    let sticks: Vec<bool> = swings.iter().map(|swing| *swing > level).collect();
    let expected = sticks.iter().filter(|sticks| **sticks).count() as u32;

    let set_point = SetPoint::new(&world.inputs);
    let begin = |forks: Forks| {
        let twin = begun(&world);
        Start::new(Arc::clone(&world), twin.simulation().fork(), &twin.applied()).among(forks, 3, &set_point)
    };
    let ask = |forks: Forks, members: u32, threads: usize| {
        look_ahead(&begin(forks), &goal(members), threads, &AtomicBool::new(false), |_| {})
    };
    let equal = [1.0 / TOOLS as f64; TOOLS as usize];
    let answer = ask(forks(&world, equal), TOOLS as u32, 2);
    assert_eq!(stuck(&answer), [expected, TOOLS as u32], "{swings:?}, level {level}");
    assert_eq!(answer.candidates[0].tools, TOOLS as u32);
    // The same with another number of threads.
    let again = ask(forks(&world, equal), TOOLS as u32, 1);
    assert_eq!(format!("{answer:?}"), format!("{again:?}"));

    // All weight on those that stick: all members do, and they have no more tools than that.
    let heavy: Vec<f64> = sticks.iter().map(|sticks| f64::from(u8::from(*sticks))).collect();
    let heavy: [f64; TOOLS as usize] = heavy.try_into().unwrap();
    let answer = ask(forks(&world, heavy), 5, 2);
    assert_eq!(stuck(&answer), [5, 5]);
    assert_eq!(answer.candidates[0].tools, expected.min(5));

    // One of them has failed before: it is unknown, and in no probability.
    let mut failed = forks(&world, equal);
    let one = sticks.iter().position(|sticks| *sticks).unwrap();
    failed.tools[one] = Err("it failed, so that what would come is unknown".to_owned());
    failed.shares = failed
        .tools
        .iter()
        .map(|tool| f64::from(u8::from(tool.is_ok())) / 7.0)
        .collect();
    let answer = ask(failed, TOOLS as u32, 2);
    assert_eq!(stuck(&answer), [expected - 1, TOOLS as u32 - 1]);
    let of = &answer.candidates[0];
    assert_eq!((of.members, of.failed, of.tools), (TOOLS as u32, 1, TOOLS as u32));
    assert!(of.failure.contains("unknown"), "{}", of.failure);
}

/// A forecast from plausible tools begins at their instant, counted from the start of the twin.
#[test]
fn a_forecast_from_plausible_tools_has_the_seconds_of_the_twin() {
    keep_priority();
    let world = world([7.0, 8.0]);
    let twin = begun(&world);
    let start = Start::new(Arc::clone(&world), twin.simulation().fork(), &twin.applied());
    let mut two = forks(&world, [0.5; TOOLS as usize]);
    two.tools.truncate(2);
    two.shares.truncate(2);
    let start = start.among(two, 1, &SetPoint::new(&world.inputs));
    let found = forecast(&start, 2, 1, 2, &AtomicBool::new(false)).unwrap();
    assert_eq!((found.first, found.tools, found.members), (107, 2, 2));
    // Each second has values: they lie in the seconds that it counts.
    assert!(found.seconds.iter().flatten().all(|band| band.quantiles[1].is_finite()));
}
