//! Counts and sums of a run or a part of it; those of all parts merge to the same bits as the whole run.

use crate::errors::python_error;
use crate::{Parameters, means, range, set, watch};
use numpy::{Element, IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use restitution_core::collected;
use restitution_core::statistics as core;
use restitution_core::statistics::{Axis, Bins, By, Moments};

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
struct Tally {
    bins: Bins,
    origin: f64,
    tally: core::Tally,
}

#[pymethods]
impl Tally {
    /// The tally of a run with these bins, from its words.
    #[staticmethod]
    fn read(
        run: Parameters<'_>,
        edges: Edges<'_>,
        words: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<Self> {
        let run = run.run()?;
        let (bins, origin) = (edges.bins(run.impacts)?, run.origin());
        let tally = core::Tally::from_words(&bins, origin, words.as_slice()?);
        Ok(Self {
            tally: tally.map_err(python_error)?,
            bins,
            origin,
        })
    }

    /// All numbers of the tally.
    fn words<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u64>>> {
        let words = self.tally.to_words().map_err(python_error)?;
        Ok(words.into_pyarray(py))
    }

    /// The sum of this tally and others.
    fn merged(&self, others: Vec<PyRef<'_, Self>>) -> PyResult<Self> {
        let mut total = core::Tally::new(&self.bins, self.origin).map_err(python_error)?;
        total.merge(&self.tally);
        for other in others {
            if other.bins != self.bins || other.origin.to_bits() != self.origin.to_bits() {
                let text = "others: must be tallies with the same bins and the same coefficient of the law";
                return Err(PyValueError::new_err(text));
            }
            total.merge(&other.tally);
        }
        Ok(Self {
            bins: self.bins.clone(),
            origin: self.origin,
            tally: total,
        })
    }

    /// The counts and moments by name.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tally = &self.tally;
        let table = self.moments(py)?;
        for (name, grid) in [
            ("count", &tally.restitution),
            ("fraction_count", &tally.fraction),
        ] {
            let counts = grid.to_counts().map_err(python_error)?;
            set(py, &table, name, (self.bins.rows(), grid.columns()), counts)?;
        }
        let created = tally.gains.iter().map(|row| row.count as i64);
        table.set_item("energy_created", column(py, created)?)?;
        let largest = tally.gains.iter().map(|row| row.largest);
        table.set_item("largest_energy_ratio", column(py, largest)?)?;
        let stops = tally.stops.map(|count| count as i64).to_vec();
        table.set_item("stops", stops.into_pyarray(py))?;
        Ok(table)
    }

    /// The number of impacts with a defined ε in each row, and their moments by name.
    fn moments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tally = &self.tally;
        // Row by row, because a fine grid does not fit into the cache, but one of its rows does.
        let rows = self.bins.rows();
        let numbers = (0..rows).map(|row| tally.number(row) as i64);
        // Where impacts are only counted, no row has moments.
        let summed = 0..tally.moments(0).map_or(0, |_| rows);
        let every = summed.clone().map(|row| tally.moments(row));
        let moments = collected("moments", every).map_err(python_error)?;
        let fractions = summed.map(|row| tally.mean_fraction(row).unwrap_or(f64::NAN));
        let moment = |f: fn(&Moments) -> f64| {
            let value = |moments: &Option<Moments>| moments.as_ref().map_or(f64::NAN, f);
            column(py, moments.iter().map(value))
        };
        let table = PyDict::new(py);
        table.set_item("number", column(py, numbers)?)?;
        table.set_item("mean", moment(|m| m.mean)?)?;
        table.set_item("variance", moment(|m| m.variance)?)?;
        table.set_item("skewness", moment(|m| m.skewness)?)?;
        table.set_item("kurtosis", moment(|m| m.kurtosis)?)?;
        table.set_item("minimum", moment(|m| m.minimum)?)?;
        table.set_item("maximum", moment(|m| m.maximum)?)?;
        table.set_item("mean_fraction", column(py, fractions)?)?;
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

/// Simulates the particles from `part[0]` up to, not including, `part[1]`, or all, and counts their impacts. Returns the tally, and
/// the `KeyboardInterrupt` that cut the run short, if any.
#[pyfunction]
#[pyo3(signature = (run, edges, threads, progress, part=None))]
fn statistics<'py>(
    py: Python<'py>,
    run: Parameters<'py>,
    edges: Edges<'py>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    part: Option<(usize, usize)>,
) -> PyResult<(Tally, Option<PyErr>)> {
    let run = run.run()?;
    let means = means(threads)?;
    let bins = edges.bins(run.impacts)?;
    let part = range(part, run.particles);
    let (tally, interrupted) = watch::run(py, progress, |monitor| {
        run.statistics_of_part(part, &bins, means, monitor)
    })?;
    let origin = run.origin();
    Ok((
        Tally {
            bins,
            origin,
            tally,
        },
        interrupted,
    ))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Tally>()?;
    module.add_function(wrap_pyfunction!(statistics, module)?)
}
