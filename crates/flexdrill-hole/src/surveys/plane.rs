//! The filter of one plane: its constants and its state.

use flexdrill_base::validation::{Bound, ValidationError};

/// Constants of the filter in one plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneModel {
    /// b_0: standard deviation of the correction where a run begins (1/m).
    pub correction: f64,
    /// q_b: standard deviation by which the correction wanders over a metre (1/m per root of a metre).
    pub correction_walk: f64,
    /// q_t: standard deviation by which the direction wanders over a metre (rad per root of a metre).
    pub angle_walk: f64,
    /// Metres of a run in which the correction wanders [`PlaneModel::beginning_factor`] times as much: the hole turns from
    /// the curvature of the last tool to that of this one.
    pub beginning: f64,
    /// How many times as much.
    pub beginning_factor: f64,
    /// Metres of a run in which surveys correct the angle only.
    pub settling: f64,
}

/// State of one plane at a depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneState {
    /// theta: angle of the hole in the plane (rad).
    pub angle: f64,
    /// b: what the curvature is above that of the model (1/m).
    pub correction: f64,
    /// P: variance of the angle (rad2), covariance of both (rad/m), variance of the correction (1/m2).
    pub covariance: [f64; 3],
}

impl PlaneModel {
    /// The plane of the build. The figures were chosen with synthetic wells of other laws, see `docs/hole_ahead.md`.
    pub const BUILD: Self = Self {
        correction: 0.035,
        correction_walk: 0.0055,
        angle_walk: 0.004,
        beginning: 2.5,
        beginning_factor: 3.0,
        settling: 1.5,
    };

    /// Across the plane of the build: the walk angle of the bit and the roll of the guide turn the hole by some 0.4 deg/m.
    /// The figures are assumptions.
    pub const RIGHT: Self = Self {
        correction: 0.010,
        correction_walk: 0.003,
        ..Self::BUILD
    };

    /// Checks the constants.
    ///
    /// # Errors
    /// [`ValidationError`] with the first number out of bounds.
    pub fn check(&self) -> Result<(), ValidationError> {
        Bound::NotNegative.check("filter.correction", self.correction, "1/m")?;
        Bound::NotNegative.check(
            "filter.correction_walk",
            self.correction_walk,
            "1/m per root of a metre",
        )?;
        Bound::NotNegative.check("filter.angle_walk", self.angle_walk, "rad per root of a metre")?;
        Bound::NotNegative.check("filter.beginning_factor", self.beginning_factor, "")?;
        Bound::NotNegative.check_all(
            "filter",
            &[("beginning", self.beginning), ("settling", self.settling)],
            "m",
        )
    }

    /// Covariance Q that `length` (m) adds, `drilled` (m) into the run; the length lies on one side of
    /// [`PlaneModel::beginning`].
    fn noise(&self, drilled: f64, length: f64) -> [f64; 3] {
        let factor = if drilled < self.beginning {
            self.beginning_factor
        } else {
            1.0
        };
        let (b, t) = ((factor * self.correction_walk).powi(2), self.angle_walk.powi(2));
        [
            t * length + b * length.powi(3) / 3.0,
            b * length.powi(2) / 2.0,
            b * length,
        ]
    }

    /// The state `length` (m) further, from `drilled` (m) into the run on, where the model turns the hole by `turn` (rad).
    pub(super) fn drilled(&self, mut state: PlaneState, drilled: f64, length: f64, turn: f64) -> PlaneState {
        state.angle += turn;
        // Q changes where the beginning of the run ends.
        let beginning = (self.beginning - drilled).clamp(0.0, length);
        for (drilled, length) in [(drilled, beginning), (drilled + beginning, length - beginning)] {
            if length > 0.0 {
                state = state.moved(length, self.noise(drilled, length));
            }
        }
        state
    }
}

impl PlaneState {
    /// x = F x, P = F P F' + Q with F = [1 length; 0 1].
    fn moved(self, length: f64, noise: [f64; 3]) -> Self {
        let [angle, both, correction] = self.covariance;
        Self {
            angle: self.angle + self.correction * length,
            correction: self.correction,
            covariance: [
                angle + 2.0 * length * both + length * length * correction + noise[0],
                both + length * correction + noise[1],
                correction + noise[2],
            ],
        }
    }

    /// The state after an angle was measured (rad) with a variance (rad2).
    ///
    /// Without `learns` the gain of the correction is 0. P is then that of Joseph's form, which holds for any gain.
    pub(super) fn measured(self, angle: f64, variance: f64, learns: bool) -> Self {
        let [p, both, correction] = self.covariance;
        let whole = p + variance;
        let surprise = angle - self.angle;
        let gain = if learns { both / whole } else { 0.0 };
        Self {
            angle: self.angle + p / whole * surprise,
            correction: self.correction + gain * surprise,
            covariance: [p * variance / whole, both * variance / whole, correction - gain * both],
        }
    }

    /// Standard deviation of the angle (rad).
    pub fn angle_deviation(&self) -> f64 {
        self.covariance[0].max(0.0).sqrt()
    }

    /// Standard deviation of the correction (1/m).
    pub fn correction_deviation(&self) -> f64 {
        self.covariance[2].max(0.0).sqrt()
    }

    /// A state that is as likely as the filter says, from two independent standard normal numbers; its covariance is 0.
    pub fn drawn(&self, normal: [f64; 2]) -> Self {
        // The lower factor of P.
        let [angle, both, correction] = self.covariance;
        let first = angle.max(0.0).sqrt();
        let across = if first > 0.0 { both / first } else { 0.0 };
        let second = (correction - across * across).max(0.0).sqrt();
        Self {
            angle: self.angle + first * normal[0],
            correction: self.correction + across * normal[0] + second * normal[1],
            covariance: [0.0; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUIET: PlaneModel = PlaneModel {
        correction: 0.0,
        correction_walk: 0.0,
        angle_walk: 0.0,
        beginning: 0.0,
        beginning_factor: 1.0,
        settling: 0.0,
    };

    fn state(covariance: [f64; 3]) -> PlaneState {
        PlaneState {
            angle: 0.0,
            correction: 0.0,
            covariance,
        }
    }

    #[test]
    fn the_gain_of_a_scalar_random_walk_becomes_that_of_riccatis_equation() {
        let model = PlaneModel {
            angle_walk: 0.3,
            ..QUIET
        };
        let (q, r) = (0.09, 0.5);
        // The predicted variance p is the positive root of p2 - q p - q r = 0, the updated one K r with K = p/(p + r).
        let p = 0.5 * (q + f64::sqrt(q * q + 4.0 * q * r));
        let mut at = state([10.0, 0.0, 0.0]);
        for _ in 0..100 {
            at = model.drilled(at, 0.0, 1.0, 0.0).measured(0.0, r, true);
        }
        // The error of the variance falls by (1 - K)2 per step, to a rounding.
        assert!((at.covariance[0] - p * r / (p + r)).abs() < 1e-14, "{at:?}");
        let predicted = model.drilled(at, 0.0, 1.0, 0.0);
        let moved = predicted.measured(1.0, r, true);
        assert!((moved.angle - p / (p + r)).abs() < 1e-14, "{moved:?}");
    }

    #[test]
    fn surveys_of_a_straight_plane_are_a_regression() {
        // Without a prior and without noise of the hole, the filter is the line of least squares: the slope of n points has
        // the variance r / sum (s - mean)2.
        let (r, slope) = (1e-6, 0.02);
        let errors = [1e-3, -2e-3, 0.5e-3, 1.5e-3, -1e-3];
        let depths = [0.0, 1.0, 2.5, 3.0, 5.0];
        let mut at = state([1e6, 0.0, 1e6]);
        let mut before = 0.0;
        for (depth, error) in depths.into_iter().zip(errors) {
            at = QUIET
                .drilled(at, before, depth - before, 0.3 * (depth - before))
                .measured((0.3 + slope) * depth + error, r, true);
            before = depth;
        }
        let mean = depths.iter().sum::<f64>() / 5.0;
        let spread: f64 = depths.iter().map(|depth| (depth - mean).powi(2)).sum();
        let line: f64 = depths
            .iter()
            .zip(errors)
            .map(|(depth, error)| (depth - mean) * error)
            .sum::<f64>()
            / spread;
        // A variance of 1e6 loses 12 digits of its sixteen to one of 1e-6: 1e-4 of it remain.
        assert!(
            (at.correction - slope - line).abs() < 1e-4 * line.abs() + 1e-7,
            "{at:?} {line}"
        );
        assert!((at.covariance[2] / (r / spread) - 1.0).abs() < 1e-3, "{at:?}");
    }

    #[test]
    fn a_length_in_parts_is_the_length() {
        let whole = PlaneModel::BUILD.drilled(state([1e-4, 1e-5, 1e-3]), 0.5, 4.0, 1.2);
        let mut parts = state([1e-4, 1e-5, 1e-3]);
        for (drilled, length) in [(0.5, 0.7), (1.2, 1.3), (2.5, 0.25), (2.75, 1.75)] {
            parts = PlaneModel::BUILD.drilled(parts, drilled, length, 0.3 * length);
        }
        for (a, b) in whole.covariance.into_iter().zip(parts.covariance) {
            assert!((a / b - 1.0).abs() < 1e-12, "{whole:?} {parts:?}");
        }
        assert!((whole.angle - parts.angle).abs() < 1e-15);
    }

    #[test]
    fn a_survey_that_must_not_learn_leaves_the_correction() {
        let at = state([1e-4, 1e-3, 0.02]);
        let after = at.measured(0.1, 1e-4, false);
        assert_eq!(after.correction, 0.0);
        assert_eq!(after.covariance[2], 0.02);
        assert!((after.angle - 0.05).abs() < 1e-15 && (after.covariance[0] - 0.5e-4).abs() < 1e-18);
    }

    #[test]
    fn drawn_states_have_the_covariance() {
        let at = state([4.0, 1.0, 9.0]);
        // The four signs of two unit numbers have the moments of independent standard normal ones.
        let mut found = [0.0; 3];
        for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            let one = at.drawn(signs);
            found[0] += 0.25 * one.angle * one.angle;
            found[1] += 0.25 * one.angle * one.correction;
            found[2] += 0.25 * one.correction * one.correction;
        }
        for (a, b) in found.into_iter().zip(at.covariance) {
            assert!((a - b).abs() < 1e-12, "{found:?}");
        }
    }
}
