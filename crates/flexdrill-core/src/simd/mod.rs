//! Eight numbers at once.

pub mod instructions;
pub mod number;
pub mod vector;

pub use instructions::Instructions;
