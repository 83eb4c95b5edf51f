//! The 12-dof Euler-Bernoulli beam element, Eq. 2 to 7.
//!
//! Node order (u, v, w, psi, phi_y, phi_z) twice, Eq. 2, with phi_y = -dw/dx and phi_z = dv/dx. The shape functions are
//! those of Eq. 4 with its misprint in the (w, phi_y1) entry corrected to -(1 - 2 xi + xi^2) xi l; H of Eq. 6 takes
//! second derivatives in the bending rows. The torsional inertia is rho I_x (Eq. 5 prints rho A in every row).
//!
//! The four motions of a straight symmetric beam (stretch, twist, bending in x-y and in x-z) do not couple, so each
//! matrix consists of the matrix of a rod, twice, and that of a bending beam, twice. This file has them once, as the
//! integrals yield them. A test compares the matrices with the integrals of
//! Eq. 5 and 6.

use nalgebra::{SMatrix, SVector};

use crate::tool::SectionProperties;

/// Displacements (Eq. 2) or forces of the two nodes of an element.
pub type ElementVector = SVector<f64, 12>;
/// A full element matrix.
pub type ElementMatrix = SMatrix<f64, 12, 12>;

/// A straight beam element of given section and length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// Stiffnesses and masses per length of its section.
    pub section: SectionProperties,
    /// Length between its two nodes (m).
    pub length: f64,
}

/// Symmetric matrix of a rod over the values of its two ends.
type RodMatrix = [[f64; 2]; 2];
/// Symmetric matrix of bending in one plane over (deflection, slope) of its two ends.
type BendingMatrix = [[f64; 4]; 4];

impl Beam {
    /// K of Eq. 6 (N/m, N, N m/rad).
    pub fn stiffness(&self) -> ElementMatrix {
        let l = self.length;
        let rod = |stiffness: f64| scaled(stiffness / l, [[1.0, -1.0], [-1.0, 1.0]]);
        let bending = scaled(
            self.section.bending / (l * l * l),
            [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
            ],
        );
        element(rod(self.section.axial), rod(self.section.torsion), bending)
    }

    /// M of Eq. 5, consistent (kg, kg m, kg m2).
    pub fn mass(&self) -> ElementMatrix {
        let l = self.length;
        let rod = |inertia: f64| scaled(inertia * l / 6.0, [[2.0, 1.0], [1.0, 2.0]]);
        let bending = scaled(
            self.section.mass * l / 420.0,
            [
                [156.0, 22.0 * l, 54.0, -13.0 * l],
                [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
                [54.0, 13.0 * l, 156.0, -22.0 * l],
                [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
            ],
        );
        element(rod(self.section.mass), rod(self.section.spin_inertia), bending)
    }

    /// G, the geometric part of K_T in Eq. 41 per unit of axial tension (1/m, -, m): G N q are the lateral forces of a
    /// tension N.
    pub fn geometric(&self) -> ElementMatrix {
        let l = self.length;
        let bending = scaled(
            1.0 / (30.0 * l),
            [
                [36.0, 3.0 * l, -36.0, 3.0 * l],
                [3.0 * l, 4.0 * l * l, -3.0 * l, -l * l],
                [-36.0, -3.0 * l, 36.0, -3.0 * l],
                [3.0 * l, -l * l, -3.0 * l, 4.0 * l * l],
            ],
        );
        element([[0.0; 2]; 2], [[0.0; 2]; 2], bending)
    }

    /// [`Beam::geometric`] of an element along a path of this `curvature` (1/m), with what a wall does as the pipe slides.
    ///
    /// A pipe that moves by s along an arc stays as far from the wall, which pushes it towards the arc's centre from its new
    /// position on: the distance is w + kappa s^2 / 2, and its force F has the part F kappa s along the old position's path. A
    /// wall that carries the thrust of the pipe pushes with F = - N kappa per length, so that its part per length is - N kappa^2
    /// s. Without it N kappa s of the weight would be missing per turned angle. With the mean s of both ends' u,
    ///
    /// ```text
    /// G - kappa^2 l s s'
    /// ```
    pub fn geometric_along(&self, curvature: f64) -> ElementMatrix {
        let mut out = self.geometric();
        let part = 0.25 * curvature * curvature * self.length;
        for i in [0, 6] {
            for j in [0, 6] {
                out[(i, j)] -= part;
            }
        }
        out
    }

    /// Axial force at an elongation (m), tension positive (N).
    pub fn tension(&self, elongation: f64) -> f64 {
        self.section.axial / self.length * elongation
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
}

fn scaled<const N: usize>(factor: f64, matrix: [[f64; N]; N]) -> [[f64; N]; N] {
    matrix.map(|row| row.map(|x| factor * x))
}

/// The element's matrix from those of its motions: (u), (psi), (v, phi_z) and (w, -phi_y).
fn element(stretch: RodMatrix, twist: RodMatrix, bending: BendingMatrix) -> ElementMatrix {
    let mut out = ElementMatrix::zeros();
    for (rows, rod) in [([0, 6], stretch), ([3, 9], twist)] {
        for i in 0..2 {
            for j in 0..2 {
                out[(rows[i], rows[j])] = rod[i][j];
            }
        }
    }
    // phi_z = dv/dx, but phi_y = -dw/dx: in the x-z plane the slopes enter with the opposite sign.
    for (rows, slope) in [([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)] {
        let signs = [1.0, slope, 1.0, slope];
        for i in 0..4 {
            for j in 0..4 {
                out[(rows[i], rows[j])] = signs[i] * signs[j] * bending[i][j];
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::{Material, Tube};

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

    /// Rows of N, Eq. 4, over the twelve nodal values: (u, v, w, psi) at xi = x / l, with the (w, phi_y1) entry
    /// corrected.
    fn shape_functions(xi: f64, l: f64) -> [[f64; 12]; 4] {
        let (c1, c2) = (
            1.0 - 3.0 * xi * xi + 2.0 * xi * xi * xi,
            3.0 * xi * xi - 2.0 * xi * xi * xi,
        );
        let (s1, s2) = ((1.0 - 2.0 * xi + xi * xi) * xi * l, (-xi * xi + xi * xi * xi) * l);
        let mut n = [[0.0; 12]; 4];
        (n[0][0], n[0][6]) = (1.0 - xi, xi);
        (n[1][1], n[1][5], n[1][7], n[1][11]) = (c1, s1, c2, s2);
        (n[2][2], n[2][4], n[2][8], n[2][10]) = (c1, -s1, c2, -s2);
        (n[3][3], n[3][9]) = (1.0 - xi, xi);
        n
    }

    /// `order` derivatives in x of [`shape_functions`], by central differences that are exact for cubics.
    fn derivative(xi: f64, l: f64, order: usize) -> [[f64; 12]; 4] {
        let h = 0.25;
        let at = |by: f64| shape_functions(xi + by * h, l);
        let mut out = [[0.0; 12]; 4];
        for (i, row) in out.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let f = |by: f64| at(by)[i][j];
                *entry = match order {
                    1 => (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / (12.0 * h * l),
                    _ => (f(1.0) - 2.0 * f(0.0) + f(-1.0)) / (h * h * l * l),
                };
            }
        }
        out
    }

    /// Integral over the element of the sum of weight_i row_i^T row_i, by four Gauss points: exact up to the seventh
    /// power.
    fn integral(l: f64, weights: [f64; 4], rows: impl Fn(f64) -> [[f64; 12]; 4]) -> ElementMatrix {
        let (near, far) = (0.339_981_043_584_856_3, 0.861_136_311_594_052_6);
        let (heavy, light) = (0.652_145_154_862_546_1, 0.347_854_845_137_453_9);
        let mut out = ElementMatrix::zeros();
        for (point, share) in [(-far, light), (-near, heavy), (near, heavy), (far, light)] {
            for (row, weight) in rows(0.5 * (1.0 + point)).iter().zip(weights) {
                let row = ElementVector::from_column_slice(row);
                out += row * row.transpose() * (0.5 * l * share * weight);
            }
        }
        out
    }

    #[test]
    fn matrices_are_the_integrals_of_the_paper() {
        let b = beam();
        let (s, l) = (b.section, b.length);
        let mass = integral(l, [s.mass, s.mass, s.mass, s.spin_inertia], |xi| shape_functions(xi, l));
        // H of Eq. 6: first derivatives of u and psi, second ones of v and w.
        let stiffness = integral(l, [s.axial, 0.0, 0.0, s.torsion], |xi| derivative(xi, l, 1))
            + integral(l, [0.0, s.bending, s.bending, 0.0], |xi| derivative(xi, l, 2));
        let geometric = integral(l, [0.0, 1.0, 1.0, 0.0], |xi| derivative(xi, l, 1));
        for (printed, integrated) in [(b.mass(), mass), (b.stiffness(), stiffness), (b.geometric(), geometric)] {
            for i in 0..12 {
                for j in 0..12 {
                    // Entry by entry against its own row's and column's size, since units differ; differences cost
                    // three digits.
                    let scale = (printed[(i, i)] * printed[(j, j)]).sqrt().max(f64::MIN_POSITIVE);
                    let off = (printed[(i, j)] - integrated[(i, j)]).abs();
                    assert!(
                        off < 1e-12 * scale,
                        "({i}, {j}): {} {}",
                        printed[(i, j)],
                        integrated[(i, j)]
                    );
                }
            }
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
            assert!((b.stiffness() * q).amax() < 1e-14 * scale, "{q}");
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
            let total = rigid.dot(&(b.mass() * rigid));
            assert!((total / (b.section.mass * b.length) - 1.0).abs() < 1e-14);
        }
    }

    /// A slide along an arc, which turns the element about the arc's centre, takes no work of tension and wall together.
    #[test]
    fn a_slide_along_the_path_takes_no_work() {
        let b = beam();
        let (curvature, slide) = (1.0 / 3.2, 0.05);
        let mut q = ElementVector::zeros();
        for (first, side) in [(0, 0.5), (6, -0.5)] {
            q[first] = slide;
            q[first + 2] = side * b.length * curvature * slide;
            q[first + 4] = curvature * slide;
        }
        let g = b.geometric_along(curvature);
        let of_tension = q.dot(&(b.geometric() * q));
        // Rounding of what the tension alone takes.
        assert!(of_tension > 1e-6 && q.dot(&(g * q)).abs() < 1e-14 * of_tension);
        assert!((g - g.transpose()).amax() == 0.0);
        assert_eq!(b.geometric_along(0.0), b.geometric());
    }

    #[test]
    fn a_tilted_stretched_element_pulls_back_with_its_tension() {
        let b = beam();
        let slope = 1e-3;
        let mut q = ElementVector::zeros();
        (q[5], q[11], q[7]) = (slope, slope, slope * b.length);
        let f = b.geometric() * q;
        // A rigid tilt turns the tension: transverse end forces +-slope, no couples.
        assert!((f[7] - slope).abs() < 1e-15 && (f[1] + slope).abs() < 1e-15);
        assert!(f[5].abs() < 1e-15 && f[11].abs() < 1e-15);
    }
}
