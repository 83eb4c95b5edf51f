//! The two precisions in which a tangent is made: double, and single for corrections whose residual is taken in double.

use std::ops::AddAssign;

use super::Chain;
use super::columns::{ONLY, load, store};
use super::tangent::Additions;
use super::{GUIDE, NODE, U};
use crate::simd::aligned::Aligned;
use crate::simd::single::Single;
use crate::simd::vector::Vector;

/// A number of a tangent.
pub(crate) trait Precision: Copy + AddAssign + 'static {
    const ZERO: Self;
    /// Sixteen of them, by vector instructions.
    type Lanes<V: Vector>: Lanes<Self>;
    /// Rounded to this precision.
    fn of(x: f64) -> Self;
    /// One in the places of the guide, zero elsewhere.
    fn guide() -> &'static [Self; NODE];
    /// One in place `k`, zero elsewhere.
    fn only(k: usize) -> &'static [Self; NODE];
    /// Forces on the nodes of a span by local forces at its stations.
    fn on_nodes(stations: &OnNodesInBoth) -> &[OnNodes<Self>];
    /// What a chain adds to the tangent.
    fn additions(chain: &mut Chain) -> &mut Additions<Self>;
}

/// Sixteen numbers: a column of a node's block.
pub(crate) trait Lanes<S>: Copy {
    fn load(from: &[S; NODE]) -> Self;
    fn store(self, to: &mut [S; NODE]);
    /// Of numbers of double precision.
    fn round(from: &[f64; NODE]) -> Self;
    fn splat(x: S) -> Self;
    fn plus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    /// self + a b, rounded once where the machine does that.
    fn plus_product(self, a: Self, b: Self) -> Self;
    /// The last eight before the first eight.
    fn swapped(self) -> Self;
}

/// Forces on the unknowns of the nodes [above, below] of a span by each of the six local forces at a station:
/// between pipe and guide, and on the guide from outside. Their transpose is the motion there by those unknowns.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct OnNodes<S> {
    pub inner: [[[S; NODE]; 6]; 2],
    pub outer: [[[S; NODE]; 6]; 2],
    /// `outer` of both nodes in one: what the node below gets is eight places higher up.
    pub outer_joined: [[S; NODE]; 6],
}

/// [`OnNodes`] of the stations of a span, in both precisions.
#[derive(Debug, Clone)]
pub(crate) struct OnNodesInBoth {
    double: Vec<OnNodes<f64>>,
    single: Vec<OnNodes<f32>>,
}

impl OnNodesInBoth {
    /// From the rows of each station over the ends of its span, and the radii of the guide (m).
    pub(crate) fn of<'a>(rows: impl Iterator<Item = &'a [[[f64; 16]; 6]; 2]> + Clone, radii: [f64; 2]) -> Self {
        Self {
            double: rows.clone().map(|rows| OnNodes::of(rows, radii)).collect(),
            single: rows.map(|rows| OnNodes::of(rows, radii)).collect(),
        }
    }
}

impl<S: Precision> OnNodes<S> {
    /// From the rows of a station over the ends of its span, [pipe, guide], and the radii of the guide, [inner, outer] (m).
    fn of(rows: &[[[f64; 16]; 6]; 2], radii: [f64; 2]) -> Self {
        // The guide gets the opposite of what the pipe gets.
        let layer = |on_pipe: f64, on_guide: f64, radius: f64| {
            std::array::from_fn(|end| {
                std::array::from_fn(|k| {
                    let arm = if k < 3 { 1.0 } else { radius };
                    let mut column = [S::ZERO; NODE];
                    for (body, first, part) in [(0, if end == 0 { U } else { 0 }, on_pipe), (1, GUIDE, on_guide * arm)]
                    {
                        if part != 0.0 {
                            (0..6).for_each(|i| column[first + i] = S::of(part * rows[body][k][8 * end + i]));
                        }
                    }
                    column
                })
            })
        };
        let outer: [[[S; NODE]; 6]; 2] = layer(0.0, 1.0, radii[1]);
        let mut outer_joined = outer[0];
        for (joined, below) in outer_joined.iter_mut().zip(&outer[1]) {
            (GUIDE..GUIDE + 6).for_each(|i| joined[i - 8] = below[i]);
        }
        Self {
            inner: layer(1.0, -1.0, radii[0]),
            outer,
            outer_joined,
        }
    }
}

impl Precision for f64 {
    const ZERO: Self = 0.0;
    type Lanes<V: Vector> = Double<V>;

    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn guide() -> &'static [Self; NODE] {
        static ROWS: Aligned<[f64; NODE]> = Aligned(GUIDE_ROWS);
        &ROWS
    }

    #[inline(always)]
    fn only(k: usize) -> &'static [Self; NODE] {
        static ROWS: Aligned<[[f64; NODE]; NODE]> = Aligned({
            let (mut rows, mut k) = ([[0.0; NODE]; NODE], 0);
            while k < NODE {
                rows[k][k] = 1.0;
                k += 1;
            }
            rows
        });
        &ROWS[k]
    }

    #[inline(always)]
    fn on_nodes(stations: &OnNodesInBoth) -> &[OnNodes<Self>] {
        &stations.double
    }

    fn additions(chain: &mut Chain) -> &mut Additions<Self> {
        &mut chain.additions
    }
}

impl Precision for f32 {
    const ZERO: Self = 0.0;
    type Lanes<V: Vector> = Rounded<V::Single>;

    #[inline(always)]
    fn of(x: f64) -> Self {
        x as Self
    }

    #[inline(always)]
    fn guide() -> &'static [Self; NODE] {
        static ROWS: Aligned<[f32; NODE]> = Aligned({
            let (mut rows, mut i) = ([0.0; NODE], 0);
            while i < NODE {
                rows[i] = GUIDE_ROWS[i] as f32;
                i += 1;
            }
            rows
        });
        &ROWS
    }

    #[inline(always)]
    fn only(k: usize) -> &'static [Self; NODE] {
        &ONLY[k]
    }

    #[inline(always)]
    fn on_nodes(stations: &OnNodesInBoth) -> &[OnNodes<Self>] {
        &stations.single
    }

    fn additions(chain: &mut Chain) -> &mut Additions<Self> {
        &mut chain.single_additions
    }
}

/// Sixteen numbers of double precision.
#[derive(Clone, Copy)]
pub(crate) struct Double<V>(pub [V; 2]);

impl<V: Vector> Lanes<f64> for Double<V> {
    #[inline(always)]
    fn load(from: &[f64; NODE]) -> Self {
        Self(load(from))
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; NODE]) {
        store(self.0, to);
    }

    #[inline(always)]
    fn round(from: &[f64; NODE]) -> Self {
        Self(load(from))
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([V::splat(x); 2])
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self([self.0[0].plus(other.0[0]), self.0[1].plus(other.0[1])])
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self([self.0[0].times(other.0[0]), self.0[1].times(other.0[1])])
    }

    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        Self([
            self.0[0].plus_product(a.0[0], b.0[0]),
            self.0[1].plus_product(a.0[1], b.0[1]),
        ])
    }

    #[inline(always)]
    fn swapped(self) -> Self {
        Self([self.0[1], self.0[0]])
    }
}

/// Sixteen numbers of single precision.
#[derive(Clone, Copy)]
pub(crate) struct Rounded<S>(pub S);

impl<S: Single> Lanes<f32> for Rounded<S> {
    #[inline(always)]
    fn load(from: &[f32; NODE]) -> Self {
        Self(S::load(from))
    }

    #[inline(always)]
    fn store(self, to: &mut [f32; NODE]) {
        self.0.store(to);
    }

    #[inline(always)]
    fn round(from: &[f64; NODE]) -> Self {
        Self(S::round(from))
    }

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(S::splat(x))
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(self.0.plus(other.0))
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(self.0.times(other.0))
    }

    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        Self(self.0.plus_product(a.0, b.0))
    }

    #[inline(always)]
    fn swapped(self) -> Self {
        Self(self.0.taken(&SWAPPED))
    }
}

/// One in the places of the guide.
const GUIDE_ROWS: [f64; NODE] = [
    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0,
];

/// Places of the last eight before those of the first eight.
static SWAPPED: Aligned<[i32; NODE]> = Aligned([8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7]);
