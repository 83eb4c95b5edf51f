//! An effect that only tests have.

pub(super) mod spring;
