//! The solver against a clock that the test moves and a model that fails when told to.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::RealTimeLoop;
use crate::clock::Clock;
use crate::link::{Command, Gauges, LoopEvent, PublisherEnd, RunState, Targets, link};
use flexdrill_core::dynamics::outcome::{FailureCause, StepFailure, StepOutcome};
use flexdrill_core::dynamics::phases::PhaseTimes;
use flexdrill_core::dynamics::scheme::Scheme;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, LiveParameters};
use flexdrill_core::twin::{BuildError, Model, Run, RunInputs, Schedule, SimulationSettings, Snapshot};

const MS: u64 = 1_000_000;
const START: u64 = 1_000_000 * MS;
/// The scripted model does not converge at speeds above this.
const TOO_FAST: f64 = 100.0;

struct ScriptedModel {
    settings: SimulationSettings,
    live: LiveParameters,
    step: u64,
}

impl Model for ScriptedModel {
    fn settings(&self) -> &SimulationSettings {
        &self.settings
    }
    fn advance(&mut self, inputs: &Inputs) -> StepOutcome {
        if inputs.rotary_speed > TOO_FAST {
            return StepOutcome::Failed(StepFailure {
                cause: FailureCause::NotConverged,
                time: 0.0,
                step: 1e-3,
                station: 7,
                body: Body::Pipe,
                value: 1.0,
            });
        }
        self.step += 1;
        StepOutcome::Advanced {
            iterations: 2,
            halvings: 0,
        }
    }
    fn step(&self) -> u64 {
        self.step
    }
    fn new_snapshot(&self) -> Snapshot {
        Snapshot::default()
    }
    fn snapshot(&mut self, out: &mut Snapshot, _end_interval: bool) {
        out.step = self.step;
    }
    fn live(&self) -> LiveParameters {
        self.live
    }
    fn set_live(&mut self, live: LiveParameters) {
        self.live = live;
    }
    fn set_slew(&mut self, rotary_speed: f64, _weight_on_bit: f64) {
        self.settings.rotary_speed_slew = rotary_speed;
    }
    fn set_whirl(&mut self, _whirl: &flexdrill_core::motion::WhirlSettings) {}
    fn set_input_trust(&mut self, _: f64) {}
    fn reset(&mut self) {
        self.step = 0;
    }
    fn phase_times(&self) -> PhaseTimes {
        PhaseTimes::from_nanoseconds(|phase| self.step * (3 + phase as u64))
    }
    fn checkpoint(&self) -> Result<Vec<u8>, BuildError> {
        Ok(vec![self.step as u8])
    }
}

#[derive(Clone)]
struct ScriptedClock {
    now: Arc<AtomicU64>,
}

impl Clock for ScriptedClock {
    fn now(&self) -> u64 {
        self.now.load(Ordering::Relaxed)
    }
    fn wait_until(&self, deadline: u64) {
        self.now.fetch_max(deadline, Ordering::Relaxed);
    }
    fn rig_time(&self) -> u64 {
        START
    }
    fn tolerance(&self) -> f64 {
        0.02
    }
}

/// 1 ms steps, 5 per period, every output due every 10 steps.
struct Bench {
    solver: RealTimeLoop<ScriptedClock, ScriptedModel>,
    publisher: PublisherEnd,
    commands: rtrb::Producer<Command>,
    targets: Arc<Targets>,
    gauges: Arc<Gauges>,
    clock: ScriptedClock,
}

impl Bench {
    fn new() -> Self {
        let settings = SimulationSettings {
            time_step: 1e-3,
            scheme: Scheme::newmark(0.6),
            max_iterations: 30,
            max_halvings: 4,
            initial_inputs: Inputs {
                rotary_speed: 1.0,
                weight_on_bit: 2.0,
            },
            rotary_speed_slew: 1.0,
            weight_on_bit_slew: 1.0,
            whirl: Default::default(),
            stick_slip: Default::default(),
            shock: Default::default(),
            watched: Vec::new(),
            whirl_sample_interval: 5e-3,
        };
        let targets = Targets::new(settings.initial_inputs);
        let gauges = Arc::new(Gauges::default());
        let (end, publisher, commands) = link(Arc::clone(&targets), Arc::clone(&gauges));
        let clock = ScriptedClock {
            now: Arc::new(AtomicU64::new(MS)),
        };
        let live = LiveParameters {
            inner_friction: [0.2; 2],
            outer_friction: [0.3; 2],
            bit_friction_factor: 0.235,
        };
        let run = Run::new(
            ScriptedModel {
                settings,
                live,
                step: 0,
            },
            Schedule::new(1e-3, |_| 100.0),
        );
        let solver = RealTimeLoop::new(run, clock.clone(), end, 5);
        Self {
            solver,
            publisher,
            commands,
            targets,
            gauges,
            clock,
        }
    }

    /// One period, which takes `time` (ns).
    fn period(&mut self, time: u64) {
        self.clock
            .now
            .fetch_max(self.solver.pacer.deadline(), Ordering::Relaxed);
        self.clock.now.fetch_add(time, Ordering::Relaxed);
        self.solver.run_period();
    }

    fn speed(&self, rotary_speed: f64) {
        self.targets.set(
            Inputs {
                rotary_speed,
                weight_on_bit: 2.0,
            },
            1,
        );
    }

    /// What was reported since the last call, in short; frames are given back.
    fn reports(&mut self) -> Vec<String> {
        let mut told = Vec::new();
        while let Ok(report) = self.publisher.events.pop() {
            told.push(match report {
                LoopEvent::Frame(frame) => {
                    let text = format!("frame {} at {}", frame.snapshot.step, frame.ticks);
                    self.publisher.empty.push(frame).unwrap();
                    text
                }
                LoopEvent::Applied {
                    inputs:
                        RunInputs {
                            step,
                            skipped,
                            reset,
                            inputs,
                            ..
                        },
                    ticks,
                    ..
                } => {
                    assert!(ticks >= skipped);
                    let reset = if reset { " reset" } else { "" };
                    format!("applied {} at {step} skipped {skipped}{reset}", inputs.rotary_speed)
                }
                LoopEvent::Failed(failure, ticks) => format!("failed at station {} tick {ticks}", failure.station),
                LoopEvent::Recovered => "recovered".into(),
            });
        }
        told
    }
}

#[test]
fn in_time_it_shows_what_is_due_and_tells_inputs_once() {
    let mut bench = Bench::new();
    for _ in 0..4 {
        bench.period(0);
    }
    assert_eq!(
        bench.reports(),
        [
            "applied 1 at 0 skipped 0",
            "frame 0 at 0",
            "frame 10 at 10",
            "frame 20 at 20"
        ]
    );
    bench.speed(3.0);
    bench.period(0);
    assert_eq!(bench.reports(), ["applied 3 at 20 skipped 0"]);
    // As the scripted model has it after 25 steps.
    assert_eq!(
        bench.gauges.phase_times(),
        PhaseTimes::from_nanoseconds(|phase| 25 * (3 + phase as u64))
    );
    assert_eq!(bench.gauges.run_state(), RunState::Running);
    assert_eq!(bench.gauges.steps_skipped.load(Ordering::Relaxed), 0);
}

#[test]
fn a_little_lateness_is_caught_up_and_more_is_skipped_whole() {
    let mut bench = Bench::new();
    bench.period(0);
    bench.reports();
    // 18 ms for a period of 5 ms: two whole periods late, within the tolerance of four.
    bench.period(18 * MS);
    assert_eq!(bench.gauges.steps_late.load(Ordering::Relaxed), 0);
    assert_eq!(bench.gauges.lateness.load(Ordering::Relaxed), 13 * MS);
    bench.period(0);
    assert_eq!(bench.reports(), ["frame 10 at 10"]);
    // 33 ms on top of what is left: more than the tolerance, so that all whole periods are given up.
    bench.period(33 * MS);
    let skipped = bench.gauges.steps_late.load(Ordering::Relaxed);
    assert_eq!(skipped % 5, 0);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        ["frame 20 at 20", &format!("applied 1 at 20 skipped {skipped}")]
    );
    assert!(bench.gauges.deadline_misses.load(Ordering::Relaxed) >= 15);
    assert_eq!(bench.gauges.ticks.load(Ordering::Relaxed), 25 + skipped);
    // The grid of deadlines has not moved.
    assert_eq!(bench.solver.pacer.deadline(), MS + MS * (25 + skipped));
}

#[test]
fn a_failed_step_freezes_the_outputs_until_the_inputs_change() {
    let mut bench = Bench::new();
    bench.period(0);
    bench.reports();
    bench.speed(TOO_FAST + 1.0);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        ["applied 101 at 5 skipped 0", "failed at station 7 tick 5"]
    );
    assert_eq!(bench.gauges.run_state(), RunState::Failed);
    for _ in 0..10 {
        bench.period(0);
    }
    assert!(
        bench.reports().is_empty(),
        "nothing stale is shown, nothing is tried again"
    );
    bench.speed(TOO_FAST + 2.0);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        ["applied 102 at 5 skipped 55", "failed at station 7 tick 60"]
    );
    bench.speed(2.0);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        ["applied 2 at 5 skipped 60", "recovered", "frame 10 at 70"]
    );
    assert_eq!(bench.gauges.run_state(), RunState::Running);
    assert_eq!(
        bench.gauges.steps_late.load(Ordering::Relaxed),
        0,
        "standing still is not being late"
    );
}

#[test]
fn a_reset_shows_the_start_again_and_keeps_the_clock() {
    let mut bench = Bench::new();
    bench.period(0);
    bench.period(0);
    bench.reports();
    bench.commands.push(Command::Reset).unwrap();
    bench.period(0);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        ["applied 1 at 10 skipped 0 reset", "frame 0 at 10", "frame 10 at 20"]
    );
}

#[test]
fn a_reset_while_failed_moves_on_with_the_present_inputs() {
    let mut bench = Bench::new();
    bench.speed(TOO_FAST + 1.0);
    bench.period(0);
    bench.reports();
    bench.commands.push(Command::Reset).unwrap();
    bench.period(0);
    assert_eq!(
        bench.reports(),
        [
            "applied 101 at 0 skipped 5 reset",
            "frame 0 at 5",
            "failed at station 7 tick 5"
        ],
        "the cause is still there, so it fails again and says so"
    );
}

#[test]
fn a_pause_stands_still_and_counts_as_skipped() {
    let mut bench = Bench::new();
    bench.period(0);
    bench.reports();
    bench.commands.push(Command::Pause(true)).unwrap();
    bench.period(0);
    bench.speed(9.0);
    bench.period(0);
    assert!(bench.reports().is_empty());
    assert_eq!(bench.gauges.run_state(), RunState::Paused);
    bench.commands.push(Command::Pause(false)).unwrap();
    bench.period(0);
    assert_eq!(bench.reports(), ["applied 9 at 5 skipped 10", "frame 10 at 20"]);
}

#[test]
fn frames_without_room_are_dropped_and_counted_but_inputs_are_told() {
    let mut bench = Bench::new();
    for _ in 0..400 {
        bench.period(0);
    }
    bench.speed(4.0);
    bench.period(0);
    let told = bench.reports();
    assert_eq!(
        told.iter().filter(|report| report.starts_with("frame")).count(),
        crate::link::FRAMES
    );
    assert_eq!(
        bench.gauges.frames_dropped.load(Ordering::Relaxed),
        201 - crate::link::FRAMES as u64
    );
    assert_eq!(told.last().unwrap(), "applied 4 at 2000 skipped 0");
    bench.period(0);
    assert_eq!(bench.reports(), ["frame 2010 at 2010"]);
}

#[test]
fn the_loop_ends_when_told_and_follows_the_deadlines() {
    let bench = Bench::new();
    let Bench {
        solver,
        mut publisher,
        gauges,
        ..
    } = bench;
    let stop = Arc::clone(&gauges);
    let thread = std::thread::spawn(move || solver.run());
    let mut frames = 0;
    while frames < 100 {
        match publisher.events.pop() {
            Ok(LoopEvent::Frame(frame)) => {
                frames += 1;
                publisher.empty.push(frame).unwrap();
            }
            _ => std::thread::yield_now(),
        }
    }
    stop.stop.store(true, Ordering::Relaxed);
    thread.join().unwrap();
    assert_eq!(gauges.start.load(Ordering::Relaxed), START);
    assert_eq!(gauges.steps_late.load(Ordering::Relaxed), 0);
}
