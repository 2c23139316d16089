//! The law of a run, from the items of a dictionary; and single contacts, for tests and for a look at a law alone.

use crate::python_error;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use restitution_core::collision::{Components, Contact};
use restitution_core::{
    ChatterjeeRuina, Coulomb, Error, Frictionless, Hypothesis, Law, Normal, Plastic, Tabulated,
    TangentialRestitution, Viscoelastic,
};

/// A number, or the parameters of a material.
#[derive(FromPyObject)]
pub enum NormalParameters {
    Constant(f64),
    #[pyo3(from_item_all)]
    Viscoelastic {
        young_modulus: f64,
        poisson_ratio: f64,
        dissipation: f64,
        density: f64,
        radius: f64,
    },
    #[pyo3(from_item_all)]
    Plastic {
        yield_speed: f64,
    },
    #[pyo3(from_item_all)]
    Tabulated {
        v: Vec<f64>,
        e: Vec<f64>,
    },
}

impl NormalParameters {
    fn normal(&self) -> Result<Normal<'_>, Error> {
        match self {
            Self::Constant(value) => Ok((*value).into()),
            Self::Viscoelastic {
                young_modulus,
                poisson_ratio,
                dissipation,
                density,
                radius,
            } => Viscoelastic::new(
                *young_modulus,
                *poisson_ratio,
                *dissipation,
                *density,
                *radius,
            )
            .map(Into::into),
            Self::Plastic { yield_speed } => Plastic::new(*yield_speed).map(Into::into),
            Self::Tabulated { v, e } => Tabulated::new(v, e).map(Into::into),
        }
    }
}

/// A law by name, with the parameters that it has.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct LawParameters {
    #[pyo3(item("type"))]
    name: String,
    normal: NormalParameters,
    #[pyo3(default)]
    tangential: f64,
    #[pyo3(default)]
    friction: f64,
    #[pyo3(default)]
    hypothesis: String,
}

impl LawParameters {
    pub fn law(&self) -> PyResult<Law<'_>> {
        let normal = self.normal.normal().map_err(python_error)?;
        let (tangential, friction) = (self.tangential, self.friction);
        let law = match self.name.as_str() {
            "TangentialRestitution" => {
                TangentialRestitution::new(normal, tangential).map(Into::into)
            }
            "Frictionless" => Frictionless::new(normal).map(Into::into),
            "Coulomb" => Coulomb::new(normal, friction, self.hypothesis()?).map(Into::into),
            "ChatterjeeRuina" => ChatterjeeRuina::new(normal, tangential, friction).map(Into::into),
            name => return Err(PyValueError::new_err(format!("no law is called {name}"))),
        };
        law.map_err(python_error)
    }

    fn hypothesis(&self) -> PyResult<Hypothesis> {
        match self.hypothesis.as_str() {
            "stronge" => Ok(Hypothesis::Stronge),
            "poisson" => Ok(Hypothesis::Poisson),
            "newton" => Ok(Hypothesis::Newton),
            name => Err(PyValueError::new_err(format!(
                "no hypothesis is called {name}"
            ))),
        }
    }
}

/// ε^n as the engine computes it, at speeds in m/s.
#[pyfunction]
pub fn normal_coefficient<'py>(
    py: Python<'py>,
    normal: NormalParameters,
    speeds: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let normal = normal.normal().map_err(python_error)?;
    let values = speeds.as_slice()?.iter().map(|&speed| normal.at(speed));
    Ok(values.collect::<Vec<_>>().into_pyarray(py))
}

type Triple = (f64, f64, f64);

/// The impulse that a law answers a contact with, over m, and the normal velocity of the contact afterwards. Vectors are
/// along n, u and w; `slip` is the contact velocity in m/s, `arm` leads from the centre of mass to the contact along n and
/// u, `inertia` is J_xx/m in the square of its unit, and `across` is the entry of m K for w.
#[pyfunction]
pub fn respond(
    law: LawParameters,
    slip: Triple,
    arm: (f64, f64),
    inertia: f64,
    across: f64,
) -> PyResult<(Triple, f64)> {
    let (normal, along, w) = slip;
    let response = law.law()?.respond(&Contact {
        slip: Components {
            normal,
            along,
            across: w,
        },
        inertia,
        arm_normal: arm.0,
        arm_along: arm.1,
        across,
    });
    let p = response.impulse;
    Ok(((p.normal, p.along, p.across), response.separation_speed))
}
