//! The numbers that the laws of joints and gaps are written over: one `f64`, or eight lanes at once.

use std::ops::{Add, Mul, Neg, Sub};

use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

/// A number to compute with.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
    /// The number's form in memory, between two computations.
    type Memory: Copy + Default;
    /// Reads a number, or one per lane, from memory.
    fn load(from: &Self::Memory) -> Self;
    /// Writes it to memory.
    fn store(self, to: &mut Self::Memory);
    /// The same `x` in every lane.
    fn of(x: f64) -> Self;
    /// self + a b, rounded once where the machine does that.
    fn plus_product(self, a: Self, b: Self) -> Self;
    /// The quotient `self / other`.
    fn over(self, other: Self) -> Self;
    /// Square root.
    fn root(self) -> Self;
    /// The larger; `other` where one of them is NaN.
    fn largest(self, other: Self) -> Self;
    /// Itself where `x` is larger than `bound`, `otherwise` elsewhere.
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Applies a scalar function to each lane.
    fn map(self, f: impl Fn(f64) -> f64) -> Self;
    /// Applies a scalar function to each pair of lanes.
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self;
    /// Whether some lane is below its bound.
    fn any_below(self, bound: Self) -> bool;
}

impl Number for f64 {
    type Memory = Self;
    #[inline(always)]
    fn load(from: &Self) -> Self {
        *from
    }
    #[inline(always)]
    fn store(self, to: &mut Self) {
        *to = self;
    }
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        self + a * b
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        self / other
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self {
        if x > bound { self } else { otherwise }
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        f(self)
    }
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        f(self, other)
    }
    #[inline(always)]
    fn any_below(self, bound: Self) -> bool {
        self < bound
    }
}

/// Eight lanes in memory.
pub type Lane = Aligned<[f64; 8]>;

/// Eight lanes in a register, one per joint or contact.
#[derive(Debug, Clone, Copy)]
pub struct Eight<V>(pub V);

/// Taylor coefficients of sine (`first` 1) and cosine (`first` 0) in powers of r^2: (-1)^k / (2 k + first)!.
const fn series<const N: usize>(first: u32) -> [f64; N] {
    let mut c = [0.0; N];
    c[0] = 1.0;
    let mut k = 1;
    while k < N {
        let m = (2 * k + first as usize) as f64;
        c[k] = -c[k - 1] / (m * (m - 1.0));
        k += 1;
    }
    c
}

impl<V: Vector> Number for Eight<V> {
    type Memory = Lane;
    #[inline(always)]
    fn load(from: &Lane) -> Self {
        Self(V::load(from))
    }
    #[inline(always)]
    fn store(self, to: &mut Lane) {
        self.0.store(to);
    }
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self(V::splat(x))
    }

    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        Self(self.0.plus_product(a.0, b.0))
    }

    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(self.0.over(other.0))
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.root())
    }

    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        Self(self.0.largest(other.0))
    }

    #[inline(always)]
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self {
        Self(self.0.where_above(x.0, bound.0, otherwise.0))
    }

    /// Sine and cosine, to two units in the last place of 1 for arguments up to 1e6.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        // Range reduction: x = n pi/2 + r with |r| <= pi/4. The first two parts of pi/2 have 33 bits each, so that
        // their products with n are exact (Cody and Waite).
        const PARTS: [f64; 3] = [
            1.570_796_326_734_125_6,
            6.077_100_506_303_966e-11,
            2.022_266_248_795_950_6e-21,
        ];
        // Adding and subtracting 3 x 2^51 rounds to an integer without an instruction for it.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        const SINE: [f64; 8] = series(1);
        const COSINE: [f64; 9] = series(0);
        let whole = |x: Self| (x + Self::of(ROUND)) - Self::of(ROUND);
        let n = whole(self * Self::of(std::f64::consts::FRAC_2_PI));
        let r = ((self - n * Self::of(PARTS[0])) - n * Self::of(PARTS[1])) - n * Self::of(PARTS[2]);
        // Both series by Horner's rule. Their last terms are below the rounding of 1 for |r| <= pi/4.
        let s = r * r;
        let (mut sine, mut cosine) = (Self::of(SINE[7]), Self::of(COSINE[8]));
        for k in (0..7).rev() {
            sine = Self::of(SINE[k]).plus_product(sine, s);
        }
        for k in (0..8).rev() {
            cosine = Self::of(COSINE[k]).plus_product(cosine, s);
        }
        sine = sine * r;
        // The quadrant n mod 4 as two bits: `odd` exchanges sine and cosine, `upper` changes both signs. Products with
        // 0 and 1 replace branches, which lanes cannot take separately.
        let floor = |x: Self| whole(x - Self::of(0.25));
        let pairs = floor(n * Self::of(0.5));
        let odd = n - pairs * Self::of(2.0);
        let upper = pairs - floor(pairs * Self::of(0.5)) * Self::of(2.0);
        let even = Self::of(1.0) - odd;
        let sign = Self::of(1.0) - upper * Self::of(2.0);
        (sign * (even * sine + odd * cosine), sign * (even * cosine - odd * sine))
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let mut lanes = Aligned([0.0; 8]);
        self.store(&mut lanes);
        for x in lanes.iter_mut() {
            *x = f(*x);
        }
        Self::load(&lanes)
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (mut lanes, mut others) = (Aligned([0.0; 8]), Aligned([0.0; 8]));
        self.store(&mut lanes);
        other.store(&mut others);
        for (x, y) in lanes.iter_mut().zip(*others) {
            *x = f(*x, y);
        }
        Self::load(&lanes)
    }

    #[inline(always)]
    fn any_below(self, bound: Self) -> bool {
        bound.0.above(self.0) != 0
    }
}

impl<V: Vector> Add for Eight<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.plus(other.0))
    }
}

impl<V: Vector> Sub for Eight<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.minus(other.0))
    }
}

impl<V: Vector> Mul for Eight<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0.times(other.0))
    }
}

impl<V: Vector> Neg for Eight<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(V::splat(0.0).minus(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::vector::Portable;

    #[test]
    fn sine_and_cosine() {
        for k in 0..20_000 {
            let x = (k as f64 - 10_000.0) * 0.731_3;
            let at = Aligned(std::array::from_fn(|lane| x + 0.1 * lane as f64));
            let (sin, cos) = Eight::<Portable>::load(&at).sin_cos();
            let (mut s, mut c) = (Aligned([0.0; 8]), Aligned([0.0; 8]));
            sin.store(&mut s);
            cos.store(&mut c);
            for lane in 0..8 {
                let (sin, cos) = at[lane].sin_cos();
                // Two units in the last place of 1.
                assert!(
                    (s[lane] - sin).abs() < 4.5e-16 && (c[lane] - cos).abs() < 4.5e-16,
                    "{}: {} {sin}, {} {cos}",
                    at[lane],
                    s[lane],
                    c[lane]
                );
            }
        }
    }
}
