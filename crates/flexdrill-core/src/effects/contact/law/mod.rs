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

mod bristle;
mod layer;
mod memory;
mod separate;
#[cfg(test)]
mod tests;
mod vector;

pub use layer::LayerContacts;

#[cfg(test)]
use nalgebra::SVector;

use crate::elements::slip::Slip;
use crate::simd::number::{Lane, Number};
use crate::tool::{FrictionLaw, GapDescription};

#[cfg(test)]
/// Local motion or force of a gap.
pub type GapVector = SVector<f64, 6>;

/// The law of a layer's contacts.
#[derive(Debug, Clone, Copy)]
pub struct GapLaw {
    /// Stiffness, damping, friction.
    pub surface: GapDescription,
    /// Regularisation speed of the friction (m/s); a bristle has none.
    pub slip_speed: f64,
    /// Stiffness of a bristle (N/m).
    pub bristle_stiffness: f64,
}

/// Sliding at a contact around and along: speeds (m/s) or, over a step, distances (m).
#[derive(Debug, Clone, Copy)]
struct Sliding<N> {
    around: N,
    along: N,
    /// Derivatives of both by the displacement along t (1/s or -).
    by: [N; 2],
}

impl<N: Number> Sliding<N> {
    /// Of a `motion` in local coordinates at the contact point, Eq. 23.
    #[inline(always)]
    fn of(touch: &Touch<N>, motion: &[N; 6]) -> Self {
        let [y, z] = touch.direction;
        let closing = (y * motion[1]).plus_product(z, motion[2]);
        let swinging = y * motion[2] - z * motion[1];
        let tilting = (motion[4] * y).plus_product(motion[5], z);
        Self {
            around: swinging + motion[3],
            along: motion[0] + (motion[4] * z - motion[5] * y),
            by: [-(closing * touch.curvature), tilting * touch.curvature],
        }
    }
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
    /// d sliding speed / d displacement along t (1/s), around and along; of a bristle d sliding distance.
    sliding_by: [N; 2],
    /// Sliding around and along, with its friction per normal force. Of a bristle: sliding distance, and minus
    /// d friction / d normal force.
    slip: [Slip<N>; 2],
    /// What [`Slip::slope`] is for the friction around by the sliding along, and the other way round.
    coupling: N,
    /// Whether the slopes are by the sliding distance of the step, as a bristle's, not by the sliding speed.
    by_travel: bool,
}

/// The derivative of a gap's force, or of one in each of eight lanes, as four dyads: the force changes by minus the sum of `on`
/// times (`by` . motion). Kept in this form, a tangent costs four products with the nodes' directions instead of a 6 x 6 matrix.
///
/// Local directions with n and t of [`Touch`]: `normal` (0, n, 0, 0, 0), `tangent` (0, t, 0, 0, 0), `around` (0, t, 1,
/// 0, 0), `along` (1, 0, 0, 0, n_z, -n_y), `tilt` (0, 0, 0, 0, n_y, n_z).
#[derive(Debug, Clone, Copy)]
pub struct GapTangent<N = f64> {
    /// The normal n.
    pub direction: [N; 2],
    /// Force along normal, around, along, per motion in the normal.
    pub by_normal: [N; 3],
    /// Force along normal, tangent, around, along, tilt, per motion in the tangent.
    pub by_tangent: [N; 5],
    /// Force around per motion around.
    pub by_around: N,
    /// Force along per motion along.
    pub by_along: N,
    /// Force around per motion along, and along per motion around.
    pub by_other: N,
}

impl<N: Number> GapTangent<N> {
    /// All its numbers in one list, two by two: the normal and minus the normal, then by what the force is proportional to; the
    /// last place is empty.
    #[inline(always)]
    pub fn numbers(&self) -> [[N; 2]; 8] {
        let ([y, z], [a, b, c], [d, e, f, g, h]) = (self.direction, self.by_normal, self.by_tangent);
        let (around, along, other) = (self.by_around, self.by_along, self.by_other);
        [
            [y, z],
            [-y, -z],
            [a, b],
            [c, d],
            [e, f],
            [g, h],
            [around, along],
            [other, N::of(0.0)],
        ]
    }
}

#[cfg(test)]
/// A dyad of a [`GapTangent`].
#[derive(Debug, Clone, Copy)]
pub struct TangentTerm {
    /// Local force.
    pub on: GapVector,
    /// The local motion that it is proportional to.
    pub by: GapVector,
}

#[cfg(test)]
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
                on: around * self.by_around + along * self.by_other,
                by: around,
            },
            TangentTerm {
                on: along * self.by_along + around * self.by_other,
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
            coupling: self.coupling[k],
            by_travel: self.by_travel,
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
        self.coupling[k] = from.coupling;
        self.by_travel = from.by_travel;
    }
}

impl<N: Number> Touch<N> {
    /// Reads all lanes from memory.
    #[inline(always)]
    pub(super) fn load(from: &Touch<N::Memory>) -> Self {
        let mut out = Self {
            normal: N::load(&from.normal),
            tangential: N::load(&from.tangential),
            axial: N::load(&from.axial),
            energy: N::load(&from.energy),
            dissipation: N::load(&from.dissipation),
            friction_power: N::load(&from.friction_power),
            direction: [N::of(0.0); 2],
            curvature: N::load(&from.curvature),
            normal_by: [N::of(0.0); 3],
            sliding_by: [N::of(0.0); 2],
            slip: [Slip::load(&from.slip[0]), Slip::load(&from.slip[1])],
            coupling: N::load(&from.coupling),
            by_travel: from.by_travel,
        };
        for k in 0..2 {
            out.direction[k] = N::load(&from.direction[k]);
            out.sliding_by[k] = N::load(&from.sliding_by[k]);
        }
        for k in 0..3 {
            out.normal_by[k] = N::load(&from.normal_by[k]);
        }
        out
    }

    /// The exact derivative with factors on those in displacement and in velocity, Eq. 22.
    #[inline(always)]
    pub fn tangent(&self, stiffness: f64, damping: f64) -> GapTangent<N> {
        let (stiffness, damping) = (N::of(stiffness), N::of(damping));
        let [around, along] = &self.slip;
        let (share_around, share_along) = (around.friction, along.friction);
        let (slope_around, slope_along) = (self.normal * around.slope, self.normal * along.slope);
        let slope_other = self.normal * self.coupling;
        let [around_by, along_by] = self.sliding_by;
        let sliding = if self.by_travel { stiffness } else { damping };
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
                share_around * across + (slope_around * around_by + slope_other * along_by) * stiffness,
                share_along * across + (slope_along * along_by + slope_other * around_by) * stiffness,
                -turning * self.axial,
            ],
            by_around: slope_around * sliding,
            by_along: slope_along * sliding,
            by_other: slope_other * sliding,
        }
    }

    /// Writes all lanes to memory, but for the coupling, which only some laws have.
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

impl GapLaw {
    /// Coefficients of friction around and along, at stations with this factor on both.
    #[inline(always)]
    fn friction<N: Number>(&self, factor: N) -> [N; 2] {
        let surface = &self.surface;
        [
            N::of(surface.friction_tangential) * factor,
            N::of(surface.friction_axial) * factor,
        ]
    }

    /// The contact of a closed gap at lateral displacement `lateral` (y, z; offsets included) and local velocity
    /// `velocity`, without friction.
    ///
    /// Normal force F = k d (1 + c d') >= 0 with penetration d: continuous at onset, never pulling.
    #[inline(always)]
    fn press<N: Number>(&self, lateral: [N; 2], clearance: N, velocity: &[N; 6]) -> Touch<N> {
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
        let by_rate = (spring * c).where_above(viscous, zero, zero);
        let nothing = Slip {
            speed: zero,
            friction: zero,
            slope: zero,
        };
        Touch {
            normal,
            tangential: zero,
            axial: zero,
            energy: N::of(0.5) * spring * depth,
            dissipation: (normal - spring) * closing,
            friction_power: zero,
            direction: [y, z],
            curvature,
            normal_by: [k * viscous, by_rate * swinging * curvature, by_rate],
            sliding_by: [zero; 2],
            slip: [nothing; 2],
            coupling: zero,
            by_travel: false,
        }
    }

    /// Stiffness of the bristle (N/m) of a contact of normal stiffness `normal` (N/m) between bodies with Poisson's
    /// ratio `poisson_ratio`: 0.82 times that of the contact for steel (Mindlin 1949).
    pub fn bristle_stiffness(normal: f64, poisson_ratio: f64) -> f64 {
        2.0 * (1.0 - poisson_ratio) / (2.0 - poisson_ratio) * normal
    }

    /// Whether the friction has bristles, which need the motion since the start of the step.
    #[inline(always)]
    pub(crate) fn has_bristles(&self) -> bool {
        self.surface.friction_law == FrictionLaw::Bristle
    }
}
