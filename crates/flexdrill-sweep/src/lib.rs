//! Sweeps of runs as a directory of content-addressed points, and maps of two quantities made from them. No run is made
//! here: the program computes a point, this crate keeps it. The file of a map is the crate [`flexdrill_map`].
//!
//! # Layout
//! - [`spec`]: what a person writes (YAML). [`values`]: the rows that it means. [`plan`]: what follows, `sweep.json`.
//! - [`directory`]: the plan and a file per result. [`outcome`]: that file.
//! - [`work`]: computes what has no result yet. [`collect`]: all results as one table.
//! - [`choice`]: which runs of a map to make next, by Gaussian processes ([`gauss`]). [`cover`]: what runs must show before a
//!   cell between them may be inferred clear. [`envelope`]: the clear part of a map.
//!
//! # Choices
//! - **No broker.** Whatever starts programs on machines that share a directory can share a sweep: a point's file is
//!   there or not, its name follows from what it is, and its bytes do not depend on who computed it.
//! - **Left alone.** What is damaged, of another version or of another plan is named and not touched.

pub mod choice;
pub mod collect;
pub mod cover;
pub mod directory;
pub mod envelope;
mod error;
pub mod gauss;
pub mod outcome;
pub mod plan;
pub mod spec;
pub mod values;
pub mod work;

pub use flexdrill_map as map;

pub use directory::{Directory, Found, Status};
pub use error::SweepError;
pub use outcome::Outcome;
pub use plan::{Plan, Point};
pub use spec::Spec;
pub use work::{Chunk, Progress, Worked};
