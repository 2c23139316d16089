//! A learned distribution of the coefficient of restitution: arrays in, arrays out.

use crate::{means, python_error, watch};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use restitution_core::distribution::{At, BLOCK, Layout, Mixture, Values};
use restitution_core::{Error, Means, Monitor};

/// The table, as the items of a dictionary.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Table<'py> {
    speeds: PyReadonlyArray1<'py, f64>,
    first: PyReadonlyArray1<'py, i64>,
    conditions: PyReadonlyArray1<'py, f64>,
    start: PyReadonlyArray1<'py, i64>,
    edges: PyReadonlyArray1<'py, f64>,
    cumulative: PyReadonlyArray1<'py, f64>,
}

/// Values and whether they are cut short by Ctrl-C.
type Filled<'py> = (Bound<'py, PyArray1<f64>>, bool);

impl Table<'_> {
    /// Fills `size` values at speeds and conditions.
    fn fill<'py>(
        &self,
        py: Python<'py>,
        (v, z): (&[f64], &[f64]),
        (size, threads): (usize, usize),
        work: impl FnOnce(&Mixture, At, &mut [f64], Means, &Monitor) -> Result<(), Error> + Send,
    ) -> PyResult<Filled<'py>> {
        let layout = Layout {
            speeds: self.speeds.as_slice()?,
            first: self.first.as_slice()?,
            conditions: self.conditions.as_slice()?,
            start: self.start.as_slice()?,
            edges: self.edges.as_slice()?,
            cumulative: self.cumulative.as_slice()?,
        };
        let means = means(threads)?;
        let mixture = Mixture::new(layout).map_err(python_error)?;
        let at = At {
            speed: Values::new(v, "v", size).map_err(python_error)?,
            condition: Values::new(z, "given", size).map_err(python_error)?,
        };
        let compute = |monitor: &Monitor| {
            let mut out = vec![0.0; size];
            work(&mixture, at, &mut out, means, monitor)?;
            Ok(out)
        };
        let (out, interrupted) = if size <= BLOCK {
            // A code that asks for one value at a time shall not wait for threads to start.
            let out = py.detach(|| compute(&Monitor::default()));
            (out.map_err(python_error)?, false)
        } else {
            watch::run(py, None, compute)?
        };
        Ok((out.into_pyarray(py), interrupted))
    }
}

/// Probability of a restitution up to x ("cdf"), density at x ("pdf") or quantile of x ("ppf"), at impact velocities v under
/// conditions z; v and z have the size of x, or 1.
#[pyfunction]
#[pyo3(signature = (table, what, x, v, z, threads))]
pub fn mixture_value<'py>(
    py: Python<'py>,
    table: Table<'py>,
    what: &str,
    x: PyReadonlyArray1<'py, f64>,
    v: PyReadonlyArray1<'py, f64>,
    z: PyReadonlyArray1<'py, f64>,
    threads: usize,
) -> PyResult<Filled<'py>> {
    let x = x.as_slice()?;
    let size = (x.len(), threads);
    table.fill(
        py,
        (v.as_slice()?, z.as_slice()?),
        size,
        |mixture, at, out, means, monitor| {
            let x = Values::new(x, "x", x.len())?;
            match what {
                "cdf" => mixture.cdf(x, at, out, means, monitor),
                "pdf" => mixture.pdf(x, at, out, means, monitor),
                _ => mixture.ppf(x, at, out, means, monitor),
            }
        },
    )
}

/// Draws `size` restitutions at impact velocities v under conditions z.
#[pyfunction]
#[pyo3(signature = (table, v, z, size, seed, threads))]
pub fn mixture_draw<'py>(
    py: Python<'py>,
    table: Table<'py>,
    v: PyReadonlyArray1<'py, f64>,
    z: PyReadonlyArray1<'py, f64>,
    size: usize,
    seed: u64,
    threads: usize,
) -> PyResult<Filled<'py>> {
    let at = (v.as_slice()?, z.as_slice()?);
    table.fill(
        py,
        at,
        (size, threads),
        |mixture, at, out, means, monitor| mixture.rvs(at, seed, out, means, monitor),
    )
}
