//! Where on the tool: on which pipe, at which station or joint.

use serde::{Deserialize, Serialize};

/// Which of the two pipes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// The flexible, rotating, jointed pipe.
    #[default]
    Pipe,
    /// The continuous guide pipe around it.
    Guide,
}

impl Body {
    /// The name in sentences: `pipe`, `guide pipe`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pipe => "pipe",
            Self::Guide => "guide pipe",
        }
    }
}

impl std::fmt::Display for Body {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// A location along the tool.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Location {
    /// The first station, at the kick-off.
    Top,
    /// The last station, at the bit.
    Bottom,
    /// Station index from the top, 0-based.
    Station(usize),
    /// Joint number from the top, 0-based (both of its pipe nodes).
    Joint(usize),
    /// Every station of the tool.
    All,
}
