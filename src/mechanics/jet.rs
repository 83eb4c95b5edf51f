//! Scalars with their first and second derivatives in three variables, of which the joint rows' gradients and Hessians (the exact
//! tangents) are made.

use nalgebra::{Matrix3, Vector3};

/// A value with gradient and Hessian in (psi, phi_y, phi_z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivatives.
    pub gradient: Vector3<f64>,
    /// Second derivatives.
    pub hessian: Matrix3<f64>,
}

impl Jet {
    /// Zero.
    pub fn zero() -> Self {
        Self {
            value: 0.0,
            gradient: Vector3::zeros(),
            hessian: Matrix3::zeros(),
        }
    }

    /// Adds `factor` times `other`.
    #[inline(always)]
    pub fn add(&mut self, factor: f64, other: &Self) {
        self.value += factor * other.value;
        for k in 0..3 {
            self.gradient[k] += factor * other.gradient[k];
            for l in 0..3 {
                self.hessian[(l, k)] += factor * other.hessian[(l, k)];
            }
        }
    }
}
