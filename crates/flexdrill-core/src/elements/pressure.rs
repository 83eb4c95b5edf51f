//! Pump pressure in the pipe: the effective tension, and what an end and a joint carry of it.
//!
//! Inside the pipe the pressure is higher than outside by p, which falls along the tool by friction of the mud. The mud is
//! counted with the pipe: what bends a pipe is the tension in its wall less pressure times bore, the effective tension
//!
//! ```text
//! N_eff = N_wall - p A_i
//! ```
//!
//! (Lubinski, Althouse and Logan, JPT 14, 1962). It takes the place of N in the geometric stiffness, and forces on pipe
//! and mud together are in balance with it. The friction that lowers p pulls the wall by as much per length as p A_i falls,
//! so that N_eff does not change by it; nor does it where the bore changes. A wall under internal pressure shortens
//! (Poisson's ratio nu), N_wall = EA e + 2 nu p A_i, so that an element has
//!
//! ```text
//! N_eff = EA e - (1 - 2 nu) p A_i.
//! ```
//!
//! The lower end decides: where it is closed and free, N_eff = 0 there; where it slides in a seal of area A_s, the pressure
//! pushes it up, N_eff = - p A_s, and the guide, whose connector holds the seal, is pulled down by the same force: a cut
//! through both pipes does not know the pump. Where it is held, the strain decides. The pins of a joint that is sealed at a diameter of
//! area A_j carry N_eff + p A_j. The momentum of the flow, rho A U^2, is left out (88 N at 8 l/s).
//!
//! Tension is positive; p in Pa. Hydrostatic pressure, the same inside and outside, is in the buoyancy.

use std::f64::consts::PI;

use crate::tool::{PressureDescription, PressureEnd, PressureSource, ToolDescription};

/// Constant factors of the pressure at the tool's top.
#[derive(Debug, Clone)]
pub struct PipePressure {
    described: PressureDescription,
    /// Effective tension of each pipe element that is not strained, per pressure at the top (N/Pa).
    pub unstrained: Vec<f64>,
    /// Force on the pipe's lower end along its axis, per pressure at the top (N/Pa); its reaction is on the guide's.
    pub on_end: f64,
    /// What the pins of each joint carry beyond the effective tension, per pressure at the top (N/Pa).
    pub on_pins: Vec<f64>,
}

impl PipePressure {
    /// Of a tool whose stations are `spacing` (m) apart.
    pub fn of(described: PressureDescription, d: &ToolDescription, spacing: f64) -> Self {
        let per_link = d.elements_per_link;
        let elements = d.links * per_link;
        let share = |stations: f64| 1.0 - described.drop_per_metre * spacing * stations;
        let free = 1.0 - 2.0 * d.material.poisson_ratio;
        let unstrained = |e: usize| {
            let bore = disc(d.pipe_sections[e % per_link].inner_diameter);
            -free * bore * share(e as f64 + 0.5)
        };
        let at_joint = |j: usize| disc(described.joint_seal_diameter) * share(((j + 1) * per_link) as f64);
        Self {
            unstrained: (0..elements).map(unstrained).collect(),
            on_end: match described.end {
                PressureEnd::Sealed { diameter } => -disc(diameter) * share(elements as f64),
                PressureEnd::Closed | PressureEnd::Held => 0.0,
            },
            on_pins: (0..d.links - 1).map(at_joint).collect(),
            described,
        }
    }

    /// Pressure inside less outside at the tool's top (Pa), under that of the standpipe (Pa).
    #[inline]
    pub fn at_top(&self, standpipe: f64) -> f64 {
        match self.described.at_top {
            PressureSource::Constant(pressure) => pressure,
            PressureSource::Standpipe => standpipe,
        }
    }
}

/// Area of a disc (m2).
fn disc(diameter: f64) -> f64 {
    PI / 4.0 * diameter * diameter
}
