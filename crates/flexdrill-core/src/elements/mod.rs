//! The laws of the tool's parts, one per file: beam, joint. What acts inside spans and at nodes beyond these is in
//! `effects/`.

pub mod beam;
pub mod bend;
pub mod factors;
pub mod joint;
pub mod slip;
pub mod spine;
