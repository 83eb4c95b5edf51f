//! Contact forces as arrows: one list of line segments per layer, coloured from blue (small) over yellow to red.
//!
//! One marker with all arrows stays far below the size at which a hundred single arrows would be cut into many packets,
//! and needs no deletion of those whose contact has ended.

use flexdrill_messages::geometry_msgs::Point;
use flexdrill_messages::std_msgs::ColorRGBA;

/// Length of the head over that of the arrow.
const HEAD_LENGTH: f64 = 0.3;
/// Half width of the head over the length of the arrow.
const HEAD_WIDTH: f64 = 0.15;

/// Adds the three segments of an arrow from `tail` along `direction` (unit) with `length` (m); `side` (unit) is the
/// direction in which the head is wide.
pub(super) fn push_arrow(points: &mut Vec<Point>, tail: [f64; 3], direction: [f64; 3], side: [f64; 3], length: f64) {
    let at = |along: f64, across: f64| Point {
        x: tail[0] + length * (along * direction[0] + across * side[0]),
        y: tail[1] + length * (along * direction[1] + across * side[1]),
        z: tail[2] + length * (along * direction[2] + across * side[2]),
    };
    let tip = at(1.0, 0.0);
    let neck = 1.0 - HEAD_LENGTH;
    points.extend([
        at(0.0, 0.0),
        tip.clone(),
        at(neck, HEAD_WIDTH),
        tip.clone(),
        at(neck, -HEAD_WIDTH),
        tip,
    ]);
}

/// Points that [`push_arrow`] adds, each with a colour.
pub(super) const POINTS_PER_ARROW: usize = 6;

/// Colour of a force, `share` being its part of the full scale.
pub(super) fn colour(share: f64) -> ColorRGBA {
    let share = share.clamp(0.0, 1.0) as f32;
    // Blue to yellow up to the middle, then yellow to red.
    let low = (2.0 * share).min(1.0);
    let high = (2.0 * share - 1.0).max(0.0);
    ColorRGBA {
        r: low,
        g: low * (1.0 - high),
        b: 1.0 - low,
        a: 1.0,
    }
}
