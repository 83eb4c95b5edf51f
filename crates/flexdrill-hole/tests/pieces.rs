//! Guides that were made in pieces of different curvature, from the bit up.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "support/elastica.rs"]
mod elastica;
mod support;

use flexdrill_hole::{Advance, Bend, Bends, BitLaw, Gravity, Guide, at_rest, bounds, steady};
use support::{ARC, CHORD, SOFT, agree, arc, drill, guide};

/// Pieces above the one at the bit: where they begin (m), and their curvature (1/m).
fn bends(changes: &[(f64, f64)]) -> Bends {
    let changes: Vec<Bend> = changes
        .iter()
        .map(|&(from, curvature)| Bend { from, curvature })
        .collect();
    Bends::new(&changes).unwrap()
}

#[test]
fn pieces_that_are_alike_are_one_guide_to_the_bit() {
    let one = guide(SOFT);
    let alike = Guide {
        bends: bends(&[(0.7, ARC), (2.3, ARC)]),
        ..one
    };
    let hole = arc(45.0, CHORD);
    assert_eq!(
        at_rest(&one, 10e3, &hole).unwrap(),
        at_rest(&alike, 10e3, &hole).unwrap()
    );
    let law = BitLaw::sharp(10e3, 20.0);
    assert_eq!(drill(one, law, ARC, 1.0), drill(alike, law, ARC, 1.0));
    // The formulas for pieces are others than those for one: they agree to the rounding of a bisection.
    for (eta, weight) in [(20.0, 10e3), (5.0, 15e3), (100.0, 6e3)] {
        let law = BitLaw::sharp(weight, eta);
        let [a, b] = [&one, &alike].map(|guide| steady(guide, &law, 1.0).unwrap());
        agree("kb", b.curvature, a.curvature, 1e-9);
        agree("l", b.free_length, a.free_length, 1e-9);
        let [a, b] = [&one, &alike].map(|guide| bounds(guide, weight, 1.0).unwrap());
        agree("low", b.low, a.low, 1e-9);
        agree("high", b.high, a.high, 1e-9);
    }
}

/// Force (N) and tilt (mrad) of a second program for a guide that was made as the hole is, an arc below a vertical hole, at
/// 10 kN. The bar is that of the same program for a guide of one curvature in statics.rs.
#[test]
fn a_guide_made_as_the_hole_is() {
    for (factor, degrees, force, tilt) in [
        (1.0, 45.0, 4156.0, -6.84),
        (1.0, 70.0, 4030.0, -6.61),
        (SOFT, 45.0, 1868.0, -13.74),
        (SOFT, 70.0, 1913.0, -13.86),
    ] {
        let tool = Guide {
            bends: bends(&[(3.2 * f64::to_radians(degrees), 0.0)]),
            ..guide(factor)
        };
        let rest = at_rest(&tool, 10e3, &arc(degrees, CHORD)).unwrap();
        println!("f {factor}, {degrees} deg:");
        agree("  F", rest.side_force.y, force, 0.005);
        agree("  t", rest.tilt.y * 1e3, tilt, 0.005);
    }
}

/// Three free lengths above the bit the curvature does not matter: a second program has 1913 N and -13.9 mrad for both.
#[test]
fn a_straight_piece_far_above_the_bit_changes_nothing() {
    let one = guide(SOFT);
    let straight_above = Guide {
        bends: bends(&[(3.2 * 70.0_f64.to_radians(), 0.0)]),
        ..one
    };
    let hole = arc(70.0, CHORD);
    let [a, b] = [&one, &straight_above].map(|guide| at_rest(guide, 10e3, &hole).unwrap());
    agree("F", b.side_force.y, a.side_force.y, 1e-3);
    agree("t", b.tilt.y, a.tilt.y, 1e-3);
    // The piece is bent where it lies: its forces on the wall are others.
    let most = |rest: &flexdrill_hole::Equilibrium| {
        let forces = rest.wall_forces.iter().map(|force| force.norm());
        forces.fold(0.0, f64::max)
    };
    assert!((most(&a) / most(&b) - 1.0).abs() > 0.1, "{} {}", most(&a), most(&b));
}

/// Two curvatures within the free span of 1.2 m: statics, closed form and an elastica with large rotations.
#[test]
fn the_steady_hole_of_two_pieces_is_that_of_the_elastica() {
    for (at_bit, changes) in [
        (0.28, &[(0.5, ARC)][..]),
        (0.35, &[(0.3, ARC)]),
        (0.0, &[(0.2, ARC)]),
        (0.30, &[(0.2, 0.33), (0.5, ARC)]),
    ] {
        let tool = Guide {
            gravity: Gravity::LowSide,
            free_curvature: at_bit,
            bends: bends(changes),
            ..guide(SOFT)
        };
        let law = BitLaw::sharp(10e3, 20.0);
        let formula = steady(&tool, &law, 1.0).unwrap();
        let (exact, force, tilt, length) = elastica::steady(&tool, &law, formula);
        assert!(
            length > changes[changes.len() - 1].0,
            "the span ends within a piece: {length}"
        );
        let drilled = drill(tool, law, formula.curvature, 14.0);
        let last = &drilled[drilled.len() - (3.0 / CHORD) as usize..];
        let mean = |of: &dyn Fn(&Advance) -> f64| last.iter().map(of).sum::<f64>() / last.len() as f64;
        println!("{at_bit} below {changes:?}:");
        // The bars are those of a guide of one curvature; see steady.rs.
        agree("  kb, elastica", mean(&|at| at.build), exact, 0.002);
        agree("  kb, closed form", mean(&|at| at.build), formula.curvature, 0.02);
        agree("  F, elastica", mean(&|at| at.side_force.y), force, 0.02);
        agree("  t, elastica", mean(&|at| at.tilt.y), tilt, 0.02);
        let at = bounds(&tool, 10e3, 1.0).unwrap();
        assert!(at.low < exact && exact < at.high, "{at:?}");
        // A bit that drills where it points is at a bound. A straight piece holds it down: then it is the lower one.
        let sharp = steady(&tool, &BitLaw::sharp(10e3, 1e8), 1.0).unwrap();
        let bound = if at_bit == 0.0 { at.low } else { at.high };
        agree("  no sideways cutting", sharp.curvature, bound, 1e-6);
    }
}

#[test]
fn a_guide_in_pieces_that_cannot_be_is_an_error() {
    let nan = Guide {
        bends: bends(&[(1.0, 9.0)]),
        ..guide(SOFT)
    };
    assert!(at_rest(&nan, 10e3, &arc(45.0, CHORD)).is_err());
}
