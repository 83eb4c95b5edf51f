//! Curvatures, long arcs and what no bit leaves, in words.

use flexdrill_core::units::n_to_kn;
use flexdrill_hole::Bounds;

use super::Long;

/// Curvature (1/m) below which a hole counts as straight: 0.06 deg/m.
pub const STRAIGHT: f64 = 1e-3;

/// The radius of a curvature (1/m) in words.
pub fn radius(curvature: f64) -> String {
    if curvature.abs() < STRAIGHT {
        "straight".to_owned()
    } else {
        format!("{:.2} m", 1.0 / curvature.abs())
    }
}

/// The radii between two curvatures (1/m), the larger curvature first.
pub fn radii(low: f64, high: f64) -> String {
    if low < STRAIGHT {
        format!("{} to straight or dropping", radius(high))
    } else {
        format!("{} to {}", radius(high), radius(low))
    }
}

/// What a curvature (1/m) asks of the hole.
pub fn needed(curvature: f64) -> String {
    match curvature {
        curvature if curvature.abs() < STRAIGHT => "a straight hole".to_owned(),
        curvature if curvature > 0.0 => format!("a radius of {} on the mean", radius(curvature)),
        curvature => format!("a drop with a radius of {} on the mean", radius(curvature)),
    }
}

/// What the closed form says of a long arc: curvature, free length, steering number, ripple. `at` names the weight.
pub fn in_a_long_arc(long: Option<&Long>, at: &str) -> String {
    let Some(long) = long else {
        return format!("A long arc of this tool has no steady radius{at}: the weight bends the guide without limit.");
    };
    let ripple = if long.ripples() {
        format!(
            "the hole ripples, with a period of about {:.1} m and the same mean radius",
            long.free_length
        )
    } else {
        "the hole does not ripple".to_owned()
    };
    let turn = if long.curvature.abs() < STRAIGHT {
        "straight on".to_owned()
    } else {
        let sense = if long.curvature < 0.0 { ", dropping" } else { "" };
        format!("a radius of {}{sense}", radius(long.curvature))
    };
    format!(
        "In a long arc it drills {turn}{at}: {:.2} m between bit and wall are free, steering number {:.1} (below 2.2 the hole \
         ripples): {ripple}.",
        long.free_length, long.steering_number
    )
}

/// The range that no bit leaves at a largest weight (N) and below it.
pub fn any_bit(bounds: Option<&Bounds>, largest_weight: f64) -> String {
    let weight = n_to_kn(largest_weight);
    match bounds {
        Some(bounds) => {
            let range = if bounds.low < STRAIGHT {
                format!("shorter than {}", radius(bounds.high))
            } else {
                format!("outside {}", radii(bounds.low, bounds.high))
            };
            format!(
                "No bit and no rock makes this guide drill a radius {range} in a long arc at {weight:.1} kN, the largest \
                 weight (inputs.weight_on_bit.max_kn), or below it."
            )
        }
        None => format!("At {weight:.1} kN, the largest weight, the thrust bends this guide without limit."),
    }
}
