//! The mud around the pipes and the pressure in them.

use serde::{Deserialize, Serialize};

/// Pump pressure in the pipe: inside less outside.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PressureDescription {
    /// At the tool's top.
    pub at_top: PressureSource,
    /// Share of it that friction takes per length (1/m).
    pub drop_per_metre: f64,
    /// What closes the pipe's lower end.
    pub end: PressureEnd,
    /// Diameter at which the joints are sealed (m).
    pub joint_seal_diameter: f64,
}

/// Where the pressure at the tool's top comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum PressureSource {
    /// A constant (Pa).
    Constant(f64),
    /// The input [`standpipe_pressure`](crate::inputs::Inputs::standpipe_pressure).
    Standpipe,
}

/// The pipe's lower end under pressure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum PressureEnd {
    /// The end is closed and free along the axis: the bit hangs on the pipe.
    Closed,
    /// The end slides in a seal, whose body carries the pressure on the bit.
    Sealed {
        /// Diameter of the seal (m).
        diameter: f64,
    },
    /// A support or the tie to the guide holds the end along the axis.
    Held,
}

/// The mud around the pipes, in `effects/mud.rs`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MudDescription {
    /// Density (kg/m3).
    pub density: f64,
    /// Dynamic viscosity (Pa s).
    pub viscosity: f64,
    /// Frequency of the motion whose mass and damping are taken (Hz).
    pub frequency: f64,
    /// What the mud adds to the mass.
    pub added_mass: AddedMass,
    /// What its viscosity takes, and adds to the mass.
    pub damping: MudDamping,
    /// The film of a body near its wall.
    pub film: MudFilm,
}

/// How much mud moves with the pipes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AddedMass {
    /// None.
    #[default]
    None,
    /// As with small motion about the centre of each annulus.
    Concentric,
    /// More near the wall, in `effects/mud_wall/`.
    Eccentric,
}

/// Damping by the mud's viscosity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MudDamping {
    /// None.
    #[default]
    None,
    /// Proportional to the relative velocity of the walls of an annulus.
    Viscous,
}

/// What mud takes from a body that squeezes it out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MudFilm {
    /// As about the centre.
    #[default]
    None,
    /// The full film of lubrication, in `effects/mud_wall/`.
    Squeeze,
}
