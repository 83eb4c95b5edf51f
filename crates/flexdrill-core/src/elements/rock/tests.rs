//! The rock's laws: derivatives, and the vibration that regeneration excites.

use std::f64::consts::TAU;

use super::*;

const CUT: DepthOfCut = DepthOfCut {
    blades: 3,
    specific_energy: 30e6,
    cutter_inclination: 0.6,
    wear_flat_force: 8e3,
    wear_flat_friction: 0.1,
    wear_flat_travel: 1e-4,
    weakening: Weakening { ratio: 1.8, rate: 4.0 },
};

/// Paths of a bit that vibrates while it drills.
fn wavy() -> Groove {
    let mut groove = Groove::new(CUT.blades);
    groove.begin(0.0, 0.0);
    for step in 1..=40_000 {
        let angle = 5e-4 * f64::from(step);
        let depth = 2e-4 * angle + 1e-5 * (7.0 * angle).sin();
        groove.record(angle, depth, depth - 2e-4);
    }
    groove
}

#[test]
fn torque_and_weight_have_the_derivatives_that_the_tangent_uses() {
    let groove = wavy();
    let law = RockLaw::DepthOfCut(CUT);
    let at = |angle: f64, speed: f64, depth: f64| {
        let mut load = BitLoad::new(&law);
        load.restore(Some(&groove));
        let bit = BitAt {
            radius: 0.059,
            slip_rate: 0.1,
            given: [0.0; 2],
            angle,
            speed,
            depth,
        };
        load.evaluate(&law, &bit);
        load
    };
    // Deep enough to cut; flats that bear in part, fully, and not at all; fast, slow and backward.
    for (depth, speed) in [(3.95e-3, 4.0), (4.2e-3, 0.02), (3.7e-3, -3.0), (4.0e-3, 0.3)] {
        let (angle, h) = (20.0003, 1e-8);
        let load = at(angle, speed, depth);
        let slope = |up: BitLoad, down: BitLoad| {
            [
                (up.torque - down.torque) / (2.0 * h),
                (up.weight - down.weight) / (2.0 * h),
            ]
        };
        let by_depth = slope(at(angle, speed, depth + h), at(angle, speed, depth - h));
        let by_angle = slope(at(angle + h, speed, depth), at(angle - h, speed, depth));
        let by_speed = slope(at(angle, speed + h, depth), at(angle, speed - h, depth));
        // Central differences of numbers up to 1e4 in steps of 1e-8: 1e-4 of rounding, and the same of curvature.
        let close = |a: f64, b: f64| (a - b).abs() < 1e-3 * (1.0 + b.abs());
        assert!(
            close(by_depth[0], load.torque_by[0]) && close(by_depth[1], load.weight_by[0]),
            "{by_depth:?}"
        );
        assert!(
            close(by_angle[0], load.torque_by[1]) && close(by_angle[1], load.weight_by[1]),
            "{by_angle:?}"
        );
        assert!(
            close(by_speed[0], load.slope) && close(by_speed[1], 0.0),
            "{by_speed:?} {}",
            load.slope
        );
    }
}

#[test]
fn weakening_is_what_its_formula_says() {
    let falls = Weakening { ratio: 2.0, rate: 5.0 };
    assert_eq!(falls.at(0.0).0, 2.0);
    let (at, slope) = falls.at(-5.0);
    assert!((at - (1.0 + (-1.0_f64).exp())).abs() < 1e-15);
    assert!((slope - (-1.0_f64).exp() / 5.0).abs() < 1e-15);
}

/// Growth (1/s) of the axial vibration of 50 kg on 1e6 N/m with 5 % of critical damping, under one blade that turns
/// steadily with a period of 32.092 ms and a cutting stiffness (N/m).
fn growth(cutting: f64) -> f64 {
    let (mass, stiffness, ratio, period) = (50.0, 1e6, 0.05, 32.092e-3);
    let damping = 2.0 * ratio * f64::sqrt(stiffness * mass);
    let (radius, speed, advance) = (0.059, TAU / period, 3e-3);
    let law = DepthOfCut {
        blades: 1,
        specific_energy: cutting / radius,
        cutter_inclination: 1.0,
        wear_flat_force: 0.0,
        wear_flat_friction: 0.0,
        wear_flat_travel: 1e-4,
        weakening: Weakening::NONE,
    };
    let mut groove = Groove::new(1);
    let h = 2e-5;
    groove.begin(-4000.0 * speed * h, -4000.0 * advance * h);
    let (mut x, mut v, mut time): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let steady = cutting * advance * period;
    // Begins on the path that it would leave for ever, but for a small push.
    for step in -4000..=0 {
        let at = h * f64::from(step);
        groove.record(speed * at, advance * at, 0.0);
    }
    v += 1e-5;
    let force = |x: f64, v: f64, time: f64, groove: &Groove| {
        let answer = law.answer(radius, advance * time + x, speed * time, groove);
        (steady - answer.weight - damping * v - stiffness * x) / mass
    };
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    let mut last = [0.0_f64; 2];
    while time < 6.0 {
        // Heun's method: its own damping is (omega h)^3 / 8, 3e-9 per step.
        let a0 = force(x, v, time, &groove);
        let (xp, vp) = (x + h * v, v + h * a0);
        let a1 = force(xp, vp, time + h, &groove);
        (x, v) = (x + 0.5 * h * (v + vp), v + 0.5 * h * (a0 + a1));
        time += h;
        groove.record(speed * time, advance * time + x, 0.0);
        if last[1] > last[0] && last[1] > x && time > 2.5 {
            peaks.push((time, last[1].ln()));
        }
        last = [last[1], x];
    }
    // Slope of the logarithm of the peaks.
    let count = peaks.len() as f64;
    let mean = peaks
        .iter()
        .fold([0.0; 2], |sum, peak| [sum[0] + peak.0 / count, sum[1] + peak.1 / count]);
    let (mut up, mut down) = (0.0, 0.0);
    for (time, level) in &peaks {
        up += (time - mean[0]) * (level - mean[1]);
        down += (time - mean[0]).powi(2);
    }
    up / down
}

/// Unstable from K = 2 k zeta (1 + zeta) = 1.05e5 N/m at the worst delay; growth -0.5611, 0 and 0.5372 1/s at 0.9, 1
/// and 1.1 K by the characteristic equation m s^2 + c s + k + K (1 - e^(-s t_n)) = 0.
#[test]
fn regeneration_excites_above_the_critical_cutting_stiffness() {
    let critical = 1.05e5;
    for (factor, expected) in [(0.9, -0.5611), (1.0, 0.0), (1.1, 0.5372)] {
        let got = growth(factor * critical);
        // The grid's straight pieces damp by (omega t_n / 1024)^2 / 8 of the delayed part; other roots have decayed
        // before the first peak that counts.
        assert!(
            (got - expected).abs() < 0.01,
            "{got} 1/s at {factor} K instead of {expected}"
        );
    }
}
