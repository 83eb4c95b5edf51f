//! The state that outlasts a restart.

use serde::{Deserialize, Serialize};

use crate::Statistics;
use crate::alarm::Timed;

/// Version of [`Saved`].
pub const FORMAT: u32 = 1;

/// The state of all alarms by their ids.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Saved {
    pub(crate) format: u32,
    pub(crate) sequence: u64,
    pub(crate) alarms: Vec<SavedAlarm>,
    pub(crate) statistics: Statistics,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SavedAlarm {
    pub(crate) id: String,
    pub(crate) state: Timed,
}

/// Why a saved state cannot be restored.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SavedError {
    /// Another version saved it.
    #[error("the alarms were saved in format {found}, this version reads {FORMAT}")]
    Format {
        /// The format of the file.
        found: u32,
    },
}
