//! An element's tension from the values of its two nodes, for the axial force that a step foresees, and the turn of a guide element's nodes
//! into its chord. All its forces are in [`crate::elements::element_form`].

use nalgebra::Matrix3;

use crate::elements::beam::Beam;

/// Displacements or forces of an element's two nodes.
pub type Ends = [f64; 12];

/// What an element's tension follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementForce {
    /// E A / l (N/m).
    axial: f64,
}

impl ElementForce {
    /// Of `beam`.
    pub fn of(beam: &Beam) -> Self {
        Self {
            axial: beam.section.axial / beam.length,
        }
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
        let mut out = *x;
        for k in 0..4 {
            let [cos, sin] = self.nodes[k / 2];
            let (along, across) = (x[3 * k], x[3 * k + 2]);
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
    use crate::elements::beam::ElementVector;
    use crate::tool::description::{Material, Tube};
    use crate::tool::section::SectionProperties;
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
    fn the_tension_is_that_of_the_plain_beam() {
        let beam = beam();
        let q = values(2.9);
        let expected = beam.axial_force(&ElementVector::from_column_slice(&q));
        let got = ElementForce::of(&beam).tension(&q);
        // Rounding of three operations.
        assert!((got - expected).abs() < 1e-14 * expected.abs(), "{got} {expected}");
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
    }
}
