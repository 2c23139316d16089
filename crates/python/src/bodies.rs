//! Bodies, made from the parameters of a shape in SI units.

use crate::describe::{Given, arguments};
use crate::errors::python_error;
use crate::watch;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyLookupError;
use pyo3::prelude::*;
use restitution_core::{
    AnyBody, BODIES, BodyKind, Error, Form, Heights, Inertia, Quaternion, RigidBall, Roughness,
    Symmetric, Vector, collected, convex_hull,
};

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

    /// Smallest height of the centre of mass, in m, at which no part is below the plane at any angle.
    fn farthest(&self) -> f64 {
        self.0.farthest()
    }
}

/// A rigid body of any shape, ready for a run.
#[pyclass(frozen, module = "restitution._core")]
pub struct Rigid(pub restitution_core::Rigid);

/// A body that a run takes.
#[derive(FromPyObject)]
pub enum Dropped<'py> {
    Revolution(PyRef<'py, Solid>),
    Rigid(PyRef<'py, Rigid>),
}

impl Dropped<'_> {
    pub fn body(&self) -> AnyBody<'_> {
        match self {
            Self::Revolution(solid) => AnyBody::Revolution(solid.0),
            Self::Rigid(body) => AnyBody::Rigid(&body.0),
        }
    }
}

type Matrix = [[f64; 3]; 3];

#[pymethods]
impl Rigid {
    /// Mass in kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.0.inertia.mass
    }

    /// Centre of mass in m, in the axes that the body was given in.
    #[getter]
    fn centre(&self) -> [f64; 3] {
        self.0.inertia.centre.parts()
    }

    /// Tensor of inertia about the centre of mass in kg m², in the same axes.
    #[getter]
    fn inertia_tensor(&self) -> Matrix {
        self.0.inertia.tensor.rows()
    }

    /// The principal moments of inertia, in kg m².
    #[getter]
    fn principal_moments(&self) -> [f64; 3] {
        self.0.principal_moments()
    }

    /// The rotation from the principal axes to those that the body was given in, as a quaternion (w, x, y, z).
    #[getter]
    fn principal_axes(&self) -> [f64; 4] {
        self.0.axes.parts()
    }

    /// The rims of a solid of revolution that can touch, rows (z, r) in m.
    #[getter]
    fn rims(&self) -> Vec<[f64; 2]> {
        self.0.rims()
    }

    /// Smallest height of the centre of mass, in m, at which no part is below the plane in any of these attitudes, rows (w, x, y, z).
    fn lowest(&self, attitudes: PyReadonlyArray2<'_, f64>) -> PyResult<f64> {
        let (rows, _) = attitudes.as_slice()?.as_chunks::<4>();
        let heights = rows
            .iter()
            .map(|&[w, x, y, z]| self.0.lowest(Quaternion::new(w, x, y, z).normalized()));
        Ok(heights.fold(0.0, f64::max))
    }

    /// Smallest height of the centre of mass, in m, at which no part is below the plane in any attitude.
    fn farthest(&self) -> f64 {
        self.0.unit
    }

    /// The distances from the centre of mass to the planes that touch the body, with these outward normals, unit vectors in the axes that it
    /// was given in; in m.
    fn supports<'py>(
        &self,
        py: Python<'py>,
        normals: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (rows, _) = normals.as_slice()?.as_chunks::<3>();
        let distances = rows
            .iter()
            .map(|&[x, y, z]| self.0.support(Vector::new(x, y, z)));
        Ok(distances.collect::<Vec<_>>().into_pyarray(py))
    }

    /// Centre and radius of each ball or vertex, rows (x, y, z, radius) in m and the axes that the body was given in.
    fn balls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let balls = self.0.balls().map_err(python_error)?;
        let row = |ball: &RigidBall| {
            let [x, y, z] = ball.centre.parts();
            [x, y, z, ball.radius]
        };
        let rows = collected("asperities", balls.iter().map(row)).map_err(python_error)?;
        let rows = rows.into_flattened().into_pyarray(py);
        rows.reshape([balls.len(), 4])
    }
}

/// A body that may take long to make; Ctrl-C ends it.
fn made(
    py: Python<'_>,
    make: impl FnOnce() -> Result<restitution_core::Rigid, Error> + Send,
) -> PyResult<Rigid> {
    let (body, interrupt) = watch::run(py, None, |monitor| monitor.over(make))?;
    interrupt.map_or(Ok(Rigid(body)), Err)
}

/// Mass, centre of mass and tensor of inertia about it, of a body that is not homogeneous.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct GivenInertia {
    mass: f64,
    centre: [f64; 3],
    tensor: Matrix,
}

impl GivenInertia {
    fn inertia(&self) -> Inertia {
        let [x, y, z] = self.centre;
        Inertia {
            mass: self.mass,
            centre: Vector::new(x, y, z),
            tensor: Symmetric::from_rows(self.tensor),
        }
    }
}

/// The attitudes (w, x, y, z) and ω in space of free bodies with these principal moments and axes, each after a time in s.
#[pyfunction]
fn turned<'py>(
    py: Python<'py>,
    moments: [f64; 3],
    axes: [f64; 4],
    attitudes: PyReadonlyArray2<'_, f64>,
    spins: PyReadonlyArray2<'_, f64>,
    times: PyReadonlyArray1<'_, f64>,
) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
    let top = restitution_core::Top::new(moments).map_err(python_error)?;
    let [w, x, y, z] = axes;
    let axes = Quaternion::new(w, x, y, z).normalized();
    let (attitudes, _) = attitudes.as_slice()?.as_chunks::<4>();
    let (spins, _) = spins.as_slice()?.as_chunks::<3>();
    let each = attitudes.iter().zip(spins).zip(times.as_slice()?);
    let (attitudes, spins): (Vec<_>, Vec<_>) = each
        .map(|((&[w, x, y, z], &[a, b, c]), &time)| {
            let principal = Quaternion::new(w, x, y, z).normalized() * axes;
            let (principal, spin) = top.turned(principal, Vector::new(a, b, c), time);
            ((principal * axes.inverse()).parts(), spin.parts())
        })
        .unzip();
    let count = attitudes.len();
    let [attitudes, spins] = [attitudes.into_flattened(), spins.into_flattened()];
    Ok([
        attitudes.into_pyarray(py).reshape([count, 4])?,
        spins.into_pyarray(py).reshape([count, 3])?,
    ])
}

/// Balls with a given inertia, and asperities on their free surface.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the parameters of a body")]
fn rough(
    py: Python<'_>,
    spheres: Vec<[f64; 4]>,
    barrel: bool,
    inertia: GivenInertia,
    asperities: usize,
    asperity_radius: f64,
    heights: Option<Given<'_>>,
    seed: u64,
) -> PyResult<Rigid> {
    let given = [heights];
    let heights = arguments(&given)?;
    let roughness = Roughness {
        asperities,
        radius: asperity_radius,
        heights: Heights::of(heights.first(), asperity_radius).map_err(python_error)?,
        seed,
    };
    let inertia = inertia.inertia();
    let ball = |&[x, y, z, radius]: &[f64; 4]| RigidBall {
        centre: Vector::new(x, y, z),
        radius,
    };
    let balls: Vec<_> = spheres.iter().map(ball).collect();
    made(py, || {
        restitution_core::Rigid::rough(&balls, barrel, inertia, &roughness)
    })
}

fn entry(name: &str) -> PyResult<&'static BodyKind> {
    let found = BODIES.iter().find(|kind| kind.about().0 == name);
    found.ok_or_else(|| PyLookupError::new_err(format!("no {name} in the table")))
}

/// The body with this name, made from all its parameters in their order.
#[pyfunction]
fn body(py: Python<'_>, name: &str, given: Vec<Option<Given<'_>>>) -> PyResult<Py<PyAny>> {
    let given = arguments(&given)?;
    Ok(match entry(name)? {
        BodyKind::Revolution(kind) => {
            let made = (kind.make)(&given).map_err(python_error)?;
            Py::new(py, Solid(made))?.into_any()
        }
        BodyKind::Rigid(kind) => Py::new(py, made(py, || kind.body(&given))?)?.into_any(),
    })
}

/// The triangles of the convex hull of points, by their numbers; none of points in one plane.
#[pyfunction]
fn hull(points: Vec<[f64; 3]>) -> Vec<[usize; 3]> {
    let vector = |[x, y, z]: [f64; 3]| Vector::new(x, y, z);
    let points: Vec<_> = points.into_iter().map(vector).collect();
    convex_hull(&points).unwrap_or_default()
}

/// Points, and triangles of their numbers.
type Polyhedron = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// Points and triangles of a polyhedron with this name and these parameters: what there is to draw of it.
#[pyfunction]
fn faces(name: &str, given: Vec<Option<Given<'_>>>) -> PyResult<Polyhedron> {
    let BodyKind::Rigid(kind) = entry(name)? else {
        return Ok((vec![], vec![]));
    };
    let form = (kind.make)(&arguments(&given)?).map_err(python_error)?;
    Ok(match form {
        Form::Faces(points, triangles) => {
            (points.into_iter().map(Vector::parts).collect(), triangles)
        }
        _ => (vec![], vec![]),
    })
}

/// True if a height of the centre of mass is at least the lowest at which no part is below the plane, up to rounding.
#[pyfunction]
fn clears(height: f64, lowest: f64) -> bool {
    restitution_core::Solid::clears(height, lowest)
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Solid>()?;
    module.add_class::<Rigid>()?;
    module.add_function(wrap_pyfunction!(turned, module)?)?;
    module.add_function(wrap_pyfunction!(clears, module)?)?;
    module.add_function(wrap_pyfunction!(rough, module)?)?;
    module.add_function(wrap_pyfunction!(faces, module)?)?;
    module.add_function(wrap_pyfunction!(hull, module)?)?;
    module.add_function(wrap_pyfunction!(body, module)?)
}
