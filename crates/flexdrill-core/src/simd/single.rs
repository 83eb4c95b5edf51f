//! Sixteen lanes of single precision, for solutions whose residual is computed in double precision.

use wide::f32x16;

/// Sixteen lanes of f32: a column of a block of sixteen.
pub(crate) trait Single: Copy {
    /// The same in every lane.
    fn splat(x: f32) -> Self;
    /// Reads sixteen lanes.
    fn load(from: &[f32; 16]) -> Self;
    /// Writes sixteen lanes.
    fn store(self, to: &mut [f32; 16]);
    /// Rounds sixteen numbers to single precision.
    fn round(from: &[f64; 16]) -> Self;
    /// Sum, lane by lane.
    fn plus(self, other: Self) -> Self;
    /// Difference, lane by lane.
    fn minus(self, other: Self) -> Self;
    /// Product, lane by lane.
    fn times(self, other: Self) -> Self;
    /// Quotient, lane by lane.
    fn over(self, other: Self) -> Self;
    /// self + a b, rounded once where the machine does that.
    fn plus_product(self, a: Self, b: Self) -> Self;
    /// self - a b, likewise.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// The larger, lane by lane. A NaN may be dropped.
    fn largest(self, other: Self) -> Self;
    /// Permutation: each lane gets the lane of `self` that `from` names.
    fn taken(self, from: &[i32; 16]) -> Self;
    /// Lane `K` in every lane.
    fn spread<const K: usize>(self) -> Self;
    /// Lane `J` in the first eight lanes, lane `K` in the others.
    fn spread_two<const J: usize, const K: usize>(self) -> Self;
}

/// As [`Portable`](super::vector::Portable).
#[derive(Debug, Clone, Copy)]
pub(crate) struct PortableSingle(f32x16);

impl Single for PortableSingle {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(f32x16::splat(x))
    }
    #[inline(always)]
    fn load(from: &[f32; 16]) -> Self {
        Self(f32x16::new(*from))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 16]) {
        *to = self.0.to_array();
    }
    #[inline(always)]
    fn round(from: &[f64; 16]) -> Self {
        let mut out = [0.0; 16];
        for (to, from) in out.iter_mut().zip(from) {
            *to = *from as f32;
        }
        Self(f32x16::new(out))
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
    fn plus_product(self, a: Self, b: Self) -> Self {
        self.plus(a.times(b))
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        self.minus(a.times(b))
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        Self(self.0.simd_gt(other.0).select(self.0, other.0))
    }
    #[inline(always)]
    fn taken(self, from: &[i32; 16]) -> Self {
        let lanes = self.0.to_array();
        let mut out = lanes;
        for (to, from) in out.iter_mut().zip(from) {
            *to = lanes[*from as usize % 16];
        }
        Self(f32x16::new(out))
    }
    #[inline(always)]
    fn spread<const K: usize>(self) -> Self {
        Self(f32x16::splat(self.0.to_array()[K]))
    }
    #[inline(always)]
    fn spread_two<const J: usize, const K: usize>(self) -> Self {
        let lanes = self.0.to_array();
        let mut out = [lanes[J]; 16];
        out[8..].fill(lanes[K]);
        Self(f32x16::new(out))
    }
}
