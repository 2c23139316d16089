//! The table of bodies, laws and materials, as dictionaries.

use crate::errors::python_error;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyLookupError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::{Creation, LawKind, Slip};
use restitution_core::{BODIES, LAWS, MATERIALS};

/// A parameter as Python gives it.
#[derive(FromPyObject)]
pub enum Given<'py> {
    Numbers(PyReadonlyArray1<'py, f64>),
    Number(f64),
    Name(String),
    Pair([f64; 2]),
}

/// The entry of the table with a name, made from its parameters.
pub fn made<'a, T: 'static>(
    mut table: impl Iterator<Item = &'a Kind<T>>,
    name: &str,
    given: &[Option<Given<'_>>],
) -> PyResult<T> {
    let kind = table
        .find(|kind| kind.name == name)
        .ok_or_else(|| PyLookupError::new_err(format!("no {name} in the table")))?;
    let arguments: Vec<_> = given
        .iter()
        .map(|given| {
            Ok(match given {
                None => Argument::Absent,
                Some(Given::Number(number)) => Argument::Number(*number),
                Some(Given::Name(name)) => Argument::Name(name),
                Some(Given::Pair(pair)) => Argument::Pair(*pair),
                Some(Given::Numbers(numbers)) => Argument::Numbers(numbers.as_slice()?),
            })
        })
        .collect::<PyResult<_>>()?;
    (kind.make)(&arguments).map_err(python_error)
}

fn argument(py: Python<'_>, given: Argument<'_>) -> PyResult<Py<PyAny>> {
    Ok(match given {
        Argument::Number(number) => number.into_pyobject(py)?.into_any().unbind(),
        Argument::Pair(pair) => pair.into_pyobject(py)?.into_any().unbind(),
        Argument::Numbers(numbers) => numbers.into_pyobject(py)?.into_any().unbind(),
        Argument::Name(name) => name.into_pyobject(py)?.into_any().unbind(),
        Argument::Absent => py.None(),
    })
}

/// Name, text and unit of a parameter; `type`, and the interval (`low`, `high`, `closed` for whether the lower end belongs to it) or the
/// `names` that are allowed; `default`, unless it must be given; `example`.
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
    entry.set_item("example", argument(py, about.example)?)?;
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
    let law = |about: &LawKind| {
        let entry = kind(py, &about.kind)?;
        match about.creates_energy {
            Creation::Never => entry.set_item("creates_energy", false)?,
            Creation::Possible => entry.set_item("creates_energy", true)?,
            Creation::Where(parameter, value) => {
                entry.set_item("creates_energy", (parameter, value))?;
            }
        }
        let slip = |slip: Slip| match slip {
            Slip::Free => "free",
            Slip::Stuck => "stuck",
            Slip::Sliding => "sliding",
            Slip::Part => "part",
        };
        let from_rest = about
            .from_rest
            .map(|[within, beyond]| (slip(within), slip(beyond)));
        entry.set_item("from_rest", from_rest)?;
        Ok(entry)
    };
    let laws: Vec<_> = LAWS.iter().map(law).collect::<PyResult<_>>()?;
    module.add("LAWS", laws)
}
