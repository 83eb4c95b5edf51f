//! Description of the tool, its well, supports and loads.

mod course;
pub(crate) mod description;
mod paper;
pub(crate) mod section;
mod validation;
pub(crate) mod well;

pub use course::Course;
pub use description::*;
pub use flexdrill_base::{Bend, Bends};
pub use section::SectionProperties;
pub use well::{WellPath, frame_along, tangent};
