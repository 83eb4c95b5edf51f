//! The guide, the bit and the hole of a configuration, as [`flexdrill_hole`] takes them.

use flexdrill_config::{BitAxis, Config, Drilled, Law, Section};
use flexdrill_core::tool::{Course, HoleInterval, SectionProperties};
use flexdrill_core::units::{deg_to_rad, n_to_kn};
use flexdrill_hole::{BitLaw, Gravity, Guide, Hole, HoleError, Spine};
use nalgebra::Vector3;

use super::loads::{bit_torque, weights};

/// Distance of two stations ahead (m).
pub const SPACING: f64 = 0.25;
/// Longest chord of the hole (m): the free length of a guide is about 1 m.
const LONGEST_CHORD: f64 = 0.042;
/// Chords over the length of a short guide.
const FEWEST_CHORDS: f64 = 50.0;

/// A tool that drills.
#[derive(Debug, Clone)]
pub struct Drilling {
    /// The guide.
    pub guide: Guide,
    /// The bit under its weight.
    pub law: BitLaw,
    /// The hole from the kick-off to the bit.
    pub hole: Hole,
    /// Chords between two stations ahead.
    pub chords: usize,
}

/// Why nothing can be predicted for a configuration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The bit is held by the last link.
    #[error(
        "tool.bit.axis = link: must be guide: a bit that is screwed to the last link points where that link lies in the \
         guide, which depends on whirl; nothing is predicted for it. Set axis: guide if a bearing of the guide holds the \
         bit's axis, which the tool's drawing shows"
    )]
    Link,
    /// The hole builds nowhere.
    #[error(
        "well.sections = straight sections only: must have an arc: a guide is bent by the arc that it lies in. Add the arc \
         above the bit to well.sections"
    )]
    Straight,
    /// The guide is held at every node.
    #[error(
        "tool.guide.fixed = true: must be false: a guide that is held at every node does not drill. Set fixed: false and \
         give tool.guide.free_curvature"
    )]
    Fixed,
    /// All of the weight is on the wear flats.
    #[error(
        "the weight at the bit = {weight} kN: must be above rock.depth_of_cut.wear_flat_force, {flats} kN: under a smaller \
         weight this bit cuts nothing. Give a larger --weight"
    )]
    NothingCuts {
        /// Weight at the bit (kN).
        weight: f64,
        /// Force of the wear flats (kN).
        flats: f64,
    },
    /// Numbers out of bounds, or statics without a solution.
    #[error(transparent)]
    Hole(#[from] HoleError),
}

impl From<flexdrill_core::validation::ValidationError> for Refusal {
    fn from(error: flexdrill_core::validation::ValidationError) -> Self {
        Self::Hole(error.into())
    }
}

/// Refuses a configuration for which nothing can be predicted, whatever the weight.
///
/// # Errors
/// The first reason.
pub fn check(config: &Config) -> Result<(), Refusal> {
    if config.tool.bit.axis() == BitAxis::Link {
        return Err(Refusal::Link);
    }
    if config.well.is_straight() {
        return Err(Refusal::Straight);
    }
    if config.tool.guide.fixed {
        return Err(Refusal::Fixed);
    }
    Ok(())
}

/// Force of the wear flats on the rock (N), which cuts nothing.
pub fn wear_flats(config: &Config) -> f64 {
    match config.rock.law {
        Law::DepthOfCut => config.rock.depth_of_cut.wear_flat_force,
        Law::Paper | Law::Weakening => 0.0,
    }
}

/// Curvature of the hole at the bit (1/m); of hole as drilled the mean.
pub fn curvature_at_bit(config: &Config) -> f64 {
    config.well.sections.last().map_or(0.0, Section::curvature)
}

/// The guide of a configuration under a weight at the bit (N).
///
/// A guide `as_built` has the curvature of the hole at the bit over its whole length. The torque is that of a bit that turns
/// fast; it only pushes the bit aside by some newtons.
pub fn guide(config: &Config, weight: f64) -> Guide {
    let tool = config.tool();
    let station = config.link_length() / config.tool.elements_per_link as f64;
    let made = tool.guide_free_curvature;
    Guide {
        length: config.well.length(),
        bending_stiffness: SectionProperties::of(tool.guide_section, tool.material, tool.guide_bending_factor).bending,
        free_curvature: made.map_or_else(|| curvature_at_bit(config), |free| free.curvature),
        bends: tool.guide_bends,
        roll: deg_to_rad(config.tool.guide.free_curvature_phase_deg),
        spine: tool.guide_spine.map(|spine| Spine {
            offset: spine.offset,
            turn: spine.phase - deg_to_rad(config.tool.guide.free_curvature_phase_deg),
            most: tool.guide_slots_close_at,
        }),
        weight_per_metre: weights(&tool).iter().sum(),
        gravity: Gravity::Down,
        gap: config.outer_clearance(),
        wall_friction: tool.outer.friction_axial * tool.wall_friction_factors.of(HoleInterval::Arc),
        // A station's spring stands for the wall along half an element on both sides.
        wall_stiffness: config.contact.outer.stiffness / station,
        torque: bit_torque(&tool, weight, f64::INFINITY),
    }
}

/// Longest chord of the hole that a guide lies in (m).
pub fn chord(guide: &Guide) -> f64 {
    LONGEST_CHORD.min(guide.length / FEWEST_CHORDS)
}

/// The bit of a configuration under a weight (N).
///
/// # Errors
/// [`Refusal::NothingCuts`].
pub fn bit(config: &Config, weight: f64) -> Result<BitLaw, Refusal> {
    let flats = wear_flats(config);
    if weight <= flats {
        return Err(Refusal::NothingCuts {
            weight: n_to_kn(weight),
            flats: n_to_kn(flats),
        });
    }
    Ok(BitLaw {
        weight,
        active_weight: weight - flats,
        lateral_resistance: config.tool.bit.lateral_resistance(),
        walk_angle: deg_to_rad(config.tool.bit.walk_angle_deg()),
    })
}

/// Chords of at most `longest` (m) through hole as drilled below a course, whose points lie at other distances.
fn chords_of(mut course: Course, drilled: &Drilled, longest: f64) -> Vec<Vector3<f64>> {
    let count = (drilled.length() / longest - 1e-9).ceil().max(1.0);
    let length = drilled.length() / count;
    let (mut before, mut points) = (course.position, drilled.points.iter().peekable());
    let (mut whole, mut chords) = (0.0, Vec::with_capacity(count as usize));
    for end in (1..=count as u32).map(|index| f64::from(index) * length) {
        // Points above the end of the chord, then the part of one that it ends in.
        while let Some(curvatures) = points.next_if(|_| whole + drilled.spacing <= end) {
            course.advance(drilled.spacing, *curvatures);
            whole += drilled.spacing;
        }
        let mut at = course;
        if let Some(curvatures) = points.peek() {
            at.advance(end - whole, **curvatures);
        }
        chords.push(at.position - before);
        before = at.position;
    }
    chords
}

/// The hole of sections from the top down, in chords of a length (m), from an inclination and an azimuth (rad) on.
///
/// # Errors
/// When a section has no length, or a hole is turned too far.
pub fn hole<'a>(
    start: f64,
    azimuth: f64,
    sections: impl IntoIterator<Item = &'a Section>,
    chord: f64,
) -> Result<Hole, HoleError> {
    let (mut hole, mut course) = (Hole::begin(start, azimuth)?, Course::begin(start, azimuth));
    for section in sections {
        let above = course;
        section.extend(&mut course);
        hole = match section {
            Section::Straight { length } => hole.straight(*length, chord)?,
            Section::Arc {
                radius,
                build_angle_deg,
            } => hole.arc(*radius, deg_to_rad(*build_angle_deg), chord)?,
            Section::Drilled(drilled) => hole.through(chords_of(above, drilled, chord))?,
        };
    }
    Ok(hole)
}

impl Drilling {
    /// The tool of a configuration at the end of its hole, under a weight at the bit (N). The hole lies in a vertical plane at
    /// an azimuth (rad).
    ///
    /// # Errors
    /// When nothing can be predicted.
    pub fn of(config: &Config, weight: f64, azimuth: f64) -> Result<Self, Refusal> {
        check(config)?;
        let (guide, law) = (guide(config, weight), bit(config, weight)?);
        let chords = (SPACING / chord(&guide)).ceil();
        let start = deg_to_rad(config.well.start_inclination_deg);
        let hole = hole(start, azimuth, &config.well.sections, SPACING / chords)?;
        Ok(Self {
            guide,
            law,
            hole,
            chords: chords as usize,
        })
    }

    /// Length of a new chord (m).
    pub fn chord(&self) -> f64 {
        SPACING / self.chords as f64
    }
}
