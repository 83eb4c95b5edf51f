//! Inputs and parameters that act on the tool at one instant.

use crate::elements::gap::GapLaw;
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
    /// eta D WOB / 3 of Eq. 1 (N m), >= 0.
    pub bit_torque: f64,
    /// Regularisation of the bit torque (rad/s).
    pub bit_slip_rate: f64,
    /// Contact law of pipe and guide.
    pub inner: GapLaw,
    /// Contact law of guide and wall.
    pub outer: GapLaw,
    /// Damping of both pipes.
    pub rayleigh: Rayleigh,
}

impl Conditions {
    /// The description's laws with the live parameters in force, bit torque by Eq. 1, the drive at angle 0.
    pub fn new(description: &ToolDescription, live: &LiveParameters, time: f64, weight_on_bit: f64) -> Self {
        let mut inner = GapLaw {
            surface: description.inner,
            slip_speed: description.slip_speed,
        };
        let mut outer = GapLaw {
            surface: description.outer,
            slip_speed: description.slip_speed,
        };
        [inner.surface.friction_tangential, inner.surface.friction_axial] = live.inner_friction;
        [outer.surface.friction_tangential, outer.surface.friction_axial] = live.outer_friction;
        Self {
            time,
            drive_angle: 0.0,
            weight_on_bit,
            bit_torque: live.bit_friction_factor * description.bit.diameter * weight_on_bit.max(0.0) / 3.0,
            bit_slip_rate: description.bit.slip_rate,
            inner,
            outer,
            rayleigh: description.rayleigh,
        }
    }
}

impl LiveParameters {
    /// The description's own values.
    pub fn of(description: &ToolDescription) -> Self {
        Self {
            inner_friction: [description.inner.friction_tangential, description.inner.friction_axial],
            outer_friction: [description.outer.friction_tangential, description.outer.friction_axial],
            bit_friction_factor: description.bit.friction_factor,
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
