//! Eight numbers at once: kernels written once over [`Vector`](vector::Vector), run with the instructions that the
//! processor has.

pub(crate) mod aligned;
mod instructions;
pub(crate) mod number;
pub(crate) mod single;
pub(crate) mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use instructions::Instructions;
pub(crate) use instructions::Kernel;
