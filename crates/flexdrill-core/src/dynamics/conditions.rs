//! Inputs and parameters that act on the tool at one instant.

use crate::inputs::Inputs;
use crate::tool::description::{LiveParameters, LoadHistory, Rayleigh, ToolDescription};

/// Inputs and parameters of one residual evaluation.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// Model time (s).
    pub time: f64,
    /// Angle of the drive (rad), for a driven top.
    pub drive_angle: f64,
    /// Weight on bit (N), compressing.
    pub weight_on_bit: f64,
    /// Rate of penetration (m/s): advance of the tool along the hole, negative when it is pulled back. The
    /// wall moves up past the guide at this speed.
    pub rate_of_penetration: f64,
    /// Standpipe pressure (Pa): inside minus outside at the tool's top.
    pub standpipe_pressure: f64,
    /// Distance (m) that the frame of the tool's displacements has advanced down the hole.
    pub depth: f64,
    /// Torque of the drive (N m); `None` where it is the reaction of the spin that the drive prescribes.
    pub drive_torque: Option<f64>,
    /// Parameters in force.
    pub live: LiveParameters,
    /// Whether the tool is coming to rest. What vanishes at rest is left out on the way there.
    pub comes_to_rest: bool,
    /// Damping of both pipes.
    pub rayleigh: Rayleigh,
}

impl Conditions {
    /// The description's laws with the live parameters in force under `inputs`, the drive at angle 0. The rotary speed of
    /// `inputs` does not enter: it acts by the angle of the drive.
    pub fn under(description: &ToolDescription, live: &LiveParameters, time: f64, inputs: &Inputs) -> Self {
        Self {
            rate_of_penetration: inputs.rate_of_penetration,
            standpipe_pressure: inputs.standpipe_pressure,
            ..Self::new(description, live, time, inputs.weight_on_bit)
        }
    }

    /// The same without advance and pressure.
    pub fn new(description: &ToolDescription, live: &LiveParameters, time: f64, weight_on_bit: f64) -> Self {
        Self {
            time,
            drive_angle: 0.0,
            weight_on_bit,
            rate_of_penetration: 0.0,
            standpipe_pressure: 0.0,
            depth: 0.0,
            drive_torque: None,
            live: *live,
            comes_to_rest: false,
            rayleigh: description.rayleigh,
        }
    }
}

impl LoadHistory {
    /// Load at `time` (N or N m).
    pub fn at(&self, time: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Ramp { rate, start, end } => rate * (time.min(*end) - start).max(0.0),
            Self::Sine {
                amplitude,
                frequency,
                phase,
            } => amplitude * libm::sin(std::f64::consts::TAU * frequency * time + phase),
            Self::Table(points) => interpolate(points, time),
        }
    }
}

fn interpolate(points: &[(f64, f64)], time: f64) -> f64 {
    let after = points.partition_point(|&(t, _)| t <= time);
    match (after.checked_sub(1).and_then(|i| points.get(i)), points.get(after)) {
        (Some(&(t0, y0)), Some(&(t1, y1))) => y0 + (y1 - y0) * (time - t0) / (t1 - t0),
        (Some(&(_, y)), None) | (None, Some(&(_, y))) => y,
        (None, None) => 0.0,
    }
}
