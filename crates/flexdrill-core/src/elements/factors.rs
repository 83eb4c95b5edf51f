//! The weights of K, C and M in the tangent, Eq. 37 and 41.

/// Factors of the tangent k K + d C + m M: (1, gamma/(beta h), 1/(beta h^2)) in a Newmark step, Eq. 41; (0, 0, 1) to
/// find accelerations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentFactors {
    /// On stiffness-like terms.
    pub stiffness: f64,
    /// On damping-like terms (1/s).
    pub damping: f64,
    /// On the mass (1/s2).
    pub mass: f64,
}
