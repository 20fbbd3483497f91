//! Scene files as Python objects.

use crate::errors::raised;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;
use toml::de::{DeTable, DeValue};
use trackbed::failure::Failure;
use trackbed::scene::Document;

/// Text of a scene file, and its tables in the order of the file.
#[pyfunction]
pub fn read(py: Python<'_>, file: PathBuf) -> PyResult<(String, Bound<'_, PyDict>)> {
    let document = Document::open(&file).map_err(|error| raised(&Failure::from(error)))?;
    let text = document.text();
    let tree = DeTable::parse(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let keys = table(py, tree.get_ref())?;
    Ok((text.to_string(), keys))
}

fn table<'py>(py: Python<'py>, entries: &DeTable<'_>) -> PyResult<Bound<'py, PyDict>> {
    // The parser sorts keys by name.
    let mut ordered: Vec<_> = entries.iter().collect();
    ordered.sort_by_key(|(key, _)| key.span().start);
    let all = PyDict::new(py);
    for (key, entry) in ordered {
        all.set_item(key.get_ref().as_ref(), value(py, entry.get_ref())?)?;
    }
    Ok(all)
}

fn value<'py>(py: Python<'py>, entry: &DeValue<'_>) -> PyResult<Bound<'py, PyAny>> {
    Ok(match entry {
        DeValue::Table(entries) => table(py, entries)?.into_any(),
        DeValue::Array(items) => {
            let all: PyResult<Vec<_>> = items.iter().map(|item| value(py, item.get_ref())).collect();
            PyList::new(py, all?)?.into_any()
        }
        DeValue::Boolean(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
        DeValue::String(text) => text.as_ref().into_pyobject(py)?.into_any(),
        DeValue::Integer(digits) => {
            let number = i64::from_str_radix(digits.as_str(), digits.radix());
            let number = number.map_err(|error| PyValueError::new_err(format!("{digits}: {error}")))?;
            number.into_pyobject(py)?.into_any()
        }
        DeValue::Float(digits) => {
            let number: f64 =
                digits.as_str().parse().map_err(|_| PyValueError::new_err(digits.to_string()))?;
            number.into_pyobject(py)?.into_any()
        }
        DeValue::Datetime(date) => date.to_string().into_pyobject(py)?.into_any(),
    })
}
