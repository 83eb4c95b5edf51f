//! Limits and ages of an input, in the unit of its samples.

/// Limits, start value and ages of one input. Values in the unit of the samples ([`super::InputKind::unit`]), times in s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputRule {
    /// Smallest accepted value.
    pub min: f64,
    /// Largest accepted value.
    pub max: f64,
    /// A value this little below zero counts as zero.
    pub tare_error: f64,
    /// Value that acts until the first sample; the assumed value of an optional input.
    pub initial: f64,
    /// Value that the target ramps to when the input stays stale.
    pub safe: f64,
    /// Rate of that ramp, per s.
    pub safe_ramp: f64,
    /// Age from which the input is SLOW.
    pub slow_age: f64,
    /// Age from which it is STALE.
    pub max_age: f64,
    /// Time for which a stale value is held before the ramp begins.
    pub hold_before_safe: f64,
    /// Whether the tool's mechanics ask for the input. One that is not used does not count for the quality of the
    /// inputs; one that is optional is then shown only when it was sent or a value is assumed.
    pub used: bool,
}

/// The rules of all inputs, in the order of [`super::InputKind::ALL`].
pub type InputRules = [InputRule; super::InputKind::COUNT];
