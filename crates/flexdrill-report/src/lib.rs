//! A recording as one HTML page to pass on: the inputs, the alarms, the worst locations, forces and moments along the
//! tool, the torque that reached the bit, and how far the numbers can be trusted.
//!
//! The crate reads a bag and writes a page. It knows neither ROS nor the node.
//!
//! # Layout
//! - `reading`: one pass over a bag in bounded memory, into a [`Summary`]. `roles`: the meaning of each topic.
//! - Parts of the summary: `history` (over time), `envelope` (over the tool), `drive` (inputs, bit, torque),
//!   `figures` (the figures of a message, as their table lists them), `transfer` (torque, weight and power from the surface
//!   to the bit), `balances` (of the whole tool), `incidents` (alarms), `tools` (what plausible tools did), `hole` (where the
//!   tool drilled next), `life` (damage of the joints), `weight` (what does not arrive at the bit), `shares` (of time), `locations` (the worst ones and
//!   their orbits), `health` (pace, model, recording).
//! - [`calibration`]: the page of a calibration.
//! - `compare`: two summaries next to each other, a [`Comparison`].
//! - [`map`]: a page of another kind, of a safe window.
//! - `plots`: the figures. `page`: the HTML, with everything in one file.

mod balances;
pub mod calibration;
mod compare;
mod drive;
mod envelope;
mod error;
mod figures;
mod health;
mod history;
mod hole;
mod incidents;
mod life;
mod locations;
pub mod map;
mod page;
mod plots;
mod reading;
mod roles;
mod shares;
mod tools;
mod transfer;
mod weight;

use std::path::{Path, PathBuf};

pub use compare::Comparison;
pub use error::ReportError;
pub use incidents::INPUT_ALARMS;
pub use page::comparison::html as comparison_html;
pub use page::html;
pub use reading::{Summary, read};

/// File name of the page.
pub const FILE: &str = "report.html";

/// Bound on plausible values, in any unit used here; an axis cannot show larger ones.
const MOST: f64 = 1e12;

/// Whether a number of a message is finite and plausible.
fn is_quantity(value: f64) -> bool {
    value.abs() < MOST
}

/// Writes the page of a recording into `folder`, which is created if necessary; an older page is replaced.
///
/// # Errors
/// When a figure cannot be drawn, or the page cannot be written.
pub fn write(summary: &Summary, folder: &Path) -> Result<PathBuf, ReportError> {
    write_page(&html(summary)?, folder)
}

/// Writes the page of two recordings into `folder`, as [`write()`] does. `tolerance` is the share of a value up to which a
/// difference is not marked.
///
/// # Errors
/// When a figure cannot be drawn, or the page cannot be written.
pub fn write_comparison(
    comparison: &Comparison<'_>,
    tolerance: Option<f64>,
    folder: &Path,
) -> Result<PathBuf, ReportError> {
    write_page(&comparison_html(comparison, tolerance)?, folder)
}

fn write_page(page: &str, folder: &Path) -> Result<PathBuf, ReportError> {
    let path = folder.join(FILE);
    let failed = |source| ReportError::Write {
        path: path.clone(),
        source,
    };
    std::fs::create_dir_all(folder).map_err(failed)?;
    std::fs::write(&path, page).map_err(failed)?;
    Ok(path)
}
