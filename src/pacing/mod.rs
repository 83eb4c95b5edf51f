//! Pacing by absolute deadlines.
