//! The laws of the parts: beam, joint, gap, bodies on nodes, bit.

pub mod beam;
pub mod bit;
pub mod element_form;
pub mod gap;
pub mod joint;
pub mod point_body;
pub mod slip;
