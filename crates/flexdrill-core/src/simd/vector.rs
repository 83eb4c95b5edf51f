//! Eight numbers at once: the same kernels with AVX-512, with AVX2 and with what every processor has.
//!
//! Kernels are written once over [`Vector`] and marked `#[inline(always)]`; the functions that call them for one kind
//! of vector carry the `target_feature` that it needs. Automatic vectorisation of such code is several times slower:
//! the compiler splits the lanes.

use wide::f64x8;

use super::instructions::{Kernel, with_portable};
use super::single::{PortableSingle, Single};

/// Eight lanes of f64, one per unknown, column or joint as the kernel says.
pub(crate) trait Vector: Copy {
    /// Sixteen lanes of single precision of the same machine.
    type Single: Single;

    /// Runs `kernel` with these vectors in a separate function, which is not inlined into the caller: a large kernel
    /// that several callers share is compiled once.
    fn call<K: Kernel>(kernel: K) -> K::Output;

    /// The same in every lane.
    fn splat(x: f64) -> Self;
    /// Reads eight lanes.
    fn load(from: &[f64; 8]) -> Self;
    /// Writes eight lanes.
    fn store(self, to: &mut [f64; 8]);
    /// Sum, lane by lane.
    fn plus(self, other: Self) -> Self;
    /// Difference, lane by lane.
    fn minus(self, other: Self) -> Self;
    /// Product, lane by lane.
    fn times(self, other: Self) -> Self;
    /// Quotient, lane by lane.
    fn over(self, other: Self) -> Self;
    /// Square root, lane by lane.
    fn root(self) -> Self;
    /// The larger, lane by lane; the lane of `other` where one of them is NaN.
    fn largest(self, other: Self) -> Self;
    /// Lanes of `self` where `x` is larger than `bound`, of `otherwise` in the others.
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self;
    /// self + a b, rounded once where the machine does that.
    fn plus_product(self, a: Self, b: Self) -> Self;
    /// self - a b, likewise.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// Lanes 1, 0, 3, 2, 5, 4, 7, 6: neighbours exchanged.
    fn swapped(self) -> Self;
    /// Whether some lane of `self` is larger in magnitude than the same lane of `bound`; NaN counts as larger.
    fn any_beyond(self, bound: Self) -> bool;
    /// A bit per lane of `self` that is larger than the same lane of `bound`.
    fn above(self, bound: Self) -> u32;
}

/// What every processor of the architecture has: pairs of lanes with SSE2 or NEON, single lanes elsewhere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable(f64x8);

impl Vector for Portable {
    type Single = PortableSingle;

    #[inline(always)]
    fn call<K: Kernel>(kernel: K) -> K::Output {
        with_portable(kernel)
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(f64x8::splat(x))
    }
    #[inline(always)]
    fn load(from: &[f64; 8]) -> Self {
        Self(f64x8::new(*from))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        *to = self.0.to_array();
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        self.where_above(self, other, other)
    }
    #[inline(always)]
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self {
        Self(x.0.simd_gt(bound.0).select(self.0, otherwise.0))
    }
    // The library's product and sum in one would be rounded once or twice as the compiler's target has it.
    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        self.plus(a.times(b))
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        self.minus(a.times(b))
    }
    #[inline(always)]
    fn swapped(self) -> Self {
        let x = self.0.to_array();
        Self(f64x8::new([x[1], x[0], x[3], x[2], x[5], x[4], x[7], x[6]]))
    }
    #[inline(always)]
    fn any_beyond(self, bound: Self) -> bool {
        // A comparison with NaN is false.
        !self.0.abs().simd_le(bound.0).all()
    }
    #[inline(always)]
    fn above(self, bound: Self) -> u32 {
        self.0.simd_gt(bound.0).to_bitmask()
    }
}
