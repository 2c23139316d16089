//! Bodies, made from the parameters of a shape in SI units.

use crate::describe::{self, Given};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use restitution_core::BODIES;

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

    /// The arcs of the outline at the end to which the axis points and at the other, joined by a straight line: each an ellipse with its
    /// centre on the axis, its semi-axes along and across the axis, and the angles from and to which it goes (m, rad).
    #[getter]
    fn outline(&self) -> [[f64; 5]; 2] {
        self.0
            .outline
            .map(|arc| [arc.centre, arc.along, arc.across, arc.from, arc.to])
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

/// The body with this name, made from all its parameters in their order.
#[pyfunction]
fn body(name: &str, arguments: Vec<Given<'_>>) -> PyResult<Solid> {
    describe::made(BODIES.iter(), name, &arguments).map(Solid)
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Solid>()?;
    module.add_function(wrap_pyfunction!(body, module)?)
}
