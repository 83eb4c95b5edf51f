//! The laws of the parts: beam, joint, gap.

pub mod beam;
pub mod element_force;
pub mod element_form;
pub mod gap;
pub mod jet;
pub mod joint;
pub mod joint_group;
pub mod rotation;
