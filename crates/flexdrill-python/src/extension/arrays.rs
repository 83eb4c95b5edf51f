//! Columns as arrays of NumPy that take over the memory and cannot be written to.

use numpy::{Element, PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::recorder::{Finished, Values};

/// A dictionary of arrays by name.
pub(super) fn dictionary<'py>(py: Python<'py>, columns: Vec<Finished>) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    for Finished { name, shape, values } in columns {
        let array = match values {
            Values::Real(values) => array(py, values, shape)?,
            Values::Code(values) => array(py, values, shape)?,
            Values::Count(values) => array(py, values, shape)?,
        };
        out.set_item(name, array)?;
    }
    Ok(out)
}

fn array<T: Element>(py: Python<'_>, values: Vec<T>, shape: Vec<usize>) -> PyResult<Bound<'_, PyAny>> {
    let flat = PyArray1::from_vec(py, values);
    debug_assert_eq!(flat.len(), shape.iter().product::<usize>());
    let array = flat.reshape(shape)?;
    let array = array.readwrite().make_nonwriteable();
    Ok(array.as_any().clone())
}
