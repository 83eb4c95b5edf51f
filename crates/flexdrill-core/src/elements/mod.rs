//! The laws of the tool's parts, one per file: beam, joint, gap, rigid body on a node, the pressure in the pipe,
//! rock, string above. What acts inside spans beyond beams and contacts is in `effects/`.

pub mod beam;
pub mod factors;
pub mod gap;
pub mod joint;
pub mod pressure;
pub mod rock;
pub mod slip;
pub mod string;
