//! `contact`: the two gap layers.

use serde::Deserialize;

use super::checker::{Bound, Checker};
use super::json_schema;
use super::section::section;
use flexdrill_core::tool::{FrictionLaw, GapDescription, HoleInterval, WallFrictionFactors as Factors};

/// Sliding speeds of the regularisation (m/s).
const SLIP_SPEED: Bound = Bound::within(1e-6, 1.0);
/// Why they are limited.
const SLIP_SPEED_REASON: &str = "0 would make friction jump at standstill; above 1 m/s it hardly holds anything";

section! {
    /// Contact between pipe and guide and between guide and wall.
    #[derive(Copy)]
    pub struct Contact(this) {
        /// Contact of the pipe with the guide, steel on steel.
        #[serde(deserialize_with = "inner_layer")]
        inner: Layer = Layer::INNER, below;
        /// Contact of the guide with the wall, steel on rock.
        #[serde(deserialize_with = "outer_layer")]
        outer: Layer = Layer::OUTER, below;
        /// Factors on the friction of the guide on the wall (`contact.outer.friction_tangential` and `friction_axial`), by
        /// the interval of the hole in which a station lies. A station carries the contact of half an element on either
        /// side of it: where a boundary lies within, its factor is the mean of both intervals by length.
        wall_friction_factors: WallFrictionFactors = WallFrictionFactors::default(), below;
        /// Sliding speed at which the regularised friction reaches 71 % of the Coulomb friction (m/s). A smaller value
        /// is closer to Coulomb's law and needs more iterations.
        slip_speed: f64 = 0.01, within(1e-6, 1.0), "m/s",
            "0 would make friction jump at standstill; above 1 m/s it hardly holds anything";
    }
}

section! {
    /// Factors on the friction of the guide on the wall by interval of the hole.
    #[derive(Copy)]
    pub struct WallFrictionFactors(this) {
        /// In straight sections before the first arc, and in all of a hole without arcs. Default 1.
        before_arc: f64 = 1.0, within(0.0, 100.0), "", "0 is without friction; no wall rubs a hundred times as much";
        /// In the arcs. Default 1.
        arc: f64 = 1.0, within(0.0, 100.0), "", "0 is without friction; no wall rubs a hundred times as much";
        /// In straight sections after the first arc. Default 1.
        after_arc: f64 = 1.0, within(0.0, 100.0), "", "0 is without friction; no wall rubs a hundred times as much";
    }
}

impl WallFrictionFactors {
    /// The same friction all along the hole.
    pub(super) fn are_one(&self) -> bool {
        *self == Self::default()
    }

    pub(super) const fn describe(&self) -> Factors {
        Factors {
            before_arc: self.before_arc,
            arc: self.arc,
            after_arc: self.after_arc,
        }
    }

    /// The name of the key of an interval below `contact.wall_friction_factors`.
    pub const fn key(interval: HoleInterval) -> &'static str {
        match interval {
            HoleInterval::BeforeArc => "before_arc",
            HoleInterval::Arc => "arc",
            HoleInterval::AfterArc => "after_arc",
        }
    }
}

section! {
    /// One gap layer.
    #[derive(Copy)]
    pub struct Layer(this) {
        /// Penalty stiffness per station (N/m). A larger value gives shorter collisions, which need a smaller step.
        /// Default 1e7 inner, 2e7 outer.
        stiffness: f64, within(0.0, 1e12), "N/m", "0 switches the layer off";
        /// Hunt-Crossley damping (s/m). A larger value reduces the rebound. Default 0.5.
        damping: f64, within(0.0, 1e3), "s/m",
            "0 is elastic; bodies here meet at well below 10 m/s, where 10 s/m is already dead";
        /// Coulomb friction coefficient around the circumference. Default 0.2 inner, 0.3 outer.
        friction_tangential: f64, within(0.0, 2.0), "", "dry surfaces stay below 1; 2 leaves room for trials";
        /// Coulomb friction coefficient along the axis. Default 0.2 inner, 0.3 outer.
        friction_axial: f64, within(0.0, 2.0), "", "dry surfaces stay below 1; 2 leaves room for trials";
        /// How friction follows from sliding: `separate` limits it around and along by themselves (the paper's Eq. 25),
        /// `vector` opposes the whole sliding velocity, `bristle` does so too and can stick. Default separate.
        #[schemars(with = "json_schema::FrictionLaw")]
        friction: FrictionLaw;
        /// Sliding speed of this layer at which the regularised friction reaches 71 % of the Coulomb friction (m/s).
        /// With `vector` choose at most a tenth of the slowest sliding that matters. Default `contact.slip_speed`.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = SLIP_SPEED.in_schema())]
        slip_speed: Option<f64>;
    }
}

impl Contact {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        for (key, layer) in [("inner", &self.inner), ("outer", &self.outer)] {
            let Some(speed) = layer.slip_speed else { continue };
            c.below(key, |c| {
                c.number("slip_speed", speed, SLIP_SPEED, "m/s", SLIP_SPEED_REASON);
                c.require(
                    layer.friction != FrictionLaw::Bristle,
                    "slip_speed",
                    speed,
                    "m/s",
                    "left out with friction: bristle",
                    "a bristle sticks and has no regularisation; use friction: vector for one",
                );
            });
        }
    }
}

/// What the file says of a layer; the rest depends on which layer it is.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PartialLayer {
    stiffness: Option<f64>,
    damping: Option<f64>,
    friction_tangential: Option<f64>,
    friction_axial: Option<f64>,
    friction: Option<FrictionLaw>,
    slip_speed: Option<f64>,
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
            friction: self.friction.unwrap_or(default.friction),
            slip_speed: self.slip_speed,
        }
    }
}

impl Layer {
    const INNER: Self = Self {
        stiffness: 1e7,
        damping: 0.5,
        friction_tangential: 0.2,
        friction_axial: 0.2,
        friction: FrictionLaw::Separate,
        slip_speed: None,
    };
    const OUTER: Self = Self {
        stiffness: 2e7,
        damping: 0.5,
        friction_tangential: 0.3,
        friction_axial: 0.3,
        friction: FrictionLaw::Separate,
        slip_speed: None,
    };

    pub(super) fn describe(&self) -> GapDescription {
        let mut gap = GapDescription::new(self.stiffness, self.friction_tangential);
        gap.friction_axial = self.friction_axial;
        gap.damping = self.damping;
        gap.friction_law = self.friction;
        gap.slip_speed = self.slip_speed;
        gap
    }
}
