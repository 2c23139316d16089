//! A gas that cools.

use crate::bodies::Dropped;
use crate::errors::{python_error, unless};
use crate::laws::Law;
use crate::{resources, watch};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
};
use pyo3::prelude::*;
use restitution_core::gas::{BIN, BINS, GAS_KIND, GAS_WHOLE, Gas, Phase, STATE, Species};
use restitution_core::pair::Partner;
use restitution_core::{collected, copied};

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

type Tables<'py> = (
    Bound<'py, PyArray3<f64>>,
    Bound<'py, PyArray2<f64>>,
    Option<Bound<'py, PyArray1<f64>>>,
);

/// Follows a gas, from the given states if there are any. Returns rows of `GAS_WHOLE` and, for each kind, `GAS_KIND` and the counts of
/// both distributions if they are asked for, by batch and look, with the states of
/// the particles at the end, and the `KeyboardInterrupt` that cut the run short, if any. Where `store` is
/// given it goes on from it, if it is not empty, and also returns what a later call goes on from.
#[pyfunction]
#[pyo3(signature = (kinds, law, course, threads, given, progress, store = None))]
#[expect(clippy::too_many_arguments, reason = "one call from Python")]
fn cool<'py>(
    py: Python<'py>,
    kinds: Vec<Counted<'py>>,
    law: &Law,
    course: Course,
    threads: usize,
    given: Option<PyReadonlyArray2<'py, f64>>,
    progress: Option<Bound<'py, PyAny>>,
    store: Option<PyReadonlyArray1<'py, f64>>,
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
    let size = gas.stored() * gas.batches;
    let mut store = match &store {
        Some(store) if store.len()? > 0 => {
            unless(
                store.len()? == size,
                "checkpoint",
                store.len()?,
                "of this gas",
            )?;
            Some(copied("checkpoint", store.as_slice()?).map_err(python_error)?)
        }
        Some(_) => {
            Some(collected("checkpoint", std::iter::repeat_n(0.0, size)).map_err(python_error)?)
        }
        None => None,
    };
    let (law, resources) = (law.law(), resources(threads)?);
    let ((rows, states), interrupted) = watch::run(py, progress, |monitor| {
        gas.cool(&law, resources, monitor, store.as_deref_mut())
    })?;
    let shape = [course.batches, course.samples + 1, gas.width()];
    let states = states.into_flattened().into_pyarray(py);
    let states = states.reshape([states.len()? / STATE, STATE])?;
    let store = store.map(|store| store.into_pyarray(py));
    Ok((
        (rows.into_pyarray(py).reshape(shape)?, states, store),
        interrupted,
    ))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("GAS_WHOLE", GAS_WHOLE)?;
    module.add("GAS_KIND", GAS_KIND)?;
    module.add("GAS_BINS", (BINS, BIN))?;
    module.add_function(wrap_pyfunction!(cool, module)?)
}
