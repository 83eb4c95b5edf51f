//! Dynamic gap elements, Eq. 20 to 34: normal contact and friction between an inner and an outer round body.
//!
//! Local coordinates of a gap, in the station's frame (x down the hole, y horizontal, z low side), as the inner body's motion
//! relative to the outer's:
//!
//! | index | motion | conjugate force |
//! |---|---|---|
//! | 0 | axial displacement | axial friction |
//! | 1, 2 | lateral displacement y, z | normal and tangential force |
//! | 3 | r_in psi (inner body) - r_out psi (outer body): surface travel by spin | torque / radius |
//! | 4, 5 | the same for phi_y, phi_z: axial surface travel by tilt | bending couple / radius |
//!
//! The force is that of the gap on the inner body; the outer body gets the opposite through its own radius, so that the
//! torques and couples act on both, Eq. 25 and 26.

use nalgebra::{SMatrix, SVector, Vector2};

use super::description::GapDescription;

/// Local motion or force of a gap.
pub type GapVector = SVector<f64, 6>;
/// Derivative of the local force in the local motion.
pub type GapMatrix = SMatrix<f64, 6, 6>;

/// Law of one layer.
#[derive(Debug, Clone, Copy)]
pub struct GapLaw {
    /// Stiffness, damping, friction.
    pub surface: GapDescription,
    /// Regularisation speed of the friction (m/s).
    pub slip_speed: f64,
}

/// A touching gap.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// Normal force (N, >= 0).
    pub normal: f64,
    /// Tangential friction on the inner body, positive in the sense of positive spin (N).
    pub tangential: f64,
    /// Axial friction on the inner body, downhole positive (N).
    pub axial: f64,
    /// Force of the gap on the inner body, normal part.
    pub normal_force: GapVector,
    /// Force of the gap on the inner body, friction part.
    pub friction_force: GapVector,
    /// d force / d local displacement.
    pub by_displacement: GapMatrix,
    /// d force / d local velocity.
    pub by_velocity: GapMatrix,
    /// Energy in the contact spring (J).
    pub energy: f64,
    /// Power taken by the normal damping (W).
    pub dissipation: f64,
}

/// Gap left (m, negative is penetration) at lateral displacement (y, z) in clearance `clearance`, Eq. 27 and 31.
pub fn gap(lateral: Vector2<f64>, clearance: f64) -> f64 {
    clearance - lateral.norm()
}

impl GapLaw {
    /// The contact at lateral displacement `lateral` (y, z; offsets included) and local velocity `velocity`, or `None` while
    /// the gap is open.
    ///
    /// Normal force F = k d (1 + c d') >= 0 with penetration d: continuous at onset, never pulling. Friction mu F v / sqrt(v^2 + v_s^2)
    /// separately around and along (Eq. 25).
    pub fn touch(&self, lateral: Vector2<f64>, clearance: f64, velocity: &GapVector) -> Option<Touch> {
        let distance = lateral.norm();
        let depth = distance - clearance;
        if depth <= 0.0 {
            return None;
        }
        let k = self.surface.stiffness;
        let n = lateral / distance;
        let t = Vector2::new(-n.y, n.x);
        let lateral_velocity = Vector2::new(velocity[1], velocity[2]);
        let closing = n.dot(&lateral_velocity);
        let swinging = t.dot(&lateral_velocity) / distance;
        let viscous = (1.0 + self.surface.damping * closing).max(0.0);
        let mut touch = Touch {
            normal: k * depth * viscous,
            tangential: 0.0,
            axial: 0.0,
            normal_force: GapVector::zeros(),
            friction_force: GapVector::zeros(),
            by_displacement: GapMatrix::zeros(),
            by_velocity: GapMatrix::zeros(),
            energy: 0.5 * k * depth * depth,
            dissipation: 0.0,
        };
        if viscous == 0.0 {
            // Leaving faster than the law can push: no force, but the spring's energy is lost to its damping.
            touch.dissipation = -k * depth * closing;
            return Some(touch);
        }
        let normal = touch.normal;
        let by_rate = k * depth * self.surface.damping;
        touch.dissipation = by_rate * closing * closing;
        // Derivatives of the normal force in the lateral displacement and velocity.
        let normal_d = n * (k * viscous) + t * (by_rate * swinging);
        let normal_v = n * by_rate;

        // Sliding speeds at the contact point, Eq. 23, and their derivatives.
        let around = t.dot(&lateral_velocity) + velocity[3];
        let along = velocity[0] + velocity[4] * n.y - velocity[5] * n.x;
        let around_d = t * (-closing / distance);
        let along_d = t * ((velocity[4] * t.y - velocity[5] * t.x) / distance);
        let (mu_t, mu_a) = (self.surface.friction_tangential, self.surface.friction_axial);
        let (share_t, slope_t) = self.regularised(around);
        let (share_a, slope_a) = self.regularised(along);
        let (f_t, f_a) = (mu_t * normal * share_t, mu_a * normal * share_a);
        touch.tangential = -f_t;
        touch.axial = -f_a;
        touch.normal_force.fixed_rows_mut::<2>(1).copy_from(&(-n * normal));
        touch.friction_force[0] = -f_a;
        touch.friction_force.fixed_rows_mut::<2>(1).copy_from(&(-t * f_t));
        touch.friction_force[3] = -f_t;
        touch.friction_force[4] = -f_a * n.y;
        touch.friction_force[5] = f_a * n.x;

        // Gradients of the two friction forces in (displacement, velocity).
        let f_t_d = normal_d * (mu_t * share_t) + around_d * (mu_t * normal * slope_t);
        let f_a_d = normal_d * (mu_a * share_a) + along_d * (mu_a * normal * slope_a);
        let around_v = GapVector::from_column_slice(&[0.0, t.x, t.y, 1.0, 0.0, 0.0]);
        let along_v = GapVector::from_column_slice(&[1.0, 0.0, 0.0, 0.0, n.y, -n.x]);
        let normal_v6 = GapVector::from_column_slice(&[0.0, normal_v.x, normal_v.y, 0.0, 0.0, 0.0]);
        let f_t_v = normal_v6 * (mu_t * share_t) + around_v * (mu_t * normal * slope_t);
        let f_a_v = normal_v6 * (mu_a * share_a) + along_v * (mu_a * normal * slope_a);

        // The directions turn with the displacement: dn = t (t.dd)/distance, dt = -n (t.dd)/distance.
        let turn = t / distance;
        for c in 0..2 {
            let (nd, td, ad, dt) = (normal_d[c], f_t_d[c], f_a_d[c], turn[c]);
            let column = [
                -ad,
                -(n.x * nd + t.x * dt * normal + t.x * td - n.x * dt * f_t),
                -(n.y * nd + t.y * dt * normal + t.y * td - n.y * dt * f_t),
                -td,
                -(ad * n.y + f_a * t.y * dt),
                ad * n.x + f_a * t.x * dt,
            ];
            touch.by_displacement.column_mut(1 + c).copy_from_slice(&column);
        }
        for c in 0..6 {
            let (nv, tv, av) = (normal_v6[c], f_t_v[c], f_a_v[c]);
            let column = [
                -av,
                -(n.x * nv + t.x * tv),
                -(n.y * nv + t.y * tv),
                -tv,
                -av * n.y,
                av * n.x,
            ];
            touch.by_velocity.column_mut(c).copy_from_slice(&column);
        }
        Some(touch)
    }

    /// v / sqrt(v^2 + v_s^2) and its derivative.
    fn regularised(&self, speed: f64) -> (f64, f64) {
        regularised_sign(speed, self.slip_speed)
    }
}

/// Smooth sign of `speed` with width `width`, and its derivative.
pub fn regularised_sign(speed: f64, width: f64) -> (f64, f64) {
    let root = speed.hypot(width);
    (speed / root, width * width / (root * root * root))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> GapLaw {
        GapLaw {
            surface: GapDescription {
                stiffness: 1e7,
                damping: 0.5,
                friction_tangential: 0.2,
                friction_axial: 0.15,
            },
            slip_speed: 0.01,
        }
    }

    #[test]
    fn tangents_are_those_of_differences() {
        let clearance = 8.5e-3;
        let lateral = Vector2::new(-6.1e-3, 6.2e-3);
        let velocity = GapVector::from_column_slice(&[0.004, 0.05, -0.12, 0.13, -0.02, 0.03]);
        let touch = law().touch(lateral, clearance, &velocity).unwrap();
        let force = |d: Vector2<f64>, v: &GapVector| {
            let t = law().touch(d, clearance, v).unwrap();
            t.normal_force + t.friction_force
        };
        // Central differences with steps of 1e-5 of each motion's scale: relative error well below 1e-6.
        for c in 0..2 {
            let mut h = Vector2::zeros();
            h[c] = 1e-9;
            let difference = (force(lateral + h, &velocity) - force(lateral - h, &velocity)) / 2e-9;
            let column = touch.by_displacement.column(1 + c);
            assert!(
                (column - difference).norm() < 1e-6 * column.norm(),
                "{column} {difference}"
            );
        }
        for c in 0..6 {
            let mut h = GapVector::zeros();
            h[c] = 1e-7;
            let difference = (force(lateral, &(velocity + h)) - force(lateral, &(velocity - h))) / 2e-7;
            let column = touch.by_velocity.column(c);
            assert!(
                (column - difference).norm() < 1e-6 * column.norm().max(1.0),
                "{c} {column} {difference}"
            );
        }
    }

    #[test]
    fn nothing_pulls_and_nothing_jumps_at_onset() {
        let law = law();
        let clearance = 8.5e-3;
        for speed in [-10.0, -1.0, 0.0, 1.0, 10.0] {
            let mut velocity = GapVector::zeros();
            velocity[2] = speed;
            let just = Vector2::new(0.0, clearance + 1e-12);
            let touch = law.touch(just, clearance, &velocity).unwrap();
            assert!(touch.normal >= 0.0 && touch.normal < 1e-4);
        }
    }
}
