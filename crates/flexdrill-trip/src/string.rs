//! The string above the tool as pieces in its hole, at any depth of the bit.
//!
//! `string.sections` has the pipes of a string whose tool is on the bottom, each with the inclination of its hole. With the
//! bit a distance x above the bottom, every pipe is x higher in the hole, and the upper x of the string are out of it.

use flexdrill_config::{Config, DrillString, Model};
use flexdrill_core::tool::{Material, SectionProperties, Tube};
use flexdrill_core::units::deg_to_rad;
use flexdrill_hole::Sense;

use crate::soft_string::{Load, Motion, Piece, above_bend};

/// Shortest piece (m): shorter ones come of rounding at boundaries.
const SHORTEST: f64 = 1e-9;

/// A pipe of the string and its hole.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    /// Distances of its ends below the rig, with the bit on the bottom (m).
    ends: [f64; 2],
    /// Inclination of the hole there (rad).
    inclination: f64,
    /// Weight per length of the pipe in mud (N/m).
    weight: f64,
    /// Radius of the pipe (m).
    radius: f64,
}

/// The string above the tool.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// From the rig down; none without `string.model: line`.
    sections: Vec<Section>,
    /// Friction coefficient.
    friction: f64,
    /// Inclination of the hole at the kick-off (rad).
    end: f64,
}

/// A part of the string.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    /// Pipe in a straight hole.
    Pipe(Piece),
    /// A bend of an angle (rad) in the hole, whose radius is not known, with the radius at which the pipe rubs (m).
    Bend(f64, f64),
}

/// Length of the hole above the kick-off (m): all of the string.
fn length(sections: &[Section]) -> f64 {
    sections.last().map_or(0.0, |last| last.ends[1])
}

impl Line {
    /// The string of a configuration.
    pub fn of(config: &Config) -> Self {
        let string: &DrillString = &config.string;
        let material = Material {
            youngs_modulus: string.material.youngs_modulus,
            poisson_ratio: string.material.poisson_ratio,
            density: string.material.density,
        };
        let gravity = config.tool().gravity;
        let mut below_rig = 0.0;
        let section = |section: &flexdrill_config::StringSection| {
            let tube = Tube {
                outer_diameter: section.outer_diameter,
                inner_diameter: section.inner_diameter,
            };
            let start = below_rig;
            below_rig += section.length;
            Section {
                ends: [start, below_rig],
                inclination: deg_to_rad(section.inclination_deg),
                weight: gravity * SectionProperties::of(tube, material, 1.0).mass,
                radius: 0.5 * section.outer_diameter,
            }
        };
        Self {
            sections: if string.model == Model::Line {
                string.sections.iter().map(section).collect()
            } else {
                Vec::new()
            },
            friction: string.friction.coefficient,
            end: deg_to_rad(config.well.start_inclination_deg),
        }
    }

    /// Length of the string (m).
    pub fn length(&self) -> f64 {
        length(&self.sections)
    }

    /// The same with its friction multiplied.
    #[must_use]
    pub fn with_friction(self, factor: f64) -> Self {
        Self {
            friction: factor * self.friction,
            ..self
        }
    }

    /// Parts from the rig down with their upper ends below the rig (m), the bit `raised` above the bottom (m).
    fn parts(&self, raised: f64) -> Vec<(f64, Part)> {
        let hangs = self.length() - raised;
        // Boundaries of the hole, and of pipes that have moved up.
        let mut ends: Vec<f64> = self.sections.iter().map(|section| section.ends[1]).collect();
        ends.extend(self.sections.iter().map(|section| section.ends[1] - raised));
        ends.retain(|end| *end > 0.0 && *end < hangs);
        ends.push(hangs);
        ends.sort_by(f64::total_cmp);
        let at = |depth: f64| self.sections.iter().find(|section| depth < section.ends[1]);
        let (mut parts, mut start): (Vec<(f64, Part)>, f64) = (Vec::new(), 0.0);
        let mut before: Option<f64> = None;
        for end in ends {
            let length = end - start;
            if length < SHORTEST {
                continue;
            }
            let middle = f64::midpoint(start, end);
            let (Some(hole), Some(pipe)) = (at(middle), at(middle + raised)) else {
                break;
            };
            if let Some(before) = before.filter(|before| *before != hole.inclination) {
                parts.push((start, Part::Bend(hole.inclination - before, pipe.radius)));
            }
            before = Some(hole.inclination);
            parts.push((
                start,
                Part::Pipe(Piece {
                    length,
                    inclination: hole.inclination,
                    curvature: 0.0,
                    along: pipe.weight,
                    across: pipe.weight,
                    friction: self.friction,
                    radius: pipe.radius,
                }),
            ));
            start = end;
        }
        // The bend into the hole of the tool counts at the tool's top, wherever that is above the kick-off.
        if let (Some(before), Some(last)) = (before, self.sections.last())
            && before != self.end
        {
            parts.push((hangs, Part::Bend(self.end - before, last.radius)));
        }
        parts
    }

    fn above(&self, part: &Part, below: Load, motion: &Motion) -> Load {
        match *part {
            Part::Pipe(piece) => piece.above(below, motion),
            Part::Bend(angle, radius) => {
                let [axial, around] = motion.shares(radius);
                let tension = above_bend(angle, self.friction, below.tension, axial, motion.sense);
                let pulls = 0.5 * (tension.abs() + below.tension.abs());
                Load {
                    tension,
                    torque: below.torque + self.friction * around * radius * pulls * angle.abs(),
                }
            }
        }
    }

    /// Loads with their distance below the rig (m), from the tool's top to the rig, over a load at the tool's top.
    pub fn up(&self, raised: f64, top: Load, motion: &Motion) -> Vec<(f64, Load)> {
        let hangs = self.length() - raised;
        let mut loads = vec![(hangs, top)];
        let mut load = top;
        for (depth, part) in self.parts(raised).iter().rev() {
            load = self.above(part, load, motion);
            loads.push((*depth, load));
        }
        loads
    }

    /// Tensions (N) with their distance below the rig (m), from the rig to the tool's top, at the places of [`Line::up`]: what
    /// arrives of a tension at the rig while the string slides.
    pub fn down(&self, raised: f64, rig: f64, sense: Sense) -> Vec<(f64, f64)> {
        let motion = Motion::sliding(sense);
        let mut tension = rig;
        let mut tensions = Vec::new();
        for (depth, part) in self.parts(raised) {
            tensions.push((depth, tension));
            tension = match part {
                Part::Pipe(piece) => {
                    let above = Load { tension, torque: 0.0 };
                    piece.below(above, &motion, f64::INFINITY).tension
                }
                // Upwards friction multiplies by what it divides by downwards.
                Part::Bend(angle, _) => above_bend(angle, self.friction, tension, 1.0, sense.opposite()),
            };
        }
        tensions.push((self.length() - raised, tension));
        tensions
    }
}
