//! The 12-dof Euler-Bernoulli beam element, Eq. 2 to 7.
//!
//! Node order (u, v, w, psi, phi_y, phi_z) twice, Eq. 2, with phi_y = -dw/dx and phi_z = dv/dx. The shape functions are
//! those of Eq. 4 with its misprint in the (w, phi_y1) entry corrected to -(1 - 2 xi + xi^2) xi l; H of Eq. 6 takes second
//! derivatives in the bending rows. The torsional inertia is rho I_x (Eq. 5 prints rho A in every row).
//!
//! The four motions of a straight symmetric beam do not couple, so products with the element's matrices are written
//! motion by motion; [`ElementMatrix`] gives the same as full 12 x 12 matrices for the assembly.

use nalgebra::{SMatrix, SVector};

use crate::tool::section::SectionProperties;

/// Displacements or forces of an element's two nodes.
pub type ElementVector = SVector<f64, 12>;
/// A full element matrix.
pub type ElementMatrix = SMatrix<f64, 12, 12>;

/// A straight beam element of given section and length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Section.
    pub section: SectionProperties,
    /// Length (m).
    pub length: f64,
}

/// (deflection, slope, deflection, slope) entries of the bending motion in the x-y plane.
const BEND_V: [usize; 4] = [1, 5, 7, 11];
/// The same in the x-z plane, where the slope is -phi_y.
const BEND_W: [usize; 4] = [2, 4, 8, 10];

impl Beam {
    /// K q: elastic force of Eq. 6 (N, N m).
    pub fn stiffness_times(&self, q: &ElementVector) -> ElementVector {
        let l = self.length;
        let mut f = ElementVector::zeros();
        let axial = self.section.axial / l * (q[6] - q[0]);
        let torque = self.section.torsion / l * (q[9] - q[3]);
        f[0] = -axial;
        f[6] = axial;
        f[3] = -torque;
        f[9] = torque;
        let c = self.section.bending / (l * l * l);
        for (at, sign) in [(BEND_V, 1.0), (BEND_W, -1.0)] {
            // In terms of the rotation of the chord, so that a rigid motion cancels before it is multiplied.
            let chord = q[at[2]] - q[at[0]];
            let (s1, s2) = (sign * l * q[at[1]], sign * l * q[at[3]]);
            let shear = c * (12.0 * chord - 6.0 * (s1 + s2));
            f[at[0]] = -shear;
            f[at[2]] = shear;
            f[at[1]] = sign * c * l * (4.0 * s1 + 2.0 * s2 - 6.0 * chord);
            f[at[3]] = sign * c * l * (2.0 * s1 + 4.0 * s2 - 6.0 * chord);
        }
        f
    }

    /// M a: consistent inertia force of Eq. 5 (N, N m).
    pub fn mass_times(&self, a: &ElementVector) -> ElementVector {
        let l = self.length;
        let mut f = ElementVector::zeros();
        let m = self.section.mass * l / 6.0;
        f[0] = m * (2.0 * a[0] + a[6]);
        f[6] = m * (a[0] + 2.0 * a[6]);
        let j = self.section.spin_inertia * l / 6.0;
        f[3] = j * (2.0 * a[3] + a[9]);
        f[9] = j * (a[3] + 2.0 * a[9]);
        let c = self.section.mass * l / 420.0;
        for (at, sign) in [(BEND_V, 1.0), (BEND_W, -1.0)] {
            let (d1, d2) = (a[at[0]], a[at[2]]);
            let (s1, s2) = (sign * l * a[at[1]], sign * l * a[at[3]]);
            f[at[0]] = c * (156.0 * d1 + 22.0 * s1 + 54.0 * d2 - 13.0 * s2);
            f[at[2]] = c * (54.0 * d1 + 13.0 * s1 + 156.0 * d2 - 22.0 * s2);
            f[at[1]] = sign * l * c * (22.0 * d1 + 4.0 * s1 + 13.0 * d2 - 3.0 * s2);
            f[at[3]] = sign * l * c * (-13.0 * d1 - 3.0 * s1 - 22.0 * d2 + 4.0 * s2);
        }
        f
    }

    /// G q: lateral force per unit of axial tension, the geometric part of K_T in Eq. 41 (times N for the force).
    pub fn geometric_times(&self, q: &ElementVector) -> ElementVector {
        let l = self.length;
        let mut f = ElementVector::zeros();
        let c = 1.0 / (30.0 * l);
        for (at, sign) in [(BEND_V, 1.0), (BEND_W, -1.0)] {
            let chord = q[at[2]] - q[at[0]];
            let (s1, s2) = (sign * l * q[at[1]], sign * l * q[at[3]]);
            let shear = c * (36.0 * chord - 3.0 * (s1 + s2));
            f[at[0]] = -shear;
            f[at[2]] = shear;
            f[at[1]] = sign * l * c * (4.0 * s1 - s2 - 3.0 * chord);
            f[at[3]] = sign * l * c * (4.0 * s2 - s1 - 3.0 * chord);
        }
        f
    }

    /// Axial force in the element, tension positive (N).
    pub fn axial_force(&self, q: &ElementVector) -> f64 {
        self.section.axial / self.length * (q[6] - q[0])
    }

    /// Consistent nodal forces of an acceleration field `g` (m/s2) in the element's frame.
    pub fn weight(&self, g: [f64; 3]) -> ElementVector {
        let l = self.length;
        let half = 0.5 * self.section.mass * l;
        let couple = self.section.mass * l * l / 12.0;
        ElementVector::from_column_slice(&[
            half * g[0],
            half * g[1],
            half * g[2],
            0.0,
            -couple * g[2],
            couple * g[1],
            half * g[0],
            half * g[1],
            half * g[2],
            0.0,
            couple * g[2],
            -couple * g[1],
        ])
    }

    /// K as a full matrix.
    pub fn stiffness(&self) -> ElementMatrix {
        columns(|q| self.stiffness_times(q))
    }

    /// M as a full matrix.
    pub fn mass(&self) -> ElementMatrix {
        columns(|q| self.mass_times(q))
    }

    /// G as a full matrix.
    pub fn geometric(&self) -> ElementMatrix {
        columns(|q| self.geometric_times(q))
    }
}

fn columns(product: impl Fn(&ElementVector) -> ElementVector) -> ElementMatrix {
    let mut matrix = ElementMatrix::zeros();
    for j in 0..12 {
        let mut unit = ElementVector::zeros();
        unit[j] = 1.0;
        matrix.set_column(j, &product(&unit));
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::description::{Material, Tube};

    fn beam() -> Beam {
        let steel = Material {
            youngs_modulus: 206e9,
            poisson_ratio: 0.3,
            density: 7850.0,
        };
        let tube = Tube {
            outer_diameter: 0.063,
            inner_diameter: 0.032,
        };
        Beam {
            section: SectionProperties::of(tube, steel, 1.0),
            length: 0.03,
        }
    }

    #[test]
    fn rigid_motions_need_no_force() {
        let b = beam();
        let l = b.length;
        let mut motions = vec![];
        for d in 0..4 {
            let mut q = ElementVector::zeros();
            q[d] = 0.01;
            q[d + 6] = 0.01;
            motions.push(q);
        }
        let mut about_z = ElementVector::zeros();
        (about_z[5], about_z[11], about_z[7]) = (0.01, 0.01, 0.01 * l);
        let mut about_y = ElementVector::zeros();
        (about_y[4], about_y[10], about_y[8]) = (0.01, 0.01, -0.01 * l);
        motions.extend([about_z, about_y]);
        let scale = b.stiffness().amax() * 0.01;
        for q in motions {
            // Rounding of the largest entry.
            assert!(b.stiffness_times(&q).amax() < 1e-14 * scale, "{q}");
        }
    }

    #[test]
    fn matrices_are_symmetric_and_the_mass_is_the_beams() {
        let b = beam();
        for m in [b.stiffness(), b.mass(), b.geometric()] {
            assert!((m - m.transpose()).amax() <= 1e-15 * m.amax());
        }
        for d in 0..3 {
            let mut rigid = ElementVector::zeros();
            rigid[d] = 1.0;
            rigid[d + 6] = 1.0;
            let total = rigid.dot(&b.mass_times(&rigid));
            assert!((total / (b.section.mass * b.length) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_tilted_stretched_element_pulls_back_with_its_tension() {
        let b = beam();
        let slope = 1e-3;
        let mut q = ElementVector::zeros();
        (q[5], q[11], q[7]) = (slope, slope, slope * b.length);
        let f = b.geometric_times(&q);
        // A rigid tilt turns the tension: transverse end forces +-slope, no couples.
        assert!((f[7] - slope).abs() < 1e-15 && (f[1] + slope).abs() < 1e-15);
        assert!(f[5].abs() < 1e-15 && f[11].abs() < 1e-15);
    }
}
