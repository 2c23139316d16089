//! Encounters of two bodies.

use crate::bodies::Dropped;
use crate::errors::python_error;
use crate::laws::Law;
use crate::records::variable;
use crate::{resources, watch};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use restitution_core::pair::{
    Encounters, Ending, Meeting, PER_CONTACT, PER_ENCOUNTER, PairState, Partner,
};
use restitution_core::{Quaternion, Values, Variable, Vector};

/// The pairs to draw: temperatures of translation, or a relative speed; impact parameter, temperatures of rotation or ω.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Drawn {
    first: u64,
    encounters: usize,
    translational_temperature: Option<[f64; 2]>,
    speed: Option<f64>,
    impact_parameter: Option<f64>,
    rotational_temperature: [f64; 2],
    spin: Option<[[f64; 3]; 2]>,
    seed: u64,
}

impl Drawn {
    fn of<'a>(&self, bodies: [&'a Partner; 2]) -> Encounters<'a> {
        let vector = |[x, y, z]: [f64; 3]| Vector::new(x, y, z);
        Encounters {
            bodies,
            first: self.first,
            count: self.encounters,
            meeting: match (self.speed, self.translational_temperature) {
                (Some(speed), _) => Meeting::Speed(speed),
                (None, given) => Meeting::Temperatures(given.unwrap_or_default()),
            },
            impact_parameter: self.impact_parameter,
            rotational: self.rotational_temperature,
            spin: self.spin.map(|both| both.map(vector)),
            seed: self.seed,
        }
    }
}

/// The body and the other one, or a plane if it is none.
fn partners(body: &Dropped<'_>, other: Option<&Dropped<'_>>) -> PyResult<[Partner; 2]> {
    let of = |name, body: &Dropped<'_>| Partner::new(name, body.body()).map_err(python_error);
    let body = of("body", body)?;
    let other = match other {
        Some(other) => of("other", other)?,
        None => Partner::plane(),
    };
    Ok([body, other])
}

/// Follows encounters, drawn or given as rows of position, velocity, ω and attitude of each body. Returns by name the variables of the encounters, those of the
/// states if they are asked for, and of the contacts, one after the other, if these are; the rate of attempts; and the `KeyboardInterrupt` that cut the run short,
/// if any.
#[pyfunction]
#[pyo3(signature = (body, other, law, drawn, given, wanted, threads, progress))]
#[expect(clippy::too_many_arguments, reason = "one call from Python")]
fn encounters<'py>(
    py: Python<'py>,
    body: Dropped<'py>,
    other: Option<Dropped<'py>>,
    law: &Law,
    drawn: Drawn,
    given: Option<PyReadonlyArray2<'py, f64>>,
    wanted: [bool; 2],
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<([Bound<'py, PyDict>; 2], f64, Option<PyErr>)> {
    let [one, two] = partners(&body, other.as_ref())?;
    let run = drawn.of([&one, &two]);
    let resources = resources(threads)?;
    let given: Option<Vec<[PairState; 2]>> = match &given {
        Some(rows) => Some(rows.as_slice()?.as_chunks().0.iter().map(state).collect()),
        None => None,
    };
    let law = law.law();
    let (mut table, interrupted) = watch::run(py, progress, |monitor| {
        run.record(&law, given.as_deref(), wanted, resources, monitor)
    })?;
    let named = |dimensions, columns: Vec<(Variable, Values)>| {
        let table = PyDict::new(py);
        for (about, values) in columns {
            table.set_item(about.name, variable(py, &about, &[dimensions], values)?)?;
        }
        PyResult::Ok(table)
    };
    let contacts = table.per_contact().map_err(python_error)?;
    Ok((
        [
            named(("encounter", run.count), table.per_encounter())?,
            named(("contact", table.hits.len()), contacts)?,
        ],
        run.attempt_rate(),
        interrupted,
    ))
}

fn state(row: &[f64; 26]) -> [PairState; 2] {
    let both = row.as_chunks::<13>().0;
    [0, 1].map(|i| {
        let [x, y, z, u, v, w, a, b, c, q, qx, qy, qz] = both[i];
        PairState {
            position: Vector::new(x, y, z),
            velocity: Vector::new(u, v, w),
            spin: Vector::new(a, b, c),
            attitude: Quaternion::new(q, qx, qy, qz),
        }
    })
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let bytes = |all: &[Variable]| -> Vec<_> {
        all.iter()
            .map(|about| (about.name, about.bytes()))
            .collect()
    };
    module.add(
        "PAIR_ENCOUNTER",
        bytes(PER_ENCOUNTER).into_py_dict(module.py())?,
    )?;
    module.add(
        "PAIR_CONTACT",
        bytes(PER_CONTACT).into_py_dict(module.py())?,
    )?;
    module.add("PAIR_ENDINGS", Ending::NAMES)?;
    module.add_function(wrap_pyfunction!(encounters, module)?)
}
