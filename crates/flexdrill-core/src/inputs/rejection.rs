//! Why a sample was refused.

use std::fmt;

use super::{InputKind, InputRoute};

/// A sample that was refused. Its `Display` is a sentence with topic, value, bound and unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rejection {
    /// Of which input.
    pub kind: InputKind,
    /// On which topic.
    pub route: InputRoute,
    /// The value received ([`InputKind::unit`]).
    pub value: f64,
    /// When it was received (s, the caller's clock).
    pub time: f64,
    /// Why it was refused, with the bound.
    pub reason: RejectionReason,
}

/// Why a sample was refused. Bounds are in the unit of the sample.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RejectionReason {
    /// NaN or infinite.
    NotFinite,
    /// Negative by more than the tare error.
    Negative {
        /// Largest negative reading that counts as zero.
        tare_error: f64,
    },
    /// Below the smallest allowed value.
    BelowMinimum {
        /// Smallest allowed.
        min: f64,
    },
    /// Above the largest allowed value.
    AboveMaximum {
        /// Largest allowed.
        max: f64,
    },
    /// Its time precedes that of the last accepted sample.
    TimeBackwards {
        /// By how much (s).
        by: f64,
    },
    /// Its source marks it as bad.
    Bad,
    /// Its stamp is ahead of the clock.
    FromFuture {
        /// By how much (s).
        by: f64,
        /// How far a stamp may be ahead (s).
        max_skew: f64,
    },
    /// Its stamp is older than a value may be.
    TooOld {
        /// Its age on arrival (s).
        age: f64,
        /// From which age a value is stale (s).
        max_age: f64,
    },
}

impl RejectionReason {
    /// Number of reasons.
    pub const COUNT: usize = 8;

    /// Index into an array of counts.
    pub const fn index(&self) -> usize {
        match self {
            Self::NotFinite => 0,
            Self::Negative { .. } => 1,
            Self::BelowMinimum { .. } => 2,
            Self::AboveMaximum { .. } => 3,
            Self::TimeBackwards { .. } => 4,
            Self::Bad => 5,
            Self::FromFuture { .. } => 6,
            Self::TooOld { .. } => 7,
        }
    }
}

/// The value to a thousandth, which is more than any sensor of a rig resolves; never a negative zero.
fn thousandths(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

impl Rejection {
    /// The value for a sentence: to a thousandth, but where that would no longer be beyond the bound.
    fn shown(&self) -> f64 {
        let rounded = thousandths(self.value);
        let is_within = match self.reason {
            RejectionReason::AboveMaximum { max } => rounded <= max,
            RejectionReason::BelowMinimum { min } => rounded >= min,
            RejectionReason::Negative { tare_error } => rounded >= -tare_error,
            _ => false,
        };
        if is_within { self.value } else { rounded }
    }
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, unit) = (self.kind.name(), self.kind.unit());
        match self.route {
            InputRoute::Plain => write!(f, "{}: {} {unit} refused: ", self.kind.topic(), self.shown()),
            InputRoute::Stamped => write!(
                f,
                "{}: {name} {} {unit} refused: ",
                InputRoute::STAMPED_TOPIC,
                self.shown()
            ),
        }?;
        match self.reason {
            RejectionReason::NotFinite => write!(f, "not a finite number"),
            RejectionReason::Negative { tare_error } => write!(
                f,
                "negative by more than the tare error of {tare_error} {unit} (inputs.{name}); tare the sensor"
            ),
            RejectionReason::BelowMinimum { min } => write!(f, "below the minimum of {min} {unit} (inputs.{name})"),
            RejectionReason::AboveMaximum { max } => write!(f, "above the maximum of {max} {unit} (inputs.{name})"),
            RejectionReason::TimeBackwards { by } => {
                // The shortest time that is shown is not 0.
                let by = thousandths(by).max(1e-3);
                write!(f, "its time is {by} s before that of the last good sample")
            }
            RejectionReason::Bad => write!(f, "its source calls it BAD"),
            RejectionReason::FromFuture { by, max_skew } => write!(
                f,
                "its stamp is {by:.3} s ahead of the clock, at most {max_skew} s are allowed (inputs.stamp.max_skew); set \
                 the clocks of both machines"
            ),
            RejectionReason::TooOld { age, max_age } => write!(
                f,
                "its stamp is {age:.3} s old, stale from {max_age} s on (inputs.{name}.max_age); set the clocks of both \
                 machines or look for what holds it up"
            ),
        }?;
        write!(f, "; the last good value is held")
    }
}

impl std::error::Error for Rejection {}
