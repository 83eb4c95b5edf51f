//! The life of each joint by its serial number: damage with a band from a stated class, carried from run to run.
//!
//! The crate knows no bag and no clock. It reads and writes the text of a table, and leaves the disk to others.
//!
//! # Layout
//! - `counted`: the cycles that a recording has counted, over resets and gaps.
//! - `living`: the lives of the joints of a run while it lasts.
//! - `run`: the damages of a run, by serial number. `kind`: what a damage means: which joint, which class.
//! - `lives`: the table of all runs, and what may be added to it. `text`: the table as text.
//! - `ranking`: joints to inspect, in words.

mod counted;
mod error;
mod kind;
mod lives;
mod living;
mod ranking;
mod run;
mod text;

pub use counted::Counted;
pub use error::LifeError;
pub use kind::Kind;
pub use lives::{Added, Lives, Row};
pub use living::LivingJoints;
pub use ranking::{JointOfFile, Part, UNKNOWN_TO_A_CLASS, Verdict, damage_in_words, damage_with_band, ranked, verdict};
pub use run::{JointOfRun, RunLife};

/// Largest file that is read (bytes): some thousand runs of the longest tools.
pub const MOST_BYTES: u64 = 64 << 20;
