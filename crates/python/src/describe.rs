//! The table of bodies, laws and materials, as dictionaries.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::Creation;
use restitution_core::{BODIES, LAWS, MATERIALS};

fn argument(py: Python<'_>, given: Argument<'_>) -> PyResult<Py<PyAny>> {
    Ok(match given {
        Argument::Number(number) => number.into_pyobject(py)?.into_any().unbind(),
        Argument::Pair(pair) => pair.into_pyobject(py)?.into_any().unbind(),
        Argument::Numbers(numbers) => numbers.into_pyobject(py)?.into_any().unbind(),
        Argument::Name(name) => name.into_pyobject(py)?.into_any().unbind(),
    })
}

/// Name, text and unit of a parameter; `type`, and the interval (`low`, `high`, `closed` for whether the lower end belongs to it) or the
/// `names` that are allowed; `default`, unless it must be given.
fn parameter<'py>(py: Python<'py>, about: &Parameter) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    entry.set_item("name", about.name)?;
    entry.set_item("text", about.text)?;
    entry.set_item("unit", about.unit)?;
    let interval = |kind: &str, interval: Interval| {
        entry.set_item("type", kind)?;
        entry.set_item("low", interval.low)?;
        entry.set_item("high", interval.high)?;
        entry.set_item("closed", interval.closed)
    };
    match about.allowed {
        Allowed::Number(allowed) => interval("number", allowed)?,
        Allowed::Pair(allowed) => interval("pair", allowed)?,
        Allowed::Numbers(allowed) => interval("numbers", allowed)?,
        Allowed::Name(names) => {
            entry.set_item("type", "name")?;
            entry.set_item("names", names)?;
        }
    }
    if let Some(default) = about.default {
        entry.set_item("default", argument(py, default)?)?;
    }
    Ok(entry)
}

fn kind<'py, T>(py: Python<'py>, about: &Kind<T>) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    entry.set_item("name", about.name)?;
    entry.set_item("text", about.text)?;
    let parameters = PyList::empty(py);
    for about in about.parameters {
        parameters.append(parameter(py, about)?)?;
    }
    entry.set_item("parameters", parameters)?;
    Ok(entry)
}

fn kinds<'py, T>(py: Python<'py>, all: &[Kind<T>]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    all.iter().map(|about| kind(py, about)).collect()
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("BODIES", kinds(py, BODIES)?)?;
    module.add("MATERIALS", kinds(py, MATERIALS)?)?;
    let law = |about: &restitution_core::law::LawKind| {
        let entry = kind(py, &about.kind)?;
        match about.creates_energy {
            Creation::Never => entry.set_item("creates_energy", false)?,
            Creation::Possible => entry.set_item("creates_energy", true)?,
            Creation::Where(parameter, value) => {
                entry.set_item("creates_energy", (parameter, value))?;
            }
        }
        Ok(entry)
    };
    let laws: Vec<_> = LAWS.iter().map(law).collect::<PyResult<_>>()?;
    module.add("LAWS", laws)
}
