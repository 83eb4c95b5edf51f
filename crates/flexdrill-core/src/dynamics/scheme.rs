//! The time scheme: Newmark, Eq. 36 to 38 (the paper's kappa is beta), and its two relatives of second order with
//! damping, HHT-alpha and generalised-alpha.
//!
//! All three take displacement and velocity over a step h by Newmark's formulas from an acceleration `lagged`,
//!
//! ```text
//! q1 = q0 + h v0 + h^2 ((1/2 - beta) l0 + beta l1)        v1 = v0 + h ((1 - gamma) l0 + gamma l1)
//! ```
//!
//! and differ in what ties it to the accelerations a that the forces give:
//!
//! ```text
//! (1 - alpha_m) l1 + alpha_m l0 = (1 - alpha_f) a1 + alpha_f a0
//! ```
//!
//! (Arnold and Bruels, Multibody System Dynamics 18, 2007, Eq. 11). With both alphas zero l = a: Newmark. The equations
//! of motion, M a1 = F(q1, v1) + constraint forces, hold as they are at the end of the step, so contact forces, joint
//! forces and accelerations are those of the laws at that instant and the residual knows nothing of the scheme. For a
//! constant mass, which this model's is, it is the same as weighting the forces of both ends: M times the formula above
//! is the equation of Chung and Hulbert (J. Appl. Mech. 60, 1993) with the multipliers among the forces.

use serde::{Deserialize, Serialize};

use crate::dynamics::state::State;
use crate::elements::factors::TangentFactors;

/// Parameters of the scheme.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scheme {
    /// Weight of the new acceleration in the velocity; 1/2 - alpha_m + alpha_f is of second order.
    pub gamma: f64,
    /// Weight of the new acceleration in the displacement.
    pub beta: f64,
    /// Weight of the old lagged acceleration.
    pub alpha_m: f64,
    /// Weight of the old acceleration.
    pub alpha_f: f64,
}

impl Scheme {
    /// Newmark with the most damping of the highest frequencies for its `gamma`: beta = (gamma + 1/2)^2 / 4. Of second
    /// order and without damping at 1/2; above, of first order, with the damping of (gamma - 1/2) h more Rayleigh beta.
    pub fn newmark(gamma: f64) -> Self {
        Self {
            gamma,
            beta: 0.25 * (gamma + 0.5).powi(2),
            alpha_m: 0.0,
            alpha_f: 0.0,
        }
    }

    /// Hilber, Hughes and Taylor's alpha scheme, by its spectral radius at infinite frequency, 1/2 (alpha 1/3) to 1
    /// (alpha 0).
    pub fn hht(rho_infinity: f64) -> Self {
        Self::second_order(0.0, (1.0 - rho_infinity) / (1.0 + rho_infinity))
    }

    /// Chung and Hulbert's scheme, by its spectral radius at infinite frequency, 0 (the highest frequencies are gone
    /// after a step) to 1 (nothing is damped).
    pub fn generalised_alpha(rho_infinity: f64) -> Self {
        let below = 1.0 + rho_infinity;
        Self::second_order((2.0 * rho_infinity - 1.0) / below, rho_infinity / below)
    }

    /// Of second order, with the least damping of low frequencies for these weights.
    fn second_order(alpha_m: f64, alpha_f: f64) -> Self {
        let lag = alpha_f - alpha_m;
        Self {
            gamma: 0.5 + lag,
            beta: 0.25 * (1.0 + lag).powi(2),
            alpha_m,
            alpha_f,
        }
    }

    /// Part of the axial force in the geometric stiffness that is foreseen from the start of a step (0 to 1); the rest
    /// is that of the displacements at its end.
    ///
    /// Between contacts the pipe answers a lateral force by inertia, and the part would be that of
    /// [`Scheme::inertia_foresees`]; held in a contact it answers by stiffness, to the force at the end of the step, and
    /// the part would be 0. Two thirds of the former, by the ripple of a compressed pipe that beats in its guide: less
    /// is too calm in steps of 0.5 ms, more too lively in steps of 0.25 ms (`docs/history/tried.md`).
    pub(crate) fn foreseen_part(&self) -> f64 {
        self.inertia_foresees() * 2.0 / 3.0
    }

    /// The part with which what moves by inertia follows an axial force to fourth order.
    ///
    /// To an oscillation of frequency omega, q0 + h v0 is q1 (1 + (omega h)^2 / 2): a foreseen force is too large by
    /// that. What moves by inertia answers a force by -a / omega^2 (1 - (beta' - 1/12) (omega h)^2) with beta' = beta -
    /// (alpha_f - alpha_m) alpha_f: too little by that. Lateral motion under a changing axial force has the error of
    /// the product, which is of fourth order where the part is 2 beta' - 1/6: 0.55 at rho_infinity 0.45, 1/2 at 1/2,
    /// 1/3 at 1.
    fn inertia_foresees(&self) -> f64 {
        let beta = self.beta - (self.alpha_f - self.alpha_m) * self.alpha_f;
        (2.0 * beta - 1.0 / 6.0).clamp(0.0, 1.0)
    }

    /// Whether the lagged acceleration is another than that of the forces.
    fn lags(&self) -> bool {
        self.alpha_m != 0.0 || self.alpha_f != 0.0
    }

    /// Change of an acceleration per displacement (1/s2) over step `h`.
    fn inertia(&self, h: f64) -> f64 {
        (1.0 - self.alpha_m) / ((1.0 - self.alpha_f) * self.beta * h * h)
    }

    /// Tangent factors for step `h` (s), Eq. 37 and 41.
    pub(crate) fn factors(&self, h: f64) -> TangentFactors {
        TangentFactors {
            stiffness: 1.0,
            damping: self.gamma / (self.beta * h),
            mass: self.inertia(h),
        }
    }

    /// Velocity and acceleration of unknown `i` after a step `h` from `from` in which it moved by `dq`: the
    /// brackets of Eq. 38.
    pub(crate) fn rates(&self, h: f64, dq: f64, from: &State, i: usize) -> (f64, f64) {
        let (v0, l0) = (from.v[i], self.lagged(h, from)(from.lagged[i], from.a[i]));
        let l1 = (dq - h * v0) / (self.beta * h * h) - (0.5 / self.beta - 1.0) * l0;
        let v1 = v0 + h * ((1.0 - self.gamma) * l0 + self.gamma * l1);
        (v1, self.acceleration(l1, l0, from.a[i]))
    }

    /// The lagged acceleration of `from` for a step of size `h`, given that kept and the acceleration. It is that of
    /// (gamma - 1/2) steps ago; where the size increment it is moved in proportion, or the step would be of first
    /// order.
    #[inline(always)]
    fn lagged(&self, h: f64, from: &State) -> impl Fn(f64, f64) -> f64 + use<> {
        let same = !self.lags() || from.scheme_step == h || from.scheme_step == 0.0;
        let ratio = if same { 1.0 } else { h / from.scheme_step };
        move |lagged, a| if same { lagged } else { a + ratio * (lagged - a) }
    }

    /// a1 from l1.
    #[inline(always)]
    fn acceleration(&self, l1: f64, l0: f64, a0: f64) -> f64 {
        ((1.0 - self.alpha_m) * l1 + self.alpha_m * l0 - self.alpha_f * a0) / (1.0 - self.alpha_f)
    }

    /// Predicts `to` a step `h` on, unknown by unknown, with the lagged acceleration fading to zero (Eq. 44 begins at
    /// `from`), by the formulas of Eq. 38.
    #[inline(always)]
    pub(crate) fn predict(&self, h: f64, from: &State, to: &mut State) {
        let n = from.q.len();
        let (q0, v0, a0, kept) = (&from.q[..n], &from.v[..n], &from.a[..n], &from.lagged[..n]);
        let (q, v, a) = (&mut to.q[..n], &mut to.v[..n], &mut to.a[..n]);
        let (by_v, by_l) = (h, h * h * (0.5 - self.beta));
        let rate = h * (1.0 - self.gamma);
        let lagged = self.lagged(h, from);
        for i in 0..n {
            let l0 = lagged(kept[i], a0[i]);
            q[i] = q0[i] + (by_v * v0[i] + by_l * l0);
            v[i] = v0[i] + rate * l0;
            a[i] = self.acceleration(0.0, l0, a0[i]);
        }
    }

    /// Sets the lagged accelerations of a converged step `h`.
    #[inline(always)]
    pub(crate) fn finish(&self, h: f64, from: &State, to: &mut State) {
        to.scheme_step = h;
        if !self.lags() {
            to.lagged.copy_from_slice(&to.a);
            return;
        }
        let lagged = self.lagged(h, from);
        let old = from.a.iter().zip(&from.lagged);
        for ((l1, a1), (a0, kept)) in to.lagged.iter_mut().zip(&to.a).zip(old) {
            let forces = (1.0 - self.alpha_f) * a1 + self.alpha_f * a0;
            *l1 = (forces - self.alpha_m * lagged(*kept, *a0)) / (1.0 - self.alpha_m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCHEMES: [fn() -> Scheme; 5] = [
        || Scheme::newmark(0.5),
        || Scheme::hht(0.8),
        || Scheme::hht(0.5),
        || Scheme::generalised_alpha(0.8),
        || Scheme::generalised_alpha(0.0),
    ];

    /// q'' + 2 damping q' + stiffness q = force sin(t).
    struct Oscillator {
        scheme: Scheme,
        damping: f64,
        stiffness: f64,
        force: f64,
        state: State,
    }

    impl Oscillator {
        fn new(scheme: Scheme, damping: f64, stiffness: f64, force: f64) -> Self {
            let state = State {
                q: vec![1.0],
                v: vec![0.0],
                a: vec![-stiffness],
                lagged: vec![-stiffness],
                scheme_step: 0.0,
                pipe_axial: vec![],
                guide_axial: vec![],
                deflection: vec![],
                pin_moments: vec![],
                held_friction: vec![],
                time: 0.0,
                drive_angle: 0.0,
            };
            Self {
                scheme,
                damping,
                stiffness,
                force,
                state,
            }
        }

        /// As [`super::super::newton::step`] does it: predict, one correction of a linear system, finish.
        fn step(&mut self, h: f64) {
            let mut to = self.state.clone();
            to.time += h;
            self.scheme.predict(h, &self.state, &mut to);
            let factors = self.scheme.factors(h);
            let inner = 2.0 * self.damping * to.v[0] + self.stiffness * to.q[0];
            let residual = to.a[0] + inner - self.force * to.time.sin();
            let tangent = factors.mass + factors.damping * 2.0 * self.damping + factors.stiffness * self.stiffness;
            let dq = -residual / tangent;
            to.q[0] += dq;
            to.v[0] += factors.damping * dq;
            to.a[0] += factors.mass * dq;
            self.scheme.finish(h, &self.state, &mut to);
            self.state = to;
        }

        /// Displacement, velocity and acceleration at t = 2 with steps of the given pattern, repeated.
        fn run(&mut self, pattern: &[f64], repeats: usize) -> [f64; 3] {
            for _ in 0..repeats {
                pattern.iter().for_each(|&h| self.step(h));
            }
            assert!((self.state.time - 2.0).abs() < 1e-9);
            [self.state.q[0], self.state.v[0], self.state.a[0]]
        }
    }

    /// Least order by which displacement, velocity and acceleration of a damped, forced oscillator converge.
    fn order(scheme: Scheme, pattern: &[f64], repeats: usize) -> f64 {
        let run = |refine: usize| {
            let pattern: Vec<f64> = pattern.iter().map(|h| h / refine as f64).collect();
            Oscillator::new(scheme, 0.3, 40.0, 5.0).run(&pattern, repeats * refine)
        };
        let (exact, coarse, fine) = (run(64), run(1), run(2));
        (0..3)
            .map(|k| ((coarse[k] - exact[k]) / (fine[k] - exact[k])).abs().log2())
            .fold(f64::MAX, f64::min)
    }

    #[test]
    fn the_schemes_are_of_second_order() {
        for scheme in SCHEMES {
            let got = order(scheme(), &[0.002], 1000);
            // The next term of the error, smaller by omega h = 0.013 times a number of the order of one, shows in the
            // second digit.
            assert!(got > 1.9, "{:?}: order {got}", scheme());
        }
        let first = order(Scheme::newmark(0.55), &[0.002], 1000);
        assert!(
            (first - 1.0).abs() < 0.2,
            "Newmark above 1/2 is of first order: {first}"
        );
    }

    /// Error of the amplitude with which a free mass follows the force cos t, foreseen in part, with `n` steps a period.
    fn response_error(scheme: Scheme, part: f64, n: usize) -> f64 {
        let h = std::f64::consts::TAU / n as f64;
        let factors = scheme.factors(h);
        let mut mass = Oscillator::new(scheme, 0.0, 0.0, 0.0).state;
        let (mut got, mut exact, mut last) = (0.0, 0.0, [0.0; 2]);
        for step in 0..5 * n {
            let t = step as f64 * h;
            let force = part * (t.cos() - h * t.sin()) + (1.0 - part) * (t + h).cos();
            let mut to = mass.clone();
            scheme.predict(h, &mass, &mut to);
            let dq = (force - to.a[0]) / factors.mass;
            to.q[0] += dq;
            to.v[0] += factors.damping * dq;
            to.a[0] += factors.mass * dq;
            scheme.finish(h, &mass, &mut to);
            // Second differences, which a drift does not reach; those of -cos t are 2 (1 - cos h) cos t. The first
            // period is left to what the start excites.
            if step >= n {
                got += (to.q[0] - 2.0 * last[0] + last[1]) * t.cos();
                exact += 2.0 * (1.0 - h.cos()) * t.cos().powi(2);
            }
            last = [to.q[0], last[0]];
            mass = to;
        }
        got / exact - 1.0
    }

    #[test]
    fn inertia_follows_a_partly_foreseen_force_to_fourth_order() {
        for scheme in [
            Scheme::newmark(0.5),
            Scheme::hht(0.8),
            Scheme::generalised_alpha(0.45),
            Scheme::generalised_alpha(0.8),
        ] {
            let order = |part: f64| (response_error(scheme, part, 64) / response_error(scheme, part, 128)).log2();
            // The next term, of relative size (omega h)^2 = 0.01, shows in the second digit.
            let (with, without) = (order(scheme.inertia_foresees()), order(0.0));
            assert!((with.abs() - 4.0).abs() < 0.2, "{scheme:?}: order {with}");
            assert!(
                (without - 2.0).abs() < 0.2,
                "{scheme:?}: order {without} without foresight"
            );
        }
    }

    #[test]
    fn halved_steps_keep_the_order() {
        for scheme in SCHEMES {
            let got = order(scheme(), &[0.002, 0.001, 0.001, 0.002, 0.0005, 0.0005, 0.001], 250);
            assert!(got > 1.9, "{:?}: order {got}", scheme());
        }
    }

    #[test]
    fn the_highest_frequencies_fade_as_designed() {
        for rho in [0.5, 0.7, 0.9] {
            for scheme in [Scheme::hht(rho), Scheme::generalised_alpha(rho)] {
                let mut oscillator = Oscillator::new(scheme, 0.0, 1e14, 0.0);
                let mut after = |steps: usize| {
                    (0..steps).for_each(|_| oscillator.step(1.0));
                    oscillator.state.q[0].abs()
                };
                // The largest eigenvalue is double, so that the motion decays with n rho^n.
                let (first, second) = (after(200), after(200));
                let got = (0.5 * second / first).powf(1.0 / 200.0);
                // n is n + a number of the order of one: 1 % in the ratio's 200th root at most.
                assert!((got / rho - 1.0).abs() < 0.01, "{scheme:?}: {got}");
            }
        }
    }

    #[test]
    fn nothing_is_lost_where_nothing_shall_be() {
        for scheme in [Scheme::newmark(0.5), Scheme::hht(1.0), Scheme::generalised_alpha(1.0)] {
            let mut oscillator = Oscillator::new(scheme, 0.0, 1.0, 0.0);
            let mut largest = 0.0_f64;
            for step in 0..100_000 {
                oscillator.step(0.7);
                if step >= 99_000 {
                    largest = largest.max(oscillator.state.q[0].abs());
                }
            }
            // A thousand steps of a ninth of a period come within 1e-5 of the peak.
            assert!((largest - 1.0).abs() < 1e-4, "{scheme:?}: amplitude {largest}");
        }
    }
}
