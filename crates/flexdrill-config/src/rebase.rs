//! The same tool at the end of the hole that it has drilled.

use super::drilled::{Drilled, Interval};
use super::{Config, ConfigError, Section};
use flexdrill_core::units::rad_to_deg;

impl Config {
    /// A copy whose hole ends with what was drilled below it: points of a length `spacing` (m) with the curvatures (build,
    /// right) (1/m), from the top down. The tool fills it from end to end as before, so that the hole loses as much at its
    /// top, and depths count from the new one. A plan, whose depths count from the old one, is left out.
    ///
    /// # Errors
    /// When the hole cannot be, such as one that leaves its vertical plane.
    pub fn rebased(&self, points: &[[f64; 2]], spacing: f64) -> Result<Self, ConfigError> {
        let mut schema = self.schema.clone();
        let well = &mut schema.well;
        let interval = well
            .describe()
            .intervals()
            .last()
            .map_or(Interval::default(), Interval::from);
        // A hole that has grown before grows on in the same list.
        match well.sections.last_mut() {
            Some(Section::Drilled(last)) if last.spacing == spacing && last.interval == interval => {
                last.points.extend(points);
            }
            _ => well.sections.push(Section::Drilled(Drilled {
                spacing,
                points: points.to_vec(),
                interval,
            })),
        }
        let mut above = spacing * points.len() as f64;
        let mut sections = Vec::with_capacity(well.sections.len());
        for section in &well.sections {
            let (length, cut) = (section.length(), section.length().min(above));
            above -= cut;
            well.start_inclination_deg += rad_to_deg(section.turn(cut));
            sections.extend(section.between(cut, length));
        }
        well.sections = sections;
        well.plan = None;
        Self::from_schema("the hole as drilled", schema)
    }
}
