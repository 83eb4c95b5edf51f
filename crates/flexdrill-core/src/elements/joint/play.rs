//! Play of a joint about its shaft: the spins of the two links differ freely by a small angle, and beyond it the joint
//! carries torque through the stiffness of its pins or cages.
//!
//! The angle g of the rotational row (Eq. 13) is no constraint then but the deformation of a contact on either side:
//!
//! ```text
//! torque = k (|g| - delta) (1 + c sign(g) g') sign(g)   for |g| > delta, else 0
//! ```
//!
//! with delta half of the play (rad), k (N m/rad) and c (s/rad) as in the law of contact of Hunt and Crossley: continuous at
//! onset, never pulling back. The torque takes the place of the row's multiplier.

use super::law::{JointLaw, RotationFunction};
use crate::simd::number::Number;
use crate::tool::JointKind;

/// The torque of a joint with play and its derivatives; all are zero within the play.
#[derive(Debug, Clone, Copy, Default)]
pub struct Play<M> {
    /// Multiplier of the row that the torque comes to (N m).
    pub multiplier: M,
    /// d multiplier / d row at a constant rate (N m).
    pub stiffness: M,
    /// d multiplier / d row' (N m s).
    pub damping: M,
    /// Energy in the spring (J).
    pub energy: M,
    /// Power taken by the damping (W).
    pub dissipation: M,
}

impl<M> JointLaw<M> {
    /// Whether the rotational row is a contact with play instead of a constraint.
    #[inline(always)]
    pub fn has_play(&self) -> bool {
        self.play.half_angle > 0.0
    }

    /// Evaluates the torque for a `row` as linearised, under the rates of the rotations.
    #[inline(always)]
    pub fn play<T: Number<Memory = M>>(&self, row: &RotationFunction<M>, rate: &[T; 6], out: &mut Play<M>) {
        // The row of a ball cage is twice the sine of the angle between the spins.
        let scale = if self.kind == JointKind::BallCage { 0.5 } else { 1.0 };
        let mut turning = T::of(0.0);
        for (gradient, &rate) in row.gradient.iter().zip(rate) {
            turning = turning.plus_product(T::load(gradient), rate);
            // From here on in the angle of the joint, whatever the row's own scale.
        }
        let angle = T::load(&row.value) * T::of(scale);
        let rate = turning * T::of(scale);
        let (k, c, half) = (self.play.stiffness, self.play.damping, self.play.half_angle);
        // How far beyond the play, and how fast it goes on.
        let over = angle.map(|g| (g.abs() - half).max(0.0));
        let closing = angle.zip(rate, |g, rate| if g < 0.0 { -rate } else { rate });
        // Contact pushes and never pulls: with damping it would pull while it opens fast.
        let pushes = |over: f64, closing: f64| over > 0.0 && 1.0 + c * closing > 0.0;
        let torque = over.zip(closing, |over, closing| {
            if pushes(over, closing) {
                k * over * (1.0 + c * closing)
            } else {
                0.0
            }
        });
        // The multiplier of the row, in the row's scale.
        torque
            .zip(angle, |torque, g| scale * torque.copysign(g))
            .store(&mut out.multiplier);
        // Stiffness and damping are the derivatives of the torque, of the row by the row.
        let square = scale * scale * k;
        over.zip(closing, |over, closing| {
            if pushes(over, closing) {
                square * (1.0 + c * closing)
            } else {
                0.0
            }
        })
        .store(&mut out.stiffness);
        over.zip(
            closing,
            |over, closing| {
                if pushes(over, closing) { square * over * c } else { 0.0 }
            },
        )
        .store(&mut out.damping);
        over.map(|over| 0.5 * k * over * over).store(&mut out.energy);
        // A contact that opens faster than it can push loses its spring's energy to the damping.
        over.zip(closing, |over, closing| {
            if pushes(over, closing) {
                k * over * c * closing * closing
            } else {
                -k * over * closing
            }
        })
        .store(&mut out.dissipation);
    }
}

impl<M> Play<M> {
    /// Adds what the derivative of the torque puts on the rotations, times `stiffness` and, of the rates, `damping`, by
    /// columns. The row's curvature is not in it.
    #[inline(always)]
    pub fn add_tangent<T: Number<Memory = M>>(
        &self,
        row: &RotationFunction<M>,
        rate: &[M; 6],
        stiffness: f64,
        damping: f64,
        out: &mut [[M; 6]; 6],
    ) {
        let (stiff, damped) = (T::of(stiffness), T::of(damping));
        let (by_row, by_rate) = (T::load(&self.stiffness), T::load(&self.damping));
        for (l, column) in out.iter_mut().enumerate() {
            let mut turned = T::of(0.0);
            for (hessian, rate) in row.hessian[l].iter().zip(rate) {
                turned = turned.plus_product(T::load(hessian), T::load(rate));
            }
            let gradient = T::load(&row.gradient[l]);
            let change = (by_row * gradient + by_rate * turned) * stiff + by_rate * gradient * damped;
            for (k, entry) in column.iter_mut().enumerate() {
                T::load(entry)
                    .plus_product(T::load(&row.gradient[k]), change)
                    .store(entry);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::tangent;
    use super::super::law::tests::joint;
    use super::*;
    use crate::tool::JointPlay;

    fn law(kind: JointKind) -> JointLaw<f64> {
        let mut law = joint(kind).law;
        law.play = JointPlay {
            half_angle: 2e-3,
            stiffness: 1e6,
            damping: 0.2,
        };
        law
    }

    fn at(law: &JointLaw<f64>, q: &[f64; 6], rate: &[f64; 6]) -> (RotationFunction<f64>, Play<f64>) {
        let (mut rows, mut play): ([RotationFunction<f64>; 2], _) = Default::default();
        law.rows(q, &mut rows);
        law.play(&rows[0], rate, &mut play);
        (rows[0], play)
    }

    /// Straight and aligned links but for the bend of the frames, apart by `angle` in spin.
    fn apart(law: &JointLaw<f64>, angle: f64) -> [f64; 6] {
        let mut q = [0.3, 0.0, 0.0, 0.3, 0.0, 0.0];
        for _ in 0..6 {
            let (row, _) = at(law, &q, &[0.0; 6]);
            q[3] -= row.value / row.gradient[3];
        }
        q[3] += angle;
        q
    }

    /// Torque and energy of a joint turned by 0.5 mrad beyond its play, against 1e6 N m/rad: 500 N m and 0.125 J; within the
    /// play nothing. Tolerance 2 %, of the energy 4 %: the joint is bent by 0.047 rad, which changes lengths of arc by half its
    /// square, and the row counts these.
    #[test]
    fn analytic_play_of_a_joint() {
        use crate::support::figure;
        for kind in [JointKind::Universal, JointKind::BallCage] {
            let law = law(kind);
            let (row, play) = at(&law, &apart(&law, 1.9e-3), &[0.0; 6]);
            assert!(row.value != 0.0);
            assert_eq!((play.multiplier, play.stiffness, play.energy), (0.0, 0.0, 0.0));
            for sign in [1.0, -1.0] {
                let (row, play) = at(&law, &apart(&law, sign * 2.5e-3), &[0.0; 6]);
                let torque = play.multiplier * row.gradient[3];
                let of = format!("{kind:?}, turned {}", if sign > 0.0 { "forward" } else { "back" });
                figure(&format!("{of}: torque (N m)"), sign * 500.0, torque, 2e-2);
                figure(&format!("{of}: energy (J)"), 0.125, play.energy, 4e-2);
            }
        }
    }

    #[test]
    fn an_opening_contact_does_not_pull() {
        let law = law(JointKind::Universal);
        let q = apart(&law, 2.5e-3);
        // Ten times faster than 1 / c.
        let (_, play) = at(&law, &q, &[0.0, 0.0, 0.0, -50.0, 0.0, 0.0]);
        assert_eq!((play.multiplier, play.stiffness, play.damping), (0.0, 0.0, 0.0));
        assert!(play.energy > 0.0 && play.dissipation > 0.0);
    }

    #[test]
    fn the_tangent_is_that_of_differences() {
        for kind in [JointKind::Universal, JointKind::BallCage] {
            let law = law(kind);
            let (mut q, rate) = (apart(&law, 3e-3), [4.0, 0.3, 0.1, 4.1, -0.2, 0.05]);
            (q[1], q[4]) = (0.01, -0.02);
            let force = |q: &[f64; 6], rate: &[f64; 6]| {
                let (row, play) = at(&law, q, rate);
                row.gradient.map(|gradient| gradient * play.multiplier)
            };
            let (row, play) = at(&law, &q, &rate);
            assert!(play.multiplier.abs() > 100.0, "not in contact");
            let derivative = |stiffness: f64, damping: f64| {
                let mut out = [[0.0; 6]; 6];
                tangent(&[row], &[play.multiplier], None, stiffness, damping, &mut out);
                play.add_tangent::<f64>(&row, &rate, stiffness, damping, &mut out);
                out
            };
            let (by_angle, by_rate) = (derivative(1.0, 0.0), derivative(0.0, 1.0));
            let h = 1e-7;
            for l in 0..6 {
                let moved = |x: &[f64; 6], by: f64| {
                    let mut x = *x;
                    x[l] += by;
                    x
                };
                let (up, down) = (force(&moved(&q, h), &rate), force(&moved(&q, -h), &rate));
                let (faster, slower) = (force(&q, &moved(&rate, h)), force(&q, &moved(&rate, -h)));
                for k in 0..6 {
                    // Stiffness of 2e6 N m/rad; moments of 1e3 N m round to 1e-13 of it over the step: 1e-6 of it.
                    assert!(
                        (by_angle[l][k] - (up[k] - down[k]) / (2.0 * h)).abs() < 4.0,
                        "{kind:?} {l} {k}"
                    );
                    assert!(
                        (by_rate[l][k] - (faster[k] - slower[k]) / (2.0 * h)).abs() < 1e-2,
                        "{kind:?} {l} {k}"
                    );
                }
            }
        }
    }
}
