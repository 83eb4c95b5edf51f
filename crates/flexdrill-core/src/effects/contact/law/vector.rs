//! Friction against the whole sliding velocity: Coulomb's law on an ellipse, regularised by a sliding speed.
//!
//! Of all friction forces with (T / mu_t)^2 + (A / mu_x)^2 <= Fn^2 a sliding contact has the one that dissipates most.
//! With the sliding speeds s_t around and s_x along (m/s) and the regularisation speed v_s this is
//!
//! ```text
//! S = sqrt((mu_t s_t)^2 + (mu_x s_x)^2 + (mu v_s)^2),   mu = max(mu_t, mu_x)
//! T = - Fn mu_t^2 s_t / S,     A = - Fn mu_x^2 s_x / S
//! dT/ds_t = - Fn mu_t^2 (1/S - mu_t^2 s_t^2 / S^3),     dT/ds_x = dA/ds_t = Fn mu_t^2 mu_x^2 s_t s_x / S^3
//! ```
//!
//! The power taken is Fn (mu_t^2 s_t^2 + mu_x^2 s_x^2) / S >= 0. T acts on the inner body in the sense of positive
//! spin, A down the hole (N). A body that turns fast has little friction against slow motion along its axis. At a
//! standstill the law creeps; [`super::bristle`] holds.

use super::{GapLaw, Sliding, Touch};
use crate::elements::slip::Slip;
use crate::simd::number::{Lane, Number};

/// Keeps S above zero without friction (m/s): T and A are then 0 over this.
const LEAST: f64 = 1e-150;

/// The regularisation mu v_s (m/s) of coefficients `mu` around and along.
#[inline(always)]
fn width<N: Number>(law: &GapLaw, [around, along]: [N; 2]) -> N {
    (around.largest(along) * N::of(law.slip_speed)).largest(N::of(LEAST))
}

/// Adds the friction of contacts that slide at the speeds of `sliding` (m/s), with their `factor` on the coefficients.
#[inline(always)]
pub(super) fn rub<N: Number>(law: &GapLaw, touch: &mut Touch<N>, sliding: Sliding<N>, factor: N) {
    let mu = law.friction(factor);
    let [mu_around, mu_along] = mu;
    let one = N::of(1.0);
    // The speeds on the unit circle's scale, and their shares of it.
    let scaled = [mu_around * sliding.around, mu_along * sliding.along];
    let width = width(law, mu);
    let square = (width * width).plus_product(scaled[0], scaled[0]);
    let over = one.over(square.plus_product(scaled[1], scaled[1]).root());
    let share = [scaled[0] * over, scaled[1] * over];
    let (around, along) = (mu_around * share[0], mu_along * share[1]);
    touch.slip = [
        Slip {
            speed: sliding.around,
            friction: around,
            slope: mu_around * mu_around * over * (one - share[0] * share[0]),
        },
        Slip {
            speed: sliding.along,
            friction: along,
            slope: mu_along * mu_along * over * (one - share[1] * share[1]),
        },
    ];
    touch.coupling = -(around * along * over);
    touch.tangential = -(around * touch.normal);
    touch.axial = -(along * touch.normal);
    touch.friction_power = -(touch.tangential * sliding.around + touch.axial * sliding.along);
    touch.sliding_by = sliding.by;
}

/// Memory of the friction of a layer over the corrections of a step: where a correction has turned the friction round,
/// its slope is that of [`crate::elements::slip`] in two directions. Without it a contact that rolls or sticks
/// oscillates.
#[derive(Debug, Clone)]
pub(super) struct VectorMemory {
    /// Number of the step; entries of earlier steps are void.
    step: u64,
    contacts: Vec<ContactMemory>,
}

/// Memory of one contact, on the scale of the unit circle.
#[derive(Debug, Clone, Copy, Default)]
struct ContactMemory {
    step: u64,
    /// Scaled sliding mu_t s_t, mu_x s_x (m/s) at the previous residual, and the share of the full friction.
    scaled: [f64; 2],
    share: [f64; 2],
    /// d share / d scaled: around, coupling, along (s/m).
    slope: [f64; 3],
    /// Whether a correction of this step has turned the friction round, against its own prediction.
    crossed: bool,
}

impl VectorMemory {
    /// A memory for `stations` stations.
    pub(super) fn new(stations: usize) -> Self {
        Self {
            step: 1,
            contacts: vec![ContactMemory::default(); stations],
        }
    }

    /// Starts a step: the memory of the previous one becomes void.
    pub(super) fn begin(&mut self) {
        self.step += 1;
    }

    /// Sets the slopes of the friction of `touches`, the contacts at `stations` lane by lane with their `factors` on the
    /// coefficients.
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        law: &GapLaw,
        stations: impl Iterator<Item = usize>,
        factors: &Lane,
        touches: &mut Touch<Lane>,
    ) {
        for (lane, station) in stations.enumerate() {
            // Each station has its factor of friction, by the interval of the hole.
            let mu = law.friction(factors[lane]);
            let width = width(law, mu);
            let slips = touches.slip.map(|slip| slip.lane(lane));
            let contact = &mut self.contacts[station];
            // Scaled by the coefficients the ellipse is a circle, and all directions are alike.
            let scaled = [0, 1].map(|k| mu[k] * slips[k].speed);
            let length = (scaled[0] * scaled[0] + scaled[1] * scaled[1]).sqrt();
            let over = 1.0 / (length * length + width * width).sqrt();
            let share = scaled.map(|x| x * over);
            let (mut expected, mut crossed) = (share, false);
            // Only an evaluation of the same step is a prediction: the memory of an earlier one is of another motion.
            if contact.step == self.step {
                let moved = [scaled[0] - contact.scaled[0], scaled[1] - contact.scaled[1]];
                let [a, b, c] = contact.slope;
                expected = [
                    contact.share[0] + a * moved[0] + b * moved[1],
                    contact.share[1] + b * moved[0] + c * moved[1],
                ];
                // The expected force cannot exceed the circle.
                let most = (expected[0] * expected[0] + expected[1] * expected[1]).sqrt().max(1.0);
                expected = expected.map(|x| x / most);
                // Within the width the law is so nearly linear that Newton's own slope converges.
                let turned = expected[0] * share[0] + expected[1] * share[1] < 0.0 && length > width;
                crossed = contact.crossed || turned;
            }
            // (1 - (e s^T + s e^T) / 2) / S with the expected share e: positive semi-definite, exact where e is s.
            let by = if crossed { expected } else { share };
            let slope = [
                over * (1.0 - by[0] * share[0]),
                -0.5 * over * (by[0] * share[1] + by[1] * share[0]),
                over * (1.0 - by[1] * share[1]),
            ];
            // Once a contact has crossed in a step, the secant holds to its end: alternating slopes would circle.
            if crossed {
                touches.slip[0].slope[lane] = mu[0] * mu[0] * slope[0];
                touches.coupling[lane] = mu[0] * mu[1] * slope[1];
                touches.slip[1].slope[lane] = mu[1] * mu[1] * slope[2];
            }
            *contact = ContactMemory {
                step: self.step,
                scaled,
                share,
                slope,
                crossed,
            };
        }
    }
}
