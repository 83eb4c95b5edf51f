//! The same tool at the end of the hole that it has drilled.

use super::drilled::{Drilled, Interval};
use super::string::DrillString;
use super::{Config, ConfigError, Section, Well};
use flexdrill_core::tool::Course;
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

impl DrillString {
    /// Moves every pipe down the hole by a length (m): what the rig adds at the top is pipe of the first section, and the pipe
    /// above the tool comes into the hole that the tool has left.
    ///
    /// A section is one pipe in one inclination. Where two sections differ in the pipe, their border moves down; where they differ
    /// in the inclination alone, it is a bend of the hole and stays. Of two that differ in both, the bend moves with the pipe. No
    /// section becomes shorter than the shortest allowed.
    fn move_down(&mut self, by: f64) {
        let pipe = |section: &super::string::Section| [section.outer_diameter, section.inner_diameter];
        for lower in 1..self.sections.len() {
            let is_another = pipe(&self.sections[lower - 1]) != pipe(&self.sections[lower]);
            if is_another && self.sections[lower].length - by >= super::string::SHORTEST {
                self.sections[lower - 1].length += by;
                self.sections[lower].length -= by;
            }
        }
        if let Some(last) = self.sections.last_mut() {
            last.length += by;
        }
    }
}

impl Config {
    /// A copy whose hole ends with what was drilled below it: points of a length `spacing` (m) with the curvatures (build,
    /// right) (1/m), from the top down. The rest as in [`Config::with_hole_below`].
    ///
    /// # Errors
    /// When the hole cannot be, such as one that leaves its vertical plane.
    pub fn rebased(&self, points: &[[f64; 2]], spacing: f64) -> Result<Self, ConfigError> {
        let interval = self
            .well
            .describe()
            .intervals()
            .last()
            .map_or(Interval::default(), Interval::from);
        let drilled = Section::Drilled(Drilled {
            spacing,
            points: points.to_vec(),
            interval,
        });
        let length = self.well.length();
        self.with_hole_below(None, length, vec![drilled], length + spacing * points.len() as f64)
    }

    /// A copy that keeps its hole down to a depth `from` (m), with sections below it, down to a bit at a depth `bit` (m). Where
    /// nothing of its hole remains, `start_deg` is the inclination of the first of them at its top.
    ///
    /// The tool fills its hole from end to end as before, so that the hole loses at its top what it gains below. There is the new
    /// kick-off: depths count from it, `well.kick_off_depth` is as much deeper, and the string above as much longer. A plan is
    /// left out, because only whoever lays it knows where it is from the new top.
    ///
    /// # Errors
    /// When the hole cannot be, such as one that leaves its vertical plane.
    pub fn with_hole_below(
        &self,
        start_deg: Option<f64>,
        from: f64,
        below: Vec<Section>,
        bit: f64,
    ) -> Result<Self, ConfigError> {
        let mut schema = self.schema.clone();
        let well = &mut schema.well;
        let moved = (bit - well.length()).max(0.0);
        // What is cut from the top of all these sections.
        let mut above = match start_deg {
            Some(start_deg) => {
                well.start_inclination_deg = start_deg;
                well.sections.clear();
                (moved - from).max(0.0)
            }
            None => {
                well.sections = above_depth(&well.sections, from);
                moved
            }
        };
        for section in below {
            // A hole that has grown before grows on in the same list.
            if let Section::Drilled(next) = &section
                && let Some(Section::Drilled(last)) = well.sections.last_mut()
                && last.spacing == next.spacing
                && last.interval == next.interval
            {
                last.points.extend(&next.points);
                continue;
            }
            well.sections.push(section);
        }
        let mut sections = Vec::with_capacity(well.sections.len());
        for section in &well.sections {
            let (length, cut) = (section.length(), section.length().min(above));
            above -= cut;
            well.start_inclination_deg += rad_to_deg(section.turn(cut));
            sections.extend(section.between(cut, length));
        }
        well.sections = sections;
        well.plan = None;
        well.kick_off_depth += moved;
        // A depth above the new kick-off is that of a tool that has drilled all of the hole.
        well.drilled_from = well.drilled_from.map(|from| (from - moved).max(0.0));
        schema.string.move_down(moved);
        Self::from_schema("the hole as drilled", schema)
    }
}

/// The parts of sections above a depth (m).
fn above_depth(sections: &[Section], depth: f64) -> Vec<Section> {
    let mut left = depth;
    let mut parts = Vec::with_capacity(sections.len());
    for section in sections {
        let length = section.length();
        // All of a section keeps its bits, whatever rounding says of their sum.
        if left >= length - 1e-9 {
            parts.push(section.clone());
        } else {
            parts.extend(section.between(0.0, left));
        }
        left = (left - length).max(0.0);
    }
    parts
}

impl Well {
    /// The hole from the top down to a depth (m).
    pub fn course_to(&self, depth: f64) -> Course {
        let mut course = Course::begin(deg_to_rad(self.start_inclination_deg), 0.0);
        for section in above_depth(&self.sections, depth) {
            section.extend(&mut course);
        }
        course
    }
}
