//! Description of the tool, its well, supports and loads.

pub(crate) mod description;
mod paper;
pub(crate) mod section;
mod validation;
pub(crate) mod well;

pub use description::{
    BitDescription, Body, Direction, GapDescription, HingeAngle, JointDescription, JointKind, LiveParameters,
    LoadHistory, Location, Material, PointLoad, PointMass, Rayleigh, Support, ToolDescription, Tube, WellDescription,
    WellSection, WobPath,
};
pub use section::SectionProperties;
pub use well::{WellPath, frame_along, tangent};
