//! The orbit in time: centre, radius, axes, and the phase rate from the swept area and from counted turns.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::orbit_window::Points;

/// First and second moments of the motion in a window, and its phase rate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Orbit {
    /// Root mean square distance from the centre (m).
    pub(super) radius: f64,
    /// Minor over major axis of the covariance, 0 for a line, 1 for a circle.
    pub(super) axis_ratio: f64,
    /// Phase rate about the centre (rad/s) from the swept area, positive from y towards z: for several lines the mean,
    /// weighted by power.
    pub(super) rate: f64,
}

/// Subtracts the centre (and, with `detrend`, its linear drift) from the points and measures the orbit. Unless the
/// orbit is smaller than `min_radius` or flatter than `min_axis_ratio`, it then scales the points along both axes, so
/// that the orbit becomes a unit circle, and measures the rate.
///
/// The rate is dA/dt / sqrt(det C), with A the swept area and C the covariance: for any ellipse that is exactly its
/// angular rate, since stretching an ellipse to a circle changes area and sqrt(det C) alike. White noise adds no area
/// on average, and a motion along a line sweeps none.
pub(super) fn measure_and_stretch(points: &mut Points, detrend: bool, min_radius: f64, min_axis_ratio: f64) -> Orbit {
    let count = points.position.len();
    // Two points have no area.
    if count < 3 {
        return Orbit::default();
    }
    let Moments {
        mean,
        slope,
        yy,
        zz,
        yz,
    } = moments(&points.position, detrend);
    // Principal axes of the covariance.
    let half_sum = 0.5 * (yy + zz);
    let half_difference = (0.25 * (yy - zz).powi(2) + yz * yz).sqrt();
    // Rounding can make the smaller one slightly negative for a line.
    let (major, minor) = (half_sum + half_difference, (half_sum - half_difference).max(0.0));
    let mut orbit = Orbit {
        radius: (yy + zz).max(0.0).sqrt(),
        ..Orbit::default()
    };
    // A point has no axes; the default ratio stands.
    if major > 0.0 {
        orbit.axis_ratio = (minor / major).sqrt();
    }
    // An orbit too small to be judged is returned before the costly part.
    if orbit.radius < min_radius {
        return orbit;
    }
    // A line cannot be stretched to a circle: its noise would be stretched with it.
    let is_line = major <= 0.0 || orbit.axis_ratio < min_axis_ratio;
    let stretch = if is_line {
        [1.0, 0.0, 0.0, 1.0]
    } else {
        let angle = 0.5 * libm::atan2(2.0 * yz, yy - zz);
        let (sin, cos) = libm::sincos(angle);
        // The factor 2 gives the stretched orbit the mean square radius 1, which the arc sine below needs.
        let (along, across) = ((2.0 * major).sqrt().recip(), (2.0 * minor).sqrt().recip());
        [along * cos, along * sin, -across * sin, across * cos]
    };
    // The drift is subtracted around the middle, where mean and slope do not depend on each other.
    let middle = 0.5 * (count as f64 - 1.0);
    for (index, position) in points.position.iter_mut().enumerate() {
        let lever = index as f64 - middle;
        let (y, z) = (
            position[0] - mean[0] - slope[0] * lever,
            position[1] - mean[1] - slope[1] * lever,
        );
        *position = [stretch[0] * y + stretch[1] * z, stretch[2] * y + stretch[3] * z];
    }
    if !is_line {
        // Twice the area of the stretched orbit, whose mean square radius is 1.
        let area: f64 = points.position.windows(2).map(|pair| cross(pair[0], pair[1])).sum();
        // The area over a chord is less than over its arc: one step sweeps r2/2 sin(phase step), hence the arc sine.
        orbit.rate = libm::asin((area / (count as f64 - 1.0)).clamp(-1.0, 1.0)) / points.spacing;
    }
    orbit
}

/// Centre, drift per point, and covariance about them.
struct Moments {
    mean: [f64; 2],
    slope: [f64; 2],
    yy: f64,
    zz: f64,
    yz: f64,
}

fn moments(position: &[[f64; 2]], detrend: bool) -> Moments {
    let n = position.len() as f64;
    let middle = 0.5 * (n - 1.0);
    // Sums about the first point, so that a small orbit far from the gap's centre loses no digits.
    let origin = position[0];
    let (mut sum, mut lever_sum, mut square, mut product) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
    for (index, point) in position.iter().enumerate() {
        let lever = index as f64 - middle;
        let at = [point[0] - origin[0], point[1] - origin[1]];
        for axis in 0..2 {
            sum[axis] += at[axis];
            lever_sum[axis] += lever * at[axis];
            square[axis] += at[axis] * at[axis];
        }
        product += at[0] * at[1];
    }
    let inertia = n * (n * n - 1.0) / 12.0;
    let mean = sum.map(|sum| sum / n);
    let slope = lever_sum.map(|sum| if detrend { sum / inertia } else { 0.0 });
    let about = |square: f64, a: usize, b: usize| square / n - mean[a] * mean[b] - slope[a] * slope[b] * inertia / n;
    Moments {
        mean: [mean[0] + origin[0], mean[1] + origin[1]],
        slope,
        yy: about(square[0], 0, 0),
        zz: about(square[1], 1, 1),
        yz: about(product, 0, 1),
    }
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Phase rate (rad/s) from the turns about the centre: with several lines, that of a line larger than all others
/// together.
pub(super) fn turning(points: &Points) -> f64 {
    let steps = points.position.len().saturating_sub(1).max(1);
    turned(&points.position) / (steps as f64 * points.spacing)
}

/// Angle (rad) by which the points turn about the origin, from y towards z. It counts quadrants, so that only the first
/// and the last point need an arc tangent.
fn turned(position: &[[f64; 2]]) -> f64 {
    let (Some(first), Some(last)) = (position.first(), position.last()) else {
        return 0.0;
    };
    let mut quarters = 0;
    let mut before = quadrant(*first);
    for pair in position.windows(2) {
        let now = quadrant(pair[1]);
        quarters += match (now - before).rem_euclid(4) {
            0 => 0,
            1 => 1,
            3 => -1,
            // Two quadrants on: the side on which the chord passes the centre decides the sign.
            _ if cross(pair[0], pair[1]) >= 0.0 => 2,
            _ => -2,
        };
        before = now;
    }
    let within = |[y, z]: [f64; 2]| libm::atan2(z, y).rem_euclid(TAU) - f64::from(quadrant([y, z])) * FRAC_PI_2;
    f64::from(quarters) * FRAC_PI_2 + within(*last) - within(*first)
}

/// 0 to 3, counted from y towards z.
fn quadrant([y, z]: [f64; 2]) -> i32 {
    match (y >= 0.0, z >= 0.0) {
        (true, true) => 0,
        (false, true) => 1,
        (false, false) => 2,
        (true, false) => 3,
    }
}

/// Correlation of the motion with itself after `lag` (in points): 1 for an exact repetition, around 0 for none.
pub(super) fn repetition(position: &[[f64; 2]], lag: f64) -> f64 {
    let (whole, part) = (lag as usize, lag.fract());
    let Some(overlap) = position.len().checked_sub(whole + 1).filter(|overlap| *overlap >= 8) else {
        return 0.0;
    };
    let (mut product, mut early, mut late) = (0.0, 0.0, 0.0);
    for (index, a) in position[..overlap].iter().enumerate() {
        let (left, right) = (position[index + whole], position[index + whole + 1]);
        let b = [0, 1].map(|axis: usize| left[axis] + (right[axis] - left[axis]) * part);
        product += a[0] * b[0] + a[1] * b[1];
        early += a[0] * a[0] + a[1] * a[1];
        late += b[0] * b[0] + b[1] * b[1];
    }
    let size = (early * late).sqrt();
    if size > 0.0 { product / size } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

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
                let orbit = measure_and_stretch(&mut points, false, 0.0, 0.2);
                assert!((orbit.rate / rate - 1.0).abs() < 1e-6, "{orbit:?} for {rate}");
                assert!((turning(&points) / rate - 1.0).abs() < 1e-9, "{orbit:?} for {rate}");
                assert!((orbit.axis_ratio - b / a).abs() < 1e-6);
                assert!((orbit.radius - (0.5 * (a * a + b * b)).sqrt()).abs() < 1e-9);
                assert!(points.position.iter().all(|[y, z]| (y.hypot(*z) - 1.0).abs() < 1e-6));
            }
        }
    }

    #[test]
    fn drift_of_the_centre_is_taken_out() {
        let mut points = ellipse(1.0, 1.0, 0.0, 4.0, 2.5, 1.0);
        let orbit = measure_and_stretch(&mut points, true, 0.0, 0.2);
        assert!((orbit.rate / 4.0 - 1.0).abs() < 0.1, "{orbit:?}");
    }

    #[test]
    fn line_has_no_rate() {
        let mut points = ellipse(1.0, 0.05, 0.4, 4.0, 3.0, 0.0);
        assert_eq!(measure_and_stretch(&mut points, false, 0.0, 0.2).rate, 0.0);
        points.position.iter_mut().for_each(|point| *point = [2.0, 2.0]);
        let standing = measure_and_stretch(&mut points, false, 0.0, 0.2);
        assert!(standing.rate == 0.0 && standing.radius < 1e-12, "{standing:?}");
    }

    #[test]
    fn turning_is_that_of_the_larger_line() {
        let mut points = ellipse(1.0, 1.0, 0.0, 3.0, 4.0, 0.0);
        let spacing = points.spacing;
        for (index, point) in points.position.iter_mut().enumerate() {
            let angle = 9.0 * spacing * index as f64;
            *point = [point[0] + 0.8 * angle.cos(), point[1] + 0.8 * angle.sin()];
        }
        let orbit = measure_and_stretch(&mut points, false, 0.0, 0.2);
        assert!((turning(&points) / 3.0 - 1.0).abs() < 0.1, "{}", turning(&points));
        assert!(orbit.rate > 4.5, "{orbit:?}");
    }

    #[test]
    fn a_motion_repeats_after_its_period_only() {
        let points = ellipse(1.0, 0.6, 0.3, 5.0, 4.0, 0.0);
        // 120 points in four turns.
        assert!(repetition(&points.position, 30.0) > 0.99);
        assert!(repetition(&points.position, 15.0) < -0.5);
        assert_eq!(repetition(&points.position, 118.0), 0.0);
    }
}
