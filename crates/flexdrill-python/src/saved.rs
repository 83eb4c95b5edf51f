//! A run as bytes: its configuration, its state and what acts on it.
//!
//! ```text
//! magic "flexdrPY" | format, u32 little-endian | content, postcard | SHA-256 of all before, 32 bytes
//! ```

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use flexdrill_config::{Config, ConfigError};
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{BuildError, CheckpointError, Simulation};

use crate::twin::Twin;

const MAGIC: [u8; 8] = *b"flexdrPY";
const HASH: usize = 32;

/// Changes with every change of the content.
pub const FORMAT: u32 = 1;

/// Why a saved twin cannot be made or restored.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SavedError {
    /// Other bytes.
    #[error("these bytes are no twin that flexdrill saved for Python; use those that Twin.save wrote")]
    NotATwin,
    /// Of another format.
    #[error("saved twin: format {found}, this version reads format {FORMAT}; load it with the version that saved it")]
    Format {
        /// Format found.
        found: u32,
    },
    /// Cut off or changed.
    #[error("saved twin: damaged, its checksum does not fit its {length} bytes; take another copy")]
    Damaged {
        /// Bytes found.
        length: usize,
    },
    /// The configuration in it is refused.
    #[error("the configuration in the saved twin: {0}")]
    Config(#[from] ConfigError),
    /// The tool cannot be built, or the state is not one of it.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The state cannot be encoded or restored.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The content cannot be encoded.
    #[error("saved twin: {0}; please report it as a bug")]
    Encoding(#[from] postcard::Error),
    /// The configuration cannot be written.
    #[error("saved twin: the configuration cannot be written: {reason}; please report it as a bug")]
    Yaml {
        /// The serializer's reason.
        reason: String,
    },
}

#[derive(Serialize, Deserialize)]
struct Content {
    configuration: String,
    checkpoint: Vec<u8>,
    inputs: Inputs,
    refinement: u32,
}

/// A twin as bytes; [`from_bytes`] continues from it bit for bit.
///
/// # Errors
/// When the state cannot be encoded.
pub fn to_bytes(twin: &Twin) -> Result<Vec<u8>, SavedError> {
    let configuration = twin.config().to_yaml().map_err(|error| SavedError::Yaml {
        reason: error.to_string(),
    })?;
    let content = Content {
        configuration,
        checkpoint: twin.simulation().checkpoint()?,
        inputs: twin.inputs(),
        refinement: twin.refinement(),
    };
    let mut bytes = MAGIC.to_vec();
    bytes.extend(FORMAT.to_le_bytes());
    let mut bytes = postcard::to_extend(&content, bytes)?;
    let checksum = Sha256::digest(&bytes);
    bytes.extend(checksum);
    Ok(bytes)
}

/// The twin in `bytes`.
///
/// # Errors
/// When the bytes are no saved twin, of another format, damaged, or the tool in them cannot be built.
pub fn from_bytes(bytes: &[u8]) -> Result<Twin, SavedError> {
    let Some(rest) = bytes.strip_prefix(&MAGIC) else {
        return Err(SavedError::NotATwin);
    };
    let damaged = SavedError::Damaged { length: bytes.len() };
    let Some((format, content)) = rest.split_first_chunk() else {
        return Err(damaged);
    };
    let found = u32::from_le_bytes(*format);
    if found != FORMAT {
        return Err(SavedError::Format { found });
    }
    let (Some((before, checksum)), Some((content, _))) =
        (bytes.split_last_chunk::<HASH>(), content.split_last_chunk::<HASH>())
    else {
        return Err(damaged);
    };
    if Sha256::digest(before).as_slice() != checksum {
        return Err(damaged);
    }
    let content: Content = postcard::from_bytes(content)?;
    let config = Arc::new(Config::from_text("the saved configuration", &content.configuration)?);
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    simulation.restore(&content.checkpoint)?;
    Ok(Twin::resumed(config, simulation, content.inputs, content.refinement))
}
