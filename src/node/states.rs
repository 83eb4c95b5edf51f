//! The whole state of the running model for those who ask for it: a file, or a look ahead. One slot travels to the solver
//! and back, so that the solver copies its state without allocating and never waits for anybody.

use std::time::{Duration, Instant};

use flexdrill_core::twin::{CheckpointError, RunInputs};
use flexdrill_realtime::link::{Command, StateSlot};

use super::control::ControlError;

/// Longest wait for the solver's state.
const WAIT: Duration = Duration::from_secs(10);
/// Between two looks for the answer; the solver looks for requests every few milliseconds.
const LOOK: Duration = Duration::from_millis(1);
/// Room for the first state (bytes): twice that of the paper's tool.
const FIRST_ROOM: usize = 4 << 20;
/// Most room for a state (bytes): some hundred times that of the paper's tool.
const MOST_ROOM: usize = 256 << 20;

/// The state of a run at one instant.
#[derive(Debug, Clone)]
pub struct SavedRun {
    /// From which a simulation of the same configuration continues.
    pub checkpoint: Vec<u8>,
    /// What acted on the model, and its step.
    pub applied: RunInputs,
    /// Steps taken or skipped before it since the start of the run.
    pub ticks: u64,
}

/// The slot and the way back from the solver. Its owner asks for one state at a time.
pub struct States {
    answers: rtrb::Consumer<Box<StateSlot>>,
    slot: Option<Box<StateSlot>>,
    asked: u64,
}

impl States {
    /// `answers` are those to [`Command::State`].
    pub fn new(answers: rtrb::Consumer<Box<StateSlot>>) -> Self {
        Self {
            answers,
            slot: None,
            asked: 0,
        }
    }

    /// Asks for the state by `send` and waits for it.
    ///
    /// # Errors
    /// When the queue of commands is full, the solver does not answer in time, or the state cannot be encoded.
    pub fn get(&mut self, send: impl Fn(Command) -> Result<u64, ControlError>) -> Result<SavedRun, ControlError> {
        loop {
            let mut slot = self.slot.take().unwrap_or_else(|| StateSlot::new(FIRST_ROOM));
            self.asked += 1;
            slot.number = self.asked;
            send(Command::State(slot))?;
            let slot = self.answer()?;
            let read = slot.checkpoint().map(<[u8]>::to_vec);
            match (read, slot.applied) {
                (Ok(checkpoint), Some(applied)) => {
                    let ticks = slot.ticks;
                    self.slot = Some(slot);
                    return Ok(SavedRun {
                        checkpoint,
                        applied,
                        ticks,
                    });
                }
                (Err(CheckpointError::NoRoom { room }), _) if 2 * room <= MOST_ROOM => {
                    self.slot = Some(StateSlot::new(2 * room));
                }
                _ => return Err(slot.length.err().map_or(ControlError::NoAnswer, ControlError::State)),
            }
        }
    }

    /// The answer to the last request. Answers to those that were given up are dropped.
    fn answer(&mut self) -> Result<Box<StateSlot>, ControlError> {
        let until = Instant::now() + WAIT;
        loop {
            match self.answers.pop() {
                Ok(slot) if slot.number == self.asked => return Ok(slot),
                Ok(_) => {}
                Err(_) if Instant::now() < until => std::thread::sleep(LOOK),
                Err(_) => return Err(ControlError::NoAnswer),
            }
        }
    }
}
