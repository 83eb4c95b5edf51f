//! The curvature of a tube's axis in the tube's own axes, to second order in its rotations.
//!
//! A tube in a path of curvature kb turns by psi about its axis and tilts by phi_y and phi_z. Along two directions that turn
//! with it, 1 towards the path's high side at psi = 0 and 2 across it, its curvature changes from that in the path by
//!
//! ```text
//! k_1 = phi_y' + phi_z' psi - kb (psi^2 + phi_z^2) / 2,      k_2 = phi_z' - kb psi - phi_y' psi + kb phi_y phi_z / 2,
//! ```
//!
//! primes along the node frames. What is proportional to such a curvature, the energy of a bend as made or of an axial force off
//! the axis, has the second derivatives below: a stiffness that turns with the tube. Signs: phi_y = -dw/dx and
//! phi_z = dv/dx; kb > 0 builds towards the high side, against z; psi turns y towards z. SI.

use crate::elements::beam::ElementMatrix;

/// Index of (psi, phi_y, phi_z) of both nodes among an element's twelve values.
pub const PSI: [usize; 2] = [3, 9];
/// See [`PSI`].
pub const PHI_Y: [usize; 2] = [4, 10];
/// See [`PSI`].
pub const PHI_Z: [usize; 2] = [5, 11];

/// Second derivatives of int `along` k_1 + `across` k_2 ds over an element by its rotations in the node frames, which are
/// `turned` by kb ds against each other (rad); `cos` is that of half of this.
pub fn second_order(along: f64, across: f64, turned: f64, cos: f64) -> ElementMatrix {
    let mut stiffness = ElementMatrix::zeros();
    // The second derivatives of factor x a x b, for two linear forms over the nodes.
    let mut add = |factor: f64, (at, a): ([usize; 2], [f64; 2]), (by, b): ([usize; 2], [f64; 2])| {
        for (row, a) in at.into_iter().zip(a) {
            for (column, b) in by.into_iter().zip(b) {
                stiffness[(row, column)] += factor * a * b;
                stiffness[(column, row)] += factor * a * b;
            }
        }
    };
    // Means and differences of the two nodes are the modes in which the curvature is written.
    let (mean, change) = ([0.5, 0.5], [-1.0, 1.0]);
    add(along * cos, (PHI_Z, change), (PSI, mean));
    add(-0.5 * along * turned, (PSI, mean), (PSI, mean));
    add(-0.5 * along * turned, (PHI_Z, mean), (PHI_Z, mean));
    add(-across, (PHI_Y, change), (PSI, mean));
    add(0.5 * across * turned, (PHI_Y, mean), (PHI_Z, mean));
    stiffness
}
