//! The bytes of a checkpoint: what they belong to, the state, and a checksum over both.
//!
//! ```text
//! magic "flexdrCP" | format, u32 | identity, 32 bytes | state, postcard | SHA-256 of all before, 32 bytes
//! ```
//!
//! Integers are little-endian. The identity is the SHA-256 of the tool description and the settings as given to
//! [`super::Simulation::new`], bit by bit: all that determines the motion from a state on. Left out are the limits on
//! iterations and halvings, which say when a step is given up, so that a run that failed can go on with others. What
//! may change while running (live parameters, slew limits, whirl thresholds) is part of the state and is restored.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::observe::Observer;
use super::settings::SimulationSettings;
use super::simulation::Simulation;
use super::snapshot::Applied;
use crate::step::StepperCheckpoint;
use crate::tool::ToolDescription;

const MAGIC: [u8; 8] = *b"flexdrCP";

/// Changes with every change of what a state consists of.
pub(super) const FORMAT: u32 = 25;

const HASH: usize = 32;
const HEADER: usize = MAGIC.len() + size_of::<u32>() + HASH;

/// Why bytes could not be restored. Nothing has changed then.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// Other bytes, or a checkpoint from before there were format numbers.
    #[error(
        "checkpoint: these bytes are no checkpoint of flexdrill, or one older than format 1; \
         start without it and save a new one"
    )]
    NotACheckpoint,
    /// Of another format.
    #[error(
        "checkpoint: format {found}, this build reads format {FORMAT}; \
         restore it with the build that wrote it, or start without it"
    )]
    Format {
        /// Format number found.
        found: u32,
    },
    /// Cut off or changed since it was written.
    #[error(
        "checkpoint: damaged, its checksum does not fit its {length} bytes; take another copy, or start without it"
    )]
    Damaged {
        /// Bytes found.
        length: usize,
    },
    /// Of another tool, or of the same with other settings.
    #[error(
        "checkpoint: saved with another tool or other settings ({found} instead of {expected}); \
         restore it with the configuration it was saved with, or start without it"
    )]
    OtherTool {
        /// First digits of the identity found.
        found: String,
        /// First digits of this simulation's.
        expected: String,
    },
    /// The room for it is too small.
    #[error("checkpoint: longer than the {room} bytes that it may have; give it more room")]
    NoRoom {
        /// Bytes that there are.
        room: usize,
    },
    /// The state cannot be encoded, or is not one although the checksum fits.
    #[error("checkpoint: {0}; please report it as a bug")]
    Encoding(#[from] postcard::Error),
}

/// The state in a checkpoint. A change of it is a new format.
#[derive(Serialize, Deserialize)]
struct Saved<S, O> {
    stepper: S,
    observer: O,
    applied: Applied,
    step: u64,
    /// Slew limits of rotary speed (rad/s2), weight on bit (N/s), rate of penetration (m/s2) and standpipe pressure
    /// (Pa/s).
    slew: [f64; 4],
}

impl Simulation {
    /// The whole state as bytes; [`Simulation::restore`] continues from it bit for bit.
    ///
    /// # Errors
    /// When the state cannot be encoded.
    pub fn checkpoint(&self) -> Result<Vec<u8>, CheckpointError> {
        write(&self.identity, &self.saved())
    }

    /// Writes the bytes of [`Simulation::checkpoint`] to the front of `room`, and returns how many they are. Nothing is
    /// allocated, so that the thread that advances a live simulation can hand its state to another. The number changes by
    /// some dozen bytes as counters grow; twice the length of a first checkpoint is room enough.
    ///
    /// # Errors
    /// When `room` is too small; what it held is then lost.
    pub fn checkpoint_into(&self, room: &mut [u8]) -> Result<usize, CheckpointError> {
        write_into(&self.identity, &self.saved(), room)
    }

    fn saved(&self) -> Saved<StepperCheckpoint<'_>, &Observer> {
        Saved {
            stepper: self.stepper.checkpoint(),
            observer: &self.observer,
            applied: self.applied,
            step: self.step,
            slew: self.settings.slew(),
        }
    }

    /// Continues from a checkpoint of the same tool and settings: state, live parameters, slew limits and whirl
    /// thresholds are then those at which it was made. After an error the simulation is unchanged.
    ///
    /// # Errors
    /// When the bytes are no checkpoint, of another format, damaged, or of another tool or other settings.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), CheckpointError> {
        let saved: Saved<StepperCheckpoint<'static>, Observer> = read(&self.identity, bytes)?;
        // The checksum holds here, so only bytes that were forged can still have the wrong sizes.
        if !saved.observer.fits(&self.observer) || !self.stepper.restore(&saved.stepper) {
            return Err(CheckpointError::Damaged { length: bytes.len() });
        }
        let before = std::mem::replace(&mut self.observer, saved.observer);
        self.observer.continue_sequence_of(&before);
        self.observer.refresh();
        self.applied = saved.applied;
        self.step = saved.step;
        self.replace_slew(saved.slew);
        Ok(())
    }
}

/// The tool and the settings that a checkpoint belongs to, as a hash.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Identity([u8; HASH]);

impl Identity {
    pub(super) fn of(tool: &ToolDescription, settings: &SimulationSettings) -> Result<Self, CheckpointError> {
        let anywhere = SimulationSettings {
            max_iterations: 0,
            max_halvings: 0,
            ..settings.clone()
        };
        let described = postcard::to_stdvec(&(tool, anywhere))?;
        Ok(Self(Sha256::digest(described).into()))
    }

    fn short(bytes: &[u8]) -> String {
        bytes.iter().take(4).map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The bytes of `state`.
pub(super) fn write(identity: &Identity, state: &impl Serialize) -> Result<Vec<u8>, CheckpointError> {
    let mut bytes = postcard::to_extend(state, header(identity).to_vec())?;
    let checksum = Sha256::digest(&bytes);
    bytes.extend(checksum);
    Ok(bytes)
}

/// The same bytes at the front of `room`; how many they are.
fn write_into(identity: &Identity, state: &impl Serialize, room: &mut [u8]) -> Result<usize, CheckpointError> {
    let full = CheckpointError::NoRoom { room: room.len() };
    let Some((front, rest)) = room.split_first_chunk_mut() else {
        return Err(full);
    };
    *front = header(identity);
    let length = match postcard::to_slice(state, rest) {
        Ok(state) => HEADER + state.len(),
        Err(postcard::Error::SerializeBufferFull) => return Err(full),
        Err(error) => return Err(error.into()),
    };
    let (content, rest) = room.split_at_mut(length);
    let Some(place) = rest.first_chunk_mut() else {
        return Err(full);
    };
    *place = Sha256::digest(content).into();
    Ok(length + HASH)
}

/// What stands before a state.
fn header(identity: &Identity) -> [u8; HEADER] {
    let mut header = [0; HEADER];
    let (magic, rest) = header.split_at_mut(MAGIC.len());
    let (format, of) = rest.split_at_mut(size_of::<u32>());
    magic.copy_from_slice(&MAGIC);
    format.copy_from_slice(&FORMAT.to_le_bytes());
    of.copy_from_slice(&identity.0);
    header
}

/// The state in `bytes`, if they are whole and of `identity`.
pub(super) fn read<S: DeserializeOwned>(identity: &Identity, bytes: &[u8]) -> Result<S, CheckpointError> {
    let Some((magic, rest)) = bytes.split_first_chunk() else {
        return Err(CheckpointError::NotACheckpoint);
    };
    if *magic != MAGIC {
        return Err(CheckpointError::NotACheckpoint);
    }
    let damaged = CheckpointError::Damaged { length: bytes.len() };
    let Some((format, _)) = rest.split_first_chunk() else {
        return Err(damaged);
    };
    let found = u32::from_le_bytes(*format);
    if found != FORMAT {
        return Err(CheckpointError::Format { found });
    }
    let Some((content, checksum)) = bytes.split_last_chunk::<HASH>() else {
        return Err(damaged);
    };
    if content.len() < HEADER || Sha256::digest(content).as_slice() != checksum {
        return Err(damaged);
    }
    let (header, state) = content.split_at(HEADER);
    let of = &header[HEADER - HASH..];
    if of != identity.0 {
        return Err(CheckpointError::OtherTool {
            found: Identity::short(of),
            expected: Identity::short(&identity.0),
        });
    }
    Ok(postcard::from_bytes(state)?)
}
