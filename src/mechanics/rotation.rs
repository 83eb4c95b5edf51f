//! Directions carried by a pipe node: R_node = E_link exp([0, phi_y, phi_z]x) Rx(psi), with the spin psi unbounded and the
//! tilts phi in the link frame that does not spin.

use nalgebra::Vector3;

use super::jet::Jet;

/// A direction in the link frame with its derivatives in (psi, phi_y, phi_z).
pub type DirectionJet = [Jet; 3];

/// Tilts beyond this (rad) are outside the range in which the series below are exact to rounding.
pub const LARGEST_TILT: f64 = 1.0;

/// sin(t)/t and its two derivatives in s = t^2, by series: exact to rounding for t up to [`LARGEST_TILT`].
fn sine_ratio(s: f64) -> [f64; 3] {
    series(s, 1)
}

/// (1 - cos t)/t^2 and its two derivatives in s = t^2.
fn versine_ratio(s: f64) -> [f64; 3] {
    series(s, 2)
}

/// Sum over n of (-s)^n / (2 n + first)! with its derivatives.
fn series(s: f64, first: u32) -> [f64; 3] {
    let mut sum = [0.0; 3];
    // Coefficients c_n of s^n, by the ratio c_{n+1} / c_n = -1 / ((2n + first + 1)(2n + first + 2)).
    let mut c = if first == 1 { 1.0 } else { 0.5 };
    let mut powers = [1.0, 0.0, 0.0];
    for n in 0..10_u32 {
        let k = f64::from(n);
        sum[0] += c * powers[0];
        sum[1] += c * k * powers[1];
        sum[2] += c * k * (k - 1.0) * powers[2];
        powers = [powers[0] * s, powers[0], powers[1]];
        let m = 2.0 * k + f64::from(first);
        c = -c / ((m + 1.0) * (m + 2.0));
    }
    sum
}

/// The node's x axis (the link's own axis after bending), in the link frame.
pub fn shaft_axis(phi_y: f64, phi_z: f64) -> DirectionJet {
    let (y, z) = (Jet::variable(phi_y, 1), Jet::variable(phi_z, 2));
    let s = y * y + z * z;
    let (a, b) = (s.chain(sine_ratio(s.value)), s.chain(versine_ratio(s.value)));
    [Jet::constant(1.0) - b * s, a * z, -(a * y)]
}

/// The node's transverse axis at angle `angle` (rad) from its y axis towards its z axis, in the link frame.
pub fn transverse_axis(psi: f64, phi_y: f64, phi_z: f64, angle: f64) -> DirectionJet {
    let (y, z) = (Jet::variable(phi_y, 1), Jet::variable(phi_z, 2));
    let s = y * y + z * z;
    let (a, b) = (s.chain(sine_ratio(s.value)), s.chain(versine_ratio(s.value)));
    let spin = Jet::variable(psi, 0);
    let (sin, cos) = (psi + angle).sin_cos();
    let vy = spin.chain([cos, -sin, -cos]);
    let vz = spin.chain([sin, cos, -sin]);
    let c = y * vz - z * vy;
    [a * c, vy + b * z * c, vz - b * y * c]
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
