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

mod layer;
mod memory;

pub use layer::LayerContacts;

use nalgebra::{SVector, Vector2};

use super::slip::Slip;
use crate::simd::number::{Lane, Number};
use crate::tool::GapDescription;

/// Local motion or force of a gap.
pub type GapVector = SVector<f64, 6>;

/// The law of a layer's contacts.
#[derive(Debug, Clone, Copy)]
pub struct GapLaw {
    /// Stiffness, damping, friction.
    pub surface: GapDescription,
    /// Regularisation speed of the friction (m/s).
    pub slip_speed: f64,
}

/// The contact of a closed gap, or one in each of eight lanes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Touch<N = f64> {
    /// Normal force (N, >= 0).
    pub normal: N,
    /// Tangential friction on the inner body, positive in the sense of positive spin (N).
    pub tangential: N,
    /// Axial friction on the inner body, downhole positive (N).
    pub axial: N,
    /// Energy in the contact spring (J).
    pub energy: N,
    /// Power taken by the normal damping (W).
    pub dissipation: N,
    /// Power taken by the friction, around and along (W, >= 0).
    pub friction_power: N,
    /// Unit vector from the outer body's axis to the inner's, y and z: the normal n. The tangent is t = (-n_z, n_y).
    direction: [N; 2],
    /// Curvature of the relative path: one over the distance of the axes (1/m).
    curvature: N,
    /// d normal / d displacement along n and along t (N/m), d normal / d closing speed (N s/m).
    normal_by: [N; 3],
    /// d sliding speed / d displacement along t (1/s), around and along.
    sliding_by: [N; 2],
    /// Sliding around and along, with its friction per normal force.
    slip: [Slip<N>; 2],
}

/// The derivative of a gap's force as four dyads: the force changes by minus the sum of `on` times (`by` . motion).
/// Kept in this form, a tangent costs four products with the nodes' directions instead of a 6 x 6 matrix.
///
/// Local directions with n and t of [`Touch`]: `normal` (0, n, 0, 0, 0), `tangent` (0, t, 0, 0, 0), `around` (0, t, 1,
/// 0, 0), `along` (1, 0, 0, 0, n_z, -n_y), `tilt` (0, 0, 0, 0, n_y, n_z).
#[derive(Debug, Clone, Copy)]
pub struct GapTangent {
    /// The normal n.
    pub direction: [f64; 2],
    /// Force along normal, around, along, per motion in the normal.
    pub by_normal: [f64; 3],
    /// Force along normal, tangent, around, along, tilt, per motion in the tangent.
    pub by_tangent: [f64; 5],
    /// Force around per motion around.
    pub by_around: f64,
    /// Force along per motion along.
    pub by_along: f64,
}

/// A dyad of a [`GapTangent`].
#[derive(Debug, Clone, Copy)]
pub struct TangentTerm {
    /// Local force.
    pub on: GapVector,
    /// The local motion that it is proportional to.
    pub by: GapVector,
}

impl GapTangent {
    /// The four dyads in local directions; the first is Eq. 22.
    pub fn terms(&self) -> [TangentTerm; 4] {
        let [y, z] = self.direction;
        let of = |components: [f64; 6]| GapVector::from_column_slice(&components);
        let (normal, tangent) = (of([0.0, y, z, 0.0, 0.0, 0.0]), of([0.0, -z, y, 0.0, 0.0, 0.0]));
        let (around, along) = (of([0.0, -z, y, 1.0, 0.0, 0.0]), of([1.0, 0.0, 0.0, 0.0, z, -y]));
        let tilt = of([0.0, 0.0, 0.0, 0.0, y, z]);
        let ([a, b, c], by) = (self.by_normal, self.by_tangent);
        [
            TangentTerm {
                on: normal * a + around * b + along * c,
                by: normal,
            },
            TangentTerm {
                on: normal * by[0] + tangent * by[1] + around * by[2] + along * by[3] + tilt * by[4],
                by: tangent,
            },
            TangentTerm {
                on: around * self.by_around,
                by: around,
            },
            TangentTerm {
                on: along * self.by_along,
                by: along,
            },
        ]
    }
}

impl Touch {
    /// Force of the gap on the inner body: the nodal force of Eq. 26 but for the radii.
    #[inline(always)]
    pub fn force(&self) -> [f64; 6] {
        self.of_parts(self.normal)
    }

    /// The friction part of [`Touch::force`].
    #[inline(always)]
    pub fn friction_force(&self) -> [f64; 6] {
        self.of_parts(0.0)
    }

    /// The normal part acts along n through N_G, Eq. 21, the others around and along.
    #[inline(always)]
    fn of_parts(&self, normal: f64) -> [f64; 6] {
        let ([y, z], around, along) = (self.direction, self.tangential, self.axial);
        [
            along,
            -y * normal - z * around,
            -z * normal + y * around,
            around,
            along * z,
            -along * y,
        ]
    }

    /// The exact derivative with factors on those in displacement and in velocity, Eq. 22.
    #[inline(always)]
    pub fn tangent(&self, stiffness: f64, damping: f64) -> GapTangent {
        let [around, along] = &self.slip;
        let (share_around, share_along) = (around.friction, along.friction);
        let (slope_around, slope_along) = (self.normal * around.slope, self.normal * along.slope);
        let normal = self.normal_by[0] * stiffness + self.normal_by[2] * damping;
        let across = self.normal_by[1] * stiffness;
        // The directions turn with the displacement: dn = t (t.dd)/distance, dt = -n (t.dd)/distance. Friction is minus
        // its share here.
        let turning = stiffness * self.curvature;
        GapTangent {
            direction: self.direction,
            by_normal: [normal, share_around * normal, share_along * normal],
            by_tangent: [
                across + turning * self.tangential,
                turning * self.normal,
                share_around * across + slope_around * self.sliding_by[0] * stiffness,
                share_along * across + slope_along * self.sliding_by[1] * stiffness,
                -turning * self.axial,
            ],
            by_around: slope_around * damping,
            by_along: slope_along * damping,
        }
    }
}

impl Touch<Lane> {
    /// The contact in lane `k`.
    #[inline(always)]
    fn lane(&self, k: usize) -> Touch {
        let two = |x: &[Lane; 2]| [x[0][k], x[1][k]];
        Touch {
            normal: self.normal[k],
            tangential: self.tangential[k],
            axial: self.axial[k],
            energy: self.energy[k],
            dissipation: self.dissipation[k],
            friction_power: self.friction_power[k],
            direction: two(&self.direction),
            curvature: self.curvature[k],
            normal_by: [self.normal_by[0][k], self.normal_by[1][k], self.normal_by[2][k]],
            sliding_by: two(&self.sliding_by),
            slip: [self.slip[0].lane(k), self.slip[1].lane(k)],
        }
    }

    /// Sets the contact in lane `k`.
    #[inline(always)]
    fn set_lane(&mut self, k: usize, from: &Touch) {
        let two = |x: &mut [Lane; 2], from: &[f64; 2]| (x[0][k], x[1][k]) = (from[0], from[1]);
        self.normal[k] = from.normal;
        self.tangential[k] = from.tangential;
        self.axial[k] = from.axial;
        self.energy[k] = from.energy;
        self.dissipation[k] = from.dissipation;
        self.friction_power[k] = from.friction_power;
        two(&mut self.direction, &from.direction);
        self.curvature[k] = from.curvature;
        for (x, from) in self.normal_by.iter_mut().zip(&from.normal_by) {
            x[k] = *from;
        }
        two(&mut self.sliding_by, &from.sliding_by);
        for (x, from) in self.slip.iter_mut().zip(&from.slip) {
            x.set_lane(k, from);
        }
    }
}

impl Slip<Lane> {
    /// The slip in lane `k`.
    #[inline(always)]
    fn lane(&self, k: usize) -> Slip {
        Slip {
            speed: self.speed[k],
            friction: self.friction[k],
            slope: self.slope[k],
        }
    }

    /// Sets the slip in lane `k`.
    #[inline(always)]
    fn set_lane(&mut self, k: usize, from: &Slip) {
        (self.speed[k], self.friction[k], self.slope[k]) = (from.speed, from.friction, from.slope);
    }
}

impl<N: Number> Touch<N> {
    /// Writes all lanes to memory.
    #[inline(always)]
    fn store(self, to: &mut Touch<N::Memory>) {
        self.normal.store(&mut to.normal);
        self.tangential.store(&mut to.tangential);
        self.axial.store(&mut to.axial);
        self.energy.store(&mut to.energy);
        self.dissipation.store(&mut to.dissipation);
        self.friction_power.store(&mut to.friction_power);
        self.curvature.store(&mut to.curvature);
        self.normal_by[2].store(&mut to.normal_by[2]);
        for k in 0..2 {
            self.direction[k].store(&mut to.direction[k]);
            self.normal_by[k].store(&mut to.normal_by[k]);
            self.sliding_by[k].store(&mut to.sliding_by[k]);
            self.slip[k].speed.store(&mut to.slip[k].speed);
            self.slip[k].friction.store(&mut to.slip[k].friction);
            self.slip[k].slope.store(&mut to.slip[k].slope);
        }
    }
}

/// Gap (m, negative is penetration) at the lateral displacement (y, z) within `clearance`, Eq. 27 and 31.
pub fn gap(lateral: Vector2<f64>, clearance: f64) -> f64 {
    clearance - lateral.norm()
}

impl GapLaw {
    /// Coefficients of friction around and along.
    #[inline(always)]
    fn friction(&self) -> [f64; 2] {
        [self.surface.friction_tangential, self.surface.friction_axial]
    }

    /// The contact of a closed gap at lateral displacement `lateral` (y, z; offsets included) and local velocity
    /// `velocity`.
    ///
    /// Normal force F = k d (1 + c d') >= 0 with penetration d: continuous at onset, never pulling. Friction mu F v /
    /// sqrt(v^2 + v_s^2) separately around and along (Eq. 25), at the sliding speeds of Eq. 23.
    #[inline(always)]
    pub fn touch<N: Number>(&self, lateral: [N; 2], clearance: N, velocity: &[N; 6]) -> Touch<N> {
        let (zero, one) = (N::of(0.0), N::of(1.0));
        let (k, c) = (N::of(self.surface.stiffness), N::of(self.surface.damping));
        let distance = (lateral[0] * lateral[0]).plus_product(lateral[1], lateral[1]).root();
        let depth = zero.largest(distance - clearance);
        let curvature = one.over(distance);
        let (y, z) = (lateral[0] * curvature, lateral[1] * curvature);
        // Relative velocity along n (closing) and along t (swinging).
        let closing = (y * velocity[1]).plus_product(z, velocity[2]);
        let swinging = y * velocity[2] - z * velocity[1];
        // Bodies that part faster than the law can push have no force; the spring's energy is lost to the damping.
        let viscous = zero.largest(one.plus_product(c, closing));
        let spring = k * depth;
        let normal = spring * viscous;
        let by_rate = (spring * c).where_above(viscous, zero);

        // Sliding speeds at the contact point, Eq. 23, and their derivatives.
        let around = swinging + velocity[3];
        let along = velocity[0] + (velocity[4] * z - velocity[5] * y);
        let tilting = (velocity[4] * y).plus_product(velocity[5], z);
        let [full_around, full_along] = self.friction().map(N::of);
        let slip = [
            Slip::at(around, full_around, self.slip_speed),
            Slip::at(along, full_along, self.slip_speed),
        ];
        let (tangential, axial) = (-(slip[0].friction * normal), -(slip[1].friction * normal));
        Touch {
            normal,
            tangential,
            axial,
            energy: N::of(0.5) * spring * depth,
            dissipation: (normal - spring) * closing,
            friction_power: -(tangential * around + axial * along),
            direction: [y, z],
            curvature,
            normal_by: [k * viscous, by_rate * swinging * curvature, by_rate],
            sliding_by: [-(closing * curvature), tilting * curvature],
            slip,
        }
    }
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
        let at = |d: Vector2<f64>, v: &GapVector| law().touch([d.x, d.y], clearance, &(*v).into());
        let touch = at(lateral, &velocity);
        let force = |d: Vector2<f64>, v: &GapVector| GapVector::from_column_slice(&at(d, v).force());
        let [y, z] = touch.direction;
        let pushed = GapVector::from_column_slice(&[0.0, -y, -z, 0.0, 0.0, 0.0]) * touch.normal;
        let friction = GapVector::from_column_slice(&touch.friction_force());
        assert!((force(lateral, &velocity) - pushed - friction).norm() < 1e-12 * touch.normal);
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
            let velocity = [0.0, 0.0, speed, 0.0, 0.0, 0.0];
            let touch = law.touch([0.0, clearance + 1e-12], clearance, &velocity);
            assert!(touch.normal >= 0.0 && touch.normal < 1e-4);
        }
    }
}
