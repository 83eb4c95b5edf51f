//! Friction around and along, each limited by itself: Eq. 25 as the paper prints it.
//!
//! T = - mu_t Fn s_t / sqrt(s_t^2 + v_s^2), A = - mu_x Fn s_x / sqrt(s_x^2 + v_s^2), with the sliding speeds s_t around
//! and s_x along. Together they reach up to sqrt 2 mu Fn.

use super::{GapLaw, Sliding, Touch};
use crate::elements::slip::Slip;
use crate::simd::number::Number;

/// Adds the friction of contacts that slide at the speeds of `sliding` (m/s), with their `factor` on the coefficients.
#[inline(always)]
pub(super) fn rub<N: Number>(law: &GapLaw, touch: &mut Touch<N>, sliding: Sliding<N>, factor: N) {
    let [full_around, full_along] = law.friction(factor);
    let slip = [
        Slip::at(sliding.around, full_around, law.slip_speed),
        Slip::at(sliding.along, full_along, law.slip_speed),
    ];
    touch.tangential = -(slip[0].friction * touch.normal);
    touch.axial = -(slip[1].friction * touch.normal);
    touch.friction_power = -(touch.tangential * sliding.around + touch.axial * sliding.along);
    touch.sliding_by = sliding.by;
    touch.slip = slip;
}
