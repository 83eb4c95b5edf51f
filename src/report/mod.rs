//! A recording as one page that an engineer sends on: what drove the tool, what called for somebody, where it was worst,
//! how forces and moments lay along it, what torque reached the bit, and how far all that can be trusted.
//!
//! # Layout
//! - `reading`: one pass over a bag in bounded memory, into a [`Summary`]; `roles` says which topic is what.
//! - What is kept: `history` (over time), `along` (over the tool), `drive` (inputs, bit, torque), `incidents` (alarms), `shares` (of the time),
//!   `places` (the worst places and their orbits), `health` (pace, model, recording).
//! - `plots`: the figures. `page`: the HTML, nothing outside of itself.

mod along;
mod drive;
mod error;
mod health;
mod history;
mod incidents;
mod page;
mod places;
mod plots;
mod reading;
mod roles;
mod shares;

use std::path::{Path, PathBuf};

pub use error::ReportError;
pub use page::html;
pub use reading::{Summary, read};

/// The page's file in the folder that it is written to.
pub const FILE: &str = "report.html";

/// Beyond this size a number is no quantity of a tool, in any unit that is used here, and no axis can show it.
const MOST: f64 = 1e12;

/// Whether a number of a message can be shown: finite, and of a size that something can have.
fn is_quantity(value: f64) -> bool {
    value.abs() < MOST
}

/// Writes the page into `folder`, which is made if it is not there; an older page there is replaced.
///
/// # Errors
/// When a figure cannot be drawn, or the page cannot be written.
pub fn write(summary: &Summary, folder: &Path) -> Result<PathBuf, ReportError> {
    let page = html(summary)?;
    let path = folder.join(FILE);
    let failed = |source| ReportError::Write {
        path: path.clone(),
        source,
    };
    std::fs::create_dir_all(folder).map_err(failed)?;
    std::fs::write(&path, page).map_err(failed)?;
    Ok(path)
}
