//! Statics of the guide with the bit held at the hole's end.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_hole::{Guide, Hole, HoleError, at_rest};
use nalgebra::Vector2;
use support::{ARC, CHORD, SOFT, agree, arc, guide};

/// Weight, thrust on the curve, walls and both ends balance as forces in the world's frame: what acts at the bit and at the
/// upper end follows from the loads, whatever the elements are.
#[test]
fn all_forces_in_an_arc_balance() {
    let tool = Guide {
        wall_friction: 0.0,
        ..guide(SOFT)
    };
    let hole = arc(90.0, CHORD);
    let rest = at_rest(&tool, 10e3, &hole).unwrap();
    let first = hole.points().len() - rest.offsets.len();
    let frames = &hole.frames()[first..];
    let across = |index: usize, force: Vector2<f64>| frames[index].right * force.x + frames[index].low * force.y;
    let last = frames.len() - 1;
    let mut sum = -frames[last].tangent * 10e3 - across(last, rest.side_force) - across(0, rest.top_force);
    for (index, force) in rest.wall_forces.iter().enumerate() {
        sum -= across(index, *force);
    }
    sum.z += tool.weight_per_metre * tool.length;
    // The string pushes the upper end, which is vertical, with the thrust there.
    sum.z += rest.thrust[0];
    println!("{sum}");
    // Walls carry 18 kN; that they act on a curve of a radius larger by the gap, 0.25 %, is beyond first order.
    assert!(sum.x.abs() < 45.0 && sum.y == 0.0 && sum.z.abs() < 45.0, "{sum}");
}

/// Force (N) and tilt (mrad) of a second program (finite differences of the same equations) for the paper's tool at
/// rest, with the weight at which they are.
#[test]
fn side_force_and_tilt_of_the_papers_tool() {
    for (factor, kn, force, tilt) in [
        (1.0, 10.0, 4083.0, -6.636),
        (1.0, 8.0, 3503.0, -6.32),
        (1.0, 20.0, 6677.0, -7.77),
        (SOFT, 10.0, 1930.0, -13.906),
        (SOFT, 8.0, 1672.0, -13.22),
        (SOFT, 20.0, 3060.0, -16.38),
    ] {
        let tool = Guide {
            wall_friction: 0.0,
            ..guide(factor)
        };
        let rest = at_rest(&tool, 1e3 * kn, &arc(90.0, CHORD)).unwrap();
        agree("F", rest.side_force.y, force, 0.005);
        agree("t", 1e3 * rest.tilt.y, tilt, 0.005);
    }
}

/// The guide's shape belongs to the guide: made with the arc's curvature over its whole length, it points down below a
/// straight hole, and a straight one is bent into the arc. Figures of the same second program.
#[test]
fn side_force_of_a_guide_that_the_hole_bends() {
    for (degrees, curvature, force, tilt) in [
        (20.0, ARC, -1408.0, 16.8),
        (45.0, ARC, 2578.0, -15.0),
        (70.0, ARC, 1913.0, -13.9),
        (90.0, 0.0, 25512.0, 63.5),
    ] {
        let tool = Guide {
            free_curvature: curvature,
            ..guide(SOFT)
        };
        let rest = at_rest(&tool, 10e3, &arc(degrees, CHORD)).unwrap();
        agree("F", rest.side_force.y, force, 0.03);
        agree("t", 1e3 * rest.tilt.y, tilt, 0.03);
    }
}

#[test]
fn a_stiffer_wall_and_shorter_chords_change_nothing() {
    let coarse = at_rest(&guide(SOFT), 10e3, &arc(90.0, CHORD)).unwrap();
    let fine = at_rest(&guide(SOFT), 10e3, &arc(90.0, CHORD / 4.0)).unwrap();
    agree("F", coarse.side_force.y, fine.side_force.y, 1e-3);
    let soft_wall = Guide {
        wall_stiffness: 5e7,
        ..guide(SOFT)
    };
    let soft_wall = at_rest(&soft_wall, 10e3, &arc(90.0, CHORD)).unwrap();
    agree("F", soft_wall.side_force.y, coarse.side_force.y, 5e-3);
}

#[test]
fn what_cannot_be_computed_is_an_error() {
    let short = Hole::begin(0.0, 0.0).unwrap().straight(2.0, 0.04).unwrap();
    assert!(matches!(
        at_rest(&guide(SOFT), 10e3, &short),
        Err(HoleError::HoleTooShort { .. })
    ));
    let nan = Guide {
        gap: f64::NAN,
        ..guide(SOFT)
    };
    assert!(matches!(
        at_rest(&nan, 10e3, &arc(90.0, CHORD)),
        Err(HoleError::Invalid(_))
    ));
    assert!(at_rest(&guide(SOFT), -1.0, &arc(90.0, CHORD)).is_err());
    let nothing = Hole::begin(0.0, 0.0).unwrap();
    assert!(at_rest(&guide(SOFT), 1e3, &nothing).is_err());
    // A thrust of 100 MN buckles the guide: an error or an equilibrium on the walls, never a panic.
    let _ = at_rest(&guide(SOFT), 1e8, &arc(90.0, CHORD));
}
