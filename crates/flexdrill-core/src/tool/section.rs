//! Section properties of round tubes.

use std::f64::consts::PI;

use crate::tool::{Material, Tube};

/// Stiffness (D of Eq. 6) and mass (Eq. 5) per length of a beam section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionProperties {
    /// E A (N).
    pub axial: f64,
    /// E I, alike about both transverse axes (N m2).
    pub bending: f64,
    /// G I_x (N m2).
    pub torsion: f64,
    /// rho A (kg/m).
    pub mass: f64,
    /// rho I_x (kg m).
    pub spin_inertia: f64,
}

impl SectionProperties {
    /// Properties of `tube` made of `material`, its bending stiffness times `bending_factor`.
    pub fn of(tube: Tube, material: Material, bending_factor: f64) -> Self {
        let (outer, inner) = (tube.outer_diameter, tube.inner_diameter);
        let area = PI / 4.0 * (outer.powi(2) - inner.powi(2));
        let second_moment = PI / 64.0 * (outer.powi(4) - inner.powi(4));
        let shear_modulus = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
        Self {
            axial: material.youngs_modulus * area,
            bending: material.youngs_modulus * second_moment * bending_factor,
            torsion: shear_modulus * 2.0 * second_moment,
            mass: material.density * area,
            spin_inertia: material.density * 2.0 * second_moment,
        }
    }
}
