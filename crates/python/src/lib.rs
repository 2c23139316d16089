//! The thin binding: parameters in, NumPy arrays out. No physics here.

mod bodies;
mod distribution;
mod laws;
mod release;
mod watch;

use bodies::Solid;
use numpy::ndarray::Array2;
use numpy::{Element, IntoPyArray, PyReadonlyArray1};
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use restitution_core::statistics::{Axis, Bins, By, CREATES_ENERGY, Moments};
use restitution_core::{Error, Level, Means, Run, Vector};

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

/// The parameters of a run, as the items of a dictionary.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Parameters<'py> {
    body: PyRef<'py, Solid>,
    law: laws::LawParameters,
    particles: usize,
    impacts: usize,
    release_height: f64,
    gravity: f64,
    orientation: release::Axes<'py>,
    spin: release::Spins<'py>,
    velocity: [f64; 3],
    incline: f64,
    minimum_speed: f64,
    seed: u64,
}

impl Parameters<'_> {
    fn run(&self) -> PyResult<Run<'_>> {
        let [x, y, z] = self.velocity;
        Ok(Run {
            body: self.body.0,
            law: self.law.law()?,
            particles: self.particles,
            impacts: self.impacts,
            release_height: self.release_height,
            gravity: self.gravity,
            orientation: self.orientation.law()?,
            spin: self.spin.law()?,
            velocity: Vector::new(x, y, z),
            incline: self.incline,
            minimum_speed: self.minimum_speed,
            seed: self.seed,
        })
    }
}

fn means(threads: usize) -> PyResult<Means> {
    Ok(Means {
        threads,
        level: level()?,
    })
}

/// Runs the ensemble; returns the records by name and whether the run was cut short by Ctrl-C.
#[pyfunction]
#[pyo3(signature = (run, threads, progress))]
fn simulate<'py>(
    py: Python<'py>,
    run: Parameters<'py>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, bool)> {
    let run = run.run()?;
    let means = means(threads)?;
    let (records, interrupted) = watch::run(py, progress, |monitor| run.simulate(means, monitor))?;

    let table = PyDict::new(py);
    let shape = (records.particles(), run.impacts);
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
    if !records.release_azimuth.is_empty() {
        table.set_item("release_azimuth", records.release_azimuth.into_pyarray(py))?;
        let spins = records.release_spin.into_flattened();
        set(py, &table, "release_spin", (shape.0, 3), spins)?;
    }
    Ok((table, interrupted))
}

/// Runs the ensemble and counts its impacts in bins between the given edges; rows are bins of the impact velocity, or, without
/// edges, the numbers of the impacts. Returns the counts and moments by name and whether the run was cut short by Ctrl-C.
#[pyfunction]
#[pyo3(signature = (run, velocity_bins, restitution_bins, fraction_bins, threads, progress))]
fn statistics<'py>(
    py: Python<'py>,
    run: Parameters<'py>,
    velocity_bins: Option<PyReadonlyArray1<'py, f64>>,
    restitution_bins: PyReadonlyArray1<'py, f64>,
    fraction_bins: Option<PyReadonlyArray1<'py, f64>>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, bool)> {
    let run = run.run()?;
    let means = means(threads)?;
    let axis = |name, edges: &PyReadonlyArray1<'py, f64>| {
        Axis::new(name, edges.as_slice()?).map_err(python_error)
    };
    let bins = Bins {
        by: match &velocity_bins {
            Some(edges) => By::Velocity(axis("velocity_bins", edges)?),
            None => By::Number(run.impacts),
        },
        restitution: axis("restitution_bins", &restitution_bins)?,
        fraction: fraction_bins
            .map(|edges| axis("fraction_bins", &edges))
            .transpose()?,
    };
    let (tally, interrupted) = watch::run(py, progress, |monitor| {
        run.statistics(&bins, means, monitor)
    })?;

    let rows = bins.rows();
    let moments: Vec<_> = (0..rows).filter_map(|row| tally.moments(row)).collect();
    let column =
        |f: fn(&Moments) -> f64| moments.iter().map(f).collect::<Vec<_>>().into_pyarray(py);
    let table = PyDict::new(py);
    for (name, grid) in [
        ("count", &tally.restitution),
        ("fraction_count", &tally.fraction),
    ] {
        let counts = grid.counts().iter().map(|&count| count as i64).collect();
        set(py, &table, name, (rows, grid.columns()), counts)?;
    }
    table.set_item("mean", column(|m| m.mean))?;
    table.set_item("variance", column(|m| m.variance))?;
    table.set_item("skewness", column(|m| m.skewness))?;
    table.set_item("kurtosis", column(|m| m.kurtosis))?;
    table.set_item("minimum", column(|m| m.minimum))?;
    table.set_item("maximum", column(|m| m.maximum))?;
    let fractions: Vec<_> = (0..rows)
        .filter_map(|row| tally.mean_fraction(row))
        .collect();
    table.set_item("mean_fraction", fractions.into_pyarray(py))?;
    let created: Vec<_> = tally.gains.iter().map(|row| row.count as i64).collect();
    table.set_item("energy_created", created.into_pyarray(py))?;
    let largest: Vec<_> = tally.gains.iter().map(|row| row.largest).collect();
    table.set_item("largest_energy_ratio", largest.into_pyarray(py))?;
    let stops = tally.stops.map(|count| count as i64).to_vec();
    table.set_item("stops", stops.into_pyarray(py))?;
    Ok((table, interrupted))
}

/// The version, the SIMD level in use, the levels of this machine, and the number of threads used where none is given.
#[pyfunction]
fn build_info(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let info = PyDict::new(py);
    info.set_item("version", env!("CARGO_PKG_VERSION"))?;
    info.set_item("simd", level()?.name())?;
    let here: Vec<_> = Level::available().map(Level::name).collect();
    info.set_item("simd_available", here)?;
    info.set_item("threads", restitution_core::default_threads())?;
    Ok(info)
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
    module.add("CREATES_ENERGY", CREATES_ENERGY)?;
    module.add("NumericalError", module.py().get_type::<NumericalError>())?;
    bodies::add_to(module)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)?;
    module.add_function(wrap_pyfunction!(statistics, module)?)?;
    module.add_function(wrap_pyfunction!(build_info, module)?)?;
    module.add_function(wrap_pyfunction!(sincos, module)?)?;
    module.add_function(wrap_pyfunction!(laws::normal_coefficient, module)?)?;
    module.add_function(wrap_pyfunction!(laws::respond, module)?)?;
    module.add_function(wrap_pyfunction!(distribution::mixture_value, module)?)?;
    module.add_function(wrap_pyfunction!(distribution::mixture_draw, module)?)?;
    Ok(())
}
