//! The hole ahead and a guide that slides, against closed forms; the figures are rows of `docs/validation.md`.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../../flexdrill-core/tests/support/figures.rs"]
mod figures;
mod support;

use std::f64::consts::{FRAC_PI_2, TAU};

use figures::{figure, scaled_figure};
use flexdrill_hole::{
    BitLaw, Gravity, Guide, Hole, Propagation, Sense, Spine, at_rest, bounds, ripple_of_two_contacts, sliding, steady,
};
use nalgebra::Vector2;
use support::{ARC, CHORD, SOFT, TUBE, arc, drill, guide};

/// The paper's guide in a hole of constant weight across it.
fn level(factor: f64) -> Guide {
    Guide {
        gravity: Gravity::LowSide,
        ..guide(factor)
    }
}

/// A straight guide without thrust on a level wall: it lies on the wall from l = (24 EI c/q)^(1/4) behind the bit on, with
/// F = q l/2 and t = -q l3/(12 EI): a beam with one end pinned at the height c, and moment and slope 0 at the other.
/// Tolerance 0.1 %; 2 % for the stiff guide, of which 8 m are shorter than 2 l.
#[test]
fn analytic_straight_guide_wraps_on_a_level_wall() {
    for (name, factor, share) in [("soft", SOFT, 1e-3), ("stiff", 1.0, 0.02)] {
        let guide = Guide {
            length: 8.0,
            free_curvature: 0.0,
            wall_friction: 0.0,
            wall_stiffness: 5e10,
            ..guide(factor)
        };
        let hole = Hole::begin(FRAC_PI_2, 0.0).unwrap();
        let hole = hole.straight(8.0, 0.04).unwrap();
        let rest = at_rest(&guide, 1.0, &hole).unwrap();
        let q = guide.weight_per_metre;
        let length = (24.0 * guide.bending_stiffness * guide.gap / q).powf(0.25);
        let force = format!("side force, {name} guide (N)");
        figure(&force, q * length / 2.0, rest.side_force.y, share);
        let tilt = -q * length.powi(3) / (12.0 * guide.bending_stiffness);
        figure(&format!("tilt, {name} guide (rad)"), tilt, rest.tilt.y, share);
    }
}

/// The pipe's torque T turns with the hole: it pushes the bit to the right by T/R. Tolerance 5 %: the guide's end bends to
/// the side too, where the wall carries a part.
#[test]
fn analytic_torque_pushes_the_bit_to_the_right() {
    let tool = Guide {
        torque: 92.4,
        ..guide(SOFT)
    };
    let rest = at_rest(&tool, 10e3, &arc(90.0, CHORD)).unwrap();
    figure("force to the right (N)", 92.4 * ARC, rest.side_force.x, 0.05);
}

/// A column between its ends under a thrust that is e off its neutral line, k^2 = C/EI: its middle moves by
/// e (1/cos(k L/2) - 1) to the side opposite to the spine, and its ends tilt by e k tan(k L/2), the secant formula, in
/// whichever direction the spine lies. Tolerance 1e-5: elements of L/50, (k L/50)^4/720 of it.
#[test]
fn analytic_column_with_a_spine_deflects_by_the_secant_formula() {
    let (length, thrust, offset) = (1.5, 20e3, 0.045);
    let hole = Hole::begin(0.0, 0.0).unwrap().straight(length, 0.03).unwrap();
    for turn in [0.0, 0.9, std::f64::consts::PI] {
        let tool = Guide {
            length,
            free_curvature: 0.0,
            weight_per_metre: 0.0,
            gap: 1.0,
            wall_friction: 0.0,
            spine: Some(Spine {
                offset,
                turn,
                most: None,
            }),
            ..guide(SOFT)
        };
        let rest = at_rest(&tool, thrust, &hole).unwrap();
        let k = (thrust / tool.bending_stiffness).sqrt();
        let deflection = offset * (1.0 / (0.5 * k * length).cos() - 1.0);
        let tilt = offset * k * (0.5 * k * length).tan();
        // Into (right, low) of the thrust's bend, from which its lower end points back, and across it, where nothing moves.
        let toward = Vector2::new(-turn.sin(), turn.cos());
        let aside = Vector2::new(turn.cos(), turn.sin());
        let middle = rest.offsets[rest.offsets.len() / 2];
        figure(
            &format!("deflection, spine at {turn:.1} rad (m)"),
            deflection,
            middle.dot(&toward),
            1e-5,
        );
        figure(
            &format!("tilt, spine at {turn:.1} rad (rad)"),
            tilt,
            -rest.tilt.dot(&toward),
            1e-5,
        );
        scaled_figure(
            &format!("tilt across it, spine at {turn:.1} rad (rad)"),
            0.0,
            rest.tilt.dot(&aside),
            tilt,
            1e-5,
        );
        // Nothing but the thrust acts, so that the ends push nowhere across.
        assert!(
            rest.side_force.norm() < 1e-3 && rest.top_force.norm() < 1e-3,
            "{rest:?}"
        );
    }
}

/// Onset of the ripple of two contacts without play at equal spans: omega = tan omega = 4.4934 gives
/// P_c = 6/(1 - 2 omega/sin omega) = 0.5879 and a period of 2 pi/omega spans. Tolerance 1e-6: the root.
#[test]
fn analytic_onset_of_the_ripple_of_two_contacts() {
    let onset = ripple_of_two_contacts(1.0).unwrap().unwrap();
    let wave = 4.493_409_457_9_f64;
    let steering = 6.0 / (1.0 - 2.0 * wave / wave.sin());
    figure("steering number P_c (-)", steering, onset.steering_number, 1e-6);
    figure("period (spans)", TAU / wave, onset.period, 1e-6);
}

/// The curvatures that no bit leaves: kf -+ sqrt(2 p c/EI) with the load p = W kb + q of the bound itself, and the steady
/// curvature of a bit that cuts nothing sideways, and of one that cuts sideways alone. Tolerance 1e-6: the iteration of p.
#[test]
fn analytic_bounds_of_the_curvature_that_a_guide_drills() {
    let guide = level(SOFT);
    let at = bounds(&guide, 10e3, 1.0).unwrap();
    for (name, bound, sign) in [("least", at.low, -1.0), ("largest", at.high, 1.0)] {
        let load = 10e3 * bound + guide.weight_per_metre;
        let deviation = (2.0 * load * guide.gap / guide.bending_stiffness).sqrt();
        figure(&format!("{name} less kf (1/m)"), sign * deviation, bound - ARC, 1e-6);
    }
    let sharp = steady(&guide, &BitLaw::sharp(10e3, 1e8), 1.0).unwrap();
    figure("no sideways cutting (1/m)", at.high, sharp.curvature, 1e-6);
    // A bit that cuts only sideways has P -> 0 with W far below eta W_a: no thrust, all load by weight.
    let heavy = Guide {
        weight_per_metre: 3500.0,
        ..guide
    };
    let blunt = steady(&heavy, &BitLaw::sharp(1e-9, 1e6), 1.0).unwrap();
    let at = bounds(&heavy, 1e-9, 1.0).unwrap();
    figure("sideways cutting alone (1/m)", at.low, blunt.curvature, 1e-6);
}

/// A guide without loads drills its own curvature: in a hole of it at once, from another one after 7.5 m. Tolerance 3e-4
/// and 1.6e-3: the hole swings about it with a falling amplitude.
#[test]
fn analytic_guide_without_loads_drills_its_own_curvature() {
    let guide = Guide {
        weight_per_metre: 0.0,
        ..level(SOFT)
    };
    let law = BitLaw::sharp(1.0, 2e5);
    let kept = drill(guide, law, ARC, 7.5);
    let farthest = kept.iter().map(|at| at.build);
    let farthest = farthest.fold(ARC, |far, build| {
        if (build - ARC).abs() > (far - ARC).abs() {
            build
        } else {
            far
        }
    });
    figure("from kf, where it is farthest (1/m)", ARC, farthest, 3e-4);
    let found = drill(guide, law, 0.30, 7.5);
    figure(
        "from 0.30 1/m, at the end (1/m)",
        ARC,
        found[found.len() - 1].build,
        1.6e-3,
    );
}

/// A rigid guide with its upper end on the axis and no wall drops by kb = -q/(eta W_a), whatever weight and length.
/// Tolerance 0.2 %: the guide bends by its weight.
#[test]
fn analytic_rigid_pendulum_drops_by_its_weight_alone() {
    for (eta, weight) in [(20.0, 10e3), (5.0, 20e3), (10.0, 10e3)] {
        let rigid = Guide {
            length: 1.0,
            bending_stiffness: TUBE * 1e3,
            free_curvature: 0.0,
            gap: 0.5,
            ..level(1.0)
        };
        let hole = Hole::begin(1.0, 0.0).unwrap().straight(1.2, 0.02).unwrap();
        let (mut propagation, _) = Propagation::begin(rigid, BitLaw::sharp(weight, eta), hole, 0.02).unwrap();
        let drilled = propagation.drill(12.0).unwrap();
        let last = &drilled[drilled.len() - 50..];
        let kb = last.iter().map(|at| at.build).sum::<f64>() / 50.0;
        let expected = -rigid.weight_per_metre / (eta * weight);
        figure(&format!("eta {eta}, {} kN (1/m)", 1e-3 * weight), expected, kb, 2e-3);
    }
}

/// A guide that slides in a straight inclined hole: q L (cos i +- mu sin i) at its upper end, since the wall carries the
/// weight across the hole wherever it does, ends included. Tolerance 2e-5 of the weight: the bit's friction is iterated.
#[test]
fn analytic_inclined_hole_asks_for_the_weight_and_its_friction() {
    for degrees in [0.0_f64, 30.0, 75.0, 90.0] {
        let inclination = degrees.to_radians();
        for (name, sense) in [("out", Sense::Out), ("in", Sense::In)] {
            let tool = Guide {
                free_curvature: 0.0,
                length: 8.0,
                ..guide(SOFT)
            };
            let hole = Hole::begin(inclination, 0.0).unwrap().straight(8.0, 0.04).unwrap();
            let found = sliding(&tool, 0.0, &hole, sense).unwrap().top_tension();
            let weight = tool.weight_per_metre * tool.length;
            let expected = weight * (inclination.cos() + sense.sign() * tool.wall_friction * inclination.sin());
            scaled_figure(&format!("{degrees} deg, {name} (N)"), expected, found, weight, 2e-5);
        }
    }
}

/// A bent guide that slides in a straight hole rubs without weight and without tension: F = EI kf/l at the bit, at the wall
/// l = sqrt(6 c/kf) behind it, and the same at the upper end. It costs 4 mu F in either sense. Tolerance 2 %: the contact
/// lies between points 20 mm apart, and F falls with 1/l.
#[test]
fn analytic_guide_bent_straight_rubs_without_tension() {
    for (free_curvature, gap) in [(0.29, 0.008), (0.15, 0.004)] {
        let tool = Guide {
            free_curvature,
            gap,
            weight_per_metre: 0.0,
            // The tension of a larger friction straightens the guide between its contacts: T l^2/EI = 4 mu kf l is 0.002 here.
            wall_friction: 0.005,
            wall_stiffness: 5e10,
            ..guide(SOFT)
        };
        let length = (6.0 * gap / free_curvature).sqrt();
        let drag = 4.0 * tool.wall_friction * tool.bending_stiffness * free_curvature / length;
        for (name, sense) in [("out", Sense::Out), ("in", Sense::In)] {
            let hole = Hole::begin(0.0, 0.0).unwrap().straight(6.0, 0.02).unwrap();
            let found = sliding(&tool, 0.0, &hole, sense).unwrap().top_tension();
            let quantity = format!("made with {free_curvature} 1/m, {name} (N)");
            figure(&quantity, sense.sign() * drag, found, 0.02);
        }
    }
}

/// A soft guide in an arc is a rope, e^(mu theta) with both signs: pulled out, its tension grows by it from the bit up;
/// run in under tension, it falls; pushed in, the push at the upper end is larger by it. Tolerance 0.5 %: its ends on the
/// axis stand off the wall by the gap, and their pull across is that of a kink of 0.5 mm in 0.16 m.
#[test]
fn analytic_soft_guide_in_an_arc_is_a_rope() {
    let rope = Guide {
        bending_stiffness: 500.0,
        free_curvature: ARC,
        weight_per_metre: 0.0,
        gap: 0.0005,
        length: FRAC_PI_2 / ARC,
        ..guide(SOFT)
    };
    let turn = rope.wall_friction * FRAC_PI_2;
    let hole = arc(90.0, 0.02);
    for (name, at_bit, sense, expected) in [
        ("out, 20 kN at the bit (N)", 20e3, Sense::Out, 20e3 * turn.exp()),
        ("in, 20 kN at the bit (N)", 20e3, Sense::In, 20e3 * (-turn).exp()),
        ("in, pushed by 0.5 kN (N)", -500.0, Sense::In, -500.0 * turn.exp()),
    ] {
        let found = sliding(&rope, at_bit, &hole, sense).unwrap().top_tension();
        figure(name, expected, found, 5e-3);
    }
}
