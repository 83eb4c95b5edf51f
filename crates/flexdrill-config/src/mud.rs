//! `environment.mud`: the mud that moves with pipe and guide.

use super::Schema;
use super::checker::Checker;
use super::json_schema;
use super::section::section;
use flexdrill_core::tool::{AddedMass, MudDamping, MudDescription, MudFilm};

section! {
    /// Mud between pipe and guide and between guide and wall: it moves with them, and its viscosity damps them. Its
    /// buoyancy is in `environment.buoyancy_factor`.
    #[derive(Copy)]
    pub struct Mud(this) {
        /// Density (kg/m3). The default is water-based mud, to which the default buoyancy factor belongs.
        density: f64 = 1100.0, within(1.0, 3000.0), "kg/m3", "1.2 is air, 2400 a heavily weighted mud";
        /// Dynamic viscosity (Pa s), of a mud that thins with shear at the shear rate of the motion. The default is
        /// usual for a light water-based mud.
        viscosity: f64 = 0.02, within(0.0, 10.0), "Pa s", "0 is ideal fluid, water has 0.001, a thick gel up to 1";
        /// Frequency of the motion whose damping and added mass by viscosity are taken (Hz). The default is two per turn
        /// at 40 r/min, at which crosses shake the pipe and a pipe that rolls in the guide may whirl. A lower frequency
        /// gives more mass and less damping.
        frequency: f64 = 4.0 / 3.0, within(0.01, 1e4), "Hz",
            "slower than 0.01 Hz nothing vibrates; a collision lasts 1e-3 s";
        /// Mass of the mud that moves with the pipes: `none`, `concentric` (as with small motion about the centre of
        /// both annuli) or `eccentric` (more near the walls, up to twice as much). It couples pipe and guide.
        #[schemars(with = "json_schema::AddedMass")]
        added_mass: AddedMass = AddedMass::Concentric;
        /// Damping by viscosity: `none`, or `viscous` (proportional to the velocity of pipe against guide and of guide
        /// against wall); with `viscous` viscosity adds to the mass too.
        #[schemars(with = "json_schema::MudDamping")]
        damping: MudDamping = MudDamping::Viscous;
        /// Film of a body near its wall: `none` (the damping about the centre), or `squeeze` (the full film of
        /// lubrication, which resists a body that squeezes it out).
        #[schemars(with = "json_schema::MudFilm")]
        film: MudFilm = MudFilm::None;
    }
}

impl Mud {
    pub(super) fn check(&self, c: &mut Checker, schema: &Schema) {
        self.check_numbers(c);
        self.check_film(c);
        let bore = schema.tool.guide.inner_diameter;
        let sections = schema.tool.pipe.element_sections(schema.tool.elements_per_link);
        let widest = sections.iter().map(|tube| tube.outer_diameter).fold(0.0, f64::max);
        c.require(
            widest < bore,
            "added_mass",
            "given",
            "",
            format!("left out with all of environment.mud, or tool.pipe at most {bore} m wide (it is {widest} m)"),
            "there is no mud between a pipe and a guide (tool.guide.inner_diameter) that is narrower",
        );
    }

    fn check_film(&self, c: &mut Checker) {
        c.require(
            self.film == MudFilm::None || self.viscosity > 0.0,
            "film",
            "squeeze",
            "",
            "none, or environment.mud.viscosity above 0",
            "a fluid without viscosity has no film",
        );
    }

    pub(super) fn describe(&self) -> MudDescription {
        MudDescription {
            density: self.density,
            viscosity: self.viscosity,
            frequency: self.frequency,
            added_mass: self.added_mass,
            damping: self.damping,
            film: self.film,
        }
    }
}
