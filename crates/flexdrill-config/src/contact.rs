//! `contact`: the two gap layers.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use flexdrill_core::tool::GapDescription;

/// Contact between pipe and guide and between guide and wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Contact {
    /// Pipe and guide, steel on steel.
    #[serde(deserialize_with = "inner_layer")]
    pub inner: Layer,
    /// Guide and wall, steel on rock.
    #[serde(deserialize_with = "outer_layer")]
    pub outer: Layer,
    /// Sliding speed at which the regularised friction reaches 71 % of Coulomb's (m/s). Default 0.01.
    pub slip_speed: f64,
}

impl Default for Contact {
    fn default() -> Self {
        Self {
            inner: Layer::INNER,
            outer: Layer::OUTER,
            slip_speed: 0.01,
        }
    }
}

/// One gap layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Layer {
    /// Per station (N/m). Default 1e7 inner, 2e7 outer.
    pub stiffness: f64,
    /// Hunt-Crossley (s/m). Default 0.5.
    pub damping: f64,
    /// Coulomb, around the circumference. Default 0.2 inner, 0.3 outer.
    pub friction_tangential: f64,
    /// Coulomb, along the axis. Default 0.2 inner, 0.3 outer.
    pub friction_axial: f64,
}

/// What the file says of a layer; the rest depends on which layer it is.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PartialLayer {
    stiffness: Option<f64>,
    damping: Option<f64>,
    friction_tangential: Option<f64>,
    friction_axial: Option<f64>,
}

fn inner_layer<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Layer, D::Error> {
    PartialLayer::deserialize(deserializer).map(|partial| partial.over(Layer::INNER))
}

fn outer_layer<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Layer, D::Error> {
    PartialLayer::deserialize(deserializer).map(|partial| partial.over(Layer::OUTER))
}

impl PartialLayer {
    fn over(self, default: Layer) -> Layer {
        Layer {
            stiffness: self.stiffness.unwrap_or(default.stiffness),
            damping: self.damping.unwrap_or(default.damping),
            friction_tangential: self.friction_tangential.unwrap_or(default.friction_tangential),
            friction_axial: self.friction_axial.unwrap_or(default.friction_axial),
        }
    }
}

impl Layer {
    const INNER: Self = Self {
        stiffness: 1e7,
        damping: 0.5,
        friction_tangential: 0.2,
        friction_axial: 0.2,
    };
    const OUTER: Self = Self {
        stiffness: 2e7,
        damping: 0.5,
        friction_tangential: 0.3,
        friction_axial: 0.3,
    };

    fn check(&self, c: &mut Checker) {
        let reason = "0 switches the layer off";
        c.number("stiffness", self.stiffness, Bound::within(0.0, 1e12), "N/m", reason);
        let reason = "0 is elastic; bodies here meet at well below 10 m/s, where 10 s/m is already dead";
        c.number("damping", self.damping, Bound::within(0.0, 1e3), "s/m", reason);
        let reason = "dry surfaces stay below 1; 2 leaves room for trials";
        c.number(
            "friction_tangential",
            self.friction_tangential,
            Bound::within(0.0, 2.0),
            "",
            reason,
        );
        c.number(
            "friction_axial",
            self.friction_axial,
            Bound::within(0.0, 2.0),
            "",
            reason,
        );
    }

    pub(super) fn describe(&self) -> GapDescription {
        GapDescription {
            stiffness: self.stiffness,
            damping: self.damping,
            friction_tangential: self.friction_tangential,
            friction_axial: self.friction_axial,
        }
    }
}

impl Contact {
    pub(super) fn check(&self, c: &mut Checker) {
        c.below("inner", |c| self.inner.check(c));
        c.below("outer", |c| self.outer.check(c));
        let reason = "0 would make friction jump at standstill; above 1 m/s it hardly holds anything";
        c.number("slip_speed", self.slip_speed, Bound::within(1e-6, 1.0), "m/s", reason);
    }
}
