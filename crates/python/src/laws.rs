//! Normal coefficients and laws, checked when they are made, and their response to single contacts.

use crate::describe::{self, Given};
use crate::errors::python_error;
use numpy::ndarray::arr2;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, ToPyArray};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use restitution_core::law::{
    AxialCompliance, Compliance, Contact, MOST_FRICTION, PADE_ABOVE, PADE_BELOW,
};
use restitution_core::{
    Error, Fault, ImpulseFunction, LAWS, MATERIALS, Normal, Raised, Rule, Scattered, Symmetric,
    Vector, collected,
};
use std::sync::Arc;

/// A normal coefficient that depends on the speed.
#[pyclass(frozen, module = "restitution._core")]
pub struct Material(Arc<restitution_core::Material>);

#[pymethods]
impl Material {
    /// β of a viscoelastic sphere, in (s/m)^{1/5}.
    #[getter]
    fn beta(&self) -> Option<f64> {
        match self.0.normal() {
            Normal::Viscoelastic(sphere) => Some(sphere.beta()),
            _ => None,
        }
    }

    /// ε_n as the engine computes it, at speeds in m/s.
    fn at<'py>(
        &self,
        py: Python<'py>,
        speeds: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let normal = self.0.normal();
        let values = speeds.as_slice()?.iter().map(|&speed| normal.at(speed));
        let values = collected("speeds", values).map_err(python_error)?;
        Ok(values.into_pyarray(py))
    }
}

/// The material with this name, made from all its parameters in their order.
#[pyfunction]
fn material(name: &str, arguments: Vec<Option<Given<'_>>>) -> PyResult<Material> {
    let made = describe::made(MATERIALS.iter(), name, &arguments)?;
    Ok(Material(Arc::new(made)))
}

/// A constant normal coefficient, or a material.
#[derive(FromPyObject)]
enum Coefficient<'py> {
    Constant(f64),
    Material(PyRef<'py, Material>),
}

impl Coefficient<'_> {
    fn material(&self) -> Result<restitution_core::Material, Error> {
        Ok(match self {
            Self::Constant(value) => Normal::Constant(*value).checked()?.into(),
            Self::Material(material) => restitution_core::Material::clone(&material.0),
        })
    }
}

/// A coefficient that scatters about a number or another material, which no row of parameters holds.
#[pyfunction]
fn scattered(normal: Coefficient<'_>, deviation: f64) -> PyResult<Material> {
    let around = normal.material().map_err(python_error)?;
    let scattered = Scattered::new(around, deviation).map_err(python_error)?;
    Ok(Material(Arc::new(restitution_core::Material::Scattered(
        scattered,
    ))))
}

/// A collision law, ready for a run.
#[pyclass(frozen, module = "restitution._core")]
pub struct Law(Chosen);

enum Chosen {
    /// A law of the core.
    Known(Arc<restitution_core::Material>, Rule),
    /// A function of the user.
    Custom(Function),
}

impl Law {
    /// The law in the core's form.
    pub fn law(&self) -> restitution_core::Law<'_> {
        match &self.0 {
            Chosen::Known(coefficient, rule) => restitution_core::Law::of(coefficient, *rule),
            Chosen::Custom(function) => restitution_core::Law::custom(function),
        }
    }
}

/// A function of K and the contact velocity, which gives an impulse: one in Python, or a law of the core.
struct Function {
    name: String,
    asked: Asked,
    pull: Pull,
}

enum Asked {
    Python(Py<PyAny>),
    Known(Arc<restitution_core::Material>, Rule),
}

/// The treatment of an impulse that pulls.
#[derive(Clone, Copy, PartialEq)]
enum Pull {
    /// It acts.
    Acts,
    /// It ends the run.
    Stop,
    /// Its normal component is left out.
    Clip,
}

/// Most characters of what a function returned that an error shows.
const SHOWN: usize = 72;

impl Function {
    /// The impulse, or what was given instead.
    fn call(
        function: &Py<PyAny>,
        py: Python<'_>,
        compliance: [[f64; 3]; 3],
        velocity: Vector,
    ) -> PyResult<Result<Vector, String>> {
        let velocity = [velocity.x, velocity.y, velocity.z].to_pyarray(py);
        let given = function
            .bind(py)
            .call1((arr2(&compliance).to_pyarray(py), velocity))?;
        if let Ok([x, y, z]) = given.extract::<[f64; 3]>() {
            return Ok(Ok(Vector::new(x, y, z)));
        }
        let text = given.repr()?.to_string();
        let short = text.split_whitespace().collect::<Vec<_>>().join(" ");
        Ok(Err(short.chars().take(SHOWN).collect()))
    }
}

impl ImpulseFunction for Function {
    fn name(&self) -> &str {
        &self.name
    }

    fn may_pull(&self) -> bool {
        self.pull != Pull::Stop
    }

    fn impulse(&self, compliance: [[f64; 3]; 3], velocity: Vector) -> Result<Vector, Fault> {
        let mut given = match &self.asked {
            Asked::Python(function) => {
                Python::attach(|py| match Self::call(function, py, compliance, velocity) {
                    Ok(given) => given.map_err(Fault::NoVector),
                    Err(error) => Err(Fault::Raised(Raised(Arc::new(error)))),
                })?
            }
            Asked::Known(coefficient, rule) => {
                let k = Compliance::new(Symmetric::from_rows(compliance))
                    .expect("the compliance of a body");
                let law = restitution_core::Law::of(coefficient, *rule);
                law.answer(&k, velocity)?.impulse
            }
        };
        if self.pull == Pull::Clip {
            given.z = given.z.max(0.0);
        }
        Ok(given)
    }
}

#[pymethods]
impl Law {
    /// The impulse of a contact divided by m, in m/s, and the normal velocity of the contact afterwards. Vectors have components
    /// along n, u and w. `slip` is the contact velocity in m/s, `arm` the vector from the centre of mass to the contact along n and u
    /// in m, `inertia` is J_xx/m in m², and `across` is the entry of m K for w.
    fn respond(
        &self,
        slip: Triple,
        arm: (f64, f64),
        inertia: f64,
        across: f64,
    ) -> PyResult<(Triple, f64)> {
        if let Chosen::Custom(_) = self.0 {
            return Err(PyTypeError::new_err(
                "a function has no response without a mass",
            ));
        }
        let (normal, along, w) = slip;
        let response = self.law().respond(&Contact {
            velocity: Vector::new(along, w, normal),
            compliance: AxialCompliance {
                inertia,
                arm_normal: arm.0,
                arm_along: arm.1,
                ww: across,
            },
        });
        let p = response.impulse;
        Ok(((p.z, p.x, p.y), response.separation_speed))
    }
}

type Triple = (f64, f64, f64);

/// The law with this name, made from the normal coefficient and all its other parameters in their order.
#[pyfunction]
fn law(name: &str, normal: Coefficient<'_>, arguments: Vec<Option<Given<'_>>>) -> PyResult<Law> {
    let rule = describe::made(LAWS.iter().map(|law| &law.kind), name, &arguments)?;
    let coefficient = match normal {
        Coefficient::Constant(_) => Arc::new(normal.material().map_err(python_error)?),
        Coefficient::Material(material) => Arc::clone(&material.0),
    };
    Ok(Law(Chosen::Known(coefficient, rule)))
}

/// The law of a function, or of a law of the core, and what becomes of an impulse that pulls: it acts unless "stop" or "clip" is given.
#[pyfunction]
#[pyo3(signature = (function, name, pull))]
fn custom(py: Python<'_>, function: Py<PyAny>, name: String, pull: Option<&str>) -> Law {
    let asked = match function.cast_bound::<Law>(py).ok().map(|law| &law.get().0) {
        Some(Chosen::Known(coefficient, rule)) => Asked::Known(Arc::clone(coefficient), *rule),
        _ => Asked::Python(function),
    };
    let pull = match pull {
        Some("stop") => Pull::Stop,
        Some(_) => Pull::Clip,
        None => Pull::Acts,
    };
    Law(Chosen::Custom(Function { name, asked, pull }))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("MOST_FRICTION", MOST_FRICTION)?;
    module.add("PADE", (PADE_ABOVE, PADE_BELOW))?;
    module.add_class::<Material>()?;
    module.add_class::<Law>()?;
    module.add_function(wrap_pyfunction!(material, module)?)?;
    module.add_function(wrap_pyfunction!(scattered, module)?)?;
    module.add_function(wrap_pyfunction!(law, module)?)?;
    module.add_function(wrap_pyfunction!(custom, module)?)
}
