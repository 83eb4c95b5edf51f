//! The laws of the tool's parts, one per file: beam, joint, gap, rigid body on a node, the guide's preload and slots, the
//! pressure in the pipe, the mud around it, rock, string above.

pub mod beam;
pub mod gap;
pub mod joint;
pub mod mud;
pub mod mud_wall;
pub mod point_body;
pub mod preload;
pub mod pressure;
pub mod rock;
pub mod shortening;
pub mod slip;
pub mod slots;
pub mod string;
