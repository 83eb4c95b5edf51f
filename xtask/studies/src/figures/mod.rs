//! The pictures of documents that no command of the program draws.

pub(crate) mod physics;
pub(crate) mod speed;
pub(crate) mod spine;
pub(crate) mod whirl;
