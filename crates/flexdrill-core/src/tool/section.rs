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

/// A part of a round tube between two nodes of a path that bends it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BentTube {
    /// Length (m, the chord's).
    pub length: f64,
    /// Curvature of the path between its nodes (1/m).
    pub path: f64,
    /// Curvature of the tube as made (1/m).
    pub made: f64,
    /// Angle of that bend from the plane of the path while the tube's spin is 0 (rad).
    pub phase: f64,
}

impl BentTube {
    /// Curvature (1/m) of the path between two node frames that are turned by `turn` (rad) against each other, whose chord
    /// has the length `length` (m): that at which the chord's beam is bent by rotations psi alone as by phi_z, 1/R in an arc.
    pub fn path_curvature(length: f64, turn: f64) -> f64 {
        2.0 * libm::sin(0.5 * turn) / length
    }

    /// Its curvature against its shape as made (1/m), in the plane of the path and across it, at small tilts: turned by `spin`
    /// (rad) and bent by `bent`, the changes of phi_y and phi_z (rad) over its length.
    pub fn change(&self, spin: f64, bent: [f64; 2]) -> [f64; 2] {
        let bent = [self.path + bent[0] / self.length, bent[1] / self.length];
        if self.made == 0.0 {
            return bent;
        }
        let (sin, cos) = libm::sincos(spin + self.phase);
        [bent[0] - self.made * cos, bent[1] - self.made * sin]
    }
}
