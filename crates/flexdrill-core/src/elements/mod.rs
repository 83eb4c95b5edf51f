//! The laws of the parts: beam, joint, gap.

pub mod beam;
pub mod element_form;
pub mod gap;
pub mod joint;
