//! Rust's errors as the exceptions of `flexdrill._errors`.

use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use flexdrill_config::{ConfigError, Problem};
use flexdrill_core::dynamics::{FailureCause, StepFailure};
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::BuildError;

use crate::recorder::RecorderError;
use crate::saved::SavedError;
use crate::twin::InputError;

/// The exception of that name, made from keywords; an error in making it takes its place.
fn exception(py: Python<'_>, class: &str, keywords: PyResult<Bound<'_, PyDict>>) -> PyErr {
    let made = keywords.and_then(|keywords| {
        let class = py.import("flexdrill._errors")?.getattr(class)?;
        class.call((), Some(&keywords))
    });
    made.map_or_else(|error| error, PyErr::from_value)
}

fn problem<'py>(py: Python<'py>, problem: &Problem) -> PyResult<Bound<'py, PyAny>> {
    let keywords = PyDict::new(py);
    keywords.set_item("file", &problem.file)?;
    keywords.set_item("line", problem.line)?;
    keywords.set_item("key", &problem.key)?;
    keywords.set_item("value", &problem.value)?;
    keywords.set_item("unit", problem.unit)?;
    keywords.set_item("bound", &problem.bound)?;
    keywords.set_item("reason", &problem.reason)?;
    py.import("flexdrill._errors")?
        .getattr("Problem")?
        .call((), Some(&keywords))
}

pub(super) fn config(py: Python<'_>, error: &ConfigError) -> PyErr {
    let problems: &[Problem] = match error {
        ConfigError::Invalid { problems } => problems,
        _ => &[],
    };
    let keywords = || {
        let problems: Vec<_> = problems.iter().map(|one| problem(py, one)).collect::<PyResult<_>>()?;
        let keywords = PyDict::new(py);
        keywords.set_item("message", error.to_string())?;
        keywords.set_item("problems", problems)?;
        Ok(keywords)
    };
    exception(py, "ConfigError", keywords())
}

pub(super) fn build(py: Python<'_>, error: &BuildError) -> PyErr {
    exception(py, "StartError", [("message", error.to_string())].into_py_dict(py))
}

pub(super) fn saved(py: Python<'_>, error: &SavedError) -> PyErr {
    match error {
        SavedError::Config(error) => config(py, error),
        _ => exception(py, "SavedStateError", [("message", error.to_string())].into_py_dict(py)),
    }
}

pub(super) fn recorder(py: Python<'_>, error: &RecorderError) -> PyErr {
    exception(py, "RecordError", [("message", error.to_string())].into_py_dict(py))
}

pub(super) fn input(py: Python<'_>, error: &InputError) -> PyErr {
    let keywords = || {
        let keywords = PyDict::new(py);
        keywords.set_item("message", error.to_string())?;
        keywords.set_item("input", error.kind.name())?;
        keywords.set_item("time_s", error.time)?;
        keywords.set_item("value", error.value)?;
        keywords.set_item("bound", (error.min, error.max))?;
        keywords.set_item("unit", error.kind.unit())?;
        Ok(keywords)
    };
    exception(py, "InputError", keywords())
}

pub(super) fn step(py: Python<'_>, failure: &StepFailure) -> PyErr {
    let (bound, unit) = match failure.cause {
        FailureCause::InputOutOfBounds(kind) => {
            let [low, high] = Inputs::bounds(kind);
            (Some((low, high)), kind.si_unit())
        }
        _ => (None, "N or N m"),
    };
    let keywords = || {
        let keywords = PyDict::new(py);
        let message = format!("step at model time {:.4} s failed: {failure}", failure.time);
        keywords.set_item("message", message)?;
        keywords.set_item("time_s", failure.time)?;
        keywords.set_item("step_s", failure.step)?;
        keywords.set_item("station", failure.station)?;
        keywords.set_item("body", failure.body.to_string())?;
        keywords.set_item("cause", failure.cause.name())?;
        keywords.set_item("value", failure.value)?;
        keywords.set_item("bound", bound)?;
        keywords.set_item("unit", unit)?;
        Ok(keywords)
    };
    exception(py, "StepError", keywords())
}

/// A value that does not make sense.
pub(super) fn value(py: Python<'_>, message: String) -> PyErr {
    exception(py, "ValueOutOfBounds", [("message", message)].into_py_dict(py))
}
