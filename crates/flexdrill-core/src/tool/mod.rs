//! Description of the tool, its well, supports and loads.

pub(crate) mod description;
mod paper;
pub(crate) mod rig_validation;
pub(crate) mod section;
mod validation;
pub(crate) mod well;

pub use crate::elements::rock::{DepthOfCut, RockLaw, Weakening};
pub use crate::elements::string::{
    Feed, HangingTool, Hoist, Piece, SpeedController, StringDescription, TopDrive, TorsionalMode, WallFriction, Wave,
};
pub use description::{
    AddedMass, BitDescription, Body, Direction, FreeCurvature, FrictionLaw, GapDescription, HingeAngle, HoleInterval,
    JointDescription, JointKind, JointPlay, LiveParameters, LoadHistory, Location, Material, MudDamping,
    MudDescription, MudFilm, PinFriction, PointLoad, PointMass, PressureDescription, PressureEnd, PressureSource,
    Rayleigh, Shortening, Support, ToolDescription, Tube, WallFrictionFactors, WeightPlace, WellDescription,
    WellSection, WobPath,
};
pub use section::SectionProperties;
pub use well::{WellPath, frame_along, tangent};
