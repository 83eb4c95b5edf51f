//! What the guide of a configuration drills, and its plan, for `flexdrill check`.

use std::path::Path;

use super::plan::Planned;
use crate::drilling::range::{Excluded, Range};
use crate::drilling::{plan, tool, words};
use flexdrill_config::Config;
use flexdrill_core::units::{n_to_kn, rad_to_deg};
use flexdrill_text::printable;

/// Rows and warnings of the summary.
#[derive(Default)]
pub(super) struct Drills {
    /// Names and values of rows.
    pub rows: Vec<(&'static str, String)>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Drills {
    /// Of a configuration with this name in a file.
    ///
    /// # Errors
    /// When its plan cannot be read, or begins away from the hole.
    pub fn of(config: &Config, name: &str, path: &Path) -> anyhow::Result<Self> {
        let mut drills = Self::default();
        let planned = Planned::of(config, name, path)?;
        let range = Range::of(config);
        if let Some(range) = &range {
            drills.rows.push(("guide drills", long_arc(config, range)));
            let any_bit = words::any_bit(range.bounds.as_ref(), range.largest_weight);
            drills.rows.push(("any bit", any_bit));
        }
        if let Some(planned) = &planned {
            drills.plan(config, planned)?;
        }
        let rows = planned.as_ref().map(|planned| planned.rows.as_slice());
        let excluded = range.map(|range| range.excluded(config, rows)).unwrap_or_default();
        drills.warnings.extend(excluded.iter().map(warning));
        Ok(drills)
    }

    /// The row of a plan, and a warning where it says nothing of the hole below the bit.
    fn plan(&mut self, config: &Config, planned: &Planned) -> anyhow::Result<()> {
        let (Some(first), Some(last)) = (planned.rows.first(), planned.rows.last()) else {
            return Ok(());
        };
        self.rows.push((
            "plan",
            format!(
                "{} stations from {:.2} to {:.2} m, inclination {:.1} to {:.1} deg, target {} m",
                planned.rows.len(),
                first.depth,
                last.depth,
                rad_to_deg(first.inclination),
                rad_to_deg(last.inclination),
                config.well.plan.as_ref().map_or(f64::NAN, |plan| plan.target),
            ),
        ));
        match plan::covers(&planned.name, &planned.rows, config.well.length()) {
            // The tool of a hole that is done is checked too.
            Err(ends @ plan::PlanError::End { .. }) => self.warnings.push(printable(&ends.to_string()).to_string()),
            covers => covers?,
        }
        Ok(())
    }
}

/// What the guide drills at a weight.
fn long_arc(config: &Config, range: &Range) -> String {
    let weight = n_to_kn(range.weight);
    let flats = tool::wear_flats(config);
    if range.weight <= flats {
        return format!(
            "nothing at {weight:.1} kN on the bit: {:.1} kN are on wear flats (rock.depth_of_cut.wear_flat_force)",
            n_to_kn(flats)
        );
    }
    words::in_a_long_arc(range.long.as_ref(), &format!(" at {weight:.1} kN on the bit"))
}

/// What to do about a curvature that the guide does not drill.
fn warning(excluded: &Excluded) -> String {
    match excluded {
        Excluded::Arc(radius) => format!(
            "well.sections: this guide cannot drill the arc of {radius} m at any weight; change the guide \
             (tool.guide.free_curvature, bending_factor) where it is to drill this arc"
        ),
        Excluded::Plan { curvature, ahead } => format!(
            "well.plan: this guide cannot drill the plan at any weight; change the guide (tool.guide.free_curvature, \
             bending_factor): the plan needs {} over {ahead:.2} m below the bit",
            words::needed(*curvature)
        ),
    }
}
