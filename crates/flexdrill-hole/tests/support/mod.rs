//! The paper's tool (`config/default.yaml`) for the tests.

#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "each test uses some of these helpers, which fail by panicking"
)]

use flexdrill_hole::{Advance, Bends, BitLaw, Gravity, Guide, Hole, Propagation};

/// EI of the paper's guide as a tube (N m2).
pub const TUBE: f64 = 6.8037e5;
/// Curvature of the paper's arc (1/m).
pub const ARC: f64 = 1.0 / 3.2;
/// Chords of the paper's tool in its arc: 125 (m).
pub const CHORD: f64 = 3.2 * std::f64::consts::FRAC_PI_2 / 125.0;
/// Bending factor of the guide that the tests call soft.
pub const SOFT: f64 = 0.05;

/// The paper's guide, made with the curvature of its arc, with a bending factor.
pub fn guide(factor: f64) -> Guide {
    Guide {
        length: 125.0 * CHORD,
        bending_stiffness: TUBE * factor,
        free_curvature: ARC,
        bends: Bends::default(),
        roll: 0.0,
        spine: None,
        weight_per_metre: 361.5,
        gravity: Gravity::Down,
        gap: 0.008,
        wall_friction: 0.3,
        wall_stiffness: 5e8,
        torque: 0.0,
    }
}

/// A vertical hole and an arc of the paper's radius to an inclination (deg).
pub fn arc(degrees: f64, chord: f64) -> Hole {
    let hole = Hole::begin(0.0, 0.0).unwrap().straight(5.2, chord).unwrap();
    hole.arc(3.2, degrees.to_radians(), chord).unwrap()
}

/// Drills from an arc of a curvature on.
pub fn drill(guide: Guide, law: BitLaw, curvature: f64, metres: f64) -> Vec<Advance> {
    let hole = Hole::begin(0.0, 0.0).unwrap();
    let hole = hole
        .arc(1.0 / curvature, (guide.length + 0.1) * curvature, CHORD)
        .unwrap();
    let (mut propagation, _) = Propagation::begin(guide, law, hole, CHORD).unwrap();
    propagation.drill(metres).unwrap()
}

/// Whether two numbers agree within a share of the second.
#[track_caller]
pub fn agree(name: &str, got: f64, wanted: f64, share: f64) {
    println!("{name}: {got:.6} ({wanted}), {:+.4} %", 100.0 * (got / wanted - 1.0));
    assert!(
        (got - wanted).abs() <= share * wanted.abs(),
        "{name}: {got}, expected {wanted}"
    );
}
