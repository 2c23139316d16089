//! Convex polyhedra.

use super::check_density;
use super::rigid::{Inertia, Moments, Rigid, RigidBall};
use crate::Error;
use crate::math::{Symmetric, Vector};
use std::ops::Add;

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
        let inertia = solid(points, triangles, f64::abs, density)?;
        let vertices: Vec<_> = points.iter().map(vertex).collect();
        Self::of_balls(inertia, "points", vertices.into_iter())
    }

    /// The homogeneous solid within closed surfaces of triangles of points (m), each seen counter-clockwise from outside, of which these
    /// `hull` points are the vertices of the convex hull, and can touch.
    ///
    /// # Errors
    /// As [`Rigid::polyhedron`].
    pub fn mesh(
        points: &[Vector],
        triangles: &[[usize; 3]],
        hull: &[usize],
        density: f64,
    ) -> Result<Self, Error> {
        let inertia = solid(points, triangles, |volume| volume, density)?;
        let known = hull.iter().all(|&i| i < points.len());
        Error::unless(known, "hull", hull.len(), "those of the points")?;
        let vertices: Vec<_> = hull.iter().map(|&i| vertex(&points[i])).collect();
        Self::of_balls(inertia, "points", vertices.into_iter())
    }
}

fn vertex(&centre: &Vector) -> RigidBall {
    RigidBall {
        centre,
        radius: 0.0,
    }
}

/// The sum of the tetrahedra that triangles make with a point among them. `counted` is how their signed volumes count.
fn solid(
    points: &[Vector],
    triangles: &[[usize; 3]],
    counted: impl Fn(f64) -> f64,
    density: f64,
) -> Result<Inertia, Error> {
    check_density(density)?;
    for x in points.iter().flat_map(|point| [point.x, point.y, point.z]) {
        Error::unless(x.is_finite(), "points", x, "finite (m)")?;
    }
    let known = triangles.as_flattened().iter().all(|&i| i < points.len());
    Error::unless(known, "triangles", triangles.len(), "those of the points")?;
    let mut vertices: Vec<usize> = triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let inside = vertices
        .iter()
        .fold(Vector::default(), |sum, &i| sum + points[i])
        / vertices.len() as f64;
    let mut moments = Moments::default();
    for corners in triangles {
        let [a, b, c] = corners.map(|i| points[i] - inside);
        let volume = counted(a.dot(b.cross(c)) / 6.0);
        moments = moments.and(tetrahedron(volume, [a, b, c]));
    }
    let allowed = "not all in one plane";
    let positive = moments.content > 0.0 && moments.content.is_finite();
    Error::unless(positive, "points", points.len(), allowed)?;
    let mut inertia = moments.inertia(density);
    inertia.centre = inertia.centre + inside;
    Ok(inertia)
}

/// The tetrahedron of the origin and three other corners: ∫**x**⊗**x** = V/20 (Σ**x**ᵢ⊗**x**ᵢ + **s**⊗**s**), **s** = Σ**x**ᵢ.
fn tetrahedron(volume: f64, corners: [Vector; 3]) -> Moments {
    let [a, b, c] = corners;
    let sum = a + b + c;
    let second = [a, b, c, sum]
        .map(|v| Symmetric::square(v, volume / 20.0))
        .into_iter()
        .fold(Symmetric::default(), Symmetric::add);
    Moments {
        content: volume,
        first: sum * (0.25 * volume),
        second,
    }
}
