//! A recording in the making.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::{alarms, arrays, errors};
use crate::recorder;

/// Columns that grow while twins run; `finish` takes them out.
#[pyclass(module = "flexdrill._native")]
pub(super) struct Recorder {
    inner: Option<recorder::Recorder>,
}

#[pymethods]
impl Recorder {
    /// For groups of columns; `rate_hz` None takes samples by hand only.
    #[new]
    fn new(py: Python<'_>, groups: Vec<String>, rate_hz: Option<f64>, time_step_s: f64) -> PyResult<Self> {
        let every = match rate_hz {
            Some(rate) => {
                recorder::Recorder::interval(rate, time_step_s).map_err(|error| errors::recorder(py, &error))?
            }
            None => 0,
        };
        let inner = recorder::Recorder::new(groups.iter().map(String::as_str), every)
            .map_err(|error| errors::recorder(py, &error))?;
        Ok(Self { inner: Some(inner) })
    }

    /// The events of the alarms so far.
    fn alarms(&self) -> PyResult<Vec<alarms::Row>> {
        let inner = self.inner.as_ref().ok_or_else(used)?;
        Ok(inner.alarms.iter().map(alarms::row).collect())
    }

    /// The columns as arrays by name; the recorder is empty then.
    fn finish<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        arrays::dictionary(py, self.take()?.finish())
    }
}

impl Recorder {
    /// Takes the columns out, to fill them without Python.
    pub(super) fn take(&mut self) -> PyResult<recorder::Recorder> {
        self.inner.take().ok_or_else(used)
    }

    /// Puts them back.
    pub(super) fn put(&mut self, inner: recorder::Recorder) {
        self.inner = Some(inner);
    }
}

fn used() -> PyErr {
    pyo3::exceptions::PyRuntimeError::new_err("the recorder has been finished, or is in use")
}
