//! Guide and pipe of a configuration in the hole above the bit, at any depth of the bit.

use flexdrill_config::{Config, FreeBend, Section};
use flexdrill_core::tool::{HoleInterval, ToolDescription, WellPath};
use flexdrill_drilling::loads::weights;
use flexdrill_drilling::tool::{chord, curvature_at_bit, guide, hole};
use flexdrill_hole::{Guide, HoleError, Sense, Sliding, sliding};

use crate::soft_string::{Load, Motion, Piece};

/// Pieces of hole shorter than this (m) are left out: a chord of nothing has no direction.
const SHORTEST: f64 = 1e-3;

/// Guide and pipe on a trip.
#[derive(Debug, Clone)]
pub struct Tool {
    guide: Guide,
    /// Weight per length of the pipe (N/m), its friction in the guide, and the radius at which it rubs (m).
    pipe: [f64; 3],
    /// The hole from the kick-off down; above it, it continues straight.
    sections: Vec<Section>,
    /// Inclination at the kick-off (rad).
    start: f64,
    path: WellPath,
    /// Whether the guide has the curvature of the hole at the bit, because none is configured.
    pub as_built: bool,
}

/// Pieces of a hole from its top down, for pipes with a weight per length along and across the hole (N/m) that rub with a
/// friction coefficient, by interval of the hole, at a radius (m).
pub fn pieces(
    sections: &[Section],
    start_inclination: f64,
    [along, across]: [f64; 2],
    friction: impl Fn(HoleInterval) -> f64,
    radius: f64,
) -> Vec<Piece> {
    let (mut inclination, mut before_arc) = (start_inclination, true);
    let mut pieces = Vec::new();
    for section in sections {
        let interval = match section {
            Section::Arc { .. } => HoleInterval::Arc,
            Section::Straight { .. } if before_arc => HoleInterval::BeforeArc,
            Section::Straight { .. } => HoleInterval::AfterArc,
            Section::Drilled(drilled) => drilled.interval.into(),
        };
        before_arc &= interval == HoleInterval::BeforeArc;
        let mut add = |length: f64, curvature: f64| {
            pieces.push(Piece {
                length,
                inclination,
                curvature,
                along,
                across,
                friction: friction(interval),
                radius,
            });
            inclination += curvature * length;
        };
        match section {
            Section::Straight { .. } | Section::Arc { .. } => add(section.length(), section.curvature()),
            Section::Drilled(drilled) => drilled
                .points
                .iter()
                .for_each(|[build, _]| add(drilled.spacing, *build)),
        }
    }
    pieces
}

/// Largest radius at which the pipe touches the guide (m).
pub fn pipe_radius(tool: &ToolDescription) -> f64 {
    tool.pipe_contact_diameters
        .iter()
        .chain(tool.pipe_sections.iter().map(|tube| &tube.outer_diameter))
        .fold(0.0_f64, |widest, &diameter| widest.max(diameter))
        / 2.0
}

/// Torque (N m) that friction in the guide takes of a pipe that hangs from its top and turns: with the tension T of its
/// weight, mu r integral |w sin i - T kappa|.
pub fn pipe_torque(pieces: &[Piece]) -> f64 {
    let turn = |below: Load, piece: &Piece| piece.above(below, &Motion::TURNING);
    pieces.iter().rev().fold(Load::default(), turn).torque
}

/// The hole of a tool whose bit is at a depth below the kick-off (m): a straight piece `above` the kick-off (m), and the upper
/// part of the sections.
fn hole_of(sections: &[Section], above: f64, depth: f64) -> Vec<Section> {
    let mut hole = Vec::new();
    if above >= SHORTEST {
        hole.push(Section::Straight { length: above });
    }
    let mut begins = 0.0;
    for section in sections {
        let left = (depth - begins).min(section.length());
        if left < SHORTEST {
            break;
        }
        match section {
            Section::Straight { .. } => hole.push(Section::Straight { length: left }),
            Section::Arc {
                radius,
                build_angle_deg,
            } => hole.push(Section::Arc {
                radius: *radius,
                build_angle_deg: build_angle_deg * (left / section.length()),
            }),
            Section::Drilled(drilled) => hole.extend(drilled.between(0.0, left).into_iter().map(Section::Drilled)),
        }
        begins += section.length();
    }
    hole
}

impl Tool {
    /// Of a configuration.
    pub fn of(config: &Config) -> Self {
        let tool = config.tool();
        let [_, pipe] = weights(&tool);
        Self {
            // Off the bottom the bit takes no torque.
            guide: Guide {
                torque: 0.0,
                ..guide(config, 0.0)
            },
            pipe: [pipe, tool.inner.friction_tangential, pipe_radius(&tool)],
            path: WellPath::new(&tool.well),
            sections: config.well.sections.clone(),
            start: tool.well.start_inclination,
            as_built: matches!(config.tool.guide.free_curvature, FreeBend::Path(_)) && curvature_at_bit(config) != 0.0,
        }
    }

    /// The same with its friction multiplied.
    #[must_use]
    pub fn with_friction(mut self, factor: f64) -> Self {
        self.guide.wall_friction *= factor;
        self.pipe[1] *= factor;
        self
    }

    /// Length of guide and pipe (m): that of the hole below the kick-off.
    pub fn length(&self) -> f64 {
        self.guide.length
    }

    /// Weight of guide and pipe in mud that hangs from their top, without friction (N), the bit at a depth below the
    /// kick-off (m).
    pub fn hanging(&self, depth: f64) -> f64 {
        let above = (self.guide.length - depth).max(0.0);
        let height = self.path.position(depth).z + above * libm::cos(self.start);
        self.guide.weight_per_metre * height
    }

    /// Loads of a guide that slides with its bit at a depth below the kick-off (m), while a tension acts on the bit (N), and
    /// the depths of its points (m).
    ///
    /// # Errors
    /// When the statics of the guide have no solution.
    pub fn slides(&self, depth: f64, tension: f64, sense: Sense) -> Result<(Vec<f64>, Sliding), HoleError> {
        let chord = chord(&self.guide);
        let sections = hole_of(&self.sections, self.guide.length - depth, depth);
        let hole = hole(self.start, 0.0, &sections, chord)?;
        let slides = sliding(&self.guide, tension, &hole, sense)?;
        let mut depths = vec![depth];
        let chords = hole.points().windows(2).rev().take(slides.tensions.len() - 1);
        for chord in chords {
            depths.push(depths[depths.len() - 1] - (chord[1] - chord[0]).norm());
        }
        depths.reverse();
        Ok((depths, slides))
    }

    /// Share of a change of tension that friction lets pass from one depth to a lower one (m) along one side of the hole:
    /// e^(-mu theta).
    pub fn passes(&self, from: f64, to: f64) -> f64 {
        let middle = f64::midpoint(from, to);
        let curvature = if middle < 0.0 { 0.0 } else { self.path.curvature(middle) };
        libm::exp(-self.guide.wall_friction * curvature.abs() * (to - from))
    }

    /// Torque that turns the pipe in the guide (N m), off the bottom, the bit at a depth below the kick-off (m).
    pub fn torque(&self, depth: f64) -> f64 {
        let [weight, friction, radius] = self.pipe;
        let sections = hole_of(&self.sections, self.guide.length - depth, depth);
        pipe_torque(&pieces(&sections, self.start, [weight; 2], |_| friction, radius))
    }

    /// Largest factor on the friction that the statics of the guide allow.
    pub fn most_factor(&self) -> f64 {
        2.0 / self.guide.wall_friction.max(f64::MIN_POSITIVE)
    }
}
