//! The Python binding: it takes parameters and returns NumPy arrays, and contains no physics.

mod bodies;
mod counts;
mod describe;
mod distribution;
mod errors;
mod gas;
mod histogram;
mod laws;
mod pair;
mod records;
mod release;
mod watch;

use bodies::Dropped;
use errors::python_error;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use restitution_core::statistics::{CREATES_ENERGY, PULLS, Sums};
use restitution_core::{About, Level, Orientation, Resources, Run, StopReason, Vector};
use std::ops::Range;

/// The SIMD level that the environment variable RESTITUTION_SIMD names, or the best of this machine.
fn level() -> PyResult<Level> {
    match std::env::var("RESTITUTION_SIMD") {
        Ok(name) if !name.is_empty() => Level::named(&name).map_err(python_error),
        _ => Ok(Level::best()),
    }
}

/// A row is `name: type in Python = |given| value for the core`; the names are those of [`Run`].
macro_rules! parameters {
    ($($name:ident: $kind:ty = |$given:ident| $core:expr;)*) => {
        /// The parameters of a run, from the items of a dictionary.
        #[derive(FromPyObject)]
        #[pyo3(from_item_all)]
        struct Parameters<'py> {
            $($name: $kind,)*
        }

        impl Parameters<'_> {
            fn run(&self) -> PyResult<Run<'_>> {
                $(let $given = &self.$name; let $name = $core;)*
                Ok(Run { $($name),* })
            }
        }
    };
}

parameters! {
    body: Dropped<'py> = |given| given.body();
    law: PyRef<'py, laws::Law> = |given| given.law();
    particles: usize = |given| *given;
    impacts: usize = |given| *given;
    release_height: release::Heights = |given| given.law();
    gravity: f64 = |given| *given;
    orientation: release::Axes<'py> = |given| given.law()?;
    spin: release::Spins<'py> = |given| given.law()?;
    release_velocity: [f64; 3] = |given| Vector::new(given[0], given[1], given[2]);
    incline: f64 = |given| *given;
    minimum_speed: f64 = |given| *given;
    settled: f64 = |given| *given;
    seed: u64 = |given| *given;
}

/// The particles in the half-open range of the pair, or all.
fn range(part: Option<(usize, usize)>, particles: usize) -> Range<usize> {
    part.map_or(0..particles, |(first, end)| first..end)
}

fn resources(threads: usize) -> PyResult<Resources> {
    Ok(Resources {
        threads,
        level: level()?,
    })
}

/// The version, the SIMD level in use, the levels of this machine, and the default number of threads.
///
/// Examples
/// --------
/// >>> import restitution as rs
/// >>> about = rs.build_info()
/// >>> about["version"] == rs.__version__, about["simd"] in about["simd_available"]
/// (True, True)
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

/// Sine and cosine as the engine computes them.
#[pyfunction]
fn sincos(x: f64) -> (f64, f64) {
    restitution_core::elementary::sincos(x)
}

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("CREATES_ENERGY", CREATES_ENERGY)?;
    module.add("PULLS", PULLS)?;
    module.add("LARGEST_RESTITUTION", Sums::LARGEST)?;
    module.add("MOST_RADIANS", restitution_core::elementary::RANGE)?;
    module.add("ORIENTATIONS", Orientation::NAMED.map(|(name, _)| name))?;
    module.add("AXES", About::NAMED.map(|(name, _)| name))?;
    module.add("STOP_REASONS", StopReason::NAMES)?;
    errors::add_to(module)?;
    describe::add_to(module)?;
    bodies::add_to(module)?;
    laws::add_to(module)?;
    pair::add_to(module)?;
    gas::add_to(module)?;
    distribution::add_to(module)?;
    counts::add_to(module)?;
    records::add_to(module)?;
    histogram::add_to(module)?;
    module.add_function(wrap_pyfunction!(build_info, module)?)?;
    module.add_function(wrap_pyfunction!(sincos, module)?)?;
    Ok(())
}
