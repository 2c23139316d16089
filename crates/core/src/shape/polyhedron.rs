//! Convex polyhedra.

use super::pieces::Extent;
use super::rigid::{Inertia, Rigid, RigidBall, VolumeMoments, homogeneous, vectors};
use super::{BodyKind, Form, check_density, hull};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{Symmetric, Vector};
use std::ops::Add;

/// Its entry in the table of bodies.
pub(super) const CONVEX_POLYHEDRON: BodyKind = BodyKind::Rigid(Kind {
    name: "ConvexPolyhedron",
    text: "convex hull of points",
    parameters: homogeneous![Parameter::new(
        "points",
        "points, of which the convex hull is the body",
        Some("m"),
        Allowed::Rows(&["x", "y", "z"], 4, Interval::ANY),
        Argument::Numbers(STONE),
    ),],
    make: |given| {
        let points = vectors(given.numbers(0));
        let faces = faces("points", &points)?;
        Ok(Form::Faces(points, faces))
    },
});

#[rustfmt::skip]
const STONE: &[f64] = &[
    3.4e-3, 0.2e-3, 0.6e-3, 1.2e-3, 2.6e-3, 1.1e-3, -2.1e-3, 2.2e-3, -0.4e-3, -3.2e-3, -0.6e-3, 0.8e-3, -0.9e-3, -2.7e-3, 0.3e-3,
    2.3e-3, -2.1e-3, -0.8e-3, 0.4e-3, 0.3e-3, 2.1e-3, 1.5e-3, 1.3e-3, -1.9e-3, -1.4e-3, -0.8e-3, -2.2e-3, -1.1e-3, 1.2e-3, 1.8e-3,
];

/// The faces of the convex hull of points.
pub(super) fn faces(name: &'static str, points: &[Vector]) -> Result<Vec<[usize; 3]>, Error> {
    let allowed = "four or more, finite, not all in one plane (m)";
    hull::triangles(points).ok_or_else(|| Error::parameter(name, points.len(), allowed))
}

impl Rigid {
    /// The homogeneous convex hull of points (m), whose faces are these triangles of them.
    ///
    /// # Errors
    /// Unless all numbers are finite, the triangles are those of the points, and the volume is positive.
    pub fn polyhedron(
        points: &[Vector],
        triangles: &[[usize; 3]],
        density: f64,
    ) -> Result<Self, Error> {
        check("points", points, triangles)?;
        let inertia = solid(points, triangles, f64::abs, density)?;
        Self::of_balls(inertia, "points", Extent::Hull, points.iter().map(vertex))
    }
}

pub(super) fn vertex(&centre: &Vector) -> RigidBall {
    RigidBall {
        centre,
        radius: 0.0,
    }
}

/// Refuses points of this name that are no numbers, and triangles of others.
pub(super) fn check(
    name: &'static str,
    points: &[Vector],
    triangles: &[[usize; 3]],
) -> Result<(), Error> {
    if triangles.as_flattened().iter().any(|&i| i >= points.len()) {
        let last = points.len().saturating_sub(1);
        let allowed = format!("triples of numbers of the {name}, from 0 to {last}");
        return Err(Error::parameter("triangles", triangles.len(), allowed));
    }
    for x in points.iter().flat_map(|point| [point.x, point.y, point.z]) {
        Error::unless(x.is_finite(), name, x, "finite (m)")?;
    }
    Ok(())
}

/// The sum of the tetrahedra that triangles make with a point among them. `counted` is how their signed volumes count.
pub(super) fn solid(
    points: &[Vector],
    triangles: &[[usize; 3]],
    counted: impl Fn(f64) -> f64,
    density: f64,
) -> Result<Inertia, Error> {
    check_density(density)?;
    let mut vertices: Vec<usize> = triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let corners = vertices.iter().map(|&i| points[i]);
    let inside = corners.fold(Vector::default(), Vector::add) / vertices.len() as f64;
    let mut moments = VolumeMoments::default();
    for corners in triangles {
        let [a, b, c] = corners.map(|i| points[i] - inside);
        let volume = counted(a.dot(b.cross(c)) / 6.0);
        moments = moments.and(tetrahedron(volume, [a, b, c]));
    }
    let allowed = "four or more that are not all in one plane";
    let positive = moments.content > 0.0 && moments.content.is_finite();
    Error::unless(positive, "points", points.len(), allowed)?;
    let mut inertia = moments.inertia(density);
    inertia.centre = inertia.centre + inside;
    Ok(inertia)
}

/// The tetrahedron of the origin and three other corners: ∫**x**⊗**x** = V/20 (Σ**x**ᵢ⊗**x**ᵢ + **s**⊗**s**), **s** = Σ**x**ᵢ.
fn tetrahedron(volume: f64, corners: [Vector; 3]) -> VolumeMoments {
    let [a, b, c] = corners;
    let sum = a + b + c;
    let second = [a, b, c, sum]
        .map(|v| Symmetric::square(v, volume / 20.0))
        .into_iter()
        .fold(Symmetric::default(), Symmetric::add);
    VolumeMoments {
        content: volume,
        first: sum * (0.25 * volume),
        second,
    }
}
