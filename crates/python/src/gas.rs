//! A gas that cools.

use crate::bodies::Dropped;
use crate::errors::python_error;
use crate::laws::Law;
use crate::{resources, watch};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use restitution_core::gas::{BIN, BINS, GAS_KIND, GAS_WHOLE, Gas, Phase, STATE, Species};
use restitution_core::pair::Partner;

/// Density, length, statistics and seed of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Course {
    number_density: f64,
    uniform: bool,
    batches: usize,
    collisions: f64,
    heating: f64,
    keep: bool,
    distributions: bool,
    samples: usize,
    seed: u64,
}

/// A body, how many there are, their temperatures of translation and of rotation about each principal axis, and whether contacts turn them about it.
type Counted<'py> = (Dropped<'py>, usize, f64, [f64; 3], [bool; 3]);

type Tables<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f64>>);

/// Follows a gas, from the given states if there are any. Returns rows of `GAS_WHOLE` and, for each kind, `GAS_KIND` and the counts of
/// both distributions if they are asked for, by batch and look, with the states of
/// the particles at the end, and the `KeyboardInterrupt` that cut the run short, if any.
#[pyfunction]
#[pyo3(signature = (kinds, law, course, threads, given, progress))]
fn cool<'py>(
    py: Python<'py>,
    kinds: Vec<Counted<'py>>,
    law: &Law,
    course: Course,
    threads: usize,
    given: Option<PyReadonlyArray2<'py, f64>>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<(Tables<'py>, Option<PyErr>)> {
    let of = |(body, ..): &Counted<'_>| Partner::new("body", body.body());
    let bodies: Vec<Partner> = kinds
        .iter()
        .map(of)
        .collect::<Result<_, _>>()
        .map_err(python_error)?;
    let given: Option<Vec<[f64; STATE]>> = match &given {
        Some(states) => Some(states.as_slice()?.as_chunks().0.to_vec()),
        None => None,
    };
    let gas = Gas {
        kinds: kinds
            .iter()
            .zip(&bodies)
            .map(
                |(&(_, particles, translational, rotational, turned), body)| Species {
                    body,
                    particles,
                    translational,
                    rotational,
                    turned,
                },
            )
            .collect(),
        density: course.number_density,
        phase: if course.uniform {
            Phase::Uniform
        } else {
            Phase::Time
        },
        batches: course.batches,
        collisions: course.collisions,
        heating: course.heating,
        keep: course.keep,
        distributions: course.distributions,
        given: given.as_deref(),
        samples: course.samples,
        seed: course.seed,
    };
    let (law, resources) = (law.law(), resources(threads)?);
    let ((rows, states), interrupted) =
        watch::run(py, progress, |monitor| gas.cool(&law, resources, monitor))?;
    let shape = [course.batches, course.samples + 1, gas.width()];
    let states = states.into_flattened().into_pyarray(py);
    let states = states.reshape([states.len()? / STATE, STATE])?;
    Ok(((rows.into_pyarray(py).reshape(shape)?, states), interrupted))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("GAS_WHOLE", GAS_WHOLE.map(|(name, ..)| name))?;
    module.add("GAS_KIND", GAS_KIND.map(|(name, ..)| name))?;
    module.add("GAS_BINS", (BINS, BIN))?;
    module.add_function(wrap_pyfunction!(cool, module)?)
}
