//! The table of bodies, laws and materials, as dictionaries.

use crate::errors::python_error;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyLookupError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use restitution_core::describe::{Allowed, Argument, Interval, Kind, Parameter};
use restitution_core::law::{Creation, LawKind, Slip};
use restitution_core::{BODIES, BodyKind, LAWS, MATERIALS};

/// A parameter as Python gives it.
#[derive(FromPyObject)]
pub enum Given<'py> {
    Numbers(PyReadonlyArray1<'py, f64>),
    Whole(u64),
    Number(f64),
    Name(String),
    Pair([f64; 2]),
    Drawn((String, Vec<f64>)),
}

/// They as the core takes them.
pub fn arguments<'a>(given: &'a [Option<Given<'_>>]) -> PyResult<Vec<Argument<'a>>> {
    let argument = |given: &'a Option<Given<'_>>| {
        Ok(match given {
            None => Argument::Absent,
            Some(Given::Number(number)) => Argument::Number(*number),
            Some(Given::Whole(number)) => Argument::Whole(*number),
            Some(Given::Name(name)) => Argument::Name(name),
            Some(Given::Pair(pair)) => Argument::Pair(*pair),
            Some(Given::Numbers(numbers)) => Argument::Numbers(numbers.as_slice()?),
            Some(Given::Drawn((name, numbers))) => Argument::Drawn(name, numbers),
        })
    };
    given.iter().map(argument).collect()
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
    (kind.make)(&arguments(given)?).map_err(python_error)
}

fn argument(py: Python<'_>, given: Argument<'_>) -> PyResult<Py<PyAny>> {
    Ok(match given {
        Argument::Number(number) => number.into_pyobject(py)?.into_any().unbind(),
        Argument::Pair(pair) => pair.into_pyobject(py)?.into_any().unbind(),
        Argument::Numbers(numbers) => numbers.into_pyobject(py)?.into_any().unbind(),
        Argument::Whole(number) => number.into_pyobject(py)?.into_any().unbind(),
        Argument::Drawn(name, numbers) => (name, numbers).into_pyobject(py)?.into_any().unbind(),
        Argument::Name(name) => name.into_pyobject(py)?.into_any().unbind(),
        Argument::Absent => py.None(),
    })
}

/// Name, name in links, text and unit of a parameter; `type`, and the names of the `columns` and the `least` number of rows of a table; and the interval (`low`, `high`, `closed` for whether the lower end belongs to it) or the
/// `names` that are allowed; `default`, unless it must be given; `example`.
fn parameter<'py>(py: Python<'py>, about: &Parameter) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    entry.set_item("name", about.name)?;
    entry.set_item("link", about.link)?;
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
        Allowed::Whole(allowed) => interval("whole", allowed)?,
        Allowed::Choice(numbers) => {
            entry.set_item("type", "choice")?;
            entry.set_item("names", numbers.to_vec())?;
        }
        Allowed::Several(names, allowed) => {
            interval("several", allowed)?;
            let links: Vec<_> = names.iter().map(|[link, _]| link).collect();
            entry.set_item("names", links)?;
        }
        Allowed::Rows(columns, least, allowed) => {
            interval("rows", allowed)?;
            entry.set_item("columns", columns)?;
            entry.set_item("least", least)?;
        }
        Allowed::Name(names) => {
            entry.set_item("type", "name")?;
            entry.set_item("names", names)?;
        }
    }
    entry.set_item("example", argument(py, about.example)?)?;
    if let (Allowed::Rows(columns, ..), Argument::Numbers(numbers)) = (about.allowed, about.example)
    {
        let rows: Vec<_> = numbers.chunks(columns.len()).collect();
        entry.set_item("example", rows)?;
    }
    if let Some(default) = about.default {
        entry.set_item("default", argument(py, default)?)?;
    }
    Ok(entry)
}

fn kind<'py>(
    py: Python<'py>,
    (name, text): (&str, &str),
    all: &[Parameter],
) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    entry.set_item("name", name)?;
    entry.set_item("text", text)?;
    let parameters = PyList::empty(py);
    for about in all {
        parameters.append(parameter(py, about)?)?;
    }
    entry.set_item("parameters", parameters)?;
    Ok(entry)
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let body = |about: &BodyKind| {
        let (name, text, parameters) = about.about();
        let entry = kind(py, (name, text), parameters)?;
        entry.set_item("rigid", matches!(about, BodyKind::Rigid(..)))?;
        Ok(entry)
    };
    let bodies: Vec<_> = BODIES.iter().map(body).collect::<PyResult<_>>()?;
    module.add("BODIES", bodies)?;
    let materials = MATERIALS.iter();
    let material = |about: &Kind<_>| kind(py, (about.name, about.text), about.parameters);
    module.add(
        "MATERIALS",
        materials.map(material).collect::<PyResult<Vec<_>>>()?,
    )?;
    let law = |about: &LawKind| {
        let entry = kind(
            py,
            (about.kind.name, about.kind.text),
            about.kind.parameters,
        )?;
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
