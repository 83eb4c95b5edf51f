//! The module `flexdrill._native`: thin, all checks and names are in the package around it.

// The macros of PyO3 write the glue to the C interface of Python.
#![allow(unsafe_code)]

mod alarms;
mod arrays;
mod errors;
mod recorder;
mod rollout;
mod twin;

use pyo3::prelude::*;

use crate::columns::{GROUPS, INSTANT};
use flexdrill_motion::{HazardKind, Severity, WhirlKind};

/// The columns of every group, in order: group, column, and whether it is constant. The group of the instant is empty.
#[pyfunction]
fn columns() -> Vec<(&'static str, &'static str, bool)> {
    let instant = INSTANT.columns.iter().map(|column| ("", column));
    let grouped = GROUPS
        .iter()
        .flat_map(|group| group.columns.iter().map(|column| (group.name, column)));
    let all = instant.chain(grouped);
    all.map(|(group, column)| (group, column.name, column.fixed)).collect()
}

/// The names of the codes: hazards, severities, kinds of whirl.
#[pyfunction]
fn names() -> (Vec<&'static str>, Vec<&'static str>, Vec<&'static str>) {
    let severities = [Severity::Ok, Severity::Watch, Severity::Warning, Severity::Critical];
    let whirl = [
        WhirlKind::None,
        WhirlKind::Forward,
        WhirlKind::Backward,
        WhirlKind::Chaotic,
        WhirlKind::JointVibration,
    ];
    (
        HazardKind::ALL.iter().map(|kind| kind.name()).collect(),
        severities.iter().map(|severity| severity.name()).collect(),
        whirl.iter().map(|kind| kind.name()).collect(),
    )
}

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<twin::Twin>()?;
    module.add_class::<recorder::Recorder>()?;
    module.add_function(wrap_pyfunction!(columns, module)?)?;
    module.add_function(wrap_pyfunction!(names, module)?)?;
    module.add_function(wrap_pyfunction!(rollout::rollout, module)?)?;
    Ok(())
}
