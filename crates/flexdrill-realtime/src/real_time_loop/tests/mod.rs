//! The solver against a clock that the test moves and a small tool that fails when it is driven too fast.

mod orders;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::RealTimeLoop;
use crate::clock::{Clock, SimulatedClock};
use crate::link::{
    Command, Gauges, LoopEvent, OrderEnd, PublisherEnd, RequestEnd, RunState, Settings, StateSlot, Targets, link,
};
use crate::monotonic;
use flexdrill_core::dynamics::phases::Phase;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{ToolDescription, WellSection};
use flexdrill_core::twin::{Run, RunInputs, Schedule, Simulation, SimulationSettings, Snapshot, StepRule};

const MS: u64 = 1_000_000;
const START: u64 = 1_000_000 * MS;
/// rad/s: no step comes through, since the drive's angle is no number that an angle can be.
const TOO_FAST: f64 = 1e200;

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

/// Two links of one element in a sixteenth of the paper's arc.
fn tool() -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(2, 1);
    tool.well.sections = vec![WellSection::Arc {
        radius: 3.2,
        angle: 0.1,
    }];
    tool
}

/// 1 ms steps, 5 per period, every output due every 10 steps.
struct Bench {
    solver: RealTimeLoop<ScriptedClock>,
    publisher: PublisherEnd,
    requests: RequestEnd,
    targets: Arc<Targets>,
    gauges: Arc<Gauges>,
    clock: ScriptedClock,
}

fn settings() -> SimulationSettings {
    SimulationSettings::default().with(|settings| {
        settings.time_step = 1e-3;
        settings.initial_inputs = Inputs {
            rotary_speed: 1.0,
            weight_on_bit: 2.0,
            ..Inputs::default()
        };
        // Every speed is reached within a step.
        settings.rotary_speed_slew = 1e300;
    })
}

fn run() -> Run {
    let mut simulation = Simulation::new(&tool(), &settings()).unwrap();
    simulation.set_clock(monotonic::now);
    Run::new(simulation, Schedule::new(1e-3, |_| 100.0))
}

impl Bench {
    fn new() -> Self {
        let targets = Targets::new(settings().initial_inputs);
        let gauges = Arc::new(Gauges::default());
        let (end, publisher, requests) = link(Arc::clone(&targets), Arc::clone(&gauges));
        let clock = ScriptedClock {
            now: Arc::new(AtomicU64::new(MS)),
        };
        let solver = RealTimeLoop::new(run(), clock.clone(), end, 5);
        Self {
            solver,
            publisher,
            requests,
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
                ..Inputs::default()
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
                LoopEvent::Failed(failure, ticks) => format!("{:?} at tick {ticks}", failure.cause),
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
    let times = bench.solver.run.simulation().phase_times();
    assert_eq!(bench.gauges.phase_times(), times);
    assert!(Phase::ALL.iter().all(|&phase| times.of(phase) > 0));
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
    bench.speed(TOO_FAST);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        [
            format!("applied {TOO_FAST} at 5 skipped 0"),
            "InputOutOfBounds(RotarySpeed) at tick 5".into()
        ]
    );
    assert_eq!(bench.gauges.run_state(), RunState::Failed);
    for _ in 0..10 {
        bench.period(0);
    }
    assert!(
        bench.reports().is_empty(),
        "nothing stale is shown, nothing is tried again"
    );
    bench.speed(2.0 * TOO_FAST);
    bench.period(0);
    assert_eq!(
        bench.reports(),
        [
            format!("applied {} at 5 skipped 55", 2.0 * TOO_FAST),
            "InputOutOfBounds(RotarySpeed) at tick 60".into()
        ]
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
    bench.requests.commands.push(Command::Reset).unwrap();
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
    bench.speed(TOO_FAST);
    bench.period(0);
    bench.reports();
    bench.requests.commands.push(Command::Reset).unwrap();
    bench.period(0);
    assert_eq!(
        bench.reports(),
        [
            format!("applied {TOO_FAST} at 0 skipped 5 reset"),
            "frame 0 at 5".into(),
            "InputOutOfBounds(RotarySpeed) at tick 5".into()
        ],
        "the cause is still there, so it fails again and says so"
    );
}

#[test]
fn a_pause_stands_still_and_counts_as_skipped() {
    let mut bench = Bench::new();
    bench.period(0);
    bench.reports();
    bench.requests.commands.push(Command::Pause(true)).unwrap();
    bench.period(0);
    bench.speed(9.0);
    bench.period(0);
    assert!(bench.reports().is_empty());
    assert_eq!(bench.gauges.run_state(), RunState::Paused);
    bench.requests.commands.push(Command::Pause(false)).unwrap();
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
    // Stamps begin a period before: what is published is never ahead of the clock.
    assert_eq!(gauges.start(), Some((START - 5 * MS) as i64));
    assert_eq!(gauges.steps_late.load(Ordering::Relaxed), 0);
}

/// `/clock` may not tick for long, and parameters are set meanwhile: more of them than the ring holds.
#[test]
fn what_is_set_before_the_first_tick_acts_on_the_first_step() {
    let targets = Targets::new(settings().initial_inputs);
    let gauges = Arc::new(Gauges::default());
    let (end, mut publisher, requests) = link(targets, Arc::clone(&gauges));
    let mut commands = requests.commands;
    let (run, newest) = (run(), Arc::new(AtomicU64::new(0)));
    let applied = run.applied();
    let solver = RealTimeLoop::new(run, SimulatedClock::new(Arc::clone(&newest)), end, 5);
    let thread = std::thread::spawn(move || solver.run());
    let room = commands.slots();
    let began = std::time::Instant::now();
    let wait = || {
        assert!(
            began.elapsed().as_secs() < 60,
            "nobody takes commands before the first tick"
        );
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    for number in 1..=2 * room {
        while commands.is_full() {
            wait();
        }
        let settings = Settings {
            live: applied.live,
            slew: [1.0, 2.0, 3.0, 4.0].map(|factor| factor * number as f64),
            whirl: applied.whirl,
            schedule: applied.schedule,
        };
        commands.push(Command::Settings(settings)).unwrap();
    }
    while commands.slots() < room {
        wait();
    }
    assert_eq!(gauges.ticks.load(Ordering::Relaxed), 0);
    newest.store(START, Ordering::Release);
    let first = loop {
        match publisher.events.pop() {
            Ok(LoopEvent::Applied { inputs, commands, .. }) => break (inputs, commands),
            Ok(_) => panic!("the inputs come first"),
            Err(_) => wait(),
        }
    };
    gauges.stop.store(true, Ordering::Relaxed);
    thread.join().unwrap();
    let newest = 2.0 * room as f64;
    assert_eq!(
        (first.0.step, first.0.slew),
        (0, [1.0, 2.0, 3.0, 4.0].map(|factor| factor * newest))
    );
    assert_eq!(first.1, 2 * room as u64);
}

/// A simulated clock that is set to another year and back: the model goes on from where it is, nothing counts as
/// missed, and stamps are those of the clock again.
#[test]
fn a_clock_that_is_set_leaves_the_model_and_takes_the_stamps_along() {
    const FORGED: u64 = 2_147_400_000_000 * MS;
    let targets = Targets::new(settings().initial_inputs);
    let gauges = Arc::new(Gauges::default());
    let (end, mut publisher, _requests) = link(targets, Arc::clone(&gauges));
    let newest = Arc::new(AtomicU64::new(START));
    let solver = RealTimeLoop::new(run(), SimulatedClock::new(Arc::clone(&newest)), end, 5);
    let thread = std::thread::spawn(move || solver.run());
    let began = std::time::Instant::now();
    let noticed = |before: Option<i64>| {
        while gauges.start() == before {
            assert!(began.elapsed().as_secs() < 60, "the loop does not look at the clock");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    };
    noticed(None);
    let mut advance = |from: u64| {
        let start = gauges.start();
        if newest.swap(from, Ordering::AcqRel) != from {
            noticed(start);
        }
        let before = gauges.ticks.load(Ordering::Relaxed);
        // Half a second of the clock in ticks of 20 ms, each when the model has come as far.
        for tick in 1..=25_u64 {
            newest.store(from + tick * 20 * MS, Ordering::Release);
            while gauges.ticks.load(Ordering::Relaxed) < before + tick * 20 {
                assert!(began.elapsed().as_secs() < 60, "the model does not follow the clock");
                while let Ok(report) = publisher.events.pop() {
                    if let LoopEvent::Frame(frame) = report {
                        publisher.empty.push(frame).unwrap();
                    }
                }
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
        }
        let ticks = gauges.ticks.load(Ordering::Relaxed);
        let stamp = gauges.start().unwrap() + (ticks * MS) as i64;
        (ticks - before, stamp - (from + 500 * MS) as i64)
    };
    for from in [START, FORGED, START + 1000 * MS, 5000 * MS] {
        let (ticks, ahead) = advance(from);
        // A period more where one was due at the instant of the set itself.
        assert!((500..=505).contains(&ticks), "{ticks} ticks in 500 ms from {from}");
        assert!(
            (-25 * MS as i64..=0).contains(&ahead),
            "stamps are {ahead} ns ahead of the clock at {from}"
        );
    }
    gauges.stop.store(true, Ordering::Relaxed);
    thread.join().unwrap();
    assert_eq!(gauges.steps_skipped.load(Ordering::Relaxed), 0);
}
