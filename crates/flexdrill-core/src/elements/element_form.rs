//! Beam matrices packed for the residual, which multiplies them with nodal values, one node per vector of eight lanes.
//!
//! In its own frame an element couples u with u, psi with psi and, in each bending plane, a deflection with a slope:
//! (v, phi_z) and (w, phi_y). Each 6 x 6 part of an element matrix therefore has two non-zero entries per row at most:
//!
//! ```text
//!          u   v   w  psi  phi_y phi_z
//!   u      d   .   .   .    .    .
//!   v      .   d   .   .    .    p          d: diagonal
//!   w      .   .   d   .    p    .          p: paired, deflection with slope
//!   psi    .   .   .   d    .    .
//!   phi_y  .   .   p   .    d    .
//!   phi_z  .   p   .   .    .    d
//! ```
//!
//! A product with a node is then the diagonal times the lanes, plus the paired entries times the lanes in paired order
//! ([`Vector::paired`]): two fused operations instead of six.

use nalgebra::Matrix3;

use crate::elements::beam::{Beam, ElementMatrix};
use crate::simd::vector::{Vector, part};

/// A node's six values (u, v, w, psi, phi_y, phi_z), and two unused lanes.
pub type Lanes = [f64; 8];

/// The other unknown of the same bending plane.
const PAIR: [usize; 6] = [0, 5, 4, 3, 2, 1];

/// Loads the node that begins at `first`. The two unused lanes hold the values that follow in the array, which spares a
/// mask; the matrices have zeros there.
#[inline(always)]
pub fn load<V: Vector>(values: &[f64], first: usize) -> V {
    match part(values, first) {
        Some(part) => V::load(part),
        None => {
            let mut lanes = [0.0; 8];
            lanes[..6].copy_from_slice(&values[first..first + 6]);
            V::load(&lanes)
        }
    }
}

/// Adds a node's forces to those that begin at `first`. The two unused lanes of `force` are zero, so that a full store
/// leaves the next node unchanged.
#[inline(always)]
pub fn add<V: Vector>(values: &mut [f64], first: usize, force: V) {
    match values.get_mut(first..first + 8).and_then(|part| part.first_chunk_mut()) {
        Some(part) => V::load(part).plus(force).store(part),
        None => {
            let mut lanes = [0.0; 8];
            force.store(&mut lanes);
            for (x, f) in values[first..first + 6].iter_mut().zip(lanes) {
                *x += f;
            }
        }
    }
}

/// Values of both nodes of an element.
pub type Both<V> = [V; 2];

/// An element matrix in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementForm {
    /// Diagonals by row node and column node.
    diagonal: [[Lanes; 2]; 2],
    /// Couplings of a deflection with a slope, by row node and column node.
    paired: [[Lanes; 2]; 2],
}

impl ElementForm {
    /// Packs `matrix`, whose entries elsewhere are zero.
    pub fn of(matrix: &ElementMatrix) -> Self {
        let filled = |entry: &dyn Fn(usize, usize, usize) -> f64| {
            std::array::from_fn(|row| {
                std::array::from_fn(|column| {
                    std::array::from_fn(|k| if k < 6 { entry(6 * row, 6 * column, k) } else { 0.0 })
                })
            })
        };
        Self {
            diagonal: filled(&|row, column, k| matrix[(row + k, column + k)]),
            paired: filled(&|row, column, k| {
                if PAIR[k] == k {
                    0.0
                } else {
                    matrix[(row + k, column + PAIR[k])]
                }
            }),
        }
    }

    /// Adds the matrix times `x` to `out`.
    #[inline(always)]
    pub fn add_product<V: Vector>(&self, x: Both<V>, out: &mut Both<V>) {
        // Both nodes are needed in paired order for both rows: permute once.
        let swapped = [x[0].paired(), x[1].paired()];
        for ((out, d), p) in out.iter_mut().zip(&self.diagonal).zip(&self.paired) {
            *out = out
                .plus_product(V::load(&d[0]), x[0])
                .plus_product(V::load(&p[0]), swapped[0])
                .plus_product(V::load(&d[1]), x[1])
                .plus_product(V::load(&p[1]), swapped[1]);
        }
    }

    /// The matrix times `x`.
    #[inline(always)]
    pub fn product<V: Vector>(&self, x: Both<V>) -> Both<V> {
        let mut out = [V::splat(0.0); 2];
        self.add_product(x, &mut out);
        out
    }

    fn is_close(&self, other: &Self) -> bool {
        let close = |a: &[[Lanes; 2]; 2], b: &[[Lanes; 2]; 2]| {
            let (a, b) = (a.as_flattened().as_flattened(), b.as_flattened().as_flattened());
            let scale = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            a.iter().zip(b).all(|(x, y)| (x - y).abs() <= SAME * scale)
        };
        close(&self.diagonal, &other.diagonal) && close(&self.paired, &other.paired)
    }
}

/// Relative difference below which two elements share their matrices: the rounding of their lengths in the well's
/// geometry.
const SAME: f64 = 1e-13;

/// Rotation from the node frames to the chord's frame. A turn about y mixes u with w and psi with phi_z only,
/// so that it is one product with the lanes and one with the lanes in crossed order ([`Vector::across`]).
#[derive(Debug, Clone, PartialEq)]
pub struct LaneTurn {
    direct: [Lanes; 2],
    crossed: [Lanes; 2],
}

impl LaneTurn {
    /// Packs the rotations of both node frames into the chord's, Eq. 8: turns about y, since wells lie in a plane.
    fn of(rotation: &[Matrix3<f64>; 2]) -> Self {
        let each = |make: fn([f64; 2]) -> Lanes| rotation.map(|r| make([r[(0, 0)], r[(0, 2)]]));
        Self {
            direct: each(|[cos, _]| [cos, 1.0, cos, cos, 1.0, cos, 0.0, 0.0]),
            crossed: each(|[_, sin]| [sin, 0.0, -sin, sin, 0.0, -sin, 0.0, 0.0]),
        }
    }

    /// Rotates nodal values into the chord's frame, Eq. 8.
    #[inline(always)]
    pub fn to_chord<V: Vector>(&self, x: Both<V>) -> Both<V> {
        let mut out = x;
        for ((out, direct), crossed) in out.iter_mut().zip(&self.direct).zip(&self.crossed) {
            let across = out.across();
            *out = V::load(direct).times(*out).plus_product(V::load(crossed), across);
        }
        out
    }

    /// Rotates forces in the chord's frame into the node frames: the transpose.
    #[inline(always)]
    pub fn to_nodes<V: Vector>(&self, f: Both<V>) -> Both<V> {
        let mut out = f;
        for ((out, direct), crossed) in out.iter_mut().zip(&self.direct).zip(&self.crossed) {
            let across = out.across();
            *out = V::load(direct).times(*out).minus_product(V::load(crossed), across);
        }
        out
    }

    fn is_close(&self, other: &Self) -> bool {
        let (a, b) = (self, other);
        let pairs = a.direct.iter().chain(&a.crossed).zip(b.direct.iter().chain(&b.crossed));
        pairs
            .flat_map(|(a, b)| a.iter().zip(b))
            .all(|(x, y)| (x - y).abs() <= SAME)
    }
}

/// The matrices of an element.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementForms {
    /// K, Eq. 6.
    pub stiffness: ElementForm,
    /// M, Eq. 5.
    pub mass: ElementForm,
    /// G, geometric stiffness per unit of tension (Eq. 41).
    pub geometric: ElementForm,
    /// Rotation into the element's frame; the pipe's node frames are its own, so it has none.
    pub turn: Option<LaneTurn>,
}

impl ElementForms {
    /// Packs the matrices of `beam` along a path of the `curvature` (1/m) that its tension knows of; `turn` holds the
    /// rotations of its node frames into its own.
    pub fn of(beam: &Beam, curvature: f64, turn: Option<&[Matrix3<f64>; 2]>) -> Self {
        Self {
            stiffness: ElementForm::of(&beam.stiffness()),
            mass: ElementForm::of(&beam.mass()),
            geometric: ElementForm::of(&beam.geometric_along(curvature)),
            turn: turn.map(LaneTurn::of),
        }
    }

    /// Whether `other` differs by rounding at most.
    pub fn is_close(&self, other: &Self) -> bool {
        let turns = match (&self.turn, &other.turn) {
            (Some(a), Some(b)) => a.is_close(b),
            (None, None) => true,
            _ => false,
        };
        turns
            && self.stiffness.is_close(&other.stiffness)
            && self.mass.is_close(&other.mass)
            && self.geometric.is_close(&other.geometric)
    }

    /// Rotates nodal values into the element's frame.
    #[inline(always)]
    pub fn to_element<V: Vector>(&self, x: Both<V>) -> Both<V> {
        match &self.turn {
            Some(turn) => turn.to_chord(x),
            None => x,
        }
    }

    /// Rotates forces from the element's frame into the node frames.
    #[inline(always)]
    pub fn to_nodes<V: Vector>(&self, f: Both<V>) -> Both<V> {
        match &self.turn {
            Some(turn) => turn.to_nodes(f),
            None => f,
        }
    }
}

/// Elements of both pipes. Equal elements share their matrices, so that these stay in the cache.
#[derive(Debug, Clone, Default)]
pub struct Elements {
    /// The different sets of matrices.
    pub kinds: Vec<ElementForms>,
    /// Pipe elements, then guide elements.
    pub list: Vec<MeshedElement>,
}

/// An element between two nodes of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshedElement {
    /// First unknowns of its nodes.
    pub nodes: [u32; 2],
    /// Index of its matrices among [`Elements::kinds`].
    pub kind: u32,
}

impl Elements {
    /// Adds an element between the nodes that begin at `nodes`.
    pub fn push(&mut self, forms: ElementForms, nodes: [usize; 2]) {
        let kind = match self.kinds.iter().position(|known| known.is_close(&forms)) {
            Some(kind) => kind,
            None => {
                self.kinds.push(forms);
                self.kinds.len() - 1
            }
        };
        self.list.push(MeshedElement {
            nodes: nodes.map(|node| node as u32),
            kind: kind as u32,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::beam::ElementVector;
    use crate::simd::vector::Portable;
    use crate::tool::SectionProperties;
    use crate::tool::{Material, Tube};
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

    /// Values of two nodes, the unused lanes included.
    fn values(seed: f64) -> [Lanes; 2] {
        std::array::from_fn(|n| std::array::from_fn(|k| (seed + 1.7 * (6 * n + k) as f64).sin()))
    }

    fn vector(x: &[Lanes; 2]) -> ElementVector {
        ElementVector::from_fn(|i, _| x[i / 6][i % 6])
    }

    fn product<V: Vector>(form: &ElementForm, x: &[Lanes; 2]) -> [Lanes; 2] {
        let mut out = [[0.0; 8]; 2];
        let made = form.product([V::load(&x[0]), V::load(&x[1])]);
        made[0].store(&mut out[0]);
        made[1].store(&mut out[1]);
        out
    }

    #[test]
    fn products_are_those_of_the_plain_matrices() {
        let beam = beam();
        let curvature = 0.3;
        let forms = ElementForms::of(&beam, curvature, None);
        let x = values(0.3);
        for (form, matrix) in [
            (&forms.stiffness, beam.stiffness()),
            (&forms.mass, beam.mass()),
            (&forms.geometric, beam.geometric_along(curvature)),
        ] {
            let expected = matrix * vector(&x);
            let out = product::<Portable>(form, &x);
            // Rounding of sums of four terms.
            assert!((vector(&out) - expected).amax() < 1e-14 * expected.amax());
            assert!(
                out.iter().all(|node| node[6..] == [0.0; 2]),
                "an unused lane has a force"
            );
        }
    }

    #[test]
    fn a_turn_is_the_rotation_about_y() {
        let rotation =
            [0.2_f64, -0.3].map(|angle| *Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), angle).matrix());
        let turn = LaneTurn::of(&rotation);
        let x = values(0.7);
        let stored = |v: Both<Portable>| {
            let mut out = [[0.0; 8]; 2];
            v[0].store(&mut out[0]);
            v[1].store(&mut out[1]);
            out
        };
        let turned = turn.to_chord([Portable::load(&x[0]), Portable::load(&x[1])]);
        let back = stored(turn.to_nodes(turned));
        let turned = stored(turned);
        for n in 0..2 {
            for k in [0, 3] {
                let part = nalgebra::Vector3::new(x[n][k], x[n][k + 1], x[n][k + 2]);
                let expected = rotation[n] * part;
                (0..3).for_each(|i| assert!((turned[n][k + i] - expected[i]).abs() < 1e-15));
            }
        }
        assert!((vector(&back) - vector(&x)).amax() < 1e-15);
    }
}
