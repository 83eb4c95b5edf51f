//! Numbers with their first and second derivatives in three variables. The rows of a joint are written over them, which
//! yields their exact gradients and Hessians.

use crate::simd::number::Number;

/// A value with gradient and Hessian in (psi, phi_y, phi_z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<T> {
    /// Value of the function.
    pub value: T,
    /// First derivatives in (psi, phi_y, phi_z).
    pub gradient: [T; 3],
    /// Second derivatives, symmetric.
    pub hessian: [[T; 3]; 3],
}

impl<T: Number> Jet<T> {
    /// The function that is zero everywhere.
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = T::of(0.0);
        Self {
            value: zero,
            gradient: [zero; 3],
            hessian: [[zero; 3]; 3],
        }
    }

    /// Adds `factor` times `other`, whose derivatives before the variable `FIRST` are zero.
    #[inline(always)]
    pub fn add<const FIRST: usize>(&mut self, factor: T, other: &Self) {
        self.value = self.value.plus_product(factor, other.value);
        for k in FIRST..3 {
            self.gradient[k] = self.gradient[k].plus_product(factor, other.gradient[k]);
            for l in k..3 {
                let sum = self.hessian[k][l].plus_product(factor, other.hessian[k][l]);
                self.hessian[k][l] = sum;
                self.hessian[l][k] = sum;
            }
        }
    }
}
