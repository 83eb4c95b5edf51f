//! Directions carried by a pipe node: R_node = E_link exp([0, phi_y, phi_z]x) Rx(psi), with the spin psi unbounded and
//! the tilts phi in the link frame that does not spin.

#[cfg(test)]
use nalgebra::Vector3;

use super::jet::Jet;
use crate::simd::number::Number;

/// A direction in the link frame with its derivatives in (psi, phi_y, phi_z); those by the variables before `FIRST` are zero.
pub struct DirectionJet<T, const FIRST: usize>(pub [Jet<T>; 3]);
/// The shaft's own axis, which does not turn with its spin.
pub type ShaftAxis<T> = DirectionJet<T, 1>;
/// An axis across the shaft.
pub type TransverseAxis<T> = DirectionJet<T, 0>;

/// Tilts beyond this (rad) are outside the range in which the series below are exact to rounding.
pub const LARGEST_TILT: f64 = 1.0;

/// Coefficients of sin(t)/t in powers of s = t^2.
const SINE_RATIO: [f64; TERMS] = coefficients(1);
/// Coefficients of (1 - cos t)/t^2.
const VERSINE_RATIO: [f64; TERMS] = coefficients(2);
/// Terms that make the series exact to rounding for t up to [`LARGEST_TILT`].
const TERMS: usize = 10;

/// (-1)^n / (2 n + first)!.
const fn coefficients(first: u32) -> [f64; TERMS] {
    let mut c = [0.0; TERMS];
    c[0] = if first == 1 { 1.0 } else { 0.5 };
    let mut n = 1;
    while n < TERMS {
        let m = (2 * n + first as usize) as f64;
        c[n] = -c[n - 1] / (m * (m - 1.0));
        n += 1;
    }
    c
}

/// Sum of a series in s with its two derivatives, by Horner's rule.
#[inline(always)]
fn series<T: Number>(c: &[f64; TERMS], s: T) -> [T; 3] {
    let mut sum = [T::of(c[TERMS - 1]), T::of(0.0), T::of(0.0)];
    for &c in c[..TERMS - 1].iter().rev() {
        sum[2] = sum[1].plus_product(sum[2], s);
        sum[1] = sum[0].plus_product(sum[1], s);
        sum[0] = T::of(c).plus_product(sum[0], s);
    }
    sum[2] = sum[2] * T::of(2.0);
    sum
}

/// A function of the tilts with its derivatives.
#[derive(Clone, Copy)]
struct Tilted<T> {
    value: T,
    y: T,
    z: T,
    yy: T,
    yz: T,
    zz: T,
}

impl<T: Number> Tilted<T> {
    /// f(y^2 + z^2) from f and its derivatives.
    #[inline(always)]
    fn radial([f, d, dd]: [T; 3], y: T, z: T) -> Self {
        let (two_d, four_dd) = (T::of(2.0) * d, T::of(4.0) * dd);
        Self {
            value: f,
            y: two_d * y,
            z: two_d * z,
            yy: two_d + four_dd * y * y,
            yz: four_dd * y * z,
            zz: two_d + four_dd * z * z,
        }
    }

    /// This times y.
    #[inline(always)]
    fn times_y(&self, y: T) -> Self {
        Self {
            value: self.value * y,
            y: self.y * y + self.value,
            z: self.z * y,
            yy: self.yy * y + T::of(2.0) * self.y,
            yz: self.yz * y + self.z,
            zz: self.zz * y,
        }
    }

    /// This times z.
    #[inline(always)]
    fn times_z(&self, z: T) -> Self {
        Self {
            value: self.value * z,
            y: self.y * z,
            z: self.z * z + self.value,
            yy: self.yy * z,
            yz: self.yz * z + self.y,
            zz: self.zz * z + T::of(2.0) * self.z,
        }
    }

    /// The function with its sign turned.
    #[inline(always)]
    fn negative(&self) -> Self {
        Self {
            value: -self.value,
            y: -self.y,
            z: -self.z,
            yy: -self.yy,
            yz: -self.yz,
            zz: -self.zz,
        }
    }

    /// This, which does not depend on the spin.
    #[inline(always)]
    fn jet(&self) -> Jet<T> {
        let zero = T::of(0.0);
        Jet {
            value: self.value,
            gradient: [zero, self.y, self.z],
            hessian: [[zero; 3], [zero, self.yy, self.yz], [zero, self.yz, self.zz]],
        }
    }

    /// This times c = y sin - z cos, whose derivative in the spin is e = y cos + z sin.
    #[inline(always)]
    fn turned(&self, sin: T, cos: T, c: T, e: T) -> Jet<T> {
        let (h, y, z) = (self.value, self.y, self.z);
        let two = T::of(2.0);
        let (sy, sz) = (y * e + h * cos, z * e + h * sin);
        let yy = self.yy * c + two * y * sin;
        let yz = self.yz * c - y * cos + z * sin;
        let zz = self.zz * c - two * z * cos;
        Jet {
            value: h * c,
            gradient: [h * e, y * c + h * sin, z * c - h * cos],
            hessian: [[-(h * c), sy, sz], [sy, yy, yz], [sz, yz, zz]],
        }
    }
}

/// The node's x axis (the link's own axis after bending), in the link frame: (1 - b s, a z, -a y) with s = y^2 + z^2.
/// Part of the Lambda of Eq. 11, as [`transverse_axis`].
#[inline(always)]
pub fn shaft_axis<T: Number>(y: T, z: T) -> ShaftAxis<T> {
    let s = y * y + z * z;
    let a = Tilted::radial(series(&SINE_RATIO, s), y, z);
    let [b, d, dd] = series(&VERSINE_RATIO, s);
    let bent = Tilted::radial([b * s, b + d * s, T::of(2.0) * d + dd * s], y, z);
    let mut along = bent.negative().jet();
    along.value = along.value + T::of(1.0);
    DirectionJet([along, a.times_z(z).jet(), a.times_y(y).negative().jet()])
}

/// The value of [`shaft_axis`] alone.
#[inline(always)]
pub fn shaft_direction<T: Number>(y: T, z: T) -> [T; 3] {
    let s = y * y + z * z;
    let [a, ..] = series(&SINE_RATIO, s);
    let [b, ..] = series(&VERSINE_RATIO, s);
    [T::of(1.0) - b * s, a * z, -(a * y)]
}

/// The node's transverse axis at an angle from its y axis towards its z axis, in the link frame (Lambda of Eq. 11
/// turned with the node): (a c, cos + b z c, sin - b y c) with c = y sin - z cos. `sin` and `cos` are those of the spin
/// plus the angle.
#[inline(always)]
pub fn transverse_axis<T: Number>((sin, cos): (T, T), y: T, z: T) -> TransverseAxis<T> {
    let s = y * y + z * z;
    let a = Tilted::radial(series(&SINE_RATIO, s), y, z);
    let b = Tilted::radial(series(&VERSINE_RATIO, s), y, z);
    let (c, e) = (y * sin - z * cos, y * cos + z * sin);
    let mut across_y = b.times_z(z).turned(sin, cos, c, e);
    across_y.value = across_y.value + cos;
    across_y.gradient[0] = across_y.gradient[0] - sin;
    across_y.hessian[0][0] = across_y.hessian[0][0] - cos;
    let mut across_z = b.times_y(y).negative().turned(sin, cos, c, e);
    across_z.value = across_z.value + sin;
    across_z.gradient[0] = across_z.gradient[0] + cos;
    across_z.hessian[0][0] = across_z.hessian[0][0] - sin;
    DirectionJet([a.turned(sin, cos, c, e), across_y, across_z])
}

/// The node's y and z axes at a spin, as [`transverse_axis`].
#[inline(always)]
pub fn transverse_axes<T: Number>(psi: T, y: T, z: T) -> [TransverseAxis<T>; 2] {
    let (sin, cos) = psi.sin_cos();
    [transverse_axis((sin, cos), y, z), transverse_axis((cos, -sin), y, z)]
}

/// The value of a direction.
#[cfg(test)]
fn value<const FIRST: usize>(direction: &DirectionJet<f64, FIRST>) -> Vector3<f64> {
    Vector3::from(direction.0.map(|part| part.value))
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;

    #[test]
    fn directions_are_those_of_the_rotation_matrix() {
        for (psi, y, z) in [
            (0.3, 0.02, -0.07),
            (1234.5, -0.2, 0.1),
            (0.0, 0.0, 0.0),
            (-2.0, 0.6, 0.6),
        ] {
            let r = Rotation3::new(Vector3::new(0.0, y, z)) * Rotation3::new(Vector3::new(psi, 0.0, 0.0));
            let angle: f64 = 0.7;
            let body = Vector3::new(0.0, angle.cos(), angle.sin());
            // Rounding of an argument of order 1e3.
            assert!((value(&transverse_axis((psi + angle).sin_cos(), y, z)) - r * body).norm() < 1e-12);
            assert!((value(&shaft_axis(y, z)) - r * Vector3::x()).norm() < 1e-14);
            assert!((value(&shaft_axis(y, z)) - Vector3::from(shaft_direction(y, z))).norm() < 1e-15);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let at = [0.4, 0.11, -0.23];
        let h = 1e-5;
        let f = |x: [f64; 3]| transverse_axis((x[0] + 0.2_f64).sin_cos(), x[1], x[2]).0;
        let centre = f(at);
        for i in 0..3 {
            let (mut lo, mut hi) = (at, at);
            lo[i] -= h;
            hi[i] += h;
            let (lo, hi) = (f(lo), f(hi));
            for k in 0..3 {
                // Central differences at h = 1e-5 leave h^2/6 f''' of about 1e-11 and rounding of the same size.
                assert!((centre[k].gradient[i] - (hi[k].value - lo[k].value) / (2.0 * h)).abs() < 1e-9);
                for l in 0..3 {
                    let second = (hi[k].gradient[l] - lo[k].gradient[l]) / (2.0 * h);
                    assert!((centre[k].hessian[i][l] - second).abs() < 1e-9);
                }
            }
        }
    }
}
