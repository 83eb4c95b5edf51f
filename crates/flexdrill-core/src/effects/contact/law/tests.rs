//! Tests of the gap laws.

use super::*;
use nalgebra::{SMatrix, Vector2};

fn law() -> GapLaw {
    GapLaw {
        surface: GapDescription {
            friction_axial: 0.15,
            ..GapDescription::new(1e7, 0.2)
        },
        slip_speed: 0.01,
        bristle_stiffness: 8e6,
    }
}

fn touch(law: &GapLaw, lateral: [f64; 2], clearance: f64, velocity: &[f64; 6]) -> Touch {
    let mut touch = law.press(lateral, clearance, velocity);
    let sliding = Sliding::of(&touch, velocity);
    match law.surface.friction_law {
        FrictionLaw::Separate => separate::rub(law, &mut touch, sliding, 1.0),
        FrictionLaw::Vector => vector::rub(law, &mut touch, sliding, 1.0),
        FrictionLaw::Bristle => unreachable!("bristles are tested over layers"),
    }
    touch
}

/// Holds the tangent at a contact to differences of the force `at` it, by lateral displacement and motion.
fn check_tangent(touch: &Touch, motion: &GapVector, at: impl Fn(Vector2<f64>, &GapVector) -> Touch) {
    let lateral = Vector2::new(-6.1e-3, 6.2e-3);
    let force = |d: Vector2<f64>, v: &GapVector| GapVector::from_column_slice(&at(d, v).force());
    let [y, z] = touch.direction;
    let pushed = GapVector::from_column_slice(&[0.0, -y, -z, 0.0, 0.0, 0.0]) * touch.normal;
    let friction = GapVector::from_column_slice(&touch.friction_force());
    assert!((force(lateral, motion) - pushed - friction).norm() < 1e-12 * touch.normal);
    let derivative = |stiffness: f64, damping: f64| {
        let terms = touch
            .tangent(stiffness, damping)
            .terms()
            .map(|term| term.on * term.by.transpose());
        -terms.iter().fold(SMatrix::<f64, 6, 6>::zeros(), |sum, term| sum + term)
    };
    let (by_displacement, by_velocity) = (derivative(1.0, 0.0), derivative(0.0, 1.0));
    // Central differences with steps of 1e-5 of each motion's scale: relative error well below 1e-6.
    for c in 0..2 {
        let mut h = Vector2::zeros();
        h[c] = 1e-9;
        let difference = (force(lateral + h, motion) - force(lateral - h, motion)) / 2e-9;
        let column = by_displacement.column(1 + c);
        assert!(
            (column - difference).norm() < 1e-6 * column.norm(),
            "{column} {difference}"
        );
    }
    for c in 0..6 {
        let mut h = GapVector::zeros();
        h[c] = 1e-7;
        let difference = (force(lateral, &(motion + h)) - force(lateral, &(motion - h))) / 2e-7;
        let column = by_velocity.column(c);
        assert!(
            (column - difference).norm() < 1e-6 * column.norm().max(1.0),
            "{c} {column} {difference}"
        );
    }
}

#[test]
fn tangents_are_those_of_differences() {
    let clearance = 8.5e-3;
    for friction_law in [FrictionLaw::Separate, FrictionLaw::Vector] {
        for (around, slip_speed) in [(0.13, 0.01), (-0.01, 0.01), (0.003, 1e-3)] {
            let mut law = law();
            (law.surface.friction_law, law.slip_speed) = (friction_law, slip_speed);
            let motion = GapVector::from_column_slice(&[0.004, 0.05, -0.12, around, -0.02, 0.03]);
            let at = |d: Vector2<f64>, v: &GapVector| touch(&law, [d.x, d.y], clearance, &(*v).into());
            check_tangent(&at(Vector2::new(-6.1e-3, 6.2e-3), &motion), &motion, at);
        }
    }
}

#[test]
fn tangents_of_bristles_are_those_of_differences() {
    use crate::simd::vector::{Portable, Vector};
    let clearance = 8.5e-3;
    let mut law = law();
    law.surface.friction_law = FrictionLaw::Bristle;
    let still = GapVector::zeros();
    let lanes = |x: &GapVector| {
        let mut lanes = [0.0; 8];
        lanes[..6].copy_from_slice(x.as_slice());
        Portable::load(&lanes)
    };
    let at = |d: Vector2<f64>, travel: &GapVector| {
        let mut layer = LayerContacts::new(5);
        layer.begin([[0.0; 2], [0.0; 2], [0.0; 2], [30.0, -20.0]].into_iter(), 5e-4);
        layer.set_travel(lanes(travel));
        layer.push::<Portable>(&law, 3, [d.x, d.y], clearance, lanes(&still));
        layer.finish::<Portable>(&law);
        layer.get(3).unwrap()
    };
    let lateral = Vector2::new(-6.1e-3, 6.2e-3);
    // A micrometre sticks, thirty slip: the contact is under 2 kN, its bristle has 8e6 N/m.
    for (travel, sticks) in [(1e-6, true), (6e-5, false)] {
        let motion = GapVector::from_column_slice(&[0.4, 0.5, -1.2, 1.3, -0.2, 0.3]) * travel;
        let touch = at(lateral, &motion);
        let slope = touch.normal * touch.slip[0].slope;
        assert_eq!((slope / 8e6 - 1.0).abs() < 1e-12, sticks, "{slope}");
        // A displacement within the step moves the contact and adds to its travel.
        let force = |by: &GapVector| {
            let moved = Vector2::new(lateral.x + by[1], lateral.y + by[2]);
            GapVector::from_column_slice(&at(moved, &(motion + by)).force())
        };
        let terms = touch
            .tangent(1.0, 0.0)
            .terms()
            .map(|term| term.on * term.by.transpose());
        let tangent = -terms.iter().fold(SMatrix::<f64, 6, 6>::zeros(), |sum, term| sum + term);
        for c in 0..6 {
            let mut h = GapVector::zeros();
            h[c] = 1e-9;
            let difference = (force(&h) - force(&-h)) / 2e-9;
            let column = tangent.column(c);
            // Forces of 2 kN round to 1e-4 N/m over steps of 1e-9 m; the ellipse curves by h k_t / F = 4e-6.
            assert!(
                (column - difference).norm() < 1e-5 * column.norm().max(1e6),
                "{c} {column} {difference}"
            );
        }
    }
}

/// A capstan whose rope also turns about its axis: with the speeds v along and u around the force grows by e^(mu
/// theta v / sqrt(v^2 + u^2)), and the torque is r u / sqrt(v^2 + u^2) times the friction. The published value
/// without rotation is e^(0.3 pi / 2) = 1.602; a pipe of 63 mm at 40 r/min and 10 mm/s keeps 7.557 % of the
/// exponent. Tolerance 0.1 %: the regularisation of 0.1 mm/s takes 5e-5 of the friction, and 1000 steps along the
/// arc 1e-8.
#[test]
fn val_capstan_with_rotation() {
    let mut law = law();
    law.surface = GapDescription {
        friction_law: FrictionLaw::Vector,
        ..GapDescription::new(1e7, 0.3)
    };
    law.slip_speed = 1e-4;
    let steps = 1000;
    let turn = std::f64::consts::FRAC_PI_2 / f64::from(steps);
    for (v, u, published) in [(0.01, 0.0, 1.602), (0.01, 0.131_95, 1.0363), (0.01, 0.01, 1.3955)] {
        let (mut force, mut along, mut around) = (1.0, 0.0, 0.0);
        for _ in 0..steps {
            // The wall carries force times turn; friction is proportional to it.
            let touch = touch(&law, [9e-3, 0.0], 8.5e-3, &[v, 0.0, 0.0, u, 0.0, 0.0]);
            let (a, t) = (-touch.axial / touch.normal, -touch.tangential / touch.normal);
            let mean = force / (1.0 - 0.5 * a * turn);
            along += a * turn * mean;
            around += t * turn * mean;
            force += a * turn * mean;
        }
        let expected = (0.3 * std::f64::consts::FRAC_PI_2 * v / v.hypot(u)).exp();
        crate::support::figure(&format!("v {v} m/s, u {u} m/s (-)"), published, force, 1e-3);
        assert!((force / expected - 1.0).abs() < 1e-3, "{force} against {expected}");
        assert!(
            (around - along * u / v).abs() < 1e-9 * along.max(around),
            "{around}, {along}"
        );
    }
}

#[test]
fn friction_takes_power_and_stays_below_coulombs() {
    let mut random = crate::support::Random(3);
    let mut next = || random.next();
    for _ in 0..20_000 {
        let mut law = law();
        law.surface.friction_law = FrictionLaw::Vector;
        [law.surface.friction_tangential, law.surface.friction_axial] = [next().abs(), next().max(0.0)];
        law.slip_speed = 0.1 * next().abs() + 1e-6;
        let angle = 3.0 * next();
        let lateral = [9e-3 * angle.cos(), 9e-3 * angle.sin()];
        let velocity = std::array::from_fn(|_| next() * next() * next());
        let touch = touch(&law, lateral, 8.5e-3, &velocity);
        let [mu_around, mu_along] = law.friction(1.0);
        let part = |force: f64, mu: f64| if mu > 0.0 { force / mu } else { force };
        let size = part(touch.tangential, mu_around).hypot(part(touch.axial, mu_along));
        assert!(
            touch.friction_power >= 0.0 && size <= touch.normal * (1.0 + 1e-12),
            "{touch:?}"
        );
    }
}

/// A pipe that turns at 40 r/min in the guide (63 mm: 0.13195 m/s around) and moves down: friction along the axis over all
/// friction, s_x / |s|, at 10 mm/s and at 3 m/h. Tolerance: half of the last of five decimals.
#[test]
fn analytic_friction_along_a_turning_pipe() {
    let mut law = law();
    law.surface = GapDescription {
        friction_law: FrictionLaw::Vector,
        ..GapDescription::new(1e7, 0.2)
    };
    // Far below all speeds here, so that what the regularisation leaves out is below 1e-8.
    law.slip_speed = 1e-7;
    for (along, share) in [(0.010, 0.075_57), (3.0 / 3600.0, 0.006_32)] {
        let velocity = [along, 0.0, 0.0, 0.131_95, 0.0, 0.0];
        let touch = touch(&law, [9e-3, 0.0], 8.5e-3, &velocity);
        let got = -touch.axial / (0.2 * touch.normal);
        crate::support::scaled_figure(&format!("at {:.2} mm/s (-)", 1e3 * along), share, got, 1.0, 6e-6);
    }
}

/// A layer with a factor at a station has the friction of one whose coefficients are larger by it: force, tangent and the
/// memory of a slide that turns within a step, to the bit. Its other stations keep their friction.
#[test]
fn a_factor_acts_as_larger_coefficients() {
    use crate::simd::vector::{Portable, Vector};
    let lanes = |x: [f64; 6]| {
        let mut lanes = [0.0; 8];
        lanes[..6].copy_from_slice(&x);
        Portable::load(&lanes)
    };
    for friction_law in [FrictionLaw::Separate, FrictionLaw::Vector, FrictionLaw::Bristle] {
        let mut own = law();
        own.surface.friction_law = friction_law;
        let mut larger = own;
        larger.surface.friction_tangential *= 1.7;
        larger.surface.friction_axial *= 1.7;
        // Nine stations fill one group of lanes and begin another; every third has the factor.
        let factors: Vec<f64> = (0..9).map(|s| if s % 3 == 1 { 1.7 } else { 1.0 }).collect();
        let mut layers = [
            LayerContacts::with_friction_factors(factors),
            LayerContacts::new(9),
            LayerContacts::new(9),
        ];
        let held = || (0..9).map(|s| [20.0 * f64::from(s), -15.0]);
        layers.iter_mut().for_each(|layer| layer.begin(held(), 5e-4));
        for around in [0.1, -0.1, 0.003] {
            for (layer, law) in layers.iter_mut().zip([&own, &own, &larger]) {
                layer.clear();
                for s in 0..9 {
                    let lateral = [-6.1e-3, 6.2e-3 + 1e-5 * s as f64];
                    let motion = [0.004, 0.05, -0.12, around, -0.02, 0.03];
                    if law.has_bristles() {
                        layer.set_travel(lanes(motion.map(|x| 1e-3 * x)));
                    }
                    layer.push::<Portable>(law, s, lateral, 8.5e-3, lanes(motion));
                }
                layer.finish::<Portable>(law);
            }
            for s in 0..9 {
                let seen = |layer: &LayerContacts| format!("{:?}", layer.get(s).unwrap());
                let expected = if s % 3 == 1 { &layers[2] } else { &layers[1] };
                assert_eq!(
                    seen(&layers[0]),
                    seen(expected),
                    "{friction_law:?}, station {s}, {around}"
                );
            }
            assert_ne!(
                layers[1].get(1).unwrap().force(),
                layers[2].get(1).unwrap().force(),
                "{friction_law:?}"
            );
        }
    }
}

#[test]
fn nothing_pulls_and_nothing_jumps_at_onset() {
    let clearance = 8.5e-3;
    for speed in [-10.0, -1.0, 0.0, 1.0, 10.0] {
        let velocity = [0.0, 0.0, speed, 0.0, 0.0, 0.0];
        let touch = touch(&law(), [0.0, clearance + 1e-12], clearance, &velocity);
        assert!(touch.normal >= 0.0 && touch.normal < 1e-4);
    }
}
