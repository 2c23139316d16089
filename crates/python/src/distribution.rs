//! A learned distribution of the coefficient of restitution, checked when it is made: arrays in, arrays out.

use crate::errors::python_error;
use crate::{resources, watch};
use numpy::{Element, IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use restitution_core::distribution::{At, BLOCK, Broadcast, Curve, Layout, Nodes};
use restitution_core::{Error, Monitor, Resources, copied};

/// The table of a distribution.
#[pyclass(frozen, module = "restitution._core")]
pub struct Mixture(pub(crate) restitution_core::distribution::Mixture);

type Array<'py> = PyReadonlyArray1<'py, f64>;

/// Broadcast, and the `KeyboardInterrupt` that cut them short, if any.
type Filled<'py> = (Bound<'py, PyArray1<f64>>, Option<PyErr>);

/// Speeds, the first component of each, and the conditions of the components.
pub(crate) fn nodes(
    speeds: &Array<'_>,
    first: &PyReadonlyArray1<'_, i64>,
    conditions: &Array<'_>,
) -> PyResult<Nodes> {
    Nodes::new(owned(speeds)?, owned(first)?, owned(conditions)?).map_err(python_error)
}

/// A copy of an array of a table.
pub(crate) fn owned<T: Element + Copy>(values: &PyReadonlyArray1<'_, T>) -> PyResult<Vec<T>> {
    copied("table", values.as_slice()?).map_err(python_error)
}

impl Mixture {
    /// Fills `size` values at speeds and conditions.
    fn fill<'py>(
        &self,
        py: Python<'py>,
        (v, z): (&Array<'py>, &Array<'py>),
        (size, threads): (usize, usize),
        work: impl FnOnce(At<'_>, &mut [f64], Resources, &Monitor) -> Result<(), Error> + Send,
    ) -> PyResult<Filled<'py>> {
        let resources = resources(threads)?;
        let at = At {
            speed: Broadcast::new(v.as_slice()?, "v", size).map_err(python_error)?,
            condition: Broadcast::new(z.as_slice()?, "given", size).map_err(python_error)?,
        };
        let compute = |monitor: &Monitor| {
            let mut out = restitution_core::distribution::values(size)?;
            work(at, &mut out, resources, monitor)?;
            Ok(out)
        };
        let (out, interrupted) = if size <= BLOCK {
            // A program that asks for one value at a time must not wait for threads to start.
            let out = py.detach(|| compute(&Monitor::default()));
            (out.map_err(python_error)?, None)
        } else {
            watch::run(py, None, compute)?
        };
        Ok((out.into_pyarray(py), interrupted))
    }
}

#[pymethods]
impl Mixture {
    /// The table in ragged arrays.
    #[new]
    fn new(
        speeds: Array<'_>,
        first: PyReadonlyArray1<'_, i64>,
        conditions: Array<'_>,
        start: PyReadonlyArray1<'_, i64>,
        edges: Array<'_>,
        cumulative: Array<'_>,
    ) -> PyResult<Self> {
        let layout = Layout {
            nodes: nodes(&speeds, &first, &conditions)?,
            start: owned(&start)?,
            edges: owned(&edges)?,
            cumulative: owned(&cumulative)?,
        };
        let mixture = restitution_core::distribution::Mixture::new(layout);
        mixture.map(Self).map_err(python_error)
    }

    /// "cdf", "pdf" or, of probabilities, "ppf" at x, for impact velocities v in m/s and conditions z, of the size of x or of size 1.
    fn value<'py>(
        &self,
        py: Python<'py>,
        what: &str,
        x: Array<'py>,
        v: Array<'py>,
        z: Array<'py>,
        threads: usize,
    ) -> PyResult<Filled<'py>> {
        let curve = Curve::named(what).map_err(python_error)?;
        let x = x.as_slice()?;
        let size = (x.len(), threads);
        self.fill(py, (&v, &z), size, |at, out, resources, monitor| {
            let x = Broadcast::new(x, "x", x.len())?;
            self.0.evaluate(curve, x, at, out, resources, monitor)
        })
    }

    /// Draws `size` coefficients of restitution at impact velocities v in m/s under conditions z.
    fn draw<'py>(
        &self,
        py: Python<'py>,
        v: Array<'py>,
        z: Array<'py>,
        size: usize,
        seed: u64,
        threads: usize,
    ) -> PyResult<Filled<'py>> {
        let draw = |at: At<'_>, out: &mut [f64], resources, monitor: &Monitor| {
            self.0.rvs(at, seed, out, resources, monitor)
        };
        self.fill(py, (&v, &z), (size, threads), draw)
    }
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Mixture>()
}
