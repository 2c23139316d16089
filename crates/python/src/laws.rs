//! Normal coefficients and laws, checked when they are made, and their response to single contacts.

use crate::errors::python_error;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use restitution_core::law::{
    AxialCompliance, Components, Contact, MOST_FRICTION, PADE_ABOVE, PADE_BELOW,
};
use restitution_core::{
    ChatterjeeRuina, Coulomb, Error, Frictionless, Hypothesis, Normal, Plastic, Points, Rule,
    Scattered, TangentialRestitution, Viscoelastic, collected,
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

fn closed(normal: Result<impl Into<Normal<'static>>, Error>) -> PyResult<Material> {
    let normal = normal.map_err(python_error)?.into();
    Ok(Material(Arc::new(restitution_core::Material::Closed(
        normal,
    ))))
}

#[pyfunction]
fn viscoelastic(
    young_modulus: f64,
    poisson_ratio: f64,
    dissipation: f64,
    density: f64,
    radius: f64,
) -> PyResult<Material> {
    closed(Viscoelastic::new(
        young_modulus,
        poisson_ratio,
        dissipation,
        density,
        radius,
    ))
}

#[pyfunction]
fn plastic(yield_speed: f64) -> PyResult<Material> {
    closed(Plastic::new(yield_speed))
}

#[pyfunction]
fn tabulated(v: PyReadonlyArray1<'_, f64>, e: PyReadonlyArray1<'_, f64>) -> PyResult<Material> {
    let points = Points::new(v.as_slice()?, e.as_slice()?).map_err(python_error)?;
    Ok(Material(Arc::new(restitution_core::Material::Measured(
        points,
    ))))
}

/// A constant normal coefficient, or a material.
#[derive(FromPyObject)]
enum Given<'py> {
    Constant(f64),
    Material(PyRef<'py, Material>),
}

impl Given<'_> {
    fn material(&self) -> Result<restitution_core::Material, Error> {
        Ok(match self {
            Given::Constant(value) => Normal::Constant(*value).checked()?.into(),
            Given::Material(material) => restitution_core::Material::clone(&material.0),
        })
    }
}

#[pyfunction]
fn scattered(normal: Given<'_>, deviation: f64) -> PyResult<Material> {
    let around = normal.material().map_err(python_error)?;
    let scattered = Scattered::new(around, deviation).map_err(python_error)?;
    Ok(Material(Arc::new(restitution_core::Material::Scattered(
        scattered,
    ))))
}

/// A collision law, ready for a run.
#[pyclass(frozen, module = "restitution._core")]
pub struct Law {
    coefficient: Arc<restitution_core::Material>,
    rule: Rule,
}

impl Law {
    /// The law in the core's form.
    pub fn law(&self) -> restitution_core::Law<'_> {
        restitution_core::Law::of(&self.coefficient, self.rule)
    }
}

#[pymethods]
impl Law {
    /// The impulse of a contact divided by m, in m/s, and the normal velocity of the contact afterwards. Vectors have components
    /// along n, u and w. `slip` is the contact velocity in m/s, `arm` the vector from the centre of mass to the contact along n and u
    /// in m, `inertia` is J_xx/m in m², and `across` is the entry of m K for w.
    fn respond(&self, slip: Triple, arm: (f64, f64), inertia: f64, across: f64) -> (Triple, f64) {
        let (normal, along, w) = slip;
        let response = self.law().respond(&Contact {
            velocity: Components {
                normal,
                along,
                across: w,
            },
            compliance: AxialCompliance {
                inertia,
                arm_normal: arm.0,
                arm_along: arm.1,
                ww: across,
            },
        });
        let p = response.impulse;
        ((p.normal, p.along, p.across), response.separation_speed)
    }
}

type Triple = (f64, f64, f64);

fn law(normal: Given<'_>, rule: Result<impl Into<Rule>, Error>) -> PyResult<Law> {
    let rule = rule.map_err(python_error)?.into();
    let coefficient = match normal {
        Given::Constant(_) => Arc::new(normal.material().map_err(python_error)?),
        Given::Material(material) => Arc::clone(&material.0),
    };
    Ok(Law { coefficient, rule })
}

#[pyfunction]
fn tangential_restitution(normal: Given<'_>, tangential: f64) -> PyResult<Law> {
    law(normal, TangentialRestitution::new(tangential))
}

#[pyfunction]
fn frictionless(normal: Given<'_>) -> PyResult<Law> {
    law(normal, Ok(Frictionless))
}

#[pyfunction]
fn coulomb(normal: Given<'_>, friction: f64, hypothesis: &str) -> PyResult<Law> {
    let hypothesis = Hypothesis::named(hypothesis).map_err(python_error)?;
    law(normal, Coulomb::new(friction, hypothesis))
}

#[pyfunction]
fn chatterjee_ruina(normal: Given<'_>, tangential: f64, friction: f64) -> PyResult<Law> {
    law(normal, ChatterjeeRuina::new(tangential, friction))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("MOST_FRICTION", MOST_FRICTION)?;
    module.add("PADE", (PADE_ABOVE, PADE_BELOW))?;
    module.add("HYPOTHESES", Hypothesis::NAMED.map(|(name, _)| name))?;
    module.add_class::<Material>()?;
    module.add_class::<Law>()?;
    module.add_function(wrap_pyfunction!(viscoelastic, module)?)?;
    module.add_function(wrap_pyfunction!(plastic, module)?)?;
    module.add_function(wrap_pyfunction!(tabulated, module)?)?;
    module.add_function(wrap_pyfunction!(scattered, module)?)?;
    module.add_function(wrap_pyfunction!(tangential_restitution, module)?)?;
    module.add_function(wrap_pyfunction!(frictionless, module)?)?;
    module.add_function(wrap_pyfunction!(coulomb, module)?)?;
    module.add_function(wrap_pyfunction!(chatterjee_ruina, module)?)
}
