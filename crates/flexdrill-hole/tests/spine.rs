//! A guide whose spine lies off its axis: thrust bends it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "support/elastica.rs"]
mod elastica;
mod support;

use flexdrill_hole::{Advance, BitLaw, Gravity, Guide, Spine, at_rest, bounds, steady};
use nalgebra::Vector2;
use support::{ARC, CHORD, SOFT, TUBE, agree, arc, drill, guide};

/// Spine on the low side, 45 mm off the axis, of slots that stay open.
const OPEN: Spine = Spine {
    offset: 0.045,
    turn: 0.0,
    most: None,
};

/// The soft guide with a spine, in a hole of constant weight across it.
fn level(free_curvature: f64, spine: Option<Spine>) -> Guide {
    Guide {
        gravity: Gravity::LowSide,
        free_curvature,
        spine,
        ..guide(SOFT)
    }
}

/// Mean build curvature over the last 3 m of 14 (1/m).
fn drilled(guide: Guide, law: BitLaw) -> (f64, Vec<Advance>) {
    let formula = steady(&guide, &law, 1.0).unwrap();
    let drilled = drill(guide, law, formula.curvature, 14.0);
    let last = drilled[drilled.len() - (3.0 / CHORD) as usize..].to_vec();
    (last.iter().map(|at| at.build).sum::<f64>() / last.len() as f64, last)
}

/// Weight, thrust on the curve, walls and both ends balance as forces in the world's frame, with the couple of the thrust on the
/// spine in the thrust along the guide.
#[test]
fn all_forces_in_an_arc_balance() {
    let tool = Guide {
        wall_friction: 0.0,
        free_curvature: 0.28,
        spine: Some(OPEN),
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
    sum.z += tool.weight_per_metre * tool.length + rest.thrust[0];
    println!("{sum}");
    // As for a guide whose spine is on its axis: what acts on a curve of a radius larger by the gap, 0.25 % of 18 kN.
    assert!(sum.x.abs() < 45.0 && sum.y == 0.0 && sum.z.abs() < 45.0, "{sum}");
}

/// Closed form, statics and an elastica with large rotations, for guides whose shape under the weight is about that of the
/// arc. The bars are those of guides without a spine; see steady.rs.
#[test]
fn the_steady_hole_is_that_of_the_elastica() {
    for (free_curvature, weight, offset) in [(0.30, 10e3, 0.045), (0.28, 20e3, 0.045), (0.30, 15e3, 0.02)] {
        let tool = level(free_curvature, Some(Spine { offset, ..OPEN }));
        let law = BitLaw::sharp(weight, 20.0);
        let formula = steady(&tool, &law, 1.0).unwrap();
        let (exact, force, tilt, _) = elastica::steady(&tool, &law, formula);
        let (kb, last) = drilled(tool, law);
        let mean = |of: &dyn Fn(&Advance) -> f64| last.iter().map(of).sum::<f64>() / last.len() as f64;
        println!("kf {free_curvature}, {weight} N, e {offset}:");
        agree("  kb, elastica", kb, exact, 0.002);
        agree("  kb, closed form", kb, formula.curvature, 0.02);
        agree("  F, elastica", mean(&|at| at.side_force.y), force, 0.02);
        agree("  t, elastica", mean(&|at| at.tilt.y), tilt, 0.02);
        let at = bounds(&tool, weight, 1.0).unwrap();
        assert!(at.low < exact && exact < at.high, "{at:?}");
    }
}

/// What the weight adds to the drilled curvature is e W/EI until the slots are shut at k_c, here from 15.1 kN on: the drilled
/// curvature less that of the same guide without a spine, in the statics and in the closed form. A guide that is more curved
/// presses harder on the wall, D (p) changes by some per cent of the difference.
#[test]
fn the_drilled_curvature_rises_with_the_weight_until_the_slots_are_shut() {
    let spine = Spine {
        most: Some(0.02),
        ..OPEN
    };
    let shut_from = SOFT * TUBE * 0.02 / 0.045;
    agree("shut from", shut_from, 15.12e3, 1e-3);
    let mut before = 0.0;
    for weight in [6e3, 10e3, 14e3, 18e3, 22e3] {
        let law = BitLaw::sharp(weight, 20.0);
        let [with, without] = [Some(spine), None].map(|spine| level(0.29, spine));
        let more = f64::min(0.045 * weight / (SOFT * TUBE), 0.02);
        println!("{weight} N:");
        let formula = [&with, &without].map(|guide| steady(guide, &law, 1.0).unwrap().curvature);
        agree("  closed form", formula[0] - formula[1], more, 0.05);
        let (kb, _) = drilled(with, law);
        let (alone, _) = drilled(without, law);
        agree("  drilled", kb - alone, more, 0.08);
        // With shut slots it drills what a guide drills that was made with k_c more.
        if weight > shut_from {
            let made = level(0.29 + 0.02, None);
            agree("  shut", formula[0], steady(&made, &law, 1.0).unwrap().curvature, 1e-12);
        } else {
            assert!(kb - alone > before, "{kb}");
        }
        before = kb - alone;
    }
}

/// A spine to the left bends the guide to the right, and one to the right to the left by as much.
#[test]
fn a_spine_aside_turns_the_hole_aside() {
    let walk = |turn: f64| {
        let tool = level(0.30, Some(Spine { turn, ..OPEN }));
        let (_, last) = drilled(tool, BitLaw::sharp(10e3, 20.0));
        last.iter().map(|at| at.walk).sum::<f64>() / last.len() as f64
    };
    let [right, left] = [0.5, -0.5].map(walk);
    println!("{right} {left}");
    assert!(right > 0.0 && (right + left).abs() < 1e-9, "{right} {left}");
    // Its part to the right is e W/EI sin 0.5; friction and thrust on the deflected guide are left out.
    agree("walk", right, 0.045 * 10e3 / (SOFT * TUBE) * 0.5_f64.sin(), 0.1);
}

#[test]
fn pieces_and_a_spine_add_up() {
    use flexdrill_hole::{Bend, Bends};
    let changes = [Bend {
        from: 0.6,
        curvature: ARC,
    }];
    let tool = Guide {
        bends: Bends::new(&changes).unwrap(),
        ..level(0.29, Some(OPEN))
    };
    let law = BitLaw::sharp(10e3, 20.0);
    let formula = steady(&tool, &law, 1.0).unwrap();
    let (exact, ..) = elastica::steady(&tool, &law, formula);
    let (kb, _) = drilled(tool, law);
    agree("kb, elastica", kb, exact, 0.002);
    agree("kb, closed form", kb, formula.curvature, 0.02);
}

#[test]
fn a_spine_that_cannot_be_is_an_error() {
    for spine in [
        Spine { offset: -0.01, ..OPEN },
        Spine {
            offset: f64::NAN,
            ..OPEN
        },
        Spine {
            turn: f64::INFINITY,
            ..OPEN
        },
        Spine {
            most: Some(0.0),
            ..OPEN
        },
    ] {
        assert!(
            at_rest(&level(ARC, Some(spine)), 10e3, &arc(45.0, CHORD)).is_err(),
            "{spine:?}"
        );
    }
}
