//! The laws of the tool's parts, one per file: beam, joint, gap, rigid body on a node, bit.

pub mod beam;
pub mod bit;
pub mod element_form;
pub mod gap;
pub mod joint;
pub mod point_body;
pub mod slip;
