//! What a calibration reads: the samples of a field log or a bag. The calibration is the crate [`flexdrill_fit`].

pub mod samples;
