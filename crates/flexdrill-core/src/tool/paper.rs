//! The paper's case: Lin, Luo, Wang, Xiu, Li, "Research on the dynamic behavior of flexible drilling tools in
//! ultrashort-radius radial horizontal wells", Scientific Reports 2024.
//!
//! The paper prints the well (R = 3.2 m, 0 to 90 degrees), five elements per link, eta = 0.235 and the bit's 118 mm.
//! All other values are assumed. `config/default.yaml` has the same numbers with their reasons; a test compares the
//! two.

use super::{
    BitDescription, Body, Direction, GapDescription, JointDescription, JointKind, Location, Material, Rayleigh,
    RockLaw, Shortening, Support, ToolDescription, Tube, WallFrictionFactors, WeightPlace, WellDescription,
    WellSection, WobPath,
};
use crate::units::deg_to_rad;
use flexdrill_base::Bends;

/// Gravity (m/s2) times the buoyancy factor 1 - 1100 / 7850 of water-based mud.
const GRAVITY_IN_MUD: f64 = 9.81 * 0.86;

impl ToolDescription {
    /// The paper's tool in the paper's well, with plausible values where the paper has none; equal to the description
    /// in `config/default.yaml`. A similar tool differs from it in some fields:
    ///
    /// ```
    /// use flexdrill_core::tool::ToolDescription;
    ///
    /// let softer = ToolDescription::paper().with(|tool| tool.guide_bending_factor = 0.05);
    /// assert_eq!(softer.links, 33);
    /// ```
    #[must_use]
    pub fn paper() -> Self {
        let pipe = Tube {
            outer_diameter: 0.063,
            inner_diameter: 0.032,
        };
        let elements_per_link = 5;
        // Printed by the paper: the well, five elements per link, eta and the bit. Everything else is assumed.
        Self {
            well: WellDescription {
                start_inclination: 0.0,
                sections: vec![WellSection::Arc {
                    radius: 3.2,
                    angle: deg_to_rad(90.0),
                }],
            },
            links: 33,
            elements_per_link,
            material: Material::STEEL,
            pipe_sections: vec![pipe; elements_per_link],
            pipe_contact_diameters: vec![pipe.outer_diameter; elements_per_link + 1],
            guide_section: Tube {
                outer_diameter: 0.102,
                inner_diameter: 0.080,
            },
            guide_bending_factor: 1.0,
            guide_free_curvature: None,
            guide_bends: Bends::default(),
            guide_slots_close_at: None,
            guide_spine: None,
            guide_fixed: false,
            hole_diameter: 0.118,
            joint: JointDescription::new(JointKind::Universal, deg_to_rad(6.0)),
            shortening: Shortening::None,
            rayleigh: Rayleigh { alpha: 2.0, beta: 1e-4 },
            // Contact stiffness and friction are assumed; `config/default.yaml` has the reasons.
            inner: GapDescription::new(1e7, 0.2),
            outer: GapDescription::new(2e7, 0.3),
            wall_friction_factors: WallFrictionFactors::ONE,
            slip_speed: 0.01,
            bit: BitDescription::new(0.118, 0.235),
            rock: RockLaw::Paper,
            string: None,
            gravity: GRAVITY_IN_MUD,
            pressure: None,
            mud: None,
            supports: table_1(),
            drive_top: true,
            wob_path: WobPath::Guide,
            weight_place: WeightPlace::Bit,
            loads: Vec::new(),
            masses: Vec::new(),
            initial_pipe_velocity: [0.0; 3],
            initial_pipe_displacement: [0.0; 3],
            initial_spin_rate: 0.0,
            static_start: true,
            slid_in: false,
        }
    }

    /// A tool of `links` equal links of `pipe` inside `guide`, which fill the well from end to end. All else is as in
    /// [`ToolDescription::paper`]: five elements per link, universal joints, steel, the supports of Table 1, the drive
    /// at the top, a bit of 118 mm.
    ///
    /// ```
    /// use flexdrill_core::tool::{ToolDescription, Tube, WellDescription, WellSection};
    ///
    /// let well = WellDescription {
    ///     start_inclination: 0.0,
    ///     sections: vec![WellSection::Arc { radius: 2.0, angle: 1.2 }, WellSection::Straight { length: 0.6 }],
    /// };
    /// let pipe = Tube { outer_diameter: 0.058, inner_diameter: 0.030 };
    /// let guide = Tube { outer_diameter: 0.098, inner_diameter: 0.076 };
    /// let tool = ToolDescription::new(well, 0.114, 20, pipe, guide).with(|tool| {
    ///     tool.bit.diameter = 0.114;
    ///     tool.joint.limit = 0.14;
    /// });
    /// tool.validate()?;
    /// # Ok::<(), flexdrill_core::validation::ValidationError>(())
    /// ```
    #[must_use]
    pub fn new(well: WellDescription, hole_diameter: f64, links: usize, pipe: Tube, guide: Tube) -> Self {
        let paper = Self::paper();
        let elements_per_link = paper.elements_per_link;
        Self {
            well,
            hole_diameter,
            guide_section: guide,
            ..paper
        }
        .with_mesh(links, elements_per_link)
        .with_pipe(pipe)
    }

    /// The description after `change`.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// The same tool of `links` links with `elements_per_link` elements each, all elements with the section of the
    /// first and all stations with the contact diameter of the first: the lists per element and per station get the
    /// lengths they need.
    #[must_use]
    pub fn with_mesh(mut self, links: usize, elements_per_link: usize) -> Self {
        let pipe = self.pipe_sections.first().copied().unwrap_or_default();
        let contact = self.pipe_contact_diameters.first().copied().unwrap_or_default();
        self.links = links;
        self.elements_per_link = elements_per_link;
        self.pipe_sections = vec![pipe; elements_per_link];
        self.pipe_contact_diameters = vec![contact; elements_per_link + 1];
        self
    }

    /// The same tool with another pipe, alike over the whole link, that meets the guide with its outer diameter.
    #[must_use]
    pub fn with_pipe(mut self, pipe: Tube) -> Self {
        self.pipe_sections.fill(pipe);
        self.pipe_contact_diameters.fill(pipe.outer_diameter);
        self
    }
}

impl Material {
    /// Structural steel: 206 GPa, 0.3, 7850 kg/m3.
    pub const STEEL: Self = Self {
        youngs_modulus: 206e9,
        poisson_ratio: 0.3,
        density: 7850.0,
    };
}

/// Table 1 of the paper: u, v, w of both pipes held at the top, v, w of both at the bottom, where the text lets the end
/// move axially.
fn table_1() -> Vec<Support> {
    use Direction::{U, V, W};
    let mut supports = Vec::new();
    for (location, directions) in [(Location::Top, vec![U, V, W]), (Location::Bottom, vec![V, W])] {
        for body in [Body::Pipe, Body::Guide] {
            supports.push(Support {
                location,
                body,
                directions: directions.clone(),
            });
        }
    }
    supports
}
