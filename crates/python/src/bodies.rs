//! Bodies, made from the parameters of a shape in SI units.

use crate::errors::python_error;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use restitution_core::{Dumbbell, LoadedSphere, Shape, Spherocylinder, Spheroid};

/// A body of revolution, ready for a run.
#[pyclass(frozen, module = "restitution._core")]
pub struct Solid(pub restitution_core::Solid);

#[pymethods]
impl Solid {
    /// Mass in kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.0.mass
    }

    /// Moment of inertia across the symmetry axis, in kg m².
    #[getter]
    fn transverse_inertia(&self) -> f64 {
        self.0.transverse_inertia
    }

    /// Moment of inertia about the symmetry axis, in kg m².
    #[getter]
    fn axial_inertia(&self) -> f64 {
        self.0.axial_inertia
    }

    /// Position of the centre of mass on the axis, relative to the middle of the shape, in m.
    #[getter]
    fn centre_of_mass(&self) -> f64 {
        self.0.centre_of_mass
    }

    /// Smallest height of the centre of mass, in m, at which no part is below the plane for any cos θ in `cosines`.
    fn lowest(&self, cosines: PyReadonlyArray1<'_, f64>) -> PyResult<f64> {
        let heights = cosines
            .as_slice()?
            .iter()
            .map(|&cosine| self.0.lowest(cosine));
        Ok(heights.fold(0.0, f64::max))
    }

    /// Whether no part is below the plane at a height of the centre of mass, in m, for any cos θ in `cosines`, or at any angle if
    /// these are not given.
    #[pyo3(signature = (height, cosines=None))]
    fn clears(&self, height: f64, cosines: Option<PyReadonlyArray1<'_, f64>>) -> PyResult<bool> {
        let lowest = match cosines {
            Some(cosines) => self.lowest(cosines)?,
            None => self.farthest(),
        };
        Ok(restitution_core::Solid::clears(height, lowest))
    }

    /// Smallest height of the centre of mass, in m, at which no part is below the plane at any angle.
    fn farthest(&self) -> f64 {
        self.0.farthest()
    }
}

fn solid<S: Shape>(shape: Result<S, restitution_core::Error>) -> PyResult<Solid> {
    Ok(Solid(shape.map_err(python_error)?.into()))
}

#[pyfunction]
fn dumbbell(radius: [f64; 2], separation: f64, density: [f64; 2]) -> PyResult<Solid> {
    solid(Dumbbell::unequal(radius, separation, density))
}

#[pyfunction]
fn loaded_sphere(radius: f64, density: f64, load: f64, offset: f64) -> PyResult<Solid> {
    solid(LoadedSphere::new(radius, density, load, offset))
}

#[pyfunction]
fn spherocylinder(radius: f64, separation: f64, density: f64) -> PyResult<Solid> {
    solid(Spherocylinder::new(radius, separation, density))
}

#[pyfunction]
fn spheroid(equatorial: f64, polar: f64, density: f64) -> PyResult<Solid> {
    solid(Spheroid::new(equatorial, polar, density))
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Solid>()?;
    module.add_function(wrap_pyfunction!(dumbbell, module)?)?;
    module.add_function(wrap_pyfunction!(loaded_sphere, module)?)?;
    module.add_function(wrap_pyfunction!(spherocylinder, module)?)?;
    module.add_function(wrap_pyfunction!(spheroid, module)?)
}
