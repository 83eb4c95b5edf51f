//! The independent witness: residual and tangent of the whole tool, assembled beam by beam over all stations with the
//! multipliers of the joints among the unknowns, and solved by block LU and by faer's sparse LU.
//!
//! No run is taken here. Tests hold the chain against it: its residual, its tangent, its energies, and whole steps.

mod assembler;
mod axial;
mod constants;
mod contacts;
mod energy;
mod equations;
mod interactions;
mod joints;
pub(crate) mod linear;
mod residual;
mod shortening;
mod slots;
mod steps;
mod tangent;
mod tests;

pub(crate) use assembler::Assembler;
pub(crate) use energy::joint_violation;
pub(crate) use interactions::Interactions;
pub(crate) use shortening::add_shortening_tangent;
pub(crate) use slots::add_slots_tangent;
