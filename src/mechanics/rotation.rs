//! Directions carried by a pipe node: R_node = E_link exp([0, phi_y, phi_z]x) Rx(psi), with the spin psi unbounded and the
//! tilts phi in the link frame that does not spin.

use nalgebra::{Matrix3, Vector3};

use super::jet::Jet;

/// A direction in the link frame with its derivatives in (psi, phi_y, phi_z).
pub type DirectionJet = [Jet; 3];

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
fn series(c: &[f64; TERMS], s: f64) -> [f64; 3] {
    let mut sum = [c[TERMS - 1], 0.0, 0.0];
    for c in c[..TERMS - 1].iter().rev() {
        sum[2] = sum[2] * s + sum[1];
        sum[1] = sum[1] * s + sum[0];
        sum[0] = sum[0] * s + c;
    }
    sum[2] *= 2.0;
    sum
}

/// A function of the tilts with its derivatives.
#[derive(Clone, Copy)]
struct Tilted {
    value: f64,
    y: f64,
    z: f64,
    yy: f64,
    yz: f64,
    zz: f64,
}

impl Tilted {
    /// f(y^2 + z^2) from f and its derivatives.
    #[inline(always)]
    fn radial([f, d, dd]: [f64; 3], y: f64, z: f64) -> Self {
        Self {
            value: f,
            y: 2.0 * y * d,
            z: 2.0 * z * d,
            yy: 2.0 * d + 4.0 * y * y * dd,
            yz: 4.0 * y * z * dd,
            zz: 2.0 * d + 4.0 * z * z * dd,
        }
    }

    /// This times y.
    #[inline(always)]
    fn times_y(&self, y: f64) -> Self {
        Self {
            value: self.value * y,
            y: self.y * y + self.value,
            z: self.z * y,
            yy: self.yy * y + 2.0 * self.y,
            yz: self.yz * y + self.z,
            zz: self.zz * y,
        }
    }

    /// This times z.
    #[inline(always)]
    fn times_z(&self, z: f64) -> Self {
        Self {
            value: self.value * z,
            y: self.y * z,
            z: self.z * z + self.value,
            yy: self.yy * z,
            yz: self.yz * z + self.y,
            zz: self.zz * z + 2.0 * self.z,
        }
    }

    /// `sign` times this, which does not depend on the spin.
    #[inline(always)]
    fn jet(&self, sign: f64) -> Jet {
        let (y, z, yy, yz, zz) = (
            sign * self.y,
            sign * self.z,
            sign * self.yy,
            sign * self.yz,
            sign * self.zz,
        );
        Jet {
            value: sign * self.value,
            gradient: Vector3::new(0.0, y, z),
            hessian: Matrix3::new(0.0, 0.0, 0.0, 0.0, yy, yz, 0.0, yz, zz),
        }
    }

    /// `sign` times this times c = y sin - z cos, whose derivative in the spin is e = y cos + z sin.
    #[inline(always)]
    fn turned(&self, sign: f64, sin: f64, cos: f64, c: f64, e: f64) -> Jet {
        let (h, y, z) = (sign * self.value, sign * self.y, sign * self.z);
        let (sy, sz) = (y * e + h * cos, z * e + h * sin);
        let yy = sign * self.yy * c + 2.0 * y * sin;
        let yz = sign * self.yz * c - y * cos + z * sin;
        let zz = sign * self.zz * c - 2.0 * z * cos;
        Jet {
            value: h * c,
            gradient: Vector3::new(h * e, y * c + h * sin, z * c - h * cos),
            hessian: Matrix3::new(-h * c, sy, sz, sy, yy, yz, sz, yz, zz),
        }
    }
}

/// The node's x axis (the link's own axis after bending), in the link frame: (1 - b s, a z, -a y) with s = y^2 + z^2.
pub fn shaft_axis(y: f64, z: f64) -> DirectionJet {
    let s = y * y + z * z;
    let a = Tilted::radial(series(&SINE_RATIO, s), y, z);
    let [b, d, dd] = series(&VERSINE_RATIO, s);
    let mut along = Tilted::radial([b * s, b + d * s, 2.0 * d + dd * s], y, z).jet(-1.0);
    along.value += 1.0;
    [along, a.times_z(z).jet(1.0), a.times_y(y).jet(-1.0)]
}

/// The value of [`shaft_axis`] alone.
#[inline]
pub fn shaft_direction(y: f64, z: f64) -> Vector3<f64> {
    let s = y * y + z * z;
    let [a, ..] = series(&SINE_RATIO, s);
    let [b, ..] = series(&VERSINE_RATIO, s);
    Vector3::new(1.0 - b * s, a * z, -a * y)
}

/// The node's transverse axis at angle `angle` (rad) from its y axis towards its z axis, in the link frame:
/// (a c, cos + b z c, sin - b y c) with c = y sin - z cos of the spin's angle.
pub fn transverse_axis(psi: f64, y: f64, z: f64, angle: f64) -> DirectionJet {
    let s = y * y + z * z;
    let a = Tilted::radial(series(&SINE_RATIO, s), y, z);
    let b = Tilted::radial(series(&VERSINE_RATIO, s), y, z);
    let (sin, cos) = (psi + angle).sin_cos();
    let (c, e) = (y * sin - z * cos, y * cos + z * sin);
    let mut across_y = b.times_z(z).turned(1.0, sin, cos, c, e);
    across_y.value += cos;
    across_y.gradient[0] -= sin;
    across_y.hessian[(0, 0)] -= cos;
    let mut across_z = b.times_y(y).turned(-1.0, sin, cos, c, e);
    across_z.value += sin;
    across_z.gradient[0] += cos;
    across_z.hessian[(0, 0)] -= sin;
    [a.turned(1.0, sin, cos, c, e), across_y, across_z]
}

/// The value of a direction.
pub fn value(direction: &DirectionJet) -> Vector3<f64> {
    Vector3::new(direction[0].value, direction[1].value, direction[2].value)
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
            assert!((value(&transverse_axis(psi, y, z, angle)) - r * body).norm() < 1e-12);
            assert!((value(&shaft_axis(y, z)) - r * Vector3::x()).norm() < 1e-14);
            assert!((value(&shaft_axis(y, z)) - shaft_direction(y, z)).norm() < 1e-15);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let at = [0.4, 0.11, -0.23];
        let h = 1e-5;
        let f = |x: [f64; 3]| transverse_axis(x[0], x[1], x[2], 0.2);
        let centre = f(at);
        for i in 0..3 {
            let (mut lo, mut hi) = (at, at);
            lo[i] -= h;
            hi[i] += h;
            let (lo, hi) = (f(lo), f(hi));
            for k in 0..3 {
                // Central differences at h = 1e-5 leave h^2/6 f''' of about 1e-11 and rounding of the same size.
                assert!((centre[k].gradient[i] - (hi[k].value - lo[k].value) / (2.0 * h)).abs() < 1e-9);
                let second = (hi[k].gradient - lo[k].gradient) / (2.0 * h);
                assert!((centre[k].hessian.column(i) - second).norm() < 1e-9);
            }
        }
    }
}
