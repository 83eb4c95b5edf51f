//! `string`: the drill string above the tool, top drive and hoist.

use std::f64::consts::FRAC_PI_2;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::section::section;
use super::tool::Material;
use flexdrill_core::tool::{
    Feed as CoreFeed, Hoist as CoreHoist, Piece, SectionProperties, SpeedController, StringDescription,
    TopDrive as CoreDrive, Tube, WallFriction,
};
use flexdrill_core::units::{deg_to_rad, sine_and_cosine};

/// Shortest section (m).
pub(super) const SHORTEST: f64 = 10.0;
/// Longest string (m): the longest wells have 15 km.
const LONGEST: f64 = 15_000.0;
/// Limits of a pull (kN).
const PULL: Bound = Bound::above(0.0, 20_000.0);
/// Why they are limited.
const PULL_REASON: &str = "leave it out where it is not known; the largest derricks lift 10,000 kN";
/// A wave travels through a piece in at least so many steps.
const LEAST_STEPS: f64 = 3.0;

/// What is between the rig and the tool.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// The speed asked for is prescribed at the tool's first link.
    #[default]
    None,
    /// Waves travel through `sections` between top drive and tool.
    Line,
    /// The speed is measured downhole, above the tool (`inputs.rotary_speed.measured: downhole`), and prescribed there.
    Measured,
}

section! {
    /// The drill string above the tool, up to top drive and hoist.
    pub struct DrillString(this) {
        /// Model: `none` (the speed is prescribed at the first link), `line` (waves travel between top drive and tool) or
        /// `measured` (the speed is measured above the tool). Default none.
        model: Model = Model::None;
        /// Sections of the string from the top drive down. Required with `line`.
        sections: Vec<Section> = Vec::new();
        /// Material. The defaults are those of steel.
        material: Material = Material::default(), below;
        /// Attenuation of torsional and axial waves: after 1 km the part e^-x is left. Steady rotation and advance lose nothing.
        attenuation_per_km: f64 = 0.0, within(0.0, 10.0), "", "10 leaves nothing of a wave after a kilometre";
        /// Friction of the string on the wall, where it is inclined.
        friction: Friction = Friction::default(), below;
        /// The top drive.
        top_drive: TopDrive = TopDrive::default(), below;
        /// Block, lines and auto-driller; in force with `rock.law: depth_of_cut`.
        hoist: Hoist = Hoist::default(), below;
        /// Largest hook load, without the block, that derrick, lines and the weakest pipe of the string allow (kN): by it
        /// `flexdrill trip` and the alarm `friction_near_stuck` judge what frees a stuck tool. Nothing of it acts on a run.
        /// Default not known.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = PULL.in_schema())]
        largest_pull_kn: Option<f64> = None;
        /// Largest tension of the guide at its top that its slots leave (kN), for the same. Default not known.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = PULL.in_schema())]
        largest_guide_pull_kn: Option<f64> = None;
    }
}

section! {
    /// A part of the string of one pipe.
    #[derive(Copy)]
    pub struct Section(this) {
        /// Length (m). Required.
        length: f64, within(10.0, 15000.0), "m", "a shorter part is part of its neighbour; the longest wells have 15 km";
        /// Outer diameter (m). Required.
        outer_diameter: f64, above(0.0, 1.0), "m", "given in metres";
        /// Inner diameter (m). Required.
        inner_diameter: f64, within(0.0, 1.0), "m", "given in metres";
        /// Inclination of the hole, 0 is vertical. Default 0.
        #[serde(default)]
        inclination_deg: f64, within(0.0, 120.0), "deg", "a hole that rises by more than 30 degrees is not drilled";
    }
}

section! {
    /// Coulomb friction of the string on the wall of the hole, by its weight there.
    #[derive(Copy)]
    pub struct Friction(this) {
        /// Coefficient of sliding. The default is the lower end of 0.25 to 0.40 measured in water-base mud (SPE 11380).
        coefficient: f64 = 0.25, within(0.0, 2.0), "", "wells have 0.1 to 0.5; 2 leaves room for trials";
        /// Friction of sticking and slow sliding over that of sliding.
        static_ratio: f64 = 1.0, within(1.0, 5.0), "", "a ratio below 1 would be a string that sticks less than it slides";
        /// Sliding speed up to which friction is static (m/s).
        static_speed: f64 = 0.01, within(0.0, 1.0), "m/s", "1 m/s is the surface of a 5 in pipe at 150 r/min";
        /// Longest part of the string whose friction and drag are lumped at one point (m).
        lump_length: f64 = 100.0, within(50.0, 1000.0), "m", "shorter parts cost time and change little";
    }
}

/// Tunings of the top drive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tuning {
    /// The drive keeps the speed asked for under any torque.
    Rigid,
    /// Speed controller with `proportional` and `integral` as given.
    #[default]
    Stiff,
    /// Speed controller that takes up torsional waves: its gains follow from the string's impedance and first mode.
    SoftTorque,
}

section! {
    /// The top drive: inertia, speed controller, torque limit.
    #[derive(Copy)]
    pub struct TopDrive(this) {
        /// Tuning: `rigid`, `stiff` or `soft_torque`. Default stiff.
        tuning: Tuning = Tuning::Stiff;
        /// Inertia of motor and gear, seen at the string (kg m2). The default is that of Aarsnes and Shor (2018).
        inertia: f64 = 2900.0, above(0.0, 1e5), "kg m2", "top drives have 500 to 5000";
        /// Proportional gain of `stiff` (N m s).
        proportional: f64 = 38e3, within(0.0, 1e7), "N m s", "0 is a drive without speed control";
        /// Integral gain of `stiff` (N m).
        integral: f64 = 100e3, within(0.0, 1e8), "N m", "0 leaves a lasting difference of speed";
        /// Proportional gain of `soft_torque` over the string's impedance: 1 takes up every wave.
        impedance_ratio: f64 = 4.0, within(0.5, 100.0), "", "below 1 the drive yields more than the string";
        /// Largest torque (N m).
        torque_limit: f64 = 20e3, above(0.0, 1e6), "N m", "top drives have 20 to 100 kN m";
    }
}

/// What the block is lowered by.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Feed {
    /// The auto-driller, towards the weight on bit asked for.
    #[default]
    Weight,
    /// The rate of penetration asked for.
    Rate,
}

section! {
    /// Block, lines and auto-driller.
    #[derive(Copy)]
    pub struct Hoist(this) {
        /// What the block is lowered by: `weight` (an auto-driller, towards the weight on bit asked for) or `rate` (the rate
        /// of penetration asked for). Default weight.
        feed: Feed = Feed::Weight;
        /// Stiffness of block, lines and derrick (N/m).
        stiffness: f64 = 5e6, within(1e4, 1e10), "N/m", "ten lines of 30 mm rope and 40 m have some 1e7";
        /// Response time of the auto-driller (s).
        response_time: f64 = 4.0, within(0.5, 120.0), "s", "faster than waves travel the weight would swing";
        /// Fastest lowering and raising of the block (m/h).
        fastest_m_per_h: f64 = 60.0, above(0.0, 3600.0), "m/h", "a metre per second is tripping, not drilling";
        /// Speed at which a bit without weight is lowered onto the rock, with `feed: weight` (m/h).
        touch_down_m_per_h: f64 = 10.0, above(0.0, 3600.0), "m/h", "a metre per second is tripping, not drilling";
        /// Distance by which the bit is lifted off bottom where no weight is asked for, with `feed: weight` (m).
        clearance: f64 = 0.01, within(0.0, 0.5), "m", "the tool's displacements count from where the hole ends";
    }
}

impl Section {
    fn tube(&self) -> Tube {
        Tube {
            outer_diameter: self.outer_diameter,
            inner_diameter: self.inner_diameter,
        }
    }

    fn properties(&self, string: &DrillString) -> SectionProperties {
        SectionProperties::of(self.tube(), string.material.describe(), 1.0)
    }

    /// Number of points at which friction on the wall and the mud's drag are lumped.
    fn lumps(&self, string: &DrillString) -> usize {
        let rubs = self.inclination_deg != 0.0 && string.friction.coefficient > 0.0;
        if !rubs && string.attenuation_per_km == 0.0 {
            return 0;
        }
        (self.length / string.friction.lump_length).ceil() as usize
    }
}

impl DrillString {
    pub(super) fn check(&self, c: &mut Checker, time_step: f64) {
        // Single numbers first: the sums and roots below need them in their ranges.
        self.check_numbers(c);
        for (key, limit) in [
            ("largest_pull_kn", self.largest_pull_kn),
            ("largest_guide_pull_kn", self.largest_guide_pull_kn),
        ] {
            if let Some(limit) = limit {
                c.number(key, limit, PULL, "kN", PULL_REASON);
            }
        }
        c.require(
            self.model != Model::Line || !self.sections.is_empty(),
            "sections",
            "[]",
            "",
            "at least one section with model: line",
            "waves need something to travel through",
        );
        // The bound is on the sum: it is the length of the well.
        let length: f64 = self.sections.iter().map(|section| section.length).sum();
        c.require(
            length <= LONGEST,
            "sections",
            length,
            "m in all",
            format!("at most {LONGEST} m"),
            "the longest wells have 15 km",
        );
        c.below("sections", |c| {
            for (index, section) in self.sections.iter().enumerate() {
                c.below(index, |c| {
                    section.check_numbers(c);
                    c.require(
                        section.inner_diameter < section.outer_diameter,
                        "inner_diameter",
                        section.inner_diameter,
                        "m",
                        format!("below the outer diameter, {} m", section.outer_diameter),
                        "a pipe has a wall",
                    );
                    // Friction and damping are lumped between pieces, so the pieces are shorter than the section.
                    let lumps = section.lumps(self).max(1) as f64;
                    // The first and the last piece of a section are half ones; they decide.
                    let shortest = if section.lumps(self) > 0 {
                        0.5 * section.length / lumps
                    } else {
                        section.length
                    };
                    // The axial wave is the faster one, and needs the longer piece.
                    let properties = section.properties(self);
                    let axial = (properties.axial / properties.mass).sqrt();
                    let least = LEAST_STEPS * time_step * axial;
                    // A NaN was reported by the check of numbers; a second message on it would mislead.
                    c.require(
                        shortest >= least || shortest.is_nan() || least.is_nan(),
                        "length",
                        section.length,
                        "m",
                        format!("so long that a piece of it, now {shortest:.1} m, has at least {least:.1} m"),
                        "a wave travels through a piece in at least three steps of solver.time_step",
                    );
                });
            }
        });
    }

    /// The string for the mechanics, `None` without a line. Friction counts with the weight in mud: `gravity` is the
    /// effective one (m/s2).
    pub(super) fn describe(&self, gravity: f64, with_hoist: bool) -> Option<StringDescription> {
        // Without a line the top of the tool is driven directly, and no string exists for the mechanics.
        if self.model != Model::Line {
            return None;
        }
        let mut pieces: Vec<Piece> = Vec::new();
        let mut weight = 0.0;
        for section in &self.sections {
            let properties = section.properties(self);
            // `along` of the weight hangs on the hoist, `across` presses on the wall.
            let (across, along) = sine_and_cosine(deg_to_rad(section.inclination_deg));
            let per_metre = properties.mass * gravity;
            weight += per_metre * section.length * along;
            let lumps = section.lumps(self);
            let piece = |length: f64| Piece::of(&properties, length);
            // A section that neither rubs nor damps is one piece: waves pass through it without a loss.
            if lumps == 0 {
                pieces.push(piece(section.length));
                continue;
            }
            let lump = section.length / lumps as f64;
            let normal = per_metre * lump * across;
            // Half pieces at both ends put the lumps into the middle of their
            // parts, so the friction acts where it arises on average.
            for k in 0..=lumps {
                let length = if k == 0 || k == lumps { 0.5 * lump } else { lump };
                let mut piece = piece(length);
                // The loss of a whole lump is at its lower end; the last half piece has none, or it would count twice.
                if k < lumps {
                    piece = piece.with_loss(self.attenuation_per_km * lump / 1000.0);
                }
                // No friction without a side force: a vertical section does not lie on the wall.
                let rubs = k < lumps && normal > 0.0 && self.friction.coefficient > 0.0;
                piece.friction = rubs.then_some(WallFriction {
                    sliding: self.friction.coefficient * normal,
                    static_ratio: self.friction.static_ratio,
                    static_speed: self.friction.static_speed,
                    radius: 0.5 * section.outer_diameter,
                });
                pieces.push(piece);
            }
        }
        // The top drive may be tuned to the impedance of the string, so it is described after the pieces.
        let drive = self.top_drive.describe(&pieces);
        // The hoist exists only with a rock that answers the advance; otherwise the weight itself is the input.
        let hoist = with_hoist.then_some(CoreHoist {
            stiffness: self.hoist.stiffness,
            response_time: self.hoist.response_time,
            fastest: self.hoist.fastest_m_per_h / 3600.0,
            // Touching down is never faster than the hoist can move.
            touch_down: self.hoist.touch_down_m_per_h.min(self.hoist.fastest_m_per_h) / 3600.0,
            clearance: self.hoist.clearance,
            feed: match self.hoist.feed {
                Feed::Weight => CoreFeed::Weight,
                Feed::Rate => CoreFeed::Rate,
            },
        });
        Some(StringDescription {
            pieces,
            drive,
            hoist,
            weight,
        })
    }
}

impl TopDrive {
    fn describe(&self, pieces: &[Piece]) -> CoreDrive {
        let controller = |proportional: f64, integral: f64| {
            CoreDrive::Controlled(SpeedController {
                inertia: self.inertia,
                proportional,
                integral,
                torque_limit: self.torque_limit,
            })
        };
        match self.tuning {
            Tuning::Rigid => CoreDrive::Rigid,
            Tuning::Stiff => controller(self.proportional, self.integral),
            Tuning::SoftTorque => {
                // At the first mode of a string held at the drive, a quarter wave, inertia and integral cancel.
                let impedance = pieces.first().map_or(0.0, |piece| piece.torsion.impedance);
                let delay: f64 = pieces.iter().map(|piece| piece.torsion.delay).sum();
                let mode = FRAC_PI_2 / delay;
                controller(self.impedance_ratio * impedance, self.inertia * mode * mode)
            }
        }
    }
}
