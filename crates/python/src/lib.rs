//! The thin binding: parameters in, NumPy arrays out. No physics here.

mod watch;

use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray, PyReadonlyArray1};
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use restitution_core::{Dumbbell, Error, Level, Means, Orientation, Run, TangentialRestitution};

create_exception!(
    restitution,
    NumericalError,
    PyRuntimeError,
    "The engine could not follow a particle; the message names it and the seed that reproduces it."
);

fn python_error(error: Error) -> PyErr {
    match error {
        Error::Parameter { .. } | Error::Level { .. } => PyValueError::new_err(error.to_string()),
        Error::Numerical { .. } => NumericalError::new_err(error.to_string()),
        Error::Threads(_) => PyRuntimeError::new_err(error.to_string()),
    }
}

/// The SIMD level that the environment variable RESTITUTION_SIMD names, or the best of this machine.
fn level() -> PyResult<Level> {
    match std::env::var("RESTITUTION_SIMD") {
        Ok(name) if !name.is_empty() => Level::named(&name).map_err(python_error),
        _ => Ok(Level::best()),
    }
}

/// Mass (kg), transverse and axial moment of inertia (kg m²) of a dumbbell.
#[pyfunction]
fn dumbbell_inertia(radius: f64, separation: f64, density: f64) -> PyResult<(f64, f64, f64)> {
    let body = Dumbbell::new(radius, separation, density).map_err(python_error)?;
    Ok((body.mass(), body.transverse_inertia(), body.axial_inertia()))
}

/// How to let particles go: the name of a law or an array of angles.
#[derive(FromPyObject)]
enum Release<'py> {
    Name(String),
    Angles(PyReadonlyArray1<'py, f64>),
}

/// Runs the ensemble; returns the records by name and whether the run was cut short by Ctrl-C.
#[pyfunction]
#[pyo3(signature = (*, radius, separation, density, normal, tangential, particles, impacts, release_height,
    gravity, orientation, minimum_speed, seed, threads, progress))]
#[expect(
    clippy::too_many_arguments,
    reason = "they are the keywords of the call"
)]
fn simulate<'py>(
    py: Python<'py>,
    radius: f64,
    separation: f64,
    density: f64,
    normal: f64,
    tangential: f64,
    particles: usize,
    impacts: usize,
    release_height: f64,
    gravity: f64,
    orientation: Release<'py>,
    minimum_speed: f64,
    seed: u64,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, bool)> {
    let orientation = match &orientation {
        Release::Angles(angles) => Orientation::Given(angles.as_slice()?),
        Release::Name(name) if name == "isotropic" => Orientation::Isotropic,
        Release::Name(_) => Orientation::UniformAngle,
    };
    let run = Run {
        body: Dumbbell::new(radius, separation, density).map_err(python_error)?,
        law: TangentialRestitution::new(normal, tangential).map_err(python_error)?,
        particles,
        impacts,
        release_height,
        gravity,
        orientation,
        minimum_speed,
        seed,
    };
    let means = Means {
        threads,
        level: level()?,
    };
    let (records, interrupted) = watch::run(py, progress, |monitor| run.simulate(means, monitor))?;

    let table = PyDict::new(py);
    let shape = (particles, impacts);
    set(py, &table, "time", shape, records.time)?;
    set(
        py,
        &table,
        "impact_velocity",
        shape,
        records.impact_velocity,
    )?;
    set(
        py,
        &table,
        "rebound_velocity",
        shape,
        records.rebound_velocity,
    )?;
    set(py, &table, "restitution", shape, records.restitution)?;
    set(
        py,
        &table,
        "rotational_fraction",
        shape,
        records.rotational_fraction,
    )?;
    set(py, &table, "energy_ratio", shape, records.energy_ratio)?;
    set(py, &table, "angle", shape, records.angle)?;
    set(py, &table, "contact", shape, records.contact)?;
    table.set_item("impacts", records.impacts.into_pyarray(py))?;
    table.set_item("stop_reason", records.stop_reason.into_pyarray(py))?;
    table.set_item("release_angle", records.release_angle.into_pyarray(py))?;
    Ok((table, interrupted))
}

/// Hands a row-major table over to NumPy without copying it.
fn set<T: Element>(
    py: Python<'_>,
    table: &Bound<'_, PyDict>,
    name: &str,
    shape: (usize, usize),
    values: Vec<T>,
) -> PyResult<()> {
    let values = Array2::from_shape_vec(shape, values).expect("the core fills the whole table");
    table.set_item(name, values.into_pyarray(py))
}

/// Sine and cosine as the engine computes them.
#[pyfunction]
fn sincos(x: f64) -> (f64, f64) {
    restitution_core::elementary::sincos(x)
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("NumericalError", module.py().get_type::<NumericalError>())?;
    module.add_function(wrap_pyfunction!(dumbbell_inertia, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)?;
    module.add_function(wrap_pyfunction!(sincos, module)?)?;
    Ok(())
}
