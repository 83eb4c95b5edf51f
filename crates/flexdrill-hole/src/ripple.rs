//! Ripples of the hole (spiralling): below which steering number P they grow.

use flexdrill_base::validation::{Bound, ValidationError};
use nalgebra::Complex;

/// P = eta W_a l2/EI below which the hole of a guide that lies on the wall with play ripples with a period of about l. It is
/// a bound from computed holes, not a formula: a kick decays at 2.2 and above, and remains at 1.8 and below.
pub const RIPPLE_THRESHOLD: f64 = 2.2;

/// The onset of ripples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ripple {
    /// P_c = eta W_a l1^2/EI: ripples grow below it.
    pub steering_number: f64,
    /// Period of the ripple in units of l1.
    pub period: f64,
}

/// Highest wave number 1/l1 searched, and the step of the search: the ripples that grow first have some waves per l1.
const HIGHEST: f64 = 40.0;
const STEP: f64 = 1e-3;

/// Onset for a weightless straight beam with contacts without play at l1 and l1 + l2 behind the bit, such as stabilisers
/// (`ratio` = l2/l1).
///
/// With y the hole's offset and A = (1 - 6/P)/(2 (1 + r)) a wave e^(lambda s/l1) grows if the real part of lambda is
/// positive in
///
/// ```text
/// lambda = (1 - e^-lambda)(1 + A) - A e^-lambda (1 - e^(-r lambda))/r
/// ```
///
/// At the onset lambda is imaginary. The equation is linear in A, which must be real: one search for its wave numbers. None
/// if no wave grows at any P > 0.
///
/// # Errors
/// [`ValidationError`] for a ratio outside 0.1 to 10.
pub fn ripple_of_two_contacts(ratio: f64) -> Result<Option<Ripple>, ValidationError> {
    Bound::Within(0.1, 10.0).check("ratio", ratio, "")?;
    let coefficient = |wave: f64| {
        let lambda = Complex::new(0.0, wave);
        let (near, far) = ((-lambda).exp(), (-lambda * ratio).exp());
        let factor = (1.0 - near) - near * (1.0 - far) / ratio;
        (lambda - (1.0 - near)) / factor
    };
    let mut first: Option<Ripple> = None;
    for index in 1..(HIGHEST / STEP) as usize {
        let (mut low, mut high) = (index as f64 * STEP, (index + 1) as f64 * STEP);
        let sign = coefficient(low).im.signum();
        if coefficient(high).im.signum() == sign {
            continue;
        }
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if coefficient(middle).im.signum() == sign {
                low = middle;
            } else {
                high = middle;
            }
        }
        let onset = coefficient(low);
        // A pole changes the sign too, without a root.
        if onset.im.abs() > 1e-6 * (1.0 + onset.re.abs()) {
            continue;
        }
        let steering_number = 6.0 / (1.0 - 2.0 * (1.0 + ratio) * onset.re);
        if steering_number > 0.0 && first.is_none_or(|first| steering_number > first.steering_number) {
            first = Some(Ripple {
                steering_number,
                period: std::f64::consts::TAU / low,
            });
        }
    }
    Ok(first)
}
