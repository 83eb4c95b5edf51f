//! The orbit in time: centre, radius, axes, and the phase rate from the area that the motion sweeps.

use super::orbit_window::Points;

/// First and second moments of the motion in a window, and its phase rate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Orbit {
    /// Root mean square distance from the centre (m).
    pub(super) radius: f64,
    /// Minor over major axis of the covariance, 0 for a line, 1 for a circle.
    pub(super) axis_ratio: f64,
    /// Phase rate about the centre (rad/s), positive from y towards z.
    pub(super) rate: f64,
}

/// Takes the centre (and, with `detrend`, its straight drift) out of the points, measures the orbit, and stretches
/// the points so that the orbit becomes a unit circle. A line stays as it is.
///
/// The rate is dA/dt / sqrt(det C), with A the swept area and C the covariance: for any ellipse that is exactly its
/// angular rate, since stretching an ellipse to a circle changes area and sqrt(det C) alike. White noise adds no area
/// on average, and a motion along a line sweeps none.
pub(super) fn measure_and_stretch(points: &mut Points, detrend: bool, min_axis_ratio: f64) -> Orbit {
    let count = points.position.len();
    if count < 3 {
        return Orbit::default();
    }
    centre(&mut points.position, detrend);
    let n = count as f64;
    let (mut yy, mut zz, mut yz, mut area) = (0.0, 0.0, 0.0, 0.0);
    let mut previous = points.position[0];
    for &[y, z] in &points.position {
        yy += y * y;
        zz += z * z;
        yz += y * z;
        area += 0.5 * (previous[0] * z - previous[1] * y);
        previous = [y, z];
    }
    let (yy, zz, yz) = (yy / n, zz / n, yz / n);
    let half_sum = 0.5 * (yy + zz);
    let half_difference = (0.25 * (yy - zz).powi(2) + yz * yz).sqrt();
    let (major, minor) = (half_sum + half_difference, (half_sum - half_difference).max(0.0));
    let mut orbit = Orbit {
        radius: (yy + zz).sqrt(),
        ..Orbit::default()
    };
    if major <= 0.0 {
        return orbit;
    }
    orbit.axis_ratio = (minor / major).sqrt();
    if orbit.axis_ratio < min_axis_ratio {
        return orbit;
    }
    // A chord cuts the arc: the area of one step is r2/2 sin(phase step), hence the arc sine.
    let phase_step = area / (n - 1.0) / (major * minor).sqrt();
    orbit.rate = phase_step.clamp(-1.0, 1.0).asin() / points.spacing;
    let angle = 0.5 * (2.0 * yz).atan2(yy - zz);
    let (sin, cos) = angle.sin_cos();
    let (along, across) = ((2.0 * major).sqrt().recip(), (2.0 * minor).sqrt().recip());
    for position in &mut points.position {
        let [y, z] = *position;
        *position = [along * (cos * y + sin * z), across * (cos * z - sin * y)];
    }
    orbit
}

fn centre(position: &mut [[f64; 2]], detrend: bool) {
    let n = position.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let (mut mean, mut slope) = ([0.0; 2], [0.0; 2]);
    for (index, point) in position.iter().enumerate() {
        let lever = index as f64 - middle;
        for axis in 0..2 {
            mean[axis] += point[axis] / n;
            slope[axis] += lever * point[axis];
        }
    }
    let inertia = n * (n * n - 1.0) / 12.0;
    for (index, point) in position.iter_mut().enumerate() {
        let lever = if detrend {
            (index as f64 - middle) / inertia
        } else {
            0.0
        };
        for axis in 0..2 {
            point[axis] -= mean[axis] + slope[axis] * lever;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn ellipse(a: f64, b: f64, tilt: f64, rate: f64, turns: f64, drift: f64) -> Points {
        let mut points = Points::new();
        let count = 120;
        let duration = turns * TAU / rate.abs();
        points.spacing = duration / f64::from(count);
        for index in 0..count {
            let time = f64::from(index) * points.spacing;
            let (along, across) = (a * (rate * time).cos(), b * (rate * time).sin());
            let (sin, cos) = tilt.sin_cos();
            let shift = drift * time / duration;
            points.position.push([
                cos * along - sin * across + 0.3 + shift,
                sin * along + cos * across - 0.1,
            ]);
        }
        points
    }

    #[test]
    fn rate_of_any_ellipse_is_exact_over_whole_turns() {
        for (a, b, rate) in [(1.0, 1.0, 3.0), (1.0, 0.3, 3.0), (1.0, 0.5, -7.0), (2e-3, 1.9e-3, -0.5)] {
            for tilt in [0.0, 0.7, 2.0] {
                let mut points = ellipse(a, b, tilt, rate, 3.0, 0.0);
                let orbit = measure_and_stretch(&mut points, false, 0.2);
                assert!((orbit.rate / rate - 1.0).abs() < 1e-6, "{orbit:?} for {rate}");
                assert!((orbit.axis_ratio - b / a).abs() < 1e-6);
                assert!((orbit.radius - (0.5 * (a * a + b * b)).sqrt()).abs() < 1e-9);
                assert!(points.position.iter().all(|[y, z]| (y.hypot(*z) - 1.0).abs() < 1e-6));
            }
        }
    }

    #[test]
    fn drift_of_the_centre_is_taken_out() {
        let mut points = ellipse(1.0, 1.0, 0.0, 4.0, 2.5, 1.0);
        let orbit = measure_and_stretch(&mut points, true, 0.2);
        assert!((orbit.rate / 4.0 - 1.0).abs() < 0.1, "{orbit:?}");
    }

    #[test]
    fn line_has_no_rate() {
        let mut points = ellipse(1.0, 0.05, 0.4, 4.0, 3.0, 0.0);
        assert_eq!(measure_and_stretch(&mut points, false, 0.2).rate, 0.0);
        points.position.iter_mut().for_each(|point| *point = [2.0, 2.0]);
        let standing = measure_and_stretch(&mut points, false, 0.2);
        assert!(standing.rate == 0.0 && standing.radius < 1e-12, "{standing:?}");
    }
}
