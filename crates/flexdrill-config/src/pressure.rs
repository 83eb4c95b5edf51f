//! `environment.pressure`: the pump's pressure in the pipe.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Schema;
use super::boundary::{BottomAxial, Preset};
use super::checker::{Bound, Checker};
use flexdrill_core::tool::{
    Body, Direction, Location, PressureDescription, PressureEnd, PressureSource, Tube, WobPath,
};

/// Three times what the pumps of a drilling rig give.
const AT_TOP: Bound = Bound::within(0.0, 100e6);
const DROP: Bound = Bound::within(0.0, f64::INFINITY);
const DIAMETER: Bound = Bound::above(0.0, 2.0);
const DIAMETER_REASON: &str = "given in metres";

/// The pump's pressure in the pipe, inside less outside: effective tension and the force on the lower end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pressure {
    /// Pressure at the top of the tool: `standpipe`, the input, or a constant in Pa. Default standpipe.
    ///
    /// Allowed: within 0 to 1e8 Pa
    #[serde(default)]
    pub at_top: AtTop,
    /// Share of that pressure which friction of the mud takes per length of the tool (1/m). Default 0. At most what leaves
    /// nothing at the lower end.
    #[serde(default)]
    #[schemars(transform = DROP.in_schema())]
    pub drop_per_metre: f64,
    /// Lower end of the pipe: `closed` (free along the axis, the bit hangs on the pipe), `sealed` (it slides in a seal of
    /// `seal_diameter`) or `held` (by the guide or a support). Required.
    #[serde(default)]
    pub end: Option<End>,
    /// Diameter of the seal in which a `sealed` end slides (m). Required for it.
    #[serde(default)]
    #[schemars(transform = DIAMETER.in_schema())]
    pub seal_diameter: Option<f64>,
    /// Diameter at which the joints are sealed, usually their ball's (m): what their pins carry. Default: the pipe's bore.
    #[serde(default)]
    #[schemars(transform = DIAMETER.in_schema())]
    pub joint_seal_diameter: Option<f64>,
}

/// `standpipe`, or a number in Pa.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(transform = AT_TOP.in_schema())]
pub enum AtTop {
    /// The input.
    Input(Standpipe),
    /// In Pa.
    Constant(f64),
}

/// The word for the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Standpipe {
    /// The standpipe's pressure.
    Standpipe,
}

impl Default for AtTop {
    fn default() -> Self {
        Self::Input(Standpipe::Standpipe)
    }
}

/// What closes the pipe's lower end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// Closed and free along the axis.
    Closed,
    /// Slides in a seal.
    Sealed,
    /// Held along the axis.
    Held,
}

impl Pressure {
    pub(super) fn check(&self, c: &mut Checker, schema: &Schema) {
        // A pressure that comes as an input has no constant to check here; its range is that of the input.
        if let AtTop::Constant(at_top) = self.at_top {
            c.number("at_top", at_top, AT_TOP, "Pa", "in Pa; a rig's pumps give up to 35e6");
        }
        // The drop may at most use up the whole pressure over the length of the tool.
        let most = Bound::within(0.0, 1.0 / schema.well.length());
        c.number(
            "drop_per_metre",
            self.drop_per_metre,
            most,
            "1/m",
            "friction cannot take more than there is: one over the tool's length",
        );
        // Without diameters the tool's own apply.
        for (key, diameter) in [
            ("seal_diameter", self.seal_diameter),
            ("joint_seal_diameter", self.joint_seal_diameter),
        ] {
            if let Some(diameter) = diameter {
                c.number(key, diameter, DIAMETER, "m", DIAMETER_REASON);
            }
        }
        // There is no safe default: on a closed, a sealed and a held end the pressure exerts different forces.
        let Some(end) = self.end else {
            let bound = "closed, sealed or held";
            let reason = "without an end condition a pressure has no effective tension; ask for the tool's drawing";
            return c.wrong("end", "left out", "", bound, reason);
        };
        // The diameter belongs to one end condition. Elsewhere it would be ignored, and its author would not notice.
        c.require(
            (end == End::Sealed) == self.seal_diameter.is_some(),
            "seal_diameter",
            self.seal_diameter
                .map_or("left out".to_owned(), |diameter| diameter.to_string()),
            "",
            "given with end sealed and only with it",
            "the pressure pushes a sliding end up by its seal's area",
        );
        // The end condition must repeat what the supports say, so that a change
        // of one does not silently change the pressure's force.
        let held = schema.holds_pipe_end();
        let name = if held { "held" } else { "closed or sealed" };
        c.require(
            (end == End::Held) == held,
            "end",
            match end {
                End::Closed => "closed",
                End::Sealed => "sealed",
                End::Held => "held",
            },
            "",
            name,
            "boundary.wob_path, bottom_axial and supports decide whether the pipe's lower end is held along the axis",
        );
    }

    pub(super) fn describe(&self, sections: &[Tube]) -> PressureDescription {
        let bore = sections.last().map_or(0.0, |tube| tube.inner_diameter);
        PressureDescription {
            at_top: match self.at_top {
                AtTop::Input(_) => PressureSource::Standpipe,
                AtTop::Constant(pressure) => PressureSource::Constant(pressure),
            },
            drop_per_metre: self.drop_per_metre,
            end: match (self.end, self.seal_diameter) {
                (Some(End::Sealed), Some(diameter)) => PressureEnd::Sealed { diameter },
                (Some(End::Held), _) => PressureEnd::Held,
                _ => PressureEnd::Closed,
            },
            joint_seal_diameter: self.joint_seal_diameter.unwrap_or(bore),
        }
    }
}

impl Schema {
    /// Whether the pipe's lower end is held along the axis.
    fn holds_pipe_end(&self) -> bool {
        let (mesh, boundary) = (self.mesh(), &self.boundary);
        let last = Location::Station(mesh.last_station());
        let by_support = boundary.supports.iter().any(|held| {
            let at = held.at.location(&mesh);
            let at_end = matches!(at, Location::Bottom | Location::All) || at == last;
            at_end && held.body == Body::Pipe && held.fix.contains(&Direction::U)
        });
        let by_preset = boundary.preset == Preset::Paper && boundary.bottom_axial == BottomAxial::Fixed;
        boundary.wob_path == WobPath::Shared || by_preset || by_support
    }
}
