//! The laws of the tool's parts, one per file: beam, joint, gap. What acts inside spans and at nodes beyond beams and
//! contacts is in `effects/`.

pub mod beam;
pub mod bend;
pub mod factors;
pub mod gap;
pub mod joint;
pub mod slip;
pub mod spine;
