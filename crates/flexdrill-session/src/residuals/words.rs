//! Why the estimate stands and why nothing follows it, in words.

use flexdrill_calibration::follow::Frozen;
use flexdrill_calibration::following::Held;

/// Why a sample does not count.
pub(super) const fn frozen_in_words(frozen: Frozen) -> &'static str {
    match frozen {
        Frozen::Missing => "a value is missing",
        Frozen::BadInput => "an input is not good",
        Frozen::NotSteady => "the motion is not steady",
        Frozen::Outlier => "the sample is far from what is expected",
    }
}

/// Why nothing follows.
pub(super) fn held_in_words(held: Held) -> String {
    match held {
        Held::Frozen(frozen) => frozen_in_words(frozen).to_owned(),
        Held::FactorUncertain(half, most) => format!(
            "the friction factor is known to +-{half:.2} only, +-{most} is required; a minute of rotation off bottom narrows it"
        ),
        Held::TareUncertain(half, most) => format!(
            "the torque tare is known to +-{half:.0} N m only, +-{most} N m is required; a minute of rotation off bottom \
             narrows it"
        ),
        Held::FactorAtLimit(limit) => format!("the friction factor is at its limit of {limit}"),
        Held::TareAtLimit(limit) => format!("the torque tare is at its limit of {limit} N m"),
    }
}
