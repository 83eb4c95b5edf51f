//! The mechanics of a flexible drilling tool in an ultrashort-radius well (Lin et al., Scientific Reports 2024), and what its
//! motion means. Numbers in, numbers out: nothing here knows of files, clocks, logs or middleware.

pub mod dynamics;
pub mod elements;
pub mod inputs;
mod linear;
pub mod model;
pub mod motion;
mod simd;
pub mod tool;
pub mod twin;
pub mod units;

pub use simd::Instructions;
