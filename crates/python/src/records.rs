//! Recorded impacts: each variable with the dimensions, values and attributes that xarray takes.

use crate::bodies::Dropped;
use crate::errors::python_error;
use crate::laws::Law;
use crate::{Parameters, range, resources, watch};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PyTuple};
use restitution_core::{Columns, PER_IMPACT, Records, Values, Variable};

/// The numbers of the recorded particles, for runs in which some had to be left out.
const NUMBER: Variable = Variable {
    name: "particle",
    text: "number of the particle, from 0",
    ..Variable::PLAIN
};

fn named(columns: &[String]) -> PyResult<Columns> {
    Columns::named(PER_IMPACT, columns.iter().map(String::as_str)).map_err(python_error)
}

/// The names of the variables of an impact that are recorded of a body under a law, with the full state if `state`.
#[pyfunction]
#[pyo3(signature = (body, law, state=false))]
fn columns(body: Dropped<'_>, law: &Law, state: bool) -> Vec<&'static str> {
    let chosen = Columns::usual(body.body(), &law.law(), state);
    chosen.of(PER_IMPACT).map(|about| about.key).collect()
}

/// Simulates the particles from `part[0]` up to, not including, `part[1]`, or all, and records the variables in `columns`, or those
/// that are usual under the law. Returns them by name, and the `KeyboardInterrupt` that cut the run short, if any.
#[pyfunction]
#[pyo3(signature = (run, threads, progress, part=None, columns=None))]
fn simulate<'py>(
    py: Python<'py>,
    run: Parameters<'py>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    part: Option<(usize, usize)>,
    columns: Option<Vec<String>>,
) -> PyResult<(Bound<'py, PyDict>, Option<PyErr>)> {
    let run = run.run()?;
    let resources = resources(threads)?;
    let columns = match columns {
        Some(names) => named(&names)?,
        None => Columns::usual(run.body, &run.law, false),
    };
    let part = range(part, run.particles);
    let (records, interrupted) = watch::run(py, progress, |monitor| {
        run.simulate_columns(part, &columns, resources, monitor)
    })?;
    Ok((table(py, records, run.impacts)?, interrupted))
}

/// Simulates several runs as one, of each the particles from the first number up to, not including, the second, and records the variables
/// in `columns`. The runs may differ in seed, number of particles and release alone. Returns as `simulate`.
#[pyfunction]
fn simulate_series<'py>(
    py: Python<'py>,
    runs: Vec<(Parameters<'py>, (usize, usize))>,
    threads: usize,
    columns: Vec<String>,
) -> PyResult<(Bound<'py, PyDict>, Option<PyErr>)> {
    let parts = runs
        .iter()
        .map(|(run, part)| Ok((run.run()?, part.0..part.1)));
    let parts: Vec<_> = parts.collect::<PyResult<_>>()?;
    let (resources, columns) = (resources(threads)?, named(&columns)?);
    let (records, interrupted) = watch::run(py, None, |monitor| {
        restitution_core::simulate_series(&parts, &columns, resources, monitor)
    })?;
    Ok((table(py, records, parts[0].0.impacts)?, interrupted))
}

/// The recorded variables by name.
fn table(py: Python<'_>, mut records: Records, impacts: usize) -> PyResult<Bound<'_, PyDict>> {
    let (particles, reached) = (records.particles(), records.reached);
    let table = PyDict::new(py);
    if !records.particle.is_empty() {
        let numbers = Values::Counts(std::mem::take(&mut records.particle));
        let dimensions = [("particle", particles)];
        table.set_item("particle", variable(py, &NUMBER, &dimensions, numbers)?)?;
    }
    for (about, values) in records.per_impact() {
        let dimensions = [("particle", particles), ("impact", impacts)];
        let (names, values, attributes) = variable(py, &about, &dimensions, values)?;
        let within = (PySlice::full(py), PySlice::new(py, 0, reached as isize, 1));
        table.set_item(about.name, (names, values.get_item(within)?, attributes))?;
    }
    for (about, values) in records.per_particle() {
        let dimensions = [("particle", particles)];
        table.set_item(about.name, variable(py, &about, &dimensions, values)?)?;
    }
    Ok(table)
}

/// Memory for one impact with these variables, in bytes.
#[pyfunction]
fn bytes_per_impact(columns: Vec<String>) -> PyResult<usize> {
    let chosen = named(&columns)?;
    Ok(chosen.of(PER_IMPACT).map(Variable::bytes).sum())
}

/// Dimensions, values and attributes, named according to the CF conventions.
pub fn variable<'py>(
    py: Python<'py>,
    about: &Variable,
    dimensions: &[(&str, usize)],
    values: Values,
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyAny>, Bound<'py, PyDict>)> {
    let mut dimensions = dimensions.to_vec();
    if about.each {
        dimensions.push(("particle", 2));
    }
    match about.components.len() {
        0 => {}
        3 => dimensions.push(("component", 3)),
        parts => dimensions.push(("quaternion", parts)),
    }
    let (names, shape): (Vec<_>, Vec<_>) = dimensions.into_iter().unzip();
    let attributes = PyDict::new(py);
    attributes.set_item("long_name", about.text)?;
    if let Some(unit) = about.unit {
        attributes.set_item("units", unit)?;
    }
    if let Some(symbol) = about.symbol {
        attributes.set_item("symbol", symbol)?;
    }
    if !about.meanings.is_empty() {
        let numbers: Vec<_> = (0..about.meanings.len() as i8).collect();
        attributes.set_item("flag_values", numbers.into_pyarray(py))?;
        attributes.set_item("flag_meanings", about.meanings.join(" "))?;
    }
    let values = match values {
        Values::Numbers(values) => values.into_pyarray(py).reshape(shape)?.into_any(),
        Values::Flags(values) => values.into_pyarray(py).reshape(shape)?.into_any(),
        Values::Parts(values) => values.into_pyarray(py).reshape(shape)?.into_any(),
        Values::Counts(values) => values.into_pyarray(py).reshape(shape)?.into_any(),
    };
    Ok((PyTuple::new(py, names)?, values, attributes))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(columns, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)?;
    module.add_function(wrap_pyfunction!(simulate_series, module)?)?;
    module.add_function(wrap_pyfunction!(bytes_per_impact, module)?)
}
