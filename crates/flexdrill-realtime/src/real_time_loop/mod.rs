//! The solver's thread. It advances the run in periods with absolute deadlines, reads inputs and commands between
//! periods, and emits frames. It does not lock, log, allocate or touch ROS.
//!
//! A period is a whole number of model steps. The loop catches up small lateness. Beyond the tolerance it skips and
//! counts whole periods, so that model and clock stay together. The refinement of the steps is the one that the motion
//! needs, as far as the machine has time for it ([`StepPace`]). It is an input of the run, and is published as one.
//!
//! While the run is paused, a client can order a number of steps ([`Command::Step`]). They are taken at the pace of the
//! clock. Inputs and refinement are decided before each of them, and without regard to the machine's pace, so that
//! the motion is the same however the steps are divided into orders.

use std::collections::VecDeque;
use std::sync::atomic::Ordering;
use std::time::Instant;

use crate::{Pacer, StepPace};
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::step::MOST_REFINEMENT;
use flexdrill_core::twin::{Frame, Run, RunInputs};
use rtrb::PushError;

use crate::clock::Clock;
use crate::link::{Command, FRAMES, LoopEnd, LoopEvent, RunState, StepOrder};

/// A clock that is this far before the deadline (ns) was set back.
const SET_BACK: u64 = 2_000_000_000;

/// Drives a run against a clock.
pub struct RealTimeLoop<C: Clock> {
    run: Run,
    clock: C,
    end: LoopEnd,
    /// Frames that have not been used yet.
    stash: VecDeque<Box<Frame>>,
    /// Used when no frame is free, so that the statistics' intervals end at the right steps.
    spare: Box<Frame>,
    pacer: Pacer,
    /// Period (ns).
    period: u64,
    steps_per_period: u64,
    steps_taken: u64,
    commands_done: u64,
    paused: bool,
    failed: bool,
    /// A command that changes the run came since the last step.
    changed: bool,
    reset_asked: bool,
    wanted: RunInputs,
    /// The inputs published last, without regard to `step` and `reset`.
    published: Option<RunInputs>,
    /// The state at the start or after a reset has not been published yet.
    first: bool,
    /// The refinement that the machine has time for.
    pace: StepPace,
    /// Periods were skipped since the last one that was computed.
    late: bool,
    /// The steps that were ordered last.
    order: StepOrder,
}

impl<C: Clock> RealTimeLoop<C> {
    /// A loop of `steps_per_period` steps per deadline. All allocations happen here.
    pub fn new(run: Run, clock: C, end: LoopEnd, steps_per_period: u64) -> Self {
        let steps_per_period = steps_per_period.max(1);
        let time_step = run.simulation().settings().time_step;
        let spare = Box::new(run.new_frame());
        let period = steps_per_period as f64 * time_step;
        let tolerance = (clock.tolerance() / period) as u64;
        Self {
            stash: (0..FRAMES).map(|_| Box::new(run.new_frame())).collect(),
            spare,
            pacer: Pacer::new(clock.now(), period, tolerance),
            period: (period * 1e9).round() as u64,
            steps_per_period,
            steps_taken: 0,
            commands_done: 0,
            paused: false,
            failed: false,
            changed: false,
            reset_asked: false,
            wanted: run.applied(),
            published: None,
            first: true,
            pace: StepPace::new(MOST_REFINEMENT),
            late: false,
            order: StepOrder::default(),
            run,
            clock,
            end,
        }
    }

    /// Runs until [`Gauges::stop`](crate::link::Gauges::stop) is set.
    pub fn run(mut self) {
        while self.clock.now() == 0 && !self.stopped() {
            // A simulated clock has not ticked yet. Commands are executed meanwhile, so that they do not fill the ring.
            self.handle_commands();
            self.clock.wait_until(1);
        }
        self.start();
        while !self.stopped() {
            let (now, deadline) = (self.clock.now(), self.pacer.deadline());
            if self.was_set(now, deadline) {
                self.follow_set_clock(now);
            } else if now >= deadline {
                self.run_period();
            } else {
                self.clock.wait_until(deadline);
            }
        }
    }

    fn start(&mut self) {
        self.follow_set_clock(self.clock.now());
    }

    /// Whether the clock was set; otherwise the difference is elapsed time.
    fn was_set(&self, now: u64, deadline: u64) -> bool {
        deadline.saturating_sub(now) > SET_BACK || now.saturating_sub(deadline) > self.clock.leap()
    }

    /// Makes the next period due at `now` and lets stamps follow the clock from here: the time by which the clock was
    /// set does not count as missed.
    fn follow_set_clock(&mut self, now: u64) {
        self.pacer.restart(now);
        // The steps of a period are computed at its start. Their stamps lie within the previous period, so that no
        // message is ahead of the clock when it is published.
        let time_step = self.run.simulation().settings().time_step;
        let gone = (self.run.ticks() as f64 * time_step * 1e9).round() as i64;
        let first = i64::try_from(self.clock.rig_time().saturating_sub(self.period)).unwrap_or(i64::MAX);
        self.end.gauges.set_start(first.saturating_sub(gone));
    }

    /// Runs one period, then skips periods if it took too long.
    fn run_period(&mut self) {
        self.handle_commands();
        self.one_period();
        let paced = self.pacer.step_done(self.clock.now());
        if paced.skipped > 0 {
            let steps = paced.skipped * self.steps_per_period;
            self.run.skip(steps);
            if !self.paused && !self.failed {
                self.late = true;
                self.end.gauges.steps_late.fetch_add(steps, Ordering::Relaxed);
            }
        }
        let lateness = paced.lateness.saturating_sub(self.clock.jump());
        self.end.gauges.lateness.store(lateness, Ordering::Relaxed);
        self.update_gauges();
    }

    fn stopped(&self) -> bool {
        self.end.gauges.stop.load(Ordering::Relaxed)
    }

    fn handle_commands(&mut self) {
        while let Ok(command) = self.end.commands.pop() {
            self.commands_done += 1;
            match command {
                Command::Settings(settings) => {
                    self.wanted.live = settings.live;
                    self.wanted.slew = settings.slew;
                    self.wanted.whirl = settings.whirl;
                    self.wanted.schedule = settings.schedule;
                }
                Command::Pause(paused) => {
                    self.paused = paused;
                    self.order.stop();
                }
                Command::Reset => {
                    self.reset_asked = true;
                    self.order.stop();
                }
                Command::Step(steps) => {
                    self.order = StepOrder::new(self.commands_done, steps);
                    if !self.paused {
                        self.order.stop();
                    }
                }
                Command::StopSteps => {
                    self.order.stop();
                    continue;
                }
                Command::State(mut slot) => {
                    slot.length = self.run.simulation().checkpoint_into(&mut slot.room);
                    (slot.applied, slot.ticks) = (Some(self.run.applied()), self.run.ticks());
                    // It is full only where requester after requester has given up; then this one has, too.
                    let _ = self.end.states.push(slot);
                    continue;
                }
            }
            self.changed = true;
        }
    }

    fn one_period(&mut self) {
        // Inputs are read once per period, so that all its steps have the same. The motion asks for a refinement, and the
        // pace allows what the machine has had time for.
        self.read_inputs(self.pace.allowed());
        let current = self.run.applied();
        let new_inputs = self.wanted.inputs != current.inputs;
        // A paused run takes only the steps that were ordered. After a failure the same inputs would fail again, so it waits
        // until something has changed.
        if self.paused && !self.reset_asked || self.failed && !new_inputs && !self.changed {
            let taken = self.ordered_steps();
            self.run.skip(self.steps_per_period - taken);
            // The steps that are not taken say nothing about the machine's pace.
            self.pace.forget();
            return;
        }
        // A reset acts while the run is paused too, and its first frame is published then.
        self.apply(&current);
        if self.paused {
            self.publish_first();
            self.run.skip(self.steps_per_period);
            return;
        }
        self.publish_first();
        // The deadline is the end of this period by the plan, not by when it began: lateness must not move it.
        let end = self.pacer.deadline().saturating_add(self.period);
        let start = self.clock.machine_time();
        let mut began = Instant::now();
        for taken in 0..self.steps_per_period {
            if !self.step(&mut began) {
                // The rest of the period is skipped, so that model time and clock stay together.
                self.run.skip(self.steps_per_period - taken);
                return;
            }
            // A step is late against the whole period: within it, steps may take their time. A clock that was
            // set in between is no lateness.
            if self.clock.now() > end.saturating_add(self.clock.jump()) {
                self.end.gauges.deadline_misses.fetch_add(1, Ordering::Relaxed);
            }
        }
        // All steps of the period are taken, so the changed inputs have proved themselves.
        self.changed = false;
        let late = std::mem::take(&mut self.late);
        self.pace
            .note((start, self.clock.machine_time()), late, self.run.applied().refinement);
    }

    /// Reads the newest targets, and the refinement that the motion asks for, `most` at most.
    fn read_inputs(&mut self, most: u32) {
        (self.wanted.inputs, self.wanted.input_quality) = self.end.targets.get();
        self.wanted.refinement = self.run.wanted_refinement().min(most);
    }

    /// Takes the steps that were ordered, those of a period at most. Returns how many were taken.
    fn ordered_steps(&mut self) -> u64 {
        let mut began = Instant::now();
        for taken in 0..self.steps_per_period {
            if !self.paused || !self.order.is_open() {
                return taken;
            }
            self.read_inputs(MOST_REFINEMENT);
            let current = self.run.applied();
            self.apply(&current);
            self.publish_first();
            if !self.step(&mut began) {
                self.order.fail();
                return taken;
            }
            self.order.step_taken();
            self.changed = false;
        }
        self.steps_per_period
    }

    /// Takes one step that begins at `began`, publishes what is due then or that it failed, and moves `began` to its end.
    /// Returns whether the model has moved.
    fn step(&mut self, began: &mut Instant) -> bool {
        let outcome = self.run.advance();
        let ended = Instant::now();
        // A full ring only loses statistics.
        let _ = self
            .end
            .step_times
            .push((ended - *began).as_nanos().min(u128::from(u32::MAX)) as u32);
        *began = ended;
        match outcome {
            StepOutcome::Advanced { .. } => {
                self.steps_taken += 1;
                if self.failed {
                    self.failed = false;
                    self.push(LoopEvent::Recovered);
                }
                self.publish_if_due();
                true
            }
            StepOutcome::Failed(failure) => {
                self.failed = true;
                self.changed = false;
                self.push(LoopEvent::Failed(failure, self.run.ticks()));
                false
            }
        }
    }

    /// Applies the newest inputs and settings to the run, and publishes them if one of them has changed.
    fn apply(&mut self, current: &RunInputs) {
        let next = RunInputs {
            step: current.step,
            skipped: current.skipped,
            reset: self.reset_asked,
            ..self.wanted
        };
        let same = self.published.is_some_and(|published| {
            RunInputs {
                step: published.step,
                reset: false,
                ..next
            } == published
        });
        if same && !next.reset && !self.changed {
            return;
        }
        if next.reset {
            self.reset_asked = false;
            self.failed = false;
            self.first = true;
        }
        self.run.apply(&next);
        self.published = Some(RunInputs { reset: false, ..next });
        let ticks = self.run.ticks();
        self.push(LoopEvent::Applied {
            inputs: next,
            ticks,
            commands: self.commands_done,
        });
    }

    fn publish_first(&mut self) {
        if self.first {
            self.first = false;
            self.publish_if_due();
        }
    }

    fn publish_if_due(&mut self) {
        if self.run.due().is_empty() {
            return;
        }
        let Some(mut frame) = self.stash.pop_front().or_else(|| self.end.empty.pop().ok()) else {
            self.run.capture(&mut self.spare);
            self.end.gauges.frames_dropped.fetch_add(1, Ordering::Relaxed);
            return;
        };
        self.run.capture(&mut frame);
        self.push(LoopEvent::Frame(frame));
    }

    fn push(&mut self, event: LoopEvent) {
        if let Err(PushError::Full(event)) = self.end.events.push(event) {
            self.end.gauges.events_lost.fetch_add(1, Ordering::Relaxed);
            if let LoopEvent::Frame(frame) = event {
                self.stash.push_back(frame);
            }
        }
    }

    fn update_gauges(&self) {
        let gauges = &self.end.gauges;
        gauges.step.store(self.run.simulation().step(), Ordering::Relaxed);
        gauges.steps_taken.store(self.steps_taken, Ordering::Relaxed);
        gauges
            .steps_skipped
            .store(self.run.applied().skipped, Ordering::Relaxed);
        gauges.ticks.store(self.run.ticks(), Ordering::Relaxed);
        gauges.set_phase_times(&self.run.simulation().phase_times());
        gauges.set_order(&self.order);
        gauges.set_run_state(match (self.paused, self.failed) {
            (true, _) => RunState::Paused,
            (_, true) => RunState::Failed,
            _ => RunState::Running,
        });
        // Last: who waits for a command finds all that it has changed.
        gauges.commands.store(self.commands_done, Ordering::Release);
    }
}

#[cfg(test)]
mod tests;
