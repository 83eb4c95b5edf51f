//! The plain form: residual and tangent over all stations of the tool, solved by block LU.
//!
//! It finds the static start, and tests hold the chain against it. No step of a run is taken here.

mod assembler;
mod contacts;
mod equations;
mod joints;
mod residual;
mod shortening;
mod slots;
mod tangent;

pub(crate) use assembler::Assembler;
pub(crate) use contacts::{add_mud_forces, inner_forces, mud_motions, outer_force};
pub(crate) use equations::{StationEquations, StationRoom};
#[cfg(test)]
pub(crate) use shortening::add_shortening_tangent;
pub(crate) use shortening::turned_by_shortening;
#[cfg(test)]
pub(crate) use slots::add_slots_tangent;
pub(crate) use slots::slots_energy;
