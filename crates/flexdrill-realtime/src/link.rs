//! Data exchange between the solver's thread and the rest of the node: wait-free rings and atomics, no locks.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU8, AtomicU64, Ordering};

use rtrb::{Consumer, Producer, RingBuffer};

use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::dynamics::phases::{self, PhaseTimes};
use flexdrill_core::inputs::{InputKind, Inputs};
use flexdrill_core::tool::LiveParameters;
use flexdrill_core::twin::{CheckpointError, Frame, RunInputs, Schedule};
use flexdrill_motion::WhirlSettings;

/// Frames in circulation: at 100 frames per second, two thirds of a second of a stalled publisher.
pub const FRAMES: usize = 64;
/// Capacity for events, in addition to frames.
const EVENTS: usize = 4096;
/// Capacity for commands.
const COMMANDS: usize = 256;
/// Capacity for states on their way back. One is asked for at a time, so that more are there only where requests were
/// given up.
const STATES: usize = 8;
/// Capacity for step times.
const STEP_TIMES: usize = 1 << 16;

/// The parameters that can change in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Coefficients.
    pub live: LiveParameters,
    /// Slew limits, as in [`flexdrill_core::twin::RunInputs::slew`].
    pub slew: [f64; 4],
    /// Thresholds of the whirl analysis.
    pub whirl: WhirlSettings,
    /// Publishing rates.
    pub schedule: Schedule,
}

/// Room for the whole state of a run, which travels to the solver and back: the solver fills it without allocating.
#[derive(Debug)]
pub struct StateSlot {
    /// Tells the answer to one request from that to another that was given up.
    pub number: u64,
    /// Room for a checkpoint, then its bytes at the front.
    pub room: Vec<u8>,
    /// Bytes of the checkpoint, or why there is none.
    pub length: Result<usize, CheckpointError>,
    /// What acted on the model then; none before the slot was filled.
    pub applied: Option<RunInputs>,
    /// Steps taken or skipped before.
    pub ticks: u64,
}

impl StateSlot {
    /// A slot for a checkpoint of up to `room` bytes.
    pub fn new(room: usize) -> Box<Self> {
        Box::new(Self {
            number: 0,
            room: vec![0; room],
            length: Err(CheckpointError::NoRoom { room }),
            applied: None,
            ticks: 0,
        })
    }

    /// The checkpoint.
    ///
    /// # Errors
    /// Why there is none.
    pub fn checkpoint(&self) -> Result<&[u8], &CheckpointError> {
        self.length.as_ref().map(|&length| &self.room[..length])
    }
}

/// Requests that the loop executes between periods.
#[derive(Debug)]
#[expect(clippy::large_enum_variant, reason = "a box would be freed on the solver's thread")]
pub enum Command {
    /// New parameters: a set of them takes effect as a whole or not at all.
    Settings(Settings),
    /// Pause (`true`) or resume.
    Pause(bool),
    /// Reset the model to the state after the start.
    Reset,
    /// Take so many steps while the run is paused. A pause, a resumption and a reset end the order.
    Step(u64),
    /// Take no more of the steps that were ordered.
    StopSteps,
    /// Fill the slot with the whole state and send it back.
    State(Box<StateSlot>),
}

/// Events of the loop, in order.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "a box would be allocated on the solver's thread"
)]
pub enum LoopEvent {
    /// A snapshot; the receiver returns the frame.
    Frame(Box<Frame>),
    /// New values act from the next step on.
    Applied {
        /// The values.
        inputs: RunInputs,
        /// Steps taken or skipped before.
        ticks: u64,
        /// Commands carried out so far.
        commands: u64,
    },
    /// A step failed after this number of ticks; the model stands still.
    Failed(StepFailure, u64),
    /// The model moves again after a failure.
    Recovered,
}

/// State of the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum RunState {
    /// The tool is being brought to rest.
    Starting = 0,
    /// Model time advances.
    Running = 1,
    /// Model time stands still on request.
    Paused = 2,
    /// A step failed; the model stands still.
    Failed = 3,
}

/// How an order of steps stands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum OrderEnd {
    /// Steps remain to be taken.
    Open = 0,
    /// All steps are taken.
    #[default]
    Done = 1,
    /// Another command ended it.
    Stopped = 2,
    /// A step failed.
    Failed = 3,
}

/// Steps that were ordered by [`Command::Step`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StepOrder {
    /// Number of the command.
    pub command: u64,
    /// Steps that have not been taken.
    pub left: u64,
    /// Whether it has ended, and how.
    pub end: OrderEnd,
}

impl StepOrder {
    pub(crate) fn new(command: u64, steps: u64) -> Self {
        let end = if steps == 0 { OrderEnd::Done } else { OrderEnd::Open };
        Self {
            command,
            left: steps,
            end,
        }
    }

    pub(crate) fn is_open(&self) -> bool {
        self.end == OrderEnd::Open
    }

    pub(crate) fn step_taken(&mut self) {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            self.end = OrderEnd::Done;
        }
    }

    pub(crate) fn stop(&mut self) {
        self.end_as(OrderEnd::Stopped);
    }

    pub(crate) fn fail(&mut self) {
        self.end_as(OrderEnd::Failed);
    }

    /// What has ended keeps its end.
    fn end_as(&mut self, end: OrderEnd) {
        if self.is_open() {
            self.end = end;
        }
    }
}

/// Numbers that the solver's thread keeps up to date and others read.
#[derive(Debug, Default)]
pub struct Gauges {
    run_state: AtomicU8,
    /// Steps taken since the start or the last reset.
    pub step: AtomicU64,
    /// Steps taken since the start, over all resets.
    pub steps_taken: AtomicU64,
    /// Steps taken or skipped since the start.
    pub ticks: AtomicU64,
    /// Steps not taken because the solver was late, had failed or was paused.
    pub steps_skipped: AtomicU64,
    /// Of these, the ones skipped because it was late.
    pub steps_late: AtomicU64,
    /// Steps that ended after the end of their period.
    pub deadline_misses: AtomicU64,
    /// How late the last period began (ns).
    pub lateness: AtomicU64,
    /// See [`Gauges::start`]; 0 before the start.
    start: AtomicI64,
    /// Frames that were due when none was free.
    pub frames_dropped: AtomicU64,
    /// Events that found no room: a recording of this run cannot be replayed exactly.
    pub events_lost: AtomicU64,
    /// Commands carried out, with all that they changed in the gauges.
    pub commands: AtomicU64,
    /// See [`Gauges::order`].
    order_command: AtomicU64,
    order_left: AtomicU64,
    order_end: AtomicU8,
    /// Time per phase of the steps taken so far (ns).
    phase_times: [AtomicU64; phases::Phase::ALL.len()],
    /// Set to end the loop.
    pub stop: AtomicBool,
}

impl Gauges {
    /// State of the solver.
    pub fn run_state(&self) -> RunState {
        match self.run_state.load(Ordering::Acquire) {
            1 => RunState::Running,
            2 => RunState::Paused,
            3 => RunState::Failed,
            _ => RunState::Starting,
        }
    }

    /// The newest order of steps.
    pub fn order(&self) -> StepOrder {
        // In the opposite order of `set_order`: what is read later is at least as new. Steps that remain are then never
        // more than those at the end that was read.
        let command = self.order_command.load(Ordering::Acquire);
        let end = match self.order_end.load(Ordering::Acquire) {
            0 => OrderEnd::Open,
            2 => OrderEnd::Stopped,
            3 => OrderEnd::Failed,
            _ => OrderEnd::Done,
        };
        StepOrder {
            command,
            left: self.order_left.load(Ordering::Relaxed),
            end,
        }
    }

    pub(crate) fn set_order(&self, order: &StepOrder) {
        self.order_left.store(order.left, Ordering::Relaxed);
        self.order_end.store(order.end as u8, Ordering::Release);
        self.order_command.store(order.command, Ordering::Release);
    }

    /// Computing time per phase of the steps so far. The phases are separate cells and may differ by a period.
    pub fn phase_times(&self) -> PhaseTimes {
        PhaseTimes::from_nanoseconds(|phase| self.phase_times[phase as usize].load(Ordering::Relaxed))
    }

    pub(crate) fn set_phase_times(&self, times: &PhaseTimes) {
        for phase in phases::Phase::ALL {
            self.phase_times[phase as usize].store(times.of(phase), Ordering::Relaxed);
        }
    }

    /// Instant of the first tick on the rig's clock (ns since 1970), such that tick times step, added to it, is an
    /// instant of the present clock; `None` before the model has started. It moves where a simulated clock is set, and
    /// may lie before 1970 then.
    pub fn start(&self) -> Option<i64> {
        Some(self.start.load(Ordering::Acquire)).filter(|start| *start != 0)
    }

    pub(crate) fn set_start(&self, start: i64) {
        // Zero means that there is no start yet; a nanosecond does not matter.
        self.start.store(if start == 0 { 1 } else { start }, Ordering::Release);
    }

    pub(crate) fn set_run_state(&self, state: RunState) {
        self.run_state.store(state as u8, Ordering::Release);
    }
}

/// The newest targets, in separate cells. The values that the loop read are published as [`LoopEvent::Applied`].
#[derive(Debug, Default)]
pub struct Targets {
    /// SI, by [`InputKind::index`].
    values: [AtomicU64; InputKind::COUNT],
    quality: AtomicU8,
}

impl Targets {
    /// Cells that hold these targets.
    pub fn new(inputs: Inputs) -> Arc<Self> {
        let targets = Arc::new(Self::default());
        targets.set(inputs, 0);
        targets
    }

    /// Replaces the targets and the quality of the inputs (the messages' INPUT_ constants).
    pub fn set(&self, inputs: Inputs, quality: u8) {
        for kind in InputKind::ALL {
            self.values[kind.index()].store(inputs.get(kind).to_bits(), Ordering::Relaxed);
        }
        self.quality.store(quality, Ordering::Relaxed);
    }

    pub(crate) fn get(&self) -> (Inputs, u8) {
        let value = |kind: InputKind| f64::from_bits(self.values[kind.index()].load(Ordering::Relaxed));
        let inputs = Inputs {
            rotary_speed: value(InputKind::RotarySpeed),
            weight_on_bit: value(InputKind::WeightOnBit),
            rate_of_penetration: value(InputKind::RateOfPenetration),
            standpipe_pressure: value(InputKind::StandpipePressure),
        };
        (inputs, self.quality.load(Ordering::Relaxed))
    }
}

/// The end of the loop.
pub struct LoopEnd {
    pub(crate) commands: Consumer<Command>,
    pub(crate) events: Producer<LoopEvent>,
    pub(crate) empty: Consumer<Box<Frame>>,
    pub(crate) step_times: Producer<u32>,
    pub(crate) states: Producer<Box<StateSlot>>,
    pub(crate) targets: Arc<Targets>,
    pub(crate) gauges: Arc<Gauges>,
}

/// The publisher's end.
pub struct PublisherEnd {
    /// Events of the loop.
    pub events: Consumer<LoopEvent>,
    /// Returned frames.
    pub empty: Producer<Box<Frame>>,
    /// Computing time of each step (ns).
    pub step_times: Consumer<u32>,
}

/// The end of those who ask the loop for something.
pub struct RequestEnd {
    /// Requests.
    pub commands: Producer<Command>,
    /// The answers to [`Command::State`].
    pub states: Consumer<Box<StateSlot>>,
}

/// Creates the ends.
pub fn link(targets: Arc<Targets>, gauges: Arc<Gauges>) -> (LoopEnd, PublisherEnd, RequestEnd) {
    let (command_sender, commands) = RingBuffer::new(COMMANDS);
    let (events, event_receiver) = RingBuffer::new(FRAMES + EVENTS);
    let (empty_sender, empty) = RingBuffer::new(FRAMES + 1);
    let (step_times, step_time_receiver) = RingBuffer::new(STEP_TIMES);
    let (states, state_receiver) = RingBuffer::new(STATES);
    (
        LoopEnd {
            commands,
            events,
            empty,
            step_times,
            states,
            targets,
            gauges,
        },
        PublisherEnd {
            events: event_receiver,
            empty: empty_sender,
            step_times: step_time_receiver,
        },
        RequestEnd {
            commands: command_sender,
            states: state_receiver,
        },
    )
}
