//! Elimination along the joints: what lies between two joints is condensed beforehand.
//!
//! Between its joints a link is linear, and so is the guide between two joint stations; their matrices last as long as
//! the step size does. So the inner stations of every span are eliminated once per step size ([`substructure`]), and an
//! iteration works on joints only ([`forward`]): 34 blocks of 16 for the paper's tool instead of 170 stations. Where
//! the guide touches the wall inside a span, the guide's inner stations are eliminated anew ([`guide_contact`]); where the
//! pipe touches the guide there, the span's stations take part in the sweep one by one. See `docs/solver.md`.
//!
//! Order inside a block of 16: rotations of the end above (0..3), its displacement (3..6), rotations of the start below
//! (6..9), guide (9..15), rotational multiplier (15). The displacement of the start below and the translational
//! multipliers are taken out as in [`joint_reduction`]. Stations without a joint have one pipe node: rotations at 0..3,
//! displacement at 3..6.

mod backward;
mod forward;
mod guide_contact;
mod increment;
mod joint_reduction;
mod pivots;
mod span;
mod spans;
mod substructure;
mod system;

pub use forward::CondensedElimination;
pub use increment::{add_joint, take};
pub use pivots::sixteen;
pub use system::CondensedSystem;

/// Unknowns per block.
const SIZE: usize = 16;
/// First of the displacement of the end above.
const U: usize = 3;
/// First of the rotations of the start below.
const BELOW: usize = 6;
/// First of the guide.
const GUIDE: usize = 9;
/// Place of the rotational multiplier in a block.
const MULTIPLIER: usize = 15;
/// Columns per block: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;
/// Place of each pipe unknown (u, v, w, psi, phi_y, phi_z) of the end above.
const PIPE_PLACES: [usize; 6] = [3, 4, 5, 0, 1, 2];

/// A block by columns.
type Block = [[f64; SIZE]; SIZE];
/// Solved columns of a block.
type Columns = [[f64; SIZE]; COLUMNS];
/// PaddedColumns columns of six, each filled up to a vector of eight.
type PaddedColumns = [[f64; 8]; 6];
