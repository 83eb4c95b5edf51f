//! How the twin is doing, in figures (`twin/status`) and judgements (`/diagnostics`).

pub mod diagnostics;
pub mod meters;
pub mod motion;
pub mod status;
