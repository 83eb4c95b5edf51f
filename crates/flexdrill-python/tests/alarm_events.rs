//! The alarms of a twin are those of a run that publishes: one session judges both.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::sync::Arc;

use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::{InputState, Inputs};
use flexdrill_core::twin::{Run, RunInputs, Simulation};
use flexdrill_messages::{AlarmEvent, CdrError, from_cdr, topics};
use flexdrill_outputs::{Encoded, schedule};
use flexdrill_python::{Recorder, Twin};
use flexdrill_session::alarms::AlarmBook;
use flexdrill_session::residuals::{Comparison, RigComparison, Samples};
use flexdrill_session::{Host, Session};

/// Four links of the paper's tool.
const SMALL: &str = "
well: {sections: [{arc: {radius: 3.2, build_angle_deg: 11}}], hole_diameter: 0.118}
tool:
  links: 4
  elements_per_link: 2
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118}
";

/// Fast and light: the pipe whirls.
const INPUTS: Inputs = Inputs {
    rotary_speed: 12.0,
    weight_on_bit: 5e3,
    ..Inputs::ZERO
};

/// Model steps: several seconds more than the longest delay of an alarm.
const STEPS: u64 = 24_000;

/// Steps of a period of node and replay.
const PERIOD: u64 = 10;

fn config() -> Arc<Config> {
    Arc::new(Config::from_text("small", SMALL).unwrap())
}

/// A host with topics: it keeps the events that it gets as bytes.
#[derive(Default)]
struct Publishing(Vec<AlarmEvent>);

impl Host for Publishing {
    type Error = CdrError;

    fn send(&mut self, encoded: Encoded<'_>) -> Result<(), CdrError> {
        if encoded.topic.name == topics::ALARM_EVENTS.name {
            self.0.push(from_cdr(encoded.cdr)?);
        }
        Ok(())
    }

    fn measured(&mut self, _: &mut RigComparison, _: u64, _: i64) -> Option<Samples> {
        None
    }

    fn compared(&mut self, _: &Comparison) {}
}

/// The events of a run with all outputs, hosted as a replay hosts it.
fn published(config: &Arc<Config>) -> Vec<AlarmEvent> {
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(config, &config.outputs.rates));
    let (mut frame, mut host) = (run.new_frame(), Publishing::default());
    let mut session = Session::new(Arc::clone(config), AlarmBook::fresh(Arc::clone(config), 0));
    session.begin(0, &mut host).unwrap();
    for step in 0..=STEPS {
        if step > 0 {
            assert!(!matches!(run.advance(), StepOutcome::Failed(_)));
        }
        if step == 0 {
            act(&mut run);
        }
        if !run.due().is_empty() {
            run.capture(&mut frame);
            session.frame(&frame, &mut host).unwrap();
            let stamp = session.instant(frame.ticks).unwrap();
            session.publish_alarms(session.header(stamp), stamp, &mut host).unwrap();
        }
        if step > 0 && step.is_multiple_of(PERIOD) {
            act(&mut run);
        }
    }
    host.0
}

/// Lets the inputs act, with the refinement that the motion asks for.
fn act(run: &mut Run) {
    let inputs = RunInputs {
        inputs: INPUTS,
        refinement: run.wanted_refinement(),
        input_quality: InputState::Ok as u8,
        ..run.applied()
    };
    run.apply(&inputs);
}

fn recorded(twin: &mut Twin, steps: u64) -> Vec<AlarmEvent> {
    // At a rate that no output has: samples end the intervals of the statistics, and the alarms do not depend on them.
    let mut recorder = Recorder::new(["bit"], 30).unwrap();
    twin.advance(&INPUTS, steps, Some(&mut recorder)).unwrap();
    recorder.alarms
}

/// As texts: what is not known of a place is NaN, which is not equal to itself.
fn exact(events: &[AlarmEvent]) -> Vec<String> {
    events.iter().map(|event| format!("{event:?}")).collect()
}

#[test]
fn a_twin_has_the_alarms_of_a_run_that_publishes() {
    let config = config();
    let expected = exact(&published(&config));
    let whirls = |text: &String| text.contains("backward_whirl");
    assert!(expected.iter().any(whirls), "{expected:#?}");
    let mut twin = Twin::new(Arc::clone(&config)).unwrap();
    // In two parts, the second by a fork too: alarms that wait or stand continue in it.
    let mut events = recorded(&mut twin, STEPS / 2 + 7);
    let mut fork = twin.fork();
    let rest = recorded(&mut twin, STEPS - STEPS / 2 - 7);
    assert_eq!(exact(&rest), exact(&recorded(&mut fork, STEPS - STEPS / 2 - 7)));
    events.extend(rest);
    assert_eq!(exact(&events), expected);
    // A run from the start has them again.
    twin.reset();
    assert_eq!(exact(&recorded(&mut twin, STEPS)), expected);
}
