//! The thin binding: parameters in, NumPy arrays out. No physics here.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use restitution_core::{Dumbbell, Error};

fn python_error(error: Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Mass (kg), transverse and axial moment of inertia (kg m²) of a dumbbell.
#[pyfunction]
fn dumbbell_inertia(radius: f64, separation: f64, density: f64) -> PyResult<(f64, f64, f64)> {
    let body = Dumbbell::new(radius, separation, density).map_err(python_error)?;
    Ok((
        body.mass(),
        body.transverse_inertia(),
        body.axial_inertia(),
    ))
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(dumbbell_inertia, module)?)?;
    Ok(())
}
