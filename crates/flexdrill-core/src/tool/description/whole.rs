//! The whole tool, and what describes the effects that it may have, with their checks: an effect that is added is described here.

use serde::{Deserialize, Serialize};

use super::{
    BitDescription, Body, Direction, GapDescription, JointDescription, Location, Material, PointLoad, Rayleigh,
    RockLaw, StringDescription, Support, Tube, WallFrictionFactors, WeightPlace, WellDescription, WobPath,
};
use crate::tool::section::BentTube;
use crate::tool::well::WellPath;
use crate::validation::{Bound, ValidationError, require};
use flexdrill_base::Bends;

type Checked = Result<(), ValidationError>;

/// Everything the mechanics needs to know, in SI units and radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ToolDescription {
    /// The bore's centre line, from the kick-off (measured depth 0) on.
    pub well: WellDescription,
    /// Number of rigidly straight links of the flexible pipe.
    pub links: usize,
    /// Beam elements per link (the paper's five).
    pub elements_per_link: usize,
    /// Steel of both pipes.
    pub material: Material,
    /// Section of each element of a link, top to bottom; length `elements_per_link`. All links are alike.
    pub pipe_sections: Vec<Tube>,
    /// Outer diameter of the pipe where it meets the guide, per station of a link (m); length
    /// `elements_per_link + 1`. Decides the inner clearance, Eq. 27.
    pub pipe_contact_diameters: Vec<f64>,
    /// Section of the guide pipe.
    pub guide_section: Tube,
    /// Factor on the guide's bending stiffness (slotted guides are softer), dimensionless.
    pub guide_bending_factor: f64,
    /// Curvature of the guide as made; `None` where it is without stress in the path. Of a guide in pieces that of the piece
    /// at the bit.
    pub guide_free_curvature: Option<FreeCurvature>,
    /// Curvatures of the guide's pieces above it, where that is given; their bends have the same toolface.
    pub guide_bends: Bends,
    /// Curvature against its shape as made at which the slots of the guide close (1/m): beyond it the guide bends with the
    /// stiffness of the whole tube. `None` where they never do.
    pub guide_slots_close_at: Option<f64>,
    /// The guide's spine, where its slots leave one off the axis.
    pub guide_spine: Option<Spine>,
    /// Every guide node held in all six directions (the verification cases' fixed outer beam).
    pub guide_fixed: bool,
    /// Diameter of the bore (m), Eq. 31.
    pub hole_diameter: f64,
    /// The joints between links.
    pub joint: JointDescription,
    /// How the pipe's links shorten along the chord as they tilt across it.
    pub shortening: Shortening,
    /// Mass- and stiffness-proportional damping of both pipes, Eq. 7.
    pub rayleigh: Rayleigh,
    /// Gap layer between pipe and guide.
    pub inner: GapDescription,
    /// Gap layer between guide and wall.
    pub outer: GapDescription,
    /// Factors on the friction of the layer between guide and wall.
    pub wall_friction_factors: WallFrictionFactors,
    /// Speed at which the regularised friction reaches 71 % of Coulomb's (m/s).
    pub slip_speed: f64,
    /// The bit and its rock, Eq. 1.
    pub bit: BitDescription,
    /// How the rock answers the bit.
    pub rock: RockLaw,
    /// The string above the tool; without one the drive prescribes the spin of the first node.
    pub string: Option<StringDescription>,
    /// Acceleration of gravity along world +Z (m/s2), already reduced by the buoyancy factor.
    pub gravity: f64,
    /// Pump pressure in the pipe; `None` without flow.
    pub pressure: Option<PressureDescription>,
    /// The mud that moves with the pipes; `None` where it is in the gravity only.
    pub mud: Option<MudDescription>,
    /// Held directions, Table 1 and its variants.
    pub supports: Vec<Support>,
    /// Whether the spin of the first pipe node follows the drive's angle (else it is as `supports` say).
    pub drive_top: bool,
    /// How the weight on bit reaches the tool.
    pub wob_path: WobPath,
    /// Where the weight on bit of the inputs is measured.
    pub weight_place: WeightPlace,
    /// Loads over time, in addition to gravity, drive and bit.
    pub loads: Vec<PointLoad>,
    /// Point masses added to nodes.
    pub masses: Vec<PointMass>,
    /// Velocity of every pipe node at the start, in the station frame (m/s), for cases that start moving.
    pub initial_pipe_velocity: [f64; 3],
    /// Displacement of every pipe node at the start, in the station frame (m).
    pub initial_pipe_displacement: [f64; 3],
    /// Spin rate of the pipe at the start (rad/s).
    pub initial_spin_rate: f64,
    /// Whether the run starts from rest under gravity and the initial weight on bit.
    pub static_start: bool,
    /// With a start from rest: the guide has been slid into the hole, so that the friction of the wall is at its limit
    /// against an advance that has just ended. Needs [`FrictionLaw::Bristle`](super::FrictionLaw::Bristle) at the wall, which holds it.
    pub slid_in: bool,
}

/// Parameters that may change while the model runs; all others are fixed when it is built.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LiveParameters {
    /// Inner layer, mu_1 and mu_2.
    pub inner_friction: [f64; 2],
    /// Outer layer, mu_1 and mu_2, where [`ToolDescription::wall_friction_factors`] are 1.
    pub outer_friction: [f64; 2],
    /// eta of Eq. 1.
    pub bit_friction_factor: f64,
}

impl LiveParameters {
    /// The description's own values.
    #[must_use]
    pub fn of(description: &ToolDescription) -> Self {
        Self {
            inner_friction: [description.inner.friction_tangential, description.inner.friction_axial],
            outer_friction: [description.outer.friction_tangential, description.outer.friction_axial],
            bit_friction_factor: description.bit.friction_factor,
        }
    }

    /// Checks every coefficient: finite and not negative.
    ///
    /// # Errors
    /// As [`ToolDescription::validate`].
    pub fn validate(&self) -> Checked {
        let coefficients = [
            ("inner_friction[0]", self.inner_friction[0]),
            ("inner_friction[1]", self.inner_friction[1]),
            ("outer_friction[0]", self.outer_friction[0]),
            ("outer_friction[1]", self.outer_friction[1]),
            ("bit_friction_factor", self.bit_friction_factor),
        ];
        Bound::NotNegative.check_all("live", &coefficients, "")
    }
}

impl ToolDescription {
    /// Checks what a guide needs that is not without stress in the path, or whose slots close as it bends.
    pub(in crate::tool) fn check_guide(&self) -> Checked {
        if let Some(close_at) = self.guide_slots_close_at {
            Bound::Positive.check("guide_slots_close_at", close_at, "1/m")?;
            let needs_slots =
                "leave it out, or set guide_bending_factor below 1: a tube without slots has none that close";
            require(self.guide_bending_factor < 1.0, "guide_slots_close_at", needs_slots)?;
            require(
                !self.guide_fixed,
                "guide_slots_close_at",
                "a guide that is held at every node does not bend; leave it out or set guide_fixed to false",
            )?;
        }
        if let Some(spine) = self.guide_spine {
            let wall = Bound::Within(0.0, 0.5 * self.guide_section.outer_diameter);
            wall.check("guide_spine.offset", spine.offset, "m")?;
            Bound::Finite.check("guide_spine.phase", spine.phase, "rad")?;
            let needs_slots =
                "leave it out, or set guide_bending_factor below 1: a tube without slots bends about its axis";
            require(self.guide_bending_factor < 1.0, "guide_spine", needs_slots)?;
            require(
                !self.guide_fixed,
                "guide_spine",
                "a guide that is held at every node does not bend; leave it out or set guide_fixed to false",
            )?;
        }
        let Some(free) = self.guide_free_curvature else {
            return Ok(());
        };
        Bound::NotNegative.check("guide_free_curvature.curvature", free.curvature, "1/m")?;
        Bound::Finite.check("guide_free_curvature.phase", free.phase, "rad")?;
        self.guide_bends.check()?;
        require(
            !self.guide_fixed,
            "guide_free_curvature",
            "a guide that is held at every node does not bend; leave it out or set guide_fixed to false",
        )
    }

    /// The bend of the guide as made, its mean between two distances above the bit (m); `None` where it is without stress in
    /// the path.
    pub(crate) fn bend_above_bit(&self, [near, far]: [f64; 2]) -> Option<FreeCurvature> {
        self.guide_free_curvature.map(|free| FreeCurvature {
            curvature: self.guide_bends.mean(free.curvature, near, far),
            ..free
        })
    }

    /// A part of the guide of `length` (m, the chord's) between two nodes whose frames are turned by `turn` (rad) against each
    /// other, and which are at these distances above the bit (m). A guide without stress in the path was made with its
    /// curvature.
    pub(crate) fn bent_guide(&self, length: f64, turn: f64, above_bit: [f64; 2]) -> BentTube {
        let path = BentTube::path_curvature(length, turn);
        let free = self.bend_above_bit(above_bit).unwrap_or(FreeCurvature {
            curvature: path,
            phase: 0.0,
        });
        BentTube {
            length,
            path,
            made: free.curvature,
            phase: free.phase,
        }
    }

    /// Checks what acts along the pipes: the pressure in them and the mud around them.
    pub(in crate::tool) fn check_along_the_pipes(&self) -> Checked {
        if let Some(pressure) = &self.pressure {
            self.check_pressure(pressure)?;
        }
        self.mud.map_or(Ok(()), |mud| self.check_mud(&mud))
    }

    fn check_pressure(&self, pressure: &PressureDescription) -> Checked {
        if let PressureSource::Constant(at_top) = pressure.at_top {
            Bound::Finite.check("pressure.at_top", at_top, "Pa")?;
        }
        // Friction cannot take more than there is.
        let most = 1.0 / WellPath::new(&self.well).length();
        Bound::Within(0.0, most).check("pressure.drop_per_metre", pressure.drop_per_metre, "1/m")?;
        Bound::NotNegative.check("pressure.joint_seal_diameter", pressure.joint_seal_diameter, "m")?;
        if let PressureEnd::Sealed { diameter } = pressure.end {
            Bound::NotNegative.check("pressure.end.diameter", diameter, "m")?;
        }
        let held = self.wob_path == WobPath::Shared || self.holds_pipe_end();
        require(
            held == (pressure.end == PressureEnd::Held),
            "pressure.end",
            "held goes with wob_path shared or a support that holds u of the pipe's lower end; closed and sealed ends are \
             free along the axis",
        )
    }

    fn check_mud(&self, mud: &MudDescription) -> Checked {
        Bound::Positive.check("mud.density", mud.density, "kg/m3")?;
        Bound::NotNegative.check("mud.viscosity", mud.viscosity, "Pa s")?;
        Bound::Positive.check("mud.frequency", mud.frequency, "Hz")?;
        // The mud is between pipe and guide along the whole link, not only where they can touch.
        let widest = self
            .pipe_sections
            .iter()
            .map(|tube| tube.outer_diameter)
            .fold(0.0, f64::max);
        Bound::Over(widest).check("guide_section.inner_diameter", self.guide_section.inner_diameter, "m")
    }

    /// Whether a support holds the pipe's lower end along the axis.
    fn holds_pipe_end(&self) -> bool {
        let last = Location::Station(self.links * self.elements_per_link);
        self.supports.iter().any(|support| {
            let at_end = matches!(support.location, Location::Bottom | Location::All) || support.location == last;
            at_end && support.body == Body::Pipe && support.directions.contains(&Direction::U)
        })
    }

    /// Bodies on nodes: those that are described, then the inertia of the bit, which acts against its spin and has no weight here.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = PointMass> {
        let of_bit = (self.bit.inertia > 0.0).then_some(PointMass {
            location: Location::Bottom,
            body: Body::Pipe,
            mass: 0.0,
            axial_inertia: self.bit.inertia,
            // That of a thin disc: the smallest ratio that a body can have.
            transverse_inertia: 0.5 * self.bit.inertia,
            eccentricity: 0.0,
            eccentricity_phase: 0.0,
        });
        self.masses.iter().copied().chain(of_bit)
    }

    /// Inertia at the pipe's lower end about its axis (kg m2).
    pub(crate) fn inertia_at_end(&self) -> f64 {
        self.bit.inertia
    }

    /// Checks the bodies on nodes.
    pub(in crate::tool) fn check_at_nodes(&self) -> Checked {
        for (index, mass) in self.masses.iter().enumerate() {
            self.validate_location(format!("masses[{index}].location"), mass.location)?;
            let field = |name: &str| format!("masses[{index}].{name}");
            Bound::NotNegative.check(&field("mass"), mass.mass, "kg")?;
            Bound::NotNegative.check(&field("axial_inertia"), mass.axial_inertia, "kg m2")?;
            // No body has less: its parts lie nearer to two diameters together than to the axis.
            let disc = Bound::Within(0.5 * mass.axial_inertia, f64::MAX);
            disc.check(&field("transverse_inertia"), mass.transverse_inertia, "kg m2")?;
            Bound::NotNegative.check(&field("eccentricity"), mass.eccentricity, "m")?;
            Bound::Finite.check(&field("eccentricity_phase"), mass.eccentricity_phase, "rad")?;
        }
        Ok(())
    }
}

/// The bend of a tube without load.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct FreeCurvature {
    /// Curvature (1/m), 0 where it is straight.
    pub curvature: f64,
    /// Toolface of the bend while the tube's spin is 0 (rad): the angle from the high side (-z) to the side that it
    /// bends to, positive towards +y.
    pub phase: f64,
}

/// The line of a slotted guide that carries its axial force, off the guide's axis; bending is about it. Thrust bends the guide
/// away from it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Spine {
    /// Distance from the axis (m).
    pub offset: f64,
    /// Toolface of the bend that thrust adds while the guide's spin is 0 (rad), as that of [`FreeCurvature`]: the spine lies
    /// on the other side of the axis.
    pub phase: f64,
}

/// How a tilted span of the pipe shortens along its chord, see `effects/shortening.rs`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shortening {
    /// Not at all: the elements are linear, as the paper's.
    #[default]
    None,
    /// By the square of the tilt.
    SecondOrder,
}

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

/// A rigid body added to a node, round but for its unbalance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointMass {
    /// Where.
    pub location: Location,
    /// On which pipe.
    pub body: Body,
    /// Mass (kg).
    pub mass: f64,
    /// Rotary inertia about the axis (kg m2).
    pub axial_inertia: f64,
    /// Rotary inertia about a diameter (kg m2); at least half of that about the axis, which is a thin disc's.
    pub transverse_inertia: f64,
    /// Distance of its centre of mass from the axis (m).
    pub eccentricity: f64,
    /// Angle of its centre of mass at spin zero, from the node's y axis towards its z axis (rad).
    pub eccentricity_phase: f64,
}
