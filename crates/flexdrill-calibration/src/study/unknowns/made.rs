//! The tool as it was made: limits of the joints, and the guide. A log can hardly move them; they are fitted with the
//! distributions that `uncertainty` states, so that the bands of all others hold for what is not known of them.

use super::Modelled;
use crate::CalibrationError;
use crate::unknown::{Shape, Unknown};
use flexdrill_config::{Config, Distribution};

/// Name, unit and key of each.
const MADE: [(&str, &str, &str); 3] = [
    ("limit of the joints", "deg", "tool.joint.limit_deg"),
    ("bending stiffness of the guide", "", "tool.guide.bending_factor"),
    ("free curvature of the guide", "1/m", "tool.guide.free_curvature"),
];

/// Those with a distribution. The others are taken as configured, and listed.
pub(super) fn of(
    config: &Config,
    left_out: &mut Vec<(&'static str, &'static str)>,
) -> Result<Vec<Modelled>, CalibrationError> {
    let numbers = config.numbers();
    let mut all = Vec::new();
    for (name, unit, key) in MADE {
        let mut stated = config.uncertainty.iter().flat_map(|stated| &stated.keys);
        let entry = stated.find(|entry| entry.key == key && entry.also.is_empty());
        let configured = numbers.iter().find(|number| number.key == key);
        let (Some(entry), Some(configured)) = (entry, configured) else {
            left_out.push((
                name,
                "a log can hardly move it: taken as configured, since uncertainty.keys has no distribution of it",
            ));
            continue;
        };
        let shape = match entry.distribution {
            Distribution::Normal { .. } => Shape::Normal,
            Distribution::LogNormal { .. } => Shape::LogNormal,
            Distribution::Uniform { .. } | Distribution::Triangular { .. } => {
                left_out.push((
                    name,
                    "a log can hardly move it: taken as configured, since its distribution is neither normal nor log_normal",
                ));
                continue;
            }
        };
        let mut ends = entry
            .distribution
            .ends()
            .map(|draw| entry.form.value(draw, configured.value));
        // A factor on a negative value turns them round.
        ends.sort_by(f64::total_cmp);
        all.push(Modelled {
            unknown: Unknown::new(name, unit, shape, ends)?,
            keys: vec![key],
            per_value: 1.0,
            drilling_alone: false,
        });
    }
    Ok(all)
}
