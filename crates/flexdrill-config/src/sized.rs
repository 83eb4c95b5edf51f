//! The same tool with another number of links, to measure how its cost grows.

use super::{Config, ConfigError, Section};
use flexdrill_core::units::rad_to_deg;

/// Shortest section of the path (m); shorter rests are rounding.
const SHORTEST: f64 = 1e-9;

impl Config {
    /// A copy with `links` links of the same length. The path keeps its start: a shorter tool ends earlier in it, a
    /// longer one continues straight after it, like a lateral after the curve. Every size therefore has links of the
    /// same length, mesh and joints, and as much of the curve as it can fill.
    ///
    /// # Errors
    /// When the result is invalid: no links, or loads and supports at locations that do not exist any longer.
    pub fn with_links(&self, links: usize) -> Result<Self, ConfigError> {
        let mut schema = self.schema.clone();
        let whole = schema.well.length();
        let mut left = whole * links as f64 / schema.tool.links as f64;
        schema.tool.links = links;
        // It begins on the hole as it is, which this one is not.
        schema.well.plan = None;
        schema.well.sections = schema
            .well
            .sections
            .iter()
            .flat_map(|s| begin_of(s, &mut left))
            .collect();
        if left > SHORTEST {
            schema.well.sections.push(Section::Straight { length: left });
        }
        Self::from_schema("a tool of another size", schema)
    }
}

/// The start of a section that fits into the length `left` (m), which is reduced by it.
fn begin_of(section: &Section, left: &mut f64) -> Vec<Section> {
    let length = section.length().min(*left);
    *left -= length;
    section.between(0.0, length)
}

impl Section {
    /// The part of it between two lengths from its top (m); hole as drilled that is cut within a point has several. Nothing
    /// where rounding alone is left.
    pub fn between(&self, top: f64, bottom: f64) -> Vec<Self> {
        let length = bottom - top;
        if length <= SHORTEST {
            return Vec::new();
        }
        match self {
            Self::Straight { .. } => vec![Self::Straight { length }],
            Self::Arc { .. } if length == self.length() => vec![self.clone()],
            Self::Arc { radius, .. } => vec![Self::Arc {
                radius: *radius,
                build_angle_deg: rad_to_deg(length / radius),
            }],
            Self::Drilled(drilled) => drilled.between(top, bottom).into_iter().map(Self::Drilled).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_keep_their_length_and_the_path_its_beginning() {
        let config = Config::load("../../config/default.yaml").unwrap();
        let link = config.well.length() / 33.0;
        for links in [1, 8, 16, 33, 66, 132] {
            let sized = config.with_links(links).unwrap();
            assert_eq!(sized.tool.links, links);
            // Rounding of angles to degrees and back.
            assert!((sized.well.length() / links as f64 - link).abs() < 1e-12);
        }
        assert_eq!(config.with_links(33).unwrap(), config);
        // Half of the links fill half of the quarter circle; twice as many go on level for its length.
        let end = |links| config.with_links(links).unwrap().well.end_inclination_deg();
        assert!((end(11) - 30.0).abs() < 1e-9 && (end(66) - 90.0).abs() < 1e-9);
        assert_eq!(config.with_links(66).unwrap().well.sections.len(), 2);
    }

    #[test]
    fn a_tool_without_links_is_refused() {
        assert!(
            Config::load("../../config/default.yaml")
                .unwrap()
                .with_links(0)
                .is_err()
        );
    }
}
