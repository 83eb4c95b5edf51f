//! Scalars with their first and second derivatives in three variables, so that the joint rows' gradients and Hessians
//! (the exact tangents) follow from the same expressions as their values.

use std::ops::{Add, Mul, Neg, Sub};

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
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            gradient: Vector3::zeros(),
            hessian: Matrix3::zeros(),
        }
    }

    /// The variable number `index`.
    pub fn variable(value: f64, index: usize) -> Self {
        let mut jet = Self::constant(value);
        jet.gradient[index] = 1.0;
        jet
    }

    /// f(self) from f, f' and f'' at the value.
    pub fn chain(self, f: [f64; 3]) -> Self {
        Self {
            value: f[0],
            gradient: self.gradient * f[1],
            hessian: self.hessian * f[1] + self.gradient * self.gradient.transpose() * f[2],
        }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            value: self.value + o.value,
            gradient: self.gradient + o.gradient,
            hessian: self.hessian + o.hessian,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            gradient: -self.gradient,
            hessian: -self.hessian,
        }
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let outer = self.gradient * o.gradient.transpose();
        Self {
            value: self.value * o.value,
            gradient: self.gradient * o.value + o.gradient * self.value,
            hessian: self.hessian * o.value + o.hessian * self.value + outer + outer.transpose(),
        }
    }
}
