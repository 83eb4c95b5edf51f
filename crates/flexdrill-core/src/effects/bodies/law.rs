//! A rigid body on a node: mass, rotary inertia, and a centre of mass that may lie off the axis.
//!
//! With the spin psi, the tilts phi, and theta = psi + phase, seen from the axis the centre of mass is at
//!
//! ```text
//! r = e (phi_y sin theta - phi_z cos theta, cos theta, sin theta)
//! ```
//!
//! to first order in the tilts, and the body spins about its tilted axis at
//!
//! ```text
//! Omega = psi' + (phi_z phi_y' - phi_y phi_z') / 2
//! ```
//!
//! to second. The forces follow by Lagrange's equations from T = m |u' + r'|^2 / 2 + J_p Omega^2 / 2 + J_t (phi_y'^2 +
//! phi_z'^2) / 2, so that their work is exactly the gain of T: on the node the unbalance m e psi'^2 that turns with the
//! spin, on the tilts the gyroscopic moment J_p psi' phi'. Damping is alpha dT/dq' (Eq. 7), on the velocity of the
//! centre of mass.

use std::ops::{Add, Mul, Neg, Sub};

/// Three components along the node's axes.
type Axes<T> = [T; 3];
/// Six components of a node.
type Node<T> = [T; 6];

/// A rigid body of revolution, but for its eccentricity.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointBody {
    /// m (kg).
    pub mass: f64,
    /// J_p, about the axis (kg m2), of the body about its centre of mass.
    pub axial_inertia: f64,
    /// J_t, about a diameter (kg m2).
    pub transverse_inertia: f64,
    /// e, from the axis to the centre of mass (m).
    pub eccentricity: f64,
    /// Angle of the centre of mass from the node's y towards its z axis at spin zero (rad).
    pub phase: f64,
}

/// Motion of a node.
#[derive(Debug, Clone, Copy)]
pub struct NodeMotion<'a> {
    /// Displacements; the translations have no influence on the forces.
    pub q: &'a [f64],
    /// Velocities.
    pub v: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
}

/// A number with its derivative in one variable. The law is written once over it, and yields its exact tangent.
#[derive(Debug, Clone, Copy)]
struct Dual {
    value: f64,
    slope: f64,
}

impl PointBody {
    /// Masses and inertias of the node's six directions: the diagonal of M.
    pub fn diagonal(&self) -> Node<f64> {
        let (m, p, t) = (self.mass, self.axial_inertia, self.transverse_inertia);
        [m, m, m, p, t, t]
    }

    /// Whether the body has forces other than those of the diagonal.
    pub fn is_coupled(&self) -> bool {
        self.axial_inertia > 0.0 || self.mass * self.eccentricity > 0.0
    }

    /// Inertia, damping (with `alpha`, 1/s) and weight (with `gravity`, m/s2 along the node's axes) in the node's six
    /// directions (N, N m), without the parts that the diagonal accounts for.
    pub fn coupled_forces(&self, node: NodeMotion<'_>, alpha: f64, gravity: Axes<f64>) -> Node<f64> {
        self.law(node, alpha, gravity, None).map(|force| force.value)
    }

    /// Derivatives of [`PointBody::coupled_forces`], by columns, where displacement, velocity and acceleration of a
    /// direction change in proportion to the factors `[k, d, m]`.
    pub fn coupled_tangent(
        &self,
        node: NodeMotion<'_>,
        alpha: f64,
        gravity: Axes<f64>,
        factors: [f64; 3],
    ) -> [Node<f64>; 6] {
        std::array::from_fn(|column| {
            self.law(node, alpha, gravity, Some((column, factors)))
                .map(|force| force.slope)
        })
    }

    /// Offset r of the centre of mass from the axis (m).
    pub fn offset(&self, q: &[f64]) -> Axes<f64> {
        let [psi, y, z] = [q[3], q[4], q[5]].map(Dual::of);
        self.arm(psi, y, z)[0].map(|r| r.value)
    }

    /// T (J).
    pub fn kinetic_energy(&self, node: NodeMotion<'_>) -> f64 {
        let NodeMotion { q, v, .. } = node;
        let [_, turned, by_y, by_z] = self.arm(Dual::of(q[3]), Dual::of(q[4]), Dual::of(q[5]));
        let speed = |k: usize| v[k] + turned[k].value * v[3] + by_y[k].value * v[4] + by_z[k].value * v[5];
        let spin = v[3] + 0.5 * (q[5] * v[4] - q[4] * v[5]);
        let squares = (0..3).map(|k| speed(k) * speed(k)).sum::<f64>();
        let tilting = v[4] * v[4] + v[5] * v[5];
        0.5 * (self.mass * squares + self.axial_inertia * spin * spin + self.transverse_inertia * tilting)
    }

    /// The offset r and its derivatives in psi, phi_y and phi_z.
    fn arm(&self, psi: Dual, y: Dual, z: Dual) -> [Axes<Dual>; 4] {
        let (sin, cos) = (psi + Dual::of(self.phase)).sin_cos();
        let e = Dual::of(self.eccentricity);
        let (sin, cos, zero) = (e * sin, e * cos, Dual::of(0.0));
        [
            [y * sin - z * cos, cos, sin],
            [y * cos + z * sin, -sin, cos],
            [sin, zero, zero],
            [-cos, zero, zero],
        ]
    }

    /// The forces of Lagrange's equations without the diagonal's; `along` selects the direction that varies, with the
    /// factors on its displacement, velocity and acceleration.
    fn law(
        &self,
        node: NodeMotion<'_>,
        alpha: f64,
        gravity: Axes<f64>,
        along: Option<(usize, [f64; 3])>,
    ) -> Node<Dual> {
        let moving = |values: &[f64], factor: usize| -> Node<Dual> {
            std::array::from_fn(|k| Dual {
                value: values[k],
                slope: along.map_or(0.0, |(column, factors)| if column == k { factors[factor] } else { 0.0 }),
            })
        };
        let (q, v, a) = (moving(node.q, 0), moving(node.v, 1), moving(node.a, 2));
        let [psi, y, z] = [q[3], q[4], q[5]];
        let [r, turned, by_y, by_z] = self.arm(psi, y, z);
        let (two, half, alpha) = (Dual::of(2.0), Dual::of(0.5), Dual::of(alpha));

        // Velocity and acceleration of the centre of mass relative to the axis; d2 r / d psi2 is -r.
        let velocity: Axes<Dual> = std::array::from_fn(|k| turned[k] * v[3] + by_y[k] * v[4] + by_z[k] * v[5]);
        let mut acceleration: Axes<Dual> =
            std::array::from_fn(|k| turned[k] * a[3] + by_y[k] * a[4] + by_z[k] * a[5] - r[k] * v[3] * v[3]);
        // The mixed derivatives d2 r / d psi d phi have an axial component only.
        let [_, cos, sin] = r;
        acceleration[0] = acceleration[0] + two * v[3] * (cos * v[4] + sin * v[5]);
        let m = Dual::of(self.mass);
        let relative: Axes<Dual> = std::array::from_fn(|k| m * (acceleration[k] + alpha * velocity[k]));
        let whole: Axes<Dual> = std::array::from_fn(|k| relative[k] + m * (a[k] + alpha * v[k] - Dual::of(gravity[k])));
        let moment = |by: &Axes<Dual>| whole[0] * by[0] + whole[1] * by[1] + whole[2] * by[2];

        // d/dt (dT/d phi') and -dT/d phi contribute half of the gyroscopic moment each.
        let p = Dual::of(self.axial_inertia);
        let drift = half * (z * v[4] - y * v[5]);
        let spin = p * (v[3] + drift);
        let spun = p * (a[3] + half * (z * a[4] - y * a[5]) + alpha * (v[3] + drift));
        [
            relative[0],
            relative[1],
            relative[2],
            moment(&turned) + spun - p * (a[3] + alpha * v[3]),
            moment(&by_y) + spin * v[5] + half * spun * z,
            moment(&by_z) - spin * v[4] - half * spun * y,
        ]
    }
}

impl Dual {
    /// A constant.
    fn of(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = (libm::sin(self.value), libm::cos(self.value));
        let with = |value, slope: f64| Self {
            value,
            slope: slope * self.slope,
        };
        (with(sin, cos), with(cos, -sin))
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.value * other.slope + self.slope * other.value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: PointBody = PointBody {
        mass: 8.0,
        axial_inertia: 0.05,
        transverse_inertia: 0.03,
        eccentricity: 0.02,
        phase: 0.4,
    };
    const Q: [f64; 6] = [0.001, 0.002, -0.003, 0.7, 0.04, -0.06];
    const V: [f64; 6] = [0.1, -0.4, 0.3, 5.0, 0.7, -0.9];
    const A: [f64; 6] = [3.0, -7.0, 2.0, 40.0, 11.0, -13.0];
    const GRAVITY: [f64; 3] = [5.0, 1.0, 8.0];

    fn forces(body: &PointBody, q: &[f64; 6], v: &[f64; 6], a: &[f64; 6], alpha: f64, gravity: [f64; 3]) -> [f64; 6] {
        let mut out = body.coupled_forces(NodeMotion { q, v, a }, alpha, gravity);
        for (k, (out, inertia)) in out.iter_mut().zip(body.diagonal()).enumerate() {
            *out += inertia * (a[k] + alpha * v[k] - if k < 3 { gravity[k] } else { 0.0 });
        }
        out
    }

    #[test]
    fn the_tangent_is_that_of_differences() {
        let (alpha, factors, h) = (2.0, [1.0, 30.0, 700.0], 1e-6);
        let node = NodeMotion { q: &Q, v: &V, a: &A };
        let tangent = BODY.coupled_tangent(node, alpha, GRAVITY, factors);
        let largest = tangent.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (column, tangent) in tangent.iter().enumerate() {
            let moved = |by: f64| {
                let (mut q, mut v, mut a) = (Q, V, A);
                q[column] += by * factors[0];
                v[column] += by * factors[1];
                a[column] += by * factors[2];
                let node = NodeMotion { q: &q, v: &v, a: &a };
                BODY.coupled_forces(node, alpha, GRAVITY)
            };
            let (up, down) = (moved(h), moved(-h));
            for k in 0..6 {
                // Quadratic in the velocities, which move by 3e-5: 1e-8, and rounding of 1e-9.
                let difference = (up[k] - down[k]) / (2.0 * h);
                assert!(
                    (difference - tangent[k]).abs() < 1e-7 * largest,
                    "d F[{k}] / d q[{column}] = {} against {difference}",
                    tangent[k]
                );
            }
        }
    }

    #[test]
    fn inertia_takes_what_the_kinetic_energy_gains() {
        let power: f64 = forces(&BODY, &Q, &V, &A, 0.0, [0.0; 3])
            .iter()
            .zip(V)
            .map(|(force, v)| force * v)
            .sum();
        let h = 1e-5;
        let energy = |t: f64| {
            let q: [f64; 6] = std::array::from_fn(|k| Q[k] + t * V[k] + 0.5 * t * t * A[k]);
            let v: [f64; 6] = std::array::from_fn(|k| V[k] + t * A[k]);
            BODY.kinetic_energy(NodeMotion { q: &q, v: &v, a: &A })
        };
        let gained = (energy(h) - energy(-h)) / (2.0 * h);
        // Of differences at 1e-5 s, whose next term is h^2 times rates of 1e3 1/s2.
        assert!(
            (power - gained).abs() < 1e-7 * power.abs(),
            "{power} W against {gained} W"
        );
    }

    #[test]
    fn a_steady_spin_pulls_towards_the_centre_of_mass() {
        let v = [0.0, 0.0, 0.0, 5.0, 0.0, 0.0];
        let q = [0.0, 0.0, 0.0, 0.7, 0.0, 0.0];
        let force = forces(&BODY, &q, &v, &[0.0; 6], 0.0, [0.0; 3]);
        let expected = 8.0 * 0.02 * 25.0;
        // The inertia force opposes the pull: it points towards the axis.
        assert!((force[1] + expected * 1.1_f64.cos()).abs() < 1e-12);
        assert!((force[2] + expected * 1.1_f64.sin()).abs() < 1e-12);
    }

    #[test]
    fn a_pure_mass_has_its_diagonal_only() {
        let body = PointBody {
            axial_inertia: 0.0,
            eccentricity: 0.0,
            ..BODY
        };
        assert!(!body.is_coupled() && BODY.is_coupled());
        let node = NodeMotion { q: &Q, v: &V, a: &A };
        assert_eq!(body.coupled_forces(node, 2.0, GRAVITY), [0.0; 6]);
    }
}
