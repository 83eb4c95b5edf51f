//! The steady hole by other equations: an inextensible elastica with large rotations in a circular hole.
//!
//! The hole's axis is a circle of radius R = 1/kb about the origin, and its outer wall, the low side, has the radius R + c
//! for the guide's axis. From the bit at (R, 0) up, with the tangent d = (-sin a, cos a) down the hole, n the force of the
//! lower part on the upper, and q outwards:
//!
//! ```text
//! a' = -kappa,   x' = -d,   n' = q e_r,   M' = d x n,   kappa = kf + M/EI;   n = (-F, -W), M = 0, a = -t at the bit
//! ```
//!
//! With the spine of the guide e off its axis towards the low side, M/EI has the couple e N of the tension N = n . d in
//! addition, and the axis becomes shorter by e times what the guide is more curved than the hole: rates are per length of the
//! axis that is there in the hole without a bend, and x' = -(1 + e (kb - kappa)) d.
//!
//! Unknown are t, F, the free length l, and kb; at l the guide is on the wall, along it, and as curved as it; and the bit
//! drills along its tangent. Nothing is linear here, and nothing is taken from the crate but the description of the guide.

use flexdrill_hole::{BitLaw, Guide, Steady};
use nalgebra::{Matrix4, Vector2, Vector4};

const STEPS: usize = 400;

/// a, x, y, n_x, n_y, M.
type State = [f64; 6];

/// Curvature where the guide was made with one (1/m).
fn curvature(guide: &Guide, made: f64, [a, .., nx, ny, moment]: State) -> f64 {
    let (sine, cosine) = a.sin_cos();
    let thrust = sine * nx - cosine * ny;
    let e = guide.spine.map_or(0.0, |spine| spine.offset);
    made + (moment + e * thrust) / guide.bending_stiffness
}

/// Rates where the guide was made with a curvature, in a hole of another one (1/m).
fn rates(guide: &Guide, hole: f64, made: f64, state: State) -> State {
    let [a, x, y, nx, ny, _] = state;
    let (sine, cosine) = a.sin_cos();
    let radius = x.hypot(y);
    let kappa = curvature(guide, made, state);
    let stretch = guide.spine.map_or(1.0, |spine| 1.0 + spine.offset * (hole - kappa));
    let q = guide.weight_per_metre;
    [
        -kappa,
        stretch * sine,
        -stretch * cosine,
        q * x / radius,
        q * y / radius,
        stretch * (-sine * ny - cosine * nx),
    ]
}

fn misfit(guide: &Guide, law: &BitLaw, unknown: Vector4<f64>) -> Vector4<f64> {
    let [tilt, force, length, hole] = [unknown.x, unknown.y, unknown.z, unknown.w];
    let radius = 1.0 / hole;
    let mut state = [-tilt, radius, 0.0, -force, -law.weight, 0.0];
    // Each piece of the guide has its own steps, so that its curvature is constant within one.
    let mut made = guide.free_curvature;
    let mut from = 0.0;
    let changes = guide.bends.changes().iter().filter(|change| change.from < length);
    let ends = changes
        .map(|change| (change.from, change.curvature))
        .chain([(length, f64::NAN)]);
    for (to, next) in ends {
        let h = (to - from) / STEPS as f64;
        for _ in 0..STEPS {
            let shifted =
                |rate: State, share: f64| -> State { std::array::from_fn(|i| state[i] + share * h * rate[i]) };
            let first = rates(guide, hole, made, state);
            let second = rates(guide, hole, made, shifted(first, 0.5));
            let third = rates(guide, hole, made, shifted(second, 0.5));
            let fourth = rates(guide, hole, made, shifted(third, 1.0));
            state = std::array::from_fn(|i| state[i] + h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]));
        }
        from = to;
        if to < length {
            made = next;
        }
    }
    let [a, x, y, ..] = state;
    let stretch = guide
        .spine
        .map_or(1.0, |spine| 1.0 + spine.offset * (hole - curvature(guide, made, state)));
    let (sine, cosine) = a.sin_cos();
    Vector4::new(
        x.hypot(y) - radius - guide.gap,
        (-sine * x + cosine * y) / x.hypot(y),
        curvature(guide, made, state) / stretch - 1.0 / (radius + guide.gap),
        law.turn(Vector2::new(0.0, tilt), Vector2::new(0.0, force)).y,
    )
}

/// kb (1/m), F (N), t (rad) and l (m) of the steady hole, found from the closed form on by Newton's method.
pub fn steady(guide: &Guide, law: &BitLaw, start: Steady) -> (f64, f64, f64, f64) {
    let scale = [1e-2, 1e3, 1.0, 0.1];
    let tilt = -0.01;
    let force = -(law.steering_resistance() - law.weight) * tilt;
    let mut unknown = Vector4::new(tilt, force, start.free_length, start.curvature);
    for _ in 0..50 {
        let now = misfit(guide, law, unknown);
        let jacobian = Matrix4::from_fn(|row, column| {
            let mut moved = unknown;
            moved[column] += 1e-6 * scale[column];
            (misfit(guide, law, moved)[row] - now[row]) / (1e-6 * scale[column])
        });
        let step = jacobian.lu().solve(&now).unwrap();
        // Half of the first steps, since the start has no more than the closed form's accuracy.
        unknown -= step * 0.7;
        if step.component_div(&Vector4::from(scale)).amax() < 1e-10 {
            break;
        }
    }
    assert!(misfit(guide, law, unknown).amax() < 1e-9, "no steady elastica");
    (unknown.w, unknown.y, unknown.x, unknown.z)
}
