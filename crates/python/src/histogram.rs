//! Counts and sums of a run or a part of it; those of all parts merge to the same bits as the whole run.

use crate::errors::python_error;
use crate::{Parameters, range, resources, watch};
use numpy::{Element, IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use restitution_core::collected;
use restitution_core::statistics as core;
use restitution_core::statistics::{Axis, Bins, By, Moments, Rows};
use restitution_core::{Error, Monitor};
use std::ops::Range;

/// The edges of the bins. Rows are bins of the impact velocity, or, if these have no edges, the numbers of the impacts.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Edges<'py> {
    velocity: Option<PyReadonlyArray1<'py, f64>>,
    restitution: PyReadonlyArray1<'py, f64>,
    fraction: Option<PyReadonlyArray1<'py, f64>>,
}

impl Edges<'_> {
    fn bins(&self, impacts: usize) -> PyResult<Bins> {
        let axis = |name, edges: &PyReadonlyArray1<'_, f64>| {
            Axis::new(name, edges.as_slice()?).map_err(python_error)
        };
        Ok(Bins {
            by: match &self.velocity {
                Some(edges) => By::Velocity(axis("velocity_bins", edges)?),
                None => By::Number(impacts),
            },
            restitution: axis("restitution_bins", &self.restitution)?,
            fraction: self
                .fraction
                .as_ref()
                .map(|edges| axis("fraction_bins", edges))
                .transpose()?,
        })
    }
}

/// Counts and sums of the impacts of some particles of a run.
#[pyclass(frozen, module = "restitution._core")]
struct Histogram {
    bins: Bins,
    origin: f64,
    counts: core::Histogram,
}

#[pymethods]
impl Histogram {
    /// The histogram of a run with these bins, from its words.
    #[staticmethod]
    fn read(
        run: Parameters<'_>,
        edges: Edges<'_>,
        words: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<Self> {
        let run = run.run()?;
        let (bins, origin) = (edges.bins(run.impacts)?, run.origin());
        let counts = core::Histogram::from_words(&bins, origin, words.as_slice()?);
        Ok(Self {
            counts: counts.map_err(python_error)?,
            bins,
            origin,
        })
    }

    /// All numbers of the histogram.
    fn words<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u64>>> {
        let words = self.counts.to_words().map_err(python_error)?;
        Ok(words.into_pyarray(py))
    }

    /// The sum of this histogram and others.
    fn merged(&self, others: Vec<PyRef<'_, Self>>) -> PyResult<Self> {
        let mut total = core::Histogram::new(&self.bins, self.origin).map_err(python_error)?;
        total.merge(&self.counts);
        for other in others {
            if other.bins != self.bins || other.origin.to_bits() != self.origin.to_bits() {
                let text = "others: must be histograms with the same bins and the same coefficient of the law";
                return Err(PyValueError::new_err(text));
            }
            total.merge(&other.counts);
        }
        Ok(Self {
            bins: self.bins.clone(),
            origin: self.origin,
            counts: total,
        })
    }

    /// The counts and moments by name.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let copy = self.counts.copied().map_err(python_error)?;
        table(py, copy)
    }
}

/// The histogram by name. The counts themselves are handed over, not a copy: a fine grid is large.
fn table(py: Python<'_>, counts: core::Histogram) -> PyResult<Bound<'_, PyDict>> {
    let core::Histogram {
        restitution,
        fraction,
        rows,
    } = counts;
    let number = rows.gains.len();
    let table = Measured::of(&rows).map_err(python_error)?.table(py)?;
    for (name, grid) in [("count", restitution), ("fraction_count", fraction)] {
        let shape = [number, grid.columns()];
        table.set_item(name, grid.into_counts().into_pyarray(py).reshape(shape)?)?;
    }
    let created = rows.gains.iter().map(|row| row.count as i64);
    table.set_item("energy_created", column(py, created)?)?;
    let largest = rows.gains.iter().map(|row| row.largest);
    table.set_item("largest_energy_ratio", column(py, largest)?)?;
    table.set_item("pulls", rows.pulls)?;
    let stops = rows.stops.iter().map(|&count| count as i64);
    table.set_item("stops", column(py, stops)?)?;
    Ok(table)
}

/// The number of impacts with a defined ε in each row, and what follows from their sums, if there are any: impacts may only be
/// counted.
struct Measured {
    numbers: Vec<i64>,
    moments: Vec<Option<Moments>>,
    fractions: Vec<f64>,
}

impl Measured {
    fn of(rows: &Rows) -> Result<Self, Error> {
        let all = rows.gains.len();
        let summed = 0..rows.moments(0).map_or(0, |_| all);
        Ok(Self {
            numbers: collected("numbers", (0..all).map(|row| rows.number(row) as i64))?,
            moments: collected("moments", summed.clone().map(|row| rows.moments(row)))?,
            fractions: collected(
                "moments",
                summed.map(|row| rows.mean_fraction(row).unwrap_or(f64::NAN)),
            )?,
        })
    }

    /// By name.
    fn table(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let moment = |f: fn(&Moments) -> f64| {
            let value = |moments: &Option<Moments>| moments.as_ref().map_or(f64::NAN, f);
            column(py, self.moments.iter().map(value))
        };
        let table = PyDict::new(py);
        table.set_item("mean", moment(|m| m.mean)?)?;
        table.set_item("variance", moment(|m| m.variance)?)?;
        table.set_item("skewness", moment(|m| m.skewness)?)?;
        table.set_item("kurtosis", moment(|m| m.kurtosis)?)?;
        table.set_item("minimum", moment(|m| m.minimum)?)?;
        table.set_item("maximum", moment(|m| m.maximum)?)?;
        table.set_item("number", self.numbers.into_pyarray(py))?;
        table.set_item("mean_fraction", self.fractions.into_pyarray(py))?;
        Ok(table)
    }
}

/// An array with a value for each row.
fn column<T: Element>(
    py: Python<'_>,
    values: impl ExactSizeIterator<Item = T>,
) -> PyResult<Bound<'_, PyArray1<T>>> {
    let values = collected("velocity_bins or impacts", values).map_err(python_error)?;
    Ok(values.into_pyarray(py))
}

/// Simulates the particles from `part[0]` up to, not including, `part[1]`, or all, and counts their impacts. Returns the histogram, and
/// the `KeyboardInterrupt` that cut the run short, if any.
#[pyfunction]
#[pyo3(signature = (run, edges, threads, progress, part=None))]
fn histogram<'py>(
    py: Python<'py>,
    run: Parameters<'py>,
    edges: Edges<'py>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    part: Option<(usize, usize)>,
) -> PyResult<(Histogram, Option<PyErr>)> {
    let run = run.run()?;
    let resources = resources(threads)?;
    let bins = edges.bins(run.impacts)?;
    let part = range(part, run.particles);
    let (counts, interrupted) = watch::run(py, progress, |monitor: &Monitor| {
        run.statistics_of_part(part, &bins, resources, monitor)
    })?;
    let origin = run.origin();
    Ok((
        Histogram {
            bins,
            origin,
            counts,
        },
        interrupted,
    ))
}

/// The histogram of a run, by name; the moments of each of its parts that was begun; and what cut it short, if anything.
type Counted<'py> = (Bound<'py, PyDict>, Vec<Bound<'py, PyDict>>, Option<PyErr>);

/// The same for the particles of several parts, one part after the other.
#[pyfunction]
fn statistics<'py>(
    py: Python<'py>,
    run: Parameters<'py>,
    edges: Edges<'py>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    parts: Vec<(usize, usize)>,
) -> PyResult<Counted<'py>> {
    let run = run.run()?;
    let resources = resources(threads)?;
    let bins = edges.bins(run.impacts)?;
    let parts: Vec<Range<usize>> = parts.into_iter().map(|(first, end)| first..end).collect();
    let mut measured = Vec::new();
    let (counts, interrupted) = watch::run(py, progress, |monitor: &Monitor| {
        run.statistics_of_parts(&parts, &bins, resources, monitor, |rows| {
            measured.push(Measured::of(rows)?);
            Ok(())
        })
    })?;
    let measured = measured.into_iter().map(|part| part.table(py));
    let measured = measured.collect::<PyResult<_>>()?;
    Ok((table(py, counts)?, measured, interrupted))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Histogram>()?;
    module.add_function(wrap_pyfunction!(histogram, module)?)?;
    module.add_function(wrap_pyfunction!(statistics, module)?)
}
