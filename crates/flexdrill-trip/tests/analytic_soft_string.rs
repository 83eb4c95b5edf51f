//! The soft string against closed forms, and against a chain of points that knows neither curvature nor inclination.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::f64::consts::FRAC_PI_2;

use flexdrill_trip::Sense;
use flexdrill_trip::soft_string::{Load, Motion, Piece, above_bend};

const SENSES: [Sense; 2] = [Sense::Out, Sense::In];

fn piece(length: f64, inclination: f64, curvature: f64, weight: f64) -> Piece {
    Piece {
        length,
        inclination,
        curvature,
        along: weight,
        across: weight,
        friction: 0.3,
        radius: 0.05,
    }
}

fn near(found: f64, expected: f64, share: f64) {
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{found}, not {expected}"
    );
}

/// Two pieces of 600 m hang: the rounding of their sums.
const ROUNDING: f64 = 1e-12;

#[test]
fn a_straight_hole_asks_for_w_cos_and_mu_w_sin() {
    for degrees in [0.0_f64, 40.0, 80.0, 90.0, 110.0] {
        for sense in SENSES {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let string = piece(600.0, degrees.to_radians(), 0.0, 120.0);
            let found = string.above(
                Load {
                    tension: 5e3,
                    torque: 0.0,
                },
                &Motion::sliding(sense),
            );
            near(
                found.tension,
                5e3 + 600.0 * 120.0 * (cosine + sense.sign() * 0.3 * sine),
                ROUNDING,
            );
            assert_eq!(found.torque, 0.0);
        }
    }
}

/// Without weight e^(mu theta), of a pull and of a push; a bend without length is an arc of any radius.
#[test]
fn an_arc_is_a_rope_round_a_drum() {
    for (tension, sense) in [
        (8e3_f64, Sense::Out),
        (8e3, Sense::In),
        (-3e3, Sense::Out),
        (-3e3, Sense::In),
    ] {
        let expected = tension * (sense.sign() * tension.signum() * 0.3 * FRAC_PI_2).exp();
        for radius in [3.2, 40.0] {
            let arc = piece(radius * FRAC_PI_2, 0.0, 1.0 / radius, 0.0);
            let at = Load { tension, torque: 0.0 };
            // Steps of 2 cm: (mu h / R)^4 / 120 of each.
            near(arc.above(at, &Motion::sliding(sense)).tension, expected, 1e-10);
        }
        near(above_bend(FRAC_PI_2, 0.3, tension, 1.0, sense), expected, ROUNDING);
    }
}

/// In one branch the law has a closed form. Where tension holds the string on the high side, pulled out from a level end up:
/// T = C e^(mu theta) - w R (2 mu sin theta + (1 - mu^2) cos theta) / (1 + mu^2).
#[test]
fn an_arc_with_weight_has_the_closed_form_of_its_branch() {
    let (radius, weight, mu) = (10.0, 200.0, 0.3_f64);
    let arc = piece(radius * FRAC_PI_2, 0.0, 1.0 / radius, weight);
    let start = 30e3;
    // With theta from the level end up, i = pi/2 - theta: T' = w R sin theta + mu (T - w R cos theta).
    let particular = |theta: f64| {
        let (sine, cosine) = theta.sin_cos();
        -weight * radius * (2.0 * mu * sine + (1.0 - mu * mu) * cosine) / (1.0 + mu * mu)
    };
    let expected = (start - particular(0.0)) * (mu * FRAC_PI_2).exp() + particular(FRAC_PI_2);
    let found = arc.above(
        Load {
            tension: start,
            torque: 0.0,
        },
        &Motion::sliding(Sense::Out),
    );
    near(found.tension, expected, 1e-10);
}

/// Friction opposes the whole sliding velocity: v / sqrt(v^2 + (omega r)^2) along the hole, the rest around.
#[test]
fn rotation_turns_friction_around() {
    let string = piece(500.0, FRAC_PI_2, 0.0, 100.0);
    let rubs = 0.3 * 100.0 * 500.0;
    for ratio in [0.0, 0.2, 1.0, 5.0] {
        let motion = Motion {
            sense: Sense::Out,
            along: 0.2,
            spin: ratio * 0.2 / 0.05,
        };
        let found = string.above(Load::default(), &motion);
        let whole = (1.0 + ratio * ratio).sqrt();
        near(found.tension, rubs / whole, 1e-9);
        near(found.torque, 0.05 * rubs * ratio / whole, 1e-9);
    }
    let turning = string.above(Load::default(), &Motion::TURNING);
    // Level to the rounding of pi/2: w L cos.
    assert!(turning.tension.abs() < 1e-10, "{turning:?}");
    near(turning.torque, 0.05 * rubs, ROUNDING);
}

#[test]
fn downwards_is_the_inverse_of_upwards() {
    for curvature in [0.0, 0.1] {
        for motion in SENSES.map(Motion::sliding) {
            let string = piece(10.0, 0.3, curvature, 300.0);
            let below = Load {
                tension: 4e3,
                torque: 0.0,
            };
            let back = string.below(string.above(below, &motion), &motion, f64::INFINITY);
            near(back.tension, below.tension, 1e-9);
        }
    }
    // What stands on the bottom is not pulled by what hangs above it.
    let hangs = piece(10.0, 0.0, 0.0, 300.0);
    let stands = hangs.below(
        Load {
            tension: 0.0,
            torque: 0.0,
        },
        &Motion::sliding(Sense::In),
        0.0,
    );
    near(stands.tension, -3e3, ROUNDING);
}

/// A chain of points in the plane. The tension of the upper link balances tension, weight and the wall's force and friction at
/// each point as vectors; nothing has a curvature or an inclination.
#[test]
fn vectors_at_the_points_of_a_chain_give_the_same() {
    let (radius, weight, mu) = (3.2, 361.5, 0.3);
    let points = 200_000;
    let step = FRAC_PI_2 / f64::from(points);
    for (at_bit, sense) in [
        (0.0, Sense::Out),
        (300.0, Sense::Out),
        (2e4, Sense::Out),
        (0.0, Sense::In),
        (-2e3, Sense::In),
    ] {
        let position = |index: i32| {
            // From the level end up; x along the build, z down.
            let (sine, cosine) = (f64::from(index) * step).sin_cos();
            [radius * sine, -radius * (1.0 - cosine)]
        };
        let mut tension = at_bit;
        for index in 0..points {
            let [before, here, after] = [index - 1, index, index + 1].map(position);
            let unit = |from: [f64; 2], to: [f64; 2]| {
                let length = (to[0] - from[0]).hypot(to[1] - from[1]);
                ([(to[0] - from[0]) / length, (to[1] - from[1]) / length], length)
            };
            let (lower, _) = unit(here, before);
            let (upper, length) = unit(here, after);
            // Forces but the upper link's and the wall's. Half of the first link has no weight: one of 200,000.
            let force = [lower[0] * tension, lower[1] * tension + weight * length];
            let along = [upper[0] - lower[0], upper[1] - lower[1]];
            let size = along[0].hypot(along[1]);
            let along = along.map(|of| of / size);
            let normal = [-along[1], along[0]];
            let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
            // The wall takes what is across, and rubs by it; the upper link, nearly along, takes the rest.
            let across = |upper_tension: f64| (dot(force, normal) + upper_tension * dot(upper, normal)).abs();
            let mut next = tension;
            for _ in 0..3 {
                next = (-dot(force, along) + sense.sign() * mu * across(next)) / dot(upper, along);
            }
            tension = next;
        }
        let arc = piece(radius * FRAC_PI_2, 0.0, 1.0 / radius, weight);
        let found = arc
            .above(
                Load {
                    tension: at_bit,
                    torque: 0.0,
                },
                &Motion::sliding(sense),
            )
            .tension;
        // The chain errs by its step, mu step of the tension and of the weight of the arc.
        let most = 1e-4 * (tension.abs() + weight * radius);
        assert!(
            (found - tension).abs() < most,
            "{at_bit} {sense:?}: {found}, not {tension}"
        );
    }
}
