//! Dynamic gap elements, Eq. 20 to 34: normal contact and friction between an inner and an outer round body.
//!
//! Local coordinates of a gap, in the station's frame (x down the hole, y horizontal, z low side), as the inner body's
//! motion relative to the outer's:
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

use nalgebra::{SVector, Vector2};

use crate::tool::description::GapDescription;

/// Local motion or force of a gap.
pub type GapVector = SVector<f64, 6>;

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
    /// Energy in the contact spring (J).
    pub energy: f64,
    /// Power taken by the normal damping (W).
    pub dissipation: f64,
    /// Power taken by the friction, around and along (W, >= 0).
    pub friction_power: f64,
    /// Unit vector from the outer body's axis to the inner's.
    direction: Vector2<f64>,
    /// Distance of the axes (m).
    distance: f64,
    /// d normal / d lateral displacement (N/m) and velocity (N s/m).
    normal_by: [Vector2<f64>; 2],
    /// d sliding speed / d lateral displacement (1/s), around and along.
    sliding_by: [Vector2<f64>; 2],
    /// d friction / d normal (-) and d friction / d sliding speed (N s/m), around and along; friction as it opposes
    /// positive sliding.
    friction_by: [[f64; 2]; 2],
}

/// The derivative of a gap's force as a sum of four products: the force changes by minus `on` times `by` . (local
/// motion).
pub type TangentTerms = [TangentTerm; 4];

/// A product of [`TangentTerms`].
#[derive(Debug, Clone, Copy)]
pub struct TangentTerm {
    /// Local force.
    pub on: GapVector,
    /// Its size per local motion.
    pub by: GapVector,
}

impl Touch {
    /// Force of the gap on the inner body, normal part.
    #[cfg(test)]
    pub fn normal_force(&self) -> GapVector {
        self.on_normal() * -self.normal
    }

    /// Force of the gap on the inner body, friction part.
    pub fn friction_force(&self) -> GapVector {
        self.on_around() * self.tangential + self.on_along() * self.axial
    }

    /// Both: the nodal force of Eq. 26 but for the radii.
    #[inline]
    pub fn force(&self) -> GapVector {
        let (n, f_n, f_t, f_a) = (self.direction, self.normal, self.tangential, self.axial);
        GapVector::from_column_slice(&[
            f_a,
            -n.x * f_n - n.y * f_t,
            -n.y * f_n + n.x * f_t,
            f_t,
            f_a * n.y,
            -f_a * n.x,
        ])
    }

    /// Along the normal: n through N_G, Eq. 21.
    #[inline]
    fn on_normal(&self) -> GapVector {
        let n = self.direction;
        GapVector::from_column_slice(&[0.0, n.x, n.y, 0.0, 0.0, 0.0])
    }

    /// Around: t = (-n_z, n_y), and the spin.
    #[inline]
    fn on_around(&self) -> GapVector {
        let n = self.direction;
        GapVector::from_column_slice(&[0.0, -n.y, n.x, 1.0, 0.0, 0.0])
    }

    #[inline]
    fn on_along(&self) -> GapVector {
        let n = self.direction;
        GapVector::from_column_slice(&[1.0, 0.0, 0.0, 0.0, n.y, -n.x])
    }

    /// The exact derivative with factors on those in displacement and in velocity; its first term is Eq. 22.
    #[inline(always)]
    pub fn tangent(&self, stiffness: f64, damping: f64) -> TangentTerms {
        let lateral = |v: Vector2<f64>| GapVector::from_column_slice(&[0.0, v.x, v.y, 0.0, 0.0, 0.0]);
        let n = self.direction;
        let t = Vector2::new(-n.y, n.x);
        let normal = self.normal_by[0] * stiffness + self.normal_by[1] * damping;
        let friction = |k: usize, on: GapVector| {
            let [by_normal, by_sliding] = self.friction_by[k];
            lateral(normal * by_normal + self.sliding_by[k] * (by_sliding * stiffness)) + on * (by_sliding * damping)
        };
        // The directions turn with the displacement: dn = t (t.dd)/distance, dt = -n (t.dd)/distance. Friction is minus
        // its share here.
        let turned = GapVector::from_column_slice(&[
            0.0,
            t.x * self.normal + n.x * self.tangential,
            t.y * self.normal + n.y * self.tangential,
            0.0,
            -self.axial * t.y,
            self.axial * t.x,
        ]);
        [
            TangentTerm {
                on: self.on_normal(),
                by: lateral(normal),
            },
            TangentTerm {
                on: self.on_around(),
                by: friction(0, self.on_around()),
            },
            TangentTerm {
                on: self.on_along(),
                by: friction(1, self.on_along()),
            },
            TangentTerm {
                on: turned,
                by: lateral(t * (stiffness / self.distance)),
            },
        ]
    }
}

/// Gap left (m, negative is penetration) at lateral displacement (y, z) in clearance `clearance`, Eq. 27 and 31.
pub fn gap(lateral: Vector2<f64>, clearance: f64) -> f64 {
    clearance - lateral.norm()
}

impl GapLaw {
    /// The contact at lateral displacement `lateral` (y, z; offsets included) and local velocity `velocity`, or `None`
    /// while the gap is open.
    ///
    /// Normal force F = k d (1 + c d') >= 0 with penetration d: continuous at onset, never pulling. Friction mu F v /
    /// sqrt(v^2 + v_s^2) separately around and along (Eq. 25), at the sliding speeds of Eq. 23.
    #[inline(always)]
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
            energy: 0.5 * k * depth * depth,
            dissipation: 0.0,
            friction_power: 0.0,
            direction: n,
            distance,
            normal_by: [Vector2::zeros(); 2],
            sliding_by: [Vector2::zeros(); 2],
            friction_by: [[0.0; 2]; 2],
        };
        if viscous == 0.0 {
            // Leaving faster than the law can push: no force, but the spring's energy is lost to its damping.
            touch.dissipation = -k * depth * closing;
            return Some(touch);
        }
        let normal = touch.normal;
        let by_rate = k * depth * self.surface.damping;
        touch.dissipation = by_rate * closing * closing;
        touch.normal_by = [n * (k * viscous) + t * (by_rate * swinging), n * by_rate];

        // Sliding speeds at the contact point, Eq. 23, and their derivatives.
        let around = t.dot(&lateral_velocity) + velocity[3];
        let along = velocity[0] + velocity[4] * n.y - velocity[5] * n.x;
        touch.sliding_by = [
            t * (-closing / distance),
            t * ((velocity[4] * t.y - velocity[5] * t.x) / distance),
        ];
        let (mu_t, mu_a) = (self.surface.friction_tangential, self.surface.friction_axial);
        let (share_t, slope_t) = self.regularised(around);
        let (share_a, slope_a) = self.regularised(along);
        touch.tangential = -mu_t * normal * share_t;
        touch.axial = -mu_a * normal * share_a;
        touch.friction_power = -(touch.tangential * around + touch.axial * along);
        touch.friction_by = [
            [mu_t * share_t, mu_t * normal * slope_t],
            [mu_a * share_a, mu_a * normal * slope_a],
        ];
        Some(touch)
    }

    /// v / sqrt(v^2 + v_s^2) and its derivative.
    #[inline(always)]
    fn regularised(&self, speed: f64) -> (f64, f64) {
        regularised_sign(speed, self.slip_speed)
    }
}

/// Smooth sign of `speed` with width `width`, and its derivative.
#[inline(always)]
pub fn regularised_sign(speed: f64, width: f64) -> (f64, f64) {
    let root = (speed * speed + width * width).sqrt();
    (speed / root, width * width / (root * root * root))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;

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
        let force = |d: Vector2<f64>, v: &GapVector| law().touch(d, clearance, v).unwrap().force();
        assert!((touch.force() - touch.normal_force() - touch.friction_force()).norm() < 1e-12 * touch.normal);
        let derivative = |stiffness: f64, damping: f64| {
            let terms = touch
                .tangent(stiffness, damping)
                .map(|term| term.on * term.by.transpose());
            -terms.iter().fold(SMatrix::<f64, 6, 6>::zeros(), |sum, term| sum + term)
        };
        let (by_displacement, by_velocity) = (derivative(1.0, 0.0), derivative(0.0, 1.0));
        // Central differences with steps of 1e-5 of each motion's scale: relative error well below 1e-6.
        for c in 0..2 {
            let mut h = Vector2::zeros();
            h[c] = 1e-9;
            let difference = (force(lateral + h, &velocity) - force(lateral - h, &velocity)) / 2e-9;
            let column = by_displacement.column(1 + c);
            assert!(
                (column - difference).norm() < 1e-6 * column.norm(),
                "{column} {difference}"
            );
        }
        for c in 0..6 {
            let mut h = GapVector::zeros();
            h[c] = 1e-7;
            let difference = (force(lateral, &(velocity + h)) - force(lateral, &(velocity - h))) / 2e-7;
            let column = by_velocity.column(c);
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
