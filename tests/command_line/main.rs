//! The command line as a user meets it, and the figures of the paper.

mod paper;
mod usage;
