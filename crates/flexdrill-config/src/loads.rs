//! `loads` and `masses`: what acts on single nodes.

use schemars::transform::Transform;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker, number};
use super::json_schema;
use super::place::{At, Mesh};
use flexdrill_core::tool::{Body, Direction, LoadHistory, PointLoad, PointMass};
use flexdrill_core::units::deg_to_rad;

const FORCE: Bound = Bound::within(-1e9, 1e9);
const FORCE_REASON: &str = "in N or N m; more would break any tool";
const TIME: Bound = Bound::within(0.0, 1e6);
const TIME_REASON: &str = "seconds of model time since the start";
const FREQUENCY: Bound = Bound::within(0.0, 10_000.0);
const TURN: Bound = Bound::within(-360.0, 360.0);
/// Of masses (kg) and inertias (kg m2).
const MASS: Bound = Bound::within(0.0, 1e6);
const ECCENTRICITY: Bound = Bound::within(0.0, 1.0);

/// A force (N) or moment (N m) on one node, in the node's own frame. At a joint it acts on the end of the link above.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Location along the tool.
    pub at: At,
    /// `pipe` or `guide`.
    #[schemars(with = "json_schema::Body")]
    pub body: Body,
    /// Direction: u, v, w for forces (N), psi, phi_y, phi_z for moments (N m).
    #[schemars(with = "json_schema::Direction")]
    pub direction: Direction,
    /// Size of the load over time.
    pub history: History,
}

/// The history of a load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum History {
    /// `constant: 500`.
    Constant(#[schemars(transform = FORCE.in_schema())] f64),
    /// `ramp: {rate: 1000, start: 0, end: 1}`: grows from `start` (s) to `end` (s), then remains constant.
    Ramp {
        /// Rate of the ramp (N/s or N m/s).
        #[schemars(transform = FORCE.in_schema())]
        rate: f64,
        /// Beginning of the ramp (s). Default 0.
        #[serde(default)]
        #[schemars(transform = TIME.in_schema())]
        start: f64,
        /// End of the ramp (s).
        #[schemars(transform = TIME.in_schema())]
        end: f64,
    },
    /// `sine: {amplitude: 100, frequency: 2, phase_deg: 0}`.
    Sine {
        /// Amplitude of the sine (N or N m).
        #[schemars(transform = FORCE.in_schema())]
        amplitude: f64,
        /// Frequency of the sine (Hz).
        #[schemars(transform = FREQUENCY.in_schema())]
        frequency: f64,
        /// Phase of the sine at time zero. Default 0.
        #[serde(default)]
        #[schemars(transform = TURN.in_schema())]
        phase_deg: f64,
    },
    /// `table: [[0, 0], [1, 500]]`: linear between points (s, N or N m), constant outside.
    Table(#[schemars(transform = table_bounds)] Vec<(f64, f64)>),
}

/// A rigid body added to one node, axisymmetric except for its unbalance. At a joint it is on the end of the link
/// above.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mass {
    /// Location along the tool.
    pub at: At,
    /// `pipe` or `guide`.
    #[schemars(with = "json_schema::Body")]
    pub body: Body,
    /// Mass (kg).
    #[schemars(transform = MASS.in_schema())]
    pub mass: f64,
    /// Moment of inertia about the axis (kg m2). Default 0.
    #[serde(default)]
    #[schemars(transform = MASS.in_schema())]
    pub inertia: f64,
    /// Moment of inertia about a diameter (kg m2). Default half of `inertia`, as for a thin disc.
    #[serde(default)]
    #[schemars(transform = MASS.in_schema())]
    pub transverse_inertia: Option<f64>,
    /// Distance of the centre of mass from the axis (m): the unbalance m e turns with the pipe. Default 0.
    #[serde(default)]
    #[schemars(transform = ECCENTRICITY.in_schema())]
    pub eccentricity: f64,
    /// Angle of the centre of mass at spin zero, from the node's y axis (horizontal) towards its z axis (low side).
    /// Default 0.
    #[serde(default)]
    #[schemars(transform = TURN.in_schema())]
    pub eccentricity_phase_deg: f64,
}

/// Bounds of the (time, value) pairs of a table.
fn table_bounds(schema: &mut Schema) {
    for (index, bound) in [TIME, FORCE].into_iter().enumerate() {
        let column = schema.pointer_mut(&format!("/items/prefixItems/{index}"));
        if let Some(Ok(column)) = column.map(<&mut Schema>::try_from) {
            bound.in_schema().transform(column);
        }
    }
}

impl Load {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        self.at.check(c, mesh);
        c.below("history", |c| self.history.check(c));
    }

    pub(super) fn describe(&self, mesh: &Mesh) -> PointLoad {
        PointLoad {
            location: self.at.location(mesh),
            body: self.body,
            direction: self.direction,
            history: self.history.describe(),
        }
    }
}

impl History {
    fn check(&self, c: &mut Checker) {
        match self {
            Self::Constant(value) => c.number("constant", *value, FORCE, "N or N m", FORCE_REASON),
            // Names of the variants are part of the path, so that the error shows the key as the file has it.
            Self::Ramp { rate, start, end } => c.below("ramp", |c| {
                c.number("rate", *rate, FORCE, "N/s or N m/s", FORCE_REASON);
                c.number("start", *start, TIME, "s", TIME_REASON);
                c.number("end", *end, TIME, "s", TIME_REASON);
                let bound = format!("after start, {} s", number(*start));
                // A ramp without a duration would be a jump.
                c.require(
                    end > start,
                    "end",
                    number(*end),
                    "s",
                    bound,
                    "the ramp would have no time to grow",
                );
            }),
            Self::Sine {
                amplitude,
                frequency,
                phase_deg,
            } => c.below("sine", |c| {
                c.number("amplitude", *amplitude, FORCE, "N or N m", FORCE_REASON);
                let reason = "the step could not follow a faster one";
                c.number("frequency", *frequency, FREQUENCY, "Hz", reason);
                c.number("phase_deg", *phase_deg, TURN, "deg", "one turn");
            }),
            Self::Table(points) => c.below("table", |c| {
                c.require(!points.is_empty(), "", "[]", "", "at least one [time, value] pair", "");
                // Minus infinity before the first pair makes the first comparison true.
                let mut before = f64::NEG_INFINITY;
                for (index, &(time, value)) in points.iter().enumerate() {
                    c.below(index, |c| {
                        c.number("0", time, TIME, "s", TIME_REASON);
                        c.number("1", value, FORCE, "N or N m", FORCE_REASON);
                        let bound = format!("after the pair before, {} s", number(before));
                        // Equal times would leave the value between two pairs undefined.
                        c.require(time > before, "0", number(time), "s", bound, "times must increase");
                    });
                    before = time;
                }
            }),
        }
    }

    fn describe(&self) -> LoadHistory {
        match self {
            Self::Constant(value) => LoadHistory::Constant(*value),
            Self::Ramp { rate, start, end } => LoadHistory::Ramp {
                rate: *rate,
                start: *start,
                end: *end,
            },
            Self::Sine {
                amplitude,
                frequency,
                phase_deg,
            } => LoadHistory::Sine {
                amplitude: *amplitude,
                frequency: *frequency,
                phase: deg_to_rad(*phase_deg),
            },
            Self::Table(points) => LoadHistory::Table(points.clone()),
        }
    }
}

impl Mass {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        self.at.check(c, mesh);
        c.number("mass", self.mass, MASS, "kg", "a mass on a node is not negative");
        let reason = "an inertia on a node is not negative";
        c.number("inertia", self.inertia, MASS, "kg m2", reason);
        if let Some(transverse) = self.transverse_inertia {
            c.number("transverse_inertia", transverse, MASS, "kg m2", reason);
            let least = 0.5 * self.inertia;
            c.require(
                transverse >= least,
                "transverse_inertia",
                number(transverse),
                "kg m2",
                format!("at least half of inertia, {} kg m2", number(least)),
                "a thin disc has half, any other body more; leave it out for a disc",
            );
        }
        let reason = "given in metres, of the order of the tool's diameter at most";
        c.number("eccentricity", self.eccentricity, ECCENTRICITY, "m", reason);
        let phase = self.eccentricity_phase_deg;
        c.number("eccentricity_phase_deg", phase, TURN, "deg", "one turn");
    }

    pub(super) fn describe(&self, mesh: &Mesh) -> PointMass {
        PointMass {
            location: self.at.location(mesh),
            body: self.body,
            mass: self.mass,
            axial_inertia: self.inertia,
            transverse_inertia: self.transverse_inertia.unwrap_or(0.5 * self.inertia),
            eccentricity: self.eccentricity,
            eccentricity_phase: deg_to_rad(self.eccentricity_phase_deg),
        }
    }
}
