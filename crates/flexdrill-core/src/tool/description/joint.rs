//! Joints between the links.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

/// Kinds of joint between two links, Eq. 12 and 13.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Cross (Hooke) joint: second row of Eq. 13, with a bend limit.
    Universal,
    /// Constant velocity: both ends spin at the same rate at any bend, with a bend limit.
    BallCage,
    /// Both rows of Eq. 13 as equalities: a hinge with one free axis, for comparison only.
    Revolute,
}

/// The angle theta in the third row of Eq. 13, for [`JointKind::Revolute`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HingeAngle {
    /// 90 degrees: links that are in line at rest.
    #[default]
    Straight,
    /// The angle of the undeflected tool in the well at spin zero: links keep the well's bend, which turns with them.
    AsBuilt,
}

/// All joints of the pipe.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointDescription {
    /// Which rows hold.
    pub kind: JointKind,
    /// Bend angle chi at which the stop begins (rad).
    pub limit: f64,
    /// Rotational stiffness of the stop (N m/rad).
    pub stop_stiffness: f64,
    /// Hunt-Crossley damping of the stop (s/rad).
    pub stop_damping: f64,
    /// Phase of the first joint's cross about the shaft (rad).
    pub cross_phase: f64,
    /// Turn of the cross from one joint to the next (rad).
    pub cross_phase_step: f64,
    /// Theta of Eq. 13 for [`JointKind::Revolute`].
    pub hinge_angle: HingeAngle,
    /// Friction in the pins of the cross; of [`JointKind::Universal`] only.
    pub friction: PinFriction,
    /// Play about the shaft; not of [`JointKind::Revolute`].
    pub play: JointPlay,
}

/// Friction in the pins of a cross, in `elements/joint/friction.rs`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PinFriction {
    /// Coefficient of friction (-); 0 is no friction.
    pub coefficient: f64,
    /// Radius of a pin (m).
    pub pin_radius: f64,
    /// Diameter of the circle on which the pins carry the torque (m).
    pub circle_diameter: f64,
    /// Rate of swing at which the regularised friction reaches 71 % of Coulomb's (rad/s).
    pub slip_rate: f64,
}

impl PinFriction {
    /// No friction; pins of 12 mm on a circle of 40 mm that slide from 0.02 rad/s on.
    pub const NONE: Self = Self {
        coefficient: 0.0,
        pin_radius: 6e-3,
        circle_diameter: 0.04,
        slip_rate: 0.02,
    };
}

/// Play of a joint about its shaft, in `elements/joint/play.rs`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct JointPlay {
    /// Half of the angle by which the links turn freely against each other (rad); 0 is a constraint.
    pub half_angle: f64,
    /// Stiffness of the contact at either end of the play (N m/rad).
    pub stiffness: f64,
    /// Its Hunt-Crossley damping (s/rad).
    pub damping: f64,
}

impl JointPlay {
    /// No play; contacts of 1e6 N m/rad if there is any.
    pub const NONE: Self = Self {
        half_angle: 0.0,
        stiffness: 1e6,
        damping: 0.5,
    };
}

impl JointDescription {
    /// Joints of one kind that bend up to `limit` (rad), with the stop of the paper's case and crosses that turn by 90
    /// degrees from joint to joint.
    #[must_use]
    pub const fn new(kind: JointKind, limit: f64) -> Self {
        Self {
            kind,
            limit,
            stop_stiffness: 2e5,
            stop_damping: 0.5,
            cross_phase: 0.0,
            cross_phase_step: FRAC_PI_2,
            hinge_angle: HingeAngle::Straight,
            friction: PinFriction::NONE,
            play: JointPlay::NONE,
        }
    }
}
