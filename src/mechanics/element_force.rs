//! Products with a beam element's matrices as the time integration needs them: all forces in one pass, and the energies' bilinear forms.
//!
//! [`super::beam::Beam`] is the plain form of the same; here its coefficients are worked out once and nothing is computed twice.

use nalgebra::Matrix3;

use super::beam::Beam;

/// Displacements or forces of an element's two nodes.
pub type Ends = [f64; 12];

/// (deflection, slope, deflection, slope) of the bending planes with the sign of the slope.
const PLANES: [([usize; 4], f64); 2] = [([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)];

/// A beam's coefficients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementForce {
    /// Length (m).
    length: f64,
    /// E A / l (N/m).
    axial: f64,
    /// G J / l (N m/rad).
    torsion: f64,
    /// E I / l^3 (N/m).
    bending: f64,
    /// 1 / (30 l) (1/m).
    geometric: f64,
    /// rho A l / 6 (kg).
    mass: f64,
    /// rho I_x l / 6 (kg m2).
    spin: f64,
    /// rho A l / 420 (kg).
    swing: f64,
}

impl ElementForce {
    /// Coefficients of `beam`.
    pub fn of(beam: &Beam) -> Self {
        let l = beam.length;
        let section = &beam.section;
        Self {
            length: l,
            axial: section.axial / l,
            torsion: section.torsion / l,
            bending: section.bending / (l * l * l),
            geometric: 1.0 / (30.0 * l),
            mass: section.mass * l / 6.0,
            spin: section.spin_inertia * l / 6.0,
            swing: section.mass * l / 420.0,
        }
    }

    /// K x + M a + N G q (N, N m), with tension N.
    #[inline(always)]
    pub fn total(&self, x: &Ends, a: &Ends, q: &Ends, tension: f64) -> Ends {
        let mut f = [0.0; 12];
        let axial = self.axial * (x[6] - x[0]);
        f[0] = self.mass * (2.0 * a[0] + a[6]) - axial;
        f[6] = self.mass * (a[0] + 2.0 * a[6]) + axial;
        let torque = self.torsion * (x[9] - x[3]);
        f[3] = self.spin * (2.0 * a[3] + a[9]) - torque;
        f[9] = self.spin * (a[3] + 2.0 * a[9]) + torque;
        let g = tension * self.geometric;
        let (c, m) = (self.bending, self.swing);
        for (at, sign) in PLANES {
            let l = sign * self.length;
            // In terms of the rotation of the chord, so that a rigid motion cancels before it is multiplied.
            let (chord, s1, s2) = (x[at[2]] - x[at[0]], l * x[at[1]], l * x[at[3]]);
            let (line, t1, t2) = (q[at[2]] - q[at[0]], l * q[at[1]], l * q[at[3]]);
            let (d1, d2, r1, r2) = (a[at[0]], a[at[2]], l * a[at[1]], l * a[at[3]]);
            let shear = c * (12.0 * chord - 6.0 * (s1 + s2)) + g * (36.0 * line - 3.0 * (t1 + t2));
            f[at[0]] = m * (156.0 * d1 + 22.0 * r1 + 54.0 * d2 - 13.0 * r2) - shear;
            f[at[2]] = m * (54.0 * d1 + 13.0 * r1 + 156.0 * d2 - 22.0 * r2) + shear;
            f[at[1]] = l
                * (c * (4.0 * s1 + 2.0 * s2 - 6.0 * chord)
                    + g * (4.0 * t1 - t2 - 3.0 * line)
                    + m * (22.0 * d1 + 4.0 * r1 + 13.0 * d2 - 3.0 * r2));
            f[at[3]] = l
                * (c * (2.0 * s1 + 4.0 * s2 - 6.0 * chord)
                    + g * (4.0 * t2 - t1 - 3.0 * line)
                    + m * (-13.0 * d1 - 3.0 * r1 - 22.0 * d2 + 4.0 * r2));
        }
        f
    }

    /// x . K y (J).
    #[inline(always)]
    pub fn stiffness_between(&self, x: &Ends, y: &Ends) -> f64 {
        let mut sum = self.axial * (x[6] - x[0]) * (y[6] - y[0]) + self.torsion * (x[9] - x[3]) * (y[9] - y[3]);
        for (at, sign) in PLANES {
            let l = sign * self.length;
            // Slopes against the chord: the bending that is left.
            let bend = |x: &Ends| {
                let chord = x[at[2]] - x[at[0]];
                (l * x[at[1]] - chord, l * x[at[3]] - chord)
            };
            let ((x1, x2), (y1, y2)) = (bend(x), bend(y));
            sum += self.bending * (x1 * (4.0 * y1 + 2.0 * y2) + x2 * (2.0 * y1 + 4.0 * y2));
        }
        sum
    }

    /// x . M y (J).
    #[inline(always)]
    pub fn mass_between(&self, x: &Ends, y: &Ends) -> f64 {
        let mut sum = self.mass * (x[0] * (2.0 * y[0] + y[6]) + x[6] * (y[0] + 2.0 * y[6]))
            + self.spin * (x[3] * (2.0 * y[3] + y[9]) + x[9] * (y[3] + 2.0 * y[9]));
        for (at, sign) in PLANES {
            let l = sign * self.length;
            let (d1, d2, r1, r2) = (y[at[0]], y[at[2]], l * y[at[1]], l * y[at[3]]);
            sum += self.swing
                * (x[at[0]] * (156.0 * d1 + 22.0 * r1 + 54.0 * d2 - 13.0 * r2)
                    + x[at[2]] * (54.0 * d1 + 13.0 * r1 + 156.0 * d2 - 22.0 * r2)
                    + l * (x[at[1]] * (22.0 * d1 + 4.0 * r1 + 13.0 * d2 - 3.0 * r2)
                        + x[at[3]] * (-13.0 * d1 - 3.0 * r1 - 22.0 * d2 + 4.0 * r2)));
        }
        sum
    }

    /// Tension N (N) at displacements `q`.
    #[inline(always)]
    pub fn tension(&self, q: &Ends) -> f64 {
        self.axial * (q[6] - q[0])
    }
}

/// Node frames to the chord's frame where they differ by turns about y only, as they do in a plane well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarTurn {
    /// Cosine and sine per node.
    nodes: [[f64; 2]; 2],
}

impl PlanarTurn {
    /// From the rotations themselves.
    pub fn of(rotation: &[Matrix3<f64>; 2]) -> Self {
        Self {
            nodes: rotation.map(|r| [r[(0, 0)], r[(0, 2)]]),
        }
    }

    /// Cosine and sine per node.
    pub fn nodes(&self) -> [[f64; 2]; 2] {
        self.nodes
    }

    /// Nodal values to the chord's frame, Eq. 8.
    #[inline(always)]
    pub fn to_chord(&self, x: &Ends) -> Ends {
        self.turn(x, 1.0)
    }

    /// Forces in the chord's frame to the nodes' frames.
    #[inline(always)]
    pub fn from_chord(&self, f: &Ends) -> Ends {
        self.turn(f, -1.0)
    }

    #[inline(always)]
    fn turn(&self, x: &Ends, sense: f64) -> Ends {
        let mut out = *x;
        for k in 0..4 {
            let [cos, sin] = self.nodes[k / 2];
            let (along, across, sin) = (x[3 * k], x[3 * k + 2], sense * sin);
            out[3 * k] = cos * along + sin * across;
            out[3 * k + 2] = cos * across - sin * along;
        }
        out
    }
}

/// Values of two nodes that begin at `first` and `second`.
#[inline(always)]
pub fn ends(values: &[f64], first: usize, second: usize) -> Ends {
    let mut x = [0.0; 12];
    x[..6].copy_from_slice(&values[first..first + 6]);
    x[6..].copy_from_slice(&values[second..second + 6]);
    x
}

/// x + factor y.
#[inline(always)]
pub fn plus(x: &Ends, factor: f64, y: &Ends) -> Ends {
    let mut sum = *x;
    for i in 0..12 {
        sum[i] += factor * y[i];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::beam::ElementVector;
    use crate::mechanics::description::{Material, Tube};
    use crate::mechanics::section::SectionProperties;
    use nalgebra::Rotation3;

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

    fn values(seed: f64) -> Ends {
        std::array::from_fn(|i| (seed + 1.7 * i as f64).sin())
    }

    #[test]
    fn forces_and_forms_are_those_of_the_plain_beam() {
        let beam = beam();
        let force = ElementForce::of(&beam);
        let (x, a, q) = (values(0.3), values(1.1), values(2.9));
        let plain = |x: &Ends| ElementVector::from_column_slice(x);
        let expected =
            beam.stiffness_times(&plain(&x)) + beam.mass_times(&plain(&a)) + beam.geometric_times(&plain(&q)) * 1e8;
        let got = plain(&force.total(&x, &a, &q, 1e8));
        // Rounding of sums of a dozen terms.
        assert!((got - expected).amax() < 1e-14 * expected.amax());
        let near =
            |got: f64, expected: f64, scale: f64| assert!((got - expected).abs() < 1e-13 * scale, "{got} {expected}");
        let (k, m) = (beam.stiffness_times(&plain(&a)), beam.mass_times(&plain(&a)));
        near(force.stiffness_between(&x, &a), plain(&x).dot(&k), k.amax());
        near(force.mass_between(&x, &a), plain(&x).dot(&m), m.amax());
        near(force.tension(&q), beam.axial_force(&plain(&q)), 1e10);
    }

    #[test]
    fn a_planar_turn_is_the_rotation_about_y() {
        let rotation =
            [0.2_f64, -0.3].map(|angle| *Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), angle).matrix());
        let turn = PlanarTurn::of(&rotation);
        let x = values(0.7);
        let turned = turn.to_chord(&x);
        for k in 0..4 {
            let part = nalgebra::Vector3::new(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
            let expected = rotation[k / 2] * part;
            (0..3).for_each(|i| assert!((turned[3 * k + i] - expected[i]).abs() < 1e-15));
        }
        for (back, x) in turn.from_chord(&turned).iter().zip(x) {
            assert!((back - x).abs() < 1e-15);
        }
    }
}
