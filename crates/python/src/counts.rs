//! Impacts counted for a learned distribution: tables of shape (particle, impact) in, counts out.

use crate::distribution::{Mixture, nodes, owned};
use crate::errors::python_error;
use crate::{resources, watch};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use restitution_core::distribution::{COARSE, Impacts};
use restitution_core::{Monitor, collected};

type Array<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;

/// The impacts in tables with a row for each particle, of which the first is that of the particle `first`.
fn impacts<'a>(
    velocity: &'a Rows<'_>,
    restitution: &'a Rows<'_>,
    condition: Option<&'a Rows<'_>>,
    first: usize,
) -> PyResult<Impacts<'a>> {
    let columns = velocity.as_array().ncols();
    let condition = condition.map(|rows| rows.as_slice()).transpose()?;
    let (v, e) = (velocity.as_slice()?, restitution.as_slice()?);
    Impacts::new(v, e, condition, columns, first).map_err(python_error)
}

/// Counts of the impacts at the components of a distribution.
#[pyclass(module = "restitution._core")]
struct Counter {
    counter: restitution_core::distribution::Counter,
    components: usize,
    batches: usize,
}

#[pymethods]
impl Counter {
    /// No impacts, at nodes and conditions in ragged arrays as in `Mixture`; `edges` are inner ones, those of each component begin
    /// at `start`.
    #[new]
    fn new(
        speeds: Array<'_>,
        first: PyReadonlyArray1<'_, i64>,
        conditions: Array<'_>,
        start: PyReadonlyArray1<'_, i64>,
        edges: Array<'_>,
        batches: usize,
    ) -> PyResult<Self> {
        let nodes = nodes(&speeds, &first, &conditions)?;
        let components = conditions.as_slice()?.len();
        let (start, edges) = (owned(&start)?, owned(&edges)?);
        let counter = restitution_core::distribution::Counter::new(nodes, start, edges, batches);
        Ok(Self {
            counter: counter.map_err(python_error)?,
            components,
            batches,
        })
    }

    /// Counts impacts of the particles from `first` on, with NaN where there was none. Returns the `KeyboardInterrupt` that cut the
    /// work short, if any.
    fn add(
        &mut self,
        py: Python<'_>,
        velocity: Rows<'_>,
        restitution: Rows<'_>,
        condition: Option<Rows<'_>>,
        first: usize,
        threads: usize,
    ) -> PyResult<Option<PyErr>> {
        let impacts = impacts(&velocity, &restitution, condition.as_ref(), first)?;
        let (counter, resources) = (&mut self.counter, resources(threads)?);
        let work = |monitor: &Monitor| counter.add(&impacts, resources, monitor);
        Ok(watch::run(py, None, work)?.1)
    }

    /// The counts by name.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counts = self.counter.counts().map_err(python_error)?;
        let (components, batches) = (self.components, self.batches);
        let bins = counts.count.len() / batches;
        let speeds = counts.seen.len() / 2;
        let table = PyDict::new(py);
        let count = counts.count.into_pyarray(py).reshape([batches, bins])?;
        table.set_item("count", count)?;
        let powers = counts.powers.into_pyarray(py);
        table.set_item("powers", powers.reshape([3, batches, components])?)?;
        table.set_item("lowest", counts.lowest.into_pyarray(py))?;
        table.set_item("highest", counts.highest.into_pyarray(py))?;
        let seen = counts.seen.into_pyarray(py).reshape([2, speeds])?;
        table.set_item("seen", seen)?;
        Ok(table)
    }
}

/// Counts of the quantile levels of impacts under a distribution.
#[pyclass(module = "restitution._core")]
struct Levels {
    levels: restitution_core::distribution::Levels,
    batches: usize,
}

#[pymethods]
impl Levels {
    /// No levels, in the intervals between as many nodes.
    #[new]
    fn new(nodes: usize, batches: usize) -> PyResult<Self> {
        let levels = restitution_core::distribution::Levels::new(nodes, batches);
        Ok(Self {
            levels: levels.map_err(python_error)?,
            batches,
        })
    }

    /// Counts impacts of the particles from `first` on, with NaN where there was none; restitutions that differ by less than `point`
    /// are the same. Returns the `KeyboardInterrupt` that cut the work short, if any.
    #[allow(clippy::too_many_arguments)]
    fn add(
        &mut self,
        py: Python<'_>,
        mixture: PyRef<'_, Mixture>,
        point: f64,
        velocity: Rows<'_>,
        restitution: Rows<'_>,
        first: usize,
        threads: usize,
    ) -> PyResult<Option<PyErr>> {
        let impacts = impacts(&velocity, &restitution, None, first)?;
        let (levels, mixture, resources) = (&mut self.levels, &mixture.0, resources(threads)?);
        let work = |monitor: &Monitor| levels.add(mixture, point, &impacts, resources, monitor);
        Ok(watch::run(py, None, work)?.1)
    }

    /// The counts of all impacts in an interval, over levels.
    fn fine<'py>(&self, py: Python<'py>, interval: usize) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let counts = self.levels.fine(interval).map_err(python_error)?;
        let counts = counts.into_iter().map(|count| count as i64);
        let counts = collected("levels", counts).map_err(python_error)?;
        Ok(counts.into_pyarray(py))
    }

    /// The counts of the batches in an interval, over batches and levels, as numbers that are resampled.
    fn coarse<'py>(&self, py: Python<'py>, interval: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let counts = self.levels.coarse(interval).map_err(python_error)?;
        let counts: Vec<_> = counts.map(|count| count as f64).collect();
        counts.into_pyarray(py).reshape([self.batches, COARSE])
    }
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Counter>()?;
    module.add_class::<Levels>()
}
