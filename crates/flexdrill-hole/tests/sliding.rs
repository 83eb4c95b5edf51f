//! A guide that slides along its hole, against closed forms and a rope that is integrated here.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use std::f64::consts::FRAC_PI_2;

use flexdrill_hole::{Guide, Hole, Sense, sliding};
use support::{ARC, SOFT, arc, guide};

const SENSES: [Sense; 2] = [Sense::Out, Sense::In];

fn straight(inclination: f64, length: f64) -> Hole {
    Hole::begin(inclination, 0.0).unwrap().straight(length, 0.04).unwrap()
}

/// With weight there is no closed form of both branches in one arc: a rope of 100,000 pieces, by Euler's rule, is the witness.
#[test]
fn a_soft_guide_with_weight_is_a_rope_on_both_sides_of_its_arc() {
    let hole = arc(90.0, 0.02);
    for at_bit in [0.0, 500.0, 20e3] {
        for sense in SENSES {
            let tool = Guide {
                bending_stiffness: 500.0,
                free_curvature: ARC,
                gap: 0.0005,
                length: FRAC_PI_2 / ARC,
                ..guide(SOFT)
            };
            let (mut tension, pieces) = (at_bit, 100_000);
            let step = FRAC_PI_2 / f64::from(pieces);
            for piece in 0..pieces {
                let inclination = FRAC_PI_2 - (f64::from(piece) + 0.5) * step;
                let (sine, cosine) = inclination.sin_cos();
                // Tension pulls the guide to the high side, weight to the low side.
                let contact = (tension * ARC - tool.weight_per_metre * sine).abs();
                tension += (tool.weight_per_metre * cosine + sense.sign() * tool.wall_friction * contact) / ARC * step;
            }
            let found = sliding(&tool, at_bit, &hole, sense).unwrap().top_tension();
            // Where the guide changes sides it hangs free over some tenths of a metre: 1 % of its weight.
            let weight = tool.weight_per_metre * tool.length;
            assert!(
                (found - tension).abs() < 0.005 * tension.abs() + 0.01 * weight,
                "{at_bit} N, {sense:?}: {found}, not {tension} N"
            );
        }
    }
}

#[test]
fn nonsense_is_refused() {
    let tool = guide(SOFT);
    assert!(sliding(&tool, f64::NAN, &straight(0.0, 6.0), Sense::Out).is_err());
    assert!(sliding(&tool, 0.0, &straight(0.0, 1.0), Sense::Out).is_err());
    let level = Guide {
        gravity: flexdrill_hole::Gravity::LowSide,
        ..tool
    };
    assert!(sliding(&level, 0.0, &straight(0.0, 6.0), Sense::Out).is_err());
}
