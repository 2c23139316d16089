//! The core's errors as Python exceptions, with their fields as attributes.

use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use restitution_core::{Error, Fault, Raised, Value};

create_exception!(
    restitution,
    NumericalError,
    PyRuntimeError,
    "The engine could not follow a particle; the message names it and the seed that reproduces it.

Examples
--------
>>> import restitution as rs
>>> try:
...     data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.98), particles=5)
... except rs.NumericalError as error:
...     print(\"report this:\", error)
"
);
create_exception!(
    restitution._core,
    ParameterError,
    PyValueError,
    "A parameter is refused; its `name`, its `value` and what is `allowed` are attributes."
);
create_exception!(
    restitution._core,
    MagnitudeError,
    ParameterError,
    "Each parameter is allowed, but what follows from all of them is too large or small for a floating-point number."
);

/// The exception for an error of the core.
pub fn python_error(error: Error) -> PyErr {
    let text = error.to_string();
    match error {
        Error::Parameter {
            name,
            value,
            allowed,
        } => with_fields(ParameterError::new_err(text), name, value, &allowed),
        Error::Magnitude {
            name,
            value,
            allowed,
        } => with_fields(MagnitudeError::new_err(text), name, value, allowed),
        Error::Level { name, allowed, .. } => with_fields(
            ParameterError::new_err(text),
            "RESTITUTION_SIMD",
            Value::Name(name),
            &allowed,
        ),
        Error::Law {
            fault: Fault::Raised(raised),
            ..
        } => raised_again(&raised, &text),
        Error::Law { .. } => PyValueError::new_err(text),
        Error::Numerical { .. } => NumericalError::new_err(text),
        Error::Threads { .. } => PyRuntimeError::new_err(text),
        Error::Cancelled => PyKeyboardInterrupt::new_err(()),
        Error::Memory { .. } => PyMemoryError::new_err(text),
    }
}

/// The exception of a law of the user's own, with a note that names particle and seed.
fn raised_again(raised: &Raised, text: &str) -> PyErr {
    let Some(error) = raised.0.downcast_ref::<PyErr>() else {
        return PyRuntimeError::new_err(text.to_owned());
    };
    Python::attach(|py| {
        let error = error.clone_ref(py);
        match error.value(py).call_method1("add_note", (text,)) {
            Ok(_) => error,
            Err(failed) => failed,
        }
    })
}

fn with_fields(error: PyErr, name: &str, value: Value, allowed: &str) -> PyErr {
    let set = |py: Python<'_>| {
        let exception = error.value(py);
        exception.setattr("name", name)?;
        match value {
            Value::Number(number) => exception.setattr("value", number)?,
            Value::Count(count) => exception.setattr("value", count)?,
            Value::Name(name) => exception.setattr("value", name)?,
        }
        exception.setattr("allowed", allowed)
    };
    match Python::attach(set) {
        Ok(()) => error,
        Err(failed) => failed,
    }
}

/// `Ok` if the condition `holds` for an array from Python, else the error.
pub fn unless(holds: bool, name: &'static str, value: usize, allowed: &str) -> PyResult<()> {
    if holds {
        return Ok(());
    }
    Err(python_error(Error::Parameter {
        name,
        value: Value::Count(value),
        allowed: allowed.to_owned(),
    }))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("NumericalError", py.get_type::<NumericalError>())?;
    module.add("ParameterError", py.get_type::<ParameterError>())?;
    module.add("MagnitudeError", py.get_type::<MagnitudeError>())
}
