//! What a description must satisfy before a model can be built from it.

use super::description::{
    Body, Direction, JointDescription, JointKind, LoadHistory, Location, Material, ToolDescription, Tube, WeightPlace,
    WellDescription, WellSection, WobPath,
};
use crate::validation::{Bound, ValidationError, count, length, require};

/// Most stations: a hundred times the paper's case; more is a slip of the pen, and its memory could not be had.
const MOST_STATIONS: usize = 20_000;

type Checked = Result<(), ValidationError>;

impl ToolDescription {
    /// Checks every field: finite, of the right sign, lists as long as the mesh needs, locations on the tool, nothing
    /// that contradicts something else. [`crate::twin::Simulation::new`] does it too.
    ///
    /// # Errors
    /// The first field that does not hold, with its value, bound and unit.
    pub fn validate(&self) -> Checked {
        self.validate_mesh()?;
        self.well.validate()?;
        self.material.validate()?;
        self.validate_sections()?;
        self.joint.validate()?;
        Bound::NotNegative.check("rayleigh.alpha", self.rayleigh.alpha, "1/s")?;
        Bound::NotNegative.check("rayleigh.beta", self.rayleigh.beta, "s")?;
        self.check_contact()?;
        Bound::NotNegative.check("gravity", self.gravity, "m/s2")?;
        self.check_along_the_pipes()?;
        self.validate_supports()?;
        self.validate_weight_place()?;
        self.check_lower_end()?;
        self.check_upper_end()?;
        self.validate_loads()?;
        self.validate_start()
    }

    fn validate_mesh(&self) -> Checked {
        count("links", self.links, 1, MOST_STATIONS)?;
        count("elements_per_link", self.elements_per_link, 1, MOST_STATIONS)?;
        let stations = self.links.saturating_mul(self.elements_per_link);
        count("links x elements_per_link", stations, 1, MOST_STATIONS)?;
        let per_element = "one per element of a link (elements_per_link)";
        length(
            "pipe_sections",
            self.pipe_sections.len(),
            self.elements_per_link,
            per_element,
        )?;
        let per_station = "one per station of a link (elements_per_link + 1)";
        let contacts = self.pipe_contact_diameters.len();
        length(
            "pipe_contact_diameters",
            contacts,
            self.elements_per_link + 1,
            per_station,
        )
    }

    fn validate_sections(&self) -> Checked {
        for (index, tube) in self.pipe_sections.iter().enumerate() {
            tube.validate(&format!("pipe_sections[{index}]"))?;
        }
        self.guide_section.validate("guide_section")?;
        for (index, &diameter) in self.pipe_contact_diameters.iter().enumerate() {
            Bound::Positive.check(&format!("pipe_contact_diameters[{index}]"), diameter, "m")?;
        }
        // The pipe turns in the guide, the guide lies in the hole, both with clearance.
        let widest = self.pipe_contact_diameters.iter().copied().fold(0.0, f64::max);
        Bound::Over(widest).check("guide_section.inner_diameter", self.guide_section.inner_diameter, "m")?;
        Bound::Over(self.guide_section.outer_diameter).check("hole_diameter", self.hole_diameter, "m")?;
        Bound::Positive.check("guide_bending_factor", self.guide_bending_factor, "")?;
        self.check_guide()
    }

    pub(super) fn validate_location(&self, field: String, location: Location) -> Checked {
        let (last_station, joints) = (self.links * self.elements_per_link, self.links - 1);
        let on_tool = match location {
            Location::Top | Location::Bottom | Location::All => true,
            Location::Station(station) => station <= last_station,
            Location::Joint(joint) => joint < joints,
        };
        if on_tool {
            Ok(())
        } else {
            Err(ValidationError::Location {
                field,
                location,
                last_station,
                joints,
            })
        }
    }

    fn validate_supports(&self) -> Checked {
        for (index, support) in self.supports.iter().enumerate() {
            let field = |name: &str| format!("supports[{index}].{name}");
            self.validate_location(field("location"), support.location)?;
            require(
                !support.directions.is_empty(),
                &field("directions"),
                "a support that holds no direction; name one or leave the support out",
            )?;
            let at_drive = matches!(support.location, Location::Top | Location::All | Location::Station(0));
            require(
                !(self.drive_top
                    && at_drive
                    && support.body == Body::Pipe
                    && support.directions.contains(&Direction::Psi)),
                &field("directions"),
                "psi of the driven node is held; leave psi out or set drive_top to false",
            )?;
        }
        Ok(())
    }

    /// The guide's reaction at the kick-off follows the weight at the bit only where nothing else carries it.
    fn validate_weight_place(&self) -> Checked {
        if self.weight_place == WeightPlace::Bit {
            return Ok(());
        }
        let last_station = self.links * self.elements_per_link;
        let holds = |station: usize| {
            let at = |location: Location| match location {
                Location::Top => station == 0,
                Location::Bottom => station == last_station,
                Location::Station(held) => held == station,
                Location::Joint(joint) => (joint + 1) * self.elements_per_link == station,
                Location::All => true,
            };
            self.supports.iter().any(|support| {
                support.body == Body::Guide && at(support.location) && support.directions.contains(&Direction::U)
            })
        };
        require(
            self.wob_path == WobPath::Guide,
            "weight_place",
            "the weight at the kick-off with wob_path shared, where the pipe carries a part of it; set wob_path to guide, or \
             weight_place to bit",
        )?;
        require(
            holds(0),
            "weight_place",
            "the weight at the kick-off of a guide whose top is not held along the axis; hold u of the guide at the top, or \
             set weight_place to bit",
        )?;
        require(
            !self.guide_fixed && !(1..=last_station).any(holds),
            "weight_place",
            "the weight at the kick-off of a guide that is held along the axis below it too; remove that support, or set \
             weight_place to bit",
        )
    }

    fn validate_loads(&self) -> Checked {
        for (index, load) in self.loads.iter().enumerate() {
            self.validate_location(format!("loads[{index}].location"), load.location)?;
            let unit = match load.direction {
                Direction::U | Direction::V | Direction::W => "N",
                Direction::Psi | Direction::PhiY | Direction::PhiZ => "N m",
            };
            load.history.validate(&format!("loads[{index}].history"), unit)?;
        }
        self.check_at_nodes()
    }

    fn validate_start(&self) -> Checked {
        for k in 0..3 {
            let (velocity, displacement) = (self.initial_pipe_velocity[k], self.initial_pipe_displacement[k]);
            Bound::Finite.check(&format!("initial_pipe_velocity[{k}]"), velocity, "m/s")?;
            Bound::Finite.check(&format!("initial_pipe_displacement[{k}]"), displacement, "m")?;
        }
        Bound::Finite.check("initial_spin_rate", self.initial_spin_rate, "rad/s")?;
        self.check_friction_at_rest()?;
        let moves = self.initial_pipe_velocity != [0.0; 3]
            || self.initial_pipe_displacement != [0.0; 3]
            || self.initial_spin_rate != 0.0;
        require(
            !(self.static_start && moves),
            "static_start",
            "a start from rest with an initial motion; set static_start to false or the initial values to 0",
        )
    }
}

impl WellDescription {
    /// Checks every section.
    ///
    /// # Errors
    /// As [`ToolDescription::validate`].
    pub fn validate(&self) -> Checked {
        Bound::Finite.check("well.start_inclination", self.start_inclination, "rad")?;
        if self.sections.is_empty() {
            return Err(ValidationError::Length {
                field: "well.sections".to_owned(),
                got: 0,
                expected: "at least 1".to_owned(),
            });
        }
        for (index, section) in self.sections.iter().enumerate() {
            let field = |name: &str| format!("well.sections[{index}].{name}");
            match section {
                WellSection::Straight { length } => Bound::Positive.check(&field("length"), *length, "m")?,
                WellSection::Arc { radius, angle } => {
                    Bound::Positive.check(&field("radius"), *radius, "m")?;
                    Bound::Positive.check(&field("angle"), *angle, "rad")?;
                }
                WellSection::Drilled { spacing, build, .. } => {
                    Bound::Positive.check(&field("spacing"), *spacing, "m")?;
                    if build.is_empty() {
                        return Err(ValidationError::Length {
                            field: field("build"),
                            got: 0,
                            expected: "at least 1".to_owned(),
                        });
                    }
                    for (point, build) in build.iter().enumerate() {
                        Bound::Finite.check(&field(&format!("build[{point}]")), *build, "1/m")?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Material {
    fn validate(&self) -> Checked {
        Bound::Positive.check("material.youngs_modulus", self.youngs_modulus, "Pa")?;
        Bound::Above(-1.0, 0.5).check("material.poisson_ratio", self.poisson_ratio, "")?;
        Bound::Positive.check("material.density", self.density, "kg/m3")
    }
}

impl Tube {
    fn validate(&self, under: &str) -> Checked {
        Bound::NotNegative.check(&format!("{under}.inner_diameter"), self.inner_diameter, "m")?;
        Bound::Over(self.inner_diameter).check(&format!("{under}.outer_diameter"), self.outer_diameter, "m")
    }
}

impl JointDescription {
    fn validate(&self) -> Checked {
        // A hinge has no stop.
        let limit = match self.kind {
            JointKind::Universal | JointKind::BallCage => Bound::Positive,
            JointKind::Revolute => Bound::NotNegative,
        };
        limit.check("joint.limit", self.limit, "rad")?;
        Bound::NotNegative.check("joint.stop_stiffness", self.stop_stiffness, "N m/rad")?;
        Bound::NotNegative.check("joint.stop_damping", self.stop_damping, "s/rad")?;
        let phases = [
            ("cross_phase", self.cross_phase),
            ("cross_phase_step", self.cross_phase_step),
        ];
        Bound::Finite.check_all("joint", &phases, "rad")?;
        self.validate_pins()
    }

    fn validate_pins(&self) -> Checked {
        let (friction, play) = (&self.friction, &self.play);
        Bound::NotNegative.check("joint.friction.coefficient", friction.coefficient, "")?;
        Bound::Positive.check("joint.friction.pin_radius", friction.pin_radius, "m")?;
        let least = if friction.coefficient > 0.0 {
            friction.pin_radius
        } else {
            0.0
        };
        Bound::Over(least).check("joint.friction.circle_diameter", friction.circle_diameter, "m")?;
        Bound::Positive.check("joint.friction.slip_rate", friction.slip_rate, "rad/s")?;
        require(
            friction.coefficient == 0.0 || self.kind == JointKind::Universal,
            "joint.friction.coefficient",
            "friction in the pins of a cross needs joint.kind universal; set joint.friction.coefficient to 0",
        )?;
        // Beyond a right angle the row would count the turn backwards.
        Bound::Within(0.0, 0.5).check("joint.play.half_angle", play.half_angle, "rad")?;
        Bound::Positive.check("joint.play.stiffness", play.stiffness, "N m/rad")?;
        Bound::NotNegative.check("joint.play.damping", play.damping, "s/rad")?;
        require(
            play.half_angle == 0.0 || self.kind != JointKind::Revolute,
            "joint.play.half_angle",
            "a hinge (joint.kind revolute) has no play in the model; set joint.play.half_angle to 0",
        )
    }
}

impl LoadHistory {
    fn validate(&self, under: &str, unit: &'static str) -> Checked {
        let field = |name: &str| format!("{under}.{name}");
        match self {
            Self::Constant(value) => Bound::Finite.check(under, *value, unit),
            Self::Ramp { rate, start, end } => {
                Bound::Finite.check(&field("rate"), *rate, if unit == "N" { "N/s" } else { "N m/s" })?;
                Bound::Finite.check(&field("start"), *start, "s")?;
                Bound::Over(*start).check(&field("end"), *end, "s")
            }
            Self::Sine {
                amplitude,
                frequency,
                phase,
            } => {
                Bound::Finite.check(&field("amplitude"), *amplitude, unit)?;
                Bound::NotNegative.check(&field("frequency"), *frequency, "Hz")?;
                Bound::Finite.check(&field("phase"), *phase, "rad")
            }
            Self::Table(points) => {
                if points.is_empty() {
                    return Err(ValidationError::Length {
                        field: under.to_owned(),
                        got: 0,
                        expected: "at least 1 point".to_owned(),
                    });
                }
                let mut before: Option<f64> = None;
                for (index, &(time, value)) in points.iter().enumerate() {
                    let later = before.map_or(Bound::Finite, Bound::Over);
                    later.check(&field(&format!("[{index}].time")), time, "s")?;
                    Bound::Finite.check(&field(&format!("[{index}].value")), value, unit)?;
                    before = Some(time);
                }
                Ok(())
            }
        }
    }
}
