//! The mechanics of a flexible drilling tool in an ultrashort-radius well (Lin et al., Scientific Reports 2024), and what its
//! motion means. Numbers in, numbers out: nothing here knows of files, clocks, logs or middleware.

#![allow(unsafe_code)]
pub mod dynamics;
pub mod elements;
pub mod inputs;
pub mod linear;
pub mod model;
pub mod motion;
pub mod simd;
pub mod tool;
pub mod twin;
pub mod units;
