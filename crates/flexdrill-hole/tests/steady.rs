//! The curvature to which a hole grows, against the closed form and against an elastica with large rotations.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "support/elastica.rs"]
mod elastica;
mod support;

use flexdrill_hole::{Advance, BitLaw, Gravity, Guide, bounds, indifferent_resistance, steady};
use support::{ARC, CHORD, SOFT, agree, drill, guide};

/// The paper's guide in a hole of constant weight across it.
fn level(factor: f64) -> Guide {
    Guide {
        gravity: Gravity::LowSide,
        ..guide(factor)
    }
}

/// Mean of a figure over the last metres.
fn mean(drilled: &[Advance], metres: f64, figure: impl Fn(&Advance) -> f64) -> f64 {
    let last = &drilled[drilled.len() - (metres / CHORD) as usize..];
    last.iter().map(figure).sum::<f64>() / last.len() as f64
}

#[test]
fn steady_curvature_of_program_elastica_and_closed_form() {
    // Bending factor, eta, W (N), and kb (1/m) of a second program, of finite differences.
    for (factor, eta, weight, curvature) in [
        (0.03, 20.0, 10e3, 0.3285),
        (0.03, 100.0, 10e3, 0.3589),
        (SOFT, 20.0, 10e3, 0.3193),
        (SOFT, 25.0, 8e3, 0.3207),
        (SOFT, 10.0, 20e3, 0.3113),
        (SOFT, 100.0, 10e3, 0.3459),
    ] {
        let (guide, law) = (level(factor), BitLaw::sharp(weight, eta));
        let formula = steady(&guide, &law, 1.0).unwrap();
        let (exact, exact_force, exact_tilt, length) = elastica::steady(&guide, &law, formula);
        let drilled = drill(guide, law, formula.curvature, 14.0);
        let kb = mean(&drilled, 3.0, |at| at.build);
        println!("f {factor}, eta {eta}, W {weight}:");
        agree("  kb, elastica", kb, exact, 0.002);
        agree("  kb, second program", kb, curvature, 0.005);
        agree("  kb, closed form", kb, formula.curvature, 0.02);
        agree(
            "  F, elastica",
            mean(&drilled, 3.0, |at| at.side_force.y),
            exact_force,
            0.02,
        );
        agree("  t, elastica", mean(&drilled, 3.0, |at| at.tilt.y), exact_tilt, 0.02);
        // The wall yields, so that it carries the guide some (4 EI/k)^(1/4) = 0.1 m nearer to the bit.
        agree("  l, elastica", drilled[drilled.len() - 1].free_length, length, 0.155);
    }
}

/// Holes that ripple: their mean curvature is that of the second program.
#[test]
fn a_blunt_bit_or_a_stiff_guide_ripples_about_the_closed_form() {
    let worn = BitLaw {
        active_weight: 1330.0,
        ..BitLaw::sharp(10e3, 20.0)
    };
    for (factor, law, curvature) in [(SOFT, worn, 0.285), (1.0, BitLaw::sharp(10e3, 20.0), 0.3077)] {
        let formula = steady(&level(factor), &law, 1.0).unwrap();
        assert!(formula.steering_number < flexdrill_hole::RIPPLE_THRESHOLD);
        let drilled = drill(level(factor), law, formula.curvature, 14.0);
        let kb = mean(&drilled, 8.0, |at| at.build);
        agree("kb, second program", kb, curvature, 0.015);
        let spread = mean(&drilled, 8.0, |at| (at.build - kb).powi(2)).sqrt();
        println!("spread {spread}, P {}", formula.steering_number);
        assert!(spread > 5e-4, "no ripples: {spread}");
    }
}

/// The formulas' numbers as a second program has them.
#[test]
fn closed_form() {
    for (factor, eta, weight, curvature, length) in [
        (0.03, 20.0, 10e3, 0.3268, 1.101),
        (SOFT, 20.0, 10e3, 0.31798, 1.211),
        (SOFT, 2.66, 10e3, 0.2805, 0.951),
        (1.0, 20.0, 10e3, 0.3070, 2.092),
        (1.0, 100.0, 10e3, 0.3145, 2.634),
    ] {
        let found = steady(&level(factor), &BitLaw::sharp(weight, eta), 1.0).unwrap();
        agree("kb", found.curvature, curvature, 3e-4);
        agree("l", found.free_length, length, 1e-3);
    }
    // What drills its own curvature does not know its free curvature from the formula for D = 0.
    let guide = level(SOFT);
    let resistance = indifferent_resistance(&guide, 10e3, 1.0).unwrap();
    agree("indifferent", resistance, 159e3, 5e-3);
    let found = steady(&guide, &BitLaw::sharp(10e3, resistance / 10e3), 1.0).unwrap();
    agree("kb", found.curvature, ARC, 1e-9);
}

/// The table for the driller in `docs/hole_ahead.md`: radii (m) by weight (kN).
#[test]
fn radii_over_the_weight() {
    for (worn, radii) in [
        (
            0.0,
            &[
                (6.0, 3.209),
                (8.0, 3.175),
                (10.0, 3.145),
                (12.0, 3.117),
                (15.0, 3.078),
                (20.0, 3.020),
            ][..],
        ),
        (8670.0, &[(10.0, 3.565), (12.0, 3.451), (15.0, 3.331), (20.0, 3.198)]),
    ] {
        for &(kn, radius) in radii {
            let law = BitLaw {
                active_weight: 1e3 * kn - worn,
                ..BitLaw::sharp(1e3 * kn, 20.0)
            };
            let found = steady(&level(SOFT), &law, 1.0).unwrap();
            agree("radius", 1.0 / found.curvature, radius, 1e-3);
        }
    }
}

#[test]
fn bounds_are_those_of_the_second_program() {
    let guide = level(SOFT);
    let at = bounds(&guide, 10e3, 1.0).unwrap();
    agree("shortest radius", 1.0 / at.high, 2.814, 1e-3);
    agree("longest radius", 1.0 / at.low, 3.646, 1e-3);
    // The program at eta W_a = 1e7 N.
    let drilled = drill(guide, BitLaw::sharp(10e3, 1e3), 0.35, 14.0);
    agree("kb", mean(&drilled, 3.0, |at| at.build), 0.3543, 0.01);
}

#[test]
fn bits_that_cannot_be_are_errors() {
    let guide = level(SOFT);
    assert!(steady(&guide, &BitLaw::sharp(10e3, 1.0), 1.0).is_err());
    assert!(steady(&guide, &BitLaw::sharp(f64::INFINITY, 20.0), 1.0).is_err());
    assert!(bounds(&guide, -1.0, 1.0).is_err());
    let worn = BitLaw {
        active_weight: 11e3,
        ..BitLaw::sharp(10e3, 20.0)
    };
    assert!(steady(&guide, &worn, 1.0).is_err());
}
